//! The flip guard: a frame in which every triangle is positive, as near as can be to the one that was asked for.
//!
//! Far outside the poses, or between poses that have little in common, the least-squares fit may turn triangles over.
//! A guarded frame minimises the same energy plus a barrier that is nothing for a healthy triangle and infinite for one
//! without area:
//!
//! 1. A triangle is healthy above [`BAR`] of the smallest area that it has in any pose. If all are, the frame is left
//!    alone: one pass over the triangles, which counts inverted ones anyway. Starting below the bar and not at zero
//!    lets the frame change without a jump where a triangle is about to turn over.
//! 2. The search starts at a frame without inverted triangles: on the way to these weights from the pose with the
//!    largest one, the last that has none. At the latest that is the pose itself.
//! 3. Limited-memory BFGS, started with the factor of the frame's own system (Liu, Bouaziz, Kavan, "Quasi-Newton methods
//!    for real-time simulation of hyperelastic materials", 2017, with a barrier energy in place of an elastic one).
//!    Each step ends before the first triangle loses its area (Smith and Schaefer, "Bijective parameterization with
//!    free boundaries", 2015, section 3.3), and every accepted frame is checked with exact predicates.
//!
//! The result depends on the weights only, never on an earlier frame. If the budget of steps runs out, the last frame
//! is returned: it is valid, and as near as the search has come.
//!
//! Cost: each step is about two frames; a few dozen steps.

use super::BlendError;
use super::system::System;
use crate::math::{Matrix, Point, point, predicate};
use crate::mesh::{first_flat, geometry};
use crate::pose::PoseSet;

/// A triangle is healthy above this fraction of its smallest area in any pose.
const BAR: f64 = 0.05;

/// Steps at most.
const MOST_STEPS: usize = 200;

/// Steps that the search remembers.
const MEMORY: usize = 8;

/// The search ends when a step would lower the energy by less than this fraction of it.
const SMALL_GAIN: f64 = 1e-10;

/// How much of the way to the first inversion a step may go.
const SAFE_FRACTION: f64 = 0.9;

/// A step has to bring this fraction of what its slope promises (Armijo).
const SUFFICIENT: f64 = 1e-4;

/// Halvings of a step at most: 2^-40 of a step is no step.
const MOST_HALVINGS: usize = 40;

/// How far along the way from the pose to the weights a start is tried, best first.
pub(super) const START_FRACTIONS: [f64; 6] = [0.9375, 0.875, 0.75, 0.5, 0.25, 0.0];

/// What the guard knows of the poses.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    /// By triangle.
    rows: Vec<Row>,
    /// Soft anchors: vertex and stiffness.
    soft: Vec<(usize, f64)>,
}

#[derive(Debug, Clone)]
struct Row {
    corners: [usize; 3],
    /// Twice the area below which the barrier acts.
    floor: f64,
    /// What the barrier is multiplied by: an area, so that it has the energy's units.
    scale: f64,
    /// The triangle's weight in the energy, and the gradients of its second and third barycentric coordinate.
    weight: f64,
    gradients: [Point; 2],
}

/// Working space of the search; grows to its size with the first repaired frame.
#[derive(Debug, Clone, Default)]
pub(super) struct GuardScratch {
    /// The frame that was asked for.
    wanted: Vec<Point>,
    gradient: Vec<Point>,
    next_gradient: Vec<Point>,
    direction: Vec<Point>,
    trial: Vec<Point>,
    right: Vec<[f64; 2]>,
    memory: Vec<Remembered>,
}

impl GuardScratch {
    /// Keeps the frame that was asked for.
    pub(super) fn set_wanted(&mut self, positions: &[Point]) {
        self.wanted.clear();
        self.wanted.extend_from_slice(positions);
    }

    /// The frame that was asked for.
    pub(super) fn wanted(&self) -> &[Point] {
        &self.wanted
    }
}

/// A step and how the gradient changed along it.
#[derive(Debug, Clone, Default)]
struct Remembered {
    step: Vec<Point>,
    change: Vec<Point>,
    /// One over their product.
    curvature: f64,
}

