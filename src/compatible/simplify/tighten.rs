//! Pulls the vertices of an enclosing polygon inwards until they touch what it encloses.
//!
//! Each vertex moves on the straight line towards the nearest point of the outline, as far as no outline point comes
//! to lie outside and the polygon stays simple. On that line the vertex itself never enters the outline, so an outline
//! edge can leave the polygon only with one of its ends: testing points is enough.

use super::original::OriginalRing;
use crate::math::{Point, point, predicate};

/// Sweeps over the vertices. The second still gains, the third hardly.
const SWEEPS: usize = 2;

/// Bisections of a step that cannot be taken whole: the step is found to 1/64 of its length.
const BISECTIONS: usize = 6;

/// An outline point this far outside an old edge, relative to the longer side of the swept triangle, is taken to touch
/// it. Points further out do not exist: the polygon encloses the outline.
const TOUCHING: f64 = 1e-9;

/// Tightens the rings of one pose (all of them: they must not meet) around `originals`, but for the vertices that stay.
///
/// Cost O(#vertices * (#outline points + #vertices)).
pub(super) fn tighten(rings: &mut [Vec<Point>], originals: &[OriginalRing], stays: impl Fn(usize, usize) -> bool) {
    for _ in 0..SWEEPS {
        for ring in 0..rings.len() {
            for vertex in 0..rings[ring].len() {
                if !stays(ring, vertex)
                    && let Some(moved) = pulled(rings, ring, vertex, &originals[ring])
                {
                    rings[ring][vertex] = moved;
                }
            }
        }
    }
}

/// Where the vertex can go, if it can move at all.
fn pulled(rings: &[Vec<Point>], ring: usize, vertex: usize, original: &OriginalRing) -> Option<Point> {
    let points = &rings[ring];
    let count = points.len();
    let (before, at, after) = (
        points[(vertex + count - 1) % count],
        points[vertex],
        points[(vertex + 1) % count],
    );
    let target = original.nearest_point(at);
    if target == at {
        return None;
    }
    // What is swept lies between these; most of the outline does not.
    let low = before.inf(&at).inf(&after.inf(&target));
    let high = before.sup(&at).sup(&after.sup(&target));
    let slack = TOUCHING * (high - low).norm();
    let near =
        |p: &Point| p.x >= low.x - slack && p.x <= high.x + slack && p.y >= low.y - slack && p.y <= high.y + slack;
    let obstacles: Vec<Point> = original
        .points()
        .iter()
        .copied()
        .filter(|p| near(p) && lost(before, at, after, target, *p))
        .collect();
    let allowed = |share: f64| {
        let moved = at + (target - at) * share;
        let free = moved != at && !obstacles.iter().any(|&p| lost(before, at, after, moved, p));
        (free && stays_simple(rings, ring, vertex, moved)).then_some(moved)
    };
    if let Some(moved) = allowed(1.0) {
        return Some(moved);
    }
    let (mut low, mut high, mut best) = (0.0, 1.0, None);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        match allowed(middle) {
            Some(moved) => (low, best) = (middle, Some(moved)),
            None => high = middle,
        }
    }
    best
}

/// Whether moving the vertex from `at` to `moved` leaves `p` outside: it is in one of the two triangles swept, and not
/// on a new edge.
fn lost(before: Point, at: Point, after: Point, moved: Point, p: Point) -> bool {
    swept_over(before, at, moved, p) || swept_over(after, at, moved, p)
}

/// Whether `p` is in the triangle that the segment from `fixed` to `at` sweeps as `at` goes to `moved`, its new
/// position not counted.
fn swept_over(fixed: Point, at: Point, moved: Point, p: Point) -> bool {
    let sense = predicate::orientation(fixed, at, moved);
    if sense.is_eq() {
        return false;
    }
    // Outline points that the polygon touched lie on its old edges only up to rounding: they count as inside.
    let slack = TOUCHING * (at - fixed).norm().max((moved - at).norm());
    let inside = |a: Point, b: Point| {
        let double_area = point::cross(b - a, p - a);
        let towards = if sense.is_gt() { double_area } else { -double_area };
        towards >= -slack * (b - a).norm()
    };
    inside(fixed, at) && inside(at, moved) && predicate::orientation(moved, fixed, p) == sense
}

/// Whether the polygon stays simple with the vertex at `moved`.
fn stays_simple(rings: &[Vec<Point>], ring: usize, vertex: usize, moved: Point) -> bool {
    let count = rings[ring].len();
    let (previous, next) = ((vertex + count - 1) % count, (vertex + 1) % count);
    let (before, after) = (rings[ring][previous], rings[ring][next]);
    if moved == before || moved == after {
        return false;
    }
    let folds =
        |p: Point, at: Point, q: Point| predicate::orientation(p, at, q).is_eq() && (p - at).dot(&(q - at)) > 0.0;
    if folds(before, moved, after) {
        return false;
    }
    for (other, points) in rings.iter().enumerate() {
        for edge in 0..points.len() {
            let (a, b) = (points[edge], points[(edge + 1) % points.len()]);
            if other == ring && (edge == previous || edge == vertex) {
                continue;
            }
            let ends_at_before = other == ring && (edge + 1) % count == previous;
            let starts_at_after = other == ring && edge == next;
            let meets_first = if ends_at_before {
                folds(a, before, moved)
            } else {
                predicate::touch(a, b, before, moved)
            };
            let meets_second = if starts_at_after {
                folds(b, after, moved)
            } else {
                predicate::touch(a, b, moved, after)
            };
            // In a triangle the one other edge joins both neighbours.
            let meets_first = if starts_at_after && count == 3 {
                folds(a, before, moved)
            } else {
                meets_first
            };
            if (meets_first && !(starts_at_after && count == 3)) || (meets_second && !(ends_at_before && count == 3)) {
                return false;
            }
        }
    }
    true
}

impl OriginalRing {
    fn nearest_point(&self, p: Point) -> Point {
        let points = self.points();
        let mut best = (f64::INFINITY, p);
        for (k, &a) in points.iter().enumerate() {
            // An edge that begins farther away does not come nearer.
            let reach = best.0 + self.longest_edge();
            if (a - p).norm_squared() > reach * reach {
                continue;
            }
            let b = points[(k + 1) % points.len()];
            let (along, distance) = point::nearest_on_segment(p, a, b);
            if distance < best.0 {
                best = (distance, a + (b - a) * along);
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Ring;

    #[test]
    fn a_loose_square_closes_on_its_content() {
        let content = Ring::new([[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]].map(Point::from)).expect("a ring");
        let mut rings = vec![
            [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]
                .map(Point::from)
                .to_vec(),
        ];
        tighten(&mut rings, &[OriginalRing::new(&content)], |_, _| false);
        let tight = Ring::new(rings[0].clone()).expect("a ring");
        assert!(tight.signed_area() < 6.0, "area {}", tight.signed_area());
        for p in content.points() {
            assert!(tight.contains(*p) || tight.edges().any(|(a, b)| predicate::on_segment(*p, a, b)));
        }
    }
}
