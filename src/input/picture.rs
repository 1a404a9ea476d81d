//! A drawing's pixels.

use crate::math::Point;

/// A premultiplied RGBA image with its place in the source's coordinates.
///
/// Pixel `(i, j)` covers the square from `origin + (i, j) / pixels_per_unit` to one pixel further. Bitmaps have origin
/// 0 and one pixel a unit; vector drawings are rasterised finer or coarser.
#[derive(Clone, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row, red, green, blue, alpha, colours multiplied by alpha; #rows x #columns entries.
    pub pixels: Vec<[u8; 4]>,
    /// Where the corner of pixel (0, 0) lies, in source units.
    pub origin: Point,
    /// How many pixels a source unit spans.
    pub pixels_per_unit: f64,
}

impl Picture {
    /// A place of the source in pixels, from the corner of pixel (0, 0).
    pub(crate) fn to_pixels(&self, place: Point) -> Point {
        (place - self.origin) * self.pixels_per_unit
    }
}

impl std::fmt::Debug for Picture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Picture")
            .field("width", &self.width)
            .field("height", &self.height)
            .field("origin", &self.origin)
            .field("pixels_per_unit", &self.pixels_per_unit)
            .finish_non_exhaustive()
    }
}
