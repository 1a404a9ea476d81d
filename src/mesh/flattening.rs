//! How far vertices can move in straight lines before a triangle becomes flat.
//!
//! Source: Smith and Schaefer, "Bijective parameterization with free boundaries" (2015), section 3.3. Twice a triangle's area is
//! a quadratic of the share of the way; its first root is where it is turned over.

use super::geometry;
use crate::math::{Point, point};

/// The share of `direction` (#vertices) at which the first of `triangles` becomes flat; infinite if none does. All of them are
/// positive at `positions` (#vertices).
#[must_use]
pub(crate) fn first_flat(
    triangles: impl IntoIterator<Item = [usize; 3]>,
    positions: &[Point],
    direction: &[Point],
) -> f64 {
    triangles
        .into_iter()
        .map(|triangle| {
            let ([a, b, c], [u, v, w]) = (
                geometry::corners(positions, triangle),
                geometry::corners(direction, triangle),
            );
            let (edges, motions) = ((b - a, c - a), (v - u, w - u));
            // The doubled area is a quadratic of the share.
            let constant = point::cross(edges.0, edges.1);
            let linear = point::cross(motions.0, edges.1) + point::cross(edges.0, motions.1);
            let square = point::cross(motions.0, motions.1);
            smallest_positive_root(square, linear, constant)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Of `square t^2 + linear t + constant` with a positive constant.
fn smallest_positive_root(square: f64, linear: f64, constant: f64) -> f64 {
    let discriminant = linear * linear - 4.0 * square * constant;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // Without cancellation: both roots from the larger sum.
    let sum = -0.5 * (linear + linear.signum() * discriminant.sqrt());
    [sum / square, constant / sum]
        .into_iter()
        .filter(|root| *root > 0.0)
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_right() {
        assert_eq!(smallest_positive_root(1.0, -3.0, 2.0), 1.0);
        assert_eq!(smallest_positive_root(0.0, -2.0, 1.0), 0.5);
        assert_eq!(smallest_positive_root(1.0, 0.0, 1.0), f64::INFINITY);
    }

    #[test]
    fn a_corner_that_falls_on_the_side_across_is_flat_half_way() {
        let positions = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]].map(Point::from);
        let still = Point::zeros();
        let falling = [still, still, Point::new(0.0, -2.0)];
        assert_eq!(first_flat([[0, 1, 2]], &positions, &falling), 0.5);
        assert_eq!(first_flat([[0, 1, 2]], &positions, &[still; 3]), f64::INFINITY);
    }
}
