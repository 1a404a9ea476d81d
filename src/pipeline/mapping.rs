//! From drawings to the N-way mapping: match, simplify, triangulate, refine.

use std::sync::Arc;

use super::landmarks::{self, Landmarks};
use super::triangulation::{self, Labels, LandmarkLabel};
use super::{MappingReport, PipelineError, Stage, deformed};
use crate::compatible::{
    CompatibleMesh, Effort, RefineOptions, Simplification, Simplified, SimplifyError, SimplifyOptions,
    TriangulateReport, refine, triangulate_features,
};
use crate::input::Drawing;
use crate::matching::{Correspondence, Landmark, MatchError, MatchOptions, MatchReport, MirrorHints, match_rings};
use crate::math::Point;
use crate::outline::{ArcLength, Outline, Ring};
use crate::pose::{Mapping, Matching, MeshQuality, PoseSet};
use crate::scene::Scene;

/// Lines inside are simplified to the mesh's tolerance; where they then touch the outline or one another, to these shares
/// of it.
const FINER_LINES: [f64; 4] = [1.0, 0.25, 0.0625, 0.0];

/// A variation of the simplification with fewer Steiner points is kept if the low angles of its refined mesh are at least
/// this share of the first one's: good triangles are worth more than few points.
const VARIED_ANGLES: f64 = 0.97;

/// Maps the drawings of a scene onto one another: `drawings` has one a drawn pose, as
/// [`read_drawings`](super::read_drawings) gives them. Deformed copies are added afterwards.
///
/// # Errors
/// [`PipelineError`] if holes or landmarks do not fit, or a stage refuses; or if the scene has layers, of which each is a scene
/// to be mapped by itself.
pub fn map_drawings(scene: &Scene, drawings: &[Drawing]) -> Result<(Mapping, MappingReport), PipelineError> {
    map_drawings_observed(scene, drawings, &mut |_| ())
}

/// As [`map_drawings`]; `begins` is told every stage as it begins, in the order of [`Stage`]. The library reads no clock:
/// whoever wants to know how long a stage takes looks at one there.
///
/// # Errors
/// As [`map_drawings`].
pub fn map_drawings_observed(
    scene: &Scene,
    drawings: &[Drawing],
    begins: &mut dyn FnMut(Stage),
) -> Result<(Mapping, MappingReport), PipelineError> {
    if !scene.layers.is_empty() {
        return Err(PipelineError::Layered {
            layers: scene.layers.iter().map(|layer| format!("'{}'", layer.name)).collect(),
        });
    }
    let drawn = scene.only_drawn();
    if drawn.poses.is_empty() || drawn.poses.len() != drawings.len() {
        let problem = format!("{} drawings for {} drawn poses", drawings.len(), drawn.poses.len());
        return Err(PipelineError::stage(&[], None, problem));
    }
    let (mapping, mut report, _) = map_drawn(&drawn, drawings, None, begins)?;
    let mapping = deformed::with_copies(scene, drawings, mapping, &mut report)?;
    Ok((mapping, report))
}

/// As [`map_drawings`] for the same drawings as `before`, which the outlines' part is taken from if nothing that it is made of has
/// changed; and that part, for the next time.
pub(super) fn map_drawings_again(
    scene: &Scene,
    drawings: &[Drawing],
    before: Option<&Arc<Boundaries>>,
) -> Result<(Mapping, MappingReport, Arc<Boundaries>), PipelineError> {
    let drawn = scene.only_drawn();
    let (mapping, mut report, boundaries) = map_drawn(&drawn, drawings, before, &mut |_| ())?;
    let mapping = deformed::with_copies(scene, drawings, mapping, &mut report)?;
    Ok((mapping, report, boundaries))
}

/// The outlines matched and simplified, and what that was made of besides the drawings.
#[derive(Debug)]
pub(super) struct Boundaries {
    on_outline: Vec<Landmark>,
    reference: Option<usize>,
    tolerance: f64,
    /// Holes in one order.
    outlines: Vec<Outline>,
    matched: Matched,
    /// The places of the landmarks, #landmarks x #poses.
    pinned: Vec<Vec<f64>>,
    simplified: Simplified,
}

impl Boundaries {
    fn new(
        scene: &Scene,
        drawings: &[Drawing],
        on_outline: &[Landmark],
        begins: &mut dyn FnMut(Stage),
    ) -> Result<Self, PipelineError> {
        begins(Stage::Matching);
        let mut outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
        let matched = match_outlines(scene, &mut outlines, on_outline)?;
        begins(Stage::Simplification);
        let pinned: Vec<Vec<f64>> = on_outline
            .iter()
            .filter_map(|landmark| everywhere(landmark, &matched.correspondences[0]))
            .collect();
        let simplified = simplification(&outlines, &matched, &pinned, scene.mesh.simplify, &scene.names())?.1;
        Ok(Self {
            on_outline: on_outline.to_vec(),
            reference: scene.reference,
            tolerance: scene.mesh.simplify,
            outlines,
            matched,
            pinned,
            simplified,
        })
    }

