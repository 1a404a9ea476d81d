//! The page of an SVG file.

use super::Canvas;
use crate::math::Point;

/// Page sizes of SVG files come in single precision: what differs from a whole number by less than this share of itself is that number.
const ROUNDING: f64 = 1e-5;

impl Canvas {
    /// A page, its numbers freed of rounding.
    pub(super) fn of_page(page: kurbo::Rect) -> Self {
        let size = page.width().abs().max(page.height().abs());
        let tidy = |v: f64| {
            if (v - v.round()).abs() < ROUNDING * size {
                v.round()
            } else {
                v
            }
        };
        Self {
            low: Point::new(tidy(page.x0), tidy(page.y0)),
            high: Point::new(tidy(page.x1), tidy(page.y1)),
        }
    }
}
