//! Cardinal radial basis functions with a linear part, in any dimension.
//!
//! Source: "Shape by Example", section 3, equations 2 to 4, and section 4, equations 5 and 6.
//!
//! B-spline:
//! 1. Fit a hyperplane to each weight's data by least squares.
//! 2. Every example gets a radial function, a cubic B-spline of its distance that reaches twice as far as its nearest
//!    neighbour. Their coefficients solve `Q r = q`, `q` being what the hyperplane leaves over.
//!
//! Thin plate (`r^2 log r`): a hyperplane first and `Q r = q` after it is singular for common layouts, so both are
//! found together from the saddle system with the side conditions that the radial part contains no linear function.
//!
//! Pseudo-poses: each takes the weights found at one place of the space and asks for them at another. All refer to
//! the weights without any pseudo-pose; then everything is fitted again with them as further examples.
//!
//! Differences from the paper:
//! - Places are centred before the fit and the intercept is free. A plain minimum-norm solution for collinear poses
//!   makes the intercept small too, and then the weights do not sum to 1.
//! - One pose alone has weight 1 everywhere.
//!
//! Layouts whose system is nearly singular are refused with the poses that make it so, instead of weights that are mostly
//! rounding.
//!
//! Cost: O((poses + pseudo-poses)^3) to build, O(poses + pseudo-poses) a weight to ask: the small system is solved again
//! when poses are moved, inserted and removed, in microseconds for a dozen. Many places at once are evaluated in lanes,
//! with the same results to the last bit.

mod fit;

use super::layout::Layout;
use super::{WeightError, WeightProvider, check_place, check_places, check_pose};
use crate::math::vectorised;
use crate::solve::DenseMatrix;
use fit::Fitted;

/// Points that are evaluated together: two or four vector registers of every kind of processor.
const LANES: usize = 8;

/// The radial function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Radial {
    /// Cubic B-spline: local, the paper's choice.
    #[default]
    BSpline,
    /// `r^2 log r`: bends least.
    ThinPlate,
}

/// The blend found at `from` is wanted at `at`.
#[derive(Debug, Clone, PartialEq)]
pub struct PseudoPose {
    /// Where the blend is now.
    pub from: Vec<f64>,
    /// Where it is wanted.
    pub at: Vec<f64>,
}

/// What [`RbfWeights`] can be told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RbfOptions {
    /// Default: [`Radial::BSpline`].
    pub radial: Radial,
    /// Default: none.
    pub pseudo_poses: Vec<PseudoPose>,
}

/// Radial basis weights.
///
/// ```
/// use inbetween::weights::{RbfOptions, RbfWeights, WeightProvider};
///
/// # fn main() -> Result<(), inbetween::weights::WeightError> {
/// let provider = RbfWeights::new(&[vec![0.0], vec![1.0]], &RbfOptions::default())?;
/// let mut weights = Vec::new();
/// provider.weights(&[0.25], &mut weights)?;
/// assert!((weights[0] - 0.75).abs() < 1e-12 && (weights[1] - 0.25).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct RbfWeights {
    places: Vec<Vec<f64>>,
    options: RbfOptions,
    fitted: Fitted,
}

impl RbfWeights {
    /// Fits weights for poses at `places` (#poses x #dimensions).
    ///
    /// # Errors
    /// [`WeightError`] if there is no pose, two examples coincide, a coordinate is not finite, dimensions differ, or
    /// the system is singular or nearly so.
    pub fn new(places: &[Vec<f64>], options: &RbfOptions) -> Result<Self, WeightError> {
        Ok(Self {
            places: places.to_vec(),
            options: options.clone(),
            fitted: fitted(places, options)?,
        })
    }

    /// Moves a pose. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`], and [`WeightError::NoSuchPose`].
    pub fn move_pose(&mut self, pose: usize, place: &[f64]) -> Result<(), WeightError> {
        check_pose(pose, self.places.len())?;
        self.edit(|places| places[pose] = place.to_vec())
    }

