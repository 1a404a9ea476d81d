//! From polygons with corresponding vertices to one mesh.

use super::PipelineError;
use crate::compatible::{CompatibleMesh, Feature, RefineOptions, TriangulateError, refine, triangulate};
use crate::math::Point;
use crate::mesh::geometry;
use crate::outline::Outline;
use crate::pose::{Mapping, Matching, Polygons, PoseSet};

/// Whether a triangulation is refined.
#[derive(Debug, Clone, PartialEq)]
pub enum Refinement {
    /// Only the vertices that the triangulation needs.
    Bare,
    /// More vertices, for triangles that bend well.
    Refine(RefineOptions),
}

/// A landmark inside the shape.
pub(super) struct InteriorLandmark {
    pub(super) name: String,
    /// Its place in every pose.
    pub(super) at: Vec<Point>,
}

/// A mapping of polygons whose vertices already correspond: the mesh covers exactly these polygons.
///
/// # Errors
/// [`PipelineError`] if the triangulation or the refinement refuses.
pub fn triangulate_polygons(polygons: &Polygons, refinement: &Refinement) -> Result<Mapping, PipelineError> {
    let (mesh, _) = mesh(&polygons.names, &polygons.outlines, &[], refinement)?;
    let poses = PoseSet::new(
        mesh.topology,
        polygons.names.iter().cloned().zip(mesh.positions).collect(),
    )
    .map_err(|error| PipelineError::stage(&polygons.names, None, error))?;
    Ok(Mapping {
        poses,
        outlines: polygons.outlines.clone(),
        rings: mesh.rings,
        steiner: mesh.steiner,
        matching: Matching {
            reference: 0,
            outer: polygons.matching(),
        },
    })
}

/// The mesh, and its smallest angle in any pose in degrees.
pub(super) fn mesh(
    names: &[String],
    polygons: &[Outline],
    landmarks: &[InteriorLandmark],
    refinement: &Refinement,
) -> Result<(CompatibleMesh, f64), PipelineError> {
    let places: Vec<Vec<Point>> = landmarks.iter().map(|landmark| landmark.at.clone()).collect();
    let named = |landmark: &usize| landmarks.get(*landmark).map_or_else(String::new, |l| l.name.clone());
    let (mesh, _) = triangulate(polygons, &places).map_err(|error| match &error {
        TriangulateError::CountsDiffer { pose, .. } | TriangulateError::TooNarrow { pose, .. } => {
            PipelineError::stage(names, Some(*pose), error)
        }
        TriangulateError::FeatureOutside {
            feature: Feature::Point(landmark),
            pose,
        } => PipelineError::LandmarkOutside {
            landmark: named(landmark),
            pose: names.get(*pose).cloned().unwrap_or_default(),
        },
        _ => PipelineError::stage(names, None, error),
    })?;
    match refinement {
        Refinement::Bare => {
            let smallest = mesh
                .positions
                .iter()
                .flat_map(|positions| {
                    let corners = |t: &[usize; 3]| geometry::corners(positions, *t);
                    mesh.topology
                        .triangles()
                        .iter()
                        .map(move |t| geometry::smallest_angle_rad(corners(t)))
                })
                .fold(f64::INFINITY, f64::min);
            Ok((mesh, smallest.to_degrees()))
        }
        Refinement::Refine(options) => {
            let (mesh, report) = refine(&mesh, options).map_err(|error| PipelineError::stage(names, None, error))?;
            Ok((mesh, report.smallest_angle_deg))
        }
    }
}
