//! The N-way mapping: what the pipeline makes of N drawings, and what every later stage starts from.

use super::PoseSet;
use super::overlaps::{OverlappingPose, Overlaps, undecided};
use crate::matching::Correspondence;
use crate::math::Point;
use crate::mesh::validity::{self, ValidityError};
use crate::outline::Outline;

/// How the outlines were put in correspondence.
#[derive(Debug, Clone, PartialEq)]
pub struct Matching {
    /// The pose whose outline is `B0` (NWM 3.1).
    pub reference: usize,
    /// The correspondence of the outer rings, in the arc-length parameters of the full-resolution outlines.
    pub outer: Correspondence,
}

/// One triangulation of N drawings.
///
/// Fields are public: a mapping may come from a file and is then proven by [`Mapping::check`].
#[derive(Debug, Clone, PartialEq)]
pub struct Mapping {
    /// The mesh with its N embeddings.
    pub poses: PoseSet,
    /// The full-resolution outline of each pose, as extracted.
    pub outlines: Vec<Outline>,
    /// The boundary as vertex indices: outer ring first, then holes.
    pub rings: Vec<Vec<usize>>,
    /// Interior vertices that the triangulation itself had to add, before refinement.
    pub steiner: usize,
    /// How the outlines correspond. In poses that lie over themselves part of the boundary is hidden: their parameters say little.
    pub matching: Matching,
    /// Where the mesh lies over itself.
    pub overlaps: Overlaps,
}

/// What is wrong with a mapping.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MappingError {
    /// The mesh is no embedding in some pose.
    #[error("pose '{pose}': {source}")]
    Pose {
        /// The pose's name.
        pose: String,
        /// The defect.
        source: ValidityError,
    },
    /// Parts of a pose lie over one another, and nothing says which is nearer.
    #[error("pose '{pose}': triangles {} and {} lie over one another and are equally near", triangles[0], triangles[1])]
    Undecided {
        /// The pose's name.
        pose: String,
        /// The triangles.
        triangles: [usize; 2],
    },
    /// Numbers of poses or holes disagree.
    #[error("{0}")]
    Counts(String),
    /// Part of an outline lies outside its mesh.
    #[error("pose '{pose}': outline point {point} at ({x:.6}, {y:.6}) lies {distance:.3e} outside the mesh")]
    NotEnclosed {
        /// The pose's name.
        pose: String,
        /// Which point of which ring, counted through all rings.
        point: usize,
        /// Its place.
        x: f64,
        /// Its place.
        y: f64,
        /// How far outside, in source units.
        distance: f64,
    },
}

impl Mapping {
    /// How far, as a fraction of a pose's diagonal, an outline point may lie outside its mesh: a merged vertex is the
    /// rounded intersection of two lines, so exact enclosure cannot be asked for.
    pub const ENCLOSURE_TOLERANCE: f64 = 1e-9;

    /// Proves the mapping valid: one topology, every triangle positive in every pose, simple boundaries equal to the
    /// stated rings, every outline point inside its mesh. Of poses that lie over themselves: positive triangles, the stated rings, and depths that
    /// tell which of two triangles is nearer wherever they lie over one another.
    ///
    /// # Errors
    /// The first defect found.
    pub fn check(&self) -> Result<(), MappingError> {
        if self.outlines.len() != self.poses.len() || self.matching.outer.pose_count() != self.poses.len() {
            return Err(MappingError::Counts(format!(
                "{} poses, but {} outlines and a matching of {}",
                self.poses.len(),
                self.outlines.len(),
                self.matching.outer.pose_count()
            )));
        }
        let triangles = self.poses.topology().triangles().len();
        let overlaps = &self.overlaps;
        let has_depths = |known: &OverlappingPose| known.depth.len() == triangles && known.pose < self.poses.len();
        let has_limbs = overlaps.limbs.is_empty() || overlaps.triangle_limb.len() == triangles;
        if !has_limbs || !overlaps.poses.iter().all(has_depths) {
            return Err(MappingError::Counts(format!(
                "the mesh has {triangles} triangles, but there are not as many depths or limbs"
            )));
        }
        let named = self.poses.names().iter().zip(self.poses.positions());
        for (pose, ((name, positions), outline)) in named.zip(&self.outlines).enumerate() {
            if let Some(depth) = overlaps.depth(pose) {
                self.check_overlapping(name, positions, depth)?;
                continue;
            }
            if outline.rings().len() != self.rings.len() {
                return Err(MappingError::Counts(format!(
                    "pose '{name}' has {} holes, the mesh {}",
                    outline.holes().len(),
                    self.rings.len().saturating_sub(1)
                )));
            }
            validity::check_embedding(self.poses.topology(), positions, &self.rings).map_err(|source| {
                MappingError::Pose {
                    pose: name.clone(),
                    source,
                }
            })?;
            self.check_enclosure(name, positions, outline)?;
        }
        Ok(())
    }

    fn check_overlapping(&self, name: &str, positions: &[Point], depth: &[f64]) -> Result<(), MappingError> {
        let topology = self.poses.topology();
        validity::check_immersion(topology, positions, &self.rings).map_err(|source| MappingError::Pose {
            pose: name.to_owned(),
            source,
        })?;
        match undecided(topology, positions, depth) {
            None => Ok(()),
            Some(triangles) => Err(MappingError::Undecided {
                pose: name.to_owned(),
                triangles,
            }),
        }
    }

    fn check_enclosure(&self, name: &str, positions: &[Point], outline: &Outline) -> Result<(), MappingError> {
        let locator = crate::mesh::PointLocator::new(self.poses.topology().triangles(), positions);
        let tolerance = Self::ENCLOSURE_TOLERANCE * outline.diagonal();
        let points = outline.rings().iter().flat_map(|ring| ring.points());
        for (point, p) in points.enumerate() {
            if locator.locate(*p).is_some() {
                continue;
            }
            let nearest = locator.bind(*p).map(|bound| bound.at(positions));
            let distance = nearest.map_or(f64::INFINITY, |q| (q - p).norm());
            if distance > tolerance {
                return Err(MappingError::NotEnclosed {
                    pose: name.to_owned(),
                    point,
                    x: p.x,
                    y: p.y,
                    distance,
                });
            }
        }
        Ok(())
    }
}
