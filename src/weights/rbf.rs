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
//! when poses are moved, inserted and removed, in ten microseconds for a dozen; other pseudo-poses leave the fit without them as it is. Many places at once are evaluated in lanes,
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
#[non_exhaustive]
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
    /// Without pseudo-poses.
    plain: Fitted,
    /// With them.
    bent: Option<Fitted>,
}

impl RbfWeights {
    /// Fits weights for poses at `places` (#poses x #dimensions).
    ///
    /// # Errors
    /// [`WeightError`] if there is no pose, two examples coincide, a coordinate is not finite, dimensions differ, or
    /// the system is singular or nearly so.
    pub fn new(places: &[Vec<f64>], options: &RbfOptions) -> Result<Self, WeightError> {
        let plain = plainly_fitted(places, options.radial)?;
        Ok(Self {
            bent: bent(&plain, places, options.radial, &options.pseudo_poses)?,
            plain,
            places: places.to_vec(),
            options: options.clone(),
        })
    }

    /// Moves a pose. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`], and [`WeightError::NoSuchPose`].
    pub fn move_pose(&mut self, pose: usize, place: &[f64]) -> Result<(), WeightError> {
        check_pose(pose, self.places.len())?;
        let before = std::mem::replace(&mut self.places[pose], place.to_vec());
        self.fit_again().inspect_err(|_| self.places[pose].clone_from(&before))
    }

    /// Adds a pose after the last one. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn insert_pose(&mut self, place: &[f64]) -> Result<(), WeightError> {
        self.places.push(place.to_vec());
        self.fit_again().inspect_err(|_| drop(self.places.pop()))
    }

    /// Removes a pose; later ones move up by one. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`], and [`WeightError::NoSuchPose`].
    pub fn remove_pose(&mut self, pose: usize) -> Result<(), WeightError> {
        check_pose(pose, self.places.len())?;
        let before = self.places.remove(pose);
        self.fit_again()
            .inspect_err(|_| self.places.insert(pose, before.clone()))
    }

    /// Replaces the pseudo-poses. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn set_pseudo_poses(&mut self, pseudo_poses: Vec<PseudoPose>) -> Result<(), WeightError> {
        self.bent = bent(&self.plain, &self.places, self.options.radial, &pseudo_poses)?;
        self.options.pseudo_poses = pseudo_poses;
        Ok(())
    }

    /// The poses' places, #poses x #dimensions.
    #[must_use]
    pub fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    /// The pseudo-poses.
    #[must_use]
    pub fn pseudo_poses(&self) -> &[PseudoPose] {
        &self.options.pseudo_poses
    }

    /// By how much the fit may magnify rounding errors: the condition number of its system, in the 1-norm.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.fitted().condition()
    }

    fn fitted(&self) -> &Fitted {
        self.bent.as_ref().unwrap_or(&self.plain)
    }

    fn fit_again(&mut self) -> Result<(), WeightError> {
        let plain = plainly_fitted(&self.places, self.options.radial)?;
        self.bent = bent(&plain, &self.places, self.options.radial, &self.options.pseudo_poses)?;
        self.plain = plain;
        Ok(())
    }
}

fn plainly_fitted(places: &[Vec<f64>], radial: Radial) -> Result<Fitted, WeightError> {
    let poses = Layout::new(places)?;
    let own = DenseMatrix::from_fn(poses.len(), poses.len(), |row, column| {
        f64::from(u8::from(row == column))
    });
    Fitted::new(&poses, &own, radial)
}

/// The fit with pseudo-poses, if there are any.
fn bent(
    plain: &Fitted,
    places: &[Vec<f64>],
    radial: Radial,
    pseudo_poses: &[PseudoPose],
) -> Result<Option<Fitted>, WeightError> {
    if pseudo_poses.is_empty() {
        return Ok(None);
    }
    let pose_count = places.len();
    let mut examples = places.to_vec();
    let mut wanted = DenseMatrix::from_fn(pose_count + pseudo_poses.len(), pose_count, |row, column| {
        f64::from(u8::from(row == column))
    });
    for (row, pseudo) in (pose_count..).zip(pseudo_poses) {
        check_place(&pseudo.at, plain.dimension())?;
        check_place(&pseudo.from, plain.dimension())?;
        let weights = wanted.row_mut(row).as_chunks_mut::<1>().0;
        plain.weights(pseudo.from.as_chunks::<1>().0, weights);
        examples.push(pseudo.at.clone());
    }
    Fitted::new(&Layout::new(&examples)?, &wanted, radial).map(Some)
}

impl WeightProvider for RbfWeights {
    fn pose_count(&self) -> usize {
        self.places.len()
    }

    fn dimension(&self) -> usize {
        self.plain.dimension()
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_place(at, self.dimension())?;
        weights.clear();
        weights.resize(self.pose_count(), 0.0);
        self.fitted()
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
            vectorised(|| self.fitted().weights(&coordinates, &mut found));
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
