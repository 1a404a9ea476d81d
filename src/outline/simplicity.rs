//! Exact test that closed polygons neither cross nor touch.
//!
//! Candidate pairs of edges come from an R-tree over their boxes; each pair is decided with exact predicates. Cost
//! O(n log n) for edges of similar length, O(n^2) if all boxes overlap.

use rstar::{AABB, RTree, primitives::GeomWithData, primitives::Rectangle};

use super::Ring;
use crate::math::{Point, predicate};

/// Two edges that share a point they should not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Meeting {
    /// Ring and edge of the one that comes first.
    pub first: (usize, usize),
    /// Ring and edge of the other.
    pub second: (usize, usize),
    /// Their common point, up to rounding, in source units.
    pub place: Point,
}

/// The first pair of edges, in ring and edge order, that meet: neighbours may share their common vertex and nothing
/// else, all others nothing.
#[must_use]
pub(crate) fn first_meeting(rings: &[Ring]) -> Option<Meeting> {
    let mut edges = Vec::new();
    for (ring, points) in rings.iter().enumerate() {
        for (edge, (a, b)) in points.edges().enumerate() {
            edges.push(GeomWithData::new(
                Rectangle::from_corners([a.x, a.y], [b.x, b.y]),
                (ring, edge, a, b),
            ));
        }
    }
    let tree = RTree::bulk_load(edges.clone());
    for entry in &edges {
        let (ring, edge, a, b) = entry.data;
        let count = rings[ring].len();
        let (low, high) = (a.inf(&b), a.sup(&b));
        let first_in_order = tree
            .locate_in_envelope_intersecting(AABB::from_corners([low.x, low.y], [high.x, high.y]))
            .filter(|other| (other.data.0, other.data.1) > (ring, edge))
            .filter(|other| {
                let (other_ring, other_edge, c, d) = other.data;
                if other_ring == ring && other_edge == (edge + 1) % count {
                    predicate::folds_back(a, b, d)
                } else if other_ring == ring && (other_edge + 1) % count == edge {
                    predicate::folds_back(c, d, b)
                } else {
                    predicate::touch(a, b, c, d)
                }
            })
            .min_by_key(|other| (other.data.0, other.data.1));
        if let Some(other) = first_in_order {
            let (other_ring, other_edge, c, d) = other.data;
            return Some(Meeting {
                first: (ring, edge),
                second: (other_ring, other_edge),
                place: common_point(a, b, c, d),
            });
        }
    }
    None
}

/// Where two segments known to meet do so, up to rounding.
pub(super) fn common_point(a: Point, b: Point, c: Point, d: Point) -> Point {
    for (p, (q, r)) in [(a, (c, d)), (b, (c, d)), (c, (a, b)), (d, (a, b))] {
        if predicate::on_segment(p, q, r) {
            return p;
        }
    }
    let (u, v) = (b - a, d - c);
    let denominator = crate::math::point::cross(u, v);
    if denominator == 0.0 {
        return a;
    }
    a + u * (crate::math::point::cross(c - a, v) / denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Ring {
        Ring::new(points.iter().copied().map(Point::from)).expect("a ring")
    }

    #[test]
    fn a_spike_that_folds_back_is_a_meeting() {
        let spike = ring(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
        assert!(first_meeting(&[spike]).is_some());
    }

    #[test]
    fn a_vertex_on_an_edge_is_a_meeting_at_that_vertex() {
        let pinched = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]]);
        assert_eq!(
            first_meeting(&[pinched]).expect("they touch").place,
            Point::new(2.0, 0.0)
        );
    }

    #[test]
    fn a_square_in_a_square_is_simple() {
        let outer = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let hole = ring(&[[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]]);
        assert_eq!(first_meeting(&[outer.clone(), hole]), None);
        assert!(first_meeting(&[outer.clone(), outer]).is_some());
    }
}
