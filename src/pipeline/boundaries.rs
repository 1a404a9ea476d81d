//! The outlines' part of a mapping: matched, and simplified to polygons with corresponding vertices.

use std::sync::Arc;

use super::drawn::{Known, RegistrationGuide, match_by_drawing};
use super::spec::LayerSpec;
use super::{PipelineError, Stage};
use crate::appearance::Appearance;
use crate::compatible::{RingPoint, Simplification, Simplified, SimplifiedAlone, SimplifyError, SimplifyOptions};
use crate::input::Drawing;
use crate::matching::{Correspondence, Landmark, MatchError, MatchOptions, MatchReport, match_rings_beside};
use crate::outline::{Outline, Ring};

/// How far corresponding vertices may drift apart where drawings say what corresponds, as a share of the deviation allowed, and at least, as a
/// fraction of the diagonal: less than that is not known of outlines that are drawn anew.
const DRIFT_SHARE: f64 = 0.5;
const LEAST_DRIFT: f64 = 0.01;

/// The outlines matched and simplified, and what that was made of besides the drawings.
#[derive(Debug)]
pub(super) struct Boundaries {
    known: Known,
    reference: Option<usize>,
    tolerance: f64,
    /// Holes in one order.
    pub(super) outlines: Vec<Outline>,
    pub(super) matched: Matched,
    /// What the drawings show.
    pub(super) appearances: Vec<Arc<Appearance>>,
    /// Where that is in every pose; `None` where nothing is drawn inside.
    pub(super) guide: Option<RegistrationGuide>,
    /// The places of the landmarks on outlines, then of those on rims, #landmarks x #poses.
    pub(super) pinned: Vec<Vec<RingPoint>>,
    /// To be varied.
    pub(super) simplification: Simplification,
    pub(super) simplified: Simplified,
}

impl Boundaries {
    /// What need not be made again is taken from `before`, which is of the same drawings.
    pub(super) fn new(
        layer: &LayerSpec,
        drawings: &[Arc<Drawing>],
        known: Known,
        before: Option<&Self>,
        begins: &mut dyn FnMut(Stage),
    ) -> Result<Self, PipelineError> {
        // Of a figure that lay over itself only the open poses were mapped so.
        let before = before.filter(|before| before.outlines.len() == drawings.len());
        begins(Stage::Matching);
        let mut outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
        let options = layer.mesh.simplify.clone();
        let refusal = |error| simplify_refusal(&layer.names(), error);
        let given = outlines.clone();
        let alone_options = options.clone();
        let alone = || alone(&given, &known, &alone_options, before);
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
                        (&known, &[]),
                        before.and_then(|before| before.guide.as_ref()),
                        options,
                    )
                },
                alone,
            );
            let (matched, guide) = matched?;
            (matched, alone, Some(guide))
        } else {
            let (matched, alone) = match_outlines(layer, &outlines, &known.on_outline, alone)?;
            (matched, alone, None)
        };
        let alone = alone.map_err(refusal)?;
        // Where drawings say what corresponds, the mesh is held to it.
        let options = match (&guide, options.drift) {
            (Some(_), None) => SimplifyOptions {
                drift: Some((DRIFT_SHARE * layer.mesh.simplify.tolerance).max(LEAST_DRIFT)),
                ..options
            },
            _ => options,
        };
        begins(Stage::Simplification);
        let on_rims = known.on_rims.iter().zip(&matched.rim_rings);
        let marked = (known.on_outline.iter().map(|landmark| (landmark, 0)))
            .chain(on_rims.map(|(rim, &ring)| (&rim.landmark, ring)));
        let pinned: Vec<Vec<RingPoint>> = marked
            .filter_map(|(landmark, ring)| everywhere(landmark, ring, &matched.correspondences[ring]))
            .collect();
        let simplification = Simplification::with(&outlines, &matched.correspondences, &pinned, &options, &alone);
        let mut simplification = simplification.map_err(refusal)?;
        let simplified = simplification.polygons().map_err(refusal)?;
        Ok(Self {
            known,
            reference: layer.reference,
            tolerance: layer.mesh.simplify.tolerance,
            outlines,
            matched,
            appearances,
            guide,
            pinned,
            simplification,
            simplified,
        })
    }

    /// Whether they are those of this layer, too, whose drawings are the same.
    pub(super) fn serve(&self, layer: &LayerSpec, known: &Known) -> bool {
        self.outlines.len() == layer.poses.len()
            && self.known == *known
            && self.reference == layer.reference
            && self.tolerance == layer.mesh.simplify.tolerance
    }
}

/// The outlines simplified alone, but for poses that lack a landmark: its place comes from the matching.
fn alone(
    outlines: &[Outline],
    known: &Known,
    options: &SimplifyOptions,
    before: Option<&Boundaries>,
) -> Result<SimplifiedAlone, SimplifyError> {
    let on = |ring: usize| move |parameter: f64| RingPoint { ring, parameter };
    let on_outline = (known.on_outline.iter()).map(|landmark| landmark.at.iter().map(|t| t.map(on(0))).collect());
    let on_rims = known.on_rims.iter().map(|rim| {
        let places = rim.landmark.at.iter().zip(&rim.holes);
        places.map(|(t, hole)| Some(on((*hole)? + 1)((*t)?))).collect()
    });
    let mut rows: Vec<Vec<Option<RingPoint>>> = on_outline.chain(on_rims).collect();
    rows.retain(|row| row.iter().any(Option::is_some));
    let before = before.map(|before| before.simplification.alone()).unwrap_or_default();
    SimplifiedAlone::new(outlines, &rows, options, &before)
}

/// All rings, matched.
#[derive(Debug)]
pub(super) struct Matched {
    pub(super) reference: usize,
    /// Outer ring first.
    pub(super) correspondences: Vec<Correspondence>,
    pub(super) outer: MatchReport,
    pub(super) holes: Vec<MatchReport>,
    /// By landmark on a rim, its ring.
    pub(super) rim_rings: Vec<usize>,
}

/// Matches the outlines of figures without holes; `beside` is other work, done where matching leaves processors idle.
fn match_outlines<T: Send>(
    layer: &LayerSpec,
    outlines: &[Outline],
    landmarks: &[Landmark],
    beside: impl FnOnce() -> T + Send,
) -> Result<(Matched, T), PipelineError> {
    let names = layer.names();
    let outer: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let options = MatchOptions {
        reference: layer.reference,
        ..MatchOptions::default()
    };
    let refusal = |error| match_refusal(&names, error);
    let (first, beside) = match_rings_beside(&outer, landmarks, &options, beside).map_err(refusal)?;
    let matched = Matched {
        reference: first.reference,
        correspondences: vec![first.correspondence],
        outer: first.report,
        holes: Vec::new(),
        rim_rings: Vec::new(),
    };
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

/// A landmark on ring `ring` of every pose: where a pose lacks it, where the matching puts it.
fn everywhere(landmark: &Landmark, ring: usize, correspondence: &Correspondence) -> Option<Vec<RingPoint>> {
    let given = landmark.at.iter().enumerate();
    let (from, known) = given.clone().find_map(|(pose, t)| Some((pose, (*t)?)))?;
    let place = |(pose, t): (usize, &Option<f64>)| RingPoint {
        ring,
        parameter: t.unwrap_or_else(|| correspondence.carry(from, pose, known)),
    };
    Some(given.map(place).collect())
}
