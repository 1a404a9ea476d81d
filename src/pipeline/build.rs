//! A character while it is built: made again after every change of its specification, from what the change leaves alone.
//!
//! [`Character`](super::Character) is made once and drawn often. A build is what it is made of, and is for whoever changes the
//! specification all the time and looks at shapes, not at painted frames: every stage has an input that can be compared, and runs
//! again when its input differs.
//!
//! | stage | its input | what is kept while that is equal |
//! |---|---|---|
//! | drawings | [`DrawnPose`]: drawing, facing; landmarks on rims where not all poses have the same holes | the drawing as it is used |
//! | boundaries | drawings, landmarks on outlines and rims, reference, tolerance | matching and simplification |
//! | mapping | `MappingInput`: poses, landmarks, lines, reference, mesh | the mesh of all poses |
//! | blend | [`BlendOptions`](crate::blend::BlendOptions) of the mesh | the factorised system |
//! | textures | the mapping | the registration of the pictures, once it was asked for |
//! | weights | `WeightsInput`: places, [`WeightOptions`] | the factorised weights |
//!
//! What is cheap is made anew every time: attachments, drawing orders, the sharpness of textures. The shapes are those of a build
//! of the same specification from nothing, to the last bit.

use std::sync::{Arc, OnceLock};

use rayon::prelude::*;

use super::boundaries::Boundaries;
use super::canvas;
use super::drawings::{covered_outlines, placed_drawings, with_outlines};
use super::figure::{self, Figure, Posed};
use super::layer::{self, LayerShape, Part, PosedLayer};
use super::layout::placed;
use super::mapping::map_drawings_again;
use super::note::Note;
use super::spec::{
    ArtChoice, CameraRule, CharacterSpec, DrawnPose, LandmarkSpec, LayerSpec, LimbSpec, MeshOptions, OverlapSearch,
    PathSpec, Places, PoseSpec, Register, WeightOptions,
};
use super::{
    Character, EditableWeights, MappingReport, PipelineError, checked_weights, editable_weights, landmarks, textures,
};
use crate::animation::Animation;
use crate::input::Drawing;
use crate::math::Point;
use crate::pose::TextureMesh;
use crate::render::{Camera, Sampling};
use crate::weights::WeightProvider;

/// A character before it is painted, made again after every change from what the change leaves alone.
///
/// Its shapes are those of a [`Character`] of the same specification, to the last bit. Copies share everything.
#[derive(Debug, Clone)]
pub struct Build {
    spec: Arc<CharacterSpec>,
    layers: Vec<LayerBuild>,
    figure: Arc<Figure>,
    weights: Arc<EditableWeights>,
    /// What the weights are made of; `None` for weights that were given.
    weights_input: Option<WeightsInput>,
    places: Vec<Vec<f64>>,
    notes: Vec<Note>,
}

/// What a layer is made of.
#[derive(Debug, Clone)]
struct LayerBuild {
    input: Arc<MappingInput>,
    /// Reflected and moved, with all their holes, one a drawn pose.
    placed: Arc<Vec<Arc<Drawing>>>,
    /// As they are used: without the holes that the mesh covers.
    drawings: Arc<Vec<Arc<Drawing>>>,
    report: Arc<MappingReport>,
    boundaries: Arc<Boundaries>,
    /// Made when it is first asked for.
    texture_mesh: Arc<OnceLock<Option<Arc<TextureMesh>>>>,
}

/// All that the mapping of a layer depends on.
#[derive(Debug, PartialEq)]
struct MappingInput {
    poses: Vec<PoseSpec>,
    reference: Option<usize>,
    landmarks: Vec<LandmarkSpec>,
    paths: Vec<PathSpec>,
    limbs: Vec<LimbSpec>,
    limb_orders: Vec<Vec<String>>,
    mesh: MeshOptions,
    overlaps: OverlapSearch,
}

