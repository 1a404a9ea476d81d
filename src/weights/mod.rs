//! Weights over the pose space: a point of the space in, one weight a pose out.
//!
//! Sources: Baxter, Barla, Anjyo, "N-way morphing for 2D animation", section 4.1; Sloan, Rose, Cohen, "Shape by
//! Example", sections 3 and 4. This stage knows places in the pose space, never a drawing.
//!
//! Every provider is cardinal (weight 1 at a pose's own place and 0 at the others) and its weights sum to 1
//! everywhere, both to rounding.
//! - [`BiharmonicWeights`] (the default): the smoothest functions on a plane that reaches past the poses. Works for
//!   any layout, collinear and two-pose ones included, and levels out far away.
//! - [`RbfWeights`]: radial basis functions with a linear part, in any dimension; extrapolates linearly.

mod biharmonic;
mod clough_tocher;
mod hessian;
mod jacobian_differences;
mod layout;
mod rbf;
mod surface;
mod tessellation;
#[cfg(test)]
mod tests;

pub use biharmonic::{BiharmonicOptions, BiharmonicWeights, Energy};
pub use rbf::{PseudoPose, Radial, RbfOptions, RbfWeights};

use crate::solve::SolveError;

/// Gives weights at places of a pose space. Built once, asked often, from any thread.
pub trait WeightProvider: std::fmt::Debug + Send + Sync {
    /// How many weights there are.
    fn pose_count(&self) -> usize;

    /// How many coordinates a place has.
    fn dimension(&self) -> usize;

    /// The weights at the place `at` (#dimensions); `weights` (#poses) is overwritten. They sum to 1.
    ///
    /// # Errors
    /// [`WeightError::WrongDimension`] or [`WeightError::NotFinite`].
    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError>;
}

/// Why there are no weights.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeightError {
    /// There is no pose.
    #[error("a pose space needs at least one pose")]
    NoPose,
    /// A place has the wrong number of coordinates.
    #[error("{found} coordinates where the pose space has {expected}")]
    WrongDimension {
        /// Of the space.
        expected: usize,
        /// Given.
        found: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("a coordinate of the place {at:?} in the pose space is not finite")]
    NotFinite {
        /// The place.
        at: Vec<f64>,
    },
    /// Two poses share one place.
    #[error("poses {first} and {second} lie at the same place of the pose space; move one of them")]
    Coincident {
        /// A pose (pseudo-poses are counted after the poses).
        first: usize,
        /// Another.
        second: usize,
    },
    /// An option has a value that makes no sense.
    #[error("{option} is {value}, but must be {must_be}")]
    BadOption {
        /// Which one.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        must_be: &'static str,
    },
    /// The linear system cannot be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// Refuses a place that a provider cannot be asked about.
fn check_place(at: &[f64], dimension: usize) -> Result<(), WeightError> {
    if at.len() != dimension {
        return Err(WeightError::WrongDimension {
            expected: dimension,
            found: at.len(),
        });
    }
    if at.iter().all(|coordinate| coordinate.is_finite()) {
        Ok(())
    } else {
        Err(WeightError::NotFinite { at: at.to_vec() })
    }
}
