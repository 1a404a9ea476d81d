//! The thin-plate energy, minimised over smooth piecewise cubics.
//!
//! Energy: the integral over the plane of `|second derivatives|^2 + weight |gradient|^2`, free at the domain's border.
//! Unknowns are the value and gradient at each vertex of reduced Clough-Tocher elements, whose functions have
//! continuous gradients; the energy of each is exact. The elements conform, so the minimum converges from above to that
//! of the energy itself as the mesh is refined, however uneven its triangles are, and what is found is the function that
//! is later evaluated: nothing has to be recovered. Values at the poses are eliminated.

use std::collections::BTreeMap;

use super::WeightError;
use super::clough_tocher;
use super::surface::Jet;
use super::tessellation::Tessellation;
use crate::mesh::geometry;
use crate::solve::{SparseCholesky, Triplets};

/// Right-hand sides solved together.
const LANES: usize = 4;

/// The jets (#vertices x #poses) of the functions that are 1 at one of the first `pose_count` vertices and 0 at the
/// others.
pub(super) fn minimise(mesh: &Tessellation, pose_count: usize, gradient_weight: f64) -> Result<Vec<Jet>, WeightError> {
    let vertex_count = mesh.positions.len();
    // Gradients are solved for in units of the size around their vertex, which keeps the digits where triangles are small.
    let mut sizes = vec![0.0_f64; vertex_count];
    for &triangle in &mesh.triangles {
        let size = geometry::signed_area(geometry::corners(&mesh.positions, triangle)).sqrt();
        for vertex in triangle {
            sizes[vertex] = if sizes[vertex] == 0.0 {
                size
            } else {
                sizes[vertex].min(size)
            };
        }
    }
    // Unknown of each vertex's value, or beyond all unknowns at the poses; gradients follow.
    let free_values = vertex_count - pose_count;
    let unknown_count = free_values + 2 * vertex_count;
    let unknown = |vertex: usize, part: usize| match part {
        0 => vertex.checked_sub(pose_count).unwrap_or(usize::MAX),
        _ => free_values + 2 * vertex + part - 1,
    };
    let mut system = Triplets::new(unknown_count, unknown_count);
    let mut right = vec![vec![0.0; pose_count]; unknown_count];
    // Most triangles of a graded mesh are the same few, exactly.
    let mut forms = BTreeMap::new();
    for &triangle in &mesh.triangles {
        let corners = geometry::corners(&mesh.positions, triangle);
        let shape = geometry::edge_matrix(corners)
            .as_slice()
            .iter()
            .map(|x| x.to_bits())
            .collect::<Vec<_>>();
        let form = forms
            .entry(shape)
            .or_insert_with(|| clough_tocher::stiffness(corners, gradient_weight));
        let scale = |index: usize| match index % 3 {
            0 => 1.0,
            _ => sizes[triangle[index / 3]].recip(),
        };
        for (row, entries) in form.iter().enumerate() {
            let to = unknown(triangle[row / 3], row % 3);
            for (column, entry) in entries.iter().enumerate() {
                let from = unknown(triangle[column / 3], column % 3);
                let value = entry * scale(row) * scale(column);
                if from == usize::MAX && to != usize::MAX {
                    right[to][triangle[column / 3]] -= value;
                } else if to >= from {
                    // The lower triangle is all that is read; eliminated rows have no place.
                    system.add(to, from, value);
                }
            }
        }
    }
    let factor = SparseCholesky::new(&system.build())?;
    let mut jets = vec![[0.0; 3]; vertex_count * pose_count];
    let mut buffer = Vec::new();
    for first in (0..pose_count).step_by(LANES) {
        let poses = first..(first + LANES).min(pose_count);
        let mut lanes: Vec<[f64; LANES]> = right
            .iter()
            .map(|row| std::array::from_fn(|lane| row.get(first + lane).copied().unwrap_or(0.0)))
            .collect();
        factor.solve(&mut lanes, &mut buffer)?;
        for (lane, pose) in poses.enumerate() {
            for vertex in 0..vertex_count {
                let value = match vertex.checked_sub(pose_count) {
                    Some(unknown) => lanes[unknown][lane],
                    None => f64::from(u8::from(vertex == pose)),
                };
                jets[vertex * pose_count + pose] = [
                    value,
                    lanes[unknown(vertex, 1)][lane] / sizes[vertex],
                    lanes[unknown(vertex, 2)][lane] / sizes[vertex],
                ];
            }
        }
    }
    Ok(jets)
}
