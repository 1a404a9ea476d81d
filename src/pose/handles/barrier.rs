//! Turning over what came out inverted: the symmetric Dirichlet energy, which is infinite for a flat triangle, minimised with the
//! handles as equations.
//!
//! Source: Smith and Schaefer, "Bijective parameterization with free boundaries" (2015) for energy and step length; the
//! positive part of a triangle's Hessian from its singular values (Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic
//! distortion energies").
//!
//! 1. It begins where nothing is inverted: the conformal map through the handles, the last drag's result or the shape moved
//!    rigidly, the first that is positive.
//! 2. Newton steps of the energy under `C V = h`, from positions that need not meet `h`: the equations are met to the share of
//!    the step that is taken, and exactly once a whole step is.
//! 3. A step ends short of the first triangle that would become flat, and is halved until energy plus violation falls.
//!
//! A beginning from which the handles are not reached is given up for the next; if none is left, the handle furthest from its
//! target is named.

use super::HandleError;
use super::constraint::Constraint;
use super::rest::RestShape;
use crate::math::{Matrix, Point, PolarSplit};
use crate::mesh::first_flat;
use crate::solve::{DenseMatrix, SolvedDense, SparseCholesky, Triplets};

/// The most Newton steps from one beginning.
const MOST_STEPS: usize = 120;
/// The share of the way to the first flat triangle that a step may go.
const SHORT_OF_FLAT: f64 = 0.85;
/// Halvings of a step before it is given up.
const MOST_HALVINGS: usize = 30;
/// Handles this near to their targets, in diagonals, are there: rounding of the small system.
const MET: f64 = 1e-10;
/// A step that moves no vertex by more than this, in diagonals, is the last.
const STILL: f64 = 1e-6;
/// What pulls handles to their targets inside the Hessian, so that translations have a stiffness, too: of the order of the
/// entries that the triangles give it.
const PULL: f64 = 1.0;

/// Fills `positions` with a deformation that meets `targets` and inverts nothing; returns the steps it took.
pub(super) fn repair(
    shape: &RestShape,
    constraint: &Constraint,
    targets: &[Point],
    beginnings: &[Vec<Point>],
    positions: &mut Vec<Point>,
) -> Result<usize, HandleError> {
    let mut failure: Option<(f64, usize)> = None;
    let mut steps = 0;
    for beginning in beginnings {
        if beginning.len() != shape.rest().len() || !shape.is_positive(beginning) {
            continue;
        }
        positions.clone_from(beginning);
        steps += minimise(shape, constraint, targets, positions)?;
        let missed = constraint
            .rows()
            .iter()
            .zip(targets)
            .map(|(row, target)| (row.at(positions) - target).norm());
        let (handle, worst) = missed
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .ok_or(HandleError::NoHandle)?;
        if worst <= MET * shape.size() && shape.is_positive(positions) {
            return Ok(steps);
        }
        if failure.is_none_or(|(least, _)| worst < least) {
            failure = Some((worst, handle));
        }
    }
    let handle = failure.map_or(0, |(_, handle)| handle);
    Err(HandleError::Inverts {
        handle,
        x: targets[handle].x,
        y: targets[handle].y,
    })
}

fn minimise(
    shape: &RestShape,
    constraint: &Constraint,
    targets: &[Point],
    positions: &mut [Point],
) -> Result<usize, HandleError> {
    let missing = |positions: &[Point]| -> Vec<Point> {
        let rows = constraint.rows().iter().zip(targets);
        rows.map(|(row, target)| target - row.at(positions)).collect()
    };
    let violation = |positions: &[Point]| missing(positions).iter().map(|m| m.norm()).sum::<f64>();
    let mut price = 0.0_f64;
    for step in 0..MOST_STEPS {
        let Some(Step { direction, multipliers }) = newton_step(shape, constraint, &missing(positions), positions)?
        else {
            return Ok(step);
        };
        let motion = direction.iter().map(|d| d.norm()).fold(0.0, f64::max);
        let is_met = missing(positions).iter().all(|m| m.norm() <= MET * shape.size());
        if is_met && motion <= STILL * shape.size() {
            return Ok(step);
        }
        // The price of a violation: above every multiplier the merit falls along the step.
        price = price.max(2.0 * multipliers.iter().map(|m| m.norm()).fold(0.0, f64::max));
        let merit = |positions: &[Point]| energy(shape, positions) + price * violation(positions);
        let before = merit(positions);
        let mut share = (SHORT_OF_FLAT * first_flat(shape.triangles().iter().copied(), positions, &direction)).min(1.0);
        let mut halvings = 0;
        let moved = loop {
            let moved: Vec<Point> = positions.iter().zip(&direction).map(|(p, d)| p + d * share).collect();
            if merit(&moved) < before && shape.is_positive(&moved) {
                break Some(moved);
            }
            share *= 0.5;
            halvings += 1;
            if halvings > MOST_HALVINGS {
                break None;
            }
        };
        match moved {
            Some(moved) => positions.clone_from_slice(&moved),
            None => return Ok(step),
        }
    }
    Ok(MOST_STEPS)
}

