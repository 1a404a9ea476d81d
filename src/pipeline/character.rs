//! A character ready to be shown in any pose.

#[cfg(feature = "export")]
mod runtime;

use std::sync::Arc;

use super::art::{LayerArt, View};
use super::figure::{Figure, Posed};
use super::layer::{self, LayerShape};
use super::note::Note;
use super::{Build, PipelineError, weighting};
use crate::animation::{Animation, Background};
use crate::blend::Certifier;
use crate::math::Point;
use crate::pipeline::spec::CharacterSpec;
use crate::render::drawing::{VectorFrame, VectorGroup, VectorNode};
use crate::render::puppet::{Puppet, PuppetFrame, PuppetLayer};
use crate::render::{Camera, Frame, PaintOptions, Sampling};
use crate::weights::WeightProvider;

/// A character with everything that is computed once: mappings, factorised blends, weights, textures, camera.
#[derive(Debug)]
pub struct Character {
    names: Vec<String>,
    places: Vec<Vec<f64>>,
    figure: Arc<Figure>,
    weights: Arc<dyn WeightProvider>,
    /// What each layer is drawn with.
    art: Vec<LayerArt>,
    camera: Camera,
    /// Along a pixel's side.
    samples: usize,
    notes: Vec<Note>,
    animation: Animation,
    sampling: Sampling,
}

impl Character {
    /// Maps and prepares the character of `spec`, for frames of `size` (columns, rows).
    ///
    /// The camera is fixed: it shows all poses and the whole animation. Poses without places are laid out first, and an animation
    /// through the poses then goes through these places; [`Self::animation`] is that one.
    ///
    /// # Errors
    /// [`PipelineError`] from any stage.
    pub fn new(spec: &CharacterSpec, animation: &Animation, size: [usize; 2]) -> Result<Self, PipelineError> {
        Self::supersampled(spec, animation, size, 1)
    }

