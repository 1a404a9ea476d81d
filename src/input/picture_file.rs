//! Pictures of image files, as they are and cut out.

use super::decode::{PictureChoice, decode_chosen};
use super::{InputError, Picture};
use crate::math::Point;

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

/// A picture as it is in the bytes of an image file, nothing taken out.
///
/// # Errors
/// [`InputError`] if it is no image of a known kind and a sensible size.
pub fn read_picture(bytes: &[u8]) -> Result<Picture, InputError> {
    read_chosen_picture(bytes, PictureChoice::Only, None)
}

/// One of the pictures in the bytes of an image file as it is, nothing taken out; of a layered file that of the layer or group whose path is `element`.
///
/// # Errors
/// As [`read_picture`], and if there is no such picture or element.
pub fn read_chosen_picture(bytes: &[u8], choice: PictureChoice, element: Option<&str>) -> Result<Picture, InputError> {
    let image = decode_chosen(bytes, choice, element)?.image;
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
