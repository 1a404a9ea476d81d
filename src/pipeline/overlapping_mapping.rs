//! The mapping of a layer some of whose drawings lie over themselves.
//!
//! What lies over itself ([`Overlapping`]) -> the mapping of all poses.
//!
//! 1. The other drawings are mapped as ever.
//! 2. Their mesh is bent, as rigidly as possible, to where the limbs were found in the poses that lie over themselves, and follows them without inverting a triangle.
//! 3. Depths are those of the parts that triangles are in; landmarks are carried.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::boundaries::Boundaries;
use super::mapping::map_drawn;
use super::note::{Note, NoteKind};
use super::overlapping::Overlapping;
use super::spec::{LayerSpec, OverlapSearch};
use super::{MappingReport, OverlapMisfit, PipelineError, Stage};
use crate::compatible::{Guide, follow};
use crate::input::Drawing;
use crate::matching::Correspondence;
use crate::math::{Point, angle, for_each_cell, point, rotation};
use crate::mesh::{PointLocator, Topology, validity};
use crate::outline::Outline;
use crate::pose::{HandleDeformation, Mapping, Matching, MeshQuality, OverlappingPose, Overlaps, PoseSet};
use crate::registration::{Explained, Overlap};
use crate::render::coverage::Coverage;

/// The share of the tolerance that the outlines of figures have some of whose poses lie over themselves.
const OVERLAPPING_TOLERANCE: f64 = 0.3;

/// The mesh and the pose's figure have at least this much in common, of what either has: a limb that was not found leaves its place bare.
const LEAST_COVER: f64 = 0.931;
/// Cells along the diagonal that this is counted on.
const COVER_CELLS: f64 = 500.0;
/// What is missing is counted in squares of so many cells.
const SQUARE_CELLS: usize = 20;
/// How far off a landmark the mesh may stay at most, as a fraction of the diagonal.
const LANDMARK_OFF: f64 = 0.02;
/// The trust in the place of a vertex that an artist has marked: before all others.
const MARKED: f64 = 100.0;
/// Handles that bend the mesh are this far apart, as a fraction of the diagonal; where they contradict one another, further by this factor, so many times.
const HANDLES_APART: f64 = 0.05;
const FURTHER: f64 = 1.6;
const TRIES: usize = 6;

/// A mapping, what is known of it, and the outlines' part of it.
pub(super) type Mapped = (Mapping, MappingReport, Arc<Boundaries>);

/// Poses in which what was found is not enough for a mesh, and why.
pub(super) struct Unfit(pub(super) Vec<(usize, OverlapMisfit)>);

/// Maps a layer without copies some of whose drawings lie over themselves; `notes` are those that are known. Poses that the mesh cannot be brought onto, or does not
/// cover there, are named instead.
pub(super) fn map_overlapping(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
    overlapping: &Overlapping,
    mut notes: Vec<Note>,
    begins: &mut dyn FnMut(Stage),
) -> Result<Result<Mapped, Unfit>, PipelineError> {
    let names = layer.names();
    let kept = overlapping.open();
    // What is marked in the other poses alone has no place here.
    let mut open = layer.only(&kept).without_limbs().without_empty_marks();
    open.overlaps = OverlapSearch::Refuse;
    // What lies over something shows its own edge there: the mesh is held closer to it.
    open.mesh.simplify.tolerance *= OVERLAPPING_TOLERANCE;
    let open_drawings: Vec<Arc<Drawing>> = kept.iter().map(|pose| Arc::clone(&drawings[*pose])).collect();
    let (mapping, of_open, boundaries) = map_drawn(&open, &open_drawings, None, begins)?;
    notes.extend(
        of_open
            .notes
            .into_iter()
            .filter(|note| !matches!(note.kind, NoteKind::Drawing(_))),
    );
    let outlines = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    let whole = match overlapping.completed(&names, outlines, &mapping)? {
        Ok(whole) => whole,
        Err(unfit) => return Ok(Err(unfit)),
    };
    let uncovered = overlapping.uncovered(&whole);
    if !uncovered.is_empty() {
        return Ok(Err(Unfit(uncovered)));
    }
    let registration = &overlapping.guide.registration;
    let explained: Vec<Option<Explained>> = (0..names.len()).map(|pose| registration.explained(pose)).collect();
    let template = PointLocator::new(
        whole.poses.topology().triangles(),
        &whole.poses.positions()[overlapping.guide.reference],
    );
    let of_template = kept
        .iter()
        .position(|pose| *pose == overlapping.guide.reference)
        .unwrap_or(0);
    let mut landmarks = of_open.landmarks;
    for landmark in &mut landmarks {
        let carried = |pose: usize| match kept.iter().position(|kept| *kept == pose) {
            Some(number) => landmark.at[number].clone(),
            None => {
                let bound = landmark.at[of_template].iter().filter_map(|p| template.bind(*p));
                bound.map(|bound| bound.at(&whole.poses.positions()[pose])).collect()
            }
        };
        let at = (0..names.len()).map(carried).collect();
        let name = &landmark.name;
        let is_given = |pose: usize| {
            let point = layer
                .landmarks
                .iter()
                .any(|own| own.name == *name && own.at[pose].is_some());
            point
                || layer
                    .paths
                    .iter()
                    .any(|own| own.name == *name && own.at[pose].is_some())
        };
        let given = (0..names.len()).map(is_given).collect();
        (landmark.given, landmark.at) = (given, at);
    }
    let report = MappingReport {
        notes,
        matching: overlapping.matched.outer.clone(),
        explained,
        holes: overlapping.matched.holes.clone(),
        landmarks,
        quality: MeshQuality::of(&whole.poses),
        ..of_open
    };
    Ok(Ok((whole, report, boundaries)))
}

