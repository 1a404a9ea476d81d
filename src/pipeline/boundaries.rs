//! The outlines' part of a mapping: matched, and simplified to polygons with corresponding vertices.

use std::sync::Arc;

use super::drawn::{Known, RegistrationGuide, match_by_drawing};
use super::spec::LayerSpec;
use super::{PipelineError, Stage};
use crate::appearance::Appearance;
use crate::compatible::{Simplification, Simplified, SimplifiedAlone, SimplifyError, SimplifyOptions};
use crate::input::Drawing;
use crate::matching::{
    Correspondence, Landmark, MatchError, MatchOptions, MatchReport, MirrorHints, match_rings, match_rings_beside,
};
use crate::math::Point;
use crate::outline::{Outline, Ring};

/// How far corresponding vertices may drift apart where drawings say what corresponds, as a share of the deviation allowed, and at least, as a
/// fraction of the diagonal: less than that is not known of outlines that are drawn anew.
const DRIFT_SHARE: f64 = 0.5;
const LEAST_DRIFT: f64 = 0.01;

/// The outlines matched and simplified, and what that was made of besides the drawings.
#[derive(Debug)]
pub(super) struct Boundaries {
    on_outline: Vec<Landmark>,
    reference: Option<usize>,
    tolerance: f64,
    /// Holes in one order.
    pub(super) outlines: Vec<Outline>,
    pub(super) matched: Matched,
    /// What the drawings show.
    pub(super) appearances: Vec<Arc<Appearance>>,
    /// Where that is in every pose; `None` where nothing is drawn inside.
    pub(super) guide: Option<RegistrationGuide>,
    /// Pairs of points inside that guide the registration.
    inside: Vec<Vec<Option<Point>>>,
    /// The places of the landmarks, #landmarks x #poses.
    pub(super) pinned: Vec<Vec<f64>>,
    /// To be varied.
    pub(super) simplification: Simplification,
    pub(super) simplified: Simplified,
}

impl Boundaries {
    /// What need not be made again is taken from `before`, which is of the same drawings.
    pub(super) fn new(
        layer: &LayerSpec,
        drawings: &[Arc<Drawing>],
        on_outline: &[Landmark],
        inside: &[Vec<Option<Point>>],
        before: Option<&Self>,
        begins: &mut dyn FnMut(Stage),
    ) -> Result<Self, PipelineError> {
        begins(Stage::Matching);
        let mut outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
        let options = layer.mesh.simplify.clone();
        let refusal = |error| simplify_refusal(&layer.names(), error);
        let given = outlines.clone();
        let alone_options = options.clone();
        let alone = || alone(&given, on_outline, &alone_options, before);
        let appearances = match before {
            Some(before) => before.appearances.clone(),
            None => super::drawn::appearances(drawings),
        };
        // Rims of holes turn with the outline around them only where the inside is looked at, too.
        let has_holes = outlines.iter().any(|outline| !outline.holes().is_empty());
        let is_drawn = has_holes || appearances.iter().any(|appearance| appearance.is_drawn());
        let (matched, alone, guide) = if is_drawn {
            let options = MatchOptions {
                reference: layer.reference,
                ..MatchOptions::default()
            };
            let (matched, alone) = rayon::join(
                || {
                    match_by_drawing(
                        &layer.names(),
                        drawings,
                        &mut outlines,
                        &appearances,
                        &Known {
                            landmarks: on_outline,
                            inside,
                        },
                        before.and_then(|before| before.guide.as_ref()),
                        options,
                    )
                },
                alone,
            );
            let (matched, guide) = matched?;
            (matched, alone, Some(guide))
        } else {
            let (matched, alone) = match_outlines(layer, &mut outlines, on_outline, alone)?;
            (matched, alone, None)
        };
        let alone = alone.map_err(refusal)?;
        // Where drawings say what corresponds, the mesh is held to it.
        let options = match (&guide, options.drift) {
            (Some(_), None) => options.with_drift((DRIFT_SHARE * layer.mesh.simplify.tolerance).max(LEAST_DRIFT)),
            _ => options,
        };
        begins(Stage::Simplification);
        let pinned: Vec<Vec<f64>> = on_outline
            .iter()
            .filter_map(|landmark| everywhere(landmark, &matched.correspondences[0]))
            .collect();
        let simplification = Simplification::with(&outlines, &matched.correspondences, &pinned, &options, &alone);
        let mut simplification = simplification.map_err(refusal)?;
        let simplified = simplification.polygons().map_err(refusal)?;
        Ok(Self {
            on_outline: on_outline.to_vec(),
            reference: layer.reference,
            tolerance: layer.mesh.simplify.tolerance,
            outlines,
            matched,
            appearances,
            guide,
            inside: inside.to_vec(),
            pinned,
            simplification,
            simplified,
        })
    }

    /// Whether they are those of this layer, too, whose drawings are the same.
    pub(super) fn serve(&self, layer: &LayerSpec, on_outline: &[Landmark], inside: &[Vec<Option<Point>>]) -> bool {
        self.inside == inside
            && self.on_outline == on_outline
            && self.reference == layer.reference
            && self.tolerance == layer.mesh.simplify.tolerance
    }
}

/// The outlines simplified alone, but for poses that lack a landmark: its place comes from the matching.
fn alone(
    outlines: &[Outline],
    on_outline: &[Landmark],
    options: &SimplifyOptions,
    before: Option<&Boundaries>,
) -> Result<SimplifiedAlone, SimplifyError> {
    let known = on_outline
        .iter()
        .filter(|landmark| landmark.at.iter().any(Option::is_some));
    let known: Vec<Vec<Option<f64>>> = known.map(|landmark| landmark.at.clone()).collect();
    let before = before.map(|before| before.simplification.alone()).unwrap_or_default();
    SimplifiedAlone::new(outlines, &known, options, &before)
}

