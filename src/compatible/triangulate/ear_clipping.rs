//! One polygon's own triangulation, by exact ear clipping.
//!
//! The polygon is simple, or weakly simple where a hole was joined to it by a bridge: then it runs along the bridge
//! twice and visits the bridge's ends twice, as different vertices at one place. An ear may touch such a twin of its own
//! corners; what keeps it inside is that its diagonal starts into the interior angle at both ends.
//!
//! It serves as the map on which visibility is walked; its shape does not matter, so the first ear found is taken.
//! Cost O(m^2) for the usual polygon of m vertices, O(m^3) at worst.

use crate::math::{Point, predicate};

/// The m - 2 triangles of a (weakly) simple polygon of positive area; `None` if no ear is left, which in exact
/// arithmetic cannot happen.
pub(super) fn triangulate_polygon(points: &[Point]) -> Option<Vec<[usize; 3]>> {
    let mut remaining: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::with_capacity(points.len().saturating_sub(2));
    let mut at = 0;
    let mut since_last_ear = 0;
    while remaining.len() > 3 {
        let count = remaining.len();
        let (a, b, c) = (
            remaining[at % count],
            remaining[(at + 1) % count],
            remaining[(at + 2) % count],
        );
        if is_ear(points, &remaining, at % count) {
            triangles.push([a, b, c]);
            remaining.remove((at + 1) % count);
            since_last_ear = 0;
            // Step on, so that the ears spread over the polygon and do not make a fan.
            at = (at + 1) % remaining.len();
        } else {
            since_last_ear += 1;
            at = (at + 1) % count;
            if since_last_ear > count {
                return None;
            }
        }
    }
    let [a, b, c] = remaining.as_slice() else { return None };
    predicate::is_positive(points[*a], points[*b], points[*c]).then(|| triangles.push([*a, *b, *c]))?;
    Some(triangles)
}

fn is_ear(points: &[Point], remaining: &[usize], at: usize) -> bool {
    let count = remaining.len();
    let point = |k: usize| points[remaining[(at + k) % count]];
    let (before, pa, pb, pc, after) = (point(count - 1), point(0), point(1), point(2), point(3));
    if !predicate::is_positive(pa, pb, pc) || !in_angle(before, pa, pb, pc) || !in_angle(pb, pc, after, pa) {
        return false;
    }
    let (low, high) = (pa.inf(&pb).inf(&pc), pa.sup(&pb).sup(&pc));
    !remaining.iter().any(|&v| {
        let p = points[v];
        let in_box = low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
        in_box
            && p != pa
            && p != pb
            && p != pc
            && [(pa, pb), (pb, pc), (pc, pa)]
                .into_iter()
                .all(|(from, to)| predicate::orientation(from, to, p).is_ge())
    })
}

/// Whether the direction from `at` to `target` lies strictly in the interior angle between the polygon edges
/// `previous at` and `at next`, or along one of them.
pub(super) fn in_angle(previous: Point, at: Point, next: Point, target: Point) -> bool {
    let left_of_next = predicate::orientation(at, next, target);
    let right_of_previous = predicate::orientation(at, target, previous);
    if predicate::orientation(previous, at, next).is_gt() {
        left_of_next.is_ge() && right_of_previous.is_ge()
    } else {
        // Reflex: not strictly within the exterior angle.
        left_of_next.is_ge() || right_of_previous.is_ge()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::geometry;

    #[test]
    fn a_bridge_to_a_hole_is_passed_twice() {
        // A square with a square hole, joined by the bridge (0, 0) - (1, 1).
        let points: Vec<Point> = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ]
        .map(Point::from)
        .to_vec();
        let triangles = triangulate_polygon(&points).expect("weakly simple");
        let area: f64 = triangles
            .iter()
            .map(|&t| geometry::signed_area(geometry::corners(&points, t)))
            .sum();
        assert_eq!((triangles.len(), area), (8, 15.0));
    }

    #[test]
    fn a_comb_is_covered_exactly() {
        let points: Vec<Point> = [
            [0.0, 0.0],
            [7.0, 0.0],
            [7.0, 3.0],
            [6.0, 3.0],
            [6.0, 1.0],
            [5.0, 1.0],
            [5.0, 3.0],
            [4.0, 3.0],
            [4.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ]
        .map(Point::from)
        .to_vec();
        let triangles = triangulate_polygon(&points).expect("simple");
        let area: f64 = triangles
            .iter()
            .map(|&t| geometry::signed_area(geometry::corners(&points, t)))
            .sum();
        assert_eq!(triangles.len(), 10);
        assert!((area - 13.0).abs() < 1e-12, "{area}");
    }
}
