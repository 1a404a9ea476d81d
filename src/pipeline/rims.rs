//! The rims of holes: which hole is which, and which points of their rims correspond.
//!
//! Outlines, landmarks on rims, a registration -> outlines with holes in one order; per hole a match of its rims.
//!
//! 1. Holes that landmarks tie together are one hole ([`HoleTies`](crate::matching::HoleTies)). Before there is a registration, the rims of those are matched
//!    through their landmarks, so that it begins with the holes turned as they say, too.
//! 2. The other holes are where the registration carries those of the reference.
//! 3. Every rim is matched like an outline, through its landmarks, and as the registration has it between them.

use std::sync::Arc;

use super::PipelineError;
use super::boundaries::match_refusal;
use super::drawn::{Known, proposed};
use super::landmark_ring::tie_refusal;
use super::landmarks::rim_names;
use crate::appearance::Appearance;
use crate::matching::{Landmark, MatchError, MatchOptions, MirrorHints, RingMatch};
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::outline::{Outline, Ring};
use crate::registration::RingPairs;

/// Corresponding points of the rims of the reference and of `pose` that have landmarks in common. `outlines` have their holes in the drawings' order.
pub(super) fn tied_rims(
    names: &[String],
    outlines: &[Outline],
    appearances: &[Arc<Appearance>],
    known: &Known,
    reference: usize,
    pose: usize,
) -> Result<RingPairs, PipelineError> {
    let mut tied = Vec::new();
    let options = MatchOptions {
        reference: Some(0),
        mirror_hints: MirrorHints::Skip,
        ..MatchOptions::default()
    };
    for (hole, rim) in outlines[reference].holes().iter().enumerate() {
        let Some(own) = known.ties.counterpart(reference, hole, pose) else {
            continue;
        };
        let is_common = [(reference, hole), (pose, own)];
        let on_both = known.on_rims.iter().filter(|rim| {
            let mut both = is_common.iter();
            both.all(|&(pose, hole)| rim.holes[pose] == Some(hole))
        });
        let landmarks: Vec<Landmark> = on_both
            .map(|rim| Landmark {
                name: rim.landmark.name.clone(),
                at: [reference, pose].map(|pose| rim.landmark.at[pose]).to_vec(),
            })
            .collect();
        if landmarks.is_empty() {
            continue;
        }
        let rings = [rim.clone(), outlines[pose].holes()[own].clone()];
        let shown = [reference, pose].map(|pose| Arc::clone(&appearances[pose]));
        let both = [reference, pose].map(|pose| names[pose].clone());
        let candidates = proposed(&rings, &shown, &landmarks, &options).map_err(|error| match_refusal(&both, error))?;
        tied.extend(candidates.pairs(1, 0));
    }
    Ok(tied)
}

/// Puts the holes of every pose in the order of the reference's: those that landmarks tie together as these say, the others each where it is nearest to where
/// that hole is carried, the surest first. A disc that is turned has its holes elsewhere. Says for every landmark on a rim which ring that is then.
pub(super) fn ordered_holes(
    names: &[String],
    outlines: &mut [Outline],
    known: &Known,
    reference: usize,
    carried: &dyn Fn(usize, Point) -> Option<Point>,
) -> Result<Vec<usize>, PipelineError> {
    let middle = |hole: &Ring| bounding_box(hole.points()).map(|(low, high)| (low + high) * 0.5);
    let middles: Vec<Vec<Option<Point>>> = (outlines.iter())
        .map(|outline| outline.holes().iter().map(middle).collect())
        .collect();
    let wanted: Vec<Vec<Option<Point>>> = (0..outlines.len())
        .map(|pose| {
            (middles[reference].iter())
                .map(|from| carried(pose, (*from)?))
                .collect()
        })
        .collect();
    let away = |pose: usize, a: usize, b: usize| {
        let both = wanted[pose][a].zip(middles[pose][b]);
        both.map_or(f64::INFINITY, |(wanted, place)| (wanted - place).norm())
    };
    let counts: Vec<usize> = middles.iter().map(Vec::len).collect();
    let orders = (known.ties.orders(reference, &counts, &away))
        .map_err(|error| tie_refusal(names, &rim_names(&known.on_rims), error))?;
    for (pose, outline) in outlines.iter_mut().enumerate().filter(|(pose, _)| *pose != reference) {
        *outline = outline.with_holes_in_order(&orders[pose]);
    }
    let ring = |holes: &Vec<Option<usize>>| {
        let (order, hole) = (orders.iter().zip(holes)).find_map(|(order, hole)| Some((order, (*hole)?)))?;
        Some(1 + order.iter().position(|own| *own == hole)?)
    };
    // Every landmark is somewhere, and every hole has its place in the order.
    Ok((known.on_rims.iter())
        .map(|rim| ring(&rim.holes).unwrap_or(0))
        .collect())
}

/// The match of a hole that fits the registration best.
pub(super) fn match_hole(
    rings: &[Ring],
    appearances: &[Arc<Appearance>],
    landmarks: &[Landmark],
    options: &MatchOptions,
    carried: &(dyn Fn(usize, Point) -> Option<Point> + Sync),
) -> Result<RingMatch, MatchError> {
    let candidates = proposed(rings, appearances, landmarks, options)?;
    let missed = |pose: usize, candidate: usize| -> f64 {
        let Some((reference, own)) = candidates.pairs(pose, candidate) else {
            return f64::INFINITY;
        };
        let pairs = reference.iter().zip(&own);
        pairs.filter_map(|(a, b)| Some((carried(pose, *a)? - b).norm())).sum()
    };
    let chosen: Vec<usize> = (0..rings.len())
        .map(|pose| {
            let by_distance = |a: &usize, b: &usize| missed(pose, *a).total_cmp(&missed(pose, *b));
            (0..candidates.count(pose)).min_by(by_distance).unwrap_or(0)
        })
        .collect();
    candidates.settled(rings, &chosen, options, carried)
}