    /// Whether they are those of this scene, too, whose drawings are the same.
    fn serve(&self, scene: &Scene, on_outline: &[Landmark]) -> bool {
        self.on_outline == on_outline && self.reference == scene.reference && self.tolerance == scene.mesh.simplify
    }
}

/// The simplification, to be varied, and what it gives.
fn simplification<'a>(
    outlines: &'a [Outline],
    matched: &Matched,
    pinned: &[Vec<f64>],
    tolerance: f64,
    names: &[String],
) -> Result<(Simplification<'a>, Simplified), PipelineError> {
    let options = SimplifyOptions::default().with_tolerance(tolerance);
    let refusal = |error| simplify_refusal(names, error);
    let mut simplification =
        Simplification::new(outlines, &matched.correspondences, pinned, &options).map_err(refusal)?;
    let simplified = simplification.polygons().map_err(refusal)?;
    Ok((simplification, simplified))
}

/// Maps a scene without copies.
fn map_drawn(
    scene: &Scene,
    drawings: &[Drawing],
    before: Option<&Arc<Boundaries>>,
    begins: &mut dyn FnMut(Stage),
) -> Result<(Mapping, MappingReport, Arc<Boundaries>), PipelineError> {
    let names = scene.names();
    let mut notes = Vec::new();
    for (name, drawing) in names.iter().zip(drawings) {
        notes.extend(drawing.notes.iter().map(|note| format!("pose '{name}': {note}")));
    }
    check_hole_counts(&names, drawings)?;
    let landmarks = landmarks::sorted(scene, drawings)?;

    let boundaries = match before.filter(|before| before.serve(scene, &landmarks.on_outline)) {
        Some(before) => Arc::clone(before),
        None => Arc::new(Boundaries::new(scene, drawings, &landmarks.on_outline, begins)?),
    };
    let Boundaries {
        outlines,
        matched,
        pinned,
        ..
    } = boundaries.as_ref();
    for (pose, name) in names.iter().enumerate() {
        if matched.outer.poses[pose].looks_mirrored {
            notes.push(format!(
                "pose '{name}' would match better reflected; set `mirror = true` if it faces the other way"
            ));
        }
    }
    let mut simplified = boundaries.simplified.clone();

    begins(Stage::Triangulation);
    let measured: Vec<ArcLength> = outlines.iter().map(|outline| ArcLength::new(outline.outer())).collect();
    let anchors: Vec<Vec<Point>> = pinned
        .iter()
        .map(|at| at.iter().zip(&measured).map(|(&t, outline)| outline.at(t)).collect())
        .collect();
    let triangulated =
        |polygons: &[Outline], effort| bare_mesh(scene, drawings, polygons, &landmarks, &anchors, effort);
    let mut bare = triangulated(&simplified.polygons, Effort::Full)?;
    let mut first = None;
    let varied = if bare.mesh.steiner > 0 {
        let (mut again, _) = simplification(outlines, matched, pinned, scene.mesh.simplify, &names)?;
        sparser(&mut again, &bare, &triangulated)
    } else {
        None
    };
    if let Some(varied) = varied
        && let Ok(other) = triangulated(&varied.polygons, Effort::Full)
        && other.mesh.is_sparer_than(&bare.mesh)
    {
        let before = std::mem::replace(&mut bare, other);
        first = Some((before, std::mem::replace(&mut simplified, varied)));
    }

    begins(Stage::Refinement);
    let options = RefineOptions::default().with_edge_length(scene.mesh.edge_length);
    let refined = |bare: &Bare| refine(&bare.mesh, &options).map_err(|error| PipelineError::stage(&names, None, error));
    let (mut mesh, mut refinement) = refined(&bare)?;
    if let Some((bare_first, simplified_first)) = first {
        let (mesh_first, refinement_first) = refined(&bare_first)?;
        if refinement.low_angle_deg < VARIED_ANGLES * refinement_first.low_angle_deg {
            (mesh, refinement) = (mesh_first, refinement_first);
            (bare, simplified) = (bare_first, simplified_first);
        }
    }
    notes.extend(bare.notes);
    let placed = landmarks.placed(&anchors, &mesh);
    let poses = PoseSet::new(mesh.topology, names.iter().cloned().zip(mesh.positions).collect())
        .map_err(|error| PipelineError::stage(&names, None, error))?;
    let report = MappingReport {
        notes,
        matching: matched.outer.clone(),
        holes: matched.holes.clone(),
        landmarks: placed,
        deformed: Vec::new(),
        simplification: simplified.report,
        triangulation: bare.report,
        refinement,
        quality: MeshQuality::of(&poses),
    };
    let mapping = Mapping {
        poses,
        outlines: outlines.clone(),
        rings: mesh.rings,
        steiner: mesh.steiner,
        matching: Matching {
            reference: matched.reference,
            outer: matched.correspondences[0].clone(),
        },
    };
    Ok((mapping, report, Arc::clone(&boundaries)))
}

