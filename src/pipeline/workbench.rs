//! A character that is being worked on: made again after every edit, from what the edit leaves alone.
//!
//! [`Character`](super::Character) is made once and drawn often. A workbench is for whoever changes the scene all the time and looks
//! at shapes, not at painted frames: it keeps what every step made, and an edited scene repeats only the steps that it concerns.
//!
//! | what changed | what is repeated |
//! |---|---|
//! | places, pseudo-poses, the pose space | weights |
//! | sharpness of textures, order of layers | nothing |
//! | stretch, anchors, regions, turns, references of the blend | the blend's factor |
//! | landmarks and lines inside, `edge_length`, copies | the triangulation and what follows |
//! | landmarks on the outline, the reference, `simplify` | the mapping |
//! | sources, `mirror`, `[input]`; or the files themselves | everything |
//!
//! Its shapes are those of a `Character` of the same scene, to the last bit; its camera after [`Workbench::filmed_anew`].

use std::sync::Arc;

use rayon::prelude::*;

use super::boundaries::Boundaries;
use super::figure::{self, Figure, Posed};
use super::layer::{self, LayerShape, Part, PosedLayer};
use super::layout::placed;
use super::mapping::map_drawings_again;
use super::{
    Character, EditableWeights, MappingReport, PipelineError, checked_weights, editable_weights, landmarks,
    read_drawings,
};
use crate::input::Drawing;
use crate::math::Point;
use crate::render::Camera;
use crate::scene::{ArtChoice, DrawnSource, Layout, PoseSource, Scene};
use crate::weights::WeightProvider;

/// Whether the drawings' files are as they were.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingFiles {
    /// They are: what was read of them is kept.
    Unchanged,
    /// They may not be: they are read again.
    Reread,
}

/// A scene's character before it is painted, made again after every edit from what the edit leaves alone.
///
/// Its shapes are those of a [`Character`](super::Character) of the same scene, to the last bit.
#[derive(Debug, Clone)]
pub struct Workbench {
    /// As it was given; its layers are what mappings are made of.
    given: Scene,
    /// Laid out.
    scene: Scene,
    layers: Vec<LayerWork>,
    figure: Arc<Figure>,
    weights: Arc<EditableWeights>,
    /// Whether they are those that the scene would have by itself, not others that were given.
    weights_are_own: bool,
    camera: Camera,
    notes: Vec<String>,
}

/// What a layer is made of.
#[derive(Debug, Clone)]
struct LayerWork {
    drawings: Arc<Vec<Drawing>>,
    report: Arc<MappingReport>,
    boundaries: Arc<Boundaries>,
}

impl Workbench {
    /// Reads and maps the drawings of `scene`.
    ///
    /// # Errors
    /// [`PipelineError`] from any stage.
    pub fn new(scene: &Scene) -> Result<Self, PipelineError> {
        rayon::scope(|_| Self::made(scene, None, DrawingFiles::Reread))
    }

    /// The same for an edited scene.
    ///
    /// # Errors
    /// As [`Self::new`]; this workbench stays as it is.
    pub fn edited(&self, scene: &Scene, files: DrawingFiles) -> Result<Self, PipelineError> {
        rayon::scope(|_| Self::made(scene, Some(self), files))
    }

    /// The same with the camera of a new one. Edits keep the camera that was there, since looking at the whole animation takes as
    /// long as dozens of frames.
    ///
    /// # Errors
    /// [`PipelineError`] if the animation leaves the pose space.
    pub fn filmed_anew(&self) -> Result<Self, PipelineError> {
        let camera = camera(&self.scene, &self.figure, &self.weights)?;
        Ok(Self { camera, ..self.clone() })
    }

    /// The same shapes with other weights, of `scene`, which is laid out and differs in what weights are made of alone. The
    /// camera stays.
    #[must_use]
    pub fn reweighted(&self, scene: &Scene, weights: Arc<EditableWeights>) -> Self {
        Self {
            scene: scene.clone(),
            weights,
            weights_are_own: false,
            ..self.clone()
        }
    }

