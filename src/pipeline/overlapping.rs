//! Drawings whose parts lie over one another: an arm in front of the chest, legs that cross, a hand on the hip.
//!
//! Drawings of a layer -> which of them lie over themselves, and where the open ones' mesh is in them.
//!
//! 1. Where parts lie over one another the outline is shorter, for the same area, than where all are apart. The drawing with the longest one is the *open* one that the others are
//!    compared with; those whose outline is clearly shorter may lie over themselves. Where none is, nothing of this costs anything.
//! 2. The limbs of the open drawing are sought in these ([`crate::registration`]). One lies over itself if that explains it clearly better, and parts that do not hang together
//!    then lie on the same place.
//! 3. The other drawings are mapped as ever. Their mesh is bent, as rigidly as possible, to where the limbs were found, and follows them without inverting a triangle.
//!
//! Limits: an open drawing is needed, and one that faces the same way. Only drawings with something drawn inside are looked at: an outline alone does not say what it hides.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::boundaries::Matched;
use super::drawn::{Known, RegistrationGuide, appearances, match_by_drawing};
use super::spec::{LayerSpec, OverlapSearch};
use crate::compatible::{Guide, follow};
use crate::input::Drawing;
use crate::matching::{Correspondence, MatchOptions};
use crate::math::{Point, for_each_cell, point, rotation};
use crate::mesh::validity;
use crate::outline::{ArcLength, Outline};
use crate::pose::{HandleDeformation, Mapping, Matching, OverlappingPose, Overlaps, PoseSet};
use crate::registration::{FoundLimbs, Overlap};
use crate::render::coverage::Coverage;

/// An outline is clearly shorter, for its area, than the longest if it has less than this share of its length: drawn anew, apart, it varies by 4 %.
const SHORTER: f64 = 0.95;
/// One that has less than this share hides no parts: it is another drawing, or the longest is that of bare lines.
const MUCH_SHORTER: f64 = 0.4;
/// A pose lies over itself if at least this share of its figure does.
const LEAST_OVERLAP: f64 = 0.005;
/// And if what is not explained falls at least to this share of what it was.
const EXPLAINED_SHARE: f64 = 0.95;
/// The mesh and the pose's figure have at least this much in common, of what either has: a limb that was not found leaves its place bare.
const LEAST_COVER: f64 = 0.931;
/// Cells along the diagonal that this is counted on.
const COVER_CELLS: f64 = 500.0;
/// Where hardly anything lies over anything, what is not explained has to fall further.
const TOUCHING_SHARE: f64 = 0.85;
/// Handles that bend the mesh are this far apart, as a fraction of the diagonal; where they contradict one another, further by this factor, so many times.
const HANDLES_APART: f64 = 0.05;
const FURTHER: f64 = 1.6;
const TRIES: usize = 6;

/// What lies over itself in the drawings of a layer.
#[derive(Debug)]
pub(super) struct Overlapping {
    /// The pose that is open.
    template: usize,
    guide: RegistrationGuide,
    /// All outlines matched to the template's as far as they can be.
    pub(super) matched: Matched,
    /// By pose, how it lies over itself; `None` of those that are mapped as ever.
    poses: Vec<Option<Overlap>>,
}

/// What of a layer's drawings lies over itself; `None` if nothing does.
pub(super) fn found(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
    known: &Known,
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
    let shorter: Vec<usize> = (0..lengths.len())
        .filter(|pose| (MUCH_SHORTER..SHORTER).contains(&(lengths[*pose] / lengths[template])))
        .collect();
    if shorter.is_empty() {
        return Ok(None);
    }
    let appearances = appearances(drawings);
    if !appearances[template].is_drawn() {
        return Ok(None);
    }
    let mut outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    let options = MatchOptions {
        reference: Some(template),
        ..MatchOptions::default()
    };
    let names = layer.names();
    let matched = match_by_drawing(&names, drawings, &mut outlines, &appearances, known, None, options);
    // What cannot be matched at all is refused by the ordinary way, which says why.
    let Ok((matched, mut guide)) = matched else {
        return Ok(None);
    };
    guide.registration.find_limbs();
    let sought: Vec<Option<FoundLimbs>> = (shorter.par_iter())
        .map(|&pose| {
            if !appearances[pose].is_drawn() {
                return None;
            }
            // Where nothing can be compared, the ordinary way says why.
            guide.registration.seek_limbs(pose).ok().flatten()
        })
        .collect();
    let mut poses: Vec<Option<Overlap>> = vec![None; drawings.len()];
    for (pose, found) in shorter.into_iter().zip(sought) {
        let lies_over = |found: &FoundLimbs| {
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
        template,
        guide,
        matched,
        poses,
    }))
}

