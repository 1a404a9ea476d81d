//! From polygons with corresponding vertices to one mesh.

use super::PipelineError;
use crate::compatible::{Feature, RefineOptions, TriangulateError, refine, triangulate};
use crate::pose::{Mapping, Matching, Polygons, PoseSet};

/// Whether a triangulation is refined.
#[derive(Debug, Clone, PartialEq)]
pub enum Refinement {
    /// Only the vertices that the triangulation needs.
    Bare,
    /// More vertices, for triangles that bend well.
    Refine(RefineOptions),
}

/// The names of what lies inside, in the order of [`crate::compatible::Features`].
#[derive(Debug, Default)]
pub(super) struct Labels {
    pub(super) points: Vec<String>,
    pub(super) paths: Vec<String>,
    /// For each path a pose in which it is drawn.
    pub(super) path_poses: Vec<usize>,
}

/// A mapping of polygons whose vertices already correspond: the mesh covers exactly these polygons.
///
/// # Errors
/// [`PipelineError`] if the triangulation or the refinement refuses.
pub fn triangulate_polygons(polygons: &Polygons, refinement: &Refinement) -> Result<Mapping, PipelineError> {
    let (mesh, _) =
        triangulate(&polygons.outlines, &[]).map_err(|error| refusal(&polygons.names, &Labels::default(), error))?;
    let mesh = match refinement {
        Refinement::Bare => mesh,
        Refinement::Refine(options) => {
            let refined = refine(&mesh, options);
            refined
                .map_err(|error| PipelineError::stage(&polygons.names, None, error))?
                .0
        }
    };
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
        overlaps: crate::pose::Overlaps::default(),
    })
}

/// Whether a line's coarser or finer form may make the difference.
pub(super) fn concerns_a_path(error: &TriangulateError) -> bool {
    match error {
        TriangulateError::FeatureOutside { feature, .. } => matches!(feature, Feature::Path(_)),
        TriangulateError::FeaturesMeet { first, second, .. } => {
            matches!(first, Feature::Path(_)) || matches!(second, Feature::Path(_))
        }
        TriangulateError::PathSides { .. } => true,
        _ => false,
    }
}

/// The triangulation's refusal with the names of poses and landmarks.
pub(super) fn refusal(names: &[String], labels: &Labels, error: TriangulateError) -> PipelineError {
    let pose_name = |pose: usize| names.get(pose).cloned().unwrap_or_default();
    let label = |feature: Feature| {
        let label = match feature {
            Feature::Point(k) => labels.points.get(k),
            Feature::Path(k) => labels.paths.get(k),
        };
        label.cloned().unwrap_or_default()
    };
    match error {
        TriangulateError::CountsDiffer { pose, .. } | TriangulateError::TooNarrow { pose, .. } => {
            PipelineError::stage(names, Some(pose), error)
        }
        TriangulateError::FeatureOutside { feature, pose } => PipelineError::LandmarkOutside {
            landmark: label(feature),
            pose: pose_name(pose),
        },
        TriangulateError::FeaturesMeet { first, second, pose } if first == second => {
            PipelineError::LandmarkCrossesItself {
                landmark: label(first),
                pose: pose_name(pose),
            }
        }
        TriangulateError::FeaturesMeet { first, second, pose } => PipelineError::LandmarksMeet {
            first: label(first),
            second: label(second),
            pose: pose_name(pose),
        },
        TriangulateError::PathShort { path } => PipelineError::LandmarkClosed {
            landmark: label(Feature::Path(path)),
            pose: pose_name(labels.path_poses.get(path).copied().unwrap_or(0)),
        },
        TriangulateError::PathSides { path, pose } => PipelineError::LandmarkSides {
            landmark: label(Feature::Path(path)),
            pose: pose_name(pose),
            other: pose_name(0),
        },
        _ => PipelineError::stage(names, None, error),
    }
}
