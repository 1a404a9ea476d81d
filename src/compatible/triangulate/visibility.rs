//! Which vertices of a polygon see one another, and what region a vertex sees.
//!
//! The view of a vertex is walked through the polygon's own triangulation: a cone, bounded by rays through polygon
//! vertices, enters a triangle over an edge and splits at the opposite corner ("triangular expansion", Bungiu, Hemmer,
//! Hershberger, Huang, Kröller 2014). Only the triangles in view are visited, so all pairs cost at most O(m^2), and
//! every decision is one exact orientation of three vertices.
//!
//! Two vertices see one another if the open segment between them is inside the polygon and touches no vertex.

use std::collections::BTreeSet;

use super::ear_clipping::triangulate_polygon;
use crate::math::{Point, point, predicate};
use crate::mesh::geometry;

/// A symmetric relation on m vertices.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Relation {
    count: usize,
    bits: Vec<bool>,
}

impl Relation {
    pub(super) fn full(count: usize) -> Self {
        Self {
            count,
            bits: vec![true; count * count],
        }
    }

    fn empty(count: usize) -> Self {
        Self {
            count,
            bits: vec![false; count * count],
        }
    }

    pub(super) fn get(&self, a: usize, b: usize) -> bool {
        self.bits[a * self.count + b]
    }

    fn set(&mut self, a: usize, b: usize) {
        self.bits[a * self.count + b] = true;
        self.bits[b * self.count + a] = true;
    }

    pub(super) fn clear(&mut self, a: usize, b: usize) {
        self.bits[a * self.count + b] = false;
        self.bits[b * self.count + a] = false;
    }

    pub(super) fn intersect(&mut self, other: &Relation) {
        for (mine, theirs) in self.bits.iter_mut().zip(&other.bits) {
            *mine &= theirs;
        }
    }
}

/// A triangulated simple polygon, ready to be looked around in.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[usize; 3]>,
    /// Of the box around the points.
    pub(super) diagonal: f64,
    /// For triangle t and corner k, the triangle across the edge from corner k to corner k + 1.
    neighbours: Vec<[Option<usize>; 3]>,
}

/// The part of a triangle that a vertex sees: right of the ray through `left`, left of the ray through `right`; both
/// `None` where the vertex is a corner of the triangle and sees all of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    pub(super) triangle: usize,
    pub(super) rays: Option<(usize, usize)>,
}

impl Sight {
    pub(super) fn new(points: Vec<Point>, triangles: Vec<[usize; 3]>) -> Self {
        Self::between_walls(points, triangles, &BTreeSet::new())
    }

    /// A triangulation in which no one sees across `walls`, directed edges of the triangle that the wall bounds.
    pub(super) fn between_walls(
        points: Vec<Point>,
        triangles: Vec<[usize; 3]>,
        walls: &BTreeSet<(usize, usize)>,
    ) -> Self {
        let mut owner = std::collections::BTreeMap::new();
        for (t, &triangle) in triangles.iter().enumerate() {
            for edge in crate::mesh::directed_edges(triangle) {
                owner.insert(edge, t);
            }
        }
        let neighbours = triangles
            .iter()
            .map(|&triangle| {
                let across = |(a, b)| owner.get(&(b, a)).copied().filter(|_| !walls.contains(&(a, b)));
                crate::mesh::directed_edges(triangle).map(across)
            })
            .collect();
        Self {
            diagonal: point::diagonal(&points),
            points,
            triangles,
            neighbours,
        }
    }

    /// All pairs of vertices that see one another; polygon edges count.
    pub(super) fn visible_pairs(&self) -> Relation {
        let mut pairs = Relation::empty(self.points.len());
        for triangle in &self.triangles {
            for (a, b) in crate::mesh::directed_edges(*triangle) {
                pairs.set(a, b);
            }
        }
        for vertex in 0..self.points.len() {
            self.look_around(vertex, |_| {}, |seen| pairs.set(vertex, seen));
        }
        pairs
    }

    /// The vertices that `vertex` sees, in order; neighbours along polygon edges count.
    pub(super) fn seen_from(&self, vertex: usize) -> Vec<usize> {
        let mut seen: Vec<usize> = Vec::new();
        self.look_around(vertex, |_| {}, |other| seen.push(other));
        for triangle in self.triangles.iter().filter(|triangle| triangle.contains(&vertex)) {
            seen.extend(triangle.iter().filter(|&&other| other != vertex));
        }
        seen.sort_unstable();
        seen.dedup();
        seen
    }

    /// The triangle across each edge of triangle `t`, the edge from corner `k` to corner `k + 1` first for `k = 0`.
    pub(super) fn neighbours(&self, t: usize) -> [Option<usize>; 3] {
        self.neighbours[t]
    }

    /// What `vertex` sees of every triangle.
    pub(super) fn views(&self, vertex: usize) -> Vec<View> {
        let mut views = Vec::new();
        self.look_around(vertex, |view| views.push(view), |_| {});
        views
    }

