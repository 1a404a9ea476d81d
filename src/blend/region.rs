//! Parts of the shape that are stiffer than others, or that may not be stretched far: painted around a vertex.
//!
//! A region is a disc on the mesh, measured along its edges: an arm that lies before the body in one pose is not painted
//! with it. Lengths are fractions of a pose's diagonal, averaged over the poses. Inside half the radius the paint is full, and
//! it fades smoothly to nothing at the radius; where regions overlap, stiffnesses multiply and the tightest limit holds.
//!
//! - Stiffness multiplies the triangle's share of the energy: where triangles want different things, the stiffer ones
//!   get more of what they want.
//! - A stretch limit `L` keeps what a triangle wants between the smallest and the largest stretch that it has in any
//!   pose, widened by the factor `L`. It holds in extrapolation, where stretches would grow without bound, and changes
//!   nothing at the poses.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::{BlendError, Region};
use crate::math::{point, smooth_step};
use crate::pose::PoseSet;

/// Where the paint starts to fade, as a fraction of the radius.
const FULL: f64 = 0.5;

/// What is painted on the triangles.
#[derive(Debug, Clone)]
pub(super) struct Paint {
    /// What the energy of each triangle is multiplied by.
    pub(super) stiffness: Vec<f64>,
    /// By how much each triangle may leave the stretches of its poses; infinite where nothing is painted.
    pub(super) limits: Vec<f64>,
}

impl Paint {
    /// Paints `regions`.
    ///
    /// # Errors
    /// [`BlendError::NoSuchVertex`] or [`BlendError::BadOption`].
    pub(super) fn new(poses: &PoseSet, regions: &[Region]) -> Result<Self, BlendError> {
        let triangles = poses.topology().triangles();
        let mut paint = Self {
            stiffness: vec![1.0; triangles.len()],
            limits: vec![f64::INFINITY; triangles.len()],
        };
        if regions.is_empty() {
            return Ok(paint);
        }
        let edges = mean_edges(poses);
        for region in regions {
            check(poses, region)?;
            let distances = distances(&edges, region.point);
            for (t, triangle) in triangles.iter().enumerate() {
                let away = triangle.iter().map(|&vertex| distances[vertex]).sum::<f64>() / 3.0;
                let share = 1.0 - smooth_step(away, FULL * region.radius, region.radius);
                if share > 0.0 {
                    paint.stiffness[t] *= libm::pow(region.stiffness, share);
                    paint.limits[t] = paint.limits[t].min(libm::pow(region.stretch_limit, share.recip()));
                }
            }
        }
        Ok(paint)
    }
}

fn check(poses: &PoseSet, region: &Region) -> Result<(), BlendError> {
    let count = poses.topology().vertex_count();
    if region.point >= count {
        return Err(BlendError::NoSuchVertex {
            vertex: region.point,
            count,
        });
    }
    let refused = |option, value, must_be| Err(BlendError::BadOption { option, value, must_be });
    if !(region.radius > 0.0 && region.radius.is_finite()) {
        return refused("the radius of a region", region.radius, "a positive number");
    }
    if !(region.stiffness > 0.0 && region.stiffness.is_finite()) {
        return refused("the stiffness of a region", region.stiffness, "a positive number");
    }
    // Infinity is no limit, NaN is a mistake.
    if region.stretch_limit.is_nan() || region.stretch_limit < 1.0 {
        return refused("the stretch limit of a region", region.stretch_limit, "at least 1");
    }
    Ok(())
}

/// The neighbours of each vertex with the mean over the poses of how far they are, as fractions of the pose's diagonal.
fn mean_edges(poses: &PoseSet) -> Vec<Vec<(usize, f64)>> {
    let diagonals: Vec<f64> = poses.positions().iter().map(point::diagonal).collect();
    let length = |a: usize, b: usize| {
        let lengths = poses.positions().iter().zip(&diagonals);
        lengths
            .map(|(positions, diagonal)| (positions[a] - positions[b]).norm() / diagonal)
            .sum::<f64>()
            / diagonals.len() as f64
    };
    let mut edges = vec![Vec::new(); poses.topology().vertex_count()];
    for &[a, b, c] in poses.topology().triangles() {
        // An inner edge comes from both of its triangles, once in each direction.
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let away = length(from, to);
            edges[from].push((to, away));
            edges[to].push((from, away));
        }
    }
    edges
}

/// How far every vertex is from `start` along edges (Dijkstra).
fn distances(edges: &[Vec<(usize, f64)>], start: usize) -> Vec<f64> {
    let mut distances = vec![f64::INFINITY; edges.len()];
    distances[start] = 0.0;
    // Non-negative numbers are ordered as their bits are.
    let mut queue = BinaryHeap::from([Reverse((0_u64, start))]);
    while let Some(Reverse((bits, vertex))) = queue.pop() {
        if f64::from_bits(bits) > distances[vertex] {
            continue;
        }
        for &(next, length) in &edges[vertex] {
            let away = distances[vertex] + length;
            if away < distances[next] {
                distances[next] = away;
                queue.push(Reverse((away.to_bits(), next)));
            }
        }
    }
    distances
}
