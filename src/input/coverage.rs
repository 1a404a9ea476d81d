//! The field of coverages whose iso-line is the outline.
//!
//! 1. A field without intermediate values along its edges carries no sub-pixel information; its iso-line would be a
//!    staircase. It is smoothed by a binomial filter, but every pixel stays on its side of the threshold: the iso-line
//!    still passes between the same pixel centres, and nothing thin is lost.
//! 2. No value comes nearer to the threshold than [`CLEARANCE`], so that the iso-line keeps off the pixel centres, where
//!    its pieces could touch.
//!
//! The field has a frame of one empty pixel, so that the iso-line of a drawing cut off by the border closes.

use rayon::prelude::*;

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
    pub(super) fn framed(measured: Vec<f32>, inner_width: usize, threshold: f32) -> Self {
        let inner_height = measured.len() / inner_width.max(1);
        let (width, height) = (inner_width + 2, inner_height + 2);
        let mut values = vec![0.0; width * height];
        values[width..]
            .par_chunks_mut(width)
            .zip(measured.par_chunks_exact(inner_width.max(1)))
            .for_each(|(row, measured)| row[1..=inner_width].copy_from_slice(measured));
        // Of a large drawing this is as much memory as the filter then needs.
        drop(measured);
        let mut coverage = Self { width, height, values };
        if coverage.is_binary(threshold) {
            coverage.smooth(threshold);
        }
        coverage.values.par_chunks_mut(width).for_each(|row| {
            for value in row {
                *value = keep_off(*value, *value >= threshold, threshold, CLEARANCE);
            }
        });
        coverage
    }

    fn is_binary(&self, threshold: f32) -> bool {
        let counted = self.values.par_chunks_exact(self.width).map(|row| {
            let (mut steps, mut intermediate) = (0_usize, 0_usize);
            for pair in row.windows(2) {
                let is_step = (pair[0] >= threshold) != (pair[1] >= threshold);
                let is_soft = pair.iter().any(|v| *v > FLAT && *v < 1.0 - FLAT);
                steps += usize::from(is_step);
                intermediate += usize::from(is_step && is_soft);
            }
            (steps, intermediate)
        });
        let (steps, intermediate) = counted.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        intermediate as f64 <= BINARY_SHARE * steps as f64
    }

    /// Two passes of the binomial filter (1, 4, 6, 4, 1) / 16, each value kept on its side of the threshold.
    fn smooth(&mut self, threshold: f32) {
        let clearance = SMOOTH_CLEARANCE.min(0.5 * threshold.min(1.0 - threshold));
        let width = self.width;
        let mut along_rows = vec![0.0; self.values.len()];
        along_rows
            .par_chunks_mut(width)
            .zip(self.values.par_chunks_exact(width))
            .for_each(|(out, row)| filter_row(out, row));
        let empty = vec![0.0; width];
        let row = |k: Option<usize>| {
            k.and_then(|k| along_rows.get(k * width..(k + 1) * width))
                .unwrap_or(&empty)
        };
        self.values.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            let (above, below) = (row(y.checked_sub(1)), row(Some(y + 1)));
            let (far_above, far_below) = (row(y.checked_sub(2)), row(Some(y + 2)));
            let rows = row(Some(y))
                .iter()
                .zip(above.iter().zip(below))
                .zip(far_above.iter().zip(far_below));
            for (out, ((own, (above, below)), (far_above, far_below))) in out.iter_mut().zip(rows) {
                let inside = *out >= threshold;
                let smooth = (6.0 * own + 4.0 * (above + below) + (far_above + far_below)) / 16.0;
                *out = keep_off(smooth, inside, threshold, clearance);
            }
        });
    }
}

/// The binomial filter along a row, beyond which is nothing.
fn filter_row(out: &mut [f32], row: &[f32]) {
    let at = |k: Option<usize>| k.and_then(|k| row.get(k)).copied().unwrap_or(0.0);
    let edge = |k: usize| {
        let near = at(k.checked_sub(1)) + at(Some(k + 1));
        let far = at(k.checked_sub(2)) + at(Some(k + 2));
        (6.0 * row[k] + 4.0 * near + far) / 16.0
    };
    // A row has the two pixels of the frame at least.
    for k in [0, 1, row.len() - 2, row.len() - 1] {
        out[k] = edge(k);
    }
    for (out, window) in out.iter_mut().skip(2).zip(row.windows(5)) {
        if let [a, b, c, d, e] = window {
            *out = (6.0 * c + 4.0 * (b + d) + (a + e)) / 16.0;
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