impl Overlapping {
    /// The mapping of all poses from that of the open ones, which has them in order.
    fn completed(
        &self,
        names: &[String],
        mut outlines: Vec<Outline>,
        open: &Mapping,
    ) -> Result<Result<Mapping, Unfit>, PipelineError> {
        let kept = self.open();
        // Their holes are in the order of the mesh's rings.
        for (pose, outline) in kept.iter().zip(&open.outlines) {
            outlines[*pose] = outline.clone();
        }
        let template = kept.iter().position(|pose| *pose == self.guide.reference).unwrap_or(0);
        let topology = open.poses.topology();
        let reference = &open.poses.positions()[template];
        let placed: Vec<Result<Vec<Point>, OverlapMisfit>> = (0..names.len())
            .into_par_iter()
            .map(|pose| match kept.iter().position(|kept| *kept == pose) {
                Some(number) => Ok(open.poses.positions()[number].clone()),
                None => {
                    let mut wanted: Vec<(Point, f64)> = (reference.iter())
                        .map(|p| {
                            let place = self.guide.carried(pose, *p).unwrap_or(*p);
                            (place, self.guide.trust(pose, *p))
                        })
                        .collect();
                    let marked: Vec<(usize, Point)> = (self.marked[pose].iter())
                        .filter_map(|[from, to]| Some((nearest(reference, *from)?, *to)))
                        .collect();
                    for &(v, to) in &marked {
                        wanted[v] = (to, MARKED);
                    }
                    let beginning = bent(topology, reference, &wanted);
                    let placed = follow(topology, reference, beginning, &wanted);
                    let off = LANDMARK_OFF * point::diagonal(&placed);
                    if let Some((_, at)) = marked.iter().find(|(v, to)| (placed[*v] - to).norm() >= off) {
                        return Err(OverlapMisfit::Mark { at: *at });
                    }
                    match validity::check_immersion(topology, &placed, &open.rings) {
                        Ok(()) => Ok(placed),
                        Err(_) => Err(OverlapMisfit::Fold),
                    }
                }
            })
            .collect();
        let unfit: Vec<(usize, OverlapMisfit)> = (placed.iter().enumerate())
            .filter_map(|(pose, placed)| Some((pose, *placed.as_ref().err()?)))
            .collect();
        if !unfit.is_empty() {
            return Ok(Err(Unfit(unfit)));
        }
        let positions = placed.into_iter().flatten();
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
        Ok(Ok(Mapping {
            overlaps: self.overlaps(topology.triangles(), reference),
            poses: PoseSet::new(topology.clone(), names.iter().cloned().zip(positions).collect())
                .map_err(|error| PipelineError::stage(names, None, error))?,
            outlines,
            rings: open.rings.clone(),
            steiner: open.steiner,
            matching: Matching {
                reference: self.guide.reference,
                outer,
            },
        }))
    }

    /// The poses whose figure is not what `mapping` covers of it: what was found there is not enough.
    fn uncovered(&self, mapping: &Mapping) -> Vec<(usize, OverlapMisfit)> {
        let misfit = |pose: usize| {
            self.poses[pose].as_ref()?;
            let (share, at) = cover(
                mapping.poses.topology().triangles(),
                &mapping.poses.positions()[pose],
                &mapping.outlines[pose],
            );
            let least = LEAST_COVER;
            (share < least).then_some((pose, OverlapMisfit::Cover { share, least, at }))
        };
        (0..self.poses.len()).filter_map(misfit).collect()
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
                names.push(format!("{}.{}", self.said.name(*limb), pieces[*limb]));
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

/// The vertex nearest to a place.
fn nearest(positions: &[Point], place: Point) -> Option<usize> {
    let away = |v: &usize| (positions[*v] - place).norm_squared();
    (0..positions.len()).min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// What the union of some triangles and the inside of an outline, less its openings, have in common, of what either has; and the middle of where most is missing.
fn cover(triangles: &[[usize; 3]], positions: &[Point], outline: &Outline) -> (f64, Point) {
    let points = positions.iter().chain(outline.outer().points());
    let Some((low, high)) = point::bounding_box(points) else {
        return (0.0, Point::zeros());
    };
    let side = (high - low).norm() / COVER_CELLS;
    if side.is_nan() || side <= 0.0 {
        return (0.0, low);
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
    // By square of cells, how many of them one has and the other has not, and the sum of their places.
    let mut missing: BTreeMap<[usize; 2], (usize, Point)> = BTreeMap::new();
    for (cell, (is_covered, area)) in is_covered.into_iter().zip(figure.areas()).enumerate() {
        let in_figure = *area >= 0.5;
        both += usize::from(is_covered && in_figure);
        either += usize::from(is_covered || in_figure);
        if is_covered != in_figure {
            let at = [cell % size[0], cell / size[0]];
            let square = missing.entry(at.map(|along| along / SQUARE_CELLS)).or_default();
            *square = (square.0 + 1, square.1 + Point::new(at[0] as f64, at[1] as f64));
        }
    }
    let most = missing.values().max_by_key(|(count, _)| *count);
    let at = most.map_or(Point::zeros(), |(count, sum)| sum / *count as f64);
    (both as f64 / either.max(1) as f64, low + at * side)
}

/// The mesh bent to where its vertices are wanted, as far as can be without inverting a triangle.
fn bent(topology: &Topology, reference: &[Point], wanted: &[(Point, f64)]) -> Vec<Point> {
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
        // What begins folded around a vertex stays so.
        if dragged.is_ok() && validity::first_winding(topology, &positions).is_none() {
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
    let pairs = reference.iter().zip(wanted);
    let frame = rotation(angle::best_turn(pairs.map(|(p, (q, _))| (p - from, q - to))));
    reference.iter().map(|p| to + frame * (p - from)).collect()
}
