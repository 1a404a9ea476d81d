//! Deformed copies become poses of the mapping (NWM 3.2).
//!
//! 1. The drawn poses are mapped without the copies.
//! 2. Each copy, after the pose that it is a copy of: its handles deform that pose's mesh; the result is proven to be an
//!    embedding.
//! 3. Outline, landmarks and correspondence are carried by the mesh: the copy is not matched.
//!
//! Handles are given in the coordinates of the drawing as it is in its file, and are reflected with it where the pose that
//! it belongs to says `mirror = true`.

use rayon::prelude::*;

use super::landmarks::as_used;
use super::spec::{DeformedCopy, HandleMove, LayerSpec, PoseShape, PoseSpec, ShrunkCopy};
use super::{MappingReport, PipelineError};
use crate::matching::{Correspondence, PoseMatch, SalientPoint};
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::mesh::PointLocator;
use crate::mesh::validity::{self, ValidityError};
use crate::outline::{Outline, OutlineError};
use crate::pose::{
    CarriedOutline, DragReport, HandleDeformation, HandleError, Mapping, Matching, MeshQuality, OverlappingPose,
    PoseSet,
};

/// How large a layer is in a pose that lacks it: far below a pixel, and far above rounding.
const SHRUNK: f64 = 1e-3;

/// How a deformed copy came about.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct DeformedPose {
    /// Which pose it is.
    pub pose: usize,
    /// Which pose it is a copy of.
    pub of: usize,
    /// How its handles were dragged.
    pub drag: DragReport,
}

/// A pose of the whole layer while it is put together.
struct Pose {
    positions: Vec<Point>,
    outline: Outline,
    /// Per row of the correspondence.
    parameters: Vec<f64>,
    /// Per landmark.
    landmarks: Vec<Vec<Point>>,
    matched: PoseMatch,
}

/// The mapping of all poses of `layer` from that of the drawn ones; `report` is completed.
pub(super) fn with_copies(
    layer: &LayerSpec,
    drawn: Mapping,
    report: &mut MappingReport,
) -> Result<Mapping, PipelineError> {
    let order = layer.drawn_poses();
    if order.len() == layer.poses.len() {
        return Ok(drawn);
    }
    let names = layer.names();
    let mut poses: Vec<Option<Pose>> = (0..names.len()).map(|_| None).collect();
    for (k, &pose) in order.iter().enumerate() {
        poses[pose] = Some(Pose {
            positions: drawn.poses.positions()[k].clone(),
            outline: drawn.outlines[k].clone(),
            parameters: drawn.matching.outer.rows().iter().map(|row| row[k]).collect(),
            landmarks: report.landmarks.iter().map(|landmark| landmark.at[k].clone()).collect(),
            matched: report.matching.poses[k].clone(),
        });
    }
    // Copies of copies need a round each; a valid layer has no circle.
    for _ in 0..names.len() {
        let ready = |(pose, said): (usize, &PoseSpec)| {
            let of = match &said.shape {
                PoseShape::Drawn(_) => return None,
                PoseShape::Deformed(copy) => copy.of,
                PoseShape::Shrunk(copy) => copy.of,
            };
            let base = poses[of].as_ref().filter(|_| poses[pose].is_none())?;
            Some((pose, of, said.shape.clone(), base))
        };
        let round: Vec<_> = layer.poses.iter().enumerate().filter_map(ready).collect();
        let made: Vec<_> = (round.into_par_iter())
            .map(|(pose, of, shape, base)| {
                let made = match &shape {
                    PoseShape::Shrunk(copy) => shrunk(layer, pose, copy, base).map(|made| (made, None)),
                    PoseShape::Deformed(copy) => {
                        let made = deformed(layer, &drawn, pose, copy, base);
                        made.map(|(made, drag)| (made, Some(drag)))
                    }
                    PoseShape::Drawn(_) => Err(PipelineError::stage(&names, Some(pose), "it is no copy")),
                };
                (pose, of, made)
            })
            .collect();
        for (pose, of, made) in made {
            let (deformed, drag) = made?;
            report.deformed.extend(drag.map(|drag| DeformedPose { pose, of, drag }));
            poses[pose] = Some(deformed);
        }
    }
    report.deformed.sort_by_key(|deformed| deformed.pose);
    let poses: Vec<Pose> = poses
        .into_iter()
        .collect::<Option<_>>()
        .ok_or_else(|| PipelineError::stage(&[], None, "a pose is a deformed copy of itself"))?;
    // By pose, its place among those that are drawn.
    let drawn_at: Vec<Option<usize>> = (0..poses.len())
        .map(|pose| order.iter().position(|&p| p == pose))
        .collect();
    for (k, landmark) in report.landmarks.iter_mut().enumerate() {
        let given = drawn_at
            .iter()
            .map(|at| at.is_some_and(|at| landmark.given[at]))
            .collect();
        landmark.given = given;
        landmark.at = poses.iter().map(|pose| pose.landmarks[k].clone()).collect();
    }
    report.explained = drawn_at.iter().map(|at| report.explained[(*at)?]).collect();
    report.matching.poses = poses.iter().map(|pose| pose.matched.clone()).collect();
    let rows = drawn.matching.outer.rows().len();
    let rows = (0..rows)
        .map(|row| poses.iter().map(|pose| pose.parameters[row]).collect())
        .collect();
    let (positions, outlines): (Vec<_>, Vec<_>) = poses.into_iter().map(|pose| (pose.positions, pose.outline)).unzip();
    let mut overlaps = drawn.overlaps;
    // A copy of a pose that lies over itself does so, too.
    let known = std::mem::take(&mut overlaps.poses);
    let of_copy = |(pose, of): (usize, usize)| {
        let own = known.iter().find(|own| order[own.pose] == of)?;
        Some(OverlappingPose {
            pose,
            depth: own.depth.clone(),
        })
    };
    overlaps.poses = layer.originals().into_iter().enumerate().filter_map(of_copy).collect();
    let whole = Mapping {
        overlaps,
        poses: PoseSet::new(
            drawn.poses.topology().clone(),
            names.iter().cloned().zip(positions).collect(),
        )
        .map_err(|error| PipelineError::stage(&names, None, error))?,
        outlines,
        rings: drawn.rings,
        steiner: drawn.steiner,
        matching: Matching {
            reference: order[drawn.matching.reference],
            outer: Correspondence::new(rows).map_err(|error| PipelineError::stage(&names, None, error))?,
        },
    };
    report.quality = MeshQuality::of(&whole.poses);
    Ok(whole)
}

