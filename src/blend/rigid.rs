//! The blend itself: everything that does not depend on the weights is computed once.
//!
//! Built in about O(#vertices^1.5 + #poses #triangles); a frame costs O(#poses #triangles) and one pass forth and back
//! over the factor. A [`RigidBlend`] is read-only after it is built: threads share one, each with its own
//! [`BlendScratch`].

use super::anchor::Anchors;
use super::guard::{Guard, GuardScratch, START_FRACTIONS};
use super::maps::TriangleMaps;
use super::reference::reference_edges;
use super::region::Paint;
use super::system::System;
use super::targets::Targets;
use super::{BlendError, BlendOptions, FrameGuard, Stretch};
use crate::math::{Point, limit_weights, predicate};
use crate::mesh::{Topology, geometry};
use crate::pose::PoseSet;

/// How far from 1 weights may sum; they are then scaled to sum 1.
pub const WEIGHT_SUM_TOLERANCE: f64 = 1e-6;

/// N poses, ready to be blended with any weights.
///
/// ```
/// use inbetween::blend::{BlendOptions, RigidBlend};
/// use inbetween::math::Point;
/// use inbetween::mesh::Topology;
/// use inbetween::pose::PoseSet;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let topology = Topology::new(3, vec![[0, 1, 2]])?;
/// let flat = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]].map(Point::from).to_vec();
/// let upright = [[0.0, 0.0], [0.0, 2.0], [-1.0, 0.0]].map(Point::from).to_vec();
/// let poses = PoseSet::new(topology, vec![("flat".into(), flat), ("upright".into(), upright)])?;
///
/// let blend = RigidBlend::new(&poses, &BlendOptions::default())?;
/// let mut half = Vec::new();
/// let report = blend.blend(&[0.5, 0.5], &mut blend.scratch(), &mut half)?;
/// assert_eq!(report.flipped, 0);
/// // Half way it is turned by 45 degrees and has kept its size.
/// assert!(((half[1] - half[0]).norm() - 2.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct RigidBlend {
    topology: Topology,
    pose_count: usize,
    stretch: Stretch,
    targets: Targets,
    system: System,
    anchors: Anchors,
    guard: Option<Guard>,
    ambiguous_turns: bool,
}

/// Working space of one thread. See [`RigidBlend::scratch`].
#[derive(Debug, Clone, Default)]
pub struct BlendScratch {
    weights: Vec<f64>,
    stretch_weights: Vec<f64>,
    right: Vec<[f64; 2]>,
    guard: GuardScratch,
}

/// What there is to say about a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct BlendReport {
    /// Triangles that are not positive.
    pub flipped: usize,
    /// Whether the guard has changed the frame ([`FrameGuard::Repair`]).
    pub repaired: bool,
}

/// One blend of `poses`, for those who need no second.
///
/// # Errors
/// As [`RigidBlend::new`] and [`RigidBlend::blend`].
pub fn blend_once(poses: &PoseSet, options: &BlendOptions, weights: &[f64]) -> Result<Vec<Point>, BlendError> {
    let blend = RigidBlend::new(poses, options)?;
    let mut positions = Vec::new();
    blend.blend(weights, &mut blend.scratch(), &mut positions)?;
    Ok(positions)
}

impl BlendReport {
    /// Both together.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            flipped: self.flipped + other.flipped,
            repaired: self.repaired || other.repaired,
        }
    }
}

impl RigidBlend {
    /// Prepares the blend of `poses`.
    ///
    /// # Errors
    /// [`BlendError`] if a pose has a triangle that is not positive, the rotations do not close, or the options name a
    /// pose or vertex that is not there.
    pub fn new(poses: &PoseSet, options: &BlendOptions) -> Result<Self, BlendError> {
        if !options.turns.is_empty() && options.turns.len() != poses.len() {
            return Err(BlendError::WrongCount {
                what: "turns",
                found: options.turns.len(),
                poses: poses.len(),
            });
        }
        check_positive(poses)?;
        let topology = poses.topology();
        let reference = reference_edges(poses, options.reference)?;
        let areas: Vec<f64> = reference.iter().map(|edges| 0.5 * edges.determinant()).collect();
        let anchors = Anchors::new(poses, &areas, &options.anchor)?;
        let paint = Paint::new(poses, &options.regions)?;
        let maps = TriangleMaps::new(poses, options, &reference, &areas, &topology.components())?;
        let system = System::new(topology, &reference, &areas, &paint.stiffness, &anchors)?;
        let guard = match options.guard {
            FrameGuard::Off => None,
            FrameGuard::Repair => Some(Guard::new(
                poses,
                &reference,
                &areas,
                &paint.stiffness,
                anchors.stiffnesses().collect(),
            )?),
        };
        Ok(Self {
            topology: topology.clone(),
            pose_count: poses.len(),
            stretch: options.stretch,
            targets: Targets::new(&maps, options.stretch, &paint.limits),
            system,
            anchors,
            guard,
            ambiguous_turns: maps.ambiguous_turns,
        })
    }

