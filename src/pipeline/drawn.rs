//! Outlines matched and interiors registered by what is drawn.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::boundaries::{Matched, match_refusal};
use super::drawings::mirrored;
use super::landmarks::{Landmarks, RimLandmark};
use super::named::named_pairs;
use super::rims::{match_hole, ordered_holes, tied_rims};
use crate::appearance::{Appearance, Profile};
use crate::compatible::Guide;
use crate::input::Drawing;
use crate::matching::{HoleTies, Landmark, MatchError, MatchOptions, MirrorHints, RingCandidates};
use crate::math::Point;
use crate::outline::{ArcLength, Outline, Ring};
use crate::registration::{Explained, Pin, Registration, RingPairs, difference, register};

/// From this share of the reference's figure on that is found in a pose, it is the same character in the same colours: drawn anew, two thirds of one
/// are found at least, of another an eighth at most.
const FOUND_SHARE: f64 = 0.5;

/// A drawing looks reflected if its reflection differs from the reference by less than this share of what it differs itself.
const REFLECTED_SHARE: f64 = 0.8;

/// Samples of a profile: one a row of a match.
const PROFILE_SAMPLES: usize = 512;

/// Where the reference's places are in the other poses.
#[derive(Debug, Clone)]
pub(super) struct RegistrationGuide {
    pub(super) reference: usize,
    pub(super) registration: Registration,
}

impl Guide for RegistrationGuide {
    fn reference(&self) -> usize {
        self.reference
    }

    fn carried(&self, pose: usize, place: Point) -> Option<Point> {
        self.registration.carried(pose, place)
    }

    fn trust(&self, pose: usize, place: Point) -> f64 {
        self.registration.trust(pose, place)
    }
}

/// The appearances of some drawings.
pub(super) fn appearances(drawings: &[Arc<Drawing>]) -> Vec<Arc<Appearance>> {
    drawings
        .par_iter()
        .map(|drawing| Arc::new(Appearance::new(drawing)))
        .collect()
}

/// What an artist says corresponds, besides lines.
#[derive(Debug, PartialEq)]
pub(super) struct Known {
    /// Points of the outer rings.
    pub(super) on_outline: Vec<Landmark>,
    /// Points of rims.
    pub(super) on_rims: Vec<RimLandmark>,
    /// What these say of the holes.
    pub(super) ties: HoleTies,
    /// Points inside, #points x #poses.
    inside: Vec<Vec<Option<Point>>>,
}

impl Known {
    pub(super) fn of(landmarks: &Landmarks) -> Self {
        Self {
            on_outline: landmarks.on_outline.clone(),
            on_rims: landmarks.on_rims.clone(),
            ties: landmarks.ties.clone(),
            inside: landmarks.points.iter().map(|point| point.at.clone()).collect(),
        }
    }

    /// The places of all of it, #landmarks x #poses; `outlines` have their holes in the drawings' order.
    fn places(&self, outlines: &[Outline]) -> Vec<Vec<Option<Point>>> {
        let arcs: Vec<Vec<ArcLength>> = (outlines.iter())
            .map(|outline| outline.rings().iter().map(ArcLength::new).collect())
            .collect();
        let on_outline = self.on_outline.iter().map(|landmark| -> Vec<Option<Point>> {
            let places = landmark.at.iter().zip(&arcs);
            places.map(|(t, rings)| t.map(|t| rings[0].at(t))).collect()
        });
        let on_rims = self.on_rims.iter().map(|rim| -> Vec<Option<Point>> {
            let places = rim.landmark.at.iter().zip(&rim.holes).zip(&arcs);
            places
                .map(|((t, hole), rings)| Some(rings[(*hole)? + 1].at((*t)?)))
                .collect()
        });
        on_outline.chain(self.inside.iter().cloned()).chain(on_rims).collect()
    }
}

