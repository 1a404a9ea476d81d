//! The page that a drawing is on.

use crate::math::Point;

/// The rectangle of a drawing's file, in source units: all columns and rows of a bitmap, what a browser shows of an SVG file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Canvas {
    /// Its upper left corner.
    pub low: Point,
    /// Its lower right corner.
    pub high: Point,
}

impl Canvas {
    /// The canvas of a bitmap of `width` x `height` pixels.
    #[must_use]
    pub fn of_pixels(width: usize, height: usize) -> Self {
        Self {
            low: Point::zeros(),
            high: Point::new(width as f64, height as f64),
        }
    }

    /// Its width and height.
    #[must_use]
    pub fn size(&self) -> Point {
        self.high - self.low
    }

    /// The canvas moved by `shift`.
    #[must_use]
    pub fn moved(&self, shift: Point) -> Self {
        Self {
            low: self.low + shift,
            high: self.high + shift,
        }
    }

    /// The smallest canvas that has both in it.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }
}