    /// Walks the view of `vertex`: every triangle in view, and every vertex seen beyond the first triangles.
    fn look_around(&self, vertex: usize, mut on_view: impl FnMut(View), mut on_vertex: impl FnMut(usize)) {
        let eye = self.points[vertex];
        // (triangle to enter, edge it is entered over as seen from outside, right ray, left ray)
        let mut stack = Vec::new();
        for (t, triangle) in self.triangles.iter().enumerate() {
            if let Some(corner) = triangle.iter().position(|&v| v == vertex) {
                on_view(View {
                    triangle: t,
                    rays: None,
                });
                let (right, left) = (triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]);
                if let Some(beyond) = self.neighbours[t][(corner + 1) % 3] {
                    stack.push((beyond, right, left, right, left));
                }
            }
        }
        while let Some((t, from, to, right, left)) = stack.pop() {
            on_view(View {
                triangle: t,
                rays: Some((right, left)),
            });
            let triangle = self.triangles[t];
            // Entered over the edge (to, from) of this triangle.
            let Some(corner) = triangle.iter().position(|&v| v == to) else {
                continue;
            };
            let apex = triangle[(corner + 2) % 3];
            let p = self.points[apex];
            let beside_right = predicate::orientation(eye, self.points[right], p);
            let beside_left = predicate::orientation(eye, self.points[left], p);
            if beside_right.is_gt() && beside_left.is_lt() {
                on_vertex(apex);
            }
            // The edge (from, apex) of the triangle lies to the right, (apex, to) to the left.
            if beside_right.is_gt()
                && let Some(beyond) = self.neighbours[t][(corner + 1) % 3]
            {
                let left = if beside_left.is_lt() { apex } else { left };
                stack.push((beyond, from, apex, right, left));
            }
            if beside_left.is_lt()
                && let Some(beyond) = self.neighbours[t][(corner + 2) % 3]
            {
                let right = if beside_right.is_gt() { apex } else { right };
                stack.push((beyond, apex, to, right, left));
            }
        }
    }
}

/// The polygon `piece` as every pose sees it; `positions` are per pose.
///
/// # Errors
/// The first pose in which it is too narrow to be triangulated.
pub(super) fn look(positions: &[Vec<Point>], piece: &[usize]) -> Result<Vec<Sight>, usize> {
    positions
        .iter()
        .enumerate()
        .map(|(pose, positions)| {
            let points: Vec<Point> = piece.iter().map(|&v| positions[v]).collect();
            let triangles = triangulate_polygon(&points).ok_or(pose)?;
            Ok(Sight::new(points, triangles))
        })
        .collect()
}

/// The pairs of vertices with line of sight in every pose.
pub(super) fn common_pairs(sights: &[Sight]) -> Relation {
    let mut common = Relation::full(sights[0].points.len());
    for sight in sights {
        common.intersect(&sight.visible_pairs());
    }
    common
}

/// A triangle's smallest angle in any pose, in radians.
pub(super) fn worst_angle_rad(sights: &[Sight], triangle: [usize; 3]) -> f64 {
    geometry::worst_angle_rad(sights.iter().map(|sight| sight.points.as_slice()), triangle)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::ear_clipping::triangulate_polygon;
    use super::*;
    use crate::outline::testing::rings;
    use proptest::prelude::*;

    pub(in super::super) fn sight_of(points: Vec<Point>) -> Sight {
        let triangles = triangulate_polygon(&points).expect("simple");
        Sight::new(points, triangles)
    }

    /// A star-shaped polygon: sorted directions, arbitrary radii.
    pub(in super::super) fn star(radii: &[f64]) -> Vec<Point> {
        let count = radii.len() as f64;
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / count;
        radii
            .iter()
            .enumerate()
            .map(|(k, r)| Point::new(r * angle(k).cos(), r * angle(k).sin()))
            .collect()
    }

    /// The definition, in O(m^3): no edge touched but at the ends, and inside near the start.
    fn naive(points: &[Point]) -> Relation {
        let count = points.len();
        let mut pairs = Relation::empty(count);
        for a in 0..count {
            pairs.set(a, (a + 1) % count);
            for b in a + 2..count {
                if (b + 1) % count == a {
                    continue;
                }
                let (p, q) = (points[a], points[b]);
                let blocked = (0..count).any(|e| {
                    let f = (e + 1) % count;
                    if e == a || f == a || e == b || f == b {
                        let other = if e == a || e == b { f } else { e };
                        predicate::on_segment(points[other], p, q)
                    } else {
                        predicate::touch(points[e], points[f], p, q)
                    }
                });
                let middle = (p + q) * 0.5;
                let ring = crate::outline::Ring::new(points.iter().copied()).expect("a ring");
                if !blocked && ring.contains(middle) {
                    pairs.set(a, b);
                }
            }
        }
        pairs
    }

    #[test]
    fn a_vertex_exactly_on_the_line_blocks() {
        // From (0, 0), the reflex vertex (2, 1) lies exactly before (4, 2).
        let points: Vec<Point> = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 1.0], [3.0, 4.0], [0.0, 4.0]]
            .map(Point::from)
            .to_vec();
        let pairs = sight_of(points).visible_pairs();
        assert!(!pairs.get(0, 2) && pairs.get(0, 3) && pairs.get(0, 4));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]
        #[test]
        fn agrees_with_the_definition_on_large_polygons(points in rings(24..201)) {
            let sight = sight_of(points.clone());
            let expected = naive(&points);
            prop_assert_eq!(&sight.visible_pairs(), &expected);
            for vertex in (0..points.len()).step_by(7) {
                let seen: Vec<usize> = (0..points.len()).filter(|&v| v != vertex && expected.get(vertex, v)).collect();
                prop_assert_eq!(sight.seen_from(vertex), seen);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn agrees_with_the_definition(radii in prop::collection::vec(0.1..1.0f64, 4..24)) {
            let points = star(&radii);
            prop_assert_eq!(sight_of(points.clone()).visible_pairs(), naive(&points));
        }

        #[test]
        fn agrees_with_the_definition_on_any_polygon(points in rings(3..24)) {
            prop_assert_eq!(sight_of(points.clone()).visible_pairs(), naive(&points));
        }

        #[test]
        fn the_views_of_a_vertex_see_the_centre_of_a_star(radii in prop::collection::vec(0.2..1.0f64, 5..20)) {
            let sight = sight_of(star(&radii));
            for vertex in 0..radii.len() {
                prop_assert!(!sight.views(vertex).is_empty());
            }
        }
    }
}