impl Guard {
    /// For reference triangles with these edges and areas, stiffnesses of triangles, and soft anchors, as in the [`System`].
    ///
    /// # Errors
    /// [`BlendError::NotFinite`] if a reference triangle has no gradients.
    pub(super) fn new(
        poses: &PoseSet,
        reference_edges: &[Matrix],
        areas: &[f64],
        stiffness: &[f64],
        soft: Vec<(usize, f64)>,
    ) -> Result<Self, BlendError> {
        let triangles = poses.topology().triangles();
        let mut rows = Vec::with_capacity(triangles.len());
        for (t, &corners) in triangles.iter().enumerate() {
            let in_poses = poses.positions().iter();
            let doubled_areas =
                in_poses.map(|positions| 2.0 * geometry::signed_area(geometry::corners(positions, corners)));
            let smallest = doubled_areas.fold(f64::INFINITY, f64::min);
            // The rows of the inverse are the gradients of the second and the third barycentric coordinate.
            let inverse = reference_edges[t].try_inverse().ok_or(BlendError::NotFinite)?;
            rows.push(Row {
                corners,
                floor: BAR * smallest,
                scale: 0.5 * smallest * stiffness[t],
                weight: areas[t] * stiffness[t],
                gradients: [0, 1].map(|row| inverse.row(row).transpose()),
            });
        }
        Ok(Self { rows, soft })
    }

    /// Whether every triangle is healthy, and so certainly positive.
    pub(super) fn all_healthy(&self, positions: &[Point]) -> bool {
        self.rows.iter().all(|row| {
            let [a, b, c] = geometry::corners(positions, row.corners);
            // A comparison with NaN is false.
            predicate::surely_above(a, b, c, row.floor)
        })
    }

    /// Searches from `positions`, whose triangles are all positive, for the frame nearest to `scratch.wanted`.
    ///
    /// # Errors
    /// [`BlendError::Solve`].
    pub(super) fn search(
        &self,
        system: &System,
        scratch: &mut GuardScratch,
        positions: &mut [Point],
    ) -> Result<(), BlendError> {
        let GuardScratch {
            wanted,
            gradient,
            next_gradient,
            direction,
            trial,
            right,
            memory,
        } = scratch;
        memory.clear();
        let mut energy = self.energy(wanted, positions, gradient);
        for _ in 0..MOST_STEPS {
            find_direction(system, gradient, memory, right, direction)?;
            let slope = dot(gradient, direction);
            if slope >= -SMALL_GAIN * energy || slope.is_nan() {
                break;
            }
            let corners = self.rows.iter().map(|row| row.corners);
            let mut length = (SAFE_FRACTION * first_flat(corners, positions, direction)).min(1.0);
            let mut accepted = None;
            for _ in 0..MOST_HALVINGS {
                trial.clear();
                trial.extend(positions.iter().zip(direction.iter()).map(|(at, by)| at + by * length));
                if self.is_valid(trial) {
                    let reached = self.energy(wanted, trial, next_gradient);
                    if reached <= energy + SUFFICIENT * length * slope {
                        accepted = Some(reached);
                        break;
                    }
                }
                length *= 0.5;
            }
            let Some(reached) = accepted else { break };
            remember(memory, positions, trial, gradient, next_gradient);
            positions.copy_from_slice(trial);
            std::mem::swap(gradient, next_gradient);
            energy = reached;
        }
        Ok(())
    }

    /// Whether every triangle is positive, exactly.
    pub(super) fn is_valid(&self, positions: &[Point]) -> bool {
        positions.iter().all(|p| point::is_finite(*p))
            && self.rows.iter().all(|row| {
                let [a, b, c] = geometry::corners(positions, row.corners);
                predicate::is_positive(a, b, c)
            })
    }

