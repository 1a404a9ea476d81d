//! What every stage of the mapping has to say.

use super::DeformedPose;
use super::note::Note;
use crate::compatible::{RefineReport, SimplifyReport, TriangulateReport};
use crate::matching::MatchReport;
use crate::pose::{MeshQuality, PlacedLandmark};
use crate::registration::Explained;

/// A stage of [`map_layer`](super::map_layer).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Stage {
    /// Which point of every outline corresponds to which; meanwhile each outline is simplified alone.
    Matching,
    /// Polygons with corresponding vertices.
    Simplification,
    /// One triangulation of the polygons.
    Triangulation,
    /// More vertices and better triangles.
    Refinement,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Matching => "matching",
            Self::Simplification => "simplification",
            Self::Triangulation => "triangulation",
            Self::Refinement => "refinement",
        })
    }
}

/// How a mapping came about: the report of every stage.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct MappingReport {
    /// What the artist should know.
    pub notes: Vec<Note>,
    /// How the outer rings were matched. The numbers in [`PoseMatch::landmarks`](crate::matching::PoseMatch::landmarks)
    /// are places in `landmarks`.
    pub matching: MatchReport,
    /// By pose, how much of what the reference shows is found in its drawing; `None` for the reference, for deformed copies, and where
    /// nothing is drawn inside the outlines.
    pub explained: Vec<Option<Explained>>,
    /// How the holes were matched, one report a hole.
    pub holes: Vec<MatchReport>,
    /// The landmarks on every pose: those on the outline, then those inside, then lines.
    pub landmarks: Vec<PlacedLandmark>,
    /// Poses that are deformed copies of others, in order. They are not matched: their cost is 0.
    pub deformed: Vec<DeformedPose>,
    /// Corresponding vertices before and after, and how well the polygons of the drawn poses fit.
    pub simplification: SimplifyReport,
    /// Steiner vertices by the way they were found.
    pub triangulation: TriangulateReport,
    /// What the refinement changed.
    pub refinement: RefineReport,
    /// Angles and stretches of the finished mesh.
    pub quality: MeshQuality,
}
