//! The rows of a correspondence, and what a pose is compared with on them.

use super::coarse::Form;
use super::curve::{Samples, Windows};
use super::thin_plate::ThinPlate;
use crate::math::Point;

/// Rows of a match; the elastic match uses every second, the splines every fourth.
const ROWS: usize = 512;
/// Rows between two control points of a spline.
pub(super) const CONTROL_STRIDE: usize = 4;
/// Stiffness of the splines, with lengths in perimeters; the first guides, the others refit.
pub(super) const STIFFNESSES: [f64; 5] = [1e-3, 1e-3, 3e-4, 1e-4, 1e-5];

/// The reference's rows, with everything about them that does not depend on the other poses.
#[derive(Debug)]
pub(super) struct Frame {
    /// The reference's parameter by row: increasing, not wrapped.
    pub(super) rows: Vec<f64>,
    /// Splines from the reference's points.
    pub(super) plate: ThinPlate,
}

impl Frame {
    /// Rows on `reference`, with one at each of `landmarks` (parameters in increasing order, distinct).
    pub(super) fn new(reference: &Form, landmarks: &[f64]) -> Self {
        let rows = if landmarks.is_empty() {
            reference.even_parameters(ROWS)
        } else {
            rows_through(landmarks)
        };
        let places: Vec<Point> = rows.iter().map(|t| reference.curve.at(*t)).collect();
        let controls: Vec<Point> = places.iter().copied().step_by(CONTROL_STRIDE).collect();
        let plate = ThinPlate::new(&controls, &places, &STIFFNESSES);
        Self { rows, plate }
    }

    /// The row of the landmark at parameter `t`, which was given to [`Self::new`].
    pub(super) fn row_of(&self, t: f64) -> Option<usize> {
        self.rows
            .iter()
            .step_by(CONTROL_STRIDE)
            .position(|row| *row == t)
            .map(|index| index * CONTROL_STRIDE)
    }
}

/// What a pose is compared with: one curve, or several whose rows correspond.
#[derive(Debug)]
pub(super) struct Model<'a> {
    /// By row, the mean of the curves' parameters: increasing, not wrapped.
    pub(super) rows: Vec<f64>,
    /// Curves with their parameters by row.
    pub(super) curves: Vec<(&'a Form, &'a [f64])>,
}

impl<'a> Model<'a> {
    /// The model of `curves`, each with its parameters by row. Their order does not matter.
    pub(super) fn new(mut curves: Vec<(&'a Form, &'a [f64])>) -> Self {
        // Sums are rounded: an order that comes from the shapes gives the same sums whatever order the poses have.
        curves.sort_by(|(_, a), (_, b)| unevenness(a).total_cmp(&unevenness(b)));
        let count = curves.first().map_or(0, |(_, parameters)| parameters.len());
        let mean = |row: usize| curves.iter().map(|(_, t)| t[row]).sum::<f64>() / curves.len() as f64;
        Self {
            rows: (0..count).map(mean).collect(),
            curves,
        }
    }

    /// Every `stride`-th row from `first` on, once around: their parameters, and each curve there.
    pub(super) fn samples(&self, first: usize, stride: usize, windows: Windows) -> (Vec<f64>, Vec<Samples>) {
        let around = |parameters: &[f64]| -> Vec<f64> {
            let count = parameters.len();
            (0..count)
                .step_by(stride)
                .map(|k| parameters[(first + k) % count] + ((first + k) / count) as f64)
                .collect()
        };
        let curves = self
            .curves
            .iter()
            .map(|(form, parameters)| Samples::new(&form.curve, around(parameters), windows))
            .collect();
        (around(&self.rows), curves)
    }
}

/// The sum of the squared steps of parameters around a curve.
fn unevenness(parameters: &[f64]) -> f64 {
    parameters.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum()
}

/// At least [`ROWS`] parameters with one at each landmark, every arc between two holding a multiple of
/// [`CONTROL_STRIDE`].
fn rows_through(landmarks: &[f64]) -> Vec<f64> {
    let mut rows = Vec::with_capacity(ROWS + CONTROL_STRIDE * landmarks.len());
    for (index, &begin) in landmarks.iter().enumerate() {
        let end = match landmarks.get(index + 1) {
            Some(next) => *next,
            None => landmarks[0] + 1.0,
        };
        let share = (ROWS / CONTROL_STRIDE) as f64 * (end - begin);
        let count = CONTROL_STRIDE * (share.ceil() as usize).max(1);
        rows.extend((0..count).map(|k| begin + (end - begin) * k as f64 / count as f64));
    }
    rows
}
