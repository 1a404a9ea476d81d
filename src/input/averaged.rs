//! A picture averaged down, in which what is smooth is looked for. Cost O(#pixels).

use image::RgbaImage;
use rayon::prelude::*;

/// The step of 8-bit values, of the range from black to white: nothing finer is told apart.
pub(super) const STEP: f32 = 1.0 / 255.0;

/// A colour, each channel in [0, 1].
pub(super) type Colour = [f32; 3];

/// A picture averaged down.
#[derive(Debug)]
pub(super) struct Small {
    /// Full-size pixels to one of it, along each side.
    pub(super) scale: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<Colour>,
    /// Whether all of a pixel lies in the region.
    pub(super) region: Vec<bool>,
}

impl Small {
    /// The picture averaged down to at most `longest` pixels a side; `region` has one entry a pixel.
    pub(super) fn new(image: &RgbaImage, region: Option<&[bool]>, longest: usize) -> Self {
        let (full_width, full_height) = (image.width() as usize, image.height() as usize);
        let scale = full_width.max(full_height).div_ceil(longest).max(1);
        let (width, height) = (full_width.div_ceil(scale), full_height.div_ceil(scale));
        let mut pixels = vec![Colour::default(); width * height];
        let mut inside = vec![true; width * height];
        pixels
            .par_chunks_mut(width.max(1))
            .zip(inside.par_chunks_mut(width.max(1)))
            .enumerate()
            .for_each(|(row, (pixels, inside))| {
                let mut sums = vec![[0_u32; 3]; width];
                let rows = row * scale..((row + 1) * scale).min(full_height);
                let row_count = rows.len();
                for y in rows {
                    let full = y * full_width..(y + 1) * full_width;
                    let raw = &image.as_raw()[4 * full.start..4 * full.end];
                    for (sum, raw) in sums.iter_mut().zip(raw.chunks(4 * scale)) {
                        for pixel in raw.chunks_exact(4) {
                            for (total, channel) in sum.iter_mut().zip(pixel) {
                                *total += u32::from(*channel);
                            }
                        }
                    }
                    if let Some(region) = region {
                        for (inside, region) in inside.iter_mut().zip(region[full].chunks(scale)) {
                            *inside &= !region.contains(&false);
                        }
                    }
                }
                for (column, (pixel, sum)) in pixels.iter_mut().zip(sums).enumerate() {
                    let columns = scale.min(full_width - column * scale);
                    *pixel = sum.map(|total| total as f32 * STEP / (columns * row_count) as f32);
                }
            });
        Self {
            scale,
            width,
            height,
            pixels,
            region: inside,
        }
    }
}
