//! A drawing's pixels.

use super::InputError;
use super::decode::{PictureChoice, decode_chosen};
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
    /// The pixels between a first column and row and last ones, and `margin` more on every side, as far as there are any.
    pub(super) fn cropped(&self, [[left, top], [right, bottom]]: [[usize; 2]; 2], margin: usize) -> Self {
        let (left, top) = (left.saturating_sub(margin), top.saturating_sub(margin));
        let right = right.saturating_add(margin + 1).min(self.width);
        let bottom = bottom.saturating_add(margin + 1).min(self.height);
        let rows = self.pixels.chunks_exact(self.width.max(1)).take(bottom).skip(top);
        Self {
            width: right.saturating_sub(left),
            height: bottom.saturating_sub(top),
            pixels: rows.flat_map(|row| row[left..right].iter().copied()).collect(),
            origin: self.origin + Point::new(left as f64, top as f64) / self.pixels_per_unit,
            pixels_per_unit: self.pixels_per_unit,
        }
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

/// A picture as it is in the bytes of an image file, nothing taken out.
///
/// # Errors
/// [`InputError`] if it is no image of a known kind and a sensible size.
pub fn read_picture(bytes: &[u8]) -> Result<Picture, InputError> {
    read_chosen_picture(bytes, PictureChoice::Only)
}

/// One of the pictures in the bytes of an image file as it is, nothing taken out.
///
/// # Errors
/// As [`read_picture`], and if there is no such picture.
pub fn read_chosen_picture(bytes: &[u8], choice: PictureChoice) -> Result<Picture, InputError> {
    let image = decode_chosen(bytes, choice)?.image;
    Ok(Picture {
        width: image.width() as usize,
        height: image.height() as usize,
        pixels: image.pixels().map(|pixel| premultiplied(pixel.0)).collect(),
        origin: Point::zeros(),
        pixels_per_unit: 1.0,
    })
}

/// A pixel with its colours multiplied by its alpha. Most are clear or opaque.
pub(super) fn premultiplied([red, green, blue, alpha]: [u8; 4]) -> [u8; 4] {
    match alpha {
        0 => [0; 4],
        u8::MAX => [red, green, blue, alpha],
        _ => {
            let times_alpha = |c: u8| ((u16::from(c) * u16::from(alpha) + 127) / 255) as u8;
            [times_alpha(red), times_alpha(green), times_alpha(blue), alpha]
        }
    }
}
