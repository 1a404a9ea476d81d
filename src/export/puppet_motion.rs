//! What formats of deformed meshes need of an animated [`Puppet`]: keys, hidden stretches, pictures as files.

use super::keys::{Keys, place_keys};
use super::png::straight_png_bytes;
use super::{LayerFault, MotionError, WriteError};
use crate::math::Point;
use crate::math::point::is_finite;
use crate::render::{Puppet, PuppetFrame, PuppetLayer, PuppetTexture};

/// A layer less opaque than this is not seen.
const UNSEEN: f64 = 1.0 / 510.0;
/// A texture that counts for less changes no channel by half a step, and is not shown.
const FAINTEST_WEIGHT: f64 = 1.0 / 510.0;

/// A puppet and what it does.
#[derive(Debug, Clone, Copy)]
pub struct PuppetMotion<'a> {
    /// What the animation is called.
    pub name: &'a str,
    /// What is moved.
    pub puppet: &'a Puppet,
    /// In seconds, the first one 0, strictly increasing. A loop ends with its first frame again.
    pub times: &'a [f64],
    /// #times frames.
    pub frames: &'a [PuppetFrame],
    /// How far, in pixels of the frame, a vertex may be from its place at any of the times.
    pub max_error: f64,
}

/// What became of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct PuppetReport {
    /// The keys of each layer.
    pub keys: Vec<usize>,
    /// How far a vertex is from its place at any of the times, in pixels, but for the rounding of the format's numbers.
    pub worst: f64,
}

/// A layer's shapes over the animation.
pub(super) struct LayerMotion {
    /// Which samples are keys. One that does not move has one key.
    pub(super) keys: Keys,
    /// #keys x #vertices, in pixels.
    pub(super) shapes: Vec<Vec<Point>>,
}

impl PuppetMotion<'_> {
    /// Proves what the writers rely on: counts agree, indices exist, numbers are finite.
    ///
    /// # Errors
    /// [`MotionError`] that names the frame or layer.
    pub fn check(&self) -> Result<(), MotionError> {
        let Self {
            puppet, times, frames, ..
        } = *self;
        if frames.is_empty() || frames.len() != times.len() {
            return Err(MotionError::FrameCount {
                frames: frames.len(),
                times: times.len(),
            });
        }
        let is_later = |k: usize| times[k].is_finite() && (k == 0 || times[k - 1] < times[k]);
        if let Some(frame) = (0..times.len()).find(|&k| !is_later(k)) {
            return Err(MotionError::Times { frame });
        }
        if puppet.size.contains(&0) || puppet.layers.is_empty() {
            return Err(MotionError::Empty);
        }
        for (index, layer) in puppet.layers.iter().enumerate() {
            check_layer(layer).map_err(|fault| MotionError::Layer {
                layer: index,
                name: layer.name.clone(),
                fault,
            })?;
        }
        for (number, frame) in frames.iter().enumerate() {
            let mut order = frame.order.clone();
            order.sort_unstable();
            if frame.layers.len() != puppet.layers.len() || !order.into_iter().eq(0..puppet.layers.len()) {
                return Err(MotionError::FrameLayers { frame: number });
            }
            for (index, (layer, shown)) in puppet.layers.iter().zip(&frame.layers).enumerate() {
                let vertices = layer.textures.first().map_or(0, |texture| texture.places.len());
                let numbers = shown.textures.iter().chain([&shown.opacity]);
                if shown.positions.len() != vertices
                    || shown.textures.len() != layer.textures.len()
                    || !shown.positions.iter().all(|p| is_finite(*p))
                    || !numbers.into_iter().all(|x| x.is_finite())
                {
                    return Err(MotionError::FrameFit {
                        frame: number,
                        layer: index,
                        name: layer.name.clone(),
                    });
                }
            }
        }
        Ok(())
    }

    /// Whether a layer is seen in a frame.
    pub(super) fn is_seen(&self, layer: usize, frame: usize) -> bool {
        self.frames[frame].layers[layer].opacity >= UNSEEN
    }

    /// The keys and shapes of a layer; where it is not seen it may be anywhere, and rests.
    pub(super) fn layer_motion(&self, layer: usize, tolerance: f64) -> LayerMotion {
        let count = self.frames.len();
        let mut shown = (0..count).find(|&k| self.is_seen(layer, k)).unwrap_or(0);
        let samples: Vec<Vec<Point>> = (0..count)
            .map(|k| {
                if self.is_seen(layer, k) {
                    shown = k;
                }
                self.frames[shown].layers[layer].positions.clone()
            })
            .collect();
        let mut keys = place_keys(self.times, &samples, tolerance);
        if let [first, last] = keys.indices[..]
            && samples[first] == samples[last]
        {
            keys.indices.truncate(1);
        }
        let shapes = keys.indices.iter().map(|&k| samples[k].clone()).collect();
        LayerMotion { keys, shapes }
    }

    /// How opaque each texture of a layer is drawn, one upon the other, so that what is seen is their mean by weight times the
    /// layer's opacity: exactly so where all of them are opaque.
    ///
    /// With the weights `w` and the opacity `o`, texture `k` gets `o w_k / (1 - o sum of w_j for j > k)`: what those above let
    /// through is 1 minus that sum.
    pub(super) fn opacities(&self, layer: usize, frame: usize) -> Vec<f64> {
        let shown = &self.frames[frame].layers[layer];
        let weights: Vec<f64> = shown
            .textures
            .iter()
            .map(|&w| if w < FAINTEST_WEIGHT { 0.0 } else { w })
            .collect();
        let sum: f64 = weights.iter().sum();
        if sum <= 0.0 || !self.is_seen(layer, frame) {
            return vec![0.0; weights.len()];
        }
        let opacity = shown.opacity.min(1.0);
        let mut through = 1.0;
        let mut opacities = vec![0.0; weights.len()];
        for (result, weight) in opacities.iter_mut().zip(&weights).rev() {
            let part = opacity * weight / sum;
            *result = if part > 0.0 {
                (part / through).clamp(0.0, 1.0)
            } else {
                0.0
            };
            through = (through - part).max(f64::MIN_POSITIVE);
        }
        opacities
    }

    /// The one texture that stands for a layer in a frame where textures cannot be mixed: the heaviest, or none where the
    /// layer is less than half opaque.
    pub(super) fn heaviest(&self, layer: usize, frame: usize) -> Option<usize> {
        let shown = &self.frames[frame].layers[layer];
        if shown.opacity < 0.5 {
            return None;
        }
        // Of equals the first.
        (0..shown.textures.len())
            .rev()
            .max_by(|&a, &b| shown.textures[a].total_cmp(&shown.textures[b]))
    }
}

