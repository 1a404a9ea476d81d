//! One simple polygon's own triangulation, by exact ear clipping.
//!
//! It serves as the map on which visibility is walked; its shape does not matter, so the first ear found is taken.
//! Cost O(m^2) for the usual polygon of m vertices, O(m^3) at worst.

use crate::math::{Point, predicate};

/// The m - 2 triangles of a simple polygon of positive area; `None` if no ear is left, which for a simple polygon in
/// exact arithmetic cannot happen.
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
        if is_ear(points, &remaining, [a, b, c]) {
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

fn is_ear(points: &[Point], remaining: &[usize], [a, b, c]: [usize; 3]) -> bool {
    let (pa, pb, pc) = (points[a], points[b], points[c]);
    if !predicate::is_positive(pa, pb, pc) {
        return false;
    }
    let (low, high) = (pa.inf(&pb).inf(&pc), pa.sup(&pb).sup(&pc));
    !remaining.iter().any(|&v| {
        let p = points[v];
        let in_box = low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
        in_box
            && v != a
            && v != b
            && v != c
            && [(pa, pb), (pb, pc), (pc, pa)]
                .into_iter()
                .all(|(from, to)| predicate::orientation(from, to, p).is_ge())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::geometry;

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
