//! A character ready to be shown in any pose.

mod runtime;

use std::sync::Arc;

use rayon::prelude::*;

use super::art::LayerArt;
use super::figure::{self, Figure, Posed};
use super::layer::{self, LayerShape, Part};
use super::layout::placed;
use super::{PipelineError, weight_provider, weighting};
use crate::animation::{Animation, Background};
use crate::input::Drawing;
use crate::render::drawing::{VectorFrame, VectorGroup, VectorNode};
use crate::render::puppet::{Puppet, PuppetFrame};
use crate::render::{Camera, Frame, PaintOptions, Painter};
use crate::scene::{Layout, Scene};
use crate::weights::WeightProvider;

/// A scene's character with everything that is computed once: mappings, factorised blends, weights, textures, camera.
#[derive(Debug)]
pub struct Character {
    names: Vec<String>,
    figure: Arc<Figure>,
    weights: Arc<dyn WeightProvider>,
    /// What each layer is drawn with.
    art: Vec<LayerArt>,
    camera: Camera,
    /// Along a pixel's side.
    samples: usize,
    notes: Vec<String>,
    background: Background,
}

impl Character {
    /// Reads, maps and prepares the character of `scene`, for frames of `size` (columns, rows).
    ///
    /// The camera is fixed: it shows all poses and the whole animation. A scene without places is laid out first; whoever
    /// wants to know its places, or its animation's, lays it out with [`laid_out`](super::laid_out) and gives that.
    ///
    /// # Errors
    /// [`PipelineError`] from any stage.
    pub fn new(scene: &Scene, size: [usize; 2]) -> Result<Self, PipelineError> {
        Self::supersampled(scene, size, 1)
    }

