//! Compatible simplification and triangulation.

mod editable;
mod refine;
mod simplify;
mod triangulate;

pub use refine::{RefineError, RefineOptions, RefineReport, refine};
pub use simplify::{Simplified, SimplifyError, SimplifyOptions, SimplifyReport, simplify};
pub use triangulate::{
    Feature, FeaturePath, Features, PathEnd, TriangulateError, TriangulateReport, triangulate, triangulate_features,
};

use crate::math::Point;
use crate::mesh::Topology;

/// A compatible triangulation: one topology embedded in N poses.
#[derive(Debug, Clone, PartialEq)]
pub struct CompatibleMesh {
    /// The triangles, positive in every pose.
    pub topology: Topology,
    /// The vertices' places: #poses x #vertices.
    pub positions: Vec<Vec<Point>>,
    /// The boundary as vertex indices: outer ring first, then holes.
    pub rings: Vec<Vec<usize>>,
    /// The vertices of interior landmarks, in the order given.
    pub landmarks: Vec<usize>,
    /// The vertices along each path, in the order given: every two successive ones are joined by an edge.
    pub paths: Vec<Vec<usize>>,
    /// Interior vertices that the triangulation itself had to add.
    pub steiner: usize,
}
