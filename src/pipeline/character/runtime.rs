//! A character as the crate's own file for playing.

use super::{Character, PipelineError};
use crate::animation::Animation;
use crate::export::runtime::{
    RuntimeAnimation, RuntimeFile, RuntimeLayer, RuntimePose, RuntimeRegion, RuntimeRegions, RuntimeTexture,
    RuntimeTie, WeightField,
};
use crate::math::{Point, point};
use crate::pipeline::LayerShape;
use crate::pipeline::art::LayerArt;
use crate::pose::PoseSet;
use crate::render::Regions;
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
        let mut drawn = puppet.layers.as_slice();
        let mut layers = Vec::new();
        for (shape, art) in self.figure.layers.iter().zip(&self.art) {
            let (own, rest) = drawn.split_at(art.regions().map_or(1, Regions::count).min(drawn.len()));
            drawn = rest;
            let layer = self.runtime_layer(shape, art, own, &encode);
            layers.push(layer.map_err(|source| PipelineError::Layer {
                layer: shape.name().to_owned(),
                source: Box::new(source),
            })?);
        }
        Ok(RuntimeFile {
            size: puppet.size.map(|side| side as u32),
            texture_sharpness: self.figure.texture_sharpness,
            poses: poses.collect(),
            field: self.field()?,
            animation: self.played(animation)?,
            layers,
        })
    }

    /// A layer that is drawn as the meshes `drawn`.
    fn runtime_layer<E: Into<Box<dyn Error + Send + Sync>>>(
        &self,
        shape: &LayerShape,
        art: &LayerArt,
        drawn: &[PuppetLayer],
        encode: impl Fn(&PuppetTexture) -> Result<Vec<u8>, E>,
    ) -> Result<RuntimeLayer, PipelineError> {
        let poses = &shape.mapping().poses;
        let in_pixels = |positions: &Vec<Point>| positions.iter().map(|p| self.camera.to_pixels(*p)).collect();
        let placed = poses
            .names()
            .iter()
            .cloned()
            .zip(poses.positions().iter().map(in_pixels));
        let mesh = PoseSet::new(poses.topology().clone(), placed.collect());
        let (textures, regions) = match (art.regions(), drawn) {
            (Some(regions), _) => (Vec::new(), Some(runtime_regions(regions, drawn, &encode)?)),
            (None, [layer, ..]) => (runtime_textures(&layer.textures, &encode)?, None),
            (None, []) => (Vec::new(), None),
        };
        Ok(RuntimeLayer {
            name: shape.name().to_owned(),
            poses: shape.poses().to_vec(),
            texture_of: art.shown_drawings().to_vec(),
            mesh: mesh.map_err(|error| PipelineError::stage(&[], None, error))?,
            rings: shape.mapping().rings.clone(),
            options: shape.options().clone(),
            tie: shape.tie.as_ref().map(|tie| RuntimeTie {
                to: tie.to,
                own: tie.own.anchors.clone(),
                other: tie.other.anchors.clone(),
            }),
            textures,
            regions,
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

/// The pictures of a layer or a region. `encode` makes a PNG file of one.
fn runtime_textures<E: Into<Box<dyn Error + Send + Sync>>>(
    textures: &[PuppetTexture],
    encode: impl Fn(&PuppetTexture) -> Result<Vec<u8>, E>,
) -> Result<Vec<RuntimeTexture>, PipelineError> {
    let texture = |texture: &PuppetTexture| {
        let size = Point::new(texture.width as f64, texture.height as f64);
        Ok(RuntimeTexture {
            name: texture.name.clone(),
            png: encode(texture).map_err(|error| PipelineError::stage(&[], None, error))?,
            places: texture.places.iter().map(|p| p.component_div(&size)).collect(),
        })
    };
    textures.iter().map(texture).collect()
}

/// The regions of a layer, whose meshes are `drawn`.
fn runtime_regions<E: Into<Box<dyn Error + Send + Sync>>>(
    regions: &Regions,
    drawn: &[PuppetLayer],
    encode: impl Fn(&PuppetTexture) -> Result<Vec<u8>, E>,
) -> Result<RuntimeRegions, PipelineError> {
    let named = regions.names().iter().zip(drawn).enumerate();
    let region = |(number, (name, layer)): (usize, (&String, &PuppetLayer))| {
        Ok(RuntimeRegion {
            name: name.clone(),
            vertices: regions.mesh(number).vertices.clone(),
            triangles: layer.triangles.clone(),
            textures: runtime_textures(&layer.textures, &encode)?,
        })
    };
    Ok(RuntimeRegions {
        regions: named.map(region).collect::<Result<_, PipelineError>>()?,
        order: regions.order().clone(),
    })
}
