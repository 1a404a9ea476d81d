//! Rotation angles that fit together over a mesh, whatever number of turns it makes.
//!
//! Between two poses, a shared edge turns by some angle, and each of its two triangles turns by an angle that differs
//! from the edge's by less than a quarter turn: with `A = R S` and `S` positive, `e . R^-1 A e = e . S e > 0`. So
//! stepping from triangle to edge to neighbour and taking the nearest angle each time is right, with a margin of half
//! a turn against rounding. (The paper steps from triangle to triangle, where the margin vanishes for needles.)
//!
//! 1. The first triangle of each mesh component takes its angle in `(-pi, pi]`.
//! 2. Breadth first, each triangle takes the angle nearest to that of the edge it is reached through.
//! 3. Every edge is then checked: if its two triangles disagree about its angle, the walk does not close.
//!
//! The edge's own angle is computed only where it decides: the two triangles differ by less than half a turn, so
//! where rounding to the neighbour leaves a margin (`CLEAR_RAD`), both ways agree.
//!
//! From a pose to a reference triangle that is no pose, stepping would be wrong: neighbouring references need not
//! share a direction. There the angles are lifted through the pose-to-pose angles ([`lift`]).

use std::collections::VecDeque;

use super::BlendError;
use super::reference::pose_edges;
use crate::math::{PolarSplit, angle};
use crate::mesh::directed_edges;
use crate::pose::PoseSet;

/// Two neighbouring triangles whose angles, rounded to one another, differ by less than this need no look at the edge
/// between them: the true difference is below pi, and rounding errors are below 1e-12.
const CLEAR_RAD: f64 = 3.0;

/// The consistent rotation of each triangle from pose `from` to pose `to`, in radians.
///
/// # Errors
/// [`BlendError::NotPositive`] for a triangle without area, [`BlendError::NotClosed`] if no consistent angles exist.
pub(super) fn pose_to_pose(poses: &PoseSet, from: usize, to: usize) -> Result<Vec<f64>, BlendError> {
    let (start, end) = (&poses.positions()[from], &poses.positions()[to]);
    let mut angles_rad = Vec::with_capacity(poses.topology().triangles().len());
    for (triangle, (edges, image)) in pose_edges(poses, start).iter().zip(pose_edges(poses, end)).enumerate() {
        let inverse = edges.try_inverse().ok_or_else(|| BlendError::NotPositive {
            pose: poses.names()[from].clone(),
            triangle,
        })?;
        angles_rad.push(PolarSplit::angle_rad_of(&(image * inverse)));
    }

    let topology = poses.topology();
    let edge_turn_rad = |triangle: usize, corner: usize| {
        let (a, b) = directed_edges(topology.triangles()[triangle])[corner];
        angle::between(start[b] - start[a], end[b] - end[a])
    };
    // The angle that `neighbour` has beside `triangle`, which it touches along the edge of `corner`.
    let beside = |angles_rad: &[f64], triangle: usize, corner: usize, neighbour: usize| {
        let near_rad = angle::nearest_turn(angles_rad[neighbour], angles_rad[triangle]);
        if (near_rad - angles_rad[triangle]).abs() < CLEAR_RAD {
            return near_rad;
        }
        let edge_rad = angle::nearest_turn(edge_turn_rad(triangle, corner), angles_rad[triangle]);
        angle::nearest_turn(angles_rad[neighbour], edge_rad)
    };
    let mut reached = vec![false; angles_rad.len()];
    let mut queue = VecDeque::new();
    for seed in 0..angles_rad.len() {
        if std::mem::replace(&mut reached[seed], true) {
            continue;
        }
        queue.push_back(seed);
        while let Some(triangle) = queue.pop_front() {
            for (corner, neighbour) in topology.neighbours()[triangle].iter().enumerate() {
                let Some(neighbour) = *neighbour else { continue };
                if !std::mem::replace(&mut reached[neighbour], true) {
                    angles_rad[neighbour] = beside(&angles_rad, triangle, corner, neighbour);
                    queue.push_back(neighbour);
                }
            }
        }
    }

    for (triangle, neighbours) in topology.neighbours().iter().enumerate() {
        for (corner, neighbour) in neighbours.iter().enumerate() {
            let Some(neighbour) = *neighbour else { continue };
            // It is the same angle or at least a whole turn away.
            let away_rad = beside(&angles_rad, triangle, corner, neighbour) - angles_rad[neighbour];
            if away_rad.abs() > std::f64::consts::PI {
                return Err(BlendError::NotClosed {
                    pose: poses.names()[to].clone(),
                    first: triangle.min(neighbour),
                    second: triangle.max(neighbour),
                });
            }
        }
    }
    Ok(angles_rad)
}

/// The angle of `split` (reference to pose `i`) nearest to `near_rad`: the reference's angle to the pivot pose plus the
/// angle from there to pose `i`, consistent over the mesh. The two ways differ by less than a quarter turn:
/// `R_i S_i (R_p S_p)^-1` turns by the angle of `R_i R_p^-1` but for the rotation in the product of two stretches.
#[must_use]
pub(super) fn lift(split: &PolarSplit, near_rad: f64) -> f64 {
    angle::nearest_turn(split.angle_rad, near_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;
    use crate::mesh::Topology;

    /// A strip of `columns` quads, and the ring of quads that it is wound into.
    fn ring(columns: usize, turns: f64) -> (Topology, Vec<Point>) {
        let circle = |r: f64| {
            (0..columns).map(move |i| {
                let angle = std::f64::consts::TAU * turns * i as f64 / columns as f64;
                Point::new(r * angle.cos(), r * angle.sin())
            })
        };
        let triangles = (0..columns)
            .flat_map(|i| {
                let j = (i + 1) % columns;
                [[i, columns + i, columns + j], [i, columns + j, j]]
            })
            .collect();
        let topology = Topology::new(2 * columns, triangles).expect("a mesh");
        (topology, circle(1.0).chain(circle(2.0)).collect())
    }

    #[test]
    fn a_ring_that_winds_twice_does_not_close() {
        let (topology, once) = ring(24, 1.0);
        let (_, twice) = ring(24, 2.0);
        let poses = PoseSet::new(
            topology,
            vec![
                ("once".into(), once.clone()),
                ("twice".into(), twice),
                ("turned".into(), {
                    once.iter().map(|p| crate::math::rotation(2.0) * p).collect()
                }),
            ],
        )
        .expect("poses");
        let error = pose_to_pose(&poses, 0, 1).expect_err("it winds twice");
        assert!(
            matches!(&error, BlendError::NotClosed { pose, .. } if pose == "twice"),
            "{error}"
        );
        let angles = pose_to_pose(&poses, 0, 2).expect("a turned copy");
        assert!(angles.iter().all(|angle| (angle - 2.0).abs() < 1e-12));
    }
}
