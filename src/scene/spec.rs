//! From a scene to the specification of its character.
//!
//! [`Scene`] -> [`CharacterSpec`]: drawings are read, names become numbers, and what only a file has (paths, lines, the layer that a
//! landmark is on) stays behind.

use rayon::prelude::*;

use super::drawings::read_drawing;
use super::settings::{Holes, Layout, PoseSource, Provider, Scene};
use super::{SceneBuildError, SceneLayer};
use crate::blend::BlendOptions;
use crate::pipeline::{
    Attachment, Character, CharacterSpec, DrawnPose, EditableWeights, LandmarkSpec, LayerSpec, PathSpec, Places,
    PoseShape, PoseSpec, SpaceSpec, TextureSpec, UnsharedHoles, WeightOptions, automatic_places, editable_weights,
    map_layer,
};
use crate::weights::{BiharmonicOptions, Range, RbfOptions};

/// What reads a drawing: of a pose, by its index, of a scene without layers, which is called so where it is one of several.
pub(super) type ReadDrawing<'a> = dyn Fn(&Scene, Option<&str>, usize) -> Result<DrawnPose, SceneBuildError> + Sync + 'a;

impl Scene {
    /// The specification of the scene's character. Its drawings are read, in parallel.
    ///
    /// # Errors
    /// [`SceneBuildError`] for the first drawing, in the scene's order, that cannot be used.
    pub fn spec(&self) -> Result<CharacterSpec, SceneBuildError> {
        self.spec_with(&read_drawing)
    }

    /// The specification of one layer, or of the whole of a scene without layers. Its drawings are read, in parallel.
    ///
    /// # Errors
    /// As [`Self::spec`].
    pub fn layer_spec(&self, layer: usize) -> Result<LayerSpec, SceneBuildError> {
        self.layer_with(layer, &read_drawing)
    }

    /// The scene's character, for frames of `size` (columns, rows) with `samples` x `samples` samples a pixel.
    ///
    /// # Errors
    /// [`SceneBuildError`] from reading or from any stage.
    pub fn character(&self, size: [usize; 2], samples: usize) -> Result<Character, SceneBuildError> {
        let made = Character::supersampled(&self.spec()?, &self.animation, size, samples);
        made.map_err(|error| self.refusal(error))
    }

    /// The drawing of one pose of a layer, by its index there, as it is used.
    ///
    /// # Errors
    /// As [`Self::spec`].
    pub fn read_drawing(&self, layer: usize, pose: usize) -> Result<DrawnPose, SceneBuildError> {
        let named = self.layers.get(layer).map(|layer| layer.name.as_str());
        read_drawing(self.of_layer(layer), named, pose)
    }

    /// The weights of a scene that is [laid out](Self::with_automatic_places); `provider` overrides its own choice.
    ///
    /// # Errors
    /// [`SceneBuildError`], naming poses, if the layout allows no weights, or if the scene asks for what only the other provider
    /// has.
    pub fn weights(&self, provider: Option<Provider>) -> Result<EditableWeights, SceneBuildError> {
        let options = self.weight_options(provider)?;
        editable_weights(&self.names(), &self.places(), &options).map_err(|error| self.refusal(error))
    }

    /// The scene with a place for every pose. If the file gives none, its drawings are read and mapped for that, which takes as
    /// long as [`map_layer`]; of a scene with layers, those of its first layer that all poses have.
    ///
    /// # Errors
    /// [`SceneBuildError`] if the drawings have to be mapped and cannot be.
    pub fn with_automatic_places(self) -> Result<Self, SceneBuildError> {
        if self.layout == Layout::Given {
            return Ok(self);
        }
        let has_all = |layer: &SceneLayer| layer.poses.len() == self.poses.len();
        let layer = match self.layers.iter().position(has_all) {
            Some(layer) => layer,
            None if self.layers.is_empty() => 0,
            None => return Err(self.refusal(crate::pipeline::PipelineError::NoCommonLayer)),
        };
        let (mapping, _) = map_layer(&self.layer_spec(layer)?).map_err(|error| self.layer_refusal(layer, error))?;
        Ok(self.laid_out(&automatic_places(&mapping)))
    }

    /// The refusal of one of the scene's layers.
    fn layer_refusal(&self, layer: usize, error: crate::pipeline::PipelineError) -> SceneBuildError {
        let Some(layer) = self.layers.get(layer) else {
            return self.refusal(error);
        };
        self.refusal(crate::pipeline::PipelineError::Layer {
            layer: layer.name.clone(),
            source: Box::new(error),
        })
    }

