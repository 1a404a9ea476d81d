//! A character ready to be shown in any pose.

use rayon::prelude::*;

use super::drawings::sharpen;
use super::layer::{self, LayerShape, Part, PosedLayer};
use super::layout::placed;
use super::{PipelineError, weight_provider, weighting};
use crate::blend::{self, BlendOptions};
use crate::input::Drawing;
use crate::math::Point;
use crate::pose::Mapping;
use crate::render::drawing::{CarriedDrawing, PoseArt, VectorFrame, VectorGroup, VectorNode, VectorPicture, rasterise};
use crate::render::puppet::{Puppet, PuppetFrame, PuppetLayer, PuppetTexture};
use crate::render::{Camera, Frame, Painter, PoseTexture, Texture};
use crate::scene::{Anchor, Animation, ArtChoice, Background, Layout, Scene};
use crate::texture::texture_weights;
use crate::weights::WeightProvider;

/// How many places of the animation the camera looks at before it chooses its distance.
const CAMERA_PLACES: usize = 48;

/// A scene's character with everything that is computed once: mappings, factorised blends, weights, textures, camera.
#[derive(Debug)]
pub struct Character {
    names: Vec<String>,
    figure: Figure,
    weights: Box<dyn WeightProvider>,
    /// What each layer is drawn with.
    art: Vec<LayerArt>,
    /// What each layer's drawings were, for whoever draws meshes by himself.
    sources: Vec<LayerSource>,
    camera: Camera,
    notes: Vec<String>,
    background: Background,
}

/// What a layer is drawn with.
#[derive(Debug)]
enum LayerArt {
    /// Textures of its drawings.
    Pixels(Box<Painter>),
    /// Its drawings' curves.
    Curves(Box<CarriedDrawing>),
}

/// The drawings of a layer.
#[derive(Debug)]
struct LayerSource {
    drawings: Vec<Drawing>,
    /// The pose of each drawing.
    drawn_on: Vec<usize>,
    /// The drawing of each pose.
    drawing_of: Vec<usize>,
}

/// The shapes of all layers.
#[derive(Debug)]
struct Figure {
    layers: Vec<LayerShape>,
    /// Per pose of the scene, the layers from back to front.
    draw_orders: Vec<Vec<usize>>,
    texture_sharpness: f64,
}

/// A character in one pose: the shapes of a frame, before it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// One a layer of the scene; a scene without layers has one.
    pub layers: Vec<PosedLayer>,
    /// The layers from back to front.
    pub order: Vec<usize>,
}

