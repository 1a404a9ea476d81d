//! Compatible triangulation: N simple polygons with corresponding vertices get one triangulation.
//!
//! Input: N outlines with equal vertex counts; output: one topology with N embeddings, whose boundary is the polygons,
//! vertex by vertex. Source: NWM 3.1 "Compatible triangulation", after Baxter, Barla, Anjyo (2008); the last resort
//! after Aronov, Seidel, Souvaine, "On compatible triangulations of simple polygons" (1993).
//!
//! What is to be met inside ([`features`]) may divide the polygons ([`regions`]); holes and all else that lies inside a
//! region are first joined to the walk around it by bridges ([`bridge`]). A piece is a list of corresponding vertices that
//! bound a simple polygon (weakly simple along bridges) in every pose. Each piece ([`division`]) is
//! 1. triangulated with diagonals that have line of sight in all poses, or divided by those that leave the least to
//!    Steiner points ([`line_of_sight`]); what has none left is
//! 2. divided by a Steiner point that several vertices see in all poses ([`single_steiner`]), or
//! 3. divided by a path of several Steiner points ([`link_path`], of a large piece [`halving_path`]), or, if no such
//!    path shrinks it,
//! 4. triangulated as the overlay of the poses' own triangulations on a convex polygon ([`chord_overlay`]), which
//!    always exists.
//!
//! At the end Steiner points that are not needed are taken out again ([`decimate`]), and small patches are solved anew
//! with fewer ([`patch`]).
//!
//! Differences from the paper: stage 1 chooses its diagonals by dynamic programming instead of taking the first found;
//! stage 2 joins its point to all vertices it can see, not to two; a partition has to shrink every part, which the
//! paper does not ask for and without which it may not end; stage 4, the decimation and the patches are not in the paper.
//!
//! Guarantee: every triangle is positive in every pose by an exact predicate. Cost: quadratic in the vertices for
//! visibility; cubic within pieces of at most 256 vertices for diagonals and for Steiner points; a fixed amount of work for
//! the patches.

mod bridge;
mod bridge_path;
mod chord_overlay;
mod convex;
mod decimate;
mod division;
mod ear_clipping;
mod features;
mod free_space;
mod halving_path;
mod in_sight;
mod joining;
mod line_of_sight;
mod link_path;
mod patch;
mod regions;
mod sights;
mod single_steiner;
mod visibility;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_holes;
#[cfg(test)]
mod tests_paths;

pub use features::{Feature, FeaturePath, Features, PathEnd};

use super::CompatibleMesh;
use super::editable::{Curves, EditableMesh};
use crate::math::Point;
use crate::mesh::TopologyError;
use crate::outline::Outline;
use division::Division;
use patch::Kept;

/// Steiner points by the stage that added them, and how many were taken out again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct TriangulateReport {
    /// Added on bridges to holes, landmarks and paths.
    pub bridge: usize,
    /// Added as hubs of a star or partition (stage 2).
    pub single: usize,
    /// Added on link paths (stage 3).
    pub link: usize,
    /// Added by chord overlays (stage 4).
    pub overlay: usize,
    /// Taken out by the decimation.
    pub decimated: usize,
}

/// Why polygons could not be triangulated compatibly.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangulateError {
    /// There is no polygon.
    #[error("compatible triangulation needs at least one polygon")]
    NoPose,
    /// Vertex counts differ.
    #[error(
        "ring {ring} of pose {pose} has {found} vertices, in pose 0 it has {expected}; corresponding rings need equal counts"
    )]
    CountsDiffer {
        /// Which pose.
        pose: usize,
        /// Which ring; 0 is the outer one.
        ring: usize,
        /// Its vertices, or 0 for a missing ring.
        found: usize,
        /// Vertices of the same ring in pose 0.
        expected: usize,
    },
    /// A feature is not inside its polygon, or has not one place a pose.
    #[error("{feature} is not inside the polygon of pose {pose}")]
    FeatureOutside {
        /// Which feature.
        feature: Feature,
        /// Which pose.
        pose: usize,
    },
    /// Two features touch, or a path touches itself.
    #[error("{first} meets {second} in pose {pose}; draw them apart")]
    FeaturesMeet {
        /// A feature.
        first: Feature,
        /// The other; the same for a path that touches itself.
        second: Feature,
        /// Which pose.
        pose: usize,
    },
    /// A path has no edge, or an end at no vertex of the polygons.
    #[error("path {path} needs two different points at least, and ends inside or on vertices of the polygons")]
    PathShort {
        /// Which path.
        path: usize,
    },
    /// A hole, landmark or path lies on different sides of a path.
    #[error(
        "pose {pose} has something on the other side of path {path} than pose 0; let the same things lie on each side"
    )]
    PathSides {
        /// Which path.
        path: usize,
        /// Which pose.
        pose: usize,
    },
    /// A corridor of a polygon is so narrow that no valid mesh was found in double precision.
    #[error(
        "the polygons are too narrow to be meshed in double precision near ({x:.6}, {y:.6}) in pose {pose}; widen the drawing there"
    )]
    TooNarrow {
        /// A pose where it shows.
        pose: usize,
        /// A vertex of the piece that failed.
        x: f64,
        /// A vertex of the piece that failed.
        y: f64,
    },
    /// The result is no surface; reported rather than handed on.
    #[error("the triangulation is no surface: {0}")]
    Topology(#[from] TopologyError),
}