    /// How many poses, and so weights.
    #[must_use]
    pub fn pose_count(&self) -> usize {
        self.pose_count
    }

    /// How many vertices a frame has.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.topology.vertex_count()
    }

    /// How many anchors [`Self::blend_anchored`] can move: the soft ones, or one for each connected piece of the mesh.
    #[must_use]
    pub fn anchor_count(&self) -> usize {
        self.anchors.count()
    }

    /// Entries of the factor: a frame reads each twice, at 12 bytes.
    #[must_use]
    pub fn factor_entry_count(&self) -> usize {
        self.system.factor_entry_count()
    }

    /// Whether some pose could as well turn the other way round: then `turns` should say which way is meant.
    #[must_use]
    pub fn turns_are_ambiguous(&self) -> bool {
        self.ambiguous_turns
    }

    /// The rotation of each triangle of `pose` against its reference, in radians, as blended. Only differences between
    /// poses mean something. Nothing if there is no such pose.
    pub fn angles_rad(&self, pose: usize) -> impl Iterator<Item = f64> + '_ {
        let count = if pose < self.pose_count {
            self.topology.triangles().len()
        } else {
            0
        };
        (0..count).map(move |triangle| self.targets.angle_rad(triangle, pose))
    }

    /// Working space for one thread, large enough for all frames: with it, and with positions that have held a frame
    /// before, a frame allocates nothing.
    #[must_use]
    pub fn scratch(&self) -> BlendScratch {
        BlendScratch {
            weights: Vec::with_capacity(self.pose_count),
            stretch_weights: Vec::with_capacity(self.pose_count),
            right: vec![[0.0; 2]; self.system.right_len()],
            guard: GuardScratch::default(),
        }
    }

    /// Blends: `positions` (#vertices) is overwritten.
    ///
    /// # Errors
    /// [`BlendError`] if the weights are not #poses finite numbers that sum to 1 within [`WEIGHT_SUM_TOLERANCE`], or
    /// the result overflows.
    pub fn blend(
        &self,
        weights: &[f64],
        scratch: &mut BlendScratch,
        positions: &mut Vec<Point>,
    ) -> Result<BlendReport, BlendError> {
        self.blend_anchored(weights, &[], scratch, positions)
    }

    /// Blends with anchors moved for this frame: `anchors[k]` is where anchor `k` is wanted, `None` (and what is
    /// missing) where the weights put it. `positions` (#vertices) is overwritten.
    ///
    /// # Errors
    /// As [`Self::blend`], and if there are more than [`Self::anchor_count`] anchors.
    pub fn blend_anchored(
        &self,
        weights: &[f64],
        anchors: &[Option<Point>],
        scratch: &mut BlendScratch,
        positions: &mut Vec<Point>,
    ) -> Result<BlendReport, BlendError> {
        positions.resize(self.topology.vertex_count(), Point::zeros());
        if anchors.len() > self.anchors.count() {
            return Err(BlendError::WrongCount {
                what: "anchors",
                found: anchors.len(),
                poses: self.pose_count,
            });
        }
        self.normalise(weights, scratch)?;
        self.fit(anchors, scratch, positions)?;
        self.finish(anchors, scratch, positions)
    }

    /// The matrix and its factor.
    pub(super) fn system(&self) -> &System {
        &self.system
    }

    /// The least-squares frame for the normalised weights in `scratch`.
    fn fit(
        &self,
        anchors: &[Option<Point>],
        scratch: &mut BlendScratch,
        positions: &mut [Point],
    ) -> Result<(), BlendError> {
        // Taken out so that the scratch can be lent on; a vector that is moved is not allocated again.
        let mut right = std::mem::take(&mut scratch.right);
        right.clear();
        right.resize(self.system.right_len(), [0.0; 2]);
        self.assemble(anchors, scratch, &mut right, 0);
        let solved = self.system.solve(&mut right);
        for (position, &place) in positions.iter_mut().zip(self.system.solved(&right)) {
            *position = Point::from(place);
        }
        scratch.right = right;
        solved
    }

    /// Puts solved positions in place, for the normalised weights in `scratch`, looks at them, and repairs what has to be.
    pub(super) fn finish(
        &self,
        anchors: &[Option<Point>],
        scratch: &mut BlendScratch,
        positions: &mut [Point],
    ) -> Result<BlendReport, BlendError> {
        self.anchors.place(&scratch.weights, anchors, positions);
        let Some(guard) = &self.guard else {
            let flipped = self.count_flipped(positions)?;
            return Ok(BlendReport {
                flipped,
                repaired: false,
            });
        };
        if guard.all_healthy(positions) {
            return Ok(BlendReport::default());
        }
        let flipped = self.count_flipped(positions)?;
        let weights = scratch.weights.clone();
        scratch.guard.set_wanted(positions);
        let repaired = self.find_valid(guard, &weights, anchors, scratch, positions)?;
        if repaired {
            guard.search(&self.system, &mut scratch.guard, positions)?;
            self.anchors.place(&weights, anchors, positions);
        } else {
            positions.copy_from_slice(scratch.guard.wanted());
        }
        Ok(BlendReport {
            flipped: if repaired {
                self.count_flipped(positions)?
            } else {
                flipped
            },
            repaired,
        })
    }

    /// Finds a frame without inverted triangles between the pose with the largest weight and `weights`. There is none
    /// only if a pose has triangles so thin that a blend of that pose alone rounds them over.
    fn find_valid(
        &self,
        guard: &Guard,
        weights: &[f64],
        anchors: &[Option<Point>],
        scratch: &mut BlendScratch,
        positions: &mut [Point],
    ) -> Result<bool, BlendError> {
        // The first of the largest: a rule that knows no earlier frame.
        let heaviest = (0..weights.len())
            .rev()
            .max_by(|&a, &b| weights[a].total_cmp(&weights[b]));
        for fraction in START_FRACTIONS {
            scratch.weights.clear();
            scratch.weights.extend(weights.iter().enumerate().map(|(pose, weight)| {
                let of_pose = if Some(pose) == heaviest { 1.0 - fraction } else { 0.0 };
                of_pose + fraction * weight
            }));
            self.fit(anchors, scratch, positions)?;
            if guard.is_valid(positions) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Adds the right-hand side for the normalised weights in `scratch` to the columns of `frame` in `right`.
    pub(super) fn assemble<const K: usize>(
        &self,
        anchors: &[Option<Point>],
        scratch: &mut BlendScratch,
        right: &mut [[f64; K]],
        frame: usize,
    ) {
        match self.stretch {
            Stretch::Limited => limit_weights(&scratch.weights, &mut scratch.stretch_weights),
            Stretch::Linear | Stretch::Log => scratch.stretch_weights.clone_from(&scratch.weights),
        }
        self.system.assemble(
            &self.targets,
            &scratch.weights,
            &scratch.stretch_weights,
            self.anchors.pulls(&scratch.weights, anchors),
            right,
            frame,
        );
    }

    /// Checks weights, and puts them into `scratch` so that they sum to 1.
    pub(super) fn normalise(&self, weights: &[f64], scratch: &mut BlendScratch) -> Result<(), BlendError> {
        if weights.len() != self.pose_count {
            return Err(BlendError::WrongCount {
                what: "weights",
                found: weights.len(),
                poses: self.pose_count,
            });
        }
        let sum: f64 = weights.iter().sum();
        // NaN does not sum to 1 either.
        let sums_to_one = (sum - 1.0).abs() <= WEIGHT_SUM_TOLERANCE;
        if !sums_to_one {
            return Err(BlendError::BadWeights { sum });
        }
        scratch.weights.clear();
        scratch.weights.extend(weights.iter().map(|weight| weight / sum));
        Ok(())
    }

    /// How many triangles are not positive. One pass; exact arithmetic only where rounding could decide.
    ///
    /// # Errors
    /// [`BlendError::NotFinite`] if a position is not finite.
    fn count_flipped(&self, positions: &[Point]) -> Result<usize, BlendError> {
        let mut flipped = 0;
        for &triangle in self.topology.triangles() {
            let [a, b, c] = geometry::corners(positions, triangle);
            if predicate::surely_above(a, b, c, 0.0) {
                continue;
            }
            if ![a, b, c].into_iter().all(crate::math::point::is_finite) {
                return Err(BlendError::NotFinite);
            }
            flipped += usize::from(!predicate::is_positive(a, b, c));
        }
        Ok(flipped)
    }
}

fn check_positive(poses: &PoseSet) -> Result<(), BlendError> {
    for (name, positions) in poses.names().iter().zip(poses.positions()) {
        let inverted = poses.topology().triangles().iter().position(|&triangle| {
            let corners = geometry::corners(positions, triangle);
            // An area that is positive exactly but not in floating point cannot be inverted either.
            let [a, b, c] = corners;
            !(geometry::signed_area(corners) > 0.0 && predicate::is_positive(a, b, c))
        });
        if let Some(triangle) = inverted {
            return Err(BlendError::NotPositive {
                pose: name.clone(),
                triangle,
            });
        }
    }
    Ok(())
}
