//! From drawings to the N-way mapping: match, simplify, triangulate, refine.

use super::drawings::{mirror_axis, reflected};
use super::triangulation::{self, InteriorLandmark};
use super::{PipelineError, Refinement};
use crate::compatible::{RefineOptions, SimplifyError, SimplifyOptions, simplify};
use crate::input::Drawing;
use crate::matching::{Correspondence, Landmark, MatchError, MatchOptions, MirrorHints, match_rings};
use crate::math::Point;
use crate::outline::{ArcLength, Outline, Ring};
use crate::pose::{Mapping, Matching, PoseSet};
use crate::scene::{Facing, Scene};

/// How far a landmark may lie from the outline it is snapped to, as a fraction of the pose's diagonal: a few times the
/// width of an ink line.
const LANDMARK_REACH: f64 = 0.03;

/// A landmark that in every pose lies inside the shape by more than this, as a fraction of the diagonal, is an interior
/// one: about the width of an ink line.
const INTERIOR_DEPTH: f64 = 0.01;

/// What an artist should know about a mapping.
#[derive(Debug, Clone, Default)]
pub struct MappingReport {
    /// One line a remark, each naming its pose.
    pub notes: Vec<String>,
    /// Corresponding vertices of the simplified boundary.
    pub boundary_vertices: usize,
    /// The smallest angle of any triangle in any pose, in degrees.
    pub smallest_angle_deg: f64,
}

/// Maps the drawings of a scene onto one another.
///
/// # Errors
/// [`PipelineError`] if holes or landmarks do not fit, or a stage refuses.
pub fn map_drawings(scene: &Scene, drawings: &[Drawing]) -> Result<(Mapping, MappingReport), PipelineError> {
    let names = scene.names();
    let mut report = MappingReport::default();
    for (name, drawing) in names.iter().zip(drawings) {
        report
            .notes
            .extend(drawing.notes.iter().map(|note| format!("pose '{name}': {note}")));
    }
    let mut outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    check_hole_counts(&names, &outlines)?;
    let (landmarks, interior) = landmarks(scene, drawings)?;
    let outer: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let mut options = MatchOptions {
        reference: scene.reference,
        ..MatchOptions::default()
    };
    let matched = match_rings(&outer, &landmarks, &options).map_err(|error| match_refusal(&names, error))?;
    for (pose, _) in matched
        .report
        .poses
        .iter()
        .enumerate()
        .filter(|(_, pose)| pose.looks_mirrored)
    {
        report.notes.push(format!(
            "pose '{}' would match better reflected; set `mirror = true` if it faces the other way",
            names[pose]
        ));
    }
    order_holes(&mut outlines, matched.reference)?;
    let mut correspondences = vec![matched.correspondence];
    for hole in 0..outlines.first().map_or(0, |outline| outline.holes().len()) {
        let rings: Vec<Ring> = outlines.iter().map(|outline| outline.holes()[hole].clone()).collect();
        options.reference = Some(matched.reference);
        options.mirror_hints = MirrorHints::Skip;
        let matched = match_rings(&rings, &[], &options).map_err(|error| match_refusal(&names, error))?;
        correspondences.push(matched.correspondence);
    }

    let pinned: Vec<Vec<f64>> = landmarks
        .iter()
        .filter_map(|landmark| everywhere(landmark, &correspondences[0]))
        .collect();
    let options = SimplifyOptions::default().with_tolerance(scene.mesh.simplify);
    let simplified = simplify(&outlines, &correspondences, &pinned, &options).map_err(|error| {
        let pose = match &error {
            SimplifyError::RingCount { pose, .. }
            | SimplifyError::Degenerate { pose, .. }
            | SimplifyError::NotSimple { pose, .. } => Some(*pose),
            _ => None,
        };
        PipelineError::stage(&names, pose, error)
    })?;
    report.boundary_vertices = simplified.report.vertices;
    let refinement = Refinement::Refine(RefineOptions::default().with_edge_length(scene.mesh.edge_length));
    let (mesh, smallest_angle_deg) = triangulation::mesh(&names, &simplified.polygons, &interior, &refinement)?;
    report.smallest_angle_deg = smallest_angle_deg;
    let poses = PoseSet::new(mesh.topology, names.iter().cloned().zip(mesh.positions).collect())
        .map_err(|error| PipelineError::stage(&names, None, error))?;
    let mapping = Mapping {
        poses,
        outlines,
        rings: mesh.rings,
        steiner: mesh.steiner,
        matching: Matching {
            reference: matched.reference,
            outer: correspondences.swap_remove(0),
        },
    };
    Ok((mapping, report))
}

/// The matching's refusal with the poses' names.
fn match_refusal(names: &[String], error: MatchError) -> PipelineError {
    let name = |pose: usize| names.get(pose).cloned().unwrap_or_default();
    match error {
        MatchError::LandmarkOrder { landmark, pose, other } => PipelineError::LandmarkOrder {
            landmark,
            pose: name(pose),
            other: name(other),
        },
        MatchError::LandmarksCoincide { first, second, pose } => PipelineError::LandmarksCoincide {
            first,
            second,
            pose: name(pose),
        },
        MatchError::LandmarkPlace { pose, .. } | MatchError::Degenerate { pose, .. } | MatchError::NoMatch { pose } => {
            PipelineError::stage(names, Some(pose), error)
        }
        other => PipelineError::stage(names, None, other),
    }
}

