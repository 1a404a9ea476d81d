//! Whether the places under `keep` and `drop` of a pose with layers name something: each a loose part of the drawing of a layer.
//!
//! A pose's places are those of all its drawings, which lie over one another. Each drawing passes over those that name nothing of it, and says so
//! ([`InputNote::PlacePassedOver`]); a place that all of them pass over is wrong.

use super::SceneBuildError;
use super::settings::{DrawnSource, PoseSource, Scene};
use crate::input::InputNote;
use crate::math::Point;
use crate::pipeline::{LayerSpec, PoseShape};

/// Refuses a place that names nothing on any layer; `layers` are those of `scene` as they were read.
pub(super) fn check_named_parts(scene: &Scene, layers: &[LayerSpec]) -> Result<(), SceneBuildError> {
    for pose in 0..scene.poses.len() {
        let drawings: Vec<(&DrawnSource, Vec<Point>)> = (scene.layers.iter().zip(layers))
            .filter_map(|(layer, read)| {
                let own = layer.poses.iter().position(|own| *own == pose)?;
                match (&layer.scene.poses[own].source, &read.poses[own].shape) {
                    (PoseSource::Drawn(said), PoseShape::Drawn(drawn)) => {
                        let notes = drawn.drawing.notes.iter();
                        let passed_over = notes.filter_map(|note| match note {
                            InputNote::PlacePassedOver { place } => Some(*place),
                            _ => None,
                        });
                        Some((said, passed_over.collect()))
                    }
                    _ => None,
                }
            })
            .collect();
        let Some((said, _)) = drawings.first() else { continue };
        let mut places = said.parts.keep.iter().chain(&said.parts.drop);
        let is_wrong = |place: &&Point| drawings.iter().all(|(_, passed_over)| passed_over.contains(place));
        if let Some(place) = places.find(is_wrong) {
            return Err(SceneBuildError::NoPartInLayers {
                file: scene.file.clone(),
                line: said.line,
                pose: scene.poses[pose].name.clone(),
                x: place.x,
                y: place.y,
            });
        }
    }
    Ok(())
}
