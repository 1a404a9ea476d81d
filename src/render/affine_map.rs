//! From one triangle to others.

use crate::math::{Point, point};

/// A triangle with area from which affine maps lead to others.
pub(super) struct TriangleFrame {
    corner: Point,
    /// How fast the second and third barycentric coordinates grow along x and along y.
    along_x: [f64; 2],
    along_y: [f64; 2],
}

impl TriangleFrame {
    pub(super) fn new([a, b, c]: [Point; 3]) -> Self {
        let (e, f) = (b - a, c - a);
        let doubled_area = point::cross(e, f);
        Self {
            corner: a,
            along_x: [f.y / doubled_area, -e.y / doubled_area],
            along_y: [-f.x / doubled_area, e.x / doubled_area],
        }
    }

    pub(super) fn map_to(&self, [a, b, c]: [Point; 3]) -> AffineMap {
        let (e, f) = (b - a, c - a);
        let along_x = e * self.along_x[0] + f * self.along_x[1];
        let along_y = e * self.along_y[0] + f * self.along_y[1];
        AffineMap {
            along_x,
            along_y,
            shift: a - along_x * self.corner.x - along_y * self.corner.y,
        }
    }
}

/// The affine map that takes one triangle to another.
pub(super) struct AffineMap {
    pub(super) along_x: Point,
    along_y: Point,
    shift: Point,
}

impl AffineMap {
    pub(super) fn apply(&self, p: Point) -> Point {
        self.along_x * p.x + self.along_y * p.y + self.shift
    }
}
