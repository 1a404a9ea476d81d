//! Textures, blended apart from geometry.
//!
//! Source: SBE 6.3: "an interpolation can be carried out independently on the geometry of the faces and/or on the textures".
//!
//! Images of one size and weights -> their weighted mean, premultiplied, of the file's values or of light
//! ([`ColourBlend`]). The weights are those of the textures' own places, which the caller asks a
//! [`WeightProvider`](crate::weights::WeightProvider) for; they may be negative and beyond 1, and then what comes out is
//! limited to colours that exist.
//!
//! Images are decoded once into sixteen bits a channel; a blend is a weighted sum in single precision, in blocks, rounded once.
//! An image alone, with weight 1, comes out as it went in: exactly where it is opaque, and to one step of 255 of light
//! where it is not.

use super::ShapeError;
use super::shape::check_length;
use crate::math::vectorised;
use crate::render::{ColourBlend, Frame};

/// A whole channel: each of a file's 255 steps is this many.
const STEP: f32 = 256.0;
/// A whole channel.
const WHOLE: f32 = 255.0 * STEP;
/// Light's bits that the table of values leaves out: where the curve is steepest, a step of a file is two entries.
const LIGHT_BITS: u32 = 3;
/// Pixels that are summed together.
const BLOCK: usize = 16;

/// Images of one size.
#[derive(Clone)]
pub struct ImageBlend {
    size: [usize; 2],
    colours: ColourBlend,
    /// What is averaged, of each image row by row.
    images: Vec<Vec<[u16; 4]>>,
    /// The file's value of an amount of light, `amount >> LIGHT_BITS` being the entry; empty if values are averaged.
    values: Vec<u8>,
}

impl std::fmt::Debug for ImageBlend {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImageBlend")
            .field("size", &self.size)
            .field("colours", &self.colours)
            .field("images", &self.images.len())
            .finish_non_exhaustive()
    }
}

impl ImageBlend {
    /// Makes `images`, premultiplied as frames are, ready to be blended.
    ///
    /// # Errors
    /// [`ShapeError::OtherImageSize`] if one has another size than the first; [`ShapeError::WrongLength`] if there is none.
    pub fn new(images: &[Frame], colours: ColourBlend) -> Result<Self, ShapeError> {
        let first = images.first().ok_or(ShapeError::WrongLength {
            what: "images",
            expected: 1,
            found: 0,
        })?;
        let size = [first.width, first.height];
        for (image, frame) in images.iter().enumerate() {
            let found = [frame.width, frame.height];
            if found != size {
                return Err(ShapeError::OtherImageSize {
                    image,
                    expected: size,
                    found,
                });
            }
            check_length("pixels", size[0] * size[1], frame.pixels.len())?;
        }
        let light: Vec<f64> = (0..=255)
            .map(|value| colours.light_of(f64::from(value) / 255.0))
            .collect();
        let decoded = |[r, g, b, a]: [u8; 4]| {
            let whole = f64::from(WHOLE);
            let alpha = f64::from(a) / 255.0;
            let of = |c: u8| match (colours, a) {
                (_, 0) => 0,
                (_, 255) | (ColourBlend::Plain, _) => (light[usize::from(c.min(a))] * whole).round() as u16,
                _ => (colours.light_of(f64::from(c.min(a)) / f64::from(a)) * alpha * whole).round() as u16,
            };
            [of(r), of(g), of(b), (alpha * whole).round() as u16]
        };
        let decode = |frame: &Frame| frame.pixels.iter().map(|pixel| decoded(*pixel)).collect();
        let value = |entry: u32| {
            let middle = f64::from((entry << LIGHT_BITS) + (1 << (LIGHT_BITS - 1))) / f64::from(WHOLE);
            (colours.value_of(middle.min(1.0)) * 255.0).round() as u8
        };
        Ok(Self {
            size,
            colours,
            images: images.iter().map(decode).collect(),
            values: match colours {
                ColourBlend::Plain => Vec::new(),
                ColourBlend::Linear => (0..=WHOLE as u32 >> LIGHT_BITS).map(value).collect(),
            },
        })
    }

