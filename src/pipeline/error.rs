//! Why a scene gives no pictures.

use std::path::PathBuf;

use super::LandmarkLabel;
use crate::blend::BlendError;
use crate::input::InputError;
use crate::scene::SceneError;
use crate::texture::TextureError;
use crate::weights::WeightError;

/// Why the pipeline stopped. Every message names the pose or file that it is about.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// The scene file is wrong.
    #[error(transparent)]
    Scene(Box<SceneError>),
    /// A layer cannot be used.
    #[error("layer '{layer}': {source}")]
    Layer {
        /// Its name.
        layer: String,
        /// What is wrong.
        source: Box<PipelineError>,
    },
    /// A scene with layers was given where one layer is meant.
    #[error("the scene has layers; this works on one of them, {}", layers.join(" or "))]
    Layered {
        /// Their names.
        layers: Vec<String>,
    },
    /// A drawing cannot be used.
    #[error("pose '{pose}' ({}): {source}", file.display())]
    Drawing {
        /// The pose's name.
        pose: String,
        /// Its file.
        file: PathBuf,
        /// What is wrong.
        source: Box<InputError>,
    },
    /// The poses have different numbers of holes.
    #[error(
        "pose '{pose}' has {found} holes, but pose '{other}' has {expected}; draw the same holes in every pose, or set \
         `holes = \"match\"` or `holes = \"fill\"` under [input]"
    )]
    HoleCount {
        /// The pose that differs.
        pose: String,
        /// Its holes.
        found: usize,
        /// The pose it differs from.
        other: String,
        /// That pose's holes.
        expected: usize,
    },
    /// A landmark lies off the outline.
    #[error(
        "landmark '{landmark}' (line {line}): on pose '{pose}' it lies {distance:.1} units from the outline, at most \
         {largest:.1} are allowed; move ({x:.1}, {y:.1}) onto the outline, or inside the shape in every pose"
    )]
    LandmarkOffOutline {
        /// Its name.
        landmark: String,
        /// The line of the scene file.
        line: usize,
        /// The pose's name.
        pose: String,
        /// How far it is off, in source units.
        distance: f64,
        /// How far it may be off.
        largest: f64,
        /// Its place.
        x: f64,
        /// Its place.
        y: f64,
    },
    /// A landmark inside the shape is not given in every pose, and there is no room where it should be.
    #[error(
        "landmark '{landmark}' (line {line}) lies inside the shape, but pose '{pose}' has neither a place for it nor room where it should be; give it one"
    )]
    LandmarkMissing {
        /// Its name.
        landmark: String,
        /// The line of the scene file.
        line: usize,
        /// The pose's name.
        pose: String,
    },
    /// A landmark inside the drawing is not inside its polygon.
    #[error("landmark {landmark} is not inside the shape of pose '{pose}', or leaves it; correct its place")]
    LandmarkOutside {
        /// Which.
        landmark: LandmarkLabel,
        /// The pose's name.
        pose: String,
    },
    /// Two landmarks inside the shape touch or cross.
    #[error("landmarks {first} and {second} meet inside pose '{pose}'; draw them apart")]
    LandmarksMeet {
        /// A landmark.
        first: LandmarkLabel,
        /// The other.
        second: LandmarkLabel,
        /// The pose's name.
        pose: String,
    },
    /// A line crosses itself.
    #[error("landmark {landmark} crosses itself in pose '{pose}'; draw it without a loop")]
    LandmarkCrossesItself {
        /// Which.
        landmark: LandmarkLabel,
        /// The pose's name.
        pose: String,
    },
    /// A line leads from a place of the outline back to the same place.
    #[error(
        "landmark {landmark} begins and ends at the same place of the outline of pose '{pose}'; let its ends lie apart, or one of them inside"
    )]
    LandmarkClosed {
        /// Which.
        landmark: LandmarkLabel,
        /// The name of a pose in which it is drawn.
        pose: String,
    },
    /// Something lies on different sides of a line.
    #[error(
        "pose '{pose}' has a hole or landmark on the other side of landmark {landmark} than pose '{other}'; let the same things lie on each side, or end the line inside"
    )]
    LandmarkSides {
        /// The line.
        landmark: LandmarkLabel,
        /// A pose's name.
        pose: String,
        /// The other pose's name.
        other: String,
    },
    /// Landmarks contradict one another.
    #[error(
        "landmark '{landmark}' makes the order impossible: going around pose '{pose}' the landmarks come in another order \
         than around pose '{other}'; correct its place on one of them, or set `mirror = true` if one faces the other way"
    )]
    LandmarkOrder {
        /// The landmark's name.
        landmark: String,
        /// A pose's name.
        pose: String,
        /// The other pose's name.
        other: String,
    },
    /// Two landmarks lie at one place.
    #[error("landmarks '{first}' and '{second}' lie at the same place of pose '{pose}'; move one or remove it")]
    LandmarksCoincide {
        /// A landmark's name.
        first: String,
        /// The other's.
        second: String,
        /// The pose's name.
        pose: String,
    },
    /// A landmark is asked for that does not exist, or is a line.
    #[error("there is no landmark point '{name}'; the scene has {known}")]
    UnknownLandmark {
        /// The name asked for.
        name: String,
        /// Those there are.
        known: String,
    },
    /// A landmark without a place.
    #[error("landmark '{landmark}' (line {line}) lies on no pose; give it a place on at least one")]
    LandmarkNowhere {
        /// Its name.
        landmark: String,
        /// The line of the scene file.
        line: usize,
    },
    /// A copy cannot be deformed.
    #[error("pose '{pose}' (line {line}), a deformed copy of '{of}': {message}")]
    Deformation {
        /// The copy's name.
        pose: String,
        /// The name of the pose that is deformed.
        of: String,
        /// The line of the scene file with the handles.
        line: usize,
        /// What is wrong and what to do.
        message: String,
    },
    /// A stage refused; the message says why.
    #[error("{}{message}", pose.as_ref().map(|p| format!("pose '{p}': ")).unwrap_or_default())]
    Stage {
        /// The pose's name, where one is to blame.
        pose: Option<String>,
        /// What is wrong.
        message: String,
    },
    /// The weights cannot be computed.
    #[error("pose space: {0}")]
    Weights(WeightError),
    /// The weights given do not sum to 1, or are too many or too few.
    #[error("{0}")]
    BadWeights(String),
    /// The shapes cannot be blended.
    #[error("blend: {0}")]
    Blend(#[from] BlendError),
    /// The textures cannot be weighted.
    #[error("texture: {0}")]
    Texture(#[from] TextureError),
}

impl From<SceneError> for PipelineError {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}

impl PipelineError {
    /// A stage's refusal about the pose of an index.
    pub(super) fn stage(names: &[String], pose: Option<usize>, message: impl std::fmt::Display) -> Self {
        Self::Stage {
            pose: pose.and_then(|k| names.get(k)).cloned(),
            message: message.to_string(),
        }
    }
}