    /// The energy at `positions`, and its gradient. The part of the fit is `sum w |J(V) - J(wanted)|^2`: `wanted` is its
    /// least point, so this is the blend's own energy but for a constant.
    fn energy(&self, wanted: &[Point], positions: &[Point], gradient: &mut Vec<Point>) -> f64 {
        gradient.clear();
        gradient.resize(positions.len(), Point::zeros());
        let mut energy = 0.0;
        for row in &self.rows {
            let [a, b, c] = row.corners;
            let away = |vertex: usize| positions[vertex] - wanted[vertex];
            let (second, third) = (away(b) - away(a), away(c) - away(a));
            let [g, h] = row.gradients;
            // The columns of the difference of the two maps.
            let (along_x, along_y) = (second * g.x + third * h.x, second * g.y + third * h.y);
            energy += row.weight * (along_x.norm_squared() + along_y.norm_squared());
            let pull = |gradient: Point| (along_x * gradient.x + along_y * gradient.y) * (2.0 * row.weight);
            let (mut at_second, mut at_third) = (pull(g), pull(h));
            let doubled_area = row.doubled_area(positions);
            if doubled_area < row.floor {
                let x = doubled_area / row.floor;
                let (value, slope) = barrier(x);
                energy += row.scale * value;
                let slope = slope * row.scale / row.floor;
                // The doubled area is the cross product of the two edges from the first corner.
                let (first_edge, second_edge) = (positions[b] - positions[a], positions[c] - positions[a]);
                at_second -= point::perpendicular(second_edge) * slope;
                at_third += point::perpendicular(first_edge) * slope;
            }
            gradient[b] += at_second;
            gradient[c] += at_third;
            gradient[a] -= at_second + at_third;
        }
        for &(vertex, stiffness) in &self.soft {
            let away = positions[vertex] - wanted[vertex];
            energy += stiffness * away.norm_squared();
            gradient[vertex] += away * (2.0 * stiffness);
        }
        energy
    }
}

impl Row {
    fn doubled_area(&self, positions: &[Point]) -> f64 {
        2.0 * geometry::signed_area(geometry::corners(positions, self.corners))
    }
}

/// `-(1 - x)^2 ln x` and its derivative, for `0 < x < 1`: joins zero at 1 with two continuous derivatives (Li et al.,
/// "Incremental potential contact", 2020, equation 6). Beyond zero there is no value, and so no step goes there.
fn barrier(x: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (f64::INFINITY, f64::NEG_INFINITY);
    }
    let (gap, logarithm) = (1.0 - x, libm::log(x));
    (-gap * gap * logarithm, 2.0 * gap * logarithm - gap * gap / x)
}

/// The quasi-Newton direction (Nocedal and Wright, "Numerical optimization", algorithm 7.4), with half the inverse of the
/// blend's matrix in the middle: the exact answer where the barrier does not act.
fn find_direction(
    system: &System,
    gradient: &[Point],
    memory: &[Remembered],
    right: &mut Vec<[f64; 2]>,
    direction: &mut Vec<Point>,
) -> Result<(), BlendError> {
    direction.clear();
    direction.extend(gradient.iter().map(|g| -g));
    let mut shares = [0.0; MEMORY];
    for (share, past) in shares.iter_mut().zip(memory).rev() {
        *share = past.curvature * dot(&past.step, direction);
        add(direction, -*share, &past.change);
    }
    right.clear();
    right.resize(system.right_len(), [0.0; 2]);
    system.set(direction.iter().map(|d| [0.5 * d.x, 0.5 * d.y]), right);
    system.solve(right)?;
    for (d, &solved) in direction.iter_mut().zip(system.solved(right)) {
        *d = Point::from(solved);
    }
    for (share, past) in shares.iter().zip(memory) {
        let back = past.curvature * dot(&past.change, direction);
        add(direction, share - back, &past.step);
    }
    Ok(())
}

/// Keeps the step from `positions` to `trial`, and forgets the oldest one if there are many.
fn remember(
    memory: &mut Vec<Remembered>,
    positions: &[Point],
    trial: &[Point],
    gradient: &[Point],
    next_gradient: &[Point],
) {
    let mut kept = if memory.len() == MEMORY {
        memory.remove(0)
    } else {
        Remembered::default()
    };
    let difference = |into: &mut Vec<Point>, from: &[Point], to: &[Point]| {
        into.clear();
        into.extend(to.iter().zip(from).map(|(to, from)| to - from));
    };
    difference(&mut kept.step, positions, trial);
    difference(&mut kept.change, gradient, next_gradient);
    let product = dot(&kept.step, &kept.change);
    // Where the energy bends down along the step, the step says nothing about a valley.
    if product > f64::EPSILON * dot(&kept.change, &kept.change).sqrt() * dot(&kept.step, &kept.step).sqrt() {
        kept.curvature = product.recip();
        memory.push(kept);
    }
}

fn dot(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn add(to: &mut [Point], factor: f64, what: &[Point]) {
    for (to, what) in to.iter_mut().zip(what) {
        *to += what * factor;
    }
}
