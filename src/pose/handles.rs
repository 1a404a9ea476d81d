//! As-rigid-as-possible deformation by handles: a pose, points on it, and where they should go; the deformed pose out.
//!
//! Source: NWM 3.2, which uses Igarashi, Moscovich, Hughes, "As-rigid-as-possible shape manipulation" (2005); here the
//! local/global form of Sorkine and Alexa, "As-rigid-as-possible surface modeling" (2007), with one rotation a triangle.
//!
//! The energy is `sum area |J(V) - R|^2` over the triangles, `J` the map from rest to deformed triangle and `R` a rotation of
//! its own, plus `bending sum c |R - R'|^2` over neighbouring triangles. It is the energy of the rigid blend with all stretches
//! 1, so that deformed copies look like what is blended between them.
//! 1. Once a pose ([`rest`]): the cotangent matrix is factored.
//! 2. Once a handle set ([`constraint`]): one solve a handle and a dense inverse with a row a handle (a Schur complement), so
//!    that every handle set of a pose shares the factor.
//! 3. A drag begins where the last one ended. The first begins twice, from the conformal map through the handles
//!    ([`conformal`]), which knows of large rotations, and from the best rigid motion; the lower energy wins.
//! 4. Rotations that fit best (local), then positions that fit best (global: two triangular solves), again and again with
//!    Anderson acceleration ([`descent`]).
//! 5. If a triangle came out inverted or nearly flat: the symmetric Dirichlet energy, which forbids that, is minimised with the
//!    handles kept ([`barrier`]).
//!
//! Differences from the sources:
//! - Igarashi's method solves twice, for similar and then for congruent triangles: here the first is the beginning only.
//! - One rotation a triangle, not one a vertex fan. Negative cotangents do no harm: the matrix is that of linear finite
//!   elements, positive whatever the triangles are.
//! - Neighbouring rotations are tied (Levi and Gotsman 2015): without that a point handle draws a spike out of a fine mesh.
//! - Handles may lie anywhere inside and are met to rounding, by elimination, not by a penalty.
//! - Nothing is inverted in the result.
//!
//! One handle translates; two at their own distance move rigidly, otherwise nearly so.
//!
//! Limits: triangles are positive, but parts may come to lie over one another: whoever needs an embedding checks that.

mod barrier;
mod conformal;
mod constraint;
mod descent;
mod rest;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use self::conformal::Conformal;
use self::constraint::Constraint;
use self::descent::Beginning;
use self::rest::RestShape;
use crate::math::{Point, point};
use crate::mesh::Topology;
use crate::solve::SolveError;

/// Handles nearer than this to one another are one, as a fraction of the pose's diagonal: a hundredth of a pixel of a drawing of
/// a thousand.
const COINCIDENT: f64 = 1e-5;

/// A triangle that keeps less than this share of its area is repaired like an inverted one.
const FLATTEST: f64 = 0.02;

/// Why handles do not deform.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HandleError {
    /// There is no handle.
    #[error("no handle is given; give at least one")]
    NoHandle,
    /// A handle does not lie on the mesh.
    #[error(
        "handle {handle} at ({x:.1}, {y:.1}) lies {distance:.1} units outside the shape; move it inside, to ({nearest_x:.1}, {nearest_y:.1}) for instance"
    )]
    Outside {
        /// Which handle, from 0.
        handle: usize,
        /// Its place.
        x: f64,
        /// Its place.
        y: f64,
        /// How far outside, in source units.
        distance: f64,
        /// The nearest place that would do.
        nearest_x: f64,
        /// The nearest place that would do.
        nearest_y: f64,
    },
    /// Two handles hold the same point.
    #[error("handles {first} and {second} hold the same point of the shape; remove one")]
    Coincident {
        /// A handle, from 0.
        first: usize,
        /// The other.
        second: usize,
    },
    /// Two handles are dragged to the same place.
    #[error(
        "handles {first} and {second} are dragged to the same place; the shape between them would vanish: drag one elsewhere"
    )]
    TargetsCoincide {
        /// A handle, from 0.
        first: usize,
        /// The other.
        second: usize,
    },
    /// Too many handles for the mesh.
    #[error(
        "handle {handle} lies in a triangle whose corners the other handles hold already; move it away from them, or refine the mesh"
    )]
    Dependent {
        /// A handle, from 0.
        handle: usize,
    },
    /// A place is not finite or far out.
    #[error("handle {handle} is dragged to ({x}, {y}); give a place within 1e7")]
    BadPlace {
        /// Which handle, from 0.
        handle: usize,
        /// Where to.
        x: f64,
        /// Where to.
        y: f64,
    },
    /// One target a handle is needed.
    #[error("{found} targets for {handles} handles")]
    WrongCount {
        /// Targets given.
        found: usize,
        /// Handles.
        handles: usize,
    },
    /// The mesh is in more than one piece, or a triangle is not positive.
    #[error("{0}; handles need a valid mesh in one piece")]
    BadMesh(String),
    /// No deformation without inverted triangles was found.
    #[error(
        "dragging handle {handle} to ({x:.1}, {y:.1}) turns parts of the shape inside out; drag it less far, move the handles beside it along, or add handles between"
    )]
    Inverts {
        /// The handle that could not follow, from 0.
        handle: usize,
        /// Where to.
        x: f64,
        /// Where to.
        y: f64,
    },
    /// A linear system cannot be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// When a drag ends. Handles are met exactly whenever that is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DragOptions {
    /// A step that moves no vertex further than this, as a fraction of the pose's diagonal, is the last. Default: 1e-7, a
    /// ten-thousandth of a pixel of a drawing of a thousand.
    pub still: f64,
    /// The most steps from each beginning. Default: 600. An interactive dragger takes as many as fit into a frame, 20 for
    /// instance: the next drag goes on from there.
    pub most_iterations: usize,
}