impl MappingInput {
    fn of(layer: &LayerSpec) -> Self {
        Self {
            poses: layer.poses.clone(),
            reference: layer.reference,
            landmarks: layer.landmarks.clone(),
            paths: layer.paths.clone(),
            limbs: layer.limbs.clone(),
            limb_orders: layer.limb_orders.clone(),
            mesh: layer.mesh.clone(),
            overlaps: layer.overlaps,
        }
    }
}

/// All that weights depend on.
#[derive(Debug, Clone, PartialEq)]
struct WeightsInput {
    places: Vec<Vec<f64>>,
    options: WeightOptions,
}

impl Build {
    /// Checks and maps a specification.
    ///
    /// # Errors
    /// [`PipelineError`] from any stage.
    pub fn new(spec: &CharacterSpec) -> Result<Self, PipelineError> {
        rayon::scope(|_| Self::made(spec, None))
    }

    /// The build of a changed specification: only stages whose input differs run again.
    ///
    /// # Errors
    /// As [`Self::new`]; this build stays as it is.
    pub fn update(&self, spec: &CharacterSpec) -> Result<Self, PipelineError> {
        rayon::scope(|_| Self::made(spec, Some(self)))
    }

    /// The same shapes with the poses at other places, whose weights are given: for weights that follow from those that were there
    /// faster than new ones are made ([`EditableWeights::move_pose`]).
    #[must_use]
    pub fn reweighted(&self, places: Vec<Vec<f64>>, weights: Arc<EditableWeights>) -> Self {
        Self {
            places,
            weights,
            weights_input: None,
            ..self.clone()
        }
    }

    /// To be run by a thread of the pool: the stages hand thousands of small tasks to it, and from outside each of them would put
    /// the thread to sleep.
    fn made(spec: &CharacterSpec, before: Option<&Self>) -> Result<Self, PipelineError> {
        spec.check()?;
        // The cheap refusals first.
        let mut weights = match &spec.space.places {
            Places::Given(places) => Some(weights_of(spec, places, before)?),
            Places::Automatic => None,
        };
        let parts = layer::parts(spec);
        let parts_before = before.map_or_else(Vec::new, |before| layer::parts(&before.spec));
        let step = |(k, part): (usize, &Part<'_>)| {
            let was = before.and_then(|before| {
                let is_same = |old: &Part<'_>| old.layer.name == part.layer.name && old.poses == part.poses;
                let old = parts_before.get(k).filter(|old| is_same(old))?;
                Some((old.layer, before.layers.get(k)?, before.figure.layers.get(k)?))
            });
            built(part, was)
        };
        let made: Vec<Result<_, PipelineError>> = parts.par_iter().enumerate().map(step).collect();
        let (mut layers, mut shapes, mut notes) = (Vec::new(), Vec::new(), spec.notes.clone());
        for made in made {
            let (layer, shape, said) = made?;
            layers.push(layer);
            shapes.push(shape);
            notes.extend(said);
        }
        layer::tie(&parts, &mut shapes)?;
        let places = placed(spec, &shapes)?;
        let weights = match weights.take() {
            Some(weights) => weights,
            None => weights_of(spec, &places, before)?,
        };
        Ok(Self {
            layers,
            figure: Arc::new(Figure::new(spec, shapes)),
            weights,
            weights_input: Some(WeightsInput {
                places: places.clone(),
                options: spec.space.weights.clone(),
            }),
            places,
            notes,
            spec: Arc::new(spec.clone()),
        })
    }

    /// The specification that it is the build of.
    #[must_use]
    pub fn spec(&self) -> &CharacterSpec {
        &self.spec
    }

    /// The places of the poses, one a pose.
    #[must_use]
    pub fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    /// Its layers, from back to front.
    #[must_use]
    pub fn layers(&self) -> &[LayerShape] {
        &self.figure.layers
    }

    /// The drawings of a layer as they are used: one a pose of it that is drawn, in order.
    #[must_use]
    pub fn drawings(&self, layer: usize) -> &[Arc<Drawing>] {
        &self.layers[layer].drawings
    }

    /// How a layer was mapped.
    #[must_use]
    pub fn report(&self, layer: usize) -> &MappingReport {
        &self.layers[layer].report
    }

