//! Compatible triangulation: N simple polygons with corresponding vertices get one triangulation.
//!
//! Input: N outlines with equal vertex counts; output: one topology with N embeddings, whose boundary is the polygons,
//! vertex by vertex. Source: NWM 3.1 "Compatible triangulation", after Baxter, Barla, Anjyo (2008); the last resort
//! after Aronov, Seidel, Souvaine, "On compatible triangulations of simple polygons" (1993).
//!
//! Holes and interior landmarks are first joined to the outer ring by bridges ([`bridge`]). A piece is a list of corresponding vertices that
//! bound a simple polygon (weakly simple along bridges) in every pose. Each piece ([`division`]) is
//! 1. triangulated with diagonals that have line of sight in all poses, or divided by those that leave the least to
//!    Steiner points ([`line_of_sight`]); what has none left is
//! 2. divided by a Steiner point that several vertices see in all poses ([`single_steiner`]), or
//! 3. divided by a path of several Steiner points ([`link_path`]), or, if no such path shrinks it,
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
mod chord_overlay;
mod convex;
mod decimate;
mod division;
mod ear_clipping;
mod line_of_sight;
mod link_path;
mod patch;
mod single_steiner;
mod visibility;

#[cfg(test)]
mod tests;

use super::CompatibleMesh;
use super::editable::EditableMesh;
use crate::math::Point;
use crate::mesh::TopologyError;
use crate::outline::Outline;
use division::Division;

/// Steiner points by the stage that added them, and how many were taken out again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct TriangulateReport {
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
    /// No hole can be joined to the rest by a segment that is inside every pose.
    #[error(
        "hole {hole} has no vertex that sees the same outline or hole vertex in every pose; fill the holes (holes = \"fill\") or move it"
    )]
    NoBridge {
        /// Which hole, from 0.
        hole: usize,
    },
    /// An interior landmark sees no vertex that it sees in every pose.
    #[error(
        "interior landmark {landmark} sees no outline vertex or other landmark that it sees in every pose; move it, or add a landmark between"
    )]
    LandmarkHidden {
        /// Which interior landmark.
        landmark: usize,
    },
    /// An interior landmark is not inside its polygon, or has not one place a pose.
    #[error("interior landmark {landmark} is not inside the polygon of pose {pose}")]
    LandmarkOutside {
        /// Which interior landmark.
        landmark: usize,
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

/// Triangulates N polygons compatibly, with a vertex at each interior landmark.
///
/// `landmarks` are points inside the polygons: #landmarks x #poses. Vertex `k` of ring `r` is vertex `k` of the mesh plus
/// the lengths of the rings before; the landmarks follow, then Steiner points.
///
/// # Errors
/// [`TriangulateError`] if the polygons do not correspond, a hole or a landmark cannot be joined, or a corridor is too
/// narrow for double precision.
pub fn triangulate(
    polygons: &[Outline],
    landmarks: &[Vec<Point>],
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
    for (landmark, places) in landmarks.iter().enumerate() {
        for (pose, polygon) in polygons.iter().enumerate() {
            if !places.get(pose).is_some_and(|&place| polygon.contains(place)) {
                return Err(TriangulateError::LandmarkOutside { landmark, pose });
            }
        }
    }
    let positions: Vec<Vec<Point>> = polygons
        .iter()
        .enumerate()
        .map(|(pose, polygon)| {
            let boundary = polygon.rings().iter().flat_map(|ring| ring.points()).copied();
            boundary.chain(landmarks.iter().map(|places| places[pose])).collect()
        })
        .collect();
    let mut rings: Vec<Vec<usize>> = Vec::new();
    let mut count = 0;
    for ring in first.rings() {
        rings.push((count..count + ring.len()).collect());
        count += ring.len();
    }
    let landmark_vertices: Vec<usize> = (count..count + landmarks.len()).collect();
    count += landmarks.len();
    // A landmark is joined like a hole of one vertex.
    let joined: Vec<Vec<usize>> = rings
        .iter()
        .cloned()
        .chain(landmark_vertices.iter().map(|&vertex| vec![vertex]))
        .collect();
    let walk = bridge::join_rings(&positions, &joined).map_err(|ring| match ring.checked_sub(rings.len()) {
        Some(landmark) => TriangulateError::LandmarkHidden { landmark },
        None => TriangulateError::NoBridge { hole: ring - 1 },
    })?;
    let mut division = Division::new(positions);
    division.solve(walk)?;

    let mut mesh = EditableMesh::new(division.positions, &division.triangles);
    let mut report = division.report;
    report.decimated = decimate::decimate(&mut mesh, count);
    let steiner = report.single + report.link + report.overlay - report.decimated;
    Ok((mesh.finish(&rings, &landmark_vertices, steiner)?, report))
}
