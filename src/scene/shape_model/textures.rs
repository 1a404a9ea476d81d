//! The pictures on a shape, blended in a space of their own (SBE 6.3).

use super::space::TextureSpace;
use super::{ShapeModelError, files};
use crate::render::{ColourBlend, Frame};
use crate::scene::ShapeScene;
use crate::shape3d::ImageBlend;
use crate::weights::WeightProvider;

/// The pictures and their weights.
#[derive(Debug)]
pub(super) struct Textures {
    pictures: ImageBlend,
    space: TextureSpace,
}

impl Textures {
    /// Those of a scene, if it has any.
    pub(super) fn read(scene: &ShapeScene) -> Result<Option<Self>, ShapeModelError> {
        let Some(space) = TextureSpace::new(scene)? else {
            return Ok(None);
        };
        let pictures = ImageBlend::new(&files::pictures(scene, &space.examples)?, ColourBlend::default())?;
        Ok(Some(Self { pictures, space }))
    }

    /// The picture at a place of the textures.
    pub(super) fn at(&self, place: &[f64]) -> Result<Frame, ShapeModelError> {
        Ok(self.pictures.blend(&self.space.weights.weights_at(place)?)?)
    }
}