impl Default for DragOptions {
    fn default() -> Self {
        Self {
            still: 1e-7,
            most_iterations: 600,
        }
    }
}

/// Whether triangles had to be turned over again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repair {
    /// None was inverted or nearly flat.
    NotNeeded,
    /// Some were; none is now.
    Done {
        /// Newton steps.
        steps: usize,
    },
}

/// How a drag went.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DragReport {
    /// Local and global steps, of all beginnings together.
    pub iterations: usize,
    /// The largest motion of a vertex in the last step, as a fraction of the pose's diagonal.
    pub last_motion: f64,
    /// The energy over the area: the mean squared deviation from a rotation. 0 where the shape moves rigidly.
    pub energy: f64,
    /// Whether triangles were inverted on the way.
    pub repair: Repair,
}

/// Working space of one dragger of one [`HandleDeformation`], which remembers where the last drag ended.
#[derive(Debug, Clone, Default)]
pub struct HandleScratch {
    descent: descent::Scratch,
    /// Where the last drag ended; empty before the first.
    last: Vec<Point>,
}

impl HandleScratch {
    /// The next drag begins anew and does not depend on those before.
    pub fn forget(&mut self) {
        self.last.clear();
        self.descent.forget();
    }
}

/// A pose with handles: built once a handle set, dragged often.
///
/// ```
/// use inbetween::{math::Point, mesh::Topology, pose::HandleDeformation};
/// let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::from);
/// let topology = Topology::new(4, vec![[0, 1, 2], [0, 2, 3]])?;
/// let handles = [Point::new(0.5, 0.5), Point::new(1.5, 0.5)];
/// let deformation = HandleDeformation::new(&topology, &square, &handles)?;
/// let mut positions = Vec::new();
/// // A quarter turn about the first handle.
/// let targets = [Point::new(0.5, 0.5), Point::new(0.5, 1.5)];
/// let report = deformation.drag(&targets, &mut deformation.scratch(), &mut positions)?;
/// assert!((positions[1] - Point::new(1.0, 2.0)).norm() < 1e-6 && report.energy < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct HandleDeformation {
    shape: Arc<RestShape>,
    constraint: Constraint,
    conformal: Conformal,
    options: DragOptions,
}

impl HandleDeformation {
    /// Puts handles on a pose whose #vertices positions are `rest`; `handles` are places on it.
    ///
    /// # Errors
    /// [`HandleError`] if the mesh is not positive and in one piece, a handle lies outside, or two hold the same point.
    pub fn new(topology: &Topology, rest: &[Point], handles: &[Point]) -> Result<Self, HandleError> {
        Self::on(Arc::new(RestShape::new(topology, rest)?), handles)
    }