fn check_layer(layer: &PuppetLayer) -> Result<(), LayerFault> {
    let vertices = layer.textures.first().map_or(0, |texture| texture.places.len());
    if layer.triangles.is_empty() {
        return Err(LayerFault::NoTriangles);
    }
    let mut indices = layer.triangles.iter().flatten().chain(layer.rings.iter().flatten());
    if let Some(&vertex) = indices.find(|&&v| v >= vertices) {
        return Err(LayerFault::MissingVertex { vertex });
    }
    for (index, texture) in layer.textures.iter().enumerate() {
        if texture.places.len() != vertices
            || texture.width * texture.height == 0
            || texture.pixels.len() != texture.width * texture.height
            || !texture.places.iter().all(|p| is_finite(*p))
        {
            return Err(LayerFault::Texture { texture: index });
        }
    }
    Ok(())
}

/// The texture as a PNG file.
///
/// # Errors
/// [`WriteError::Encoding`] for a texture without pixels.
pub fn texture_png(texture: &PuppetTexture) -> Result<Vec<u8>, WriteError> {
    straight_png_bytes([texture.width, texture.height], texture.pixels.as_flattened(), None)
}

/// Where values that are held from one frame to the next change: the first frame, and each that differs from the one before.
pub(super) fn changes<T: PartialEq>(values: &[T]) -> Vec<usize> {
    (0..values.len())
        .filter(|&k| k == 0 || values[k] != values[k - 1])
        .collect()
}

#[cfg(test)]
pub(super) mod testing {
    use super::*;
    use crate::render::{PuppetLayerFrame, PuppetPose, Sampling};

    /// A puppet of two squares in a frame of 200 x 100. The first turns once in two seconds while its first texture gives way to
    /// the second; the second one stands still, comes before the first at half time, and vanishes at the end.
    pub(in crate::export) struct Turning {
        pub(in crate::export) puppet: Puppet,
        pub(in crate::export) times: Vec<f64>,
        pub(in crate::export) frames: Vec<PuppetFrame>,
    }

    const FRAMES: usize = 49;

