//! A pose at rest: what every handle set on it shares.

use super::HandleError;
use crate::math::{Matrix, Point, point, predicate};
use crate::mesh::{Topology, geometry};
use crate::solve::{SparseCholesky, Triplets};

/// The tie between neighbouring rotations, as a share of the shape's area (`alpha` of Levi and Gotsman 2015): an arm as wide
/// as a tenth of the figure then resists bending about twice as much as without it.
const BENDING: f64 = 0.004;

/// A mesh at rest, factored.
#[derive(Debug)]
pub(super) struct RestShape {
    topology: Topology,
    rest: Vec<Point>,
    areas: Vec<f64>,
    /// Per triangle and corner, the gradient of its barycentric coordinate.
    gradients: Vec<[Point; 3]>,
    /// Per triangle and edge, the weight of the tie to the rotation of the triangle across; 0 where there is none.
    ties: Vec<[f64; 3]>,
    area: f64,
    size: f64,
    /// Of the cotangent matrix without vertex 0, whose place the handles decide.
    factor: SparseCholesky,
    /// Of the conformal energy without the two vertices of `far_apart`; x and y of a vertex are neighbours.
    conformal: SparseCholesky,
    far_apart: [usize; 2],
}

impl RestShape {
    pub(super) fn new(topology: &Topology, rest: &[Point]) -> Result<Self, HandleError> {
        if rest.len() != topology.vertex_count() || topology.triangles().is_empty() {
            return Err(HandleError::BadMesh(format!(
                "{} positions for {} vertices",
                rest.len(),
                topology.vertex_count()
            )));
        }
        if topology.components().iter().any(|&component| component != 0) {
            return Err(HandleError::BadMesh("the mesh has several pieces".to_owned()));
        }
        let mut areas = Vec::with_capacity(topology.triangles().len());
        let mut gradients = Vec::with_capacity(topology.triangles().len());
        for (triangle, &vertices) in topology.triangles().iter().enumerate() {
            let corners = geometry::corners(rest, vertices);
            let [a, b, c] = corners;
            let of_triangle = geometry::barycentric_gradients(corners)
                .filter(|_| predicate::is_positive(a, b, c) && geometry::signed_area(corners) > 0.0)
                .ok_or_else(|| HandleError::BadMesh(format!("triangle {triangle} is not positive")))?;
            areas.push(geometry::signed_area(corners));
            gradients.push(of_triangle);
        }
        let area: f64 = areas.iter().sum();
        let far_apart = [0, farthest(rest, rest[0])];
        Ok(Self {
            ties: ties(topology, rest, area),
            factor: cotangent_factor(topology, &areas, &gradients)?,
            conformal: conformal_factor(topology, &areas, &gradients, far_apart)?,
            topology: topology.clone(),
            rest: rest.to_vec(),
            areas,
            gradients,
            area,
            size: point::diagonal(rest),
            far_apart,
        })
    }

    pub(super) fn triangles(&self) -> &[[usize; 3]] {
        self.topology.triangles()
    }

    pub(super) fn neighbours(&self) -> &[[Option<usize>; 3]] {
        self.topology.neighbours()
    }

    pub(super) fn rest(&self) -> &[Point] {
        &self.rest
    }

    pub(super) fn areas(&self) -> &[f64] {
        &self.areas
    }

    pub(super) fn gradients(&self) -> &[[Point; 3]] {
        &self.gradients
    }

    pub(super) fn ties(&self) -> &[[f64; 3]] {
        &self.ties
    }

    pub(super) fn area(&self) -> f64 {
        self.area
    }

    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// The map from the rest triangle to the triangle at `positions`.
    pub(super) fn triangle_map(&self, triangle: usize, positions: &[Point]) -> Matrix {
        let mut map = Matrix::zeros();
        for (&vertex, gradient) in self.triangles()[triangle].iter().zip(&self.gradients[triangle]) {
            map += positions[vertex] * gradient.transpose();
        }
        map
    }

    /// The energy without the ties: `sum area |J - R|^2` with the best rotations.
    pub(super) fn energy(&self, positions: &[Point]) -> f64 {
        (0..self.areas.len())
            .map(|t| {
                let map = self.triangle_map(t, positions);
                self.areas[t] * deviation(&map)
            })
            .sum()
    }