    /// To be run by a thread of the pool: the stages hand thousands of small tasks to it, and from outside each of them would put
    /// the thread to sleep.
    fn made(scene: &Scene, before: Option<&Self>, files: DrawingFiles) -> Result<Self, PipelineError> {
        let given = scene;
        // The cheap refusals first.
        let mut weights = match scene.layout {
            Layout::Given => Some(weights_of(scene, before)?),
            Layout::Automatic => None,
        };
        let parts = layer::parts(scene);
        let parts_before = before.map_or_else(Vec::new, |before| layer::parts(&before.given));
        let step = |(k, part): (usize, &Part<'_>)| -> Result<(LayerWork, LayerShape, Vec<String>), PipelineError> {
            let was = before.and_then(|before| {
                let is_same = |old: &Part<'_>| old.name == part.name && old.poses == part.poses;
                let old = parts_before.get(k).filter(|old| is_same(old))?;
                Some((old, before.layers.get(k)?, before.figure.layers.get(k)?))
            });
            let drawings_kept = was
                .filter(|(old, ..)| files == DrawingFiles::Unchanged && shows_the_same(old.scene, part.scene))
                .map(|(_, work, _)| Arc::clone(&work.drawings));
            let boundaries_kept = was
                .filter(|_| drawings_kept.is_some())
                .map(|(_, work, _)| &work.boundaries);
            let mapped_before = was.filter(|(old, ..)| drawings_kept.is_some() && maps_the_same(old.scene, part.scene));
            let drawings = match drawings_kept {
                Some(drawings) => drawings,
                None => Arc::new(read_drawings(part.scene).map_err(|error| part.refusal(error))?),
            };
            let mut notes = Vec::new();
            if let Some((_, work, shape)) = mapped_before {
                notes.extend(work.report.notes.iter().cloned());
                let shape = part.shape_again(shape, &mut notes)?;
                return Ok((work.clone(), shape, notes));
            }
            let (mapping, mut report, boundaries) =
                map_drawings_again(part.scene, &drawings, boundaries_kept).map_err(|error| part.refusal(error))?;
            for note in &mut report.notes {
                *note = part.remark(note);
            }
            notes.extend(report.notes.iter().cloned());
            let shape = part.shape(mapping, &mut notes)?;
            let work = LayerWork {
                drawings,
                report: Arc::new(report),
                boundaries,
            };
            Ok((work, shape, notes))
        };
        let made: Vec<Result<_, PipelineError>> = parts.par_iter().enumerate().map(step).collect();
        let (mut layers, mut shapes, mut notes) = (Vec::new(), Vec::new(), Vec::new());
        for made in made {
            let (work, shape, said) = made?;
            layers.push(work);
            shapes.push(shape);
            notes.extend(said);
        }
        layer::tie(&parts, &mut shapes)?;
        let scene = placed(scene, shapes.iter().map(|shape| (shape.poses(), shape.mapping())))?;
        let weights = match weights.take() {
            Some(weights) => weights,
            None => weights_of(&scene, before)?,
        };
        let figure = Arc::new(Figure::new(&scene, shapes));
        let camera = match before {
            Some(before) => before.camera,
            None => camera(&scene, &figure, &weights)?,
        };
        Ok(Self {
            given: given.clone(),
            scene,
            layers,
            figure,
            weights,
            weights_are_own: true,
            camera,
            notes,
        })
    }

    /// The scene, laid out.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Its layers, in the scene's order; a scene without layers has one.
    #[must_use]
    pub fn layers(&self) -> &[LayerShape] {
        &self.figure.layers
    }

    /// The drawings of a layer: one a pose of it that is drawn, in order.
    #[must_use]
    pub fn drawings(&self, layer: usize) -> &[Drawing] {
        &self.layers[layer].drawings
    }

    /// How a layer was mapped.
    #[must_use]
    pub fn report(&self, layer: usize) -> &MappingReport {
        &self.layers[layer].report
    }

    /// A place of a source file in the drawing as it is used, which may be reflected, and the other way round: of drawing
    /// `drawing` of a layer, counted like [`Self::drawings`].
    #[must_use]
    pub fn as_used(&self, layer: usize, drawing: usize, place: Point) -> Point {
        landmarks::as_used(self.scene.of_layer(layer), self.drawings(layer), drawing, place)
    }

    /// What the artist should know, one line a remark.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The camera of frames of the animation's own size.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The weights.
    #[must_use]
    pub fn weights(&self) -> &Arc<EditableWeights> {
        &self.weights
    }

