//! From drawings to the N-way mapping: match, simplify, triangulate, refine.

use std::sync::Arc;

use super::boundaries::Boundaries;
use super::drawings::used_drawings;
use super::drawn::{Known, is_found};
use super::landmarks::{self, Landmarks};
use super::note::{Note, NoteKind};
use super::overlapping;
use super::overlapping_mapping::{Unfit, map_overlapping};
use super::spec::{LayerRole, LayerSpec};
use super::triangulation::{self, Labels};
use super::{MappingReport, PipelineError, Stage, deformed};
use crate::appearance::Appearance;
use crate::blend::{BlendOptions, RigidBlend};
use crate::compatible::{
    CompatibleMesh, Effort, Guide, Simplification, Simplified, TriangulateReport, refine_guided, triangulate_features,
};
use crate::input::{Drawing, InputNote};
use crate::math::Point;
use crate::outline::{ArcLength, Outline};
use crate::pose::{Mapping, Matching, MeshQuality, Overlaps, PoseSet};
use crate::registration::Explained;

/// Lines inside are simplified to the mesh's tolerance; where they then touch the outline or one another, to these shares
/// of it.
const FINER_LINES: [f64; 4] = [1.0, 0.25, 0.0625, 0.0];

/// By how much, as a fraction, the units of drawings may differ without a word: rounding of a page's size.
const LIKE_UNITS: f64 = 0.02;

/// A variation of the simplification with fewer Steiner points is kept if the low angles of its refined mesh are at least
/// this share of the first one's: good triangles are worth more than few points.
const VARIED_ANGLES: f64 = 0.97;

/// Maps the drawings of a layer onto one another. Deformed copies are added afterwards.
///
/// # Errors
/// [`PipelineError`] if the layer is not valid, holes or landmarks do not fit, or a stage refuses.
pub fn map_layer(layer: &LayerSpec) -> Result<(Mapping, MappingReport), PipelineError> {
    map_layer_observed(layer, &mut |_| ())
}

/// As [`map_layer`]; `begins` is told every stage as it begins, in the order of [`Stage`], on the thread that works on it. The
/// library reads no clock: whoever wants to know how long a stage takes looks at one there.
///
/// # Errors
/// As [`map_layer`].
pub fn map_layer_observed(
    layer: &LayerSpec,
    begins: &mut (dyn FnMut(Stage) + Send),
) -> Result<(Mapping, MappingReport), PipelineError> {
    layer.check()?;
    // The stages hand thousands of small tasks to the thread pool; from outside it, each would put this thread to sleep.
    rayon::scope(|_| {
        let drawings = used_drawings(layer)?;
        let (mapping, mut report, _) = map_drawn(&layer.only_drawn(), &drawings, None, begins)?;
        let mapping = deformed::with_copies(layer, mapping, &mut report)?;
        Ok((mapping, report))
    })
}

/// The mapping of a valid layer from its drawings as they are used; for the same drawings as `before`, which the outlines' part is taken from if nothing that it is made of has
/// changed; and that part, for the next time.
pub(super) fn map_drawings_again(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
    before: Option<&Arc<Boundaries>>,
) -> Result<(Mapping, MappingReport, Arc<Boundaries>), PipelineError> {
    let drawn = layer.only_drawn();
    let (mapping, mut report, boundaries) = map_drawn(&drawn, drawings, before, &mut |_| ())?;
    let mapping = deformed::with_copies(layer, mapping, &mut report)?;
    Ok((mapping, report, boundaries))
}