    /// The places of the poses.
    #[must_use]
    pub fn places(&self) -> Vec<Vec<f64>> {
        self.poses.iter().map(|pose| pose.at.clone()).collect()
    }

    /// The specification with drawings that `read` gives.
    pub(super) fn spec_with(&self, read: &ReadDrawing<'_>) -> Result<CharacterSpec, SceneBuildError> {
        let layers: Vec<Result<LayerSpec, SceneBuildError>> = (0..self.layers.len().max(1))
            .into_par_iter()
            .map(|layer| self.layer_with(layer, read))
            .collect();
        let draw_orders = if self.layers.is_empty() {
            Vec::new()
        } else {
            self.poses.iter().map(|pose| pose.draw_order.clone()).collect()
        };
        Ok(CharacterSpec {
            layers: layers.into_iter().collect::<Result<_, _>>()?,
            draw_orders,
            space: SpaceSpec {
                poses: self.names(),
                places: match self.layout {
                    Layout::Given => Places::Given(self.places()),
                    Layout::Automatic => Places::Automatic,
                },
                weights: self.weight_options(None)?,
            },
            texture: TextureSpec {
                sharpness: self.texture_sharpness,
                blending: self.colour_blend,
                art: self.art,
            },
        })
    }

    fn layer_with(&self, layer: usize, read: &ReadDrawing<'_>) -> Result<LayerSpec, SceneBuildError> {
        let (own, within) = (self.of_layer(layer), self.layers.get(layer));
        let named = within.map(|layer| layer.name.as_str());
        let drawn: Vec<usize> = own.drawn_poses();
        let drawings: Vec<Result<DrawnPose, SceneBuildError>> =
            drawn.par_iter().map(|&pose| read(own, named, pose)).collect();
        let mut drawings = drawings.into_iter();
        let mut poses = Vec::new();
        for (index, pose) in own.poses.iter().enumerate() {
            let shape = match &pose.source {
                PoseSource::Deformed(copy) => PoseShape::Deformed(copy.copy.clone()),
                PoseSource::Drawn(_) | PoseSource::Layered => match drawings.next() {
                    Some(drawing) => PoseShape::Drawn(drawing?),
                    None => return Err(own.without_drawing(index).into()),
                },
            };
            poses.push(PoseSpec {
                name: pose.name.clone(),
                shape,
            });
        }
        let landmarks = own.landmarks.iter().map(|landmark| LandmarkSpec {
            name: landmark.name.clone(),
            at: landmark.at.clone(),
        });
        let paths = own.paths.iter().map(|path| PathSpec {
            name: path.name.clone(),
            at: path.at.clone(),
        });
        let attachment = within.and_then(|layer| {
            let anchor = layer.anchor.as_ref()?;
            let landmark = own.landmarks.iter().position(|own| own.name == anchor.landmark)?;
            Some(Attachment {
                to: anchor.to,
                landmark,
            })
        });
        Ok(LayerSpec {
            name: named.map_or_else(|| self.short_name(), str::to_owned),
            poses,
            reference: own.reference,
            landmarks: landmarks.collect(),
            paths: paths.collect(),
            mesh: own.mesh.clone(),
            blend: BlendOptions {
                turns: own.poses.iter().map(|pose| pose.turns).collect(),
                ..own.blend.clone()
            },
            attachment,
            unshared_holes: match self.input.holes {
                Holes::Keep => UnsharedHoles::Refuse,
                Holes::Match | Holes::Fill => UnsharedHoles::Cover,
            },
        })
    }

    /// The options of the scene's weights, or of those that `provider` asks for.
    fn weight_options(&self, provider: Option<Provider>) -> Result<WeightOptions, SceneBuildError> {
        let settings = &self.pose_space;
        let pseudo_poses = self.pseudo_poses.clone();
        Ok(match provider.unwrap_or(settings.provider) {
            Provider::Biharmonic => WeightOptions::Biharmonic(BiharmonicOptions {
                epsilon: settings.epsilon,
                range: settings.range,
                walls: settings.walls.clone(),
                pseudo_poses,
                ..BiharmonicOptions::default()
            }),
            Provider::Rbf if !settings.walls.is_empty() || settings.range != Range::Free => {
                return Err(SceneBuildError::Provider {
                    file: self.file.clone(),
                });
            }
            Provider::Rbf => WeightOptions::Rbf(RbfOptions {
                radial: settings.radial,
                pseudo_poses,
            }),
        })
    }
}
