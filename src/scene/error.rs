//! What can be wrong with a scene file.

use std::path::PathBuf;

use super::shape::ShapeProblem;
use crate::animation::AnimationError;

/// A problem of a scene file and its place.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{}: {problem}", file.display(), line.map(|l| format!(":{l}")).unwrap_or_default())]
pub struct SceneError {
    /// The scene file.
    pub file: PathBuf,
    /// The line the problem stands on, from 1, where it stands on one.
    pub line: Option<usize>,
    /// What is wrong and what to do.
    pub problem: SceneProblem,
}

/// What is wrong with a scene file, and the remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneProblem {
    /// The file cannot be read.
    #[error("cannot read the scene: {reason}; give the path of a scene.toml (`inbetween new` writes one)")]
    Unreadable {
        /// The system's reason.
        reason: String,
    },
    /// It is no TOML, or a key is unknown or has the wrong type.
    #[error("{0}")]
    Format(String),
    /// Another version of the format.
    #[error("version {found} of the scene format is unknown; this release reads `version = 1`")]
    Version {
        /// What the file says.
        found: i64,
    },
    /// Something that this release does not do.
    #[error("{what} is not supported yet; {remedy}")]
    NotSupported {
        /// Which key or value.
        what: String,
        /// What to do instead.
        remedy: String,
    },
    /// There is no pose.
    #[error("the scene has no pose; add at least one [[pose]] with a name and a source")]
    NoPose,
    /// A name is empty or taken.
    #[error("{kind} name '{name}' is {}; give every {kind} a name of its own", if name.is_empty() { "empty" } else { "used twice" })]
    BadName {
        /// `pose` or `landmark`.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A pose is named that does not exist.
    #[error("{used_by} names pose '{name}', but the poses are {known}; correct the name or remove it")]
    UnknownPose {
        /// The name.
        name: String,
        /// Which key names it.
        used_by: String,
        /// The names there are.
        known: String,
    },
    /// A landmark is named that does not exist.
    #[error("{used_by} names landmark '{name}', which no [[landmark]] has; correct the name or add the landmark")]
    UnknownLandmark {
        /// The name.
        name: String,
        /// Which key names it.
        used_by: String,
    },
    /// A number is not finite or out of its range.
    #[error("{key} is {value}, but must be {allowed}")]
    BadNumber {
        /// Which key, with its pose where it has one.
        key: String,
        /// The value.
        value: f64,
        /// The range in words.
        allowed: &'static str,
    },
    /// A word that is none of the choices.
    #[error("{key} is '{value}', but must be {allowed}")]
    BadChoice {
        /// Which key.
        key: String,
        /// The value.
        value: String,
        /// The choices in words.
        allowed: &'static str,
    },
    /// Some poses have a place and some have none.
    #[error(
        "pose '{without}' has no `at`, but pose '{with}' has one; place all poses or none (none: they are laid out automatically)"
    )]
    HalfPlaced {
        /// A pose with a place.
        with: String,
        /// A pose without.
        without: String,
    },
    /// Places of different dimensions.
    #[error("{key} has {found} coordinates, the others have {expected}; give every place the same number")]
    Dimension {
        /// Which key, with its pose where it has one.
        key: String,
        /// Its coordinates.
        found: usize,
        /// The others' coordinates.
        expected: usize,
    },
    /// Two poses at one place.
    #[error(
        "poses '{first}' and '{second}' are both at {place}; move one of them, since the blend there could only be one of the two"
    )]
    SamePlace {
        /// A pose.
        first: String,
        /// The other.
        second: String,
        /// Where.
        place: String,
    },
    /// A source leaves the scene's folder.
    #[error(
        "pose '{pose}': source '{path}' {reason}; copy the drawing beside the scene file and name it relative to that"
    )]
    SourceOutside {
        /// The pose.
        pose: String,
        /// The source as written.
        path: String,
        /// In which way it leaves.
        reason: &'static str,
    },
    /// A source that is not there.
    #[error("pose '{pose}': cannot open the drawing '{path}': {reason}; correct `source` or put the file there")]
    SourceMissing {
        /// The pose.
        pose: String,
        /// The source as written.
        path: String,
        /// The system's reason.
        reason: String,
    },
    /// Keys whose times do not increase.
    #[error("animation key {index} is at time {time}, not after its predecessor at {before}; sort the keys by time")]
    KeyOrder {
        /// Which key, from 0.
        index: usize,
        /// Its time.
        time: f64,
        /// The time before.
        before: f64,
    },
    /// A key of the animation that is none.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// Something that only scenes of shapes in space have.
    #[error(transparent)]
    Shape(#[from] ShapeProblem),
}