fn check_hole_counts(names: &[String], outlines: &[Outline]) -> Result<(), PipelineError> {
    let expected = outlines.first().map_or(0, |outline| outline.holes().len());
    match outlines.iter().position(|outline| outline.holes().len() != expected) {
        None => Ok(()),
        Some(pose) => Err(PipelineError::HoleCount {
            pose: names[pose].clone(),
            found: outlines[pose].holes().len(),
            other: names[0].clone(),
            expected,
        }),
    }
}

/// The scene's landmarks: those on the outlines as parameters of the outer rings, and those inside.
fn landmarks(scene: &Scene, drawings: &[Drawing]) -> Result<(Vec<Landmark>, Vec<InteriorLandmark>), PipelineError> {
    let measured: Vec<ArcLength> = drawings.iter().map(|d| ArcLength::new(d.outline.outer())).collect();
    let (mut on_outline, mut interior) = (Vec::new(), Vec::new());
    for landmark in &scene.landmarks {
        if landmark.at.iter().all(Option::is_none) {
            return Err(PipelineError::LandmarkNowhere {
                landmark: landmark.name.clone(),
                line: landmark.line,
            });
        }
        let mut found = Vec::with_capacity(drawings.len());
        for (pose, place) in landmark.at.iter().enumerate() {
            found.push(place.map(|place| {
                let drawing = &drawings[pose];
                let place = match scene.poses[pose].facing {
                    Facing::AsDrawn => place,
                    Facing::Mirrored => reflected(place, mirror_axis(&drawing.outline)),
                };
                let (parameter, distance) = measured[pose].nearest(place);
                Found {
                    place,
                    parameter,
                    distance,
                    inside: drawing.outline.contains(place),
                    size: drawing.outline.diagonal(),
                }
            }));
        }
        let is_interior = found
            .iter()
            .flatten()
            .all(|f| f.inside && f.distance > INTERIOR_DEPTH * f.size);
        if is_interior {
            let at = found.iter().enumerate().map(|(pose, found)| match found {
                Some(found) => Ok(found.place),
                None => Err(PipelineError::LandmarkMissing {
                    landmark: landmark.name.clone(),
                    line: landmark.line,
                    pose: scene.poses[pose].name.clone(),
                }),
            });
            interior.push(InteriorLandmark {
                name: landmark.name.clone(),
                at: at.collect::<Result<_, _>>()?,
            });
            continue;
        }
        for (pose, found) in found.iter().enumerate() {
            if let Some(found) = found.as_ref().filter(|f| f.distance > LANDMARK_REACH * f.size) {
                return Err(PipelineError::LandmarkOffOutline {
                    landmark: landmark.name.clone(),
                    line: landmark.line,
                    pose: scene.poses[pose].name.clone(),
                    distance: found.distance,
                    largest: LANDMARK_REACH * found.size,
                    x: found.place.x,
                    y: found.place.y,
                });
            }
        }
        let at = found.iter().map(|found| found.as_ref().map(|f| f.parameter)).collect();
        on_outline.push(Landmark {
            name: landmark.name.clone(),
            at,
        });
    }
    Ok((on_outline, interior))
}

/// A landmark's place on one pose.
struct Found {
    place: Point,
    /// Of the nearest point of the outline.
    parameter: f64,
    /// To that point, in source units.
    distance: f64,
    inside: bool,
    /// The pose's diagonal.
    size: f64,
}

/// A landmark on every pose: where a pose lacks it, where the matching puts it.
fn everywhere(landmark: &Landmark, correspondence: &Correspondence) -> Option<Vec<f64>> {
    let (from, known) = landmark
        .at
        .iter()
        .enumerate()
        .find_map(|(pose, t)| t.map(|t| (pose, t)))?;
    Some(
        landmark
            .at
            .iter()
            .enumerate()
            .map(|(pose, t)| t.unwrap_or_else(|| correspondence.carry(from, pose, known)))
            .collect(),
    )
}

/// Puts the holes of every pose in the order of the reference's: each at the nearest place relative to its outline.
fn order_holes(outlines: &mut [Outline], reference: usize) -> Result<(), PipelineError> {
    let places: Vec<Point> = match outlines.get(reference) {
        Some(outline) => outline
            .holes()
            .iter()
            .map(|hole| relative_place(hole, outline.outer()))
            .collect(),
        None => return Ok(()),
    };
    if places.len() < 2 {
        return Ok(());
    }
    for outline in outlines.iter_mut() {
        let mut left: Vec<Ring> = outline.holes().to_vec();
        let mut ordered = Vec::with_capacity(left.len());
        for place in &places {
            let distance = |hole: &Ring| (relative_place(hole, outline.outer()) - place).norm();
            let nearest = (0..left.len()).min_by(|a, b| distance(&left[*a]).total_cmp(&distance(&left[*b])));
            if let Some(nearest) = nearest {
                ordered.push(left.remove(nearest));
            }
        }
        *outline =
            Outline::new(outline.outer().clone(), ordered).map_err(|error| PipelineError::stage(&[], None, error))?;
    }
    Ok(())
}

/// The middle of a hole's box, in units of the outer ring's box.
fn relative_place(hole: &Ring, outer: &Ring) -> Point {
    let bounds = |ring: &Ring| crate::math::point::bounding_box(ring.points()).unwrap_or_default();
    let ((low, high), (outer_low, outer_high)) = (bounds(hole), bounds(outer));
    ((low + high) * 0.5 - outer_low).component_div(&(outer_high - outer_low).sup(&Point::repeat(f64::MIN_POSITIVE)))
}
