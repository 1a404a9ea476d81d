//! Outlines with as many points as can be seen.
//!
//! From a point that is kept, the directions of a line that passes every later point within the tolerance are a cone, which each
//! point narrows; the last point in the cone is kept next (Imai and Iri's test of one segment, applied greedily). One pass.

use inbetween::math::{Point, point};

/// The directions in which all points so far lie within the tolerance, from its right bound to its left one.
#[derive(Clone, Copy)]
struct Cone {
    right: Point,
    left: Point,
}

/// Some points of a closed ring, in order, the first among them, so that no other is farther than `tolerance` from the edge
/// that takes its place. A ring that would have less than three is left as it is.
pub(super) fn thinned(ring: &[Point], tolerance: f64) -> Vec<Point> {
    let Some(&first) = ring.first() else { return Vec::new() };
    let mut kept = vec![first];
    let (mut from, mut last) = (first, first);
    let (mut cone, mut farthest) = (None, 0.0_f64);
    for &p in ring.iter().skip(1).chain([&first]) {
        let mut distance = (p - from).norm();
        if !(distance >= farthest && cone.is_none_or(|cone| is_within(cone, p - from))) {
            kept.push(last);
            (from, cone) = (last, None);
            distance = (p - from).norm();
        }
        farthest = distance;
        cone = narrowed(cone, p - from, distance, tolerance);
        last = p;
    }
    if kept.len() < 3 { ring.to_vec() } else { kept }
}

fn is_within(cone: Cone, direction: Point) -> bool {
    point::cross(cone.right, direction) >= 0.0 && point::cross(direction, cone.left) >= 0.0
}

/// The part of the cone whose lines pass the point `to`, seen from its apex, within the tolerance.
fn narrowed(cone: Option<Cone>, to: Point, distance: f64, tolerance: f64) -> Option<Cone> {
    if distance <= tolerance {
        return cone;
    }
    let (along, across) = (
        to * (distance * distance - tolerance * tolerance).sqrt(),
        point::perpendicular(to) * tolerance,
    );
    let own = Cone {
        right: along - across,
        left: along + across,
    };
    let Some(cone) = cone else { return Some(own) };
    Some(Cone {
        right: if point::cross(cone.right, own.right) > 0.0 {
            own.right
        } else {
            cone.right
        },
        left: if point::cross(cone.left, own.left) < 0.0 {
            own.left
        } else {
            cone.left
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn farthest_from(ring: &[Point], kept: &[Point]) -> f64 {
        // Kept points are the ring's own, in its order: what lies between two of them belongs to their edge.
        let mut worst = 0.0_f64;
        let mut k = 0;
        for p in ring {
            if k + 1 < kept.len() && *p == kept[k + 1] {
                k += 1;
            }
            let edge = (kept[k], kept[(k + 1) % kept.len()]);
            worst = worst.max(point::nearest_on_segment(*p, edge.0, edge.1).1);
        }
        worst
    }

    #[test]
    fn a_smooth_outline_needs_few_points() {
        let rim = (0..2000).map(|k| std::f64::consts::TAU * f64::from(k) / 2000.0);
        let rim: Vec<Point> = rim.map(|t| Point::new(t.cos(), t.sin()) * 200.0).collect();
        let kept = thinned(&rim, 0.05);
        assert!(kept.len() < 150, "{} points", kept.len());
        assert!(farthest_from(&rim, &kept) <= 0.05 + 1e-9);
    }

    #[test]
    fn what_is_smaller_than_the_tolerance_stays() {
        let speck: Vec<Point> = [[0.0, 0.0], [0.01, 0.0], [0.0, 0.01]].map(Point::from).to_vec();
        assert_eq!(thinned(&speck, 0.5), speck);
        assert!(thinned(&[], 0.5).is_empty());
    }

    proptest! {
        #[test]
        fn no_point_is_farther_than_the_tolerance(
            steps in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 3..200), tolerance in 0.0..0.8f64,
        ) {
            let mut at = Point::zeros();
            let walk = steps.iter().map(|&(x, y)| {
                at += Point::new(x, y);
                at
            });
            let ring: Vec<Point> = walk.collect();
            let kept = thinned(&ring, tolerance);
            prop_assert!(kept.len() <= ring.len());
            prop_assert!(farthest_from(&ring, &kept) <= tolerance + 1e-9);
        }
    }
}
