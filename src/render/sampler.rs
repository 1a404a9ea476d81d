//! Colours of many samples of one row at once.
//!
//! A texture is looked up along a straight line of texels, [`LANES`] samples at a time. First the places: for each sample
//! the index of the upper left of the four texels around it, and the parts that those four have in the average, the
//! texture's weight included; integers, in a loop that compilers turn into the widest registers there are. Then the
//! texels: two loads a sample, and the four channels side by side in one register of eight products of 16 bits.
//!
//! Places have 16 fractional bits. Parts are rounded so that they sum to the texture's weight, and only integers are
//! added: a colour does not depend on where a run of samples begins, and one that all texels share is met exactly.

use wide::{bytemuck::cast, i16x8, i32x4, u8x16};

use super::level::{Level, MOST_TEXELS};
use crate::math::Point;

/// Samples that are looked up at once.
pub(super) const LANES: usize = 16;
/// A whole channel: 255 with 8 fractional bits.
pub(super) const WHOLE_CHANNEL: u32 = 255 << 8;
/// Bits of [`WHOLE_WEIGHT`].
pub(super) const WEIGHT_BITS: u32 = 14;
/// The weights of all textures together: the largest power of two that fits 16 bits with a sign.
pub(super) const WHOLE_WEIGHT: u32 = 1 << WEIGHT_BITS;

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

/// For each of some samples the sums of its red, green, blue and alpha, each channel times the weight.
pub(super) type Sums = [i32x4; LANES];

/// Sums to which nothing is added yet.
pub(super) const NOTHING: Sums = [i32x4::ZERO; LANES];

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
        let place = |t: f64| rounded_to_whole((t - 0.5) * TEXEL) as i64;
        let length = |t: f64| rounded_to_whole(t * TEXEL).clamp(-LONGEST_STEP, LONGEST_STEP) as i32;
        Self {
            start: [place(start.x), place(start.y)],
            step: [length(step.x), length(step.y)],
        }
    }
}

/// The nearest whole number, ties to even ones, of numbers below 2^51; others stay as they are.
///
/// The sum with a number so large that it has no fractional bits is rounded by the processor; where there is no instruction to
/// round, and in programs for all processors there is none, this is much faster than a call.
#[inline(always)]
fn rounded_to_whole(value: f64) -> f64 {
    const NO_FRACTION: f64 = 1.5 * (1u64 << 52) as f64;
    if value.abs() < (1u64 << 51) as f64 {
        (value + NO_FRACTION) - NO_FRACTION
    } else {
        value
    }
}

/// What is read for some samples.
#[derive(Debug, Clone, Copy)]
struct Taps {
    /// The upper left of four texels.
    index: [u32; LANES],
    /// The parts of the two left ones, the upper one in the lower half; of the two right ones.
    left: [u32; LANES],
    right: [u32; LANES],
}

impl Taps {
    const NONE: Self = Self {
        index: [0; LANES],
        left: [0; LANES],
        right: [0; LANES],
    };

    /// Of samples `first..first + LANES` of a walk through a level. The parts of each sample sum to `weight`.
    #[inline(always)]
    fn find(&mut self, level: &Level, walk: &Walk, first: usize, weight: u32) {
        let (width, height) = (level.width() as i32, level.height() as i32);
        let start: [i32; 2] = std::array::from_fn(|axis| {
            let place = walk.start[axis].saturating_add(first as i64 * i64::from(walk.step[axis]));
            place.clamp(-FARTHEST, FARTHEST) as i32
        });
        for lane in 0..LANES {
            let place = |axis: usize, side: i32| {
                let place = start[axis] + lane as i32 * walk.step[axis];
                let place = place.max(0).min((side - 1) << FRACTION_BITS);
                let texel = (place >> FRACTION_BITS).min(side - 2);
                (texel, (place - (texel << FRACTION_BITS)) as u32)
            };
            let ((x, across), (y, down)) = (place(0, width), place(1, height));
            self.index[lane] = (y * width + x) as u32;
            let right = (weight * across) >> FRACTION_BITS;
            let lower = (weight * down) >> FRACTION_BITS;
            // Rounded down, no part exceeds the row or column it is taken from: nothing is borrowed from the upper half.
            let lower_right = (right * down) >> FRACTION_BITS;
            self.right[lane] = (right - lower_right) | lower_right << 16;
            self.left[lane] = ((weight - lower) | lower << 16) - self.right[lane];
        }
    }
}

