//! Colours of many samples of one row at once.
//!
//! A texture is looked up along a straight line of texels, [`LANES`] samples at a time: places and interpolation in
//! integers, in loops that compilers turn into wide registers. Places have 16 fractional bits, of which 8 are used
//! to interpolate; a channel comes out with 8 fractional bits. Only integers are added, so a colour does not depend
//! on where a run of samples begins, and one that all texels share is met exactly.

use super::level::Level;
use crate::math::Point;

/// Samples that are looked up at once.
pub(super) const LANES: usize = 16;
/// A whole channel: 255 with 8 fractional bits.
pub(super) const WHOLE_CHANNEL: u32 = 255 << 8;
/// The weights of all textures together; a whole channel times it fits 32 bits.
pub(super) const WHOLE_WEIGHT: u32 = 1 << 16;

/// Fractional bits of a place.
const FRACTION_BITS: u32 = 16;
/// One texel.
const TEXEL: f64 = (1 << FRACTION_BITS) as f64;
/// Places further than this from the corner are moved there: twice the largest level.
const FARTHEST: i64 = 1 << 30;
/// Longer steps from sample to sample are shortened to this, 512 texels, so that a run of [`LANES`] fits 32 bits.
const LONGEST_STEP: f64 = (1 << 25) as f64;

/// Red, green, blue and alpha of some samples.
pub(super) type Channels = [[u32; LANES]; 4];

/// A straight line through a level: the places of the samples of one row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walk {
    start: [i64; 2],
    step: [i32; 2],
}

impl Walk {
    /// The walk whose first sample is at `start`, in texels from the corner of the first texel, and every further one
    /// by `step` away.
    #[inline(always)]
    pub(super) fn new(start: Point, step: Point) -> Self {
        // Casts saturate, and NaN becomes 0. Places are counted from the first texel's centre.
        let place = |t: f64| ((t - 0.5) * TEXEL).round_ties_even() as i64;
        let length = |t: f64| (t * TEXEL).round_ties_even().clamp(-LONGEST_STEP, LONGEST_STEP) as i32;
        Self {
            start: [place(start.x), place(start.y)],
            step: [length(step.x), length(step.y)],
        }
    }
}

/// The colours of samples `first..first + LANES` of a walk, each channel in `0..=WHOLE_CHANNEL`. Beyond the border the
/// border's colour holds.
#[inline(always)]
pub(super) fn look_up(level: &Level, walk: &Walk, first: usize) -> Channels {
    let (width, height) = (level.width() as i32, level.height() as i32);
    let start: [i32; 2] = std::array::from_fn(|axis| {
        let place = walk.start[axis].saturating_add(first as i64 * i64::from(walk.step[axis]));
        place.clamp(-FARTHEST, FARTHEST) as i32
    });
    let mut index = [0u32; LANES];
    let mut across = [0u32; LANES];
    let mut down = [0u32; LANES];
    for lane in 0..LANES {
        let place = |axis: usize, side: i32| {
            let place = (start[axis] + lane as i32 * walk.step[axis]).clamp(0, (side - 1) << FRACTION_BITS);
            let texel = (place >> FRACTION_BITS).min(side - 2);
            (texel, ((place - (texel << FRACTION_BITS)) >> 8) as u32)
        };
        let ((x, right), (y, below)) = (place(0, width), place(1, height));
        index[lane] = (y * width + x) as u32;
        across[lane] = right;
        down[lane] = below;
    }
    let (mut upper, mut lower) = ([0u64; LANES], [0u64; LANES]);
    let (width, texels) = (level.width(), level.texels());
    for lane in 0..LANES {
        let at = index[lane] as usize;
        upper[lane] = pair(texels, at);
        lower[lane] = pair(texels, at + width);
    }
    /// Every other channel: two channels are interpolated in one number, 16 bits for each.
    const PAIR: u32 = 0x00ff_00ff;
    let mut channels = [[0; LANES]; 4];
    for lane in 0..LANES {
        // Four weights that sum to 256.
        let (right, below) = (across[lane], down[lane]);
        let both = (right * below + 128) >> 8;
        let weights = [256 + both - right - below, right - both, below - both, both];
        let corners = [
            upper[lane] as u32,
            (upper[lane] >> 32) as u32,
            lower[lane] as u32,
            (lower[lane] >> 32) as u32,
        ];
        let (mut red_blue, mut green_alpha) = (0, 0);
        for (corner, weight) in corners.into_iter().zip(weights) {
            red_blue += (corner & PAIR) * weight;
            green_alpha += ((corner >> 8) & PAIR) * weight;
        }
        channels[0][lane] = red_blue & 0xffff;
        channels[1][lane] = green_alpha & 0xffff;
        channels[2][lane] = red_blue >> 16;
        channels[3][lane] = green_alpha >> 16;
    }
    channels
}

