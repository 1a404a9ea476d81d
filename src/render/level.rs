//! A picture at one resolution.
//!
//! At least two texels wide and high, so that every place has four texels around it, and at most [`MOST_TEXELS`] a
//! side, so that places fit fixed-point numbers ([`super::sampler`]).

use rayon::prelude::*;

/// The longest side of a level in texels: as long as a picture's may be.
pub(super) const MOST_TEXELS: usize = 16_384;

/// Premultiplied texels, row by row.
#[derive(Clone)]
pub(super) struct Level {
    width: usize,
    height: usize,
    texels: Vec<[u8; 4]>,
}

/// A texel of a finer level and its part in one of a coarser level.
type Share = (usize, f32);

impl Level {
    /// The level of `width` x `height` pixels; missing ones are clear. A side of one texel, or none, is made two.
    pub(super) fn new(width: usize, height: usize, mut pixels: Vec<[u8; 4]>) -> Self {
        pixels.resize(width * height, [0; 4]);
        let (wide, high) = (width.max(2), height.max(2));
        if (wide, high) != (width, height) {
            let at = |x: usize, y: usize| {
                let (x, y) = (x.min(width.saturating_sub(1)), y.min(height.saturating_sub(1)));
                pixels.get(y * width + x).copied().unwrap_or_default()
            };
            pixels = (0..wide * high).map(|i| at(i % wide, i / wide)).collect();
        }
        Self {
            width: wide,
            height: high,
            texels: pixels,
        }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    pub(super) fn texels(&self) -> &[[u8; 4]] {
        &self.texels
    }

    pub(super) fn texels_mut(&mut self) -> &mut [[u8; 4]] {
        &mut self.texels
    }

    /// The premultiplied colour at a place in texels, each channel in 0..=255, interpolated between the centres of the
    /// four texels around it. Beyond the border the border's colour holds.
    pub(super) fn sample(&self, u: f32, v: f32) -> [f32; 4] {
        // Written so that NaN becomes 0.
        let clamp = |t: f32, count: usize| (t - 0.5).max(0.0).min((count - 1) as f32);
        let (u, v) = (clamp(u, self.width), clamp(v, self.height));
        let (x, y) = ((u as usize).min(self.width - 2), (v as usize).min(self.height - 2));
        let (across, down) = (u - x as f32, v - y as f32);
        let upper = &self.texels[y * self.width..][x..x + 2];
        let lower = &self.texels[(y + 1) * self.width..][x..x + 2];
        std::array::from_fn(|k| {
            let between = |row: &[[u8; 4]]| f32::from(row[0][k]) * (1.0 - across) + f32::from(row[1][k]) * across;
            between(upper) * (1.0 - down) + between(lower) * down
        })
    }

    /// The level whose texels are `1 / ratio` texels of this one wide and high, each the mean of what it covers of this
    /// one; `ratio` at most 1.
    pub(super) fn shrunk(&self, ratio: f64) -> Self {
        let (across, down) = (shares(self.width, ratio), shares(self.height, ratio));
        let (width, height) = (across.len(), down.len());
        let mut texels = vec![[0; 4]; width * height];
        texels
            .par_chunks_exact_mut(width)
            .zip(&down)
            .for_each(|(row, sources)| {
                for (texel, columns) in row.iter_mut().zip(&across) {
                    let mut sum = [0.5; 4];
                    for (y, high) in sources {
                        let source = &self.texels[y * self.width..(y + 1) * self.width];
                        for (x, wide) in columns {
                            for (s, c) in sum.iter_mut().zip(source[*x]) {
                                *s += wide * high * f32::from(c);
                            }
                        }
                    }
                    *texel = sum.map(|s| s as u8);
                }
            });
        Self::new(width, height, texels)
    }
}

/// For each of the fewer texels along a side of `count`, what it covers of them; parts sum to 1.
fn shares(count: usize, ratio: f64) -> Vec<Vec<Share>> {
    let fewer = ((count as f64 * ratio).ceil() as usize).clamp(1, count.max(1));
    let size = 1.0 / ratio;
    (0..fewer)
        .map(|k| {
            let (start, end) = (k as f64 * size, ((k + 1) as f64 * size).min(count as f64));
            (start as usize..(end.ceil() as usize).min(count))
                .map(|t| {
                    let covered = end.min((t + 1) as f64) - start.max(t as f64);
                    (t, (covered / (end - start)) as f32)
                })
                .filter(|(_, part)| *part > 0.0)
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shrinking_takes_means_of_what_is_covered() {
        let level = Level::new(3, 2, [0, 60, 120, 0, 60, 120].map(|c| [c; 4]).to_vec());
        let half = level.shrunk(0.5);
        // The second texel covers one column only: beyond the border there is nothing to take a mean of.
        assert_eq!((half.width(), half.height()), (2, 2));
        assert_eq!(half.texels()[..2], [[30; 4], [120; 4]]);
        let two_thirds = level.shrunk(2.0 / 3.0);
        // 0 and half of 60 over 1.5 texels; half of 60 and 120.
        assert_eq!(two_thirds.texels()[..2], [[20; 4], [100; 4]]);
    }

    #[test]
    fn a_line_or_nothing_can_be_sampled() {
        let line = Level::new(1, 3, vec![[10; 4], [20; 4], [30; 4]]);
        assert_eq!(line.sample(0.5, 1.5), [20.0; 4]);
        assert_eq!(line.sample(9.0, 9.0), [30.0; 4]);
        assert_eq!(Level::new(0, 0, vec![]).sample(f32::NAN, 0.0), [0.0; 4]);
    }
}
