//! Which triangle of a mesh holds a point.

use rstar::{AABB, RTree, primitives::GeomWithData, primitives::Rectangle};

use super::{MeshPoint, geometry};
use crate::math::{Point, point};

/// A point found on a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located {
    /// The triangle.
    pub triangle: usize,
    /// Barycentric coordinates in it; non-negative, sum 1.
    pub barycentric: [f64; 3],
}

/// Rounding of the three cross products: a point on an edge belongs to the mesh.
const EDGE_TOLERANCE: f64 = 1e-12;

type Entry = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Finds the triangle at a point. Built in O(n log n), queried in about O(log n).
#[derive(Debug, Clone)]
pub struct PointLocator {
    vertices: Vec<[usize; 3]>,
    triangles: Vec<[Point; 3]>,
    tree: RTree<Entry>,
}

impl PointLocator {
    /// A locator over `triangles` at `positions`.
    #[must_use]
    pub fn new(triangles: &[[usize; 3]], positions: &[Point]) -> Self {
        let corners: Vec<[Point; 3]> = triangles.iter().map(|&t| geometry::corners(positions, t)).collect();
        let boxes = corners
            .iter()
            .enumerate()
            .map(|(t, [a, b, c])| {
                let (low, high) = (a.inf(b).inf(c), a.sup(b).sup(c));
                Entry::new(Rectangle::from_corners([low.x, low.y], [high.x, high.y]), t)
            })
            .collect();
        Self {
            vertices: triangles.to_vec(),
            triangles: corners,
            tree: RTree::bulk_load(boxes),
        }
    }

    /// The triangle that holds `p`; on a shared edge the one with the smallest index. `None` outside the mesh.
    #[must_use]
    pub fn locate(&self, p: Point) -> Option<Located> {
        self.tree
            .locate_in_envelope_intersecting(AABB::from_point([p.x, p.y]))
            .filter_map(|entry| {
                let barycentric = geometry::barycentric(self.triangles[entry.data], p)?;
                barycentric.iter().all(|&b| b >= -EDGE_TOLERANCE).then(|| Located {
                    triangle: entry.data,
                    barycentric: clamped(barycentric),
                })
            })
            .min_by_key(|located| located.triangle)
    }

    /// The point of the mesh nearest to `p`: `p` itself inside. `None` only for a mesh without triangles.
    ///
    /// Outside the mesh the cost is O(#triangles).
    #[must_use]
    pub fn nearest(&self, p: Point) -> Option<Located> {
        if let Some(inside) = self.locate(p) {
            return Some(inside);
        }
        let mut best: Option<(f64, Located)> = None;
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let (along, distance) = point::nearest_on_segment(p, corners[k], corners[(k + 1) % 3]);
                if best.as_ref().is_none_or(|(d, _)| distance < *d) {
                    let mut barycentric = [0.0; 3];
                    barycentric[k] = 1.0 - along;
                    barycentric[(k + 1) % 3] = along;
                    best = Some((
                        distance,
                        Located {
                            triangle: t,
                            barycentric,
                        },
                    ));
                }
            }
        }
        best.map(|(_, located)| located)
    }

    /// As [`Self::bind`] for each of `places`; quick where one is near to the one before.
    #[must_use]
    pub fn bind_along(&self, places: impl IntoIterator<Item = Point>) -> Option<Vec<MeshPoint>> {
        let mut last = 0;
        let bound = |p: Point| {
            let here = geometry::barycentric(*self.triangles.get(last)?, p);
            // Inside for sure: on an edge the smallest index counts.
            let inside = here.filter(|barycentric| barycentric.iter().all(|&b| b > 2.0 * EDGE_TOLERANCE));
            let located = match inside {
                Some(barycentric) => Located {
                    triangle: last,
                    barycentric: clamped(barycentric),
                },
                None => self.nearest(p)?,
            };
            last = located.triangle;
            Some(self.bound(located))
        };
        places.into_iter().map(bound).collect()
    }

    fn bound(&self, located: Located) -> MeshPoint {
        MeshPoint {
            vertices: self.vertices[located.triangle],
            shares: located.barycentric,
        }
    }

    /// The point of the mesh at `p`, carried by its triangle. `None` outside the mesh.
    #[must_use]
    pub fn bind_inside(&self, p: Point) -> Option<MeshPoint> {
        self.locate(p).map(|located| self.bound(located))
    }

    /// The point of the mesh nearest to `p`, carried by its triangle. `None` only for a mesh without triangles.
    #[must_use]
    pub fn bind(&self, p: Point) -> Option<MeshPoint> {
        self.nearest(p).map(|located| self.bound(located))
    }
}

/// Tiny negative coordinates set to zero, sum restored to 1.
fn clamped(barycentric: [f64; 3]) -> [f64; 3] {
    let positive = barycentric.map(|b| b.max(0.0));
    let sum: f64 = positive.iter().sum();
    positive.map(|b| b / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_inside_edge_and_outside() {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point::from);
        let locator = PointLocator::new(&[[0, 1, 2], [0, 2, 3]], &positions);
        assert_eq!(locator.locate(Point::new(0.5, 0.5)).map(|l| l.triangle), Some(0));
        assert_eq!(locator.locate(Point::new(0.2, 0.8)).map(|l| l.triangle), Some(1));
        assert_eq!(locator.locate(Point::new(1.2, 0.8)), None);
        let nearest = locator.nearest(Point::new(2.0, 0.5)).expect("a mesh");
        assert_eq!((nearest.triangle, nearest.barycentric), (0, [0.0, 0.5, 0.5]));
        let bound = locator.bind(Point::new(2.0, 0.5)).expect("a mesh");
        assert_eq!(
            (bound.vertices, bound.at(&positions)),
            ([0, 1, 2], Point::new(1.0, 0.5))
        );
        assert_eq!(bound.at(&positions.map(|p| p * 2.0)), Point::new(2.0, 1.0));
        let along: Vec<Point> = (0..40).map(|k| Point::new(0.05 * f64::from(k), 0.5)).collect();
        let each: Option<Vec<MeshPoint>> = along.iter().map(|&p| locator.bind(p)).collect();
        assert_eq!(locator.bind_along(along), each);
    }
}