/// Texel `at` and the next one, the first in the lower half.
#[inline(always)]
fn pair(texels: &[[u8; 4]], at: usize) -> u64 {
    let [first, second] = [texels[at], texels[at + 1]].map(u32::from_le_bytes);
    u64::from(first) | u64::from(second) << 32
}

/// Weights as whole numbers in the same proportion that sum to [`WHOLE_WEIGHT`]; nothing if none is positive.
pub(super) fn whole_weights(weights: &[f64]) -> Vec<u32> {
    let total: f64 = weights.iter().sum();
    let mut whole: Vec<u32> = weights
        .iter()
        .map(|weight| (weight / total * f64::from(WHOLE_WEIGHT)).round() as u32)
        .collect();
    let others = |largest: usize, whole: &[u32]| -> u32 {
        let all = whole.iter().enumerate();
        all.filter(|(k, _)| *k != largest).map(|(_, weight)| weight).sum()
    };
    // What rounding left over goes where it is smallest.
    let largest = (0..weights.len()).max_by(|a, b| weights[*a].total_cmp(&weights[*b]).then(b.cmp(a)));
    if let Some(largest) = largest {
        whole[largest] = WHOLE_WEIGHT.saturating_sub(others(largest, &whole));
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn integers_agree_with_the_plain_formula(
            texels in prop::collection::vec(prop::array::uniform4(0u8..), 35),
            start in prop::array::uniform2(-4.0..12.0f64),
            step in prop::array::uniform2(-1.5..1.5f64),
        ) {
            let level = Level::new(7, 5, texels);
            let (start, step) = (Point::from(start), Point::from(step));
            let found = look_up(&level, &Walk::new(start, step), 3);
            for lane in 0..LANES {
                let p = start + step * (3 + lane) as f64;
                let expected = level.sample(p.x as f32, p.y as f32);
                for (channel, expected) in found.iter().zip(expected) {
                    let value = channel[lane] as f32 / 256.0;
                    // 255 times a 256th for either direction.
                    prop_assert!((value - expected).abs() < 2.5, "{value} for {expected}");
                }
            }
        }

        #[test]
        fn one_colour_is_met_exactly_wherever_it_is_looked_up(
            colour in prop::array::uniform4(0u8..),
            start in prop::array::uniform2(prop::num::f64::ANY),
            step in prop::array::uniform2(prop::num::f64::ANY),
            first in 0usize..100_000,
        ) {
            let level = Level::new(3, 4, vec![colour; 12]);
            let found = look_up(&level, &Walk::new(Point::from(start), Point::from(step)), first);
            for (channel, expected) in found.iter().zip(colour) {
                prop_assert!(channel.iter().all(|c| *c == u32::from(expected) << 8));
            }
        }

        #[test]
        fn weights_become_whole_and_keep_their_sum(weights in prop::collection::vec(0.001..1.0f64, 1..40)) {
            let whole = whole_weights(&weights);
            let total: f64 = weights.iter().sum();
            prop_assert_eq!(whole.iter().sum::<u32>(), WHOLE_WEIGHT);
            for (found, weight) in whole.iter().zip(&weights) {
                prop_assert!((f64::from(*found) - weight / total * 65536.0).abs() <= 0.5 * weights.len() as f64);
            }
        }
    }
}