/// The length of the outer ring over the root of its area.
fn relative_length(outline: &Outline) -> f64 {
    ArcLength::new(outline.outer()).perimeter() / outline.outer().signed_area().abs().sqrt().max(f64::MIN_POSITIVE)
}

impl Overlapping {
    /// The poses that do not lie over themselves.
    pub(super) fn open(&self) -> Vec<usize> {
        (0..self.poses.len())
            .filter(|pose| self.poses[*pose].is_none())
            .collect()
    }

    /// Where the template's places are in the other poses.
    pub(super) fn guide(&self) -> &RegistrationGuide {
        &self.guide
    }

    /// The mapping of all poses from that of the open ones, which has them in order.
    pub(super) fn completed(
        &self,
        names: &[String],
        mut outlines: Vec<Outline>,
        open: &Mapping,
    ) -> Result<Mapping, PipelineError> {
        let kept = self.open();
        // Their holes are in the order of the mesh's rings.
        for (pose, outline) in kept.iter().zip(&open.outlines) {
            outlines[*pose] = outline.clone();
        }
        let refusal = |pose: usize, message: String| PipelineError::stage(names, Some(pose), message);
        let template = kept.iter().position(|pose| *pose == self.template).unwrap_or(0);
        let topology = open.poses.topology();
        let reference = &open.poses.positions()[template];
        let positions: Vec<Vec<Point>> = (0..names.len())
            .into_par_iter()
            .map(|pose| match kept.iter().position(|kept| *kept == pose) {
                Some(number) => Ok(open.poses.positions()[number].clone()),
                None => {
                    let wanted: Vec<(Point, f64)> = (reference.iter())
                        .map(|p| {
                            let place = self.guide.carried(pose, *p).unwrap_or(*p);
                            (place, self.guide.trust(pose, *p))
                        })
                        .collect();
                    let beginning = bent(topology, reference, &wanted);
                    let placed = follow(topology, reference, beginning, &wanted);
                    validity::check_immersion(topology, &placed, &open.rings)
                        .map_err(|error| refusal(pose, error.to_string()))?;
                    Ok(placed)
                }
            })
            .collect::<Result<_, PipelineError>>()?;
        let rows = open.matching.outer.rows().iter().map(|row| {
            let of_template = row[template];
            let parameter = |pose: usize| match kept.iter().position(|kept| *kept == pose) {
                Some(number) => row[number],
                // Part of the boundary is hidden: the template's stands for it.
                None => of_template,
            };
            (0..names.len()).map(parameter).collect()
        });
        let outer = Correspondence::new(rows.collect()).map_err(|error| PipelineError::stage(names, None, error))?;
        Ok(Mapping {
            overlaps: self.overlaps(topology.triangles(), reference),
            poses: PoseSet::new(topology.clone(), names.iter().cloned().zip(positions).collect())
                .map_err(|error| PipelineError::stage(names, None, error))?,
            outlines,
            rings: open.rings.clone(),
            steiner: open.steiner,
            matching: Matching {
                reference: self.template,
                outer,
            },
        })
    }

    /// The poses whose figure is not what `mapping` covers of it: what was found there is not enough.
    pub(super) fn uncovered(&self, mapping: &Mapping) -> Vec<usize> {
        let is_uncovered = |pose: &usize| {
            self.poses[*pose].is_some()
                && cover(
                    mapping.poses.topology().triangles(),
                    &mapping.poses.positions()[*pose],
                    &mapping.outlines[*pose],
                ) < LEAST_COVER
        };
        (0..self.poses.len()).filter(is_uncovered).collect()
    }

    /// The same without some poses, which are then mapped as ever; `None` if that leaves none.
    pub(super) fn without(mut self, poses: &[usize]) -> Option<Self> {
        for pose in poses {
            self.poses[*pose] = None;
        }
        self.poses.iter().any(Option::is_some).then_some(self)
    }