    /// Whether both pose the same weights in the same way.
    #[must_use]
    pub fn has_figure_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.figure, &other.figure)
    }

    /// Whether both have the meshes of one and the same mapping.
    #[must_use]
    pub fn has_meshes_of(&self, other: &Self) -> bool {
        self.layers.len() == other.layers.len()
            && (self.layers.iter().zip(&other.layers)).all(|(a, b)| Arc::ptr_eq(&a.report, &b.report))
    }

    /// Whether both show the very same pictures.
    #[must_use]
    pub fn has_pictures_of(&self, other: &Self) -> bool {
        self.layers.len() == other.layers.len()
            && (self.layers.iter().zip(&other.layers)).all(|(a, b)| Arc::ptr_eq(&a.drawings, &b.drawings))
    }

    /// The character for weights, one a pose of the scene, that sum to 1; its textures as sharp as the scene says, or as
    /// `sharpness` does.
    ///
    /// # Errors
    /// [`PipelineError`] if there is not one weight a pose, or they do not sum to 1.
    pub fn posed(&self, weights: &[f64], sharpness: Option<f64>) -> Result<Posed, PipelineError> {
        let weights = checked_weights(weights, &self.scene.names())?;
        self.figure.posed_sharpened(&weights, sharpness)
    }

    /// The character of this shape, for frames of the animation's own size: what is left to make is its art.
    ///
    /// # Errors
    /// [`PipelineError`] if a drawing cannot be prepared.
    pub fn character(&self) -> Result<Character, PipelineError> {
        let drawings = self
            .layers
            .iter()
            .map(|layer| layer.drawings.as_ref().clone())
            .collect();
        let weights: Arc<dyn WeightProvider> = Arc::<EditableWeights>::clone(&self.weights);
        let (figure, notes) = (Arc::clone(&self.figure), self.notes.clone());
        Character::drawn(&self.scene, figure, weights, self.camera, 1, drawings, notes)
    }

    /// Whether frames of a layer are curves: its drawings are, and the scene wants them so.
    #[must_use]
    pub fn is_drawn_as_curves(&self, layer: usize) -> bool {
        self.scene.of_layer(layer).art == ArtChoice::Curves
            && self.drawings(layer).iter().all(|drawing| drawing.art.is_some())
    }

    /// Whether both have the same shapes, drawn with the same art; their weights may differ.
    #[must_use]
    pub fn draws_like(&self, other: &Self) -> bool {
        let art = |bench: &Self, layer: usize| {
            let scene = bench.scene.of_layer(layer);
            (scene.art, scene.colour_blend)
        };
        self.has_figure_of(other)
            && self.has_pictures_of(other)
            && self.camera == other.camera
            && (0..self.layers.len()).all(|layer| art(self, layer) == art(other, layer))
    }

    /// The blended outlines of a layer: outer ring first.
    #[must_use]
    pub fn silhouette(&self, layer: usize, posed: &PosedLayer) -> Vec<Vec<Point>> {
        self.figure.layers[layer]
            .silhouette
            .at(&posed.positions, &posed.weights)
    }
}

/// The camera of frames of the animation's own size.
fn camera(scene: &Scene, figure: &Figure, weights: &EditableWeights) -> Result<Camera, PipelineError> {
    let size = scene.animation.size.map(|side| side as usize);
    figure::camera(&scene.animation, size, figure, weights)
}

/// The weights, kept if nothing that they are made of has changed.
fn weights_of(scene: &Scene, before: Option<&Workbench>) -> Result<Arc<EditableWeights>, PipelineError> {
    let is_same = |before: &&Workbench| {
        let was = &before.scene;
        let places = |scene: &Scene| scene.poses.iter().map(|pose| pose.at.clone()).collect::<Vec<_>>();
        before.weights_are_own
            && places(was) == places(scene)
            && was.pose_space == scene.pose_space
            && was.pseudo_poses == scene.pseudo_poses
    };
    match before.filter(is_same) {
        Some(before) => Ok(Arc::clone(&before.weights)),
        None => editable_weights(scene, None).map(Arc::new),
    }
}

/// Whether two scenes without layers read the same drawings in the same way.
fn shows_the_same(a: &Scene, b: &Scene) -> bool {
    let sources = |scene: &Scene| -> Vec<DrawnSource> {
        let drawn = scene.poses.iter().filter_map(|pose| match &pose.source {
            PoseSource::Drawn(source) => Some(DrawnSource {
                line: 0,
                ..source.clone()
            }),
            _ => None,
        });
        drawn.collect()
    };
    a.file == b.file && a.input == b.input && sources(a) == sources(b)
}

/// Whether two scenes without layers that show the same drawings have the same mapping.
fn maps_the_same(a: &Scene, b: &Scene) -> bool {
    let essence = |scene: &Scene| {
        let mut scene = scene.clone();
        // What mappings are not made of.
        scene.animation = a.animation.clone();
        scene.layout = Layout::Given;
        scene.pose_space = Default::default();
        scene.blend = Default::default();
        scene.texture_sharpness = 0.0;
        scene.colour_blend = Default::default();
        scene.art = Default::default();
        scene.pseudo_poses = Vec::new();
        for pose in &mut scene.poses {
            (pose.at, pose.turns, pose.draw_order) = (Vec::new(), 0, Vec::new());
            match &mut pose.source {
                PoseSource::Drawn(source) => source.line = 0,
                PoseSource::Deformed(copy) => copy.line = 0,
                PoseSource::Layered => {}
            }
        }
        let lines = scene.landmarks.iter_mut().map(|landmark| &mut landmark.line);
        for line in lines.chain(scene.paths.iter_mut().map(|path| &mut path.line)) {
            *line = 0;
        }
        scene
    };
    essence(a) == essence(b)
}