/// Matches all rings and registers the interiors; what of that `before` has is not made again. By pose, `pinned` has pairs of places, of the reference and of the pose, that
/// are known beside what `known` says; none at all is an empty list.
pub(super) fn match_by_drawing(
    names: &[String],
    drawings: &[Arc<Drawing>],
    outlines: &mut [Outline],
    appearances: &[Arc<Appearance>],
    (known, pinned): (&Known, &[Vec<[Point; 2]>]),
    before: Option<&RegistrationGuide>,
    mut options: MatchOptions,
) -> Result<(Matched, RegistrationGuide), PipelineError> {
    let refusal = |error: MatchError| match_refusal(names, error);
    let landmarks = &known.on_outline;
    let outer: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let mut candidates = proposed(&outer, appearances, landmarks, &options).map_err(refusal)?;
    let reference = candidates.reference();
    let poses = 0..outlines.len();
    let tied: Vec<RingPairs> = (poses.clone())
        .map(|pose| {
            if pose == reference {
                return Ok(Vec::new());
            }
            tied_rims(names, outlines, appearances, known, reference, pose)
        })
        .collect::<Result<_, PipelineError>>()?;
    let beginnings: Vec<Vec<RingPairs>> = (poses.clone().zip(&tied))
        .map(|(pose, tied)| beginnings(&candidates, pose, tied))
        .collect();
    let places = known.places(outlines);
    let pins: Vec<Vec<Pin>> = poses
        .map(|pose| {
            let certain = places
                .iter()
                .filter_map(|at| Some(Pin::certain(at[reference]?, at[pose]?)));
            let pinned = pinned.get(pose).into_iter().flatten();
            let certain = certain.chain(pinned.map(|[from, to]| Pin::certain(*from, *to)));
            let named = named_pairs(&drawings[reference], &drawings[pose]).into_iter();
            certain.chain(named.map(|[from, to]| Pin::likely(from, to))).collect()
        })
        .collect();
    let (mut registration, mut chosen) = register(
        appearances,
        reference,
        &beginnings,
        &pins,
        before.map(|before| &before.registration),
    )
    .map_err(|error| PipelineError::stage(names, Some(reference), error))?;
    // Drawings in other colours have their form and their lines in common.
    let unlike = |pose: &usize| {
        registration
            .explained(*pose)
            .is_some_and(|explained| !is_found(&explained))
    };
    let unlike: Vec<usize> = (0..outlines.len()).filter(unlike).collect();
    if !unlike.is_empty() {
        let mut plain = appearances.to_vec();
        for &pose in &unlike {
            plain[pose] = Arc::new(appearances[pose].without_colours());
        }
        options.reference = Some(reference);
        candidates = proposed(&outer, &plain, landmarks, &options).map_err(refusal)?;
        let shown = Arc::new(appearances[reference].without_colours());
        for pose in unlike {
            let both = [Arc::clone(&shown), Arc::clone(&plain[pose])];
            let begins = [Vec::new(), self::beginnings(&candidates, pose, &tied[pose])];
            let (by_form, chosen_of) = register(&both, 0, &begins, &[Vec::new(), pins[pose].clone()], None)
                .map_err(|error| PipelineError::stage(names, Some(pose), error))?;
            registration.placed_as_in(pose, &by_form, 1);
            chosen[pose] = chosen_of[1];
        }
    }
    let carried = |pose: usize, place: Point| registration.carried(pose, place);
    let mut first = candidates
        .settled(&outer, &chosen, &options, &carried)
        .map_err(refusal)?;
    first
        .report
        .poses
        .par_iter_mut()
        .enumerate()
        .for_each(|(pose, matched)| {
            // Outlines alone cannot tell a figure that faces the other way from one that leans there. Names and landmarks inside can.
            matched.looks_mirrored = matched.looks_mirrored
                && pins[pose].is_empty()
                && registration.residual(pose).is_some_and(|residual| {
                    looks_reflected(residual, &drawings[pose], &outer[reference], &appearances[reference])
                });
        });
    let rim_rings = ordered_holes(names, outlines, known, reference, &carried)?;
    let mut matched = Matched {
        reference,
        correspondences: vec![first.correspondence],
        outer: first.report,
        holes: Vec::new(),
        rim_rings: rim_rings.clone(),
    };
    options.reference = Some(reference);
    options.mirror_hints = MirrorHints::Skip;
    options.turns_rad = first.turns_rad;
    for hole in 0..outlines.first().map_or(0, |outline| outline.holes().len()) {
        let rings: Vec<Ring> = outlines.iter().map(|outline| outline.holes()[hole].clone()).collect();
        let on_rim = known
            .on_rims
            .iter()
            .zip(&rim_rings)
            .filter(|(_, ring)| **ring == hole + 1);
        let on_rim: Vec<Landmark> = on_rim.map(|(rim, _)| rim.landmark.clone()).collect();
        let of_hole = match_hole(&rings, appearances, &on_rim, &options, &carried).map_err(refusal)?;
        matched.correspondences.push(of_hole.correspondence);
        matched.holes.push(of_hole.report);
    }
    Ok((
        matched,
        RegistrationGuide {
            reference,
            registration,
        },
    ))
}

/// Whether enough of the reference is found in a pose to say nothing of it.
pub(super) fn is_found(explained: &Explained) -> bool {
    explained.share >= FOUND_SHARE
}

/// How a registration of `pose` may begin, with rims that landmarks match.
fn beginnings(candidates: &RingCandidates, pose: usize, tied: &RingPairs) -> Vec<RingPairs> {
    (0..candidates.count(pose))
        .filter_map(|candidate| {
            let outer = candidates.pairs(pose, candidate)?;
            Some(std::iter::once(outer).chain(tied.iter().cloned()).collect())
        })
        .collect()
}

/// Whether a drawing, reflected, differs clearly less from the reference than it does itself, which is by `residual`. One that cannot be reflected or
/// registered does not.
pub(super) fn looks_reflected(residual: f64, drawing: &Drawing, reference: &Ring, shown: &Arc<Appearance>) -> bool {
    let Ok(reflected) = mirrored(drawing.clone(), None) else {
        return false;
    };
    let rings = [reference.clone(), reflected.outline.outer().clone()];
    let left = self::residual(&rings, [shown, &Arc::new(Appearance::new(&reflected))]);
    left.is_some_and(|left| left < REFLECTED_SHARE * residual)
}

/// How much the second of two drawings differs from the first where it is registered to it; `None` where it cannot be.
pub(super) fn residual(rings: &[Ring; 2], appearances: [&Arc<Appearance>; 2]) -> Option<f64> {
    let appearances = appearances.map(Arc::clone);
    let options = MatchOptions {
        reference: Some(0),
        mirror_hints: MirrorHints::Skip,
        ..MatchOptions::default()
    };
    let candidates = proposed(rings, &appearances, &[], &options).ok()?;
    difference(
        [&appearances[0], &appearances[1]],
        &beginnings(&candidates, 1, &Vec::new()),
    )
    .ok()
}

/// Proposed matches of rings of drawings.
pub(super) fn proposed(
    rings: &[Ring],
    appearances: &[Arc<Appearance>],
    landmarks: &[Landmark],
    options: &MatchOptions,
) -> Result<RingCandidates, MatchError> {
    let profiles: Vec<Profile> = (rings.par_iter().zip(appearances))
        .flat_map_iter(|(ring, appearance)| appearance.profiles(&[ring], PROFILE_SAMPLES))
        .collect();
    RingCandidates::new(rings, &profiles, landmarks, options)
}
