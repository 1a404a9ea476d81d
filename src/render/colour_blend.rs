//! What is averaged when colours are: the file's values, or light.
//!
//! Pictures store colours by the sRGB curve, so that equal steps look equal. Their mean is what most programs show as
//! a cross-fade. The mean of the *light*, as of two slides projected on one wall, is brighter where the colours differ much;
//! it is the physically right one for glows and photographs.
//!
//! Light is averaged over textures and over the samples of a pixel. The interpolation between the texels of one
//! texture, the outline's edge and what is put behind a frame stay plain: so a pose looks the same either way, and the
//! edge agrees with what players and editors make of a frame's alpha.

use std::sync::LazyLock;

use super::sampler::{Channels, LANES, WEIGHT_BITS, WHOLE_CHANNEL};

/// How colours of several textures are averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourBlend {
    /// Their values in the file, as most programs do.
    #[default]
    Plain,
    /// Their light: decoded by the sRGB curve, averaged, encoded again.
    Linear,
}

impl ColourBlend {
    /// What is averaged of a channel from 0 to 1.
    #[must_use]
    pub fn light_of(self, value: f64) -> f64 {
        match self {
            Self::Plain => value,
            Self::Linear if value <= 0.040_45 => value / 12.92,
            Self::Linear => libm::pow((value + 0.055) / 1.055, 2.4),
        }
    }

    /// The channel of which [`Self::light_of`] is `light`.
    #[must_use]
    pub fn value_of(self, light: f64) -> f64 {
        match self {
            Self::Plain => light,
            Self::Linear if light <= 0.003_130_8 => light * 12.92,
            Self::Linear => 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055,
        }
    }
}

/// From a texture's channels to what is averaged, and from averages to pixels. What is averaged lies in
/// `0..=WHOLE_CHANNEL`; sums have the bits of the weights more.
pub(super) trait Light: Copy + Sync {
    /// Whether what is averaged are the values as they are in the texture.
    const AS_THEY_ARE: bool;

    fn decode(self, channels: Channels) -> Channels;
    fn encode(self, sums: &Channels) -> [[u8; 4]; LANES];
}

/// [`ColourBlend::Plain`].
#[derive(Clone, Copy)]
pub(super) struct Plain;

impl Light for Plain {
    const AS_THEY_ARE: bool = true;

    #[inline(always)]
    fn decode(self, channels: Channels) -> Channels {
        channels
    }

    #[inline(always)]
    fn encode(self, sums: &Channels) -> [[u8; 4]; LANES] {
        let mut pixels = [0u32; LANES];
        for lane in 0..LANES {
            let byte = |k: usize| (sums[k][lane] + (1 << (WEIGHT_BITS + 7))) >> (WEIGHT_BITS + 8);
            pixels[lane] = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
        }
        pixels.map(u32::to_le_bytes)
    }
}

/// [`ColourBlend::Linear`].
#[derive(Clone, Copy)]
pub(super) struct Linear(&'static Tables);

impl Linear {
    pub(super) fn new() -> Self {
        static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);
        Self(&TABLES)
    }
}

impl Light for Linear {
    const AS_THEY_ARE: bool = false;

    #[inline(always)]
    fn decode(self, mut channels: Channels) -> Channels {
        for lane in 0..LANES {
            let alpha = channels[3][lane];
            for channel in &mut channels[..3] {
                let straight = unmultiplied(channel[lane], alpha);
                channel[lane] = multiplied(self.0.light_of(straight), alpha);
            }
        }
        channels
    }

