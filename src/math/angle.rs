//! Angles in radians.

use std::f64::consts::{PI, TAU};

use super::point::{Point, cross};

/// The angle from direction `a` to direction `b`, in `(-pi, pi]`; 0 if either has no length.
#[must_use]
pub(crate) fn between(a: Point, b: Point) -> f64 {
    libm::atan2(cross(a, b), a.dot(&b))
}

/// The angle by which points, relative to their middle, have to be turned to come nearest to others, relative to theirs, by least squares; in `(-pi, pi]`.
#[must_use]
pub(crate) fn best_turn(pairs: impl Iterator<Item = (Point, Point)>) -> f64 {
    let turn: Point = pairs.map(|(a, b)| Point::new(a.dot(&b), cross(a, b))).sum();
    between(Point::new(1.0, 0.0), turn)
}

/// `angle_rad` moved by whole turns into `(-pi, pi]`.
#[must_use]
pub(crate) fn wrap(angle_rad: f64) -> f64 {
    let wrapped = angle_rad - TAU * (angle_rad / TAU).round();
    if wrapped <= -PI { wrapped + TAU } else { wrapped }
}

/// The angle equal to `angle_rad` up to whole turns that lies nearest to `reference_rad`.
#[must_use]
pub(crate) fn nearest_turn(angle_rad: f64, reference_rad: f64) -> f64 {
    angle_rad + TAU * ((reference_rad - angle_rad) / TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrap_keeps_pi_and_moves_minus_pi() {
        assert_eq!(wrap(PI), PI);
        assert_eq!(wrap(-PI), PI);
        assert!((wrap(7.0) - (7.0 - TAU)).abs() < 1e-15);
    }

    #[test]
    fn nearest_turn_follows_the_reference() {
        assert!((nearest_turn(0.1, 4.0 * PI) - (0.1 + 4.0 * PI)).abs() < 1e-12);
        assert_eq!(nearest_turn(0.1, 0.0), 0.1);
    }

    #[test]
    fn between_is_signed() {
        assert!((between(Point::new(1.0, 0.0), Point::new(0.0, 2.0)) - PI / 2.0).abs() < 1e-15);
        assert_eq!(between(Point::new(0.0, 0.0), Point::new(0.0, 2.0)), 0.0);
    }
}
