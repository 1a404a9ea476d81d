//! The shapes of all layers of a character, in one pose.

use super::PipelineError;
use super::layer::{LayerShape, PosedLayer};
use super::spec::CharacterSpec;
use crate::animation::Animation;
use crate::math::Point;
use crate::render::Camera;
use crate::texture::shared_texture_weights;
use crate::weights::WeightProvider;

/// How many places of the animation the camera looks at before it chooses its distance.
const CAMERA_PLACES: usize = 48;

/// The shapes of all layers.
#[derive(Debug)]
pub(super) struct Figure {
    pub(super) layers: Vec<LayerShape>,
    /// Per pose of the space, the layers from back to front.
    pub(super) draw_orders: Vec<Vec<usize>>,
    /// Per pose of the space, the one whose drawing it shows.
    originals: Vec<usize>,
    /// How sharply textures follow the nearest pose.
    pub(super) texture_sharpness: f64,
}

/// A character in one pose: the shapes of a frame, before it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// One a layer.
    pub layers: Vec<PosedLayer>,
    /// The layers from back to front.
    pub order: Vec<usize>,
}

impl Posed {
    /// Inverted triangles, over all layers.
    #[must_use]
    pub fn flipped(&self) -> usize {
        self.layers.iter().map(|layer| layer.report.flipped).sum()
    }
}

impl Figure {
    /// The shapes of a character's layers, one a layer.
    pub(super) fn new(spec: &CharacterSpec, layers: Vec<LayerShape>) -> Self {
        Self {
            draw_orders: spec.draw_order_of_poses(),
            layers,
            originals: spec.originals(),
            texture_sharpness: spec.texture.sharpness,
        }
    }

    /// The shapes for weights that sum to 1.
    pub(super) fn posed(&self, weights: &[f64]) -> Result<Posed, PipelineError> {
        self.posed_sharpened(weights, None)
    }

    /// The same with textures as sharp as is said here.
    pub(super) fn posed_sharpened(&self, weights: &[f64], sharpness: Option<f64>) -> Result<Posed, PipelineError> {
        let sharpness = sharpness.unwrap_or(self.texture_sharpness);
        let shown = shared_texture_weights(weights, &self.originals, sharpness)?;
        let mut layers: Vec<PosedLayer> = (self.layers.iter())
            .map(|shape| shape.posed(weights, &shown, sharpness))
            .collect::<Result<_, _>>()?;
        // What a layer hangs on is put in its place first; a valid specification has no circle.
        let mut is_placed: Vec<bool> = self.layers.iter().map(|shape| shape.hangs_on().is_none()).collect();
        for _ in 0..self.layers.len() {
            for (k, shape) in self.layers.iter().enumerate() {
                let Some(to) = shape.hangs_on().filter(|&to| !is_placed[k] && is_placed[to]) else {
                    continue;
                };
                let gap = shape.gap(&layers[k], &layers[to]);
                for position in &mut layers[k].positions {
                    *position += gap;
                }
                is_placed[k] = true;
            }
        }
        Ok(Posed {
            layers,
            order: self.draw_orders[strongest(&shown)].clone(),
        })
    }
}

/// The pose whose drawing is seen most; of equal ones the first.
fn strongest(shown: &[f64]) -> usize {
    (0..shown.len()).fold(0, |best, pose| if shown[pose] > shown[best] { pose } else { best })
}

/// A camera that shows all poses and the whole animation.
pub(super) fn camera(
    animation: &Animation,
    size: [usize; 2],
    figure: &Figure,
    weights: &dyn WeightProvider,
) -> Result<Camera, PipelineError> {
    let mut shown: Vec<Point> = (figure.layers.iter())
        .flat_map(|layer| &layer.mapping().outlines)
        .flat_map(|outline| outline.outer().points().iter().copied())
        .collect();
    let (start, count) = (animation.time_of_frame(0), CAMERA_PLACES);
    let mut at_place = Vec::new();
    for k in 0..count {
        let time = start + animation.duration() * k as f64 / count as f64;
        weights
            .weights(&animation.at(time), &mut at_place)
            .map_err(PipelineError::Weights)?;
        for (shape, posed) in figure.layers.iter().zip(figure.posed(&at_place)?.layers) {
            if posed.opacity > 0.0 {
                shown.extend(
                    shape
                        .silhouette
                        .at(&posed.positions, &posed.weights)
                        .into_iter()
                        .flatten(),
                );
            }
        }
    }
    Ok(Camera::fitting(&shown, size))
}