    pub(in crate::export) fn turning() -> Turning {
        // The middle comes first, so that the ring is not the first vertices.
        let square = |centre: Point, angle: f64| -> Vec<Point> {
            let corner = |quarter: usize| {
                let (sine, cosine) = (angle + quarter as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
                centre + Point::new(cosine, sine) * 40.0
            };
            std::iter::once(centre).chain((0..4).map(corner)).collect()
        };
        let texture = |name: &str, colour: [u8; 4]| PuppetTexture {
            name: name.to_owned(),
            width: 8,
            height: 4,
            pixels: vec![colour; 32],
            places: [(4.0, 2.0), (8.0, 2.0), (4.0, 4.0), (0.0, 2.0), (4.0, 0.0)]
                .map(|(x, y)| Point::new(x, y))
                .to_vec(),
        };
        let layer = |name: &str, textures: Vec<PuppetTexture>| PuppetLayer {
            name: name.to_owned(),
            triangles: (0..4).map(|k| [0, 1 + k, 1 + (k + 1) % 4]).collect(),
            rings: vec![vec![1, 2, 3, 4]],
            poses: textures
                .iter()
                .enumerate()
                .map(|(k, texture)| PuppetPose {
                    name: texture.name.clone(),
                    positions: square(Point::new(100.0, 50.0), k as f64),
                    texture: k,
                })
                .collect(),
            textures,
        };
        let puppet = Puppet {
            sampling: Sampling::Smooth,
            size: [200, 100],
            layers: vec![
                layer(
                    "wheel",
                    vec![texture("red", [255, 0, 0, 255]), texture("blue", [0, 0, 255, 255])],
                ),
                layer("box", vec![texture("green", [0, 255, 0, 255])]),
            ],
        };
        let times: Vec<f64> = (0..FRAMES).map(|k| k as f64 / 24.0).collect();
        let frames = times
            .iter()
            .map(|t| PuppetFrame {
                layers: vec![
                    PuppetLayerFrame {
                        positions: square(Point::new(90.0, 50.0), t * std::f64::consts::PI),
                        textures: vec![1.0 - t / 2.0, t / 2.0],
                        opacity: 1.0,
                    },
                    PuppetLayerFrame {
                        positions: square(Point::new(150.0, 40.0), 0.0),
                        textures: vec![1.0],
                        opacity: if *t > 1.9 { 0.0 } else { 1.0 },
                    },
                ],
                order: if *t < 1.0 { vec![1, 0] } else { vec![0, 1] },
            })
            .collect();
        Turning { puppet, times, frames }
    }

    impl Turning {
        pub(in crate::export) fn motion(&self, max_error: f64) -> PuppetMotion<'_> {
            PuppetMotion {
                name: "turn",
                puppet: &self.puppet,
                times: &self.times,
                frames: &self.frames,
                max_error,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::testing::turning;
    use super::*;

    #[test]
    fn textures_drawn_upon_one_another_count_by_their_weights() {
        let mut turning = turning();
        for opacity in [1.0, 0.6] {
            turning.frames[7].layers[0].opacity = opacity;
            turning.frames[7].layers[0].textures = vec![0.3, 0.7];
            let [below, above] = turning.motion(0.0).opacities(0, 7)[..] else {
                panic!("two textures");
            };
            assert!((above - 0.7 * opacity).abs() < 1e-12);
            assert!((below * (1.0 - above) - 0.3 * opacity).abs() < 1e-12);
        }
        assert_eq!(turning.motion(0.0).opacities(0, 0), [1.0, 0.0]);
        assert_eq!(turning.motion(0.0).opacities(1, 48), [0.0]);
    }

    #[test]
    fn what_is_not_seen_rests() {
        let mut turning = turning();
        turning.frames[47].layers[1].positions[2] = Point::new(1e6, 0.0);
        let motion = turning.motion(0.1);
        assert_eq!(motion.layer_motion(1, 0.1).keys.indices, [0]);
        assert_eq!((motion.heaviest(1, 40), motion.heaviest(1, 48)), (Some(0), None));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        type Break = fn(&mut super::testing::Turning);
        let broken: [(Break, &str); 7] = [
            (|t| t.frames.clear(), "0 frames at 49"),
            (|t| t.times[3] = 0.0, "do not increase"),
            (|t| t.frames[3].order = vec![1, 1], "layers"),
            (|t| t.frames[3].layers[0].positions[1].x = f64::NAN, "'wheel'"),
            (|t| t.frames[3].layers[0].textures = vec![1.0], "'wheel'"),
            (|t| t.puppet.layers[1].triangles[0][1] = 5, "'box'"),
            (|t| t.puppet.layers[1].textures[0].pixels.truncate(31), "'box'"),
        ];
        for (damage, said) in broken {
            let mut turning = turning();
            turning.motion(0.1).check().expect("whole");
            damage(&mut turning);
            let refusal = turning.motion(0.1).check().expect_err("it is broken").to_string();
            assert!(refusal.contains(said), "{refusal}");
        }
    }
}
