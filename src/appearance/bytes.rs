//! A level of the scale space in bytes, for searches that compare it at thousands of places.

use super::blur::{CHANNELS, ChannelImage, LANES, Pixel};
use crate::math::Point;

/// The channels of a pixel in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Bytes([u8; LANES]);

/// Steps a unit of difference: a hundredth is less than what differs between two drawings of one thing.
pub(crate) const STEPS_PER_UNIT: f32 = 100.0;
/// Zero of the two colour axes, which have both signs; more than a quarter of a unit beyond white and black is cut off.
const COLOUR_ZERO: f32 = 127.0;

/// A [`ChannelImage`] in bytes, with a frame around it that repeats its border.
#[derive(Debug, Clone)]
pub(crate) struct ByteImage {
    width: usize,
    height: usize,
    frame: usize,
    pixels: Vec<Bytes>,
}

impl Bytes {
    /// The channels, rounded.
    pub(crate) fn new(pixel: &Pixel) -> Self {
        let zero = [0.0, COLOUR_ZERO, COLOUR_ZERO, 0.0, 0.0, 0.0, 0.0, 0.0];
        // Conversions to integers saturate.
        Self(std::array::from_fn(|k| {
            (pixel[k] * STEPS_PER_UNIT + zero[k] + 0.5) as u8
        }))
    }

    /// The coverage, in steps.
    pub(crate) fn coverage(&self) -> u8 {
        self.0[CHANNELS - 1]
    }

    /// The sum of the absolute differences of all channels, in steps. The processor has an instruction for it.
    #[inline(always)]
    pub(crate) fn difference(&self, other: &Self) -> u32 {
        let pairs = self.0.iter().zip(&other.0);
        pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
    }
}

impl ByteImage {
    /// `image` with a frame this wide.
    pub(crate) fn new(image: &ChannelImage, frame: usize) -> Self {
        let (width, height) = (image.width, image.height);
        let mut pixels = Vec::with_capacity((width + 2 * frame) * (height + 2 * frame));
        for y in 0..height + 2 * frame {
            let row = y.saturating_sub(frame).min(height - 1) * width;
            let row = &image.pixels[row..row + width];
            pixels.extend(std::iter::repeat_n(Bytes::new(&row[0]), frame));
            pixels.extend(row.iter().map(Bytes::new));
            pixels.extend(std::iter::repeat_n(Bytes::new(&row[width - 1]), frame));
        }
        Self {
            width,
            height,
            frame,
            pixels,
        }
    }

    /// How far a pixel this far to the right and below is in [`Self::around`], relative to the middle, of a disc of radius `reach`.
    pub(crate) fn offset(&self, [across, down]: [i32; 2]) -> isize {
        down as isize * self.stride() as isize + across as isize
    }

    /// All pixels in the rows within `reach` of the pixel that holds a place, or of the nearest one; the first is `reach` rows above and
    /// `reach` columns before it. `reach` is at most the frame's width.
    #[inline(always)]
    pub(crate) fn around(&self, x: f32, y: f32, reach: usize) -> &[Bytes] {
        let column = (x as usize).min(self.width - 1) + self.frame - reach;
        let row = (y as usize).min(self.height - 1) + self.frame - reach;
        let first = row * self.stride() + column;
        &self.pixels[first..first + 2 * reach * (self.stride() + 1) + 1]
    }

    /// Columns and rows, without the frame.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The pixel that holds a place, or the nearest one.
    #[inline(always)]
    pub(crate) fn pixel(&self, place: Point) -> &Bytes {
        &self.around(place.x as f32, place.y as f32, 0)[0]
    }

    fn stride(&self) -> usize {
        self.width + 2 * self.frame
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_around_a_place_repeat_the_border() {
        let image = ChannelImage {
            width: 3,
            height: 2,
            pixels: (0..6).map(|k| [k as f32 * 0.1; LANES]).collect(),
        };
        let framed = ByteImage::new(&image, 4);
        let around = framed.around(2.9, 0.2, 2);
        let at = |across: i32, down: i32| around[(framed.offset([across + 2, down + 2])) as usize].0[3];
        assert_eq!(
            (at(0, 0), at(-1, 0), at(0, 1), at(2, 0), at(0, -2), at(-2, 2)),
            (20, 10, 50, 20, 20, 30)
        );
        assert_eq!(
            Bytes::new(&[0.5; LANES]).difference(&Bytes::new(&[0.25; LANES])),
            8 * 25
        );
    }
}
