//! The paper's energy: squared differences of the gradients of neighbouring triangles.
//!
//! Source: NWM 4.1, equations 1 and 2: the sum over pairs of triangles with a common edge of `|J_j - J_k|^2`, plus
//! `epsilon` times the sum over triangles of `|J_i|^2`, both unweighted as printed. It stands for second derivatives
//! only where triangles are even. The result is piecewise linear; for smooth evaluation each vertex takes the mean of
//! its triangles' gradients, weighted by area, which is linear in the data and keeps the values.
//!
//! Unknown `v` is the value at vertex `v`.

use super::tessellation::Tessellation;
use super::{WallProblem, WeightError};
use crate::math::Point;
use crate::mesh::{Topology, geometry};
use crate::solve::{Entry, Triplets};

/// The gradient at a vertex as a linear form: an unknown and what it is multiplied with.
pub(super) type GradientForm = Vec<(usize, Point)>;

/// The recovered gradient at each vertex.
pub(super) fn recovery(mesh: &Tessellation) -> Vec<GradientForm> {
    let mut forms = vec![GradientForm::new(); mesh.positions.len()];
    let mut areas = vec![0.0; mesh.positions.len()];
    for &triangle in &mesh.triangles {
        let corners = geometry::corners(&mesh.positions, triangle);
        let area = geometry::signed_area(corners);
        let Some(directions) = geometry::barycentric_gradients(corners) else {
            continue;
        };
        for vertex in triangle {
            areas[vertex] += area;
            for (unknown, direction) in triangle.into_iter().zip(directions) {
                match forms[vertex].iter_mut().find(|(known, _)| *known == unknown) {
                    Some((_, form)) => *form += direction * area,
                    None => forms[vertex].push((unknown, direction * area)),
                }
            }
        }
    }
    for (form, area) in forms.iter_mut().zip(areas) {
        for (_, direction) in form {
            *direction /= area;
        }
    }
    forms
}

/// The lower triangle of the energy's matrix; `epsilons` has one weight a triangle.
pub(super) fn energy(mesh: &Tessellation, epsilons: &[f64]) -> Result<Vec<Entry>, WeightError> {
    let vertex_count = mesh.positions.len();
    let topology = Topology::new(vertex_count, mesh.triangles.clone()).map_err(|_| WeightError::Wall {
        wall: 0,
        problem: WallProblem::Tangled,
    })?;
    let directions: Vec<[Point; 3]> = mesh
        .triangles
        .iter()
        .map(|&triangle| {
            geometry::barycentric_gradients(geometry::corners(&mesh.positions, triangle)).unwrap_or([Point::zeros(); 3])
        })
        .collect();
    // Rows of the least-squares problem, two (x and y) for each pair and each triangle.
    let pairs = topology.adjacent_triangles();
    let mut terms = Triplets::new(2 * (pairs.len() + mesh.triangles.len()), vertex_count);
    let mut add_gradient = |row: usize, triangle: usize, factor: f64| {
        for (&vertex, direction) in mesh.triangles[triangle].iter().zip(&directions[triangle]) {
            terms.add(2 * row, vertex, factor * direction.x);
            terms.add(2 * row + 1, vertex, factor * direction.y);
        }
    };
    for (row, &(first, second)) in pairs.iter().enumerate() {
        add_gradient(row, first, 1.0);
        add_gradient(row, second, -1.0);
    }
    for (triangle, epsilon) in epsilons.iter().enumerate() {
        add_gradient(pairs.len() + triangle, triangle, epsilon.sqrt());
    }
    let normal = terms.build().normal();
    Ok(normal.entries().filter(|(row, column, _)| row >= column).collect())
}
