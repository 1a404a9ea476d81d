//! Weights within [0, 1]: bounded biharmonic weights.
//!
//! Source: Jacobson, Baran, Popovic, Sorkine, "Bounded biharmonic weights for real-time deformation" (2011): the energy is
//! minimised under bounds on the values at the vertices. Solved by the alternating direction method of multipliers (Boyd
//! et al. 2011), which needs one factorisation: of the energy plus a penalty.
//!
//! 1. The plate settles, its values drawn towards the last admissible ones by the penalty.
//! 2. At every vertex the weights are projected to the nearest ones that are not negative and sum to 1.
//! 3. The disagreement is added up and drawn against; again from 1, until it is small or the budget is used up.
//!
//! Between vertices, and for what is left of the disagreement, weights are bent to be admissible where they are evaluated:
//! `w_i = g(f_i) / sum of g(f_j)`, with `g` 0 below 0, the identity from [`BEND`] on, and a cubic between that joins both
//! smoothly. So the weights are within [0, 1] and sum to 1 at every place, keep continuous gradients, and are 1 and 0
//! at the poses.
//!
//! Differences from the source: all weights are found together, so that they sum to 1 at the optimum already.
//!
//! Cost: per iteration one pair of triangular solves a pose; tens to hundreds of iterations.

use std::f64::consts::TAU;

use super::WeightError;
use super::elements::Form;
use super::plate::{Load, Plate, Supports};
use super::tessellation::Tessellation;
use crate::mesh::geometry;

/// The penalty on a squared deviation, per area, is about the energy of waves this many times as long as the mesh's edges at
/// a place, which makes the iteration short: the mesh follows what the weights do, near the poses and far away.
const WAVE: f64 = 10.0;

/// Steps are stretched by this factor (over-relaxation, Boyd et al. 3.4.3).
const RELAXATION: f64 = 1.7;

/// Iterations at most.
const BUDGET: usize = 400;

/// What an iteration may still change and what the weights may still miss the bounds by, as a root mean square.
const ENOUGH: f64 = 3e-4;

/// Values below this are bent when weights are evaluated. Far larger than what values miss the bounds by, so that the
/// bend is gentle; so small that it hardly changes them.
const BEND: f64 = 0.02;

/// How the search for bounded weights ended.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BoundedReport {
    /// Iterations used, at most 400.
    pub iterations: usize,
    /// By how much the weights found miss the bounds at the mesh's vertices, as a root mean square, before they are bent
    /// to be within them.
    pub deviation: f64,
    /// What the last iteration changed, as a root mean square.
    pub change: f64,
    /// Whether both are below 3e-4. If not, the weights are still within the bounds, cardinal and smooth, but not quite
    /// of least energy.
    pub converged: bool,
}

/// The penalty at each vertex.
pub(super) fn penalties(mesh: &Tessellation) -> Vec<f64> {
    let mut penalties = vec![0.0; mesh.positions.len()];
    for &triangle in &mesh.triangles {
        let area = geometry::signed_area(geometry::corners(&mesh.positions, triangle));
        // An equilateral triangle with this edge has this area, up to a seventh.
        let wave = WAVE * (2.0 * area).sqrt();
        let per_area = (TAU / wave).powi(4);
        for vertex in triangle {
            penalties[vertex] += per_area * area / 3.0;
        }
    }
    penalties
}

/// The functions of least energy (#unknowns x #functions) whose values at the unknowns `values` are within the bounds.
/// `plate` has the penalties on its diagonal.
pub(super) fn settle(
    plate: &Plate,
    supports: &Supports<'_>,
    values: &[usize],
    penalties: &[f64],
) -> Result<(Vec<f64>, BoundedReport), WeightError> {
    let count = supports.count;
    let whole: f64 = penalties.iter().sum();
    let mut admissible = vec![1.0 / count as f64; values.len() * count];
    let mut disagreement = vec![0.0; values.len() * count];
    let mut row = vec![0.0; count];
    let mut report = BoundedReport {
        iterations: 0,
        deviation: f64::INFINITY,
        change: f64::INFINITY,
        converged: false,
    };
    loop {
        let drawn = |pose: usize| -> Form {
            let towards = |(vertex, &unknown): (usize, &usize)| {
                let k = vertex * count + pose;
                (unknown, penalties[vertex] * (admissible[k] - disagreement[k]))
            };
            values.iter().enumerate().map(towards).collect()
        };
        let loads: Vec<Load> = plate.loads((0..count).map(drawn).collect())?;
        let functions = plate.settle(&supports.with(&loads))?;
        report.iterations += 1;
        let (mut missed, mut changed) = (0.0, 0.0);
        for (vertex, (&unknown, penalty)) in values.iter().zip(penalties).enumerate() {
            let here = vertex * count..(vertex + 1) * count;
            let found = &functions[unknown * count..(unknown + 1) * count];
            let (before, lag) = (&mut admissible[here.clone()], &mut disagreement[here]);
            for k in 0..count {
                lag[k] += RELAXATION * found[k] + (1.0 - RELAXATION) * before[k];
            }
            row.copy_from_slice(lag);
            project(&mut row);
            for k in 0..count {
                changed += penalty * (row[k] - before[k]) * (row[k] - before[k]);
                missed += penalty * (row[k] - found[k]) * (row[k] - found[k]);
                before[k] = row[k];
                lag[k] -= row[k];
            }
        }
        report.deviation = (missed / whole).sqrt();
        report.change = (changed / whole).sqrt();
        report.converged = report.deviation.max(report.change) < ENOUGH;
        if report.converged || report.iterations == BUDGET {
            return Ok((functions, report));
        }
    }
}

/// The nearest numbers that are not negative and sum to 1 (Held, Wolfe, Crowder 1974).
fn project(numbers: &mut [f64]) {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let (mut sum, mut shift) = (0.0, 0.0);
    for (k, number) in sorted.into_iter().enumerate() {
        sum += number;
        let candidate = (sum - 1.0) / (k + 1) as f64;
        if number > candidate {
            shift = candidate;
        }
    }
    for number in numbers {
        *number = (*number - shift).max(0.0);
    }
}

/// Bends weights to be within [0, 1], see the module's page.
pub(super) fn bend(weights: &mut [f64]) {
    for weight in weights.iter_mut() {
        let t = *weight / BEND;
        if t < 1.0 {
            *weight = if t > 0.0 { BEND * t * t * (2.0 - t) } else { 0.0 };
        }
    }
    // The largest of weights that sum to 1 is at least their mean, so it is not bent to nothing.
    let sum: f64 = weights.iter().sum();
    for weight in weights {
        *weight /= sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn projections_by_hand() {
        for (given, expected) in [
            ([0.5, 0.5, 0.0], [0.5, 0.5, 0.0]),
            ([1.2, -0.1, -0.1], [1.0, 0.0, 0.0]),
            ([0.6, 0.6, -0.2], [0.5, 0.5, 0.0]),
            ([0.0, 0.0, 0.0], [1.0 / 3.0; 3]),
        ] {
            let mut numbers = given;
            project(&mut numbers);
            for (found, expected) in numbers.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{given:?} to {numbers:?}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn bent_weights_are_admissible_and_hardly_changed(
            mut weights in proptest::collection::vec(-0.01..1.0f64, 1..20),
        ) {
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 0.5);
            weights.iter_mut().for_each(|w| *w /= sum);
            let before = weights.clone();
            bend(&mut weights);
            prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for (after, before) in weights.iter().zip(&before) {
                prop_assert!((0.0..=1.0).contains(after));
                prop_assert!(before.abs() > BEND || (after - before).abs() < 2.0 * BEND);
            }
        }
    }
}