/// A pose shrunk to almost a point.
fn shrunk(layer: &LayerSpec, pose: usize, copy: &ShrunkCopy, base: &Pose) -> Result<Pose, PipelineError> {
    let (low, high) = bounding_box(base.outline.outer().points()).unwrap_or_default();
    let middle = 0.5 * (low + high);
    let place = |p: Point| copy.to + (p - middle) * SHRUNK;
    Ok(Pose {
        positions: base.positions.iter().map(|&p| place(p)).collect(),
        outline: (base.outline.map(place)).map_err(|error| PipelineError::stage(&layer.names(), Some(pose), error))?,
        parameters: base.parameters.clone(),
        landmarks: (base.landmarks.iter())
            .map(|points| points.iter().map(|&p| place(p)).collect())
            .collect(),
        matched: PoseMatch {
            cost: 0.0,
            mismatch: vec![0.0; base.matched.mismatch.len()],
            looks_mirrored: false,
            reflection_ratio: 1.0,
            ..base.matched.clone()
        },
    })
}

fn deformed(
    layer: &LayerSpec,
    drawn: &Mapping,
    pose: usize,
    copy: &DeformedCopy,
    base: &Pose,
) -> Result<(Pose, DragReport), PipelineError> {
    let name = || layer.poses[pose].name.clone();
    let refusal = |message: String| PipelineError::Deformation {
        pose: name(),
        of: layer.poses[copy.of].name.clone(),
        message,
    };
    let drawing = (layer.drawing_of(pose)).and_then(|(root, _)| layer.drawn_poses().iter().position(|&p| p == root));
    let drawing = drawing.ok_or_else(|| refusal("it has no drawing".to_owned()))?;
    let ends = |end: fn(&HandleMove) -> Point| -> Vec<Point> {
        copy.handles
            .iter()
            .map(|handle| as_used(layer, drawing, end(handle)))
            .collect()
    };
    let (mut from, mut to) = (ends(|handle| handle.from), ends(|handle| handle.to));
    if from.is_empty() {
        // A layer that stays as it is while others move.
        from.extend(base.positions.first());
        to.clone_from(&from);
    }
    let topology = drawn.poses.topology();
    let mut positions = Vec::new();
    let drag = HandleDeformation::new(topology, &base.positions, &from)
        .and_then(|deformation| deformation.drag(&to, &mut deformation.scratch(), &mut positions))
        .map_err(|error: HandleError| refusal(error.to_string()))?;
    let lies_over = drawn.overlaps.depth(drawing).is_some();
    let is_valid = if lies_over {
        validity::check_immersion(topology, &positions, &drawn.rings)
    } else {
        validity::check_embedding(topology, &positions, &drawn.rings)
    };
    is_valid.map_err(|error| refusal(overlap(&error, &to)))?;
    // Of one that lies over itself the outline is what is seen of the drawing.
    let carried = if lies_over {
        None
    } else {
        let carried = CarriedOutline::new(topology, &base.positions, &positions, &base.outline);
        Some(carried.map_err(|error| refusal(error.to_string()))?)
    };
    let parameter = |t: f64| carried.as_ref().map_or(t, |carried| carried.parameter(0, t));
    let locator = PointLocator::new(topology.triangles(), &base.positions);
    let carry = |p: &Point| -> Point { locator.bind(*p).map_or(*p, |bound| bound.at(&positions)) };
    let landmarks = base
        .landmarks
        .iter()
        .map(|points| points.iter().map(carry).collect())
        .collect();
    // Nothing was matched, so nothing is doubtful.
    let matched = PoseMatch {
        cost: 0.0,
        mismatch: vec![0.0; base.matched.mismatch.len()],
        looks_mirrored: false,
        reflection_ratio: 1.0,
        salient: (base.matched.salient.iter())
            .map(|salient| SalientPoint {
                parameter: parameter(salient.parameter),
                ..*salient
            })
            .collect(),
        landmarks: base.matched.landmarks.clone(),
    };
    let whole = Pose {
        parameters: base.parameters.iter().map(|&t| parameter(t)).collect(),
        outline: carried.map_or_else(|| base.outline.clone(), |carried| carried.outline),
        positions,
        landmarks,
        matched,
    };
    Ok((whole, drag))
}

/// What is wrong with a deformed mesh, and what would help.
fn overlap(error: &ValidityError, targets: &[Point]) -> String {
    let ValidityError::BoundaryNotSimple(OutlineError::EdgesMeet { x, y, .. }) = error else {
        return format!("{error}; drag the handles less far");
    };
    let place = Point::new(*x, *y);
    let distance = |handle: &usize| (targets[*handle] - place).norm();
    let nearest = (0..targets.len())
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0);
    format!(
        "parts of the shape come to lie over one another near ({x:.1}, {y:.1}); drag handle {nearest}, the nearest, so that they stay apart"
    )
}