    /// Depths and limbs of triangles, which are at `reference` in the template.
    fn overlaps(&self, triangles: &[[usize; 3]], reference: &[Point]) -> Overlaps {
        let registration = &self.guide.registration;
        let part_of: Vec<usize> = (triangles.iter())
            .map(|triangle| {
                let middle = triangle.iter().map(|v| reference[*v]).sum::<Point>() / 3.0;
                registration.part_at(middle).unwrap_or(0)
            })
            .collect();
        // One of two triangles of one part is nearer, too, where it lies over itself.
        let share = 0.5 / triangles.len().max(1) as f64;
        let depth_of = |overlap: &Overlap| -> Vec<f64> {
            let ranks = part_of
                .iter()
                .map(|part| overlap.ranks.get(*part).copied().unwrap_or(0));
            ranks
                .enumerate()
                .map(|(t, rank)| rank as f64 + t as f64 * share)
                .collect()
        };
        let poses = self.poses.iter().enumerate().filter_map(|(pose, overlap)| {
            Some(OverlappingPose {
                pose,
                depth: depth_of(overlap.as_ref()?),
            })
        });
        let poses = poses.collect();
        let limb_of_parts = registration.limb_of_parts();
        // Limbs that bend are several: each of their parts moves by itself.
        let mut names = Vec::new();
        let mut number_of = vec![None; limb_of_parts.len()];
        let mut pieces = vec![0; limb_of_parts.len()];
        for (part, limb) in limb_of_parts.iter().enumerate() {
            if let Some(limb) = limb {
                pieces[*limb] += 1;
                number_of[part] = Some(names.len());
                names.push(format!("limb {}.{}", limb + 1, pieces[*limb]));
            }
        }
        Overlaps {
            poses,
            limbs: names,
            triangle_limb: if number_of.iter().all(Option::is_none) {
                Vec::new()
            } else {
                part_of
                    .iter()
                    .map(|part| number_of.get(*part).copied().flatten())
                    .collect()
            },
        }
    }
}

/// What the union of some triangles and the inside of an outline, less its openings, have in common, of what either has.
fn cover(triangles: &[[usize; 3]], positions: &[Point], outline: &Outline) -> f64 {
    let points = positions.iter().chain(outline.outer().points());
    let Some((low, high)) = point::bounding_box(points) else {
        return 0.0;
    };
    let side = (high - low).norm() / COVER_CELLS;
    if side.is_nan() || side <= 0.0 {
        return 0.0;
    }
    // Casts saturate; both are at most the diagonal's.
    let size = [high.x - low.x, high.y - low.y].map(|length| (length / side) as usize + 1);
    let place = |p: Point| (p - low) / side;
    let mut is_covered = vec![false; size[0] * size[1]];
    for triangle in triangles {
        for_each_cell(triangle.map(|v| place(positions[v])), size, |cell, _| {
            is_covered[cell] = true
        });
    }
    let rings = outline.rings().iter().chain(outline.openings());
    let rings: Vec<Vec<Point>> = rings
        .map(|ring| ring.points().iter().map(|p| place(*p)).collect())
        .collect();
    let figure = Coverage::of(rings.iter().map(Vec::as_slice), size[0], size[1]);
    let (mut both, mut either) = (0usize, 0usize);
    for (is_covered, area) in is_covered.into_iter().zip(figure.areas()) {
        both += usize::from(is_covered && *area >= 0.5);
        either += usize::from(is_covered || *area >= 0.5);
    }
    both as f64 / either.max(1) as f64
}

/// The mesh bent to where its vertices are wanted, as far as can be without inverting a triangle.
fn bent(topology: &crate::mesh::Topology, reference: &[Point], wanted: &[(Point, f64)]) -> Vec<Point> {
    let mut apart = HANDLES_APART * point::diagonal(reference);
    for _ in 0..TRIES {
        // The surest first; then each one that is far enough from those before it.
        let mut order: Vec<usize> = (0..reference.len()).collect();
        order.sort_by(|a, b| wanted[*b].1.total_cmp(&wanted[*a].1).then(a.cmp(b)));
        let mut handles: Vec<usize> = Vec::new();
        for v in order {
            if handles
                .iter()
                .all(|other| (reference[*other] - reference[v]).norm() > apart)
            {
                handles.push(v);
            }
        }
        let from: Vec<Point> = handles.iter().map(|v| reference[*v]).collect();
        let to: Vec<Point> = handles.iter().map(|v| wanted[*v].0).collect();
        let mut positions = Vec::new();
        let dragged = HandleDeformation::new(topology, reference, &from)
            .and_then(|deformation| deformation.drag(&to, &mut deformation.scratch(), &mut positions));
        if dragged.is_ok() {
            return positions;
        }
        apart *= FURTHER;
    }
    // Moved as a whole.
    let count = reference.len().max(1) as f64;
    let (from, to) = (
        reference.iter().sum::<Point>() / count,
        wanted.iter().map(|(place, _)| place).sum::<Point>() / count,
    );
    let turn: Point = (reference.iter().zip(wanted))
        .map(|(p, (q, _))| Point::new((p - from).dot(&(q - to)), point::cross(p - from, q - to)))
        .sum();
    let frame = rotation(crate::math::angle::between(Point::new(1.0, 0.0), turn));
    reference.iter().map(|p| to + frame * (p - from)).collect()
}
