//! Exact decisions on the signs of determinants of double-precision coordinates.
//!
//! Every sign here is that of the exact value for the coordinates given (Shewchuk 1997, through the crate `robust`),
//! as long as no product overflows or underflows; the input stage admits only coordinates for which none does.

use std::cmp::Ordering;

use super::point::Point;

/// The side of the directed line `a b` on which `c` lies: `Greater` for a positive triangle `a b c`, `Equal` when
/// the three are collinear.
#[must_use]
pub(crate) fn orientation(a: Point, b: Point, c: Point) -> Ordering {
    let coord = |p: Point| robust::Coord { x: p.x, y: p.y };
    let determinant = robust::orient2d(coord(a), coord(b), coord(c));
    determinant.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// Whether the triangle `a b c` has positive area.
#[must_use]
pub fn is_positive(a: Point, b: Point, c: Point) -> bool {
    orientation(a, b, c) == Ordering::Greater
}

/// Twice the area of a triangle comes out wrong by at most this fraction of the sizes of the two products whose difference
/// it is (Shewchuk 1997).
const CROSS_ERROR: f64 = 4.0 * f64::EPSILON;

/// Whether twice the area of the triangle `a b c` is above `floor`, whatever rounding did: `false` where rounding could
/// decide, and where a coordinate is not finite. Costs no more than the area.
#[must_use]
pub(crate) fn surely_above(a: Point, b: Point, c: Point, floor: f64) -> bool {
    let (left, right) = ((b.x - a.x) * (c.y - a.y), (b.y - a.y) * (c.x - a.x));
    // Infinity minus infinity is not a number, and compares as false.
    left - right > floor + CROSS_ERROR * (left.abs() + right.abs())
}

/// Whether the open segments `a b` and `c d` cross in one interior point of both.
#[must_use]
pub(crate) fn cross_properly(a: Point, b: Point, c: Point, d: Point) -> bool {
    let (abc, abd) = (orientation(a, b, c), orientation(a, b, d));
    if abc == Ordering::Equal || abd == Ordering::Equal || abc == abd {
        return false;
    }
    let (cda, cdb) = (orientation(c, d, a), orientation(c, d, b));
    cda != Ordering::Equal && cdb != Ordering::Equal && cda != cdb
}

/// Whether the closed segments `a b` and `c d` share any point.
#[must_use]
pub(crate) fn touch(a: Point, b: Point, c: Point, d: Point) -> bool {
    let (abc, abd) = (orientation(a, b, c), orientation(a, b, d));
    let (cda, cdb) = (orientation(c, d, a), orientation(c, d, b));
    if abc != abd && cda != cdb {
        return true;
    }
    (abc == Ordering::Equal && in_box(c, a, b))
        || (abd == Ordering::Equal && in_box(d, a, b))
        || (cda == Ordering::Equal && in_box(a, c, d))
        || (cdb == Ordering::Equal && in_box(b, c, d))
}

/// Whether `p` lies on the closed segment `a b`.
#[must_use]
pub(crate) fn on_segment(p: Point, a: Point, b: Point) -> bool {
    orientation(a, b, p) == Ordering::Equal && in_box(p, a, b)
}

/// Whether the edge `b c` runs back over its predecessor `a b`.
#[must_use]
pub(crate) fn folds_back(a: Point, b: Point, c: Point) -> bool {
    orientation(a, b, c).is_eq() && (a - b).dot(&(c - b)) > 0.0
}

fn in_box(p: Point, a: Point, b: Point) -> bool {
    let (low, high) = (a.inf(&b), a.sup(&b));
    low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64) -> Point {
        Point::new(x, y)
    }

    #[test]
    fn orientation_is_exact_where_floating_point_is_not() {
        let (a, b) = (p(0.0, 0.0), p(1.0, 1.0));
        assert_eq!(orientation(a, b, p(0.5, 0.5)), Ordering::Equal);
        assert_eq!(orientation(a, b, p(0.5, 0.5 + f64::EPSILON / 2.0)), Ordering::Greater);
        // 12 + 12 ulp apart on a diagonal: the plain determinant returns 0 here.
        assert_eq!(
            orientation(p(12.0, 12.0), p(24.0, 24.0), p(0.5, 0.5 - f64::EPSILON / 4.0)),
            Ordering::Less
        );
    }

    #[test]
    fn segments_that_share_an_end_touch_but_do_not_cross() {
        let (a, b, c) = (p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0));
        assert!(touch(a, b, b, c));
        assert!(!cross_properly(a, b, b, c));
        assert!(cross_properly(a, c, b, p(0.0, 1.0)));
        assert!(!touch(a, b, p(2.0, 0.0), p(3.0, 0.0)));
        assert!(touch(a, b, p(0.5, 0.0), p(3.0, 0.0)));
        assert!(on_segment(p(0.5, 0.0), a, b) && !on_segment(p(1.5, 0.0), a, b));
    }
}