/// `sum area (|J|^2 + |J^-1|^2)`; infinite where a triangle is not positive.
fn energy(shape: &RestShape, positions: &[Point]) -> f64 {
    (0..shape.areas().len())
        .map(|t| {
            let map = shape.triangle_map(t, positions);
            let determinant = map.determinant();
            if determinant > 0.0 {
                shape.areas()[t] * map.norm_squared() * (1.0 + 1.0 / (determinant * determinant))
            } else {
                f64::INFINITY
            }
        })
        .sum()
}

/// A Newton step under the equations.
struct Step {
    /// Per vertex.
    direction: Vec<Point>,
    /// Per handle.
    multipliers: Vec<Point>,
}

/// The Newton step; `None` if the system cannot be solved.
fn newton_step(
    shape: &RestShape,
    constraint: &Constraint,
    missing: &[Point],
    positions: &[Point],
) -> Result<Option<Step>, HandleError> {
    let size = 2 * positions.len();
    let mut hessian = Triplets::new(size, size);
    let mut downhill = vec![[0.0; 1]; size];
    for (t, triangle) in shape.triangles().iter().enumerate() {
        let (area, gradients) = (shape.areas()[t], &shape.gradients()[t]);
        let Some(modes) = Modes::of(&shape.triangle_map(t, positions)) else {
            return Ok(None);
        };
        for (&vertex, gradient) in triangle.iter().zip(gradients) {
            let slope = modes.slope * gradient * area;
            downhill[2 * vertex][0] -= slope.x;
            downhill[2 * vertex + 1][0] -= slope.y;
        }
        for (stiffness, mode) in &modes.stiff {
            let along = gradients.map(|gradient| mode * gradient);
            for (&row, a) in triangle.iter().zip(&along) {
                for (&column, b) in triangle.iter().zip(&along) {
                    let entries = a * b.transpose() * (area * stiffness);
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        hessian.add(2 * row + i, 2 * column + j, entries[(i, j)]);
                    }
                }
            }
        }
    }
    for (row, missing) in constraint.rows().iter().zip(missing) {
        for (&a, share) in row.vertices.iter().zip(row.shares) {
            downhill[2 * a][0] += PULL * share * missing.x;
            downhill[2 * a + 1][0] += PULL * share * missing.y;
            for (&b, other) in row.vertices.iter().zip(row.shares) {
                hessian.add(2 * a, 2 * b, PULL * share * other);
                hessian.add(2 * a + 1, 2 * b + 1, PULL * share * other);
            }
        }
    }
    let Ok(factor) = SparseCholesky::new(&hessian.build()) else {
        return Ok(None);
    };
    let mut buffer = Vec::new();
    factor.solve(&mut downhill, &mut buffer)?;
    // The Schur complement of the equations.
    let count = 2 * constraint.len();
    let mut responses = Vec::with_capacity(count);
    for equation in 0..count {
        let row = &constraint.rows()[equation / 2];
        let mut response = vec![[0.0; 1]; size];
        for (&vertex, share) in row.vertices.iter().zip(row.shares) {
            response[2 * vertex + equation % 2][0] = share;
        }
        factor.solve(&mut response, &mut buffer)?;
        responses.push(response);
    }
    let at = |equation: usize, values: &[[f64; 1]]| -> f64 {
        let row = &constraint.rows()[equation / 2];
        let shares = row.vertices.iter().zip(row.shares);
        shares
            .map(|(&vertex, share)| share * values[2 * vertex + equation % 2][0])
            .sum()
    };
    let small = DenseMatrix::from_fn(count, count, |row, column| at(row, &responses[column]));
    let right = DenseMatrix::from_fn(count, 1, |row, _| missing[row / 2][row % 2] - at(row, &downhill));
    let Ok(multipliers) = SolvedDense::new(&small).and_then(|solved| solved.solve(&right)) else {
        return Ok(None);
    };
    for (equation, response) in responses.iter().enumerate() {
        for (value, [along]) in downhill.iter_mut().zip(response) {
            value[0] += multipliers.at(equation, 0) * along;
        }
    }
    let direction = downhill
        .chunks_exact(2)
        .map(|pair| Point::new(pair[0][0], pair[1][0]))
        .collect();
    let multipliers = (0..count / 2)
        .map(|k| Point::new(multipliers.at(2 * k, 0), multipliers.at(2 * k + 1, 0)) + missing[k] * PULL)
        .collect();
    Ok(Some(Step { direction, multipliers }))
}