    /// How many images there are.
    #[must_use]
    pub fn image_count(&self) -> usize {
        self.images.len()
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The mean of the images with `weights` (#images).
    ///
    /// # Errors
    /// [`ShapeError::WrongLength`].
    pub fn blend(&self, weights: &[f64]) -> Result<Frame, ShapeError> {
        let mut frame = Frame::filled(self.size[0], self.size[1], [0; 4]);
        self.blend_into(weights, &mut frame.pixels)?;
        Ok(frame)
    }

    /// The mean of the images with `weights` (#images), into `pixels` (#rows x #columns), without allocating.
    ///
    /// # Errors
    /// [`ShapeError::WrongLength`].
    pub fn blend_into(&self, weights: &[f64], pixels: &mut [[u8; 4]]) -> Result<(), ShapeError> {
        check_length("weights", self.images.len(), weights.len())?;
        check_length("pixels", self.size[0] * self.size[1], pixels.len())?;
        for (block, out) in pixels.chunks_mut(BLOCK).enumerate() {
            let mut sums = [[0.0_f32; 4]; BLOCK];
            for (image, weight) in self.images.iter().zip(weights) {
                let (weight, from) = (*weight as f32, &image[block * BLOCK..]);
                if weight == 0.0 {
                    continue;
                }
                vectorised(
                    #[inline(always)]
                    || {
                        for (sum, pixel) in sums.iter_mut().zip(from) {
                            for (sum, channel) in sum.iter_mut().zip(pixel) {
                                *sum += weight * f32::from(*channel);
                            }
                        }
                    },
                );
            }
            for (pixel, sum) in out.iter_mut().zip(&sums) {
                *pixel = self.encoded(*sum);
            }
        }
        Ok(())
    }

    fn encoded(&self, [r, g, b, a]: [f32; 4]) -> [u8; 4] {
        let alpha = if a.is_nan() { 0.0 } else { a.clamp(0.0, WHOLE) };
        let alpha_byte = (alpha / STEP).round() as u8;
        let colour = |light: f32| match self.colours {
            ColourBlend::Plain => (light.clamp(0.0, alpha) / STEP).round() as u8,
            ColourBlend::Linear if alpha_byte == 0 => 0,
            ColourBlend::Linear => {
                let straight = (light / alpha).clamp(0.0, 1.0) * WHOLE;
                let value = self.values[straight as usize >> LIGHT_BITS];
                ((f32::from(value) * alpha / WHOLE).round() as u8).min(alpha_byte)
            }
        };
        [colour(r), colour(g), colour(b), alpha_byte]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(pixels: Vec<[u8; 4]>) -> Frame {
        Frame {
            width: pixels.len(),
            height: 1,
            pixels,
        }
    }

    #[test]
    fn an_image_alone_comes_out_as_it_went_in() {
        let opaque: Vec<[u8; 4]> = (0..=255).map(|c| [c, 255 - c, c / 3, 255]).collect();
        let translucent: Vec<[u8; 4]> = (0..=255).map(|a| [a, a / 2, 0, a]).collect();
        for colours in [ColourBlend::Plain, ColourBlend::Linear] {
            let images = [frame(opaque.clone()), frame(translucent.clone())];
            let blend = ImageBlend::new(&images, colours).expect("one size");
            assert_eq!(blend.blend(&[1.0, 0.0]).expect("two weights").pixels, opaque);
            let found = blend.blend(&[0.0, 1.0]).expect("two weights").pixels;
            for (pixel, expected) in found.iter().zip(&translucent) {
                let allowed = u8::from(colours == ColourBlend::Linear);
                for k in 0..4 {
                    assert!(pixel[k].abs_diff(expected[k]) <= allowed, "{pixel:?} for {expected:?}");
                }
            }
        }
    }

    #[test]
    fn half_the_light_is_brighter_than_half_the_value_and_nothing_leaves_the_range() {
        let images = [frame(vec![[0, 0, 0, 255]; 3]), frame(vec![[255; 4]; 3])];
        let plain = ImageBlend::new(&images, ColourBlend::Plain).expect("one size");
        let linear = ImageBlend::new(&images, ColourBlend::Linear).expect("one size");
        assert_eq!(
            plain.blend(&[0.5, 0.5]).expect("weights").pixels[0],
            [128, 128, 128, 255]
        );
        assert_eq!(
            linear.blend(&[0.5, 0.5]).expect("weights").pixels[1],
            [188, 188, 188, 255]
        );
        for blend in [plain, linear] {
            assert_eq!(blend.blend(&[-0.5, 1.5]).expect("weights").pixels[2], [255; 4]);
            assert_eq!(blend.blend(&[1.5, -0.5]).expect("weights").pixels[2], [0, 0, 0, 255]);
            assert_eq!(blend.blend(&[f64::NAN, 1.0]).expect("weights").pixels[2][3], 0);
        }
    }

    #[test]
    fn images_of_other_sizes_are_refused() {
        let images = [frame(vec![[0; 4]; 3]), frame(vec![[0; 4]; 2])];
        let error = ImageBlend::new(&images, ColourBlend::Plain).expect_err("another size");
        assert!(error.to_string().contains("image 1 is 2 x 1 pixels"), "{error}");
        assert!(ImageBlend::new(&[], ColourBlend::Plain).is_err());
        let blend = ImageBlend::new(&images[..1], ColourBlend::Plain).expect("an image");
        assert!(blend.blend(&[]).is_err());
    }
}
