//! Automatic layout: drawings that are alike lie near one another in the pose space.

use super::{PipelineError, layer};
use crate::pose::{Mapping, deformation_distances};
use crate::scene::{Layout, Scene};
use crate::weights::arrange;

/// Places in the plane for the poses of a mapping, by how far one has to be deformed into the other: see
/// [`deformation_distances`] and [`arrange`].
#[must_use]
pub fn automatic_places(mapping: &Mapping) -> Vec<Vec<f64>> {
    let places = arrange(&deformation_distances(&mapping.poses));
    places.into_iter().map(Vec::from).collect()
}

/// The scene with a place for every pose: its own, or those of the first of its layers that all poses have. A layer is given by
/// its poses and its mapping.
pub(super) fn placed<'a>(
    scene: &Scene,
    layers: impl IntoIterator<Item = (&'a [usize], &'a Mapping)>,
) -> Result<Scene, PipelineError> {
    if scene.layout == Layout::Given {
        return Ok(scene.clone());
    }
    let mut whole = layers.into_iter().filter(|(poses, _)| poses.len() == scene.poses.len());
    let (_, mapping) = whole.next().ok_or_else(no_common_layer)?;
    Ok(scene.laid_out(&automatic_places(mapping)))
}

fn no_common_layer() -> PipelineError {
    PipelineError::stage(
        &[],
        None,
        "pose space: no layer is in all poses, so the poses cannot be compared; give every pose its place, `at`",
    )
}

/// The scene with a place for every pose. If the file gives none, its drawings are read and mapped for that, which takes as long
/// as [`map_drawings`](super::map_drawings); of a scene with layers, those of its first layer that all poses have.
///
/// # Errors
/// [`PipelineError`] if the drawings have to be mapped and cannot be.
pub fn laid_out(scene: Scene) -> Result<Scene, PipelineError> {
    if scene.layout == Layout::Given {
        return Ok(scene);
    }
    let whole = layer::parts(&scene)
        .into_iter()
        .find(|part| part.poses.len() == scene.poses.len())
        .ok_or_else(no_common_layer)?;
    let (_, mapping, _) = whole.mapped()?;
    placed(&scene, [(whole.poses.as_slice(), &mapping)])
}