/// How the energy of a triangle changes with its map.
struct Modes {
    /// The derivative.
    slope: Matrix,
    /// Positive curvatures and their directions.
    stiff: [(f64, Matrix); 4],
}

impl Modes {
    /// `None` if the map is not positive.
    fn of(map: &Matrix) -> Option<Self> {
        let split = PolarSplit::of(map);
        let (a, b, c) = (split.stretch.m11, split.stretch.m12, split.stretch.m22);
        let axis_rad = 0.5 * (2.0 * b).atan2(a - c);
        let (middle, radius) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
        let (large, small) = (middle + radius, middle - radius);
        if !(small > 0.0 && large.is_finite()) {
            return None;
        }
        // J = U diag(large, small) V^T.
        let right = crate::math::rotation(axis_rad);
        let left = crate::math::rotation(split.angle_rad) * right;
        let in_axes = |m: Matrix| left * m * right.transpose();
        let slope = |s: f64| 2.0 * s - 2.0 / (s * s * s);
        let curvature = |s: f64| 2.0 + 6.0 / (s * s * s * s);
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let cubes = (large * small).powi(3);
        let twist = ((slope(large) + slope(small)) / (large + small)).max(0.0);
        let shear = 2.0 + 2.0 * (large * large + large * small + small * small) / cubes;
        Some(Self {
            slope: in_axes(Matrix::new(slope(large), 0.0, 0.0, slope(small))),
            stiff: [
                (curvature(large), in_axes(Matrix::new(1.0, 0.0, 0.0, 0.0))),
                (curvature(small), in_axes(Matrix::new(0.0, 0.0, 0.0, 1.0))),
                (twist, in_axes(Matrix::new(0.0, -half, half, 0.0))),
                (shear, in_axes(Matrix::new(0.0, half, half, 0.0))),
            ],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_right() {
        // The slope against differences.
        let map = Matrix::new(1.6, 0.4, -0.2, 1.2);
        let value = |m: &Matrix| m.norm_squared() * (1.0 + 1.0 / m.determinant().powi(2));
        let modes = Modes::of(&map).expect("positive");
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (mut up, mut down) = (map, map);
            up[(i, j)] += 1e-6;
            down[(i, j)] -= 1e-6;
            let difference = (value(&up) - value(&down)) / 2e-6;
            assert!((difference - modes.slope[(i, j)]).abs() < 1e-6);
            let bend = (value(&up) - 2.0 * value(&map) + value(&down)) / 1e-12;
            let curvature: f64 = modes.stiff.iter().map(|(s, m)| s * m[(i, j)] * m[(i, j)]).sum();
            // No mode of this map is negative, so the Hessian is the whole one.
            assert!((bend - curvature).abs() < 1e-2 * curvature, "{bend} {curvature}");
        }
        assert!(Modes::of(&Matrix::new(1.0, 0.0, 0.0, -0.1)).is_none());
    }
}
