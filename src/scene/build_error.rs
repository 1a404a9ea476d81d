//! Why a scene gives no pictures, and where in its file that stands.

use std::path::PathBuf;

use super::settings::{PoseSource, Scene};
use super::{SceneError, layers};
use crate::input::InputError;
use crate::pipeline::PipelineError;

/// Why no character could be built from a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneBuildError {
    /// The scene file is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A drawing cannot be used.
    #[error("{}:{line}: {}pose '{pose}' ({}): {source}", file.display(), layers::prefix(layer.as_deref()), drawing.display())]
    Drawing {
        /// The scene file.
        file: PathBuf,
        /// The line that names the drawing.
        line: usize,
        /// The layer, in a scene with layers.
        layer: Option<String>,
        /// The pose's name.
        pose: String,
        /// The drawing's file, as written.
        drawing: PathBuf,
        /// What is wrong.
        source: Box<InputError>,
    },
    /// A place under `keep` or `drop` of a pose with layers names nothing.
    #[error(
        "{}:{line}: pose '{pose}': `keep` and `drop`: on the drawing of no layer is a loose part near ({x:.1}, {y:.1}); give a place on the part that is \
         meant",
        file.display()
    )]
    NoPartInLayers {
        /// The scene file.
        file: PathBuf,
        /// The line that names the first of the pose's drawings.
        line: usize,
        /// The pose's name.
        pose: String,
        /// The place, in source units.
        x: f64,
        /// The place, in source units.
        y: f64,
    },
    /// Weights were asked for that cannot do what the scene says.
    #[error("{}: pose space: radial weights know no walls and no bounds; remove them, or take biharmonic weights", file.display())]
    Provider {
        /// The scene file.
        file: PathBuf,
    },
    /// The pipeline refused.
    #[error("{}{}: {source}", file.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Pipeline {
        /// The scene file.
        file: PathBuf,
        /// The line of what the refusal is about, where it stands on one.
        line: Option<usize>,
        /// What is wrong.
        source: Box<PipelineError>,
    },
}

impl Scene {
    /// The pipeline's refusal with the file and the line of the landmark or pose that it is about.
    #[must_use]
    pub fn refusal(&self, error: PipelineError) -> SceneBuildError {
        SceneBuildError::Pipeline {
            file: self.file.clone(),
            line: self.line_of(&error),
            source: Box::new(error),
        }
    }

    fn line_of(&self, error: &PipelineError) -> Option<usize> {
        let own = (error.layer().and_then(|name| self.layer(name))).map_or(self, |layer| &layer.scene);
        if let Some(name) = error.landmark() {
            let points = own.landmarks.iter().map(|landmark| (&landmark.name, landmark.line));
            let lines = own.paths.iter().map(|path| (&path.name, path.line));
            let whole = |end: &str| name.strip_suffix(end);
            let name = whole(" (start)").or_else(|| whole(" (end)")).unwrap_or(name);
            return points.chain(lines).find(|(own, _)| *own == name).map(|(_, line)| line);
        }
        if let Some(name) = error.limb() {
            return own.limbs.iter().find(|limb| limb.name == name).map(|limb| limb.line);
        }
        let pose = own.poses.iter().find(|pose| Some(pose.name.as_str()) == error.pose())?;
        match (&pose.source, error.within_layer()) {
            (PoseSource::Deformed(copy), PipelineError::Deformation { .. }) => Some(copy.line),
            (PoseSource::Drawn(drawn), PipelineError::Drawing { .. }) => Some(drawn.line),
            _ => None,
        }
    }
}
