//! Automatic layout: drawings that are alike lie near one another in the pose space.

use super::PipelineError;
use super::layer::LayerShape;
use super::spec::{CharacterSpec, LayerRole, Places};
use crate::pose::{Mapping, deformation_distances};
use crate::weights::arrange;

/// Places in the plane for the poses of a mapping, by how far one has to be deformed into the other: see
/// [`deformation_distances`] and [`arrange`].
#[must_use]
pub fn automatic_places(mapping: &Mapping) -> Vec<Vec<f64>> {
    let places = arrange(&deformation_distances(&mapping.poses));
    places.into_iter().map(Vec::from).collect()
}

impl CharacterSpec {
    /// The layer that automatic places come from: the first that all poses have, loose parts last.
    ///
    /// # Errors
    /// [`PipelineError::NoCommonLayer`] if there is none.
    pub fn layer_of_places(&self) -> Result<usize, PipelineError> {
        let has_all = |k: &usize| self.layers[*k].poses.len() == self.space.poses.len();
        let is_body = |k: &usize| self.layers[*k].role == LayerRole::Body;
        let common: Vec<usize> = (0..self.layers.len()).filter(has_all).collect();
        let first = common.iter().find(|k| is_body(k)).or(common.first());
        first.copied().ok_or(PipelineError::NoCommonLayer)
    }
}

/// A place for every pose: its own, or by how far the shapes of a layer that all poses have are from one another.
pub(super) fn placed(spec: &CharacterSpec, shapes: &[LayerShape]) -> Result<Vec<Vec<f64>>, PipelineError> {
    match &spec.space.places {
        Places::Given(places) => Ok(places.clone()),
        Places::Automatic => {
            let shape = &shapes[spec.layer_of_places()?];
            let mut places = vec![Vec::new(); spec.space.poses.len()];
            // The layer may have the poses in another order.
            for (place, &pose) in automatic_places(shape.mapping()).into_iter().zip(shape.poses()) {
                places[pose] = place;
            }
            Ok(places)
        }
    }
}
