//! Coarse matches of two whole curves: which starts are worth a closer look, and how alike the curves are.

use super::curve::{Curve, Samples};
use super::elastic::{MismatchTable, Path};
use super::feature::{SalientPoint, salient_points};
use super::monotone::CyclicMap;
use super::start::cheapest_paths;
use crate::outline::{Ring, RingError};

/// Starts nearer than this, in perimeters, are one start.
const APART: f64 = 0.02;

/// One pose's outline with what is measured on it once.
#[derive(Debug, Clone)]
pub(super) struct Form {
    /// The curve.
    pub(super) curve: Curve,
    /// Its salient points.
    pub(super) salient: Vec<SalientPoint>,
}

impl Form {
    /// Measures `ring`.
    pub(super) fn new(ring: &Ring) -> Result<Self, RingError> {
        Ok(Self::of(Curve::new(ring)?))
    }

    /// Measures `ring` as seen in a mirror.
    pub(super) fn mirrored(ring: &Ring) -> Result<Self, RingError> {
        Ok(Self::of(Curve::mirrored(ring)?))
    }

    fn of(curve: Curve) -> Self {
        let salient = salient_points(&curve);
        Self { curve, salient }
    }

    /// `count` samples in even steps from the curve's own start on.
    pub(super) fn even_samples(&self, count: usize) -> Samples {
        Samples::coarse(&self.curve, self.even_parameters(count))
    }

    /// `count` parameters in even steps from the curve's own start on.
    pub(super) fn even_parameters(&self, count: usize) -> Vec<f64> {
        (0..count).map(|k| self.curve.start + k as f64 / count as f64).collect()
    }
}

/// A coarse match and its cost.
#[derive(Debug, Clone)]
pub(super) struct CoarseMatch {
    /// From the first curve to the second.
    pub(super) map: CyclicMap,
    /// The elastic cost.
    pub(super) cost: f32,
}

impl CoarseMatch {
    /// The match along `path`.
    pub(super) fn from_path(table: &MismatchTable, path: &Path) -> Self {
        let inner = &path.nodes[..path.nodes.len() - 1];
        Self {
            map: CyclicMap::through(
                inner.iter().map(|(i, _)| table.row_parameter(*i)).collect(),
                inner.iter().map(|(_, j)| table.column_parameter(*j)).collect(),
            ),
            cost: path.cost,
        }
    }
}

/// The best coarse matches of `first` to `second` with clearly different starts, cheapest first; at least one.
pub(super) fn coarse_matches(first: &Samples, second: &Samples, most: usize) -> Vec<CoarseMatch> {
    coarse_matches_to(first.parameters.clone(), std::slice::from_ref(first), second, most)
}

/// The same for several curves on common rows, which `rows` stand for.
pub(super) fn coarse_matches_to(rows: Vec<f64>, first: &[Samples], second: &Samples, most: usize) -> Vec<CoarseMatch> {
    let samples = rows.len();
    let table = MismatchTable::new(rows, first, second.clone());
    let apart = ((APART * samples as f64).round() as usize).max(1);
    cheapest_paths(&table, apart, most)
        .into_iter()
        .map(|path| CoarseMatch::from_path(&table, &path))
        .collect()
}
