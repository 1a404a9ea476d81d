//! The spaces of a shape: one of its forms, and one of its textures (SBE 6.3).

use super::ShapeModelError;
use crate::scene::{ShapeScene, Subject};
use crate::weights::{PseudoPose, RbfOptions, RbfWeights, WeightError, WeightProvider};

/// The weights of a scene's examples over their space, known without any form.
#[derive(Debug, Clone)]
pub struct ShapeSpace {
    geometry: RbfWeights,
    textures: Option<TextureSpace>,
}

/// The weights of those examples that have a texture.
#[derive(Debug, Clone)]
pub(super) struct TextureSpace {
    /// The examples that have one.
    pub(super) examples: Vec<usize>,
    pub(super) weights: RbfWeights,
}

impl ShapeSpace {
    /// The spaces of a scene. No file is opened.
    ///
    /// # Errors
    /// [`ShapeModelError::Space`], naming examples, if their places allow no weights.
    pub fn new(scene: &ShapeScene) -> Result<Self, ShapeModelError> {
        Ok(Self {
            geometry: fitted(scene, Subject::Geometry)?,
            textures: TextureSpace::new(scene)?,
        })
    }

    /// The weights of the forms at a place (#adjectives), one an example.
    ///
    /// # Errors
    /// [`ShapeModelError`] if the place has the wrong number of values or is not finite.
    pub fn weights_at(&self, place: &[f64]) -> Result<Vec<f64>, ShapeModelError> {
        Ok(self.geometry.weights_at(place)?)
    }

    /// The weights of the textures at a place, one an example, 0 for those without one; none where no example has one.
    ///
    /// # Errors
    /// As [`Self::weights_at`].
    pub fn texture_weights_at(&self, place: &[f64]) -> Result<Vec<f64>, ShapeModelError> {
        let Some(textures) = &self.textures else {
            return Ok(Vec::new());
        };
        let own = textures.weights.weights_at(place)?;
        let mut weights = vec![0.0; self.geometry.pose_count()];
        for (&example, weight) in textures.examples.iter().zip(own) {
            weights[example] = weight;
        }
        Ok(weights)
    }
}

impl TextureSpace {
    /// That of a scene, if any example has a texture.
    pub(super) fn new(scene: &ShapeScene) -> Result<Option<Self>, ShapeModelError> {
        if !scene.is_textured() {
            return Ok(None);
        }
        Ok(Some(Self {
            examples: members(scene, Subject::Texture),
            weights: fitted(scene, Subject::Texture)?,
        }))
    }
}

/// What the weights of a subject are told.
pub(super) fn options(scene: &ShapeScene, subject: Subject) -> RbfOptions {
    let pseudo_examples = scene.pseudo_examples.iter().filter(|pseudo| match subject {
        Subject::Texture => pseudo.of.is_texture(),
        _ => pseudo.of.is_geometry(),
    });
    RbfOptions {
        radial: scene.radial,
        pseudo_poses: pseudo_examples
            .map(|pseudo| PseudoPose {
                from: pseudo.from.clone(),
                at: pseudo.at.clone(),
            })
            .collect(),
    }
}

/// Why there are no weights, with the names of examples.
pub(super) fn refusal(scene: &ShapeScene, subject: Subject, error: &WeightError) -> ShapeModelError {
    let examples = members(scene, subject);
    let name = |pose: usize| match examples.get(pose) {
        Some(&example) => format!("'{}'", scene.examples[example].name),
        None => format!("pseudo-example {}", pose - examples.len()),
    };
    ShapeModelError::Space {
        what: match subject {
            Subject::Texture => "space of the textures",
            _ => "space of the examples",
        },
        // The weights' own words for them.
        reason: error
            .naming(name)
            .replace("pose space", "space")
            .replace("poses", "examples"),
    }
}

/// The examples that a subject is about.
fn members(scene: &ShapeScene, subject: Subject) -> Vec<usize> {
    let is_member = |&k: &usize| subject != Subject::Texture || scene.examples[k].texture.is_some();
    (0..scene.examples.len()).filter(is_member).collect()
}

fn fitted(scene: &ShapeScene, subject: Subject) -> Result<RbfWeights, ShapeModelError> {
    let place = |k: usize| match subject {
        Subject::Texture => scene.examples[k].texture_at.clone(),
        _ => scene.examples[k].at.clone(),
    };
    let places: Vec<Vec<f64>> = members(scene, subject).into_iter().map(place).collect();
    RbfWeights::new(&places, &options(scene, subject)).map_err(|error| refusal(scene, subject, &error))
}