impl From<sights::Narrow> for TriangulateError {
    fn from(narrow: sights::Narrow) -> Self {
        Self::TooNarrow {
            pose: narrow.pose,
            x: narrow.place.x,
            y: narrow.place.y,
        }
    }
}

/// Triangulates N polygons compatibly, with a vertex at each interior landmark.
///
/// `landmarks` are points inside the polygons: #landmarks x #poses; see [`triangulate_features`].
///
/// # Examples
/// ```
/// use inbetween::{compatible::triangulate, math::Point, outline::{Outline, Ring}};
/// let polygon = |corners: [[f64; 2]; 4]| -> Result<Outline, Box<dyn std::error::Error>> {
///     Ok(Outline::new(Ring::new(corners.map(Point::from))?, vec![])?)
/// };
/// // The first is reflex at its last corner, the second at its first: they have no diagonal in common.
/// let poses = [
///     polygon([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 1.0]])?,
///     polygon([[1.0, 3.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]])?,
/// ];
/// let (mesh, report) = triangulate(&poses, &[])?;
/// assert!(mesh.steiner > 0 && mesh.positions.len() == 2);
/// assert_eq!(mesh.steiner, report.single + report.link + report.overlay - report.decimated);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`triangulate_features`].
pub fn triangulate(
    polygons: &[Outline],
    landmarks: &[Vec<Point>],
) -> Result<(CompatibleMesh, TriangulateReport), TriangulateError> {
    let features = Features {
        points: landmarks.to_vec(),
        paths: Vec::new(),
    };
    triangulate_features(polygons, &features, Effort::Full)
}

/// How much is searched for fewer Steiner points once there is a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Effort {
    /// About a second at most.
    #[default]
    Full,
    /// A fortieth of it, to compare polygons by how many points they will need.
    Sketch,
}

/// What a sketch does of the search: one part in so many.
const SKETCHED: usize = 40;

/// Triangulates N polygons compatibly, with a vertex at each point and a chain of edges along each path of `features`.
///
/// Vertex `k` of ring `r` is vertex `k` of the mesh plus the lengths of the rings before; then follow the points, the
/// points of the paths, and Steiner points.
///
/// # Errors
/// [`TriangulateError`] if the polygons do not correspond, a feature is outside or meets another, poses disagree about
/// what lies beside a path, or a corridor is too narrow for double precision.
pub fn triangulate_features(
    polygons: &[Outline],
    features: &Features,
    effort: Effort,
) -> Result<(CompatibleMesh, TriangulateReport), TriangulateError> {
    let work = match effort {
        Effort::Full => patch::WORK,
        Effort::Sketch => patch::WORK / SKETCHED,
    };
    searched(polygons, features, work)
}

/// As [`triangulate_features`], with so much work at most for the search of [`patch`].
fn searched(
    polygons: &[Outline],
    features: &Features,
    work: usize,
) -> Result<(CompatibleMesh, TriangulateReport), TriangulateError> {
    let first = polygons.first().ok_or(TriangulateError::NoPose)?;
    for (pose, polygon) in polygons.iter().enumerate() {
        for ring in 0..first.rings().len().max(polygon.rings().len()) {
            let count = |outline: &Outline| outline.rings().get(ring).map_or(0, |r| r.len());
            let (found, expected) = (count(polygon), count(first));
            if found != expected {
                return Err(TriangulateError::CountsDiffer {
                    pose,
                    ring,
                    found,
                    expected,
                });
            }
        }
    }
    let mut rings: Vec<Vec<usize>> = Vec::new();
    let mut count = 0;
    for ring in first.rings() {
        rings.push((count..count + ring.len()).collect());
        count += ring.len();
    }
    let mut positions: Vec<Vec<Point>> = polygons
        .iter()
        .map(|polygon| polygon.rings().iter().flat_map(|ring| ring.points()).copied().collect())
        .collect();
    let numbered = features::number(features, &rings, &mut positions)?;
    features::check(polygons, &rings, &numbered, &positions)?;
    let mut division = Division::new(positions);
    for region in regions::regions(&rings, &numbered, &division.positions)? {
        let joined = bridge::join_islands(&mut division.positions, region.walk, region.islands)?;
        division.report.bridge += joined.steiner;
        division.solve(joined.walk)?;
    }

    let mut mesh = EditableMesh::new(division.positions, &division.triangles);
    let mut report = division.report;
    let along = |path: &Vec<usize>| {
        path.windows(2)
            .flat_map(|ends| [(ends[0], ends[1]), (ends[1], ends[0])])
            .collect::<Vec<_>>()
    };
    let kept = Kept {
        below: numbered.count,
        edges: numbered.paths.iter().flat_map(along).collect(),
    };
    report.decimated = decimate::decimate(&mut mesh, &kept, work);
    let steiner = report.bridge + report.single + report.link + report.overlay - report.decimated;
    let curves = Curves {
        rings,
        landmarks: numbered.points,
        paths: numbered.paths,
    };
    Ok((mesh.finish(&curves, steiner)?, report))
}