    #[inline(always)]
    fn encode(self, sums: &Channels) -> [[u8; 4]; LANES] {
        std::array::from_fn(|lane| {
            let mean = |k: usize| (sums[k][lane] + (1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS;
            let alpha = mean(3);
            let byte = |k: usize| {
                let value = self.0.value_of(unmultiplied(mean(k), alpha));
                ((multiplied(value, alpha) + 128) >> 8) as u8
            };
            [byte(0), byte(1), byte(2), ((alpha + 128) >> 8) as u8]
        })
    }
}

#[inline(always)]
fn unmultiplied(channel: u32, alpha: u32) -> u32 {
    match alpha {
        0 => 0,
        WHOLE_CHANNEL => channel.min(WHOLE_CHANNEL),
        alpha => (channel * WHOLE_CHANNEL / alpha).min(WHOLE_CHANNEL),
    }
}

#[inline(always)]
fn multiplied(channel: u32, alpha: u32) -> u32 {
    match alpha {
        WHOLE_CHANNEL => channel,
        alpha => (channel * alpha + WHOLE_CHANNEL / 2) / WHOLE_CHANNEL,
    }
}

/// The sRGB curve (IEC 61966-2-1) and its inverse, from and to `0..=WHOLE_CHANNEL`.
struct Tables {
    light: Vec<u16>,
    value: Vec<u8>,
}

/// A value's bits that the table of light leaves out: 16 entries for each step of a file.
const VALUE_BITS: u32 = 4;
/// Light's bits that the table of values leaves out: where the curve is steepest, a step of a file is two entries.
const LIGHT_BITS: u32 = 3;

impl Tables {
    fn new() -> Self {
        let whole = f64::from(WHOLE_CHANNEL);
        let light = |value: f64| match value {
            v if v <= 0.04045 => v / 12.92,
            v => libm::pow((v + 0.055) / 1.055, 2.4),
        };
        let value = |light: f64| match light {
            l if l <= 0.003_130_8 => l * 12.92,
            l => 1.055 * libm::pow(l, 1.0 / 2.4) - 0.055,
        };
        Self {
            light: (0..=WHOLE_CHANNEL >> VALUE_BITS)
                .map(|entry| (light(f64::from(entry << VALUE_BITS) / whole) * whole).round() as u16)
                .collect(),
            value: (0..=WHOLE_CHANNEL >> LIGHT_BITS)
                .map(|entry| {
                    let middle = f64::from((entry << LIGHT_BITS) + (1 << (LIGHT_BITS - 1)));
                    (value((middle / whole).min(1.0)) * 255.0).round() as u8
                })
                .collect(),
        }
    }

    #[inline(always)]
    fn light_of(&self, value: u32) -> u32 {
        u32::from(self.light[(value >> VALUE_BITS) as usize])
    }

    #[inline(always)]
    fn value_of(&self, light: u32) -> u32 {
        u32::from(self.value[(light >> LIGHT_BITS) as usize]) << 8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn averaged(light: impl Light, colours: [[u8; 4]; 2]) -> [u8; 4] {
        let mut sums = [[0; LANES]; 4];
        for colour in colours {
            let decoded = light.decode(colour.map(|c| [u32::from(c) << 8; LANES]));
            for (sum, channel) in sums.iter_mut().zip(decoded) {
                for (s, c) in sum.iter_mut().zip(channel) {
                    *s += c << (WEIGHT_BITS - 1);
                }
            }
        }
        light.encode(&sums)[5]
    }

    #[test]
    fn every_colour_survives_both_ways() {
        for alpha in [255u8, 200, 128] {
            for c in 0..=alpha {
                let colour = [c, alpha - c, c / 2, alpha];
                assert_eq!(averaged(Plain, [colour; 2]), colour);
                let linear = averaged(Linear::new(), [colour; 2]);
                let allowed = u8::from(alpha != 255);
                for (found, given) in linear.iter().zip(colour) {
                    assert!(found.abs_diff(given) <= allowed, "{linear:?} for {colour:?}");
                }
            }
        }
    }

    #[test]
    fn half_the_light_is_brighter_than_half_the_value() {
        let black_and_white = [[0, 0, 0, 255], [255; 4]];
        assert_eq!(averaged(Plain, black_and_white), [128, 128, 128, 255]);
        // The sRGB value of half the light.
        assert_eq!(averaged(Linear::new(), black_and_white), [188, 188, 188, 255]);
    }

    #[test]
    fn what_is_clear_has_no_colour_to_add() {
        assert_eq!(averaged(Linear::new(), [[0; 4], [255, 0, 0, 255]]), [128, 0, 0, 128]);
        assert_eq!(averaged(Plain, [[0; 4], [255, 0, 0, 255]]), [128, 0, 0, 128]);
    }
}
