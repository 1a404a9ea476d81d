//! What lies just inside a closed curve.

use super::figure::{Appearance, PIXELS_PER_UNIT};
use crate::math::{Point, point};
use crate::outline::{ArcLength, Ring};

/// How far inside the curve it is looked, in figure units: within the line that surrounds most drawings, and behind it.
const DEPTHS: [f64; 3] = [0.015, 0.035, 0.06];
/// Channels that are compared: all but coverage, which the curve itself says.
const CHANNELS: usize = 4;
/// Numbers a sample.
pub(crate) const PROFILE_CHANNELS: usize = DEPTHS.len() * CHANNELS;
/// Blur of what is looked at, in working pixels.
const DEVIATION_PX: f32 = 3.0;
/// Half of the chord that gives the direction of the curve, in working pixels.
const TANGENT_REACH_PX: f64 = 4.0;

/// What is drawn just inside a closed curve, at even steps of its length.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    samples: Vec<[f32; PROFILE_CHANNELS]>,
}

impl Profile {
    /// A profile from what is seen at even steps of a curve's length, from its parameter 0 on: three depths of four channels each, in which
    /// a difference of 1 is that of black and white. `None` for no samples.
    #[must_use]
    pub fn new(samples: Vec<[f32; PROFILE_CHANNELS]>) -> Option<Self> {
        (!samples.is_empty()).then_some(Self { samples })
    }

    /// The numbers at parameter `t`, taken modulo 1, linear between the samples.
    #[must_use]
    pub fn at(&self, t: f64) -> [f32; PROFILE_CHANNELS] {
        let count = self.samples.len();
        let place = crate::math::wrapped(t) * count as f64;
        let before = (place as usize).min(count - 1);
        let along = (place - before as f64) as f32;
        let (a, b) = (&self.samples[before], &self.samples[(before + 1) % count]);
        std::array::from_fn(|k| a[k] + along * (b[k] - a[k]))
    }

    /// How much two samples differ: the sum over the channels, no more than `most` at any depth, in the mean over the depths.
    #[must_use]
    #[inline(always)]
    pub fn difference(a: &[f32; PROFILE_CHANNELS], b: &[f32; PROFILE_CHANNELS], most: f32) -> f32 {
        let mut sum = 0.0;
        for (a, b) in a.chunks_exact(CHANNELS).zip(b.chunks_exact(CHANNELS)) {
            let at_depth: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
            sum += at_depth.min(most);
        }
        sum / DEPTHS.len() as f32
    }
}

impl Appearance {
    /// What is drawn just inside each of `rings`, which are in source units and have the figure on the side to which a ring of positive area
    /// turns (a hole has it outside), in `count` even steps of its length.
    #[must_use]
    pub fn profiles(&self, rings: &[&Ring], count: usize) -> Vec<Profile> {
        let image = self.blurred(DEVIATION_PX);
        let count = count.max(1);
        let of_ring = |ring: &&Ring| {
            let arc = ArcLength::new(ring);
            let reach = (TANGENT_REACH_PX / (arc.perimeter() * self.scale())).min(0.2);
            let samples = (0..count).map(|k| {
                let t = k as f64 / count as f64;
                let chord = arc.at(t + reach) - arc.at(t - reach);
                let inward = match chord.norm() {
                    length if length > 0.0 => point::perpendicular(chord) / length,
                    _ => Point::zeros(),
                };
                let here = self.to_pixels(arc.at(t));
                let mut sample = [0.0; PROFILE_CHANNELS];
                for (values, depth) in sample.chunks_exact_mut(CHANNELS).zip(DEPTHS) {
                    let p = here + inward * (depth * PIXELS_PER_UNIT);
                    values.copy_from_slice(&image.at(p.x as f32, p.y as f32)[..CHANNELS]);
                }
                sample
            });
            Profile {
                samples: samples.collect(),
            }
        };
        rings.iter().map(of_ring).collect()
    }
}
