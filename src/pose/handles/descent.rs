//! The local and the global step, in turn, accelerated.
//!
//! 1. Local: every triangle's rotation is the one nearest to its map and to its neighbours' rotations, one triangle after the
//!    other; a sum of four numbers and a square root each.
//! 2. Global: the positions that fit these rotations best and meet the handles.
//! 3. The steps are combined so that their linear part cancels (Anderson acceleration; Peng et al. 2018, "Anderson
//!    acceleration for geometry optimization and physics simulation"); where that raises the energy the plain step is taken.
//!
//! It ends when no vertex moves any more, or after a number of steps ([`DragOptions`]).

use super::constraint::Constraint;
use super::rest::RestShape;
use super::{DragOptions, HandleError};
use crate::math::Point;

/// Steps that are combined.
const WINDOW: usize = 5;
/// What is added to the diagonal of the combination's normal equations, relative to its entries.
const DAMPING: f64 = 1e-10;

impl Scratch {
    /// The next descent begins with the rotations of its positions.
    pub(super) fn forget(&mut self) {
        self.rotations.clear();
    }
}

/// What a descent reached.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outcome {
    pub(super) iterations: usize,
    /// Of the last step, as a fraction of the diagonal.
    pub(super) last_motion: f64,
    pub(super) energy: f64,
    pub(super) smallest_share: f64,
}

/// Which rotations a descent begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beginning {
    /// Those of the positions.
    Anew,
    /// Those of the descent before.
    Onwards,
}

/// Working space.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    /// Cosine and sine of each triangle.
    rotations: Vec<[f64; 2]>,
    /// Twice the similar part of each triangle's map, times its area.
    pulls: Vec<[f64; 2]>,
    fitted: Vec<[f64; 2]>,
    solve: Vec<[f64; 2]>,
    small: Vec<Point>,
    step: Vec<Point>,
    last_fitted: Vec<Point>,
    last_step: Vec<Point>,
    /// Differences of successive steps and of successive fits, a ring of `WINDOW`.
    step_differences: Vec<Vec<Point>>,
    fit_differences: Vec<Vec<Point>>,
}

/// Minimises the energy from `positions` on, with the handles at `targets`.
pub(super) fn minimise(
    shape: &RestShape,
    constraint: &Constraint,
    targets: &[Point],
    (beginning, options): (Beginning, &DragOptions),
    positions: &mut [Point],
    scratch: &mut Scratch,
) -> Result<Outcome, HandleError> {
    if beginning == Beginning::Anew || scratch.rotations.len() != shape.areas().len() {
        begin(shape, positions, scratch);
    }
    let (mut kept, mut next) = (0, 0);
    let (mut energy, mut is_combined) = (f64::INFINITY, false);
    let mut outcome = Outcome {
        iterations: 0,
        last_motion: f64::INFINITY,
        energy: 0.0,
        smallest_share: 0.0,
    };
    let most = options.most_iterations.max(1);
    while outcome.iterations < most {
        outcome.iterations += 1;
        let mut reached = turn(shape, positions, &mut scratch.rotations, &mut scratch.pulls);
        // The first positions need not meet the handles, and then their energy says nothing.
        let falls = reached <= energy;
        if is_combined && !falls {
            positions.clone_from_slice(&scratch.last_fitted);
            reached = turn(shape, positions, &mut scratch.rotations, &mut scratch.pulls);
            (kept, next) = (0, 0);
        }
        energy = reached;
        fit(shape, constraint, targets, scratch)?;
        let mut motion = 0.0_f64;
        scratch.step.clear();
        for (fitted, position) in scratch.fitted.iter().zip(positions.iter()) {
            let step = Point::from(*fitted) - position;
            motion = motion.max(step.norm());
            scratch.step.push(step);
        }
        outcome.last_motion = motion / shape.size();
        if outcome.iterations > 2 {
            for (k, (step, last)) in scratch.step.iter().zip(&scratch.last_step).enumerate() {
                scratch.step_differences[next][k] = step - last;
                scratch.fit_differences[next][k] = Point::from(scratch.fitted[k]) - scratch.last_fitted[k];
            }
            next = (next + 1) % WINDOW;
            kept = (kept + 1).min(WINDOW);
        }
        scratch.last_step.clone_from(&scratch.step);
        scratch.last_fitted.clear();
        scratch
            .last_fitted
            .extend(scratch.fitted.iter().map(|p| Point::from(*p)));
        positions.clone_from_slice(&scratch.last_fitted);
        if outcome.last_motion <= options.still {
            break;
        }
        is_combined = kept > 0 && outcome.iterations < most;
        if is_combined {
            combine(
                &scratch.step,
                &scratch.step_differences[..kept],
                &scratch.fit_differences[..kept],
                positions,
            );
        }
    }
    outcome.energy = energy;
    outcome.smallest_share = shape.smallest_share(positions);
    Ok(outcome)
}

