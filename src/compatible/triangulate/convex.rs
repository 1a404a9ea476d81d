//! Convex regions by clipping. They only propose points; every point taken is proven with exact predicates.

use crate::math::{Point, point};

/// A convex polygon, possibly empty.
#[derive(Debug, Clone)]
pub(super) struct Convex {
    corners: Vec<Point>,
}

impl Convex {
    pub(super) fn new(corners: Vec<Point>) -> Self {
        Self { corners }
    }

    /// Keeps what lies left of the line from `a` to `b`.
    pub(super) fn clip(&mut self, a: Point, b: Point) {
        let side = |p: Point| point::cross(b - a, p - a);
        let count = self.corners.len();
        let mut kept = Vec::with_capacity(count + 1);
        for k in 0..count {
            let (p, q) = (self.corners[k], self.corners[(k + 1) % count]);
            let (at_p, at_q) = (side(p), side(q));
            if at_p >= 0.0 {
                kept.push(p);
            }
            if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                kept.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
        self.corners = kept;
    }

    /// The centre of area and its distance to the nearest side; `None` for an empty or flat region.
    pub(super) fn centre(&self) -> Option<(Point, f64)> {
        let origin = *self.corners.first()?;
        let (mut area, mut moment) = (0.0, Point::zeros());
        for pair in self.corners[1..].windows(2) {
            let (u, v) = (pair[0] - origin, pair[1] - origin);
            let double_area = point::cross(u, v);
            area += double_area;
            moment += (u + v) * (double_area / 3.0);
        }
        if area.is_nan() || area <= 0.0 {
            return None;
        }
        let centre = origin + moment / area;
        let count = self.corners.len();
        let clearance = (0..count)
            .map(|k| point::nearest_on_segment(centre, self.corners[k], self.corners[(k + 1) % count]).1)
            .fold(f64::INFINITY, f64::min);
        (clearance > 0.0).then_some((centre, clearance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_square() {
        let mut square = Convex::new(
            [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]
                .map(Point::from)
                .to_vec(),
        );
        square.clip(Point::new(1.0, 0.0), Point::new(1.0, 2.0));
        assert_eq!(square.centre(), Some((Point::new(0.5, 1.0), 0.5)));
        square.clip(Point::new(0.0, 0.0), Point::new(0.0, 2.0));
        assert_eq!(square.centre(), None);
    }
}
