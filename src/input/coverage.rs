//! The field of coverages whose iso-line is the outline.
//!
//! 1. A field without intermediate values along its edges carries no sub-pixel information; its iso-line would be a
//!    staircase. It is smoothed by a binomial filter, but every pixel stays on its side of the threshold: the iso-line
//!    still passes between the same pixel centres, and nothing thin is lost.
//! 2. No value comes nearer to the threshold than [`CLEARANCE`], so that the iso-line keeps off the pixel centres, where
//!    its pieces could touch.
//!
//! The field has a frame of one empty pixel, so that the iso-line of a drawing cut off by the border closes.

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
}

impl Coverage {
    /// The coverages `measured`, row by row, kept off `threshold`.
    pub(super) fn framed(measured: &[f32], inner_width: usize, threshold: f32) -> Self {
        let inner_height = measured.len() / inner_width.max(1);
        let (width, height) = (inner_width + 2, inner_height + 2);
        let mut values = vec![0.0; width * height];
        for row in 0..inner_height {
            let start = (row + 1) * width + 1;
            values[start..start + inner_width].copy_from_slice(&measured[row * inner_width..(row + 1) * inner_width]);
        }
        let mut coverage = Self { width, height, values };
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
