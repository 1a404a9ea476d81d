//! A stretch of a shape's animation, for formats with morph targets and joints.

use super::{ShapeForm, ShapeModel, ShapeModelError};
use crate::export::{ShapeMotion, ShapeState};
use crate::math::Point3;
use crate::scene::ShapeScene;
use crate::shape3d::{Form, ShapeError};

/// Forms, normals and states of a stretch: what a [`ShapeMotion`] refers to.
#[derive(Debug)]
pub struct ShapeTake<'a> {
    model: &'a ShapeModel,
    name: String,
    examples: Vec<String>,
    forms: Vec<Form>,
    normals: Vec<Vec<Point3>>,
    times: Vec<f64>,
    states: Vec<ShapeState>,
    texture: Option<Vec<u8>>,
}

impl ShapeModel {
    /// The places of the geometry at `times` (increasing, in seconds) as states. `texture` is a PNG file.
    ///
    /// # Errors
    /// [`ShapeModelError`] if a place gives no form.
    pub fn take(
        &self,
        scene: &ShapeScene,
        times: Vec<f64>,
        places: &[Vec<f64>],
        texture: Option<Vec<u8>>,
    ) -> Result<ShapeTake<'_>, ShapeModelError> {
        let mut take = ShapeTake {
            model: self,
            name: scene.short_name(),
            examples: scene.examples.iter().map(|example| example.name.clone()).collect(),
            forms: Vec::new(),
            normals: Vec::new(),
            times,
            states: Vec::new(),
            texture,
        };
        for (example, form) in self.shape.forms().iter().enumerate() {
            let (positions, normals) = self.surface_of(form.positions().to_vec())?;
            let problem = |problem| ShapeError::Form { example, problem };
            take.forms.push(Form::new(self.topology(), positions).map_err(problem)?);
            take.normals.push(normals);
        }
        for place in places {
            take.states.push(ShapeState {
                weights: self.weights_at(place)?,
                joints: match &self.poser {
                    Some(poser) => poser.rig().skeleton().local_poses(place)?,
                    None => Vec::new(),
                },
            });
        }
        Ok(take)
    }

    /// The forms at places, one by one.
    ///
    /// # Errors
    /// [`ShapeModelError`] if a place gives no form.
    pub fn forms_at(&self, places: &[Vec<f64>]) -> Result<Vec<ShapeForm>, ShapeModelError> {
        use rayon::prelude::*;
        places.par_iter().map(|place| self.form_at(place)).collect()
    }
}

impl ShapeTake<'_> {
    /// What is exported. `max_error` is a share of the diagonal of the examples' common box.
    #[must_use]
    pub fn motion(&self, max_error: f64) -> ShapeMotion<'_> {
        ShapeMotion {
            name: &self.name,
            topology: self.model.topology(),
            examples: &self.examples,
            forms: &self.forms,
            normals: &self.normals,
            rig: self.model.poser.as_ref().map(|poser| poser.rig()),
            texture: self.texture.as_deref(),
            times: &self.times,
            states: &self.states,
            max_error: max_error * self.diagonal(),
        }
    }

    /// The diagonal of the examples' common box.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        let mut points = self.forms.iter().flat_map(Form::positions);
        let Some(first) = points.next() else { return 0.0 };
        let (low, high) = points.fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)));
        (high - low).norm()
    }
}
