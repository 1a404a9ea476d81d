//! From a scene to the specification of its character.
//!
//! [`Scene`] -> [`CharacterSpec`]: drawings are read, names become numbers, and what only a file has (paths, lines, the layer that a
//! landmark is on) stays behind.

use rayon::prelude::*;

use super::drawings::{canvas_px, read_drawing, read_sheet};
use super::named_parts::check_named_parts;
use super::settings::{DrawnSource, FrameSize, Holes, Layout, PoseSource, Provider, Scene};
use super::{SceneBuildError, SceneLayer};
use crate::blend::BlendOptions;
use crate::input::{PartOptions, Picture, PlaceRule};
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::pipeline::{
    Attachment, CameraRule, Character, CharacterSpec, DrawnPose, EditableWeights, Facing, LandmarkSpec, LayerParts,
    LayerRole, LayerSpec, LimbSpec, PathSpec, Places, PoseShape, PoseSpec, SpaceSpec, TextureSpec, UnsharedHoles,
    WeightOptions, automatic_places, editable_weights, map_layer,
};
use crate::weights::{BiharmonicOptions, Range, RbfOptions};

/// Whether a drawing is read with places that may be those of other layers' drawings.
fn names_parts_of_layers(said: &DrawnSource) -> bool {
    let PartOptions { keep, drop, places, .. } = &said.parts;
    *places == PlaceRule::SeveralDrawings && !(keep.is_empty() && drop.is_empty())
}

/// Layers of a pose that is reflected are reflected about one line, the middle of all of them.
fn reflect_together(layers: &mut [LayerSpec]) {
    let mut middles: Vec<(String, Point, Point)> = Vec::new();
    for pose in layers.iter().flat_map(|layer| &layer.poses) {
        let PoseShape::Drawn(drawn) = &pose.shape else { continue };
        let outline = drawn.drawing.outline.outer();
        let Some((low, high)) = bounding_box(outline.points()).filter(|_| drawn.facing == Facing::Mirrored) else {
            continue;
        };
        match middles.iter_mut().find(|(name, ..)| *name == pose.name) {
            Some((_, all_low, all_high)) => (*all_low, *all_high) = (all_low.inf(&low), all_high.sup(&high)),
            None => middles.push((pose.name.clone(), low, high)),
        }
    }
    for pose in layers.iter_mut().flat_map(|layer| &mut layer.poses) {
        let found = middles.iter().find(|(name, ..)| *name == pose.name);
        if let (PoseShape::Drawn(drawn), Some((_, low, high))) = (&mut pose.shape, found) {
            drawn.axis = Some(low.x + high.x);
        }
    }
}

/// The largest side of a frame, in pixels.
const LARGEST_FRAME: f64 = 16_384.0;

/// What reads a drawing: of a pose, by its index, of a scene without layers, which is called so where it is one of several.
pub(super) type ReadDrawing<'a> = dyn Fn(&Scene, Option<&str>, usize) -> Result<DrawnPose, SceneBuildError> + Sync + 'a;

impl Scene {
    /// The specification of the scene's character. Its drawings are read, in parallel.
    ///
    /// # Errors
    /// [`SceneBuildError`] for the first drawing, in the scene's order, that cannot be used.
    pub fn spec(&self) -> Result<CharacterSpec, SceneBuildError> {
        Ok(self.arranged(self.spec_with(&read_drawing)?))
    }

