//! Points of a drawing bound to the mesh of its pose.

use crate::math::Point;
use crate::mesh::{PointLocator, geometry};

/// A point as a combination of the three vertices of a triangle: carried by the triangle's affine map wherever it lies, inside
/// or outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Anchor {
    vertices: [usize; 3],
    shares: [f64; 3],
}

impl Anchor {
    /// Where it is when the vertices are at `positions`.
    pub(super) fn place(&self, positions: &[Point]) -> Point {
        let [a, b, c] = self.vertices.map(|vertex| positions[vertex]);
        let [u, v, w] = self.shares;
        a * u + b * v + c * w
    }
}

/// The mesh as it lies in the pose that a drawing was made for.
#[derive(Debug)]
pub(super) struct PoseMesh<'a> {
    triangles: &'a [[usize; 3]],
    positions: &'a [Point],
    locator: PointLocator,
}

impl<'a> PoseMesh<'a> {
    pub(super) fn new(triangles: &'a [[usize; 3]], positions: &'a [Point]) -> Self {
        Self {
            triangles,
            positions,
            locator: PointLocator::new(triangles, positions),
        }
    }

    /// The positions of the pose.
    pub(super) fn positions(&self) -> &'a [Point] {
        self.positions
    }

    /// The triangle that carries `p`: the one that holds it or, outside the mesh, the nearest. 0 in a mesh without triangles.
    pub(super) fn triangle_at(&self, p: Point) -> usize {
        self.locator.nearest(p).map_or(0, |located| located.triangle)
    }

    /// `p`, carried by the given triangle.
    pub(super) fn bind(&self, p: Point, triangle: usize) -> Anchor {
        let vertices = self.triangles.get(triangle).copied().unwrap_or_default();
        let shares = geometry::barycentric(geometry::corners(self.positions, vertices), p);
        Anchor {
            vertices,
            shares: shares.unwrap_or([1.0, 0.0, 0.0]),
        }
    }

    /// `p`, carried by the triangle at it.
    pub(super) fn bind_here(&self, p: Point) -> Anchor {
        self.bind(p, self.triangle_at(p))
    }
}
