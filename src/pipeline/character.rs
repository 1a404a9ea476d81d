//! A character ready to be shown in any pose.

use super::drawings::{read_drawings, sharpen};
use super::layout::placed;
use super::{PipelineError, map_drawings, weight_provider, weighting};
use crate::blend::{self, BlendOptions, BlendReport, RigidBlend};
use crate::input::Drawing;
use crate::math::Point;
use crate::pose::Mapping;
use crate::render::{Camera, Frame, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use crate::scene::{Anchor, Animation, Background, Layout, Scene};
use crate::texture::shared_texture_weights;
use crate::weights::WeightProvider;

/// How many places of the animation the camera looks at before it chooses its distance.
const CAMERA_PLACES: usize = 48;

/// A scene's character with everything that is computed once: mapping, factorised blend, weights, textures, camera.
#[derive(Debug)]
pub struct Character {
    mapping: Mapping,
    notes: Vec<String>,
    blend: RigidBlend,
    weights: Box<dyn WeightProvider>,
    texture_sharpness: f64,
    background: Background,
    painter: Painter,
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
        // The cheap refusals first.
        let mut weights = match scene.layout {
            Layout::Given => Some(weight_provider(scene, None)?),
            Layout::Automatic => None,
        };
        let mut drawings = read_drawings(scene)?;
        let (mapping, report) = map_drawings(scene, &drawings)?;
        let scene = &placed(scene, &mapping);
        let weights = match weights.take() {
            Some(weights) => weights,
            None => weight_provider(scene, None)?,
        };
        let mut notes = report.notes;
        let blend = RigidBlend::new(&mapping.poses, &blend_options(scene, &mapping))?;
        if blend.turns_are_ambiguous() {
            notes.push(
                "some poses are turned by half a turn against one another, so either way round is as good; \
                 set `turns` on a pose to choose"
                    .to_owned(),
            );
        }
        let silhouette = Silhouette::new(&mapping);
        let camera = camera(scene, size, &mapping, &blend, weights.as_ref(), &silhouette)?;
        sharpen(scene, &mut drawings, camera.scale())?;
        let (textures, texture_of) = textures(scene, &drawings, camera.scale());
        Ok(Self {
            painter: Painter::new(
                &mapping,
                textures,
                texture_of,
                silhouette,
                camera,
                PaintOptions::default(),
            ),
            mapping,
            notes,
            blend,
            weights,
            texture_sharpness: scene.texture_sharpness,
            background: scene.animation.background,
        })
    }

    /// The mapping.
    #[must_use]
    pub fn mapping(&self) -> &Mapping {
        &self.mapping
    }

    /// What the artist should know, one line a remark.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The frame at a place of the pose space.
    ///
    /// # Errors
    /// [`PipelineError`] if the place has the wrong dimension or is not finite.
    pub fn frame_at(&self, place: &[f64]) -> Result<Frame, PipelineError> {
        let mut weights = Vec::new();
        self.weights
            .weights(place, &mut weights)
            .map_err(PipelineError::Weights)?;
        self.frame_of(&weights)
    }

    /// The frame for given weights, one a pose.
    ///
    /// # Errors
    /// [`PipelineError`] if they do not fit or do not sum to 1.
    pub fn frame_of(&self, weights: &[f64]) -> Result<Frame, PipelineError> {
        let weights = weighting::checked_weights(weights, self.mapping.poses.names())?;
        let (positions, _) = self.shape_of(&weights)?;
        let shown = shared_texture_weights(&weights, self.painter.texture_of(), self.texture_sharpness)?;
        let mut frame = self.painter.paint(&positions, &weights, &shown);
        if let Background::Colour(colour) = self.background {
            frame.put_before(colour);
        }
        Ok(frame)
    }

    /// The vertices of the frame for given weights, and what there is to say about it: the blend without the picture.
    ///
    /// # Errors
    /// As [`Self::frame_of`].
    pub fn shape_of(&self, weights: &[f64]) -> Result<(Vec<Point>, BlendReport), PipelineError> {
        let mut positions = Vec::new();
        let report = self.blend.blend(weights, &mut self.blend.scratch(), &mut positions)?;
        Ok((positions, report))
    }

    /// The vertices of the frame at a place of the pose space.
    ///
    /// # Errors
    /// As [`Self::frame_at`].
    pub fn shape_at(&self, place: &[f64]) -> Result<(Vec<Point>, BlendReport), PipelineError> {
        let mut weights = Vec::new();
        self.weights
            .weights(place, &mut weights)
            .map_err(PipelineError::Weights)?;
        self.shape_of(&weights)
    }

    /// Frame `index` of an animation, counted from 0.
    ///
    /// # Errors
    /// As [`Self::frame_at`].
    pub fn frame(&self, animation: &Animation, index: usize) -> Result<Frame, PipelineError> {
        self.frame_at(&animation.at(animation.time_of_frame(index)))
    }
}

