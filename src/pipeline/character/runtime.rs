//! A character as the crate's own file for playing.

use super::{Character, PipelineError};
use crate::animation::Animation;
use crate::export::runtime::{
    RuntimeAnimation, RuntimeFile, RuntimeLayer, RuntimePose, RuntimeTexture, RuntimeTie, WeightField,
};
use crate::math::{Point, point};
use crate::pipeline::LayerShape;
use crate::pose::PoseSet;
use crate::render::puppet::{PuppetLayer, PuppetTexture};
use std::error::Error;

/// Samples of the weights along a side of the plane.
const GRID: usize = 65;
/// How far the samples reach beyond the poses, as a fraction of their extent.
const MARGIN: f64 = 0.25;

impl Character {
    /// Everything that a player needs. `animation` is the one that is played. `encode` makes a PNG file of a texture.
    ///
    /// # Errors
    /// [`PipelineError`] if the animation leaves the pose space, or with what `encode` says as its source.
    pub fn runtime_file<E: Into<Box<dyn Error + Send + Sync>>>(
        &self,
        animation: &Animation,
        encode: impl Fn(&PuppetTexture) -> Result<Vec<u8>, E>,
    ) -> Result<RuntimeFile, PipelineError> {
        let puppet = self.puppet();
        let named = self.names.iter().zip(&self.places);
        let poses = named
            .zip(&self.figure.draw_orders)
            .map(|((name, at), order)| RuntimePose {
                name: name.clone(),
                at: at.clone(),
                order: order.clone(),
            });
        let layers = self.figure.layers.iter().zip(&puppet.layers);
        Ok(RuntimeFile {
            size: puppet.size.map(|side| side as u32),
            texture_sharpness: self.figure.texture_sharpness,
            poses: poses.collect(),
            field: self.field()?,
            animation: self.played(animation)?,
            layers: layers
                .map(|(shape, layer)| {
                    runtime_layer(shape, layer, &encode).map_err(|source| PipelineError::Layer {
                        layer: layer.name.clone(),
                        source: Box::new(source),
                    })
                })
                .collect::<Result<_, _>>()?,
        })
    }

    fn single_weights_at(&self, place: &[f64]) -> Result<Vec<f32>, PipelineError> {
        Ok(self
            .weights_at(place)?
            .into_iter()
            .map(|weight| weight as f32)
            .collect())
    }

    fn played(&self, animation: &Animation) -> Result<RuntimeAnimation, PipelineError> {
        let weights = (0..animation.frame_count())
            .map(|index| self.single_weights_at(&animation.place_of_frame(index)))
            .collect::<Result<_, _>>()?;
        Ok(RuntimeAnimation {
            fps: animation.fps,
            is_loop: animation.is_loop(),
            weights,
        })
    }

    fn field(&self) -> Result<Option<WeightField>, PipelineError> {
        let points: Option<Vec<Point>> = (self.places.iter())
            .map(|place| match place.as_slice() {
                [x, y] => Some(Point::new(*x, *y)),
                _ => None,
            })
            .collect();
        let Some((low, high)) = points.as_ref().and_then(point::bounding_box) else {
            return Ok(None);
        };
        let extent = (high - low).max();
        let margin = Point::repeat(MARGIN * if extent > 0.0 { extent } else { 1.0 });
        let (low, high) = (low - margin, high + margin);
        let step = (high - low) / (GRID - 1) as f64;
        let mut weights = Vec::new();
        for row in 0..GRID {
            for column in 0..GRID {
                weights.extend(self.single_weights_at(&[low.x + step.x * column as f64, low.y + step.y * row as f64])?);
            }
        }
        Ok(Some(WeightField {
            low: low.into(),
            high: high.into(),
            columns: GRID,
            rows: GRID,
            weights,
        }))
    }
}

fn runtime_layer<E: Into<Box<dyn Error + Send + Sync>>>(
    shape: &LayerShape,
    layer: &PuppetLayer,
    encode: impl Fn(&PuppetTexture) -> Result<Vec<u8>, E>,
) -> Result<RuntimeLayer, PipelineError> {
    let poses = layer
        .poses
        .iter()
        .map(|pose| (pose.name.clone(), pose.positions.clone()));
    let mesh = PoseSet::new(shape.mapping().poses.topology().clone(), poses.collect());
    let texture = |texture: &PuppetTexture| {
        let size = Point::new(texture.width as f64, texture.height as f64);
        Ok(RuntimeTexture {
            name: texture.name.clone(),
            png: encode(texture).map_err(|error| PipelineError::stage(&[], None, error))?,
            places: texture.places.iter().map(|p| p.component_div(&size)).collect(),
        })
    };
    Ok(RuntimeLayer {
        name: layer.name.clone(),
        poses: shape.poses().to_vec(),
        texture_of: layer.poses.iter().map(|pose| pose.texture).collect(),
        mesh: mesh.map_err(|error| PipelineError::stage(&[], None, error))?,
        rings: layer.rings.clone(),
        options: shape.options().clone(),
        tie: shape.tie.as_ref().map(|tie| RuntimeTie {
            to: tie.to,
            own: tie.own.anchors.clone(),
            other: tie.other.anchors.clone(),
        }),
        textures: layer
            .textures
            .iter()
            .map(texture)
            .collect::<Result<_, PipelineError>>()?,
    })
}