fn begin(shape: &RestShape, positions: &[Point], scratch: &mut Scratch) {
    scratch.rotations.clear();
    scratch.rotations.extend((0..shape.areas().len()).map(|t| {
        let map = shape.triangle_map(t, positions);
        unit([map.m11 + map.m22, map.m21 - map.m12], [1.0, 0.0])
    }));
    for ring in [&mut scratch.step_differences, &mut scratch.fit_differences] {
        ring.resize(WINDOW, Vec::new());
        for entry in ring.iter_mut() {
            entry.resize(positions.len(), Point::zeros());
        }
    }
}

/// The local step; returns the energy of `positions` with the new rotations.
fn turn(shape: &RestShape, positions: &[Point], rotations: &mut [[f64; 2]], pulls: &mut Vec<[f64; 2]>) -> f64 {
    let mut energy = 0.0;
    pulls.clear();
    for (t, (area, ties)) in shape.areas().iter().zip(shape.ties()).enumerate() {
        let map = shape.triangle_map(t, positions);
        let mut pull = [area * (map.m11 + map.m22), area * (map.m21 - map.m12)];
        pulls.push(pull);
        let mut tied = 0.0;
        for (across, tie) in shape.neighbours()[t].iter().zip(ties) {
            if let Some(other) = across {
                let [cos, sin] = rotations[*other];
                pull = [pull[0] + 2.0 * tie * cos, pull[1] + 2.0 * tie * sin];
                tied += tie;
            }
        }
        rotations[t] = unit(pull, rotations[t]);
        // |J - R|^2 and half of |R - R'|^2 a tie, without the part that is the same for all rotations.
        energy += area * (map.norm_squared() + 2.0) + 2.0 * tied;
    }
    for (t, (pull, ties)) in pulls.iter().zip(shape.ties()).enumerate() {
        let [cos, sin] = rotations[t];
        energy -= 2.0 * (cos * pull[0] + sin * pull[1]);
        for (across, tie) in shape.neighbours()[t].iter().zip(ties) {
            if let Some(other) = across {
                energy -= 2.0 * tie * (cos * rotations[*other][0] + sin * rotations[*other][1]);
            }
        }
    }
    energy.max(0.0)
}

/// The global step.
fn fit(
    shape: &RestShape,
    constraint: &Constraint,
    targets: &[Point],
    scratch: &mut Scratch,
) -> Result<(), HandleError> {
    scratch.fitted.clear();
    scratch.fitted.resize(shape.rest().len(), [0.0; 2]);
    for (t, (triangle, gradients)) in shape.triangles().iter().zip(shape.gradients()).enumerate() {
        let (area, [cos, sin]) = (shape.areas()[t], scratch.rotations[t]);
        for (&vertex, gradient) in triangle.iter().zip(gradients) {
            let right = &mut scratch.fitted[vertex];
            right[0] += area * (cos * gradient.x - sin * gradient.y);
            right[1] += area * (sin * gradient.x + cos * gradient.y);
        }
    }
    shape.solve(&mut scratch.fitted, &mut scratch.solve)?;
    constraint.meet(targets, &mut scratch.fitted, &mut scratch.small);
    Ok(())
}

/// Takes from `positions` what the last steps say will be undone: least squares over the window.
fn combine(step: &[Point], step_differences: &[Vec<Point>], fit_differences: &[Vec<Point>], positions: &mut [Point]) {
    let count = step_differences.len();
    let dot = |a: &[Point], b: &[Point]| -> f64 { a.iter().zip(b).map(|(p, q)| p.dot(q)).sum() };
    let (mut gram, mut right) = ([[0.0; WINDOW]; WINDOW], [0.0; WINDOW]);
    for i in 0..count {
        for j in 0..=i {
            gram[i][j] = dot(&step_differences[i], &step_differences[j]);
            gram[j][i] = gram[i][j];
        }
        gram[i][i] *= 1.0 + DAMPING;
        right[i] = dot(&step_differences[i], step);
    }
    let Some(shares) = solve_small(gram, right, count) else {
        return;
    };
    for (share, differences) in shares.iter().zip(fit_differences) {
        for (position, difference) in positions.iter_mut().zip(differences) {
            *position -= difference * *share;
        }
    }
}

/// A positive definite system of `count` unknowns, by elimination; `None` if it is singular.
fn solve_small(mut gram: [[f64; WINDOW]; WINDOW], mut right: [f64; WINDOW], count: usize) -> Option<[f64; WINDOW]> {
    for pivot in 0..count {
        let diagonal = gram[pivot][pivot];
        if !(diagonal > 0.0 && diagonal.is_finite()) {
            return None;
        }
        for row in pivot + 1..count {
            let factor = gram[row][pivot] / diagonal;
            let above = gram[pivot];
            for (entry, above) in gram[row].iter_mut().zip(above).take(count).skip(pivot) {
                *entry -= factor * above;
            }
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| gram[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / gram[row][row];
    }
    Some(right)
}

/// The direction of `[cos, sin]`, or `otherwise` where there is none.
fn unit([cos, sin]: [f64; 2], otherwise: [f64; 2]) -> [f64; 2] {
    // Areas and maps are relative to the shape's size, so that squares neither vanish nor overflow.
    let length = (cos * cos + sin * sin).sqrt();
    if length > 0.0 && length.is_finite() {
        [cos / length, sin / length]
    } else {
        otherwise
    }
}
