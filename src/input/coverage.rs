//! How much of each pixel the drawing covers.
//!
//! 1. Where alpha varies, coverage is alpha relative to the most opaque pixel. Otherwise it comes from the distance of
//!    a pixel's colour to the background's, the most frequent colour along the border: a pixel with no background
//!    beside it is covered, and an edge pixel is covered by its distance relative to the largest distance beside it.
//!    Relative, because a pale body on white paper is as much a body as its black ink line.
//! 2. An image without intermediate values along its edges carries no sub-pixel information; its iso-line would be a
//!    staircase. It is smoothed by a binomial filter, but every pixel stays on its side of the threshold: the iso-line
//!    still passes between the same pixel centres, and nothing thin is lost.
//! 3. No value comes nearer to the threshold than [`CLEARANCE`], so that the iso-line keeps off the pixel centres, where
//!    its pieces could touch.
//!
//! The field has a frame of one empty pixel, so that the iso-line of a drawing cut off by the border closes.

use image::RgbaImage;

/// Largest colour difference in a channel, 0 to 255, that still counts as background: JPEG noise stays below it.
const BACKGROUND_TOLERANCE: u8 = 20;
/// Alpha, 0 to 255, below which the most opaque pixel counts as nothing.
const FAINTEST_ALPHA: u8 = 8;
/// Values this near to 0 or 1 count as not anti-aliased.
const FLAT: f32 = 0.04;
/// Share of edge pixels with intermediate values up to which an image counts as not anti-aliased.
const BINARY_SHARE: f64 = 0.1;
/// Least distance of a coverage from the threshold. It moves the iso-line by less than this many pixels on a sharp edge.
const CLEARANCE: f32 = 1e-3;
/// Least distance from the threshold after smoothing: the iso-line stays this fraction of a step off pixel centres.
const SMOOTH_CLEARANCE: f32 = 0.06;

/// A field of coverages with a frame of one empty pixel all around.
#[derive(Debug, Clone)]
pub(super) struct Coverage {
    /// Columns, the frame included.
    pub(super) width: usize,
    /// Rows, the frame included.
    pub(super) height: usize,
    /// Row by row, 0 to 1.
    pub(super) values: Vec<f32>,
    /// The coverages as measured, neither smoothed nor kept off the threshold, without the frame.
    pub(super) measured: Vec<f32>,
    /// Where the coverage came from.
    pub(super) source: CoverageSource,
}

/// What told drawing from background.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CoverageSource {
    /// The alpha channel.
    Alpha,
    /// The distance from this colour.
    Background([u8; 3]),
}

impl Coverage {
    /// The coverage of `image`, kept off `threshold`.
    pub(super) fn of(image: &RgbaImage, threshold: f32) -> Self {
        let (source, measured) = measure(image);
        let (inner_width, inner_height) = (image.width() as usize, image.height() as usize);
        let (width, height) = (inner_width + 2, inner_height + 2);
        let mut values = vec![0.0; width * height];
        for row in 0..inner_height {
            let start = (row + 1) * width + 1;
            values[start..start + inner_width].copy_from_slice(&measured[row * inner_width..(row + 1) * inner_width]);
        }
        let mut coverage = Self {
            width,
            height,
            values,
            measured,
            source,
        };
        if coverage.is_binary(threshold) {
            coverage.smooth(threshold);
        }
        for value in &mut coverage.values {
            *value = keep_off(*value, *value >= threshold, threshold, CLEARANCE);
        }
        coverage
    }

    fn is_binary(&self, threshold: f32) -> bool {
        let (mut steps, mut intermediate) = (0_usize, 0_usize);
        for row in self.values.chunks_exact(self.width) {
            for pair in row.windows(2) {
                if (pair[0] >= threshold) != (pair[1] >= threshold) {
                    steps += 1;
                    intermediate += usize::from(pair.iter().any(|v| *v > FLAT && *v < 1.0 - FLAT));
                }
            }
        }
        intermediate as f64 <= BINARY_SHARE * steps as f64
    }

