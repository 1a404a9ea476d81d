//! The blend itself: everything that does not depend on the weights is computed once.
//!
//! Built in about O(#vertices^1.5 + #poses #triangles); a frame costs O(#poses #triangles) and one pass forth and back
//! over the factor. A [`RigidBlend`] is read-only after it is built: threads share one, each with its own
//! [`BlendScratch`].

use super::anchor::Anchors;
use super::maps::TriangleMaps;
use super::reference::reference_edges;
use super::region::Paint;
use super::system::System;
use super::targets::Targets;
use super::{BlendError, BlendOptions, Stretch};
use crate::math::{Point, limit_weights, predicate};
use crate::mesh::{Topology, geometry};
use crate::pose::PoseSet;

/// How far from 1 weights may sum; they are then scaled to sum 1.
pub const WEIGHT_SUM_TOLERANCE: f64 = 1e-6;

/// A double-precision cross product of differences is wrong by at most this fraction of the sizes of its two terms
/// (Shewchuk 1997): above it the sign is certain.
const CROSS_ERROR: f64 = 4.0 * f64::EPSILON;

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
    ambiguous_turns: bool,
}

/// Working space of one thread. See [`RigidBlend::scratch`].
#[derive(Debug, Clone, Default)]
pub struct BlendScratch {
    weights: Vec<f64>,
    stretch_weights: Vec<f64>,
    right: Vec<[f64; 2]>,
}

/// What there is to say about a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct BlendReport {
    /// Triangles that are not positive.
    pub flipped: usize,
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
        Ok(Self {
            topology: topology.clone(),
            pose_count: poses.len(),
            stretch: options.stretch,
            targets: Targets::new(&maps, options.stretch, &paint.limits),
            system: System::new(topology, &reference, &areas, &paint.stiffness, &anchors)?,
            anchors,
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
        self.assemble(weights, anchors, scratch)?;
        self.system.solve(&mut scratch.right)?;
        for (position, &solved) in positions.iter_mut().zip(self.system.solved(&scratch.right)) {
            *position = Point::from(solved);
        }
        self.anchors.place(&scratch.weights, anchors, positions);
        let flipped = self.count_flipped(positions)?;
        Ok(BlendReport { flipped })
    }

    /// Checks the weights, and puts the right-hand side together in the scratch.
    fn assemble(
        &self,
        weights: &[f64],
        anchors: &[Option<Point>],
        scratch: &mut BlendScratch,
    ) -> Result<(), BlendError> {
        self.normalise(weights, &mut scratch.weights)?;
        match self.stretch {
            Stretch::Limited => limit_weights(&scratch.weights, &mut scratch.stretch_weights),
            Stretch::Linear | Stretch::Log => scratch.stretch_weights.clone_from(&scratch.weights),
        }
        scratch.right.resize(self.system.right_len(), [0.0; 2]);
        self.system.assemble(
            &self.targets,
            &scratch.weights,
            &scratch.stretch_weights,
            self.anchors.pulls(&scratch.weights, anchors),
            &mut scratch.right,
        );
        Ok(())
    }

    fn normalise(&self, weights: &[f64], normalised: &mut Vec<f64>) -> Result<(), BlendError> {
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
        normalised.clear();
        normalised.extend(weights.iter().map(|weight| weight / sum));
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
            let (left, right) = ((b.x - a.x) * (c.y - a.y), (b.y - a.y) * (c.x - a.x));
            // A comparison with NaN is false, and so is one with infinity.
            if left - right > CROSS_ERROR * (left.abs() + right.abs()) {
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