pub(super) fn blend_options(scene: &Scene, mapping: &Mapping) -> BlendOptions {
    let vertex = |landmark| nearest_vertex(scene, mapping, landmark);
    let settings = &scene.blend;
    BlendOptions {
        reference: settings.reference,
        stretch: settings.stretch,
        anchor: match &settings.anchor {
            Anchor::Centroid => blend::Anchor::Centroid,
            Anchor::Landmark(landmark) => blend::Anchor::Vertex(vertex(*landmark)),
            Anchor::Soft(anchors) => {
                let soft = anchors.iter().map(|anchor| blend::SoftAnchor {
                    vertex: vertex(anchor.landmark),
                    stiffness: anchor.stiffness,
                });
                blend::Anchor::Soft(soft.collect())
            }
        },
        turns: scene.poses.iter().map(|pose| pose.turns).collect(),
        regions: settings
            .regions
            .iter()
            .map(|region| blend::Region {
                vertex: vertex(region.landmark),
                radius: region.radius,
                stiffness: region.stiffness,
                stretch_limit: region.stretch_limit,
            })
            .collect(),
        guard: settings.guard,
    }
}

/// The vertex nearest to a landmark, over all poses that have it.
fn nearest_vertex(scene: &Scene, mapping: &Mapping, landmark: usize) -> usize {
    let places = &scene.landmarks[landmark].at;
    let distance = |vertex: usize| -> f64 {
        places
            .iter()
            .zip(mapping.poses.positions())
            .filter_map(|(place, positions)| place.map(|place| (positions[vertex] - place).norm()))
            .sum()
    };
    (0..mapping.poses.topology().vertex_count())
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        .unwrap_or(0)
}

fn camera(
    scene: &Scene,
    size: [usize; 2],
    mapping: &Mapping,
    blend: &RigidBlend,
    weights: &dyn WeightProvider,
    silhouette: &Silhouette,
) -> Result<Camera, PipelineError> {
    let mut shown: Vec<Point> = mapping
        .outlines
        .iter()
        .flat_map(|outline| outline.outer().points().iter().copied())
        .collect();
    let animation = &scene.animation;
    let (start, count) = (animation.time_of_frame(0), CAMERA_PLACES);
    let (mut at_place, mut positions, mut scratch) = (Vec::new(), Vec::new(), blend.scratch());
    for k in 0..count {
        let time = start + animation.duration() * k as f64 / count as f64;
        weights
            .weights(&animation.at(time), &mut at_place)
            .map_err(PipelineError::Weights)?;
        blend.blend(&at_place, &mut scratch, &mut positions)?;
        shown.extend(silhouette.at(&positions, &at_place).into_iter().flatten());
    }
    Ok(Camera::fitting(&shown, size))
}

/// The drawings' textures, and which of them each pose shows.
fn textures(scene: &Scene, drawings: &[Drawing], frame_scale: f64) -> (Vec<PoseTexture>, Vec<usize>) {
    let drawn = scene.drawn_poses();
    let textures = drawings
        .iter()
        .zip(&drawn)
        .map(|(drawing, &drawn_on)| PoseTexture {
            texture: Texture::new(&drawing.picture, &drawing.outline, frame_scale),
            drawn_on,
        })
        .collect();
    let shown = |pose: usize| {
        let root = scene.drawing_of(pose).map(|(root, _)| root);
        drawn.iter().position(|&pose| Some(pose) == root).unwrap_or(0)
    };
    (textures, (0..scene.poses.len()).map(shown).collect())
}
