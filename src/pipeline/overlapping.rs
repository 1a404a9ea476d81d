//! Drawings whose parts lie over one another: an arm in front of the chest, legs that cross, a hand on the hip.
//!
//! Drawings of a layer -> which of them lie over themselves, and where the open ones' mesh is in them.
//!
//! 1. Where parts lie over one another the outline is shorter, for the same area, than where all are apart. The drawing with the longest one is the *open* one that the others are
//!    compared with; those whose outline is clearly shorter may lie over themselves, and those whose landmarks say so: they come in another order, or lie inside; and
//!    those that the artist says something of limbs of.
//!    Where there are none, nothing of this costs anything.
//! 2. The limbs of the open drawing are sought in these ([`crate::registration`]). One lies over itself if that explains it clearly better, and parts that do not hang together
//!    then lie on the same place.
//!
//! Limits: an open drawing is needed, and one that faces the same way. Only drawings with something drawn inside are looked at: an outline alone does not say what it hides.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::boundaries::Matched;
use super::drawn::{Known, RegistrationGuide, match_by_drawing};
use super::landmarks::{self, Landmarks};
use super::limbs_said::{LimbsSaid, poses_said};
use super::spec::{LayerSpec, OverlapSearch};
use crate::appearance::Appearance;
use crate::input::Drawing;
use crate::matching::MatchOptions;
use crate::math::Point;
use crate::outline::Outline;
use crate::registration::{FoundLimbs, Overlap};

/// An outline is clearly shorter, for its area, than the longest if it has less than this share of its length: drawn anew, apart, it varies by 4 %.
const SHORTER: f64 = 0.95;
/// One that has less than this share hides no parts: it is another drawing, or the longest is that of bare lines.
const MUCH_SHORTER: f64 = 0.4;
/// A pose lies over itself if at least this share of its figure does.
const LEAST_OVERLAP: f64 = 0.005;
/// What is not explained has to fall at least to this share of what it was.
const EXPLAINED_SHARE: f64 = 0.95;
/// Where hardly anything lies over anything, what is not explained has to fall further.
const TOUCHING_SHARE: f64 = 0.85;
/// What lies over itself in the drawings of a layer.
#[derive(Debug)]
pub(super) struct Overlapping {
    /// Of the open pose.
    pub(super) guide: RegistrationGuide,
    /// All outlines matched to the template's as far as they can be.
    pub(super) matched: Matched,
    /// By pose, places of the template and its own that are marked as one.
    pub(super) marked: Vec<Vec<[Point; 2]>>,
    /// What the artist says of limbs.
    pub(super) said: LimbsSaid,
    /// The poses that something is said of, or whose landmarks lie as they cannot where parts are apart.
    asked: Vec<usize>,
    /// By pose, how it lies over itself; `None` of those that are mapped as ever.
    pub(super) poses: Vec<Option<Overlap>>,
}

/// What of a layer's drawings lies over itself; `None` if nothing does. `landmarks` are the layer's, if they can be sorted as those of drawings whose parts
/// are apart.
pub(super) fn found(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
    landmarks: Option<&Landmarks>,
) -> Result<Option<Overlapping>, PipelineError> {
    if layer.overlaps == OverlapSearch::Refuse || drawings.len() < 2 {
        return Ok(None);
    }
    let lengths: Vec<f64> = drawings
        .iter()
        .map(|drawing| relative_length(&drawing.outline))
        .collect();
    let by_length = |a: &usize, b: &usize| lengths[*a].total_cmp(&lengths[*b]).then(b.cmp(a));
    let Some(template) = (0..lengths.len()).max_by(by_length) else {
        return Ok(None);
    };
    let is_shorter = |pose: usize| (MUCH_SHORTER..SHORTER).contains(&(lengths[pose] / lengths[template]));
    let otherwise = marked_otherwise(layer, drawings, landmarks, template);
    let said_of = poses_said(layer, template);
    let asked: Vec<usize> = (0..lengths.len())
        .filter(|pose| otherwise.contains(pose) || said_of.contains(pose))
        .collect();
    let shorter: Vec<usize> = (0..lengths.len())
        .filter(|pose| is_shorter(*pose) || asked.contains(pose))
        .collect();
    if shorter.is_empty() {
        return Ok(None);
    }
    let appearances: Vec<Arc<Appearance>> = (drawings.par_iter())
        .map(|drawing| Arc::new(Appearance::opened(drawing)))
        .collect();
    let names = layer.names();
    let unseen = |pose: usize| PipelineError::LimbsUnseen {
        pose: names[pose].clone(),
    };
    if !appearances[template].is_drawn() {
        return if said_of.is_empty() {
            Ok(None)
        } else {
            Err(unseen(template))
        };
    }
    if let Some(pose) = said_of.iter().find(|pose| !appearances[**pose].is_drawn()) {
        return Err(unseen(*pose));
    }
    let mut outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    let options = MatchOptions {
        reference: Some(template),
        ..MatchOptions::default()
    };
    // Where parts lie over one another, what is marked may come in any order along the outline, or lie inside.
    let open: Vec<usize> = (0..drawings.len()).filter(|pose| !shorter.contains(pose)).collect();
    let Ok(landmarks) = landmarks::sorted(&layer.marked_only_in(&open), drawings) else {
        return Ok(None);
    };
    let marked = marked_pairs(layer, template, &shorter);
    let known = (&Known::of(&landmarks), &marked[..]);
    let matched = match_by_drawing(&names, drawings, &mut outlines, &appearances, known, None, options);
    // What cannot be matched at all is refused by the ordinary way, which says why.
    let Ok((matched, mut guide)) = matched else {
        return Ok(None);
    };
    let said = LimbsSaid::new(layer, &guide, &open)?;
    let sought: Vec<Option<FoundLimbs>> = (shorter.par_iter())
        .map(|&pose| {
            if !appearances[pose].is_drawn() {
                return None;
            }
            // Where nothing can be compared, the ordinary way says why.
            guide.registration.seek_limbs(pose, said.of(pose)).ok().flatten()
        })
        .collect();
    let mut poses: Vec<Option<Overlap>> = vec![None; drawings.len()];
    for (pose, found) in shorter.into_iter().zip(sought) {
        let lies_over = |found: &FoundLimbs| {
            // What is marked has put parts over one another before their limbs were sought.
            let is_marked = !marked[pose].is_empty() || said_of.contains(&pose);
            if is_marked && found.overlap.share >= LEAST_OVERLAP || otherwise.contains(&pose) {
                return true;
            }
            let [before, after] = found.overlap.unexplained;
            let is_clearly_better = after < EXPLAINED_SHARE * before;
            // Parts that touch close a ring, or part the outline otherwise, without lying over one another.
            is_clearly_better && (found.overlap.share >= LEAST_OVERLAP || after < TOUCHING_SHARE * before)
        };
        if let Some(found) = found.filter(lies_over) {
            guide.registration.place(pose, &found);
            poses[pose] = Some(found.overlap);
        }
    }
    if poses.iter().all(Option::is_none) {
        return Ok(None);
    }
    Ok(Some(Overlapping {
        guide,
        matched,
        marked,
        said,
        asked,
        poses,
    }))
}

