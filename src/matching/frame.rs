//! The rows of a correspondence, and what a pose is compared with on them.

use super::coarse::Form;
use super::curve::{Samples, around};
use super::thin_plate::ThinPlate;
use crate::math::Point;

/// Rows of a match; the elastic match uses every second, the splines every fourth.
const ROWS: usize = 512;
/// Rows between two control points of a spline.
pub(super) const CONTROL_STRIDE: usize = 4;
/// Rows between two samples of the coarse match: about a hundred samples.
const COARSE_STRIDE: usize = 5;
/// Stiffness of the splines, with lengths in perimeters; the first guides, the others refit.
pub(super) const STIFFNESSES: [f64; 5] = [1e-3, 1e-3, 3e-4, 1e-4, 1e-5];

/// The reference's rows, with everything about them that does not depend on the other poses.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    /// The reference's parameter by row: increasing, not wrapped.
    pub(super) rows: Vec<f64>,
    /// The reference at its rows.
    pub(super) measured: RowSamples,
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
        let measured = RowSamples::new(reference, rows.clone());
        Self { rows, measured, plate }
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

/// A pose measured where its rows are: once, however often it is compared.
#[derive(Debug, Clone)]
pub(super) struct RowSamples {
    /// At every row.
    pub(super) fine: Samples,
    /// At every row of the coarse match.
    coarse: Samples,
}

impl RowSamples {
    /// Measures `form` at the parameters of its rows.
    pub(super) fn new(form: &Form, rows: Vec<f64>) -> Self {
        let fine = Samples::fine(&form.curve, rows);
        let coarse = fine.around(0, COARSE_STRIDE).with_long_windows(&form.curve);
        Self { fine, coarse }
    }
}

/// One of the curves that a pose is compared with.
#[derive(Debug, Clone, Copy)]
pub(super) struct ModelCurve<'a> {
    pub(super) form: &'a Form,
    /// Its parameters by row.
    pub(super) parameters: &'a [f64],
    /// What is measured there.
    pub(super) measured: &'a RowSamples,
}

/// What a pose is compared with: one curve, or several whose rows correspond.
#[derive(Debug)]
pub(super) struct Model<'a> {
    /// By row, the mean of the curves' parameters: increasing, not wrapped.
    pub(super) rows: Vec<f64>,
    /// The curves.
    pub(super) curves: Vec<ModelCurve<'a>>,
}

impl<'a> Model<'a> {
    /// The model of `curves`. Their order does not matter.
    pub(super) fn new(mut curves: Vec<ModelCurve<'a>>) -> Self {
        // Sums are rounded: an order that comes from the shapes gives the same sums whatever order the poses have.
        curves.sort_by(|a, b| unevenness(a.parameters).total_cmp(&unevenness(b.parameters)));
        let count = curves.first().map_or(0, |curve| curve.parameters.len());
        let mean = |row: usize| curves.iter().map(|curve| curve.parameters[row]).sum::<f64>() / curves.len() as f64;
        Self {
            rows: (0..count).map(mean).collect(),
            curves,
        }
    }

    /// Every `stride`-th row from `first` on, once around: their parameters, and each curve there.
    pub(super) fn samples(&self, first: usize, stride: usize) -> (Vec<f64>, Vec<Samples>) {
        let curves = self
            .curves
            .iter()
            .map(|curve| curve.measured.fine.around(first, stride));
        (around(&self.rows, first, stride), curves.collect())
    }

    /// The rows of the coarse match: their parameters, and each curve there.
    pub(super) fn coarse_samples(&self) -> (Vec<f64>, Vec<Samples>) {
        let curves = self.curves.iter().map(|curve| curve.measured.coarse.clone());
        (around(&self.rows, 0, COARSE_STRIDE), curves.collect())
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
