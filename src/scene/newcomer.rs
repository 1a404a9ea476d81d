//! One more pose in a scene that stands: where it belongs, and where the scene's landmarks lie on it.
//!
//! 1. The scene is mapped with the new drawing in it, which has no landmark yet: the mapping carries those of the others onto it.
//! 2. Its place in the pose space is the one whose distances to the other poses are most nearly in proportion to how far its shape is from
//!    theirs; the other poses stay where they are.

use super::SceneBuildError;
use super::drawings::read_drawing;
use super::settings::Scene;
use crate::math::Point;
use crate::pipeline::{Build, LayerRole, Note};
use crate::pose::{LandmarkKind, deformation_distances};
use crate::weights::place_among;

/// What is known of a new pose from the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Newcomer {
    /// Its place in the pose space.
    pub at: Vec<f64>,
    /// For each landmark that the scene's other poses have, by name, where it lies on the new drawing.
    pub landmarks: Vec<(String, Point)>,
    /// The same of lines.
    pub paths: Vec<(String, Vec<Point>)>,
    /// What the artist should know.
    pub notes: Vec<Note>,
}

impl Scene {
    /// What the other poses say of pose `pose` of a scene without layers, whose drawing has no landmarks of its own.
    ///
    /// # Errors
    /// [`SceneBuildError`] if a drawing cannot be read or the scene cannot be mapped.
    pub fn newcomer(&self, pose: usize) -> Result<Newcomer, SceneBuildError> {
        let spec = self.spec_with(&read_drawing)?.with_loose_parts();
        let build = Build::new(&spec).map_err(|error| self.refusal(error))?;
        let mut newcomer = Newcomer {
            at: Vec::new(),
            landmarks: Vec::new(),
            paths: Vec::new(),
            notes: build.notes().to_vec(),
        };
        for (layer, own) in build.spec().layers.iter().enumerate() {
            let drawing = own.drawn_poses().iter().position(|drawn| *drawn == pose);
            if own.role == LayerRole::Body {
                let distances = deformation_distances(&build.layers()[layer].mapping().poses);
                let others: Vec<usize> = (0..self.poses.len()).filter(|other| *other != pose).collect();
                let places: Vec<Vec<f64>> = others.iter().map(|&other| self.poses[other].at.clone()).collect();
                let among: Vec<Vec<f64>> = others
                    .iter()
                    .map(|&a| others.iter().map(|&b| distances[a][b]).collect())
                    .collect();
                let own: Vec<f64> = others.iter().map(|&other| distances[pose][other]).collect();
                newcomer.at = place_among(&places, &among, &own);
            }
            let Some(drawing) = drawing else { continue };
            for landmark in &build.report(layer).landmarks {
                let as_drawn = |place: &Point| build.as_drawn(layer, drawing, *place);
                let places: Vec<Point> = landmark.at[pose].iter().map(as_drawn).collect();
                let is_line = |name: &String| own.paths.iter().any(|path| path.name == *name);
                match (landmark.kind, places.as_slice()) {
                    (LandmarkKind::Line, [_, _, ..]) if is_line(&landmark.name) => {
                        newcomer.paths.push((landmark.name.clone(), places));
                    }
                    (LandmarkKind::OnOutline | LandmarkKind::OnRim | LandmarkKind::Inside, [place])
                        if own.landmarks.iter().any(|own| own.name == landmark.name) =>
                    {
                        newcomer.landmarks.push((landmark.name.clone(), *place));
                    }
                    // The ends of lines on the outline come with their lines.
                    _ => {}
                }
            }
        }
        Ok(newcomer)
    }
}
