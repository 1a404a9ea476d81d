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

mod arrangement;
mod biharmonic;
mod bounded;
mod clough_tocher;
mod elements;
mod hessian;
mod jacobian_differences;
mod layout;
mod objective;
mod plate;
mod rbf;
mod space;
mod surface;
mod tessellation;
#[cfg(test)]
mod tests;
mod walls;

pub use arrangement::{arrange, place_among};
pub use biharmonic::{BiharmonicOptions, BiharmonicWeights, Edit, Energy, Range};
pub use bounded::BoundedReport;
pub use objective::{Objective, Region, Target};
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

    /// The same as a list of their own.
    ///
    /// # Errors
    /// As [`Self::weights`].
    fn weights_at(&self, at: &[f64]) -> Result<Vec<f64>, WeightError> {
        let mut weights = Vec::new();
        self.weights(at, &mut weights)?;
        Ok(weights)
    }

    /// The weights at many places: #points x #dimensions coordinates in, #points x #poses weights out, the same as one by
    /// one; `weights` is overwritten.
    ///
    /// # Errors
    /// As [`Self::weights`]; [`WeightError::WrongDimension`] also if the last place is not whole.
    fn weights_of_many(&self, places: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_places(places, self.dimension())?;
        weights.clear();
        let mut here = Vec::with_capacity(self.pose_count());
        for place in places.chunks_exact(self.dimension().max(1)) {
            self.weights(place, &mut here)?;
            weights.extend_from_slice(&here);
        }
        Ok(())
    }
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
    #[error("{}", coincident(&first.to_string(), &second.to_string()))]
    Coincident {
        /// A pose (pseudo-poses are counted after the poses).
        first: usize,
        /// Another.
        second: usize,
    },
    /// A pose is meant that does not exist.
    #[error("pose {pose} does not exist: there are {count}, counted from 0")]
    NoSuchPose {
        /// The index given.
        pose: usize,
        /// How many there are.
        count: usize,
    },
    /// A wall cannot be built.
    #[error("wall {wall} {problem}")]
    Wall {
        /// Which, from 0 in the order given.
        wall: usize,
        /// What is wrong with it.
        problem: WallProblem,
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
    /// The poses are arranged so that the fit would be mostly rounding.
    #[error("{}", nearly_singular(&in_words(poses), *condition))]
    NearlySingular {
        /// The poses to blame (pseudo-poses are counted after the poses).
        poses: Vec<usize>,
        /// By how much rounding would be magnified.
        condition: f64,
    },
    /// The linear system cannot be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl WeightError {
    /// The message with poses called as the caller calls them; indices from #poses on mean pseudo-poses.
    #[must_use]
    pub fn naming(&self, name: impl Fn(usize) -> String) -> String {
        let list = |poses: &[usize]| poses.iter().map(|&pose| name(pose)).collect::<Vec<_>>().join(", ");
        match self {
            Self::Coincident { first, second } => coincident(&name(*first), &name(*second)),
            Self::NearlySingular { poses, condition } => nearly_singular(&list(poses), *condition),
            Self::Wall {
                wall,
                problem: WallProblem::TouchesPose { pose },
            } => format!("wall {wall} {}", touches(&name(*pose))),
            other => other.to_string(),
        }
    }
}

fn coincident(first: &str, second: &str) -> String {
    format!("poses {first} and {second} lie at the same place of the pose space; move one of them")
}

fn nearly_singular(poses: &str, condition: f64) -> String {
    format!(
        "the system for the weights is nearly singular (condition {condition:.1e}) because of poses {poses}; move one of \
         them, or take one out"
    )
}

fn touches(pose: &str) -> String {
    format!("touches pose {pose}, which can only lie on one side of it; move the wall or the pose")
}

/// What is wrong with a wall, and the remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WallProblem {
    /// It has no length.
    #[error("has no length; give it two different points")]
    Degenerate,
    /// It goes through a pose.
    #[error("{}", touches(&pose.to_string()))]
    TouchesPose {
        /// The pose.
        pose: usize,
    },
    /// It crosses itself or others too often, or too closely, for a mesh.
    #[error("crosses itself or others too often or too closely; draw the walls simpler")]
    Tangled,
}

fn in_words(poses: &[usize]) -> String {
    let words: Vec<String> = poses.iter().map(usize::to_string).collect();
    words.join(", ")
}

/// Refuses places of which a provider cannot be asked all.
fn check_places(places: &[f64], dimension: usize) -> Result<(), WeightError> {
    let left_over = places.len() % dimension.max(1);
    if left_over != 0 {
        return Err(WeightError::WrongDimension {
            expected: dimension,
            found: left_over,
        });
    }
    places
        .chunks_exact(dimension.max(1))
        .try_for_each(|place| check_place(place, dimension))
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

/// Refuses a pose that is not there.
fn check_pose(pose: usize, count: usize) -> Result<(), WeightError> {
    if pose < count {
        Ok(())
    } else {
        Err(WeightError::NoSuchPose { pose, count })
    }
}
