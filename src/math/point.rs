//! Points of the plane and the vector algebra on them.

/// A point, or a displacement, in the plane. The two share one type because the stages average points freely.
///
/// It is nalgebra's two-vector: `+`, `-`, `* f64`, `.norm()`, `.dot(&b)`, `.x`, `.y` work as expected.
pub type Point = nalgebra::Vector2<f64>;

/// The z component of the cross product of two displacements: twice the signed area they span.
#[must_use]
pub fn cross(a: Point, b: Point) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The displacement turned by a quarter turn in the positive sense, from x to y.
#[must_use]
pub fn perpendicular(a: Point) -> Point {
    Point::new(-a.y, a.x)
}

/// Whether both coordinates are finite.
#[must_use]
pub fn is_finite(a: Point) -> bool {
    a.x.is_finite() && a.y.is_finite()
}

/// The smallest axis-parallel box around some points: lowest and highest corner, or `None` for no points.
#[must_use]
pub fn bounding_box<'a>(points: impl IntoIterator<Item = &'a Point>) -> Option<(Point, Point)> {
    points.into_iter().fold(None, |bounds, p| match bounds {
        None => Some((*p, *p)),
        Some((low, high)) => Some((low.inf(p), high.sup(p))),
    })
}

/// The length of the diagonal of the bounding box of some points; 0 for no points.
#[must_use]
pub fn diagonal<'a>(points: impl IntoIterator<Item = &'a Point>) -> f64 {
    bounding_box(points).map_or(0.0, |(low, high)| (high - low).norm())
}

/// The parameter in `[0, 1]` of the point of segment `a b` nearest to `p`, and the distance to it.
#[must_use]
pub fn nearest_on_segment(p: Point, a: Point, b: Point) -> (f64, f64) {
    let along = b - a;
    let length_squared = along.norm_squared();
    let t = if length_squared > 0.0 {
        ((p - a).dot(&along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (t, (a + along * t - p).norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cross_is_positive_from_x_to_y() {
        assert_eq!(cross(Point::new(1.0, 0.0), Point::new(0.0, 1.0)), 1.0);
        assert_eq!(perpendicular(Point::new(1.0, 0.0)), Point::new(0.0, 1.0));
    }

    #[test]
    fn nearest_point_is_clamped_to_the_segment() {
        let (a, b) = (Point::new(0.0, 0.0), Point::new(2.0, 0.0));
        assert_eq!(nearest_on_segment(Point::new(1.0, 3.0), a, b), (0.5, 3.0));
        assert_eq!(nearest_on_segment(Point::new(6.0, 3.0), a, b), (1.0, 5.0));
        assert_eq!(nearest_on_segment(Point::new(3.0, 4.0), a, a), (0.0, 5.0));
    }

    #[test]
    fn bounding_box_of_nothing_is_nothing() {
        assert_eq!(bounding_box(&[]), None);
        assert_eq!(diagonal(&[Point::new(1.0, 1.0), Point::new(4.0, 5.0)]), 5.0);
    }
}
