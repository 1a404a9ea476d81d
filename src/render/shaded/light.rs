//! How light falls on a form.

use std::sync::LazyLock;

use crate::math::Point3;
use crate::render::ColourBlend;

/// Towards the key light, the fill light; and how strong they are. Seen are x to the right, y up, z towards the eye.
const KEY: ([f64; 3], [f64; 3]) = ([-0.48, 0.62, 0.62], [1.02, 0.99, 0.94]);
const FILL: ([f64; 3], [f64; 3]) = ([0.85, 0.10, 0.45], [0.20, 0.22, 0.26]);
/// Light from above and from below.
const SKY: [f64; 3] = [0.30, 0.32, 0.35];
const GROUND: [f64; 3] = [0.13, 0.12, 0.11];
/// How far the key light reaches around the form: hard terminators look like creases.
const WRAP: f64 = 0.18;
/// The highlight.
const GLOSS: f64 = 0.10;
const GLOSS_POWER: i32 = 36;
/// The bright edge.
const RIM: f64 = 0.16;
/// How much lighter and darker grains are.
const GRAIN: f64 = 0.22;
/// Where brightness begins to level off below white.
const SHOULDER: f64 = 0.82;

/// What a form without a texture is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Look {
    /// Its colour: red, green, blue as in sRGB.
    pub colour: [u8; 3],
    /// Whether it is speckled.
    pub surface: Surface,
}

/// How even a colour is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Surface {
    /// The same everywhere.
    #[default]
    Even,
    /// Speckled.
    Grainy,
}

impl Look {
    /// The colour as the share of light that it throws back.
    pub(super) fn albedo(&self) -> [f64; 3] {
        self.colour.map(linear)
    }

    /// The light that comes from a point with a normal (of any length), seen at a sample.
    pub(super) fn light(&self, albedo: [f64; 3], normal: Point3, sample: [usize; 2]) -> [f64; 3] {
        let mut n = normal.try_normalize(0.0).unwrap_or(Point3::z());
        // The side that is seen is lit.
        if n.z < 0.0 {
            n = -n;
        }
        let [key, fill] = [KEY.0, FILL.0].map(|d| Point3::from(d).normalize());
        let wrapped = ((n.dot(&key) + WRAP) / (1.0 + WRAP)).max(0.0);
        let filled = n.dot(&fill).max(0.0);
        let upward = 0.5 + 0.5 * n.y;
        let half = (key + Point3::z()).normalize();
        let gloss = GLOSS * n.dot(&half).max(0.0).powi(GLOSS_POWER);
        let rim = RIM * (1.0 - n.z).powi(3) * upward;
        let grain = match self.surface {
            Surface::Even => 1.0,
            Surface::Grainy => 1.0 + GRAIN * speckle(sample),
        };
        std::array::from_fn(|k| {
            let around = GROUND[k] + (SKY[k] - GROUND[k]) * upward;
            let diffuse = albedo[k] * grain * (KEY.1[k] * wrapped + FILL.1[k] * filled + around);
            shouldered(diffuse + gloss + rim * (0.3 + 0.7 * albedo[k]))
        })
    }
}

/// Levels off towards white instead of clipping.
fn shouldered(light: f64) -> f64 {
    if light <= SHOULDER {
        return light;
    }
    let room = 1.0 - SHOULDER;
    let over = (light - SHOULDER) / room;
    SHOULDER + room * over / (1.0 + over)
}

/// From -1 to 1, the same for the same pixel, unlike its neighbours'.
fn speckle([x, y]: [usize; 2]) -> f64 {
    let pixel = |k: usize| (k / super::SAMPLES) as u32;
    let mut hash = pixel(x).wrapping_mul(0x9e37_79b9) ^ pixel(y).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 15)).wrapping_mul(0x2c1b_3c6d);
    hash = (hash ^ (hash >> 12)).wrapping_mul(0x297a_2d39);
    f64::from((hash ^ (hash >> 15)) & 0xffff) / f64::from(0x7fff) - 1.0
}

/// A channel of sRGB as light, from 0 to 1.
pub(super) fn linear(channel: u8) -> f64 {
    static TABLE: LazyLock<Vec<f64>> = LazyLock::new(|| {
        (0..=255u8)
            .map(|c| ColourBlend::Linear.light_of(f64::from(c) / 255.0))
            .collect()
    });
    TABLE[usize::from(channel)]
}

/// The pixel of `covered` samples out of `all` with their light added up.
pub(super) fn encoded(sum: [f64; 3], covered: usize, all: usize) -> [u8; 4] {
    if covered == 0 {
        return [0; 4];
    }
    let alpha = covered as f64 / all as f64;
    let byte = |value: f64| (255.0 * value + 0.5).clamp(0.0, 255.0) as u8;
    let channel = |k: usize| {
        let mean = sum[k] / covered as f64;
        byte(ColourBlend::Linear.value_of(mean.clamp(0.0, 1.0)) * alpha)
    };
    [channel(0), channel(1), channel(2), byte(alpha)]
}
