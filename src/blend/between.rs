//! Whether a triangle stays positive while its corners move in straight lines.
//!
//! With the edges `e`, `f` from the first corner at the beginning (0) and at the end (1), twice the area after the share `t` of the way is
//! `(1 - t)^2 e0 x f0 + t (1 - t) (e0 x f1 + e1 x f0) + t^2 e1 x f1`. It is positive for all `t` from 0 to 1 if and only if both ends are and the middle term is
//! above minus twice the root of their product. Each term is computed with a bound on its rounding, so that what is said to be positive is.

use crate::math::{Point, predicate};

/// A sum of products of differences of coordinates is wrong by at most this fraction of the sum of their sizes: each difference and each product by half a unit of the last
/// place, each of at most three additions again, and as much for the bound's own rounding.
const SUM_ERROR: f64 = 8.0 * f64::EPSILON;

/// Whether a triangle with corners `start` is positive all the way while they move evenly to `end`. `false` where rounding could decide.
#[must_use]
pub(super) fn is_positive_throughout(start: [Point; 3], end: [Point; 3]) -> bool {
    let [(e0, f0), (e1, f1)] = [start, end].map(|[a, b, c]| (b - a, c - a));
    let middle = least(&[e0.x * f1.y, e1.x * f0.y], &[e0.y * f1.x, e1.y * f0.x]);
    if middle >= 0.0 {
        let is_positive = |[a, b, c]: [Point; 3]| predicate::is_positive(a, b, c);
        return is_positive(start) && is_positive(end);
    }
    let first = least(&[e0.x * f0.y], &[e0.y * f0.x]);
    let last = least(&[e1.x * f1.y], &[e1.y * f1.x]);
    // The roots of numbers below 0 are not numbers, and compare as false.
    -middle < 2.0 * (1.0 - SUM_ERROR) * first.sqrt() * last.sqrt()
}

/// What the sum of some products less that of others is at least.
fn least(added: &[f64], subtracted: &[f64]) -> f64 {
    let sum = |products: &[f64]| products.iter().sum::<f64>();
    let size: f64 = added.iter().chain(subtracted).map(|product| product.abs()).sum();
    (sum(added) - sum(subtracted)) - SUM_ERROR * size
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{point, rotation};
    use proptest::prelude::*;

    const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]];

    #[test]
    fn a_triangle_that_turns_by_less_than_half_a_turn_never_folds() {
        let start = TRIANGLE.map(Point::from);
        // Straight lines shrink what turns, to nothing for half a turn.
        for (turn_rad, stays) in [(0.5, true), (3.1, true), (std::f64::consts::PI, false)] {
            let end = start.map(|p| rotation(turn_rad) * p);
            assert_eq!(is_positive_throughout(start, end), stays, "{turn_rad}");
        }
        assert!(is_positive_throughout(start, start));
    }

    #[test]
    fn a_fold_between_two_good_frames_is_found() {
        let start = TRIANGLE.map(Point::from);
        // The triangle turned by half a turn about a point elsewhere, as good as before.
        let end = start.map(|p| Point::new(7.0, 3.0) - p);
        assert!(!is_positive_throughout(start, end));
        let mirrored = start.map(|p| Point::new(-p.x, p.y));
        assert!(!is_positive_throughout(start, mirrored));
        // A corner that goes exactly to the side across and no further.
        let mut flat = start;
        flat[2] = Point::new(1.0, 0.0);
        assert!(!is_positive_throughout(start, flat) && !is_positive_throughout(flat, start));
    }

    proptest! {
        /// What is proven is positive wherever one looks, and what is positive by far is proven.
        #[test]
        fn it_is_what_looking_shows(
            start in proptest::array::uniform3(proptest::array::uniform2(-9.0..9.0f64)),
            end in proptest::array::uniform3(proptest::array::uniform2(-9.0..9.0f64)),
        ) {
            let (start, end) = (start.map(Point::from), end.map(Point::from));
            let areas = (0..=1000).map(|k| {
                let t = f64::from(k) / 1000.0;
                let [a, b, c] = [0, 1, 2].map(|corner| start[corner] * (1.0 - t) + end[corner] * t);
                point::cross(b - a, c - a)
            });
            let least = areas.fold(f64::INFINITY, f64::min);
            if is_positive_throughout(start, end) {
                prop_assert!(least > -1e-12, "{}", least);
            } else {
                // Between two looks a quadratic of this size falls by less than this.
                prop_assert!(least < 1e-2, "{}", least);
            }
        }
    }
}
