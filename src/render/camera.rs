//! Where the character stands in the frame.

use crate::math::{Point, point};

/// A fixed camera: a scale and a shift from source units to pixels, the same for every frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    scale: f64,
    shift: Point,
    size: [usize; 2],
}

impl Camera {
    /// The free border at the tightest sides, as a fraction of the frame's shorter side.
    pub const MARGIN: f64 = 0.04;

    /// A camera that shows all of `points`, centred, in a frame of `size` pixels (columns, rows, neither 0).
    ///
    /// Nothing to show, or a single point, is shown at one pixel a unit.
    #[must_use]
    pub fn fitting<'a>(points: impl IntoIterator<Item = &'a Point>, size: [usize; 2]) -> Self {
        let (low, high) = point::bounding_box(points).unwrap_or_default();
        let extent = high - low;
        let frame = Point::new(size[0] as f64, size[1] as f64);
        let margin = Self::MARGIN * frame.min();
        let room = (frame - Point::repeat(2.0 * margin)).sup(&Point::repeat(1.0));
        let scale = (room.x / extent.x).min(room.y / extent.y);
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        Self {
            scale,
            shift: frame * 0.5 - (low + high) * (0.5 * scale),
            size,
        }
    }

    /// A camera that shows the rectangle between two corners, centred and as large as it fits, in a frame of `size` pixels (columns,
    /// rows, neither 0). What is left over is divided to whole pixels, so that in a frame whose size is a whole multiple of the rectangle's
    /// units become squares of whole pixels.
    #[must_use]
    pub fn of_canvas([low, high]: [Point; 2], size: [usize; 2]) -> Self {
        let extent = high - low;
        let frame = Point::new(size[0] as f64, size[1] as f64);
        let scale = (frame.x / extent.x).min(frame.y / extent.y);
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let room = (0.5 * (frame - extent * scale)).map(f64::floor);
        Self {
            scale,
            shift: room - low * scale,
            size,
        }
    }

    /// Pixels a source unit spans.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Columns and rows of the frame.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The place in the frame, in pixels from its upper left corner, of a place in source units.
    #[must_use]
    pub fn to_pixels(&self, p: Point) -> Point {
        p * self.scale + self.shift
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_character_fills_the_width() {
        let camera = Camera::fitting(&[Point::new(-10.0, 5.0), Point::new(90.0, 25.0)], [200, 100]);
        let left = camera.to_pixels(Point::new(-10.0, 15.0));
        assert!((left - Point::new(4.0, 50.0)).norm() < 1e-9);
        let right = camera.to_pixels(Point::new(90.0, 15.0));
        assert!((right - Point::new(196.0, 50.0)).norm() < 1e-9);
    }

    #[test]
    fn a_canvas_is_shown_as_large_as_it_fits_from_whole_pixels_on() {
        let canvas = [Point::new(10.0, -4.0), Point::new(42.0, 28.0)];
        let place = |size| {
            let camera = Camera::of_canvas(canvas, size);
            (camera.scale(), camera.to_pixels(canvas[0]))
        };
        assert_eq!(place([32, 32]), (1.0, Point::zeros()));
        assert_eq!(place([96, 96]), (3.0, Point::zeros()));
        assert_eq!(place([67, 64]), (2.0, Point::new(1.0, 0.0)));
    }

    #[test]
    fn a_single_point_stands_in_the_middle() {
        let camera = Camera::fitting(&[Point::new(7.0, 8.0)], [20, 10]);
        assert_eq!(camera.to_pixels(Point::new(7.0, 8.0)), Point::new(10.0, 5.0));
    }
}
