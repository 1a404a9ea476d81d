//! One closed polygon.

use crate::math::{Point, point};

/// Why a list of points is no ring.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// Fewer than three points are left once repeated neighbours are merged.
    #[error("a closed outline needs at least 3 distinct points, got {distinct}")]
    TooFewPoints {
        /// How many distinct consecutive points there were.
        distinct: usize,
    },
    /// A coordinate is NaN or infinite, or too large for exact predicates.
    #[error("point {index} at ({x}, {y}) is not finite or beyond {limit:e}; move the drawing nearer to its origin", limit = Ring::LARGEST_COORDINATE)]
    BadCoordinate {
        /// Which point of the list.
        index: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
}

/// A closed polygon: the last point joins the first. At least three points, all finite, no two neighbours equal.
///
/// It may cross itself; an [`Outline`](super::Outline) is made of rings that do not.
#[derive(Debug, Clone, PartialEq)]
pub struct Ring {
    points: Vec<Point>,
}

impl Ring {
    /// The largest absolute coordinate, in source units. Far beyond any drawing, far below the point where the
    /// products in the exact predicates overflow.
    pub const LARGEST_COORDINATE: f64 = 1e7;

    /// A ring through `points`; equal neighbours (the closing point included) are merged.
    ///
    /// # Errors
    /// [`RingError`] if a coordinate is not finite or too large, or if fewer than three distinct points are left.
    pub fn new(points: impl IntoIterator<Item = Point>) -> Result<Self, RingError> {
        let mut kept: Vec<Point> = Vec::new();
        for (index, p) in points.into_iter().enumerate() {
            // Written so that NaN fails too.
            if !(p.x.abs() <= Self::LARGEST_COORDINATE && p.y.abs() <= Self::LARGEST_COORDINATE) {
                return Err(RingError::BadCoordinate { index, x: p.x, y: p.y });
            }
            if kept.last() != Some(&p) {
                kept.push(p);
            }
        }
        while kept.len() > 1 && kept.first() == kept.last() {
            kept.pop();
        }
        if kept.len() < 3 {
            return Err(RingError::TooFewPoints { distinct: kept.len() });
        }
        Ok(Self { points: kept })
    }

    /// The points, in order.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// How many points, which is also how many edges.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a ring is never empty")]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Point `index`, counted cyclically.
    #[must_use]
    pub fn point(&self, index: usize) -> Point {
        self.points[index % self.points.len()]
    }

    /// The directed edges `(from, to)`; edge `k` starts at point `k`.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = (Point, Point)> + '_ {
        (0..self.len()).map(|k| (self.point(k), self.point(k + 1)))
    }

    /// The area, positive for a ring that turns from x to y.
    #[must_use]
    pub fn signed_area(&self) -> f64 {
        // Relative to the first point, so that a ring far from the origin loses no digits.
        let origin = self.points[0];
        0.5 * self
            .edges()
            .map(|(a, b)| point::cross(a - origin, b - origin))
            .sum::<f64>()
    }

    /// The length of the closed polygon.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.edges().map(|(a, b)| (b - a).norm()).sum()
    }

    /// The length of the diagonal of the bounding box: the size that relative tolerances refer to.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        point::diagonal(&self.points)
    }

    /// The same ring run the other way, from the same first point.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut points = self.points.clone();
        points[1..].reverse();
        Self { points }
    }

    /// The ring with every point moved by `f`.
    ///
    /// # Errors
    /// [`RingError`] if the moved points are no ring.
    pub fn map(&self, f: impl FnMut(Point) -> Point) -> Result<Self, RingError> {
        Self::new(self.points.iter().copied().map(f))
    }

    /// Whether `p` is inside, by the even-odd rule. Points on the ring may go either way.
    #[must_use]
    pub fn contains(&self, p: Point) -> bool {
        self.edges().fold(false, |inside, (a, b)| {
            let crosses = (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            inside != crosses
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Ring {
        Ring::new([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]].map(Point::from)).expect("a ring")
    }

    #[test]
    fn closing_point_is_merged_and_area_is_positive() {
        let square = square();
        assert_eq!(square.len(), 4);
        assert_eq!(square.signed_area(), 4.0);
        assert_eq!(square.reversed().signed_area(), -4.0);
        assert_eq!(square.perimeter(), 8.0);
        assert!(square.contains(Point::new(1.0, 1.0)) && !square.contains(Point::new(3.0, 1.0)));
    }

    #[test]
    fn bad_points_are_refused_by_index() {
        let refused = Ring::new([[0.0, 0.0], [1e300, 0.0], [2.0, 2.0]].map(Point::from));
        assert!(matches!(refused, Err(RingError::BadCoordinate { index: 1, .. })));
        let refused = Ring::new([[0.0, 0.0], [0.0, f64::NAN], [2.0, 2.0]].map(Point::from));
        assert!(matches!(refused, Err(RingError::BadCoordinate { index: 1, .. })));
        let refused = Ring::new([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]].map(Point::from));
        assert_eq!(refused, Err(RingError::TooFewPoints { distinct: 2 }));
    }
}
