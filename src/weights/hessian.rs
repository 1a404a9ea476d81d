//! The thin-plate energy on smooth piecewise cubics.
//!
//! Energy: half the integral over the plane of `|second derivatives|^2 + weight |gradient|^2`, free at the domain's border.
//! Unknowns are the value and gradient at each vertex of reduced Clough-Tocher elements, whose functions have
//! continuous gradients; the energy of each is exact. The elements conform, so the minimum converges from above to that
//! of the energy itself as the mesh is refined, however uneven its triangles are, and what is found is the function that
//! is later evaluated: nothing has to be recovered.
//!
//! Unknown `3 v + k` is the value (0), or the derivative along x or y (1, 2) times a length of the mesh, of vertex `v`.

use std::collections::BTreeMap;

use super::clough_tocher;
use super::tessellation::Tessellation;
use crate::mesh::geometry;
use crate::solve::Entry;

/// The size of the smallest triangle around each vertex. Gradients are solved for in this unit, which keeps the digits
/// where triangles are small.
pub(super) fn sizes(mesh: &Tessellation) -> Vec<f64> {
    let mut sizes = vec![f64::INFINITY; mesh.positions.len()];
    for &triangle in &mesh.triangles {
        let size = geometry::signed_area(geometry::corners(&mesh.positions, triangle)).sqrt();
        for vertex in triangle {
            sizes[vertex] = sizes[vertex].min(size);
        }
    }
    sizes
}

/// The lower triangle of the energy's matrix; `gradient_weights` has one weight a triangle.
pub(super) fn energy(mesh: &Tessellation, sizes: &[f64], gradient_weights: &[f64]) -> Vec<Entry> {
    let mut entries = Vec::with_capacity(45 * mesh.triangles.len());
    // Most triangles of a graded mesh are the same few, exactly.
    let mut forms = BTreeMap::new();
    for (&triangle, gradient_weight) in mesh.triangles.iter().zip(gradient_weights) {
        let corners = geometry::corners(&mesh.positions, triangle);
        let edges = geometry::edge_matrix(corners);
        let shape: [u64; 4] = std::array::from_fn(|k| edges.as_slice()[k].to_bits());
        let form = forms.entry(shape).or_insert_with(|| clough_tocher::stiffness(corners));
        for row in 0..9 {
            for column in 0..9 {
                let to = 3 * triangle[row / 3] + row % 3;
                let from = 3 * triangle[column / 3] + column % 3;
                if to >= from {
                    let scale = |vertex: usize, k: usize| if k.is_multiple_of(3) { 1.0 } else { sizes[vertex] };
                    let value = form.bend[row][column] + gradient_weight * form.slope[row][column];
                    let unit = scale(triangle[row / 3], row) * scale(triangle[column / 3], column);
                    entries.push((to, from, value / unit));
                }
            }
        }
    }
    entries
}