/// Samples between texels that are read ahead: at one texel a sample, 64 bytes, as much as a cache fetches at once.
const AHEAD_SAMPLES: usize = 16;
/// How many rows below a walk texels are read ahead: the walk itself reads the next one, and in a moment so does the
/// row below.
const AHEAD_ROWS: i64 = 2;

/// Asks for the texels that a walk of `count` samples and the row below it are about to need, to no other end than to have
/// them near. Where a row crosses rows of texels slantwise, processors do not foresee what comes, and waiting for it took a third
/// of the time; nothing waits for what is asked for here.
#[inline(always)]
pub(super) fn read_ahead(level: &Level, walk: &Walk, count: usize) {
    let mut place = [walk.start[0], walk.start[1].saturating_add(AHEAD_ROWS << FRACTION_BITS)];
    for _ in 0..count.div_ceil(AHEAD_SAMPLES) {
        let [x, y] = place.map(|t| (t >> FRACTION_BITS).clamp(0, MOST_TEXELS as i64) as usize);
        if let Some(texel) = level.texels().get(y * level.width() + x) {
            fetch(texel);
        }
        for (place, step) in place.iter_mut().zip(walk.step) {
            *place = place.saturating_add(AHEAD_SAMPLES as i64 * i64::from(step));
        }
    }
}

/// Asks for a texel without waiting, where there is an instruction for that; elsewhere reads it.
#[inline(always)]
fn fetch(texel: &[u8; 4]) {
    #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse"))]
    safe_arch::prefetch_t0(texel);
    #[cfg(not(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse")))]
    std::hint::black_box(*texel);
}

/// Adds the colours of the samples of a walk from `first` on to `sums`, one each, times `weight`, which is at most
/// [`WHOLE_WEIGHT`]. Beyond the border the border's colour holds.
#[inline(always)]
pub(super) fn add_colours(level: &Level, walk: &Walk, first: usize, weight: u32, sums: &mut [i32x4]) {
    let mut taps = Taps::NONE;
    taps.find(level, walk, first, weight);
    let rows = level_rows(level);
    for (lane, sum) in sums.iter_mut().enumerate().take(LANES) {
        *sum += colour(rows, &taps, lane);
    }
}

/// A texture, the walk through it, and its weight.
pub(super) type Look<'a> = (&'a Level, &'a Walk, u32);

