//! Compatible simplification and triangulation.

mod editable;
mod refine;
mod simplify;
mod triangulate;

pub use refine::{RefineError, RefineOptions, RefineReport, refine};
pub use simplify::{Simplified, SimplifyError, SimplifyOptions, SimplifyReport, simplify};
pub use triangulate::{TriangulateError, TriangulateReport, triangulate};

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
    /// Interior vertices that the triangulation itself had to add.
    pub steiner: usize,
}
