//! What is wrong, in the artist's words, and where in the page that belongs.

use inbetween::pipeline::PipelineError;
use inbetween::scene::{SceneError, SceneProblem};
use serde::Serialize;

use super::http::Response;

/// Part of the page that a problem belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Where {
    File,
    Pose,
    Landmark,
    Layer,
    Space,
    Mapping,
    Animation,
}

/// A problem and its place.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub(crate) struct Problem {
    pub(crate) message: String,
    #[serde(rename = "where")]
    pub(crate) place: Option<Where>,
    pub(crate) pose: Option<String>,
    pub(crate) landmark: Option<String>,
    pub(crate) layer: Option<String>,
    pub(crate) line: Option<usize>,
}

impl Problem {
    pub(crate) fn new(message: impl std::fmt::Display) -> Self {
        Self {
            message: message.to_string(),
            ..Self::default()
        }
    }

    pub(crate) fn at(message: impl std::fmt::Display, place: Where) -> Self {
        Self {
            place: Some(place),
            ..Self::new(message)
        }
    }
}

impl From<&SceneError> for Problem {
    fn from(error: &SceneError) -> Self {
        let mut problem = Self {
            line: error.line,
            ..Self::at(&error.problem, Where::File)
        };
        match &error.problem {
            SceneProblem::SourceMissing { pose, .. } | SceneProblem::SourceOutside { pose, .. } => {
                (problem.place, problem.pose) = (Some(Where::Pose), Some(pose.clone()));
            }
            SceneProblem::KeyOrder { .. } => problem.place = Some(Where::Animation),
            SceneProblem::SamePlace { .. } | SceneProblem::HalfPlaced { .. } => problem.place = Some(Where::Space),
            _ => {}
        }
        problem
    }
}

impl From<&PipelineError> for Problem {
    fn from(error: &PipelineError) -> Self {
        use PipelineError as E;
        let of_landmark = |name: &String, pose: Option<&String>, line: Option<usize>| Self {
            landmark: Some(name.clone()),
            pose: pose.cloned(),
            line,
            ..Self::at(error, Where::Landmark)
        };
        let of_pose = |name: &String| Self {
            pose: Some(name.clone()),
            ..Self::at(error, Where::Pose)
        };
        match error {
            E::Scene(error) => Self::from(error.as_ref()),
            E::Layer { layer, source } => {
                let within = Self::from(source.as_ref());
                Self {
                    message: error.to_string(),
                    layer: Some(layer.clone()),
                    place: within.place.or(Some(Where::Layer)),
                    ..within
                }
            }
            E::Drawing { pose, .. } | E::HoleCount { pose, .. } => of_pose(pose),
            E::LandmarkOffOutline {
                landmark, pose, line, ..
            }
            | E::LandmarkMissing { landmark, pose, line } => of_landmark(landmark, Some(pose), Some(*line)),
            E::LandmarkNowhere { landmark, line } => of_landmark(landmark, None, Some(*line)),
            E::LandmarkOutside { landmark, pose }
            | E::LandmarkCrossesItself { landmark, pose }
            | E::LandmarkClosed { landmark, pose }
            | E::LandmarkSides { landmark, pose, .. } => of_landmark(&landmark.name, Some(pose), Some(landmark.line)),
            E::LandmarksMeet { second, pose, .. } => of_landmark(&second.name, Some(pose), Some(second.line)),
            E::LandmarkOrder { landmark, pose, .. } => of_landmark(landmark, Some(pose), None),
            E::LandmarksCoincide { second, pose, .. } => of_landmark(second, Some(pose), None),
            E::Deformation { pose, line, .. } => Self {
                line: Some(*line),
                ..of_pose(pose)
            },
            E::Stage { pose: Some(pose), .. } => of_pose(pose),
            E::Stage { pose: None, message } if message.starts_with("pose space") => Self::at(error, Where::Space),
            E::Weights(_) => Self::at(error, Where::Space),
            _ => Self::at(error, Where::Mapping),
        }
    }
}

/// A request that is not served.
#[derive(Debug, Clone)]
pub(crate) struct Refusal {
    status: u16,
    problem: Box<Problem>,
}

impl Refusal {
    /// The request makes no sense.
    pub(crate) fn bad(message: impl std::fmt::Display) -> Self {
        Self {
            status: 400,
            problem: Box::new(Problem::new(message)),
        }
    }

    /// The present state does not allow it.
    pub(crate) fn conflict(problem: impl Into<Problem>) -> Self {
        Self {
            status: 409,
            problem: Box::new(problem.into()),
        }
    }

    /// Something went wrong here.
    pub(crate) fn failed(message: impl std::fmt::Display) -> Self {
        Self {
            status: 500,
            problem: Box::new(Problem::new(message)),
        }
    }

    pub(crate) fn response(&self) -> Response {
        Response::json(&serde_json::json!({ "error": self.problem })).with_status(self.status)
    }
}

impl From<PipelineError> for Refusal {
    fn from(error: PipelineError) -> Self {
        Self::conflict(Problem::from(&error))
    }
}
