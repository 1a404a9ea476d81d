//! Levels of the scale space of a drawing.

use crate::math::vectorised;

/// Numbers a pixel: a register of eight, of which the first [`CHANNELS`] are used.
pub(crate) const LANES: usize = 8;
/// Those that are used.
pub(crate) const CHANNELS: usize = 5;
/// The channels, in order: lightness, the two colour axes, ink, coverage.
pub(crate) type Pixel = [f32; LANES];

/// Standard deviations beyond which a Gaussian is cut off.
const REACH: f32 = 3.0;

/// An image with the channels of [`Appearance`](super::Appearance), in working pixels.
#[derive(Clone)]
pub struct ChannelImage {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<Pixel>,
}

impl std::fmt::Debug for ChannelImage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "ChannelImage {} x {}", self.width, self.height)
    }
}

impl ChannelImage {
    /// The value at a place between the pixels' centres, bilinear.
    pub(crate) fn at(&self, x: f32, y: f32) -> Pixel {
        let (x, y) = (
            (x - 0.5).clamp(0.0, (self.width - 1) as f32),
            (y - 0.5).clamp(0.0, (self.height - 1) as f32),
        );
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f32, y - row as f32);
        let (right, below) = (
            (column + 1).min(self.width - 1),
            (row + 1).min(self.height - 1) * self.width,
        );
        let row = row * self.width;
        let corners = [
            (&self.pixels[row + column], (1.0 - u) * (1.0 - v)),
            (&self.pixels[row + right], u * (1.0 - v)),
            (&self.pixels[below + column], (1.0 - u) * v),
            (&self.pixels[below + right], u * v),
        ];
        let mut value = [0.0; LANES];
        for (pixel, weight) in corners {
            for (value, channel) in value.iter_mut().zip(pixel) {
                *value += weight * channel;
            }
        }
        value
    }

    /// Every channel convolved with a Gaussian of this standard deviation, in pixels. What lies beyond the border counts as zero.
    pub(super) fn gaussian(&self, deviation: f32) -> Self {
        let reach = (REACH * deviation).ceil() as usize;
        let mut kernel: Vec<f32> = (0..=reach)
            .map(|k| libm::expf(-0.5 * (k as f32 / deviation) * (k as f32 / deviation)))
            .collect();
        let sum = kernel[0] + 2.0 * kernel[1..].iter().sum::<f32>();
        kernel.iter_mut().for_each(|weight| *weight /= sum);
        let (width, height) = (self.width, self.height);
        let mut across = vec![[0.0; LANES]; width * height];
        let mut down = across.clone();
        vectorised(
            #[inline(always)]
            || {
                for (row, source) in across.chunks_exact_mut(width).zip(self.pixels.chunks_exact(width)) {
                    add(row, source, kernel[0]);
                    for (offset, &weight) in kernel.iter().enumerate().skip(1).take_while(|(k, _)| *k < width) {
                        add(&mut row[offset..], source, weight);
                        add(row, &source[offset..], weight);
                    }
                }
                for y in 0..height {
                    let row = &mut down[y * width..(y + 1) * width];
                    let source = |y: usize| &across[y * width..(y + 1) * width];
                    add(row, source(y), kernel[0]);
                    for (offset, &weight) in kernel.iter().enumerate().skip(1) {
                        if y >= offset {
                            add(row, source(y - offset), weight);
                        }
                        if y + offset < height {
                            add(row, source(y + offset), weight);
                        }
                    }
                }
            },
        );
        Self {
            width,
            height,
            pixels: down,
        }
    }
}

/// Adds `weight` times `source` to `row`, as far as both go.
#[inline(always)]
fn add(row: &mut [Pixel], source: &[Pixel], weight: f32) {
    for (value, other) in row.iter_mut().zip(source) {
        for (value, other) in value.iter_mut().zip(other) {
            *value += weight * other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_spreads_to_a_gaussian_and_keeps_its_sum() {
        let (width, height) = (31, 29);
        let mut image = ChannelImage {
            width,
            height,
            pixels: vec![[0.0; LANES]; width * height],
        };
        image.pixels[14 * width + 15] = [1.0; LANES];
        let blurred = image.gaussian(2.0);
        let sum: f32 = blurred.pixels.iter().map(|pixel| pixel[3]).sum();
        assert!((sum - 1.0).abs() < 1e-4, "{sum}");
        let (middle, aside) = (blurred.pixels[14 * width + 15][0], blurred.pixels[14 * width + 17][0]);
        assert!((aside / middle - (-0.5_f32).exp()).abs() < 1e-4);
        assert_eq!(blurred.at(15.5, 14.5)[0], middle);
    }
}