    /// Two passes of the binomial filter (1, 4, 6, 4, 1) / 16, each value kept on its side of the threshold.
    fn smooth(&mut self, threshold: f32) {
        let inside: Vec<bool> = self.values.iter().map(|v| *v >= threshold).collect();
        let (width, height) = (self.width as isize, self.height as isize);
        for (step_x, step_y) in [(1, 0), (0, 1)] {
            let before = self.values.clone();
            let at = |x: isize, y: isize| {
                if x < 0 || y < 0 || x >= width || y >= height {
                    0.0
                } else {
                    before[(y * width + x) as usize]
                }
            };
            for y in 0..height {
                for x in 0..width {
                    let near = at(x - step_x, y - step_y) + at(x + step_x, y + step_y);
                    let far = at(x - 2 * step_x, y - 2 * step_y) + at(x + 2 * step_x, y + 2 * step_y);
                    self.values[(y * width + x) as usize] = (6.0 * at(x, y) + 4.0 * near + far) / 16.0;
                }
            }
        }
        for (value, inside) in self.values.iter_mut().zip(inside) {
            *value = keep_off(
                *value,
                inside,
                threshold,
                SMOOTH_CLEARANCE.min(0.5 * threshold.min(1.0 - threshold)),
            );
        }
    }
}

fn keep_off(value: f32, inside: bool, threshold: f32, clearance: f32) -> f32 {
    if inside {
        value.max(threshold + clearance)
    } else {
        value.min(threshold - clearance)
    }
}

fn measure(image: &RgbaImage) -> (CoverageSource, Vec<f32>) {
    let alphas = image.pixels().map(|p| p.0[3]);
    let (low, high) = alphas.fold((u8::MAX, 0), |(low, high), a| (low.min(a), high.max(a)));
    if low < high || high < FAINTEST_ALPHA {
        let most = if high < FAINTEST_ALPHA { 255.0 } else { f32::from(high) };
        let values = image.pixels().map(|p| f32::from(p.0[3]) / most).collect();
        return (CoverageSource::Alpha, values);
    }
    let background = border_colour(image);
    (CoverageSource::Background(background), from_colour(image, background))
}

/// The colour met most often along the border, channels rounded so that noise does not split it.
fn border_colour(image: &RgbaImage) -> [u8; 3] {
    let (width, height) = image.dimensions();
    let mut border: Vec<[u8; 3]> = Vec::new();
    for x in 0..width {
        border.extend([image.get_pixel(x, 0), image.get_pixel(x, height - 1)].map(|p| [p.0[0], p.0[1], p.0[2]]));
    }
    for y in 0..height {
        border.extend([image.get_pixel(0, y), image.get_pixel(width - 1, y)].map(|p| [p.0[0], p.0[1], p.0[2]]));
    }
    let bin = |colour: &[u8; 3]| colour.map(|c| c.saturating_add(8) / 16);
    border.sort_unstable_by_key(|colour| (bin(colour), *colour));
    let mut most: &[[u8; 3]] = &[];
    for group in border.chunk_by(|a, b| bin(a) == bin(b)) {
        if group.len() > most.len() {
            most = group;
        }
    }
    [0, 1, 2].map(|channel| {
        let mut values: Vec<u8> = most.iter().map(|colour| colour[channel]).collect();
        values.sort_unstable();
        values.get(values.len() / 2).copied().unwrap_or(0)
    })
}

fn from_colour(image: &RgbaImage, background: [u8; 3]) -> Vec<f32> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let difference: Vec<u8> = image
        .pixels()
        .map(|p| {
            (0..3)
                .map(|channel| p.0[channel].abs_diff(background[channel]))
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut values = Vec::with_capacity(difference.len());
    for y in 0..height {
        for x in 0..width {
            let own = difference[y * width + x];
            if own <= BACKGROUND_TOLERANCE {
                // Still a fraction, so that faint edge pixels count: noise in the open has nothing strong beside it.
                let strongest = neighbourhood(&difference, width, height, x, y).max().unwrap_or(0);
                let share = if strongest > BACKGROUND_TOLERANCE {
                    f32::from(own) / f32::from(strongest)
                } else {
                    0.0
                };
                values.push(share.min(0.5 * f32::from(own) / f32::from(BACKGROUND_TOLERANCE)));
                continue;
            }
            let (mut strongest, mut weakest) = (own, own);
            for other in neighbourhood(&difference, width, height, x, y) {
                strongest = strongest.max(other);
                weakest = weakest.min(other);
            }
            values.push(if weakest > BACKGROUND_TOLERANCE {
                1.0
            } else {
                f32::from(own) / f32::from(strongest)
            });
        }
    }
    values
}

fn neighbourhood(field: &[u8], width: usize, height: usize, x: usize, y: usize) -> impl Iterator<Item = u8> + '_ {
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| field[row * width + column]))
}