    /// As [`Self::new`], with `samples` x `samples` samples a pixel in its frames, from 1 to 4.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn supersampled(scene: &Scene, size: [usize; 2], samples: usize) -> Result<Self, PipelineError> {
        let samples = samples.clamp(1, PaintOptions::MOST_SAMPLES);
        // The cheap refusals first.
        let mut weights = match scene.layout {
            Layout::Given => Some(weight_provider(scene, None)?),
            Layout::Automatic => None,
        };
        let parts = layer::parts(scene);
        let mapped: Vec<Result<_, PipelineError>> = parts.par_iter().map(Part::mapped).collect();
        let mut drawings = Vec::new();
        let mut shapes = Vec::new();
        let mut notes = Vec::new();
        for (part, mapped) in parts.iter().zip(mapped) {
            let (drawn, mapping, report) = mapped?;
            notes.extend(report.notes);
            shapes.push(part.shape(mapping, &mut notes)?);
            drawings.push(drawn);
        }
        layer::tie(&parts, &mut shapes)?;
        let scene = &placed(scene, shapes.iter().map(|shape| (shape.poses(), shape.mapping())))?;
        let weights = match weights.take() {
            Some(weights) => weights,
            None => weight_provider(scene, None)?,
        };
        let figure = Arc::new(Figure::new(scene, shapes));
        let camera = figure::camera(&scene.animation, size, &figure, weights.as_ref())?;
        Self::drawn(scene, figure, weights.into(), camera, samples, drawings, notes)
    }

    /// The figure with the art of its layers: `drawings` are those of each. The scene is laid out.
    pub(super) fn drawn(
        scene: &Scene,
        figure: Arc<Figure>,
        weights: Arc<dyn WeightProvider>,
        camera: Camera,
        samples: usize,
        drawings: Vec<Vec<Drawing>>,
        mut notes: Vec<String>,
    ) -> Result<Self, PipelineError> {
        let mut art = Vec::new();
        for ((part, shape), drawings) in layer::parts(scene).iter().zip(&figure.layers).zip(drawings) {
            art.push(LayerArt::new(part, shape, drawings, camera, samples, &mut notes)?);
        }
        Ok(Self {
            names: scene.names(),
            figure,
            weights,
            art,
            camera,
            samples,
            notes,
            background: scene.animation.background,
        })
    }

    /// Its layers, in the scene's order; a scene without layers has one.
    #[must_use]
    pub fn layers(&self) -> &[LayerShape] {
        &self.figure.layers
    }

    /// What the artist should know, one line a remark.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The character at a place of the pose space.
    ///
    /// # Errors
    /// [`PipelineError`] if the place has the wrong dimension or is not finite.
    pub fn posed_at(&self, place: &[f64]) -> Result<Posed, PipelineError> {
        self.posed_of(&self.weights.weights_at(place).map_err(PipelineError::Weights)?)
    }

    /// The character for given weights, one a pose of the scene.
    ///
    /// # Errors
    /// [`PipelineError`] if they do not fit or do not sum to 1.
    pub fn posed_of(&self, weights: &[f64]) -> Result<Posed, PipelineError> {
        self.figure.posed(&weighting::checked_weights(weights, &self.names)?)
    }

    /// Paints a frame.
    #[must_use]
    pub fn paint(&self, posed: &Posed) -> Frame {
        let painters: Option<Vec<&Painter>> = self.art.iter().map(LayerArt::painter).collect();
        let Some(painters) = painters else {
            return self.draw(posed).rasterise(self.samples);
        };
        let mut frame: Option<Frame> = None;
        for &k in &posed.order {
            let layer = &posed.layers[k];
            if layer.opacity <= 0.0 {
                continue;
            }
            let own = painters[k].paint(&layer.positions, &layer.weights, &layer.texture_weights);
            match &mut frame {
                None if layer.opacity == 1.0 => frame = Some(own),
                before => before
                    .get_or_insert_with(|| self.clear_frame())
                    .put_over(&own, layer.opacity),
            }
        }
        let mut frame = frame.unwrap_or_else(|| self.clear_frame());
        if let Background::Colour(colour) = self.background {
            frame.put_before(colour);
        }
        frame
    }

    fn clear_frame(&self) -> Frame {
        let [columns, rows] = self.camera.size();
        Frame::filled(columns, rows, [0; 4])
    }

    /// Draws a frame as curves. Layers whose drawings are bitmaps are pictures in it.
    ///
    /// In a scene with layers every layer is a group with its name, and what is in it has names that begin with that.
    #[must_use]
    pub fn draw(&self, posed: &Posed) -> VectorFrame {
        let mut nodes = Vec::new();
        for &k in &posed.order {
            let (layer, name) = (&posed.layers[k], self.figure.layers[k].name());
            let mut own = self.art[k].draw(layer);
            if self.figure.layers.len() == 1 {
                nodes = own;
                continue;
            }
            for node in &mut own {
                node.put_under(name);
            }
            nodes.push(VectorNode::Group(VectorGroup {
                id: name.to_owned(),
                opacity: layer.opacity,
                clip: None,
                nodes: own,
            }));
        }
        VectorFrame {
            size: self.camera.size(),
            background: match self.background {
                Background::Transparent => None,
                Background::Colour(colour) => Some(colour),
            },
            nodes,
        }
    }

    /// The character as textured meshes, for formats and engines that draw those.
    #[must_use]
    pub fn puppet(&self) -> Puppet {
        Puppet {
            size: self.camera.size(),
            layers: (self.figure.layers.iter().zip(&self.art))
                .map(|(shape, art)| art.puppet(shape, &self.camera))
                .collect(),
        }
    }

    /// What changes of `puppet`, as [`Self::puppet`] gives it, in one frame.
    #[must_use]
    pub fn puppet_frame(&self, puppet: &Puppet, posed: &Posed) -> PuppetFrame {
        let layers = puppet.layers.iter().zip(&posed.layers);
        PuppetFrame {
            layers: layers
                .map(|(layer, posed)| {
                    layer.frame(&posed.positions, &posed.texture_weights, posed.opacity, &self.camera)
                })
                .collect(),
            order: posed.order.clone(),
        }
    }

    /// The frame at a place of the pose space.
    ///
    /// # Errors
    /// [`PipelineError`] if the place has the wrong dimension or is not finite.
    pub fn frame_at(&self, place: &[f64]) -> Result<Frame, PipelineError> {
        Ok(self.paint(&self.posed_at(place)?))
    }

    /// The frame for given weights, one a pose.
    ///
    /// # Errors
    /// [`PipelineError`] if they do not fit or do not sum to 1.
    pub fn frame_of(&self, weights: &[f64]) -> Result<Frame, PipelineError> {
        Ok(self.paint(&self.posed_of(weights)?))
    }

    /// Frame `index` of an animation, counted from 0.
    ///
    /// # Errors
    /// As [`Self::frame_at`].
    pub fn frame(&self, animation: &Animation, index: usize) -> Result<Frame, PipelineError> {
        Ok(self.paint(&self.posed(animation, index)?))
    }

    /// The character in frame `index` of an animation, counted from 0.
    ///
    /// # Errors
    /// As [`Self::posed_at`].
    pub fn posed(&self, animation: &Animation, index: usize) -> Result<Posed, PipelineError> {
        self.posed_at(&animation.at(animation.time_of_frame(index)))
    }
}