    /// The specification of one layer, or of the whole of a scene without layers. Its drawings are read, in parallel.
    ///
    /// # Errors
    /// As [`Self::spec`].
    pub fn layer_spec(&self, layer: usize) -> Result<LayerSpec, SceneBuildError> {
        // Which way a pose faces, about which line it is reflected, and whether its places of loose parts name any, is a matter of all its layers.
        if self.of_layer(layer).drawn_poses().into_iter().all(|pose| {
            let drawing = self.of_layer(layer).drawing_of(pose);
            drawing.is_none_or(|(_, said)| said.facing == Facing::AsDrawn && !names_parts_of_layers(said))
        }) {
            return self.layer_with(layer, &read_drawing);
        }
        Ok(self.spec_with(&read_drawing)?.layers.swap_remove(layer))
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

    /// All that is on the sheet of the drawing of one pose of a layer, by its index there: as its file has it, nothing taken out.
    ///
    /// # Errors
    /// As [`Self::spec`].
    pub fn read_sheet(&self, layer: usize, pose: usize) -> Result<Picture, SceneBuildError> {
        let named = self.layers.get(layer).map(|layer| layer.name.as_str());
        read_sheet(self.of_layer(layer), named, pose)
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

    /// The scene with frames as large as its drawings' canvas, if they are to be: pixel for pixel of bitmaps, of SVG files as large as
    /// a browser shows them.
    fn with_canvas_size(mut self) -> Result<Self, SceneBuildError> {
        if self.frame_size == FrameSize::Given || self.camera == CameraRule::Fit {
            return Ok(self);
        }
        let whole: Vec<&Self> = if self.layers.is_empty() {
            vec![&self]
        } else {
            self.layers.iter().map(|layer| &layer.scene).collect()
        };
        let drawn: Vec<(&Self, usize)> = whole
            .into_iter()
            .flat_map(|own| own.drawn_poses().into_iter().map(move |pose| (own, pose)))
            .collect();
        let sizes: Vec<Result<Point, SceneBuildError>> =
            drawn.into_par_iter().map(|(own, pose)| canvas_px(own, pose)).collect();
        let mut largest = Point::repeat(1.0);
        for size in sizes {
            largest = largest.sup(&size?);
        }
        self.animation.size = [largest.x, largest.y].map(|side| side.round().min(LARGEST_FRAME) as u32);
        self.frame_size = FrameSize::Given;
        Ok(self)
    }

    /// The scene with a place for every pose, and frames as large as its drawings' canvas if the file gives no size for
    /// `camera = "drawing"`. If the file gives none, its drawings are read and mapped for that, which takes as
    /// long as [`map_layer`]; of a scene with layers, those of its first layer that all poses have.
    ///
    /// # Errors
    /// [`SceneBuildError`] if the drawings have to be mapped and cannot be.
    pub fn with_automatic_places(self) -> Result<Self, SceneBuildError> {
        let sized = self.with_canvas_size()?;
        if sized.layout == Layout::Given {
            return Ok(sized);
        }
        sized.laid_out_by_drawings()
    }

    fn laid_out_by_drawings(self) -> Result<Self, SceneBuildError> {
        let has_all = |layer: &SceneLayer| layer.poses.len() == self.poses.len();
        let layer = match self.layers.iter().position(has_all) {
            Some(layer) => layer,
            None if self.layers.is_empty() => 0,
            None => return Err(self.refusal(crate::pipeline::PipelineError::NoCommonLayer)),
        };
        let mut parts = LayerParts::of(&self.layer_spec(layer)?, &[]);
        let largest = parts.layers.swap_remove(parts.largest);
        let (mapping, _) = map_layer(&largest).map_err(|error| self.layer_refusal(layer, error))?;
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

    /// The specification with drawings that `read` gives, as they are.
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
        let layers = layers.into_iter().collect::<Result<Vec<LayerSpec>, _>>()?;
        check_named_parts(self, &layers)?;
        let spec = CharacterSpec {
            layers,
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
                sampling: self.sampling,
                register: self.register,
            },
            camera: CameraRule::Fit,
            notes: Vec::new(),
        };
        let mut settled = spec.with_facings();
        if !self.layers.is_empty() {
            reflect_together(&mut settled.layers);
        }
        Ok(settled)
    }

    /// The specification of the scene's character from its drawings as they were read: loose parts are layers, and everything lies where
    /// the camera wants it.
    pub(super) fn arranged(&self, read: CharacterSpec) -> CharacterSpec {
        let spec = read.with_loose_parts();
        match self.camera {
            CameraRule::Fit => spec,
            CameraRule::Drawing => spec.on_canvas(),
        }
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
        let limbs = own.limbs.iter().map(|limb| {
            let mut spec = LimbSpec::new(&limb.name, limb.at.clone());
            spec.cut.clone_from(&limb.cut);
            spec
        });
        let limb_orders: Vec<Vec<String>> = own.poses.iter().map(|pose| pose.limb_order.clone()).collect();
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
            limbs: limbs.collect(),
            limb_orders: if limb_orders.iter().all(Vec::is_empty) {
                Vec::new()
            } else {
                limb_orders
            },
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
            overlaps: self.input.overlaps,
            role: LayerRole::Body,
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