/// All rings, matched.
#[derive(Debug)]
pub(super) struct Matched {
    pub(super) reference: usize,
    /// Outer ring first.
    pub(super) correspondences: Vec<Correspondence>,
    pub(super) outer: MatchReport,
    pub(super) holes: Vec<MatchReport>,
}

/// Matches the outer rings, puts the holes of all poses in one order, and matches them; `beside` is other work, done where
/// matching leaves processors idle.
fn match_outlines<T: Send>(
    layer: &LayerSpec,
    outlines: &mut [Outline],
    landmarks: &[Landmark],
    beside: impl FnOnce() -> T + Send,
) -> Result<(Matched, T), PipelineError> {
    let names = layer.names();
    let outer: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let mut options = MatchOptions {
        reference: layer.reference,
        ..MatchOptions::default()
    };
    let refusal = |error| match_refusal(&names, error);
    let (first, beside) = match_rings_beside(&outer, landmarks, &options, beside).map_err(refusal)?;
    order_holes(outlines, first.reference)?;
    options.turns_rad = first.turns_rad;
    let mut matched = Matched {
        reference: first.reference,
        correspondences: vec![first.correspondence],
        outer: first.report,
        holes: Vec::new(),
    };
    options.reference = Some(matched.reference);
    options.mirror_hints = MirrorHints::Skip;
    for hole in 0..outlines.first().map_or(0, |outline| outline.holes().len()) {
        let rings: Vec<Ring> = outlines.iter().map(|outline| outline.holes()[hole].clone()).collect();
        let of_hole = match_rings(&rings, &[], &options).map_err(refusal)?;
        matched.correspondences.push(of_hole.correspondence);
        matched.holes.push(of_hole.report);
    }
    Ok((matched, beside))
}

/// The simplification's refusal with the pose's name.
fn simplify_refusal(names: &[String], error: SimplifyError) -> PipelineError {
    let pose = match &error {
        SimplifyError::RingCount { pose, .. }
        | SimplifyError::Degenerate { pose, .. }
        | SimplifyError::NotSimple { pose, .. } => Some(*pose),
        _ => None,
    };
    PipelineError::stage(names, pose, error)
}

/// The matching's refusal with the poses' names.
pub(super) fn match_refusal(names: &[String], error: MatchError) -> PipelineError {
    let name = |pose: usize| names.get(pose).cloned().unwrap_or_default();
    match error {
        MatchError::LandmarkOrder { landmark, pose, other } => PipelineError::LandmarkOrder {
            landmark,
            pose: name(pose),
            other: name(other),
        },
        MatchError::LandmarksCoincide { first, second, pose } => PipelineError::LandmarksCoincide {
            first,
            second,
            pose: name(pose),
        },
        MatchError::LandmarkPlace { pose, .. } | MatchError::Degenerate { pose, .. } | MatchError::NoMatch { pose } => {
            PipelineError::stage(names, Some(pose), error)
        }
        other => PipelineError::stage(names, None, other),
    }
}

/// A landmark on every pose: where a pose lacks it, where the matching puts it.
fn everywhere(landmark: &Landmark, correspondence: &Correspondence) -> Option<Vec<f64>> {
    let (from, known) = landmark
        .at
        .iter()
        .enumerate()
        .find_map(|(pose, t)| t.map(|t| (pose, t)))?;
    Some(
        landmark
            .at
            .iter()
            .enumerate()
            .map(|(pose, t)| t.unwrap_or_else(|| correspondence.carry(from, pose, known)))
            .collect(),
    )
}

/// Puts the holes of every pose in the order of the reference's: each at the nearest place relative to its outline.
fn order_holes(outlines: &mut [Outline], reference: usize) -> Result<(), PipelineError> {
    let places: Vec<Point> = match outlines.get(reference) {
        Some(outline) => outline
            .holes()
            .iter()
            .map(|hole| relative_place(hole, outline.outer()))
            .collect(),
        None => return Ok(()),
    };
    if places.len() < 2 {
        return Ok(());
    }
    for outline in outlines.iter_mut() {
        let mut left: Vec<Ring> = outline.holes().to_vec();
        let mut ordered = Vec::with_capacity(left.len());
        for place in &places {
            let distance = |hole: &Ring| (relative_place(hole, outline.outer()) - place).norm();
            let nearest = (0..left.len()).min_by(|a, b| distance(&left[*a]).total_cmp(&distance(&left[*b])));
            if let Some(nearest) = nearest {
                ordered.push(left.remove(nearest));
            }
        }
        *outline = Outline::new(outline.outer().clone(), ordered)
            .map_err(|error| PipelineError::stage(&[], None, error))?
            .with_openings(outline.openings().to_vec());
    }
    Ok(())
}

/// The middle of a hole's box, in units of the outer ring's box.
fn relative_place(hole: &Ring, outer: &Ring) -> Point {
    let bounds = |ring: &Ring| crate::math::point::bounding_box(ring.points()).unwrap_or_default();
    let ((low, high), (outer_low, outer_high)) = (bounds(hole), bounds(outer));
    ((low + high) * 0.5 - outer_low).component_div(&(outer_high - outer_low).sup(&Point::repeat(f64::MIN_POSITIVE)))
}