impl Posed {
    /// Inverted triangles, over all layers.
    #[must_use]
    pub fn flipped(&self) -> usize {
        self.layers.iter().map(|layer| layer.report.flipped).sum()
    }
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
        let figure = Figure {
            draw_orders: draw_orders(scene, shapes.len()),
            layers: shapes,
            texture_sharpness: scene.texture_sharpness,
        };
        let camera = camera(&scene.animation, size, &figure, weights.as_ref())?;
        let mut sources = Vec::new();
        let mut art = Vec::new();
        for ((part, shape), mut drawings) in parts.iter().zip(&figure.layers).zip(drawings) {
            let silhouette = shape.silhouette.clone();
            art.push(match curves(part.scene, &mut drawings) {
                Some((curves, drawing_of)) => {
                    let (carried, remarks) =
                        CarriedDrawing::new(shape.mapping(), curves, drawing_of, silhouette, camera);
                    notes.extend(remarks.iter().map(|note| part.remark(note)));
                    LayerArt::Curves(Box::new(carried))
                }
                None => {
                    sharpen(part.scene, &mut drawings, camera.scale())?;
                    let (textures, texture_of) = textures(part.scene, &drawings, camera.scale());
                    let painter = Painter::new(shape.mapping(), textures, texture_of, silhouette, camera);
                    LayerArt::Pixels(Box::new(painter))
                }
            });
            sources.push(LayerSource {
                drawn_on: part.scene.drawn_poses(),
                drawing_of: drawing_of_poses(part.scene),
                drawings,
            });
        }
        Ok(Self {
            names: scene.names(),
            figure,
            weights,
            art,
            sources,
            camera,
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
        let mut weights = Vec::new();
        self.weights
            .weights(place, &mut weights)
            .map_err(PipelineError::Weights)?;
        self.posed_of(&weights)
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
        let has_curves = self.art.iter().any(|art| matches!(art, LayerArt::Curves(_)));
        if has_curves {
            return rasterise(&self.draw(posed), 1);
        }
        let mut frame: Option<Frame> = None;
        for &k in &posed.order {
            let layer = &posed.layers[k];
            let LayerArt::Pixels(painter) = &self.art[k] else {
                continue;
            };
            if layer.opacity <= 0.0 {
                continue;
            }
            let own = painter.paint(&layer.positions, &layer.weights, &layer.texture_weights);
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
            let mut own = match &self.art[k] {
                LayerArt::Curves(drawing) => drawing.frame(&layer.positions, &layer.weights, &layer.texture_weights),
                LayerArt::Pixels(painter) => vec![VectorNode::Picture(VectorPicture {
                    id: "picture".to_owned(),
                    frame: painter.paint(&layer.positions, &layer.weights, &layer.texture_weights),
                    opacity: 1.0,
                })],
            };
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
        let layer = |(shape, source): (&LayerShape, &LayerSource)| {
            let poses = &shape.mapping().poses;
            let texture = |(drawing, &pose): (&Drawing, &usize)| {
                PuppetTexture::new(
                    &poses.names()[pose],
                    &drawing.picture,
                    &drawing.outline,
                    &poses.positions()[pose],
                    self.camera.scale(),
                )
            };
            let textures = source.drawings.iter().zip(&source.drawn_on).map(texture).collect();
            PuppetLayer::new(
                shape.name(),
                shape.mapping(),
                textures,
                &source.drawing_of,
                &self.camera,
            )
        };
        Puppet {
            size: self.camera.size(),
            layers: self.figure.layers.iter().zip(&self.sources).map(layer).collect(),
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

impl Figure {
    /// The shapes for weights that sum to 1.
    fn posed(&self, weights: &[f64]) -> Result<Posed, PipelineError> {
        let shown = texture_weights(weights, self.texture_sharpness)?;
        let mut layers: Vec<PosedLayer> = (self.layers.iter())
            .map(|shape| shape.posed(weights, &shown, self.texture_sharpness))
            .collect::<Result<_, _>>()?;
        // What a layer hangs on is put in its place first; a validated scene has no circle.
        let mut is_placed: Vec<bool> = self.layers.iter().map(|shape| shape.hangs_on().is_none()).collect();
        for _ in 0..self.layers.len() {
            for (k, shape) in self.layers.iter().enumerate() {
                let Some(to) = shape.hangs_on().filter(|&to| !is_placed[k] && is_placed[to]) else {
                    continue;
                };
                let gap = shape.gap(&layers[k], &layers[to]);
                for position in &mut layers[k].positions {
                    *position += gap;
                }
                is_placed[k] = true;
            }
        }
        Ok(Posed {
            layers,
            order: self.draw_orders[strongest(&shown)].clone(),
        })
    }
}

/// The pose whose drawing is seen most; of equal ones the first.
fn strongest(shown: &[f64]) -> usize {
    (0..shown.len()).fold(0, |best, pose| if shown[pose] > shown[best] { pose } else { best })
}

fn draw_orders(scene: &Scene, layer_count: usize) -> Vec<Vec<usize>> {
    if scene.layers.is_empty() {
        return vec![(0..layer_count).collect(); scene.poses.len()];
    }
    scene.poses.iter().map(|pose| pose.draw_order.clone()).collect()
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
    animation: &Animation,
    size: [usize; 2],
    figure: &Figure,
    weights: &dyn WeightProvider,
) -> Result<Camera, PipelineError> {
    let mut shown: Vec<Point> = (figure.layers.iter())
        .flat_map(|layer| &layer.mapping().outlines)
        .flat_map(|outline| outline.outer().points().iter().copied())
        .collect();
    let (start, count) = (animation.time_of_frame(0), CAMERA_PLACES);
    let mut at_place = Vec::new();
    for k in 0..count {
        let time = start + animation.duration() * k as f64 / count as f64;
        weights
            .weights(&animation.at(time), &mut at_place)
            .map_err(PipelineError::Weights)?;
        for (shape, posed) in figure.layers.iter().zip(figure.posed(&at_place)?.layers) {
            if posed.opacity > 0.0 {
                shown.extend(
                    shape
                        .silhouette
                        .at(&posed.positions, &posed.weights)
                        .into_iter()
                        .flatten(),
                );
            }
        }
    }
    Ok(Camera::fitting(&shown, size))
}

/// The drawings as curves, if all are to be and can be drawn so, and which of them each pose shows.
fn curves(scene: &Scene, drawings: &mut [Drawing]) -> Option<(Vec<PoseArt>, Vec<usize>)> {
    if scene.art == ArtChoice::Pixels || drawings.iter().any(|drawing| drawing.art.is_none()) {
        return None;
    }
    let curves = drawings
        .iter_mut()
        .zip(scene.drawn_poses())
        .filter_map(|(drawing, drawn_on)| {
            Some(PoseArt {
                art: drawing.art.take()?,
                drawn_on,
            })
        });
    Some((curves.collect(), drawing_of_poses(scene)))
}

/// The drawings' textures, and which of them each pose shows.
fn textures(scene: &Scene, drawings: &[Drawing], frame_scale: f64) -> (Vec<PoseTexture>, Vec<usize>) {
    let textures = drawings
        .iter()
        .zip(scene.drawn_poses())
        .map(|(drawing, drawn_on)| PoseTexture {
            texture: Texture::new(&drawing.picture, &drawing.outline, frame_scale),
            drawn_on,
        })
        .collect();
    (textures, drawing_of_poses(scene))
}

/// The drawing that each pose shows, by its place among those that are drawn.
fn drawing_of_poses(scene: &Scene) -> Vec<usize> {
    let drawn = scene.drawn_poses();
    let shown = |pose: usize| {
        let root = scene.drawing_of(pose).map(|(root, _)| root);
        drawn.iter().position(|&pose| Some(pose) == root).unwrap_or(0)
    };
    (0..scene.poses.len()).map(shown).collect()
}
