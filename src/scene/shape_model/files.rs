//! The files of a scene as forms, joints and pictures. What is wrong with one names it and the line of the scene.

use super::ShapeModelError;
use crate::input::{read_obj, read_picture};
use crate::math::Point3;
use crate::render::Frame;
use crate::scene::{JointSettings, ShapeScene, SkeletonSettings};
use crate::shape3d::{FormTopology, Joint, Rig, RigError, Scaling, Shift, Skeleton, Skin, Turn};

/// The forms' topology and the examples' positions, #examples x #vertices.
pub(super) fn forms(scene: &ShapeScene) -> Result<(FormTopology, Vec<Vec<Point3>>), ShapeModelError> {
    let mut shared: Option<FormTopology> = None;
    let mut forms = Vec::new();
    for example in &scene.examples {
        let unusable = |reason: String| scene.unusable(&example.form, &reason);
        let read = read_obj(&scene.read(&example.form)?).map_err(|error| unusable(error.to_string()))?;
        match &shared {
            None => shared = Some(read.topology),
            Some(shared) => shared.same_as(&read.topology).map_err(|error| {
                let first = &scene.examples[0].name;
                unusable(format!("it is no form like that of example '{first}': {error}"))
            })?,
        }
        forms.push(read.form.into_positions());
    }
    let topology = shared.ok_or(crate::weights::WeightError::NoPose)?;
    let mut textures = scene.examples.iter().filter_map(|example| example.texture.as_ref());
    if let Some(texture) = textures.next().filter(|_| !topology.has_texture()) {
        let reason = "the forms have no texture coordinates to show it by; export them with `vt` lines";
        return Err(scene.unusable(texture, reason).into());
    }
    Ok((topology, forms))
}

/// The skeleton with the skin on it.
pub(super) fn rig(scene: &ShapeScene, vertex_count: usize) -> Result<Option<Rig>, ShapeModelError> {
    let Some((settings, weights)) = scene.skeleton.as_ref().zip(scene.skin_weights()?) else {
        return Ok(None);
    };
    let unusable = |reason: String| scene.unusable(&settings.weights, &reason);
    if weights.len() != vertex_count {
        return Err(unusable(format!(
            "it has weights for {} vertices, but the forms have {vertex_count}; export them from one model",
            weights.len()
        ))
        .into());
    }
    let skeleton = skeleton(settings, scene.dimension())?;
    let skin = Skin::new(&weights, settings.joints.len()).map_err(|error| unusable(error.to_string()))?;
    Ok(Some(Rig::new(skeleton, skin)?))
}

fn skeleton(settings: &SkeletonSettings, dimension: usize) -> Result<Skeleton, RigError> {
    let joint = |settings: &JointSettings| {
        let turns = settings.turns.iter().map(|turn| Turn {
            adjective: turn.adjective,
            axis: turn.axis,
            degrees: turn.degrees,
            degrees_at_zero: turn.offset_degrees,
        });
        let shifts = settings.shifts.iter().map(|shift| Shift {
            adjective: shift.adjective,
            by: shift.by,
        });
        let scalings = settings.scalings.iter().map(|scaling| Scaling {
            adjective: scaling.adjective,
            factors: scaling.factors,
        });
        Joint {
            turns: turns.collect(),
            shifts: shifts.collect(),
            scalings: scalings.collect(),
            ..Joint::new(&settings.name, settings.parent, settings.origin)
        }
    };
    Skeleton::new(settings.joints.iter().map(joint).collect(), dimension)
}

/// The pictures of some examples, which must have one; all of one size.
pub(super) fn pictures(scene: &ShapeScene, examples: &[usize]) -> Result<Vec<Frame>, ShapeModelError> {
    let mut pictures: Vec<Frame> = Vec::new();
    for &index in examples {
        let Some(file) = &scene.examples[index].texture else {
            continue;
        };
        let unusable = |reason: String| scene.unusable(file, &reason);
        let picture = read_picture(&scene.read(file)?).map_err(|error| unusable(error.to_string()))?;
        let (width, height) = (picture.width, picture.height);
        if let Some(first) = pictures
            .first()
            .filter(|first| (first.width, first.height) != (width, height))
        {
            return Err(unusable(format!(
                "it is {width} x {height} pixels, that of example '{}' is {} x {}; make all pictures one size",
                scene.examples[examples[0]].name, first.width, first.height
            ))
            .into());
        }
        pictures.push(Frame {
            width,
            height,
            pixels: picture.pixels,
        });
    }
    Ok(pictures)
}
