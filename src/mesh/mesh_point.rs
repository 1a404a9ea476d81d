//! A point that a triangle of a mesh carries.

use crate::math::Point;

/// A point as a combination of three vertices: where they move, it moves with the affine map of their triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshPoint {
    /// The vertices.
    pub vertices: [usize; 3],
    /// How much of each; their sum is 1. None is negative for a point in the triangle.
    pub shares: [f64; 3],
}

impl MeshPoint {
    /// Where it is when the mesh's vertices are at `positions`.
    #[must_use]
    pub fn at(&self, positions: &[Point]) -> Point {
        let [a, b, c] = self.vertices.map(|vertex| positions[vertex]);
        let [u, v, w] = self.shares;
        a * u + b * v + c * w
    }
}
