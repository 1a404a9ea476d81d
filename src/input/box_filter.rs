//! Means over a square around each pixel, of four channels; outside of the picture is nothing.
//!
//! Rows, then columns, each by a running sum, which costs the same however wide the square is. Columns are taken some at a time, as they lie in
//! memory side by side. Cost O(#pixels).

use rayon::prelude::*;

/// Columns that are averaged together: a few lines of the processor's cache.
const COLUMNS_AT_ONCE: usize = 16;

/// Averages the pixels of a picture over squares of `2 radius + 1` pixels a side.
pub(super) fn box_filter(pixels: &mut [[f32; 4]], width: usize, radius: usize) {
    let width = width.max(1);
    let height = pixels.len() / width;
    pixels.par_chunks_mut(width).for_each(|row| {
        let means = running_means(|x| &row[x..=x], row.len(), radius);
        row.copy_from_slice(&means);
    });
    let blocks: Vec<Vec<[f32; 4]>> = (0..width.div_ceil(COLUMNS_AT_ONCE))
        .into_par_iter()
        .map(|block| {
            let first = block * COLUMNS_AT_ONCE;
            let end = (first + COLUMNS_AT_ONCE).min(width);
            running_means(|y| &pixels[y * width + first..y * width + end], height, radius)
        })
        .collect();
    pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (row, block) in row.chunks_mut(COLUMNS_AT_ONCE).zip(&blocks) {
            row.copy_from_slice(&block[y * row.len()..(y + 1) * row.len()]);
        }
    });
}

/// For each of `count` lines of pixels the mean of those up to `radius` lines away, pixel by pixel.
fn running_means<'a>(line: impl Fn(usize) -> &'a [[f32; 4]], count: usize, radius: usize) -> Vec<[f32; 4]> {
    let length = if count == 0 { 0 } else { line(0).len() };
    let share = 1.0 / (2 * radius + 1) as f32;
    let mut sums = vec![[0.0_f64; 4]; length];
    let mut means = Vec::with_capacity(length * count);
    for k in 0..radius.min(count) {
        add(&mut sums, line(k), 1.0);
    }
    for k in 0..count {
        if k + radius < count {
            add(&mut sums, line(k + radius), 1.0);
        }
        if k > radius {
            add(&mut sums, line(k - radius - 1), -1.0);
        }
        means.extend(sums.iter().map(|sum| sum.map(|total| total as f32 * share)));
    }
    means
}

fn add(sums: &mut [[f64; 4]], line: &[[f32; 4]], sign: f64) {
    for (sum, value) in sums.iter_mut().zip(line) {
        for (total, value) in sum.iter_mut().zip(value) {
            *total += sign * f64::from(*value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_filter_is_the_mean_of_squares() {
        for (width, height, radius) in [(40, 23, 3), (5, 9, 7), (1, 1, 2), (17, 1, 1)] {
            let value = |x: usize, y: usize| [x as f32, (y * y) as f32, ((x * 7 + y * 3) % 5) as f32, 1.0];
            let mut pixels: Vec<[f32; 4]> = (0..width * height).map(|k| value(k % width, k / width)).collect();
            box_filter(&mut pixels, width, radius);
            for (k, mean) in pixels.iter().enumerate() {
                let around = |c: usize, end: usize| c.saturating_sub(radius)..(c + radius + 1).min(end);
                let mut sum = [0.0_f32; 4];
                for (x, y) in around(k / width, height).flat_map(|y| around(k % width, width).map(move |x| (x, y))) {
                    for (total, value) in sum.iter_mut().zip(value(x, y)) {
                        *total += value;
                    }
                }
                let area = ((2 * radius + 1) * (2 * radius + 1)) as f32;
                for (mean, sum) in mean.iter().zip(sum) {
                    assert!(
                        (mean - sum / area).abs() <= 1e-5 * (sum / area).max(1.0),
                        "{k}: {mean} {sum}"
                    );
                }
            }
        }
    }
}
