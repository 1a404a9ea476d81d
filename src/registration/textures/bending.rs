//! A warp held so smooth that no triangle turns over.

use super::surface::Surface;
use crate::math::{Matrix, Point};
use crate::mesh::geometry;

/// The largest stretch, as a share, that the warp may have in any direction. Two warps that keep this, and all between, leave every triangle positive.
const MOST_BENDING: f64 = 0.45;
/// Rounds in which triangles that bend more are made smoother, after which what is left of them is halved.
const ROUNDS: usize = 24;
const HALVINGS: usize = 16;

/// The displacements with the vertices of triangles that they bend too much moved towards the mean of their neighbours.
pub(super) fn limited(surface: &Surface, mut displacements: Vec<Point>) -> Vec<Point> {
    for round in 0..ROUNDS + HALVINGS {
        let mut is_bent = vec![false; displacements.len()];
        for triangle in &surface.triangles {
            if bending(surface, *triangle, &displacements) > MOST_BENDING {
                triangle.iter().for_each(|v| is_bent[*v] = true);
            }
        }
        if !is_bent.contains(&true) {
            return displacements;
        }
        displacements = (0..displacements.len())
            .map(|v| {
                if !is_bent[v] {
                    return displacements[v];
                }
                let around = &surface.neighbours[v];
                let sum: Point = around.iter().map(|w| displacements[*w]).sum();
                let mean = (displacements[v] + sum) / (1 + around.len()) as f64;
                if round < ROUNDS { mean } else { mean * 0.5 }
            })
            .collect();
    }
    // Slivers that nothing helps: there the mesh has the last word.
    vec![Point::zeros(); displacements.len()]
}

/// The largest singular value of the displacements' gradient in a triangle; infinite in one without area.
fn bending(surface: &Surface, triangle: [usize; 3], displacements: &[Point]) -> f64 {
    let [a, b, c] = geometry::corners(&surface.vertices, triangle);
    let [u, v, w] = geometry::corners(displacements, triangle);
    let still = u == v && v == w;
    match Matrix::from_columns(&[b - a, c - a]).try_inverse() {
        Some(inverse) => (Matrix::from_columns(&[v - u, w - u]) * inverse).singular_values()[0],
        None if still => 0.0,
        None => f64::INFINITY,
    }
}