    /// Adds a pose after the last one. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn insert_pose(&mut self, place: &[f64]) -> Result<(), WeightError> {
        self.edit(|places| places.push(place.to_vec()))
    }

    /// Removes a pose; later ones move up by one. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`], and [`WeightError::NoSuchPose`].
    pub fn remove_pose(&mut self, pose: usize) -> Result<(), WeightError> {
        check_pose(pose, self.places.len())?;
        self.edit(|places| drop(places.remove(pose)))
    }

    /// Replaces the pseudo-poses. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn set_pseudo_poses(&mut self, pseudo_poses: Vec<PseudoPose>) -> Result<(), WeightError> {
        let options = RbfOptions {
            pseudo_poses,
            ..self.options.clone()
        };
        *self = Self::new(&self.places, &options)?;
        Ok(())
    }

    /// The poses' places, #poses x #dimensions.
    #[must_use]
    pub fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    /// By how much the fit may magnify rounding errors: the condition number of its system, in the 1-norm.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.fitted.condition()
    }

    fn edit(&mut self, change: impl FnOnce(&mut Vec<Vec<f64>>)) -> Result<(), WeightError> {
        let mut places = self.places.clone();
        change(&mut places);
        self.fitted = fitted(&places, &self.options)?;
        self.places = places;
        Ok(())
    }
}

fn fitted(places: &[Vec<f64>], options: &RbfOptions) -> Result<Fitted, WeightError> {
    let poses = Layout::new(places)?;
    let (pose_count, dimension) = (poses.len(), poses.dimension());
    let own = DenseMatrix::from_fn(pose_count, pose_count, |row, column| f64::from(u8::from(row == column)));
    let plain = Fitted::new(&poses, &own, options.radial)?;
    if options.pseudo_poses.is_empty() {
        return Ok(plain);
    }
    let mut examples = places.to_vec();
    let mut wanted = Vec::with_capacity(options.pseudo_poses.len());
    for pseudo in &options.pseudo_poses {
        check_place(&pseudo.at, dimension)?;
        check_place(&pseudo.from, dimension)?;
        let mut weights = vec![0.0; pose_count];
        plain.weights(pseudo.from.as_chunks::<1>().0, weights.as_chunks_mut::<1>().0);
        wanted.push(weights);
        examples.push(pseudo.at.clone());
    }
    let data = DenseMatrix::from_fn(examples.len(), pose_count, |row, column| {
        match row.checked_sub(pose_count) {
            Some(pseudo) => wanted[pseudo][column],
            None => f64::from(u8::from(row == column)),
        }
    });
    Fitted::new(&Layout::new(&examples)?, &data, options.radial)
}

impl WeightProvider for RbfWeights {
    fn pose_count(&self) -> usize {
        self.places.len()
    }

    fn dimension(&self) -> usize {
        self.fitted.dimension()
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_place(at, self.dimension())?;
        weights.clear();
        weights.resize(self.pose_count(), 0.0);
        self.fitted
            .weights(at.as_chunks::<1>().0, weights.as_chunks_mut::<1>().0);
        if weights.iter().all(|weight| weight.is_finite()) {
            Ok(())
        } else {
            Err(WeightError::NotFinite { at: at.to_vec() })
        }
    }

    fn weights_of_many(&self, places: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_places(places, self.dimension())?;
        // A space without dimensions has no places to list.
        let (dimension, pose_count) = (self.dimension().max(1), self.pose_count());
        weights.clear();
        weights.resize(places.len() / dimension * pose_count, 0.0);
        let mut coordinates = vec![[0.0; LANES]; dimension];
        let mut found = vec![[0.0; LANES]; pose_count];
        let blocks = places.chunks(LANES * dimension);
        for (block, out) in blocks.zip(weights.chunks_mut(LANES * pose_count)) {
            for (lane, place) in block.chunks_exact(dimension).enumerate() {
                for (along, coordinate) in coordinates.iter_mut().zip(place) {
                    along[lane] = *coordinate;
                }
            }
            vectorised(|| self.fitted.weights(&coordinates, &mut found));
            for (lane, row) in out.chunks_exact_mut(pose_count).enumerate() {
                for (weight, found) in row.iter_mut().zip(&found) {
                    *weight = found[lane];
                }
            }
        }
        match weights.iter().position(|weight| !weight.is_finite()) {
            None => Ok(()),
            Some(bad) => {
                let point = bad / pose_count;
                let at = places[point * dimension..(point + 1) * dimension].to_vec();
                Err(WeightError::NotFinite { at })
            }
        }
    }
}
