//! Points of a drawing bound to the mesh of its pose.

use std::collections::BTreeMap;

use crate::math::{Point, point};
use crate::mesh::{MeshPoint, PointLocator, geometry};

/// The mesh as it lies in the pose that a drawing was made for.
#[derive(Debug)]
pub(super) struct PoseMesh<'a> {
    triangles: &'a [[usize; 3]],
    positions: &'a [Point],
    locator: PointLocator,
    /// The edges that have a triangle on one side only, with that triangle.
    rim: Vec<([usize; 2], usize)>,
}

impl<'a> PoseMesh<'a> {
    pub(super) fn new(triangles: &'a [[usize; 3]], positions: &'a [Point]) -> Self {
        Self {
            triangles,
            positions,
            locator: PointLocator::new(triangles, positions),
            rim: rim(triangles),
        }
    }

    /// The positions of the pose.
    pub(super) fn positions(&self) -> &'a [Point] {
        self.positions
    }

    /// The triangle that carries `p`: the one that holds it or, outside the mesh, the nearest. 0 in a mesh without triangles.
    pub(super) fn triangle_at(&self, p: Point) -> usize {
        if let Some(located) = self.locator.locate(p) {
            return located.triangle;
        }
        // Of a point outside, the nearest place is on the rim.
        let distance = |[a, b]: [usize; 2]| point::nearest_on_segment(p, self.positions[a], self.positions[b]).1;
        let nearest = self.rim.iter().map(|&(edge, triangle)| (distance(edge), triangle));
        nearest
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(0, |(_, triangle)| triangle)
    }

    /// `p`, carried by the given triangle, in which it need not lie.
    pub(super) fn bind(&self, p: Point, triangle: usize) -> MeshPoint {
        let vertices = self.triangles.get(triangle).copied().unwrap_or_default();
        let shares = geometry::barycentric(geometry::corners(self.positions, vertices), p);
        MeshPoint {
            vertices,
            shares: shares.unwrap_or([1.0, 0.0, 0.0]),
        }
    }

    /// `p`, carried by the triangle at it.
    pub(super) fn bind_here(&self, p: Point) -> MeshPoint {
        self.bind(p, self.triangle_at(p))
    }
}

fn rim(triangles: &[[usize; 3]]) -> Vec<([usize; 2], usize)> {
    let mut seen: BTreeMap<[usize; 2], (usize, usize)> = BTreeMap::new();
    for (k, &[a, b, c]) in triangles.iter().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            seen.entry([from.min(to), from.max(to)]).or_insert((0, k)).0 += 1;
        }
    }
    let alone = seen.into_iter().filter(|(_, (count, _))| *count == 1);
    alone.map(|(edge, (_, triangle))| (edge, triangle)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_outside_goes_with_the_nearest_triangle() {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point::from);
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let mesh = PoseMesh::new(&triangles, &positions);
        assert_eq!(mesh.rim.len(), 4);
        assert_eq!(
            (
                mesh.triangle_at(Point::new(3.0, 0.4)),
                mesh.triangle_at(Point::new(-2.0, 0.4))
            ),
            (0, 1)
        );
        // By the triangle's own affine map: x of a point is doubled.
        let wider = positions.map(|p| Point::new(2.0 * p.x, p.y));
        let outside = Point::new(3.0, 0.4);
        assert!((mesh.bind_here(outside).at(&wider) - Point::new(6.0, 0.4)).norm() < 1e-12);
    }
}
