//! Refinement: a valid compatible triangulation becomes a good one.
//!
//! Input and output: a [`CompatibleMesh`]; the boundary curves, the interior landmarks and the
//! paths stay, point for point, but their edges may be split.
//! Source: NWM 3.1 (angle-based smoothing and compatible flips, after Surazsky and Gotsman 2004); the distortion step
//! is ours.
//!
//! 1. Edges are split, longest first, boundary edges too, until none is longer than asked in nearly any pose; after
//!    each halving of the length, edges are flipped and vertices smoothed ([`split`], [`flip`], [`smooth`]).
//! 2. After each halving, too, the interior vertices of every pose move so that the triangles differ as little as possible
//!    between poses while staying well shaped ([`distortion`]); flips follow.
//! 3. Where an angle is still small, the vertices around it move so that the smallest angle there grows ([`widen`]).
//!
//! Differences from the paper: it smooths and flips only. Splitting gives bending room to look rigid; minimising the
//! distortion makes interiors correspond well and not only validly.
//!
//! Guarantee: no step makes a triangle non-positive in any pose; each move is proven by an exact predicate before it is
//! taken. Cost: linear in vertices times poses for each sweep, a bounded number of sweeps. Limit: angles at the boundary
//! are bounded by the outlines' own spikes.

mod distortion;
mod flip;
mod follow;
mod guide;
mod smooth;
mod split;
mod star;
mod widen;

#[cfg(test)]
mod tests;

pub(crate) use follow::follow;
pub use guide::Guide;

use super::CompatibleMesh;
use super::editable::{Curves, EditableMesh};
use crate::math::point;
use crate::mesh::{TopologyError, geometry};
use star::Stars;

/// What the refinement aims for.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RefineOptions {
    /// Edges longer than this are split, as a fraction of the pose's diagonal, in the power mean over the poses with
    /// exponent 16: nearly in any. Default 0.05.
    pub edge_length: f64,
    /// Angles below this are widened where they can be, in degrees. Default 12.
    pub smallest_angle_deg: f64,
}

impl Default for RefineOptions {
    fn default() -> Self {
        Self {
            edge_length: 0.05,
            smallest_angle_deg: 12.0,
        }
    }
}

/// What a refinement reached.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RefineReport {
    /// Vertices added by splits.
    pub splits: usize,
    /// Edges flipped.
    pub flips: usize,
    /// The smallest angle of any triangle in any pose, in degrees.
    pub smallest_angle_deg: f64,
    /// The 5th percentile over the triangles of each one's smallest angle in any pose, in degrees.
    pub low_angle_deg: f64,
}

/// Why a mesh could not be refined.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RefineError {
    /// The edge length is not a positive number, or so small that the mesh would have millions of vertices.
    #[error("the edge length must be a fraction of the diagonal of at least {smallest}, got {given}", smallest = SMALLEST_EDGE_LENGTH)]
    BadEdgeLength {
        /// The value given.
        given: f64,
    },
    /// The result is no surface; reported rather than handed on.
    #[error("the refined mesh is no surface: {0}")]
    Topology(#[from] TopologyError),
}

/// Edge lengths below this would make meshes of a million vertices.
const SMALLEST_EDGE_LENGTH: f64 = 1e-3;

/// Sweeps of angle-based smoothing after each round of splits.
const SMOOTHING_SWEEPS: usize = 3;

/// Sweeps of distortion minimisation at each length, and how often flips come in between at the last.
const DISTORTION_SWEEPS: usize = 20;
const DISTORTION_ROUNDS: usize = 3;

/// Refines a compatible triangulation.
///
/// # Errors
/// [`RefineError`] if the edge length is out of range.
pub fn refine(mesh: &CompatibleMesh, options: &RefineOptions) -> Result<(CompatibleMesh, RefineReport), RefineError> {
    refine_guided(mesh, options, None)
}

/// As [`refine`]; inside, the poses follow `guide`, and vertices that split the boundary lie where it has them on their edges.
///
/// # Errors
/// As [`refine`].
pub fn refine_guided(
    mesh: &CompatibleMesh,
    options: &RefineOptions,
    guide: Option<&dyn Guide>,
) -> Result<(CompatibleMesh, RefineReport), RefineError> {
    if options.edge_length.is_nan() || options.edge_length < SMALLEST_EDGE_LENGTH {
        return Err(RefineError::BadEdgeLength {
            given: options.edge_length,
        });
    }
    let diagonals: Vec<f64> = mesh.positions.iter().map(point::diagonal).collect();
    let mut curves = Curves {
        rings: mesh.rings.clone(),
        landmarks: mesh.landmarks.clone(),
        paths: mesh.paths.clone(),
    };
    let mut work = EditableMesh::new(mesh.positions.clone(), mesh.topology.triangles());
    let start = work.vertex_count();
    let mut flips = flip::flip(&mut work, &curves.paths);

    // Halve the length from a coarse start: long thin triangles are cut where they are long, then relax.
    let mut length = options.edge_length * 8.0;
    while length > options.edge_length * 0.99 {
        split::split_long_edges(&mut work, &mut curves, &diagonals, length, guide);
        flips += flip::flip(&mut work, &curves.paths);
        let stars = Stars::new(&work, &curves);
        smooth::smooth(&mut work, &stars, SMOOTHING_SWEEPS);
        flips += flip::flip(&mut work, &curves.paths);
        // With few vertices, each sweep reaches far; the next level starts from what this one found.
        let stars = Stars::new(&work, &curves);
        guide::minimise(&mut work, &stars, DISTORTION_SWEEPS, guide);
        flips += flip::flip(&mut work, &curves.paths);
        length *= 0.5;
    }
    if let Some(guide) = guide {
        flips += guide::refine_where_bent(&mut work, &mut curves, &diagonals, options.edge_length, guide);
    }
    for _ in 1..DISTORTION_ROUNDS {
        let stars = Stars::new(&work, &curves);
        guide::minimise(&mut work, &stars, DISTORTION_SWEEPS, guide);
        flips += flip::flip(&mut work, &curves.paths);
    }
    let stars = Stars::new(&work, &curves);
    widen::widen(&mut work, &stars, options.smallest_angle_deg.to_radians());

    let splits = work.vertex_count() - start;
    let refined = work.finish(&curves, mesh.steiner)?;
    let angles = geometry::worst_angles_deg(&refined.positions, refined.topology.triangles());
    let report = RefineReport {
        splits,
        flips,
        smallest_angle_deg: angles.first().copied().unwrap_or(0.0),
        low_angle_deg: angles.get(angles.len() / 20).copied().unwrap_or(0.0),
    };
    Ok((refined, report))
}