    /// A place of a drawing in the drawing as it is used, which may be reflected and moved: of drawing `drawing` of a layer, counted
    /// like [`Self::drawings`].
    #[must_use]
    pub fn as_used(&self, layer: usize, drawing: usize, place: Point) -> Point {
        landmarks::as_used(&self.spec.layers[layer], drawing, place)
    }

    /// The place of a drawing that [`Self::as_used`] takes to `place`.
    #[must_use]
    pub fn as_drawn(&self, layer: usize, drawing: usize, place: Point) -> Point {
        landmarks::as_drawn(&self.spec.layers[layer], drawing, place)
    }

    /// What the artist should know.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
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

    /// Whether both have the same shapes, drawn with the same art; their weights may differ.
    #[must_use]
    pub fn draws_like(&self, other: &Self) -> bool {
        let art = |build: &Self| {
            let texture = &build.spec.texture;
            (texture.art, texture.blending, texture.sampling, texture.register)
        };
        self.has_figure_of(other) && self.has_pictures_of(other) && art(self) == art(other)
    }

    /// The mesh on which the pictures of a layer are registered to one another; `None` where the mapping's own mesh carries them (nothing is drawn inside,
    /// they are too unlike, or the specification does not want it) and where frames are curves. Made when it is first asked for.
    #[must_use]
    pub fn texture_mesh(&self, layer: usize) -> Option<Arc<TextureMesh>> {
        let texture = &self.spec.texture;
        if texture.register == Register::Off || texture.sampling == Sampling::Nearest || self.is_drawn_as_curves(layer)
        {
            return None;
        }
        let (of, mapping) = (&self.layers[layer], self.figure.layers[layer].mapping());
        if !mapping.overlaps.is_empty() {
            return None;
        }
        let made = || textures::registered(&self.spec.layers[layer], &of.boundaries, mapping).map(Arc::new);
        of.texture_mesh.get_or_init(made).clone()
    }

    /// Whether frames of a layer are curves: its drawings are, and the specification wants them so.
    #[must_use]
    pub fn is_drawn_as_curves(&self, layer: usize) -> bool {
        self.spec.texture.art == ArtChoice::Curves
            && self.figure.layers[layer].mapping().overlaps.is_empty()
            && self.drawings(layer).iter().all(|drawing| drawing.art.is_some())
    }

    /// The character for weights, one a pose, that sum to 1; its textures as sharp as the specification says, or as `sharpness`
    /// does.
    ///
    /// # Errors
    /// [`PipelineError`] if there is not one weight a pose, or they do not sum to 1.
    pub fn posed(&self, weights: &[f64], sharpness: Option<f64>) -> Result<Posed, PipelineError> {
        let weights = checked_weights(weights, &self.spec.space.poses)?;
        self.figure.posed_sharpened(&weights, sharpness)
    }

    /// The blended outlines of a layer: outer ring first.
    #[must_use]
    pub fn silhouette(&self, layer: usize, posed: &PosedLayer) -> Vec<Vec<Point>> {
        self.figure.layers[layer]
            .silhouette
            .at(&posed.positions, &posed.weights)
    }

    /// A camera for frames of `size` (columns, rows) that shows what the specification's [`CameraRule`] says: all poses and the whole
    /// animation, or the drawings' canvas. Looking at the animation takes as long as dozens of frames.
    ///
    /// # Errors
    /// [`PipelineError`] if the animation is none in this pose space.
    pub fn camera(&self, animation: &Animation, size: [usize; 2]) -> Result<Camera, PipelineError> {
        match self.spec.camera {
            CameraRule::Fit => figure::camera(animation, size, &self.figure, self.weights.as_ref()),
            CameraRule::Drawing => Ok(canvas::camera(
                self.layers.iter().flat_map(|layer| layer.drawings.iter()),
                size,
            )),
        }
    }

