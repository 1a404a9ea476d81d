//! Automatic layout: drawings that are alike lie near one another in the pose space.

use super::{PipelineError, map_drawings, read_drawings};
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

/// The scene with a place for every pose: its own, or those of its mapping.
pub(super) fn placed(scene: &Scene, mapping: &Mapping) -> Scene {
    match scene.layout {
        Layout::Given => scene.clone(),
        Layout::Automatic => scene.laid_out(&automatic_places(mapping)),
    }
}

/// The scene with a place for every pose. If the file gives none, its drawings are read and mapped for that, which takes as long
/// as [`map_drawings`].
///
/// # Errors
/// [`PipelineError`] if the drawings have to be mapped and cannot be.
pub fn laid_out(scene: Scene) -> Result<Scene, PipelineError> {
    if scene.layout == Layout::Given {
        return Ok(scene);
    }
    let drawings = read_drawings(&scene)?;
    let (mapping, _) = map_drawings(&scene, &drawings)?;
    Ok(placed(&scene, &mapping))
}