/// The best of some variations of the simplification by their sketched triangulations, if any beats the first.
fn sparser(
    simplification: &mut Simplification,
    first: &Bare,
    triangulated: &impl Fn(&[Outline], Effort) -> Result<Bare, PipelineError>,
) -> Option<Simplified> {
    let mut best: Option<(Bare, Simplified)> = None;
    for _ in 0..Simplification::VARIATIONS {
        let least = best.as_ref().map_or(&first.mesh, |(bare, _)| &bare.mesh);
        if least.steiner == 0 {
            break;
        }
        let Some(varied) = simplification.vary(least) else {
            continue;
        };
        if let Ok(other) = triangulated(&varied.polygons, Effort::Sketch)
            && other.mesh.is_sparer_than(least)
        {
            simplification.keep();
            best = Some((other, varied));
        }
    }
    best.map(|(_, varied)| varied)
}

/// All rings, matched.
#[derive(Debug)]
struct Matched {
    reference: usize,
    /// Outer ring first.
    correspondences: Vec<Correspondence>,
    outer: MatchReport,
    holes: Vec<MatchReport>,
}

/// Matches the outer rings, puts the holes of all poses in one order, and matches them.
fn match_outlines(scene: &Scene, outlines: &mut [Outline], landmarks: &[Landmark]) -> Result<Matched, PipelineError> {
    let names = scene.names();
    let outer: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let mut options = MatchOptions {
        reference: scene.reference,
        ..MatchOptions::default()
    };
    let refusal = |error| match_refusal(&names, error);
    let first = match_rings(&outer, landmarks, &options).map_err(refusal)?;
    order_holes(outlines, first.reference)?;
    let mut matched = Matched {
        reference: first.reference,
        correspondences: vec![first.correspondence],
        outer: first.report,
        holes: Vec::new(),
    };
    options.reference = Some(matched.reference);
    options.mirror_hints = MirrorHints::Skip;
    for hole in 0..outlines.first().map_or(0, |outline| outline.holes().len()) {
        let rings: Vec<Ring> = outlines.iter().map(|outline| outline.holes()[hole].clone()).collect();
        let of_hole = match_rings(&rings, &[], &options).map_err(refusal)?;
        matched.correspondences.push(of_hole.correspondence);
        matched.holes.push(of_hole.report);
    }
    Ok(matched)
}

/// A triangulation before it is refined.
struct Bare {
    mesh: CompatibleMesh,
    report: TriangulateReport,
    /// What was placed.
    notes: Vec<String>,
}

/// The triangulation of the polygons with everything inside them.
fn bare_mesh(
    scene: &Scene,
    drawings: &[Drawing],
    polygons: &[Outline],
    landmarks: &Landmarks,
    anchors: &[Vec<Point>],
    effort: Effort,
) -> Result<Bare, PipelineError> {
    let label = |name: &String, line: usize| LandmarkLabel {
        name: name.clone(),
        line,
    };
    let labels = Labels {
        points: landmarks.points.iter().map(|l| label(&l.name, l.line)).collect(),
        paths: landmarks.paths.iter().map(|l| label(&l.name, l.line)).collect(),
        path_poses: (landmarks.paths.iter())
            .map(|path| path.at.iter().position(Option::is_some).unwrap_or(0))
            .collect(),
    };
    let mut refusal = PipelineError::stage(&[], None, "no polygon");
    for share in FINER_LINES {
        let (features, notes) = landmarks.features(scene, drawings, polygons, anchors, share * scene.mesh.simplify)?;
        match triangulate_features(polygons, &features, effort) {
            Ok((mesh, report)) => return Ok(Bare { mesh, report, notes }),
            Err(error) => {
                let may_be_coarse = triangulation::concerns_a_path(&error);
                refusal = triangulation::refusal(&scene.names(), &labels, error);
                if !may_be_coarse {
                    break;
                }
            }
        }
    }
    Err(refusal)
}

/// The simplification's refusal with the pose's name.
fn simplify_refusal(names: &[String], error: SimplifyError) -> PipelineError {
    let pose = match &error {
        SimplifyError::RingCount { pose, .. }
        | SimplifyError::Degenerate { pose, .. }
        | SimplifyError::NotSimple { pose, .. } => Some(*pose),
        _ => None,
    };
    PipelineError::stage(names, pose, error)
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

fn check_hole_counts(names: &[String], drawings: &[Drawing]) -> Result<(), PipelineError> {
    let holes = |drawing: &Drawing| drawing.outline.holes().len();
    let expected = drawings.first().map_or(0, holes);
    match drawings.iter().position(|drawing| holes(drawing) != expected) {
        None => Ok(()),
        Some(pose) => Err(PipelineError::HoleCount {
            pose: names[pose].clone(),
            found: holes(&drawings[pose]),
            other: names[0].clone(),
            expected,
        }),
    }
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