/// The poses whose landmarks lie as they cannot where parts are apart: in another order along the outline than in the template, or inside where they lie on
/// it there. An order that is reversed is that of a drawing that faces the other way.
fn marked_otherwise(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
    landmarks: Option<&Landmarks>,
    template: usize,
) -> Vec<usize> {
    let others = (0..drawings.len()).filter(|pose| *pose != template);
    if layer.landmarks.is_empty() {
        return Vec::new();
    }
    match landmarks {
        Some(landmarks) => others.filter(|pose| is_shuffled(landmarks, template, *pose)).collect(),
        None => others
            .filter(|&pose| {
                let both = landmarks::sorted(&layer.marked_only_in(&[template, pose]), drawings);
                both.map_or(true, |landmarks| is_shuffled(&landmarks, template, pose))
            })
            .collect(),
    }
}

/// Whether landmarks come around the outline of a pose neither in the order of the template nor in its reverse.
fn is_shuffled(landmarks: &Landmarks, template: usize, pose: usize) -> bool {
    let mut along: Vec<[f64; 2]> = (landmarks.on_outline.iter())
        .filter_map(|landmark| Some([landmark.at[template]?, landmark.at[pose]?]))
        .collect();
    along.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let next = along.iter().cycle().skip(1);
    let back = along.iter().zip(next).filter(|(own, next)| next[1] <= own[1]).count();
    back > 1 && along.len() > back + 1
}

/// By drawn pose, the places of landmarks and of the ends of lines in the template and in it, as drawings are used; none of poses that are not among `poses`.
fn marked_pairs(layer: &LayerSpec, template: usize, poses: &[usize]) -> Vec<Vec<[Point; 2]>> {
    let used = |pose: usize, place: Point| landmarks::as_used(layer, pose, place);
    let mut pairs = vec![Vec::new(); layer.drawn_poses().len()];
    for &pose in poses {
        let pair = |[from, to]: [Point; 2]| [used(template, from), used(pose, to)];
        let points = (layer.landmarks.iter())
            .filter_map(|landmark| Some([landmark.at[template]?, landmark.at[pose]?]))
            .map(pair);
        let lines = layer.paths.iter().filter_map(|path| {
            let both = [path.at[template].as_ref()?, path.at[pose].as_ref()?];
            Some(both.map(|line| [line.first().copied(), line.last().copied()]))
        });
        let ends = lines.flat_map(|[from, to]| [0, 1].map(|end| Some([from[end]?, to[end]?])));
        pairs[pose] = points.chain(ends.flatten().map(pair)).collect();
    }
    pairs
}

/// The length of the outer ring over the root of its area.
fn relative_length(outline: &Outline) -> f64 {
    outline.outer().perimeter() / outline.outer().signed_area().abs().sqrt().max(f64::MIN_POSITIVE)
}

impl Overlapping {
    /// The poses that do not lie over themselves.
    pub(super) fn open(&self) -> Vec<usize> {
        (0..self.poses.len())
            .filter(|pose| self.poses[*pose].is_none())
            .collect()
    }

    /// Whether the artist says that parts of a pose lie over one another.
    pub(super) fn is_asked(&self, pose: usize) -> bool {
        self.asked.contains(&pose)
    }

    /// What is left without some poses, which are then mapped as ever; `None` if nothing is.
    pub(super) fn without(mut self, poses: &[usize]) -> Option<Self> {
        for pose in poses {
            self.poses[*pose] = None;
        }
        self.poses.iter().any(Option::is_some).then_some(self)
    }
}
