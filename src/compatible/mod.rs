//! Compatible simplification and triangulation.
//!
//! [`simplify`] makes polygons of outlines, [`triangulate`] a mesh of polygons, [`refine`] a better mesh of a mesh. Each
//! can be used by itself:
//!
//! ```
//! use inbetween::{compatible::{RefineOptions, refine, triangulate}, math::Point, outline::{Outline, Ring}};
//! let rectangle = |width: f64| -> Result<Outline, Box<dyn std::error::Error>> {
//!     let corners = [[0.0, 0.0], [width, 0.0], [width, 1.0], [0.0, 1.0]];
//!     Ok(Outline::new(Ring::new(corners.map(Point::from))?, vec![])?)
//! };
//! let (bare, _) = triangulate(&[rectangle(1.0)?, rectangle(2.0)?], &[])?;
//! assert_eq!(bare.topology.triangles().len(), 2);
//! let mut options = RefineOptions::default();
//! options.edge_length = 0.1;
//! let (mesh, report) = refine(&bare, &options)?;
//! assert_eq!(mesh.topology.vertex_count(), 4 + report.splits);
//! assert!(report.low_angle_deg > 12.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod editable;
mod refine;
mod simplify;
mod triangulate;

pub(crate) use refine::follow;
pub use refine::{Guide, RefineError, RefineOptions, RefineReport, refine, refine_guided};
pub(crate) use simplify::SimplifiedAlone;
pub use simplify::{RingPoint, Simplification, Simplified, SimplifyError, SimplifyOptions, SimplifyReport, simplify};
pub use triangulate::{
    Effort, Feature, FeaturePath, Features, PathEnd, TriangulateError, TriangulateReport, triangulate,
    triangulate_features,
};

use crate::math::Point;
use crate::mesh::{Topology, geometry};

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

impl CompatibleMesh {
    /// Whether it has fewer Steiner points than another mesh of the same outlines, or as many and less area.
    #[must_use]
    pub fn is_sparer_than(&self, other: &Self) -> bool {
        let area = |mesh: &Self, pose: usize| -> f64 {
            let corners = |t: &[usize; 3]| geometry::corners(&mesh.positions[pose], *t);
            let triangles = mesh.topology.triangles().iter();
            triangles.map(|t| geometry::signed_area(corners(t))).sum()
        };
        let poses = 0..self.positions.len().min(other.positions.len());
        let growth: f64 = poses.map(|pose| area(self, pose) / area(other, pose) - 1.0).sum();
        self.steiner < other.steiner || (self.steiner == other.steiner && growth < 0.0)
    }
}