    /// The smallest share of its area that a triangle keeps; negative if one is inverted.
    pub(super) fn smallest_share(&self, positions: &[Point]) -> f64 {
        (self.triangles().iter().zip(&self.areas))
            .map(|(&triangle, area)| geometry::signed_area(geometry::corners(positions, triangle)) / area)
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether every triangle is positive, exactly.
    pub(super) fn is_positive(&self, positions: &[Point]) -> bool {
        self.triangles().iter().all(|&triangle| {
            let [a, b, c] = geometry::corners(positions, triangle);
            predicate::is_positive(a, b, c)
        })
    }

    /// The rest pose moved rigidly so that `from` comes near `to`.
    pub(super) fn rigid_motion(&self, from: &[Point], to: &[Point]) -> Vec<Point> {
        let count = from.len().max(1) as f64;
        let (middle, wanted) = (from.iter().sum::<Point>() / count, to.iter().sum::<Point>() / count);
        let (mut cos, mut sin) = (0.0, 0.0);
        for (a, b) in from.iter().zip(to) {
            let (a, b) = (a - middle, b - wanted);
            cos += a.dot(&b);
            sin += point::cross(a, b);
        }
        let length = cos.hypot(sin);
        let (cos, sin) = if length > 0.0 {
            (cos / length, sin / length)
        } else {
            (1.0, 0.0)
        };
        let rotation = Matrix::new(cos, -sin, sin, cos);
        self.rest.iter().map(|p| rotation * (p - middle) + wanted).collect()
    }

    /// Solves with the cotangent matrix in place: entry 0 becomes 0. The entries have to sum to 0.
    pub(super) fn solve(&self, right: &mut [[f64; 2]], buffer: &mut Vec<[f64; 2]>) -> Result<(), HandleError> {
        let Some((first, others)) = right.split_first_mut() else {
            return Ok(());
        };
        *first = [0.0; 2];
        Ok(self.factor.solve(others, buffer)?)
    }

    /// Solves with the conformal matrix for one displacement a vertex; the two pinned ones become 0.
    pub(super) fn solve_conformal(&self, right: &[Point]) -> Result<Vec<Point>, HandleError> {
        let free = |vertex: &usize| !self.far_apart.contains(vertex);
        let mut unknowns: Vec<[f64; 1]> = (0..right.len())
            .filter(free)
            .flat_map(|vertex| [[right[vertex].x], [right[vertex].y]])
            .collect();
        self.conformal.solve(&mut unknowns, &mut Vec::new())?;
        let mut solution = vec![Point::zeros(); right.len()];
        for (vertex, pair) in (0..right.len()).filter(free).zip(unknowns.chunks_exact(2)) {
            solution[vertex] = Point::new(pair[0][0], pair[1][0]);
        }
        Ok(solution)
    }
}

/// `|J - R|^2` with the best rotation.
pub(super) fn deviation(map: &Matrix) -> f64 {
    let trace_rotated = (map.m11 + map.m22).hypot(map.m21 - map.m12);
    (map.norm_squared() - 2.0 * trace_rotated + 2.0).max(0.0)
}

fn farthest(points: &[Point], from: Point) -> usize {
    (0..points.len())
        .max_by(|&a, &b| (points[a] - from).norm().total_cmp(&(points[b] - from).norm()))
        .unwrap_or(0)
}

/// The tie across an edge: its length over the distance of the two middles, as for a gradient over the mesh.
fn ties(topology: &Topology, rest: &[Point], area: f64) -> Vec<[f64; 3]> {
    let middle = |t: usize| geometry::corners(rest, topology.triangles()[t]).iter().sum::<Point>() / 3.0;
    (topology.triangles().iter().zip(topology.neighbours()))
        .enumerate()
        .map(|(t, (vertices, across))| {
            std::array::from_fn(|k| {
                across[k].map_or(0.0, |other| {
                    let length = (rest[vertices[(k + 1) % 3]] - rest[vertices[k]]).norm();
                    BENDING * area * length / (middle(t) - middle(other)).norm()
                })
            })
        })
        .collect()
}

fn cotangent_factor(
    topology: &Topology,
    areas: &[f64],
    gradients: &[[Point; 3]],
) -> Result<SparseCholesky, HandleError> {
    let size = topology.vertex_count() - 1;
    let mut matrix = Triplets::new(size, size);
    for ((triangle, gradients), area) in topology.triangles().iter().zip(gradients).zip(areas) {
        for (a, &row) in triangle.iter().enumerate() {
            for (b, &column) in triangle.iter().enumerate() {
                // Vertex 0 wraps to a place outside the matrix, which is ignored.
                let value = area * gradients[a].dot(&gradients[b]);
                matrix.add(row.wrapping_sub(1), column.wrapping_sub(1), value);
            }
        }
    }
    Ok(SparseCholesky::new(&matrix.build())?)
}

/// The matrix of half the squared distance from a similarity: the Dirichlet energy less the area.
fn conformal_factor(
    topology: &Topology,
    areas: &[f64],
    gradients: &[[Point; 3]],
    pinned: [usize; 2],
) -> Result<SparseCholesky, HandleError> {
    let mut next = 0;
    let unknowns: Vec<usize> = (0..topology.vertex_count())
        .map(|vertex| {
            if pinned.contains(&vertex) {
                return usize::MAX / 4;
            }
            next += 1;
            next - 1
        })
        .collect();
    let mut matrix = Triplets::new(2 * next, 2 * next);
    for ((triangle, gradients), area) in topology.triangles().iter().zip(gradients).zip(areas) {
        for (a, &row) in triangle.iter().enumerate() {
            for (b, &column) in triangle.iter().enumerate() {
                let (row, column) = (2 * unknowns[row], 2 * unknowns[column]);
                let along = area * gradients[a].dot(&gradients[b]);
                let across = area * point::cross(gradients[a], gradients[b]);
                matrix.add(row, column, along);
                matrix.add(row + 1, column + 1, along);
                matrix.add(row, column + 1, -across);
                matrix.add(row + 1, column, across);
            }
        }
    }
    Ok(SparseCholesky::new(&matrix.build())?)
}