    /// As [`Self::new`], with `samples` x `samples` samples a pixel in its frames, from 1 to 4.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn supersampled(
        spec: &CharacterSpec,
        animation: &Animation,
        size: [usize; 2],
        samples: usize,
    ) -> Result<Self, PipelineError> {
        let build = Build::new(spec)?;
        let animation = build.through_places(animation)?;
        let camera = build.camera(&animation, size)?;
        build.character(&animation, camera, samples)
    }

    /// A build's figure with the art of its layers.
    pub(super) fn drawn(
        build: &Build,
        animation: &Animation,
        weights: Arc<dyn WeightProvider>,
        camera: Camera,
        samples: usize,
    ) -> Result<Self, PipelineError> {
        let samples = samples.clamp(1, PaintOptions::MOST_SAMPLES);
        let (spec, figure) = (build.spec(), Arc::clone(build.figure()));
        let mut notes = build.notes().to_vec();
        let mut art = Vec::new();
        for (k, (part, shape)) in layer::parts(spec).iter().zip(&figure.layers).enumerate() {
            let drawings = build.drawings(k);
            art.push(LayerArt::new(
                part,
                shape,
                &spec.texture,
                drawings,
                || build.texture_mesh(k),
                View { camera, samples },
                &mut notes,
            )?);
        }
        Ok(Self {
            names: spec.space.poses.clone(),
            places: build.places().to_vec(),
            figure,
            weights,
            art,
            camera,
            samples,
            notes,
            animation: animation.clone(),
            sampling: spec.texture.sampling,
        })
    }

    /// The names of its poses, in the order of weights.
    #[must_use]
    pub fn poses(&self) -> &[String] {
        &self.names
    }

    /// The places of its poses, one a pose.
    #[must_use]
    pub fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    /// The animation that its camera shows.
    #[must_use]
    pub fn animation(&self) -> &Animation {
        &self.animation
    }

    /// Its layers, from back to front.
    #[must_use]
    pub fn layers(&self) -> &[LayerShape] {
        &self.figure.layers
    }

    /// What the artist should know.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
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
        self.posed_of(&self.weights_at(place)?)
    }

    /// The character for given weights, one a pose.
    ///
    /// # Errors
    /// [`PipelineError`] if they do not fit or do not sum to 1.
    pub fn posed_of(&self, weights: &[f64]) -> Result<Posed, PipelineError> {
        self.figure.posed(&weighting::checked_weights(weights, &self.names)?)
    }

    /// The weights of its poses at a place of the pose space; sum 1.
    ///
    /// # Errors
    /// [`PipelineError`] if the place has the wrong dimension or is not finite.
    pub fn weights_at(&self, place: &[f64]) -> Result<Vec<f64>, PipelineError> {
        self.weights.weights_at(place).map_err(PipelineError::Weights)
    }

    /// What certifies frames of its layers, one a layer: each is asked with the layer's own weights and positions in a frame ([`super::PosedLayer`]).
    ///
    /// # Errors
    /// [`PipelineError`] if a layer's poses do not allow it.
    pub fn certifiers(&self) -> Result<Vec<Certifier>, PipelineError> {
        let certifier = |shape: &LayerShape| Ok(Certifier::of_mapping(shape.mapping(), shape.options())?);
        self.figure.layers.iter().map(certifier).collect()
    }

    /// Paints a frame.
    #[must_use]
    pub fn paint(&self, posed: &Posed) -> Frame {
        if !self.art.iter().all(LayerArt::is_pixels) {
            return self.draw(posed).rasterise(self.samples);
        }
        let mut frame: Option<Frame> = None;
        for &k in &posed.order {
            let layer = &posed.layers[k];
            if layer.opacity <= 0.0 {
                continue;
            }
            let Some(own) = self.art[k].paint(layer) else { continue };
            match &mut frame {
                None if layer.opacity == 1.0 => frame = Some(own),
                before => before
                    .get_or_insert_with(|| self.clear_frame())
                    .put_over(&own, layer.opacity),
            }
        }
        let mut frame = frame.unwrap_or_else(|| self.clear_frame());
        if let Background::Colour(colour) = self.animation.background {
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
    /// In a character with several layers every layer is a group with its name, and what is in it has names that begin with that.
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
            background: match self.animation.background {
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
                .flat_map(|(shape, art)| art.puppet(shape, &self.camera))
                .collect(),
            sampling: self.sampling,
        }
    }

    /// What changes of `puppet`, as [`Self::puppet`] gives it, in one frame.
    #[must_use]
    pub fn puppet_frame(&self, puppet: &Puppet, posed: &Posed) -> PuppetFrame {
        let mut shown = puppet.layers.iter();
        let mut layers = Vec::new();
        // By layer, its meshes from back to front.
        let mut meshes: Vec<Vec<usize>> = Vec::new();
        for (art, posed) in self.art.iter().zip(&posed.layers) {
            let first = layers.len();
            let Some(regions) = art.regions() else {
                let frame = |layer: &PuppetLayer| {
                    layer.frame(&posed.positions, &posed.texture_weights, posed.opacity, &self.camera)
                };
                layers.extend(shown.next().map(frame));
                meshes.push(vec![first]);
                continue;
            };
            for region in 0..regions.count() {
                let vertices = regions.mesh(region).vertices.iter();
                let positions: Vec<Point> = vertices.map(|v| posed.positions[*v]).collect();
                let frame =
                    |layer: &PuppetLayer| layer.frame(&positions, &posed.texture_weights, posed.opacity, &self.camera);
                layers.extend(shown.next().map(frame));
            }
            let order = regions
                .order()
                .from_back_to_front(&posed.weights, &posed.texture_weights);
            meshes.push(order.into_iter().map(|region| first + region).collect());
        }
        PuppetFrame {
            layers,
            order: posed.order.iter().flat_map(|&layer| meshes[layer].clone()).collect(),
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
        self.posed_at(&animation.place_of_frame(index))
    }
}
