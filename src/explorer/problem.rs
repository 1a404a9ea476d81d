//! What is wrong, in the artist's words, and where in the page that belongs.

use inbetween::pipeline::PipelineError;
use inbetween::scene::{SceneBuildError, SceneError, SceneProblem};
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
            SceneProblem::KeyOrder { .. } | SceneProblem::Animation(_) => problem.place = Some(Where::Animation),
            SceneProblem::SamePlace { .. } | SceneProblem::HalfPlaced { .. } => problem.place = Some(Where::Space),
            _ => {}
        }
        problem
    }
}

impl From<&PipelineError> for Problem {
    fn from(error: &PipelineError) -> Self {
        use PipelineError as E;
        let within = error.within_layer();
        let place = match within {
            E::Space { .. } | E::NoCommonLayer | E::Weights(_) => Where::Space,
            E::Animation(_) => Where::Animation,
            _ if within.landmark().is_some() => Where::Landmark,
            _ if within.pose().is_some() => Where::Pose,
            _ if error.layer().is_some() => Where::Layer,
            _ => Where::Mapping,
        };
        Self {
            pose: error.pose().map(str::to_owned),
            landmark: error.landmark().map(str::to_owned),
            layer: error.layer().map(str::to_owned),
            ..Self::at(error, place)
        }
    }
}

impl From<&SceneBuildError> for Problem {
    fn from(error: &SceneBuildError) -> Self {
        match error {
            SceneBuildError::Scene(error) => Self::from(error),
            SceneBuildError::Drawing {
                line,
                layer,
                pose,
                drawing,
                source,
                ..
            } => Self {
                line: Some(*line),
                layer: layer.clone(),
                pose: Some(pose.clone()),
                ..Self::at(format!("pose '{pose}' ({}): {source}", drawing.display()), Where::Pose)
            },
            SceneBuildError::Pipeline { line, source, .. } => Self {
                line: *line,
                ..Self::from(source.as_ref())
            },
            SceneBuildError::NoPartInLayers { line, pose, .. } => Self {
                line: Some(*line),
                pose: Some(pose.clone()),
                ..Self::at(error, Where::Pose)
            },
            SceneBuildError::Provider { .. } => Self::at(error, Where::Space),
            other => Self::at(other, Where::File),
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

impl From<SceneBuildError> for Refusal {
    fn from(error: SceneBuildError) -> Self {
        Self::conflict(Problem::from(&error))
    }
}
