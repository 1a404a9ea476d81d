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
//! Cost: O((poses + pseudo-poses)^3) to build, linear to ask: poses can be dragged, inserted and removed by building
//! again within a frame.

use super::layout::{Layout, distance};
use super::{WeightError, WeightProvider, check_place};
use crate::solve::{DenseMatrix, SolvedDense};

/// Singular values of the layout below this fraction of the largest are no direction: the poses are collinear.
const FLATNESS: f64 = 1e-10;

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
    pose_count: usize,
    radial: Radial,
    /// Poses, then pseudo-poses.
    layout: Layout,
    /// What distances are divided by, for each example.
    radii: Vec<f64>,
    /// #examples x #poses coefficients of the radial functions (`r` in SBE 3).
    coefficients: DenseMatrix,
    mean: Vec<f64>,
    /// #dimensions x #poses slopes about the mean (`a` in SBE 3), and the #poses weights at the mean.
    slopes: DenseMatrix,
    at_mean: Vec<f64>,
}

impl RbfWeights {
    /// Fits weights for poses at `places` (#poses x #dimensions).
    ///
    /// # Errors
    /// [`WeightError`] if there is no pose, two examples coincide, a coordinate is not finite, dimensions differ, or
    /// the system is singular.
    pub fn new(places: &[Vec<f64>], options: &RbfOptions) -> Result<Self, WeightError> {
        let poses = Layout::new(places)?;
        let pose_count = poses.len();
        let dimension = poses.dimension();
        let own = DenseMatrix::from_fn(pose_count, pose_count, |row, column| f64::from(u8::from(row == column)));
        let plain = Self::fit(poses, own, options.radial)?;
        if options.pseudo_poses.is_empty() {
            return Ok(plain);
        }
        let mut examples = places.to_vec();
        let mut wanted = Vec::with_capacity(options.pseudo_poses.len());
        for pseudo in &options.pseudo_poses {
            check_place(&pseudo.at, dimension)?;
            let mut weights = Vec::new();
            plain.weights(&pseudo.from, &mut weights)?;
            wanted.push(weights);
            examples.push(pseudo.at.clone());
        }
        let data = DenseMatrix::from_fn(examples.len(), pose_count, |row, column| {
            match row.checked_sub(pose_count) {
                Some(pseudo) => wanted[pseudo][column],
                None => f64::from(u8::from(row == column)),
            }
        });
        Self::fit(Layout::new(&examples)?, data, options.radial)
    }

    /// Interpolates `data` (#examples x #poses) at the examples.
    fn fit(layout: Layout, data: DenseMatrix, radial: Radial) -> Result<Self, WeightError> {
        let (count, dimension) = (layout.len(), layout.dimension());
        let places = layout.places();
        let mean: Vec<f64> = (0..dimension)
            .map(|k| places.iter().map(|place| place[k]).sum::<f64>() / count as f64)
            .collect();
        let centred = DenseMatrix::from_fn(count, dimension, |row, column| places[row][column] - mean[column]);
        let radii = match radial {
            Radial::BSpline => layout.nearest_neighbours(),
            // One common unit: it changes nothing but the rounding.
            Radial::ThinPlate if count > 1 => vec![layout.diagonal(); count],
            Radial::ThinPlate => vec![1.0; count],
        };
        let kernel = |a: usize, b: usize| radial.at(distance(&places[a], &places[b]) / radii[b]);
        let (coefficients, slopes, at_mean) = match radial {
            Radial::BSpline => {
                let data_mean: Vec<f64> = (0..data.column_count())
                    .map(|column| (0..count).map(|row| data.at(row, column)).sum::<f64>() / count as f64)
                    .collect();
                let about_mean = DenseMatrix::from_fn(count, data.column_count(), |row, column| {
                    data.at(row, column) - data_mean[column]
                });
                let slopes = centred.least_squares(&about_mean, FLATNESS)?;
                let left_over = about_mean.plus(-1.0, &centred.times(&slopes)?)?;
                let system = DenseMatrix::from_fn(count, count, kernel);
                (SolvedDense::new(&system)?.solve(&left_over)?, slopes, data_mean)
            }
            Radial::ThinPlate => {
                // Only directions in which the poses extend can have a slope.
                let directions = centred.row_space(FLATNESS)?;
                let unit = radii[0];
                let along = centred.times(&directions)?;
                let side = directions.column_count() + 1;
                let linear = |row: usize, k: usize| if k == 0 { 1.0 } else { along.at(row, k - 1) / unit };
                let system = DenseMatrix::from_fn(count + side, count + side, |row, column| {
                    match (row.checked_sub(count), column.checked_sub(count)) {
                        (None, None) => kernel(row, column),
                        (None, Some(k)) => linear(row, k),
                        (Some(k), None) => linear(column, k),
                        (Some(_), Some(_)) => 0.0,
                    }
                });
                let right = DenseMatrix::from_fn(count + side, data.column_count(), |row, column| {
                    if row < count { data.at(row, column) } else { 0.0 }
                });
                let solution = SolvedDense::new(&system)?.solve(&right)?;
                let coefficients =
                    DenseMatrix::from_fn(count, data.column_count(), |row, column| solution.at(row, column));
                let in_directions = DenseMatrix::from_fn(side - 1, data.column_count(), |row, column| {
                    solution.at(count + 1 + row, column) / unit
                });
                let slopes = directions.times(&in_directions)?;
                let at_mean = (0..data.column_count())
                    .map(|column| solution.at(count, column))
                    .collect();
                (coefficients, slopes, at_mean)
            }
        };
        Ok(Self {
            pose_count: data.column_count(),
            radial,
            layout,
            radii,
            coefficients,
            mean,
            slopes,
            at_mean,
        })
    }
}

impl WeightProvider for RbfWeights {
    fn pose_count(&self) -> usize {
        self.pose_count
    }

    fn dimension(&self) -> usize {
        self.layout.dimension()
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_place(at, self.dimension())?;
        weights.clear();
        weights.extend_from_slice(&self.at_mean);
        for (k, (coordinate, mean)) in at.iter().zip(&self.mean).enumerate() {
            for (pose, weight) in weights.iter_mut().enumerate() {
                *weight += (coordinate - mean) * self.slopes.at(k, pose);
            }
        }
        for (example, (place, radius)) in self.layout.places().iter().zip(&self.radii).enumerate() {
            let value = self.radial.at(distance(at, place) / radius);
            if value != 0.0 {
                for (pose, weight) in weights.iter_mut().enumerate() {
                    *weight += value * self.coefficients.at(example, pose);
                }
            }
        }
        if weights.iter().all(|weight| weight.is_finite()) {
            Ok(())
        } else {
            Err(WeightError::NotFinite { at: at.to_vec() })
        }
    }
}

impl Radial {
    /// The radial function at `t`, the distance over the radius.
    fn at(self, t: f64) -> f64 {
        match self {
            Self::BSpline if t < 1.0 => 2.0 / 3.0 - t * t + 0.5 * t * t * t,
            Self::BSpline if t < 2.0 => (2.0 - t).powi(3) / 6.0,
            Self::BSpline => 0.0,
            Self::ThinPlate if t > 0.0 => t * t * t.ln(),
            Self::ThinPlate => 0.0,
        }
    }
}
