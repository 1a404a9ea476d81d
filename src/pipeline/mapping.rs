//! From drawings to the N-way mapping: match, simplify, triangulate, refine.

use std::sync::Arc;

use super::boundaries::Boundaries;
use super::landmarks::{self, Landmarks};
use super::triangulation::{self, Labels, LandmarkLabel};
use super::{MappingReport, PipelineError, Stage, deformed};
use crate::compatible::{
    CompatibleMesh, Effort, RefineOptions, Simplification, Simplified, TriangulateReport, refine, triangulate_features,
};
use crate::input::Drawing;
use crate::math::Point;
use crate::outline::{ArcLength, Outline};
use crate::pose::{Mapping, Matching, MeshQuality, PoseSet};
use crate::scene::Scene;

/// Lines inside are simplified to the mesh's tolerance; where they then touch the outline or one another, to these shares
/// of it.
const FINER_LINES: [f64; 4] = [1.0, 0.25, 0.0625, 0.0];

/// By how much, as a fraction, the units of drawings may differ without a word: rounding of a page's size.
const LIKE_UNITS: f64 = 0.02;

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

/// As [`map_drawings`]; `begins` is told every stage as it begins, in the order of [`Stage`], on the thread that works on it. The
/// library reads no clock: whoever wants to know how long a stage takes looks at one there.
///
/// # Errors
/// As [`map_drawings`].
pub fn map_drawings_observed(
    scene: &Scene,
    drawings: &[Drawing],
    begins: &mut (dyn FnMut(Stage) + Send),
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
    // The stages hand thousands of small tasks to the thread pool; from outside it, each would put this thread to sleep.
    rayon::scope(|_| {
        let (mapping, mut report, _) = map_drawn(&drawn, drawings, None, begins)?;
        let mapping = deformed::with_copies(scene, drawings, mapping, &mut report)?;
        Ok((mapping, report))
    })
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
    notes.extend(note_on_units(&names, drawings));
    check_hole_counts(&names, drawings)?;
    let landmarks = landmarks::sorted(scene, drawings)?;

    let boundaries = match before.filter(|before| before.serve(scene, &landmarks.on_outline)) {
        Some(same) => Arc::clone(same),
        None => {
            let before = before.map(Arc::as_ref);
            Arc::new(Boundaries::new(scene, drawings, &landmarks.on_outline, before, begins)?)
        }
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
        sparser(boundaries.simplification.clone(), &bare, &triangulated)
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

/// Says that drawings are in different units, as one in millimetres among others in pixels is.
fn note_on_units(names: &[String], drawings: &[Drawing]) -> Option<String> {
    let unit = |pose: &usize| drawings[*pose].unit_px;
    let by_unit = |a: &usize, b: &usize| unit(a).total_cmp(&unit(b));
    let smallest = (0..drawings.len()).min_by(by_unit)?;
    let largest = (0..drawings.len()).max_by(by_unit)?;
    let times = unit(&largest) / unit(&smallest);
    (times > 1.0 + LIKE_UNITS).then(|| {
        format!(
            "a unit of pose '{}' is {times:.2} times as large on the page as one of pose '{}', and coordinates are taken as they are; save \
             both with the same units and viewBox if one looks too small",
            names[largest], names[smallest]
        )
    })
}

/// The best of some variations of the simplification by their sketched triangulations, if any beats the first.
fn sparser(
    mut simplification: Simplification,
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