    /// Other handles on the same pose; the factor is kept.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_handles(&self, handles: &[Point]) -> Result<Self, HandleError> {
        Self::on(Arc::clone(&self.shape), handles)
    }

    fn on(shape: Arc<RestShape>, handles: &[Point]) -> Result<Self, HandleError> {
        if handles.is_empty() {
            return Err(HandleError::NoHandle);
        }
        for (second, b) in handles.iter().enumerate() {
            let is_same = |a: &Point| (a - b).norm() <= COINCIDENT * shape.size();
            if let Some(first) = handles[..second].iter().position(is_same) {
                return Err(HandleError::Coincident { first, second });
            }
        }
        let constraint = Constraint::new(&shape, handles)?;
        let conformal = Conformal::new(&shape, &constraint)?;
        Ok(Self {
            shape,
            constraint,
            conformal,
            options: DragOptions::default(),
        })
    }

    /// The same handles, dragged with other options.
    #[must_use]
    pub fn with_options(mut self, options: DragOptions) -> Self {
        self.options = options;
        self
    }

    /// How many handles.
    #[must_use]
    pub fn handle_count(&self) -> usize {
        self.constraint.len()
    }

    /// Working space for one dragger.
    #[must_use]
    pub fn scratch(&self) -> HandleScratch {
        HandleScratch::default()
    }

    /// Drags every handle to its target; `positions` (#vertices) is overwritten. Handles are met to rounding, every
    /// triangle is positive.
    ///
    /// Begins where the last drag with this `scratch` ended. Cost an iteration: O(#triangles + #vertices #handles) and two
    /// triangular solves.
    ///
    /// # Errors
    /// [`HandleError`] if a target is no place, two coincide, or nothing but an inverted shape meets them; the scratch then
    /// begins anew.
    pub fn drag(
        &self,
        targets: &[Point],
        scratch: &mut HandleScratch,
        positions: &mut Vec<Point>,
    ) -> Result<DragReport, HandleError> {
        self.check_targets(targets)?;
        let shape = self.shape.as_ref();
        let mut fallbacks: Vec<Vec<Point>> = Vec::new();
        let outcome = if scratch.last.len() == shape.rest().len() {
            positions.clone_from(&scratch.last);
            descent::minimise(
                shape,
                &self.constraint,
                targets,
                (Beginning::Onwards, &self.options),
                positions,
                &mut scratch.descent,
            )?
        } else {
            let conformal = self.conformal.map(shape, targets)?;
            let rigid = shape.rigid_motion(self.constraint.places(), targets);
            let mut best: Option<(descent::Outcome, Vec<Point>)> = None;
            let mut iterations = 0;
            for beginning in [&conformal, &rigid] {
                let mut reached = beginning.clone();
                let outcome = descent::minimise(
                    shape,
                    &self.constraint,
                    targets,
                    (Beginning::Anew, &self.options),
                    &mut reached,
                    &mut scratch.descent,
                )?;
                iterations += outcome.iterations;
                let rank = |o: &descent::Outcome| (o.smallest_share < FLATTEST, o.energy);
                let is_better = best.as_ref().is_none_or(|(other, _)| {
                    let (mine, theirs) = (rank(&outcome), rank(other));
                    mine.0.cmp(&theirs.0).then(mine.1.total_cmp(&theirs.1)).is_lt()
                });
                if is_better {
                    best = Some((outcome, reached));
                }
            }
            let (mut outcome, reached) = best.ok_or(HandleError::NoHandle)?;
            outcome.iterations = iterations;
            scratch.descent.forget();
            *positions = reached;
            fallbacks = vec![conformal, rigid];
            outcome
        };
        let mut report = DragReport {
            iterations: outcome.iterations,
            last_motion: outcome.last_motion,
            energy: outcome.energy / shape.area(),
            repair: Repair::NotNeeded,
        };
        if outcome.smallest_share < FLATTEST {
            if fallbacks.is_empty() {
                fallbacks = vec![
                    scratch.last.clone(),
                    self.conformal.map(shape, targets)?,
                    shape.rigid_motion(self.constraint.places(), targets),
                ];
            }
            scratch.forget();
            let steps = barrier::repair(shape, &self.constraint, targets, &fallbacks, positions)?;
            report.energy = shape.energy(positions) / shape.area();
            report.repair = Repair::Done { steps };
        }
        scratch.last.clone_from(positions);
        Ok(report)
    }

    fn check_targets(&self, targets: &[Point]) -> Result<(), HandleError> {
        if targets.len() != self.handle_count() {
            return Err(HandleError::WrongCount {
                found: targets.len(),
                handles: self.handle_count(),
            });
        }
        let limit = crate::outline::Ring::LARGEST_COORDINATE;
        for (handle, target) in targets.iter().enumerate() {
            if !(point::is_finite(*target) && target.x.abs() <= limit && target.y.abs() <= limit) {
                return Err(HandleError::BadPlace {
                    handle,
                    x: target.x,
                    y: target.y,
                });
            }
            let is_same = |other: &Point| (other - target).norm() <= COINCIDENT * self.shape.size();
            if let Some(first) = targets[..handle].iter().position(is_same) {
                return Err(HandleError::TargetsCoincide { first, second: handle });
            }
        }
        Ok(())
    }
}