    /// The character of this shape, seen by `camera`, with `samples` x `samples` samples a pixel, from 1 to 4: what is left to
    /// make is its art. In front of the animation's background; see [`Self::through_places`].
    ///
    /// # Errors
    /// [`PipelineError`] if a drawing cannot be prepared.
    pub fn character(&self, animation: &Animation, camera: Camera, samples: usize) -> Result<Character, PipelineError> {
        let weights: Arc<dyn WeightProvider> = Arc::<EditableWeights>::clone(&self.weights);
        Character::drawn(self, animation, weights, camera, samples)
    }

    /// The animation with the poses where they are: one through the poses goes through their places, one with keys of its own
    /// stays as it is.
    ///
    /// # Errors
    /// [`PipelineError`] if there is no such animation.
    pub fn through_places(&self, animation: &Animation) -> Result<Animation, PipelineError> {
        Ok(animation.through(self.places.iter().map(Vec::as_slice))?)
    }

    /// The shapes of all layers.
    pub(super) fn figure(&self) -> &Arc<Figure> {
        &self.figure
    }
}

/// A layer, built from what it was before: the specification, what was made of it, the shape.
fn built(
    part: &Part<'_>,
    was: Option<(&LayerSpec, &LayerBuild, &LayerShape)>,
) -> Result<(LayerBuild, LayerShape, Vec<Note>), PipelineError> {
    let input = MappingInput::of(part.layer);
    if let Some((_, layer, shape)) = was.filter(|(_, layer, _)| *layer.input == input) {
        let mut notes = layer.report.notes.clone();
        let shape = part.shape_again(shape, &mut notes)?;
        return Ok((layer.clone(), shape, notes));
    }
    let same_drawings = was.filter(|(old, ..)| old.has_drawings_of(part.layer));
    let placed = match same_drawings {
        Some((_, layer, _)) => Arc::clone(&layer.placed),
        None => {
            let kept = |pose: &DrawnPose| {
                let (old, layer, _) = was?;
                let place = old.drawn().position(|old| old == pose)?;
                layer.placed.get(place).cloned()
            };
            Arc::new(placed_drawings(part.layer, kept).map_err(|error| part.refusal(error))?)
        }
    };
    let covered = covered_outlines(part.layer, &placed).map_err(|error| part.refusal(error))?;
    // Which holes are covered depends on landmarks, too.
    let same_used = same_drawings.filter(|(_, layer, _)| match &covered {
        Some(outlines) => layer.drawings.iter().map(|drawing| &drawing.outline).eq(outlines),
        None => Arc::ptr_eq(&layer.drawings, &placed),
    });
    let drawings = match (same_used, covered) {
        (Some((_, layer, _)), _) => Arc::clone(&layer.drawings),
        (None, Some(outlines)) => Arc::new(with_outlines(&placed, outlines)),
        (None, None) => Arc::clone(&placed),
    };
    let boundaries_before = same_used.map(|(_, layer, _)| &layer.boundaries);
    let mapped = map_drawings_again(part.layer, &drawings, boundaries_before);
    let (mapping, mut report, boundaries) = mapped.map_err(|error| part.refusal(error))?;
    report.notes = report.notes.into_iter().map(|note| part.named(note)).collect();
    let mut notes = report.notes.clone();
    let shape = part.shape(mapping, &mut notes)?;
    let layer = LayerBuild {
        input: Arc::new(input),
        placed,
        drawings,
        report: Arc::new(report),
        boundaries,
        texture_mesh: Arc::default(),
    };
    Ok((layer, shape, notes))
}

/// The weights, kept if nothing that they are made of has changed.
fn weights_of(
    spec: &CharacterSpec,
    places: &[Vec<f64>],
    before: Option<&Build>,
) -> Result<Arc<EditableWeights>, PipelineError> {
    let is_same = |input: &WeightsInput| input.places == places && input.options == spec.space.weights;
    match before.filter(|before| before.weights_input.as_ref().is_some_and(is_same)) {
        Some(before) => Ok(Arc::clone(&before.weights)),
        None => editable_weights(&spec.space.poses, places, &spec.space.weights).map(Arc::new),
    }
}
