//! Why a scene of a shape gives no forms.

use crate::render::PictureError;
use crate::scene::SceneError;
use crate::shape3d::{RigError, ShapeError, SubdivisionError};
use crate::weights::WeightError;

/// Why there is no form. Messages name the file or example that they are about.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeModelError {
    /// The scene file or one of the files that it names is wrong.
    #[error(transparent)]
    Scene(Box<SceneError>),
    /// The examples' places allow no weights.
    #[error("{what}: {reason}")]
    Space {
        /// Which space.
        what: &'static str,
        /// What is wrong with it, and what to do.
        reason: String,
    },
    /// The skeleton cannot be used.
    #[error("skeleton: {0}")]
    Rig(#[from] RigError),
    /// Forms cannot be subdivided.
    #[error("subdivision: {0}")]
    Subdivision(#[from] SubdivisionError),
    /// There is no form at a place.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// There are no weights at a place.
    #[error(transparent)]
    Weights(#[from] WeightError),
    /// No picture can be drawn.
    #[error("no contact sheet: {0}")]
    Sheet(#[source] PictureError),
}

impl From<SceneError> for ShapeModelError {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}
