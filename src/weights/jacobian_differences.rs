//! The paper's energy: squared differences of the gradients of neighbouring triangles.
//!
//! Source: NWM 4.1, equations 1 and 2: the sum over pairs of triangles with a common edge of `|J_j - J_k|^2`, plus
//! `epsilon` times the sum over triangles of `|J_i|^2`, both unweighted as printed. It stands for second derivatives
//! only where triangles are even. The result is piecewise linear; for smooth evaluation each vertex takes the mean of
//! its triangles' gradients, weighted by area, which is linear in the data and keeps the values.

use super::WeightError;
use super::surface::Jet;
use super::tessellation::Tessellation;
use crate::math::Point;
use crate::mesh::{Topology, geometry};
use crate::solve::{SparseCholesky, Triplets};

/// The jets (#vertices x #poses) of the functions that are 1 at one of the first `pose_count` vertices and 0 at the
/// others.
pub(super) fn minimise(mesh: &Tessellation, pose_count: usize, epsilon: f64) -> Result<Vec<Jet>, WeightError> {
    let values = vertex_values(mesh, pose_count, epsilon)?;
    let vertex_count = mesh.positions.len();
    let mut jets = vec![[0.0; 3]; vertex_count * pose_count];
    let mut areas = vec![0.0; vertex_count];
    for &triangle in &mesh.triangles {
        let corners = geometry::corners(&mesh.positions, triangle);
        let area = geometry::signed_area(corners);
        let Some(directions) = geometry::barycentric_gradients(corners) else {
            continue;
        };
        for vertex in triangle {
            areas[vertex] += area;
        }
        for pose in 0..pose_count {
            let gradient: Point = triangle
                .iter()
                .zip(directions)
                .map(|(&vertex, direction)| direction * values[vertex * pose_count + pose])
                .sum();
            for vertex in triangle {
                let jet = &mut jets[vertex * pose_count + pose];
                jet[1] += area * gradient.x;
                jet[2] += area * gradient.y;
            }
        }
    }
    for (vertex, at_vertex) in jets.chunks_exact_mut(pose_count).enumerate() {
        for (jet, value) in at_vertex.iter_mut().zip(&values[vertex * pose_count..]) {
            *jet = [*value, jet[1] / areas[vertex], jet[2] / areas[vertex]];
        }
    }
    Ok(jets)
}

/// The minimiser's values, #vertices x #poses.
fn vertex_values(mesh: &Tessellation, pose_count: usize, epsilon: f64) -> Result<Vec<f64>, WeightError> {
    let vertex_count = mesh.positions.len();
    let Ok(topology) = Topology::new(vertex_count, mesh.triangles.clone()) else {
        return Err(WeightError::NoPose);
    };
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
    for triangle in 0..mesh.triangles.len() {
        add_gradient(pairs.len() + triangle, triangle, epsilon.sqrt());
    }
    // The poses are the first vertices; their values are known.
    let normal = terms.build().normal();
    let unknown_count = vertex_count - pose_count;
    let mut system = Triplets::new(unknown_count, unknown_count);
    let mut right = vec![vec![0.0; pose_count]; unknown_count];
    for (row, column, value) in normal.entries() {
        match (row.checked_sub(pose_count), column.checked_sub(pose_count)) {
            (Some(row), Some(column)) => system.add(row, column, value),
            (Some(row), None) => right[row][column] -= value,
            (None, _) => {}
        }
    }
    let factor = SparseCholesky::new(&system.build())?;
    let mut values = vec![0.0; vertex_count * pose_count];
    let mut buffer = Vec::new();
    for pose in 0..pose_count {
        values[pose * pose_count + pose] = 1.0;
        let mut lane: Vec<[f64; 1]> = right.iter().map(|row| [row[pose]]).collect();
        factor.solve(&mut lane, &mut buffer)?;
        for (unknown, [value]) in lane.into_iter().enumerate() {
            values[(pose_count + unknown) * pose_count + pose] = value;
        }
    }
    Ok(values)
}