/// Maps a layer without copies.
pub(super) fn map_drawn(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
    before: Option<&Arc<Boundaries>>,
    begins: &mut dyn FnMut(Stage),
) -> Result<(Mapping, MappingReport, Arc<Boundaries>), PipelineError> {
    let names = layer.names();
    let mut notes = Vec::new();
    for (name, drawing) in names.iter().zip(drawings) {
        let of_drawing = |note: &InputNote| Note::on_pose(name, NoteKind::Drawing(note.clone()));
        notes.extend(drawing.notes.iter().filter(|note| note.is_told()).map(of_drawing));
    }
    if layer.role == LayerRole::Body {
        notes.extend(note_on_units(&names, drawings));
    }
    check_hole_counts(&names, drawings)?;
    // Where parts lie over one another, landmarks may lie as they must not elsewhere: they are refused when that is known.
    let landmarks = landmarks::sorted(layer, drawings);
    let mut found = overlapping::found(layer, drawings, landmarks.as_ref().ok())?;
    let mut misfit = None;
    while let Some(overlapping) = found {
        match map_overlapping(layer, drawings, &overlapping, notes.clone(), begins)? {
            // A mesh that goes around one of its holes otherwise than in the other poses cannot be blended.
            Ok(mapped) if RigidBlend::new(&mapped.0.poses, &BlendOptions::default()).is_err() => break,
            Ok(mapped) => return Ok(mapped),
            // What was found in these poses is not enough: they are mapped as ever, but for those that the artist says more of.
            Err(Unfit(poses)) => {
                let asked = poses.iter().find(|(pose, _)| overlapping.is_asked(*pose));
                misfit = misfit.or(asked.map(|(pose, misfit)| PipelineError::Overlap {
                    pose: names[*pose].clone(),
                    misfit: *misfit,
                }));
                let poses: Vec<usize> = poses.into_iter().map(|(pose, _)| pose).collect();
                found = overlapping.without(&poses);
            }
        }
    }
    // Where landmarks lie as they must not, since parts lie over one another, that is what is wrong.
    let landmarks = match (landmarks, misfit) {
        (Ok(landmarks), None) => landmarks,
        (Ok(_), Some(misfit)) if layer.has_limbs() => return Err(misfit),
        (Ok(landmarks), Some(_)) => landmarks,
        (Err(_), Some(misfit)) => return Err(misfit),
        (Err(error), None) => return Err(error),
    };
    let known = Known::of(&landmarks);
    let boundaries = match before.filter(|before| before.serve(layer, &known)) {
        Some(same) => Arc::clone(same),
        None => Arc::new(Boundaries::new(
            layer,
            drawings,
            known,
            before.map(Arc::as_ref),
            begins,
        )?),
    };
    let Boundaries {
        outlines,
        matched,
        pinned,
        ..
    } = boundaries.as_ref();
    for (pose, name) in names.iter().enumerate() {
        // A loose part cannot be reflected by itself.
        if matched.outer.poses[pose].looks_mirrored && layer.role == LayerRole::Body {
            notes.push(Note::on_pose(name, NoteKind::LooksReflected));
        }
    }
    let explained: Vec<Option<Explained>> = (0..names.len())
        .map(|pose| boundaries.guide.as_ref()?.registration.explained(pose))
        .collect();
    notes.extend(notes_on_strangers(
        &names,
        matched.reference,
        &explained,
        &boundaries.appearances,
    ));
    let mut simplified = boundaries.simplified.clone();

    begins(Stage::Triangulation);
    let measured: Vec<Vec<ArcLength>> = (outlines.iter())
        .map(|outline| outline.rings().iter().map(ArcLength::new).collect())
        .collect();
    let anchors: Vec<Vec<Point>> = (pinned.iter())
        .map(|row| {
            let places = row.iter().zip(&measured);
            places.map(|(at, rings)| rings[at.ring].at(at.parameter)).collect()
        })
        .collect();
    let triangulated = |polygons: &[Outline], effort| bare_mesh(layer, polygons, &landmarks, &anchors, effort);
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
    let guide = boundaries.guide.as_ref().map(|guide| guide as &dyn Guide);
    let refined = |bare: &Bare| {
        refine_guided(&bare.mesh, &layer.mesh.refine, guide).map_err(|error| PipelineError::stage(&names, None, error))
    };
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
        explained,
        holes: matched.holes.clone(),
        landmarks: placed,
        deformed: Vec::new(),
        simplification: simplified.report,
        triangulation: bare.report,
        refinement,
        quality: MeshQuality::of(&poses),
    };
    let mapping = Mapping {
        overlaps: Overlaps::default(),
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

/// Says which poses show something else than the reference, and where a landmark would say most. Of two shapes on which nothing is drawn, there is nothing
/// to be found.
fn notes_on_strangers(
    names: &[String],
    reference: usize,
    explained: &[Option<Explained>],
    appearances: &[Arc<Appearance>],
) -> Vec<Note> {
    let is_drawn = |pose: usize| appearances.get(pose).is_some_and(|appearance| appearance.is_drawn());
    (names.iter().zip(explained).enumerate())
        .filter_map(|(pose, (name, explained))| {
            let explained = explained.filter(|explained| !is_found(explained))?;
            if !is_drawn(pose) && !is_drawn(reference) {
                return None;
            }
            let reference = names[reference].clone();
            Some(Note::on_pose(name, NoteKind::Unlike { reference, explained }))
        })
        .collect()
}

/// Says that drawings are in different units, as one in millimetres among others in pixels is.
fn note_on_units(names: &[String], drawings: &[Arc<Drawing>]) -> Option<Note> {
    let unit = |pose: &usize| drawings[*pose].unit_px;
    let by_unit = |a: &usize, b: &usize| unit(a).total_cmp(&unit(b));
    let smallest = (0..drawings.len()).min_by(by_unit)?;
    let largest = (0..drawings.len()).max_by(by_unit)?;
    let times = unit(&largest) / unit(&smallest);
    (times > 1.0 + LIKE_UNITS).then(|| {
        let smallest = names[smallest].clone();
        Note::on_pose(&names[largest], NoteKind::UnitsDiffer { smallest, times })
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
    notes: Vec<Note>,
}

/// The triangulation of the polygons with everything inside them.
fn bare_mesh(
    layer: &LayerSpec,
    polygons: &[Outline],
    landmarks: &Landmarks,
    anchors: &[Vec<Point>],
    effort: Effort,
) -> Result<Bare, PipelineError> {
    let labels = Labels {
        points: landmarks.points.iter().map(|l| l.name.clone()).collect(),
        paths: landmarks.paths.iter().map(|l| l.name.clone()).collect(),
        path_poses: (landmarks.paths.iter())
            .map(|path| path.at.iter().position(Option::is_some).unwrap_or(0))
            .collect(),
    };
    let mut refusal = PipelineError::stage(&[], None, "no polygon");
    for share in FINER_LINES {
        let (features, notes) = landmarks.features(layer, polygons, anchors, share * layer.mesh.simplify.tolerance)?;
        match triangulate_features(polygons, &features, effort) {
            Ok((mesh, report)) => return Ok(Bare { mesh, report, notes }),
            Err(error) => {
                let may_be_coarse = triangulation::concerns_a_path(&error);
                refusal = triangulation::refusal(&layer.names(), &labels, error);
                if !may_be_coarse {
                    break;
                }
            }
        }
    }
    Err(refusal)
}

fn check_hole_counts(names: &[String], drawings: &[Arc<Drawing>]) -> Result<(), PipelineError> {
    let holes = |drawing: &Arc<Drawing>| drawing.outline.holes().len();
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
