//! The triangles around each movable vertex, laid out flat for sweeps that leave the topology alone.

use super::super::editable::{Curves, EditableMesh};
use crate::math::{Point, predicate};
use crate::mesh::geometry;

/// For each interior vertex the edges opposite to it: `(a, b)` for each triangle `(vertex, a, b)`.
#[derive(Debug)]
pub(super) struct Stars {
    vertices: Vec<usize>,
    starts: Vec<usize>,
    opposite: Vec<(usize, usize)>,
}

impl Stars {
    /// The stars of all vertices that are on no ring or path and are no landmark.
    pub(super) fn new(mesh: &EditableMesh, curves: &Curves) -> Self {
        let mut fixed = vec![false; mesh.vertex_count()];
        for &v in curves
            .rings
            .iter()
            .chain(&curves.paths)
            .flatten()
            .chain(&curves.landmarks)
        {
            fixed[v] = true;
        }
        let mut stars = Self {
            vertices: Vec::new(),
            starts: vec![0],
            opposite: Vec::new(),
        };
        for (v, &is_fixed) in fixed.iter().enumerate() {
            if is_fixed || mesh.degree(v) == 0 {
                continue;
            }
            for triangle in mesh.triangles_at(v) {
                let corner = triangle.iter().position(|&w| w == v).unwrap_or(0);
                stars
                    .opposite
                    .push((triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]));
            }
            stars.vertices.push(v);
            stars.starts.push(stars.opposite.len());
        }
        stars
    }

    /// The stars of all vertices, those of the boundary included.
    pub(super) fn of_all(mesh: &EditableMesh) -> Self {
        let nothing = Curves {
            rings: Vec::new(),
            landmarks: Vec::new(),
            paths: Vec::new(),
        };
        Self::new(mesh, &nothing)
    }

    /// Each movable vertex with its opposite edges.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &[(usize, usize)])> {
        self.vertices
            .iter()
            .zip(self.starts.windows(2))
            .map(|(&v, range)| (v, &self.opposite[range[0]..range[1]]))
    }
}

/// Whether all triangles of a star are positive with its centre at `centre`. Exact.
pub(super) fn is_positive(positions: &[Point], centre: Point, opposite: &[(usize, usize)]) -> bool {
    opposite
        .iter()
        .all(|&(a, b)| predicate::is_positive(centre, positions[a], positions[b]))
}

/// The smallest angle of a star's triangles with its centre at `centre`, in radians.
pub(super) fn smallest_angle_rad(positions: &[Point], centre: Point, opposite: &[(usize, usize)]) -> f64 {
    opposite
        .iter()
        .map(|&(a, b)| geometry::smallest_angle_rad([centre, positions[a], positions[b]]))
        .fold(f64::INFINITY, f64::min)
}
