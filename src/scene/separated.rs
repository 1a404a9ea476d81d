//! The parts that were found in a scene's drawings, as the layers of a scene of its own.
//!
//! A scene without layers -> one drawing a part and pose, and what of the scene belongs to which part ([`Separated`]). The drawings are on
//! the canvas of the ones that they were found in, so every coordinate of the scene stays as it is. Limits: a part that a pose lacks grows
//! from a point while the scene is whole, and appears when it is in layers; nothing of a part lies hidden behind another one, since
//! parts are loose.

use super::SceneBuildError;
use super::drawings::read_drawing;
use super::settings::Scene;
use crate::input::{Art, Canvas, Picture};
use crate::outline::Outline;
use crate::pipeline::{HandleMove, Note, PoseShape};

/// A scene's parts.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Separated {
    /// From back to front; one if the drawings are of one piece.
    pub layers: Vec<SeparatedLayer>,
    /// For each pose the layers from back to front.
    pub draw_orders: Vec<Vec<usize>>,
    /// What the artist should know.
    pub notes: Vec<Note>,
}

/// One part of a scene's drawings.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SeparatedLayer {
    /// What it is called.
    pub name: String,
    /// Its drawing in each pose of the scene; `None` where the pose lacks it or is a deformed copy.
    pub drawings: Vec<Option<SeparatedDrawing>>,
    /// The names of the landmarks and lines that lie on it.
    pub landmarks: Vec<String>,
    /// For each pose of the scene the handles that take hold of it.
    pub handles: Vec<Vec<HandleMove>>,
}

/// A part of one drawing.
#[derive(Debug, Clone)]
pub enum SeparatedDrawing {
    /// Of a bitmap: its pixels on the whole canvas.
    Pixels(Picture),
    /// Of a vector drawing: its curves, and the page that they are on.
    Curves(Art, Canvas),
    /// Of a vector drawing with something that curves cannot say, such as a picture or a mask.
    Unwritable,
}

impl Scene {
    /// The parts of a scene without layers.
    ///
    /// # Errors
    /// [`SceneBuildError`] if a drawing cannot be read.
    pub fn separated(&self) -> Result<Separated, SceneBuildError> {
        let spec = self.spec_with(&read_drawing)?.with_loose_parts();
        let outlines = |pose: usize, but: usize| -> Vec<&Outline> {
            let others = spec.layers.iter().enumerate().filter(|(layer, _)| *layer != but);
            let shapes = others.filter_map(|(_, layer)| match &layer.poses.get(pose)?.shape {
                PoseShape::Drawn(drawn) => Some(&drawn.drawing.outline),
                PoseShape::Deformed(_) | PoseShape::Shrunk(_) => None,
            });
            shapes.collect()
        };
        let drawing_of = |layer: usize, pose: usize| -> Option<SeparatedDrawing> {
            let PoseShape::Drawn(drawn) = &spec.layers[layer].poses.get(pose)?.shape else {
                return None;
            };
            Some(match (&drawn.drawing.art, &drawn.svg) {
                (Some(art), _) => SeparatedDrawing::Curves(art.clone(), drawn.drawing.canvas),
                (None, Some(_)) => SeparatedDrawing::Unwritable,
                (None, None) => SeparatedDrawing::Pixels(drawn.drawing.picture_alone(&outlines(pose, layer))),
            })
        };
        let handles_of = |layer: usize, pose: usize| match spec.layers[layer].poses.get(pose).map(|pose| &pose.shape) {
            Some(PoseShape::Deformed(copy)) => copy.handles.clone(),
            _ => Vec::new(),
        };
        let poses = 0..self.poses.len();
        let layers = (spec.layers.iter().enumerate()).map(|(index, layer)| {
            let landmarks = layer.landmarks.iter().map(|landmark| landmark.name.clone());
            SeparatedLayer {
                name: layer.name.clone(),
                drawings: poses.clone().map(|pose| drawing_of(index, pose)).collect(),
                landmarks: landmarks
                    .chain(layer.paths.iter().map(|path| path.name.clone()))
                    .collect(),
                handles: poses.clone().map(|pose| handles_of(index, pose)).collect(),
            }
        });
        Ok(Separated {
            layers: layers.collect(),
            draw_orders: spec.draw_order_of_poses(),
            notes: spec.notes.clone(),
        })
    }
}