/// Paints the samples of walks, from their first on: the mean of `N` textures, whose weights sum to [`WHOLE_WEIGHT`].
///
/// As [`add_colours`] and [`rounded`] do texture by texture; here a sample's sum stays in a register.
#[inline(always)]
pub(super) fn paint<const N: usize>(looks: [Look<'_>; N], pixels: &mut [[u8; 4]]) {
    let rows = looks.map(|(level, _, _)| level_rows(level));
    let mut taps = [Taps::NONE; N];
    for (run, pixels) in pixels.chunks_mut(LANES).enumerate() {
        for (taps, (level, walk, weight)) in taps.iter_mut().zip(looks) {
            taps.find(level, walk, run * LANES, weight);
        }
        for (lane, pixel) in pixels.iter_mut().enumerate().take(LANES) {
            let mut sum = HALF;
            for k in 0..N {
                sum += colour(rows[k], &taps[k], lane);
            }
            *pixel = whole(sum);
        }
    }
}

/// The texels of a level that have one below them, and those that have one above them.
#[inline(always)]
fn level_rows(level: &Level) -> [&[[u8; 4]]; 2] {
    let lower = &level.texels()[level.width()..];
    [&level.texels()[..lower.len()], lower]
}

/// The colour at one of the samples of `taps`, times the weight.
#[inline(always)]
fn colour([upper, lower]: [&[[u8; 4]]; 2], taps: &Taps, lane: usize) -> i32x4 {
    let index = taps.index[lane] as usize;
    let range = index..index + 2;
    // Always there: places are clamped.
    let (Some([a, b]), Some([c, d])) = (upper.get(range.clone()), lower.get(range)) else {
        return i32x4::ZERO;
    };
    // Red of the upper and of the lower texel, then green: pairs that are multiplied by pairs of parts.
    let columns = u8x16::unpack_low(side_by_side(*a, *b), side_by_side(*c, *d));
    i16x8::from_u8x16_low(columns).dot(pairs(taps.left[lane]))
        + i16x8::from_u8x16_high(columns).dot(pairs(taps.right[lane]))
}

/// Two texels in the first eight lanes.
#[inline(always)]
fn side_by_side(first: [u8; 4], second: [u8; 4]) -> u8x16 {
    let both = u64::from(u32::from_le_bytes(first)) | u64::from(u32::from_le_bytes(second)) << 32;
    cast([both.to_le(), 0])
}

/// The lower and the upper half of a number in turns.
#[inline(always)]
fn pairs(halves: u32) -> i16x8 {
    let in_memory = if cfg!(target_endian = "big") {
        halves.rotate_left(16)
    } else {
        halves
    };
    cast([in_memory; 4])
}

/// Sums whose weights are whole as pixels, rounded.
#[inline(always)]
pub(super) fn rounded(sums: &Sums) -> [[u8; 4]; LANES] {
    sums.map(|sum| whole(sum + HALF))
}

/// Half of [`WHOLE_WEIGHT`] in every channel: with it, [`whole`] rounds.
const HALF: i32x4 = i32x4::new([1 << (WEIGHT_BITS - 1); 4]);

/// A sum whose weights are whole as a pixel, rounded down.
#[inline(always)]
fn whole(sum: i32x4) -> [u8; 4] {
    let channels: i32x4 = sum >> WEIGHT_BITS as i32;
    let words = i16x8::from_i32x8_saturate(cast([channels, channels]));
    let [first, ..]: [[u8; 4]; 4] = cast(u8x16::narrow_i16x8(words, words));
    first
}

/// The colours of samples `first..first + LANES` of a walk, each channel in `0..=WHOLE_CHANNEL`.
#[inline(always)]
pub(super) fn look_up(level: &Level, walk: &Walk, first: usize) -> Channels {
    let mut sums = NOTHING;
    add_colours(level, walk, first, WHOLE_WEIGHT, &mut sums);
    let mut channels = [[0; LANES]; 4];
    for (lane, sum) in sums.iter().enumerate() {
        for (channel, value) in channels.iter_mut().zip(sum.to_array()) {
            channel[lane] = value as u32 >> (WEIGHT_BITS - 8);
        }
    }
    channels
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
                    // Parts are off by a few of 16384, places by a few of 65536, times 255; values are rounded to a 256th.
                    prop_assert!((value - expected).abs() < 0.2, "{value} for {expected}");
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
        fn several_textures_average_as_their_weights_say(
            texels in prop::collection::vec(prop::array::uniform4(0u8..), 12),
            others in prop::collection::vec(prop::array::uniform4(0u8..), 35),
            start in prop::array::uniform2(-1.0..8.0f64),
            step in prop::array::uniform2(-1.5..1.5f64),
            weight in 1..WHOLE_WEIGHT,
        ) {
            let levels = [Level::new(3, 4, texels), Level::new(7, 5, others)];
            let walk = Walk::new(Point::from(start), Point::from(step));
            let mut sums = NOTHING;
            for (level, weight) in levels.iter().zip([weight, WHOLE_WEIGHT - weight]) {
                add_colours(level, &walk, 0, weight, &mut sums);
            }
            let share = weight as f32 / WHOLE_WEIGHT as f32;
            for (lane, pixel) in rounded(&sums).iter().enumerate() {
                let p = Point::from(start) + Point::from(step) * lane as f64;
                let [first, second] = [0, 1].map(|k| levels[k].sample(p.x as f32, p.y as f32));
                for k in 0..4 {
                    let expected = share * first[k] + (1.0 - share) * second[k];
                    prop_assert!((f32::from(pixel[k]) - expected).abs() < 0.7, "{pixel:?}: {expected}");
                }
            }
        }

        #[test]
        fn weights_become_whole_and_keep_their_sum(weights in prop::collection::vec(0.001..1.0f64, 1..40)) {
            let whole = whole_weights(&weights);
            let total: f64 = weights.iter().sum();
            prop_assert_eq!(whole.iter().sum::<u32>(), WHOLE_WEIGHT);
            for (found, weight) in whole.iter().zip(&weights) {
                prop_assert!((f64::from(*found) - weight / total * f64::from(WHOLE_WEIGHT)).abs() <= 0.5 * weights.len() as f64);
            }
        }
    }
}
