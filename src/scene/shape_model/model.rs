//! A shape, opened from its scene.

use super::textures::Textures;
use super::{ShapeModelError, ShapeNote, files, space};
use crate::math::Point3;
use crate::render::Frame;
use crate::scene::{ShapeScene, SubdivisionSettings, Subject, SurfacePoints};
use crate::shape3d::{
    Example, Form, FormTopology, LoopSubdivision, NormalWeighting, Poser, Rig, RigScratch, Shape, ShapeError,
    SubdividedPositions, SubdivisionOptions, subdivide_texture, vertex_normals,
};
use crate::weights::WeightProvider;

/// A shape with everything that is computed once. It is immutable and is asked from many threads.
///
/// ```no_run
/// use inbetween::scene::{ShapeModel, ShapeScene};
/// use std::path::Path;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = ShapeScene::open(Path::new("data/shapes/bendable/scene.toml"))?;
/// let model = ShapeModel::open(&scene)?;
/// let form = model.form_at(&[0.5, 0.2])?;
/// assert_eq!(form.positions.len(), model.topology().vertex_count());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct ShapeModel {
    pub(super) shape: Shape,
    pub(super) poser: Option<Poser>,
    pub(super) subdivision: Option<LoopSubdivision>,
    surface: FormTopology,
    textures: Option<Textures>,
    notes: Vec<ShapeNote>,
}

/// A form of the shape.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeForm {
    /// The weights of the examples in it.
    pub weights: Vec<f64>,
    /// Positions, #vertices of [`ShapeModel::topology`].
    pub positions: Vec<Point3>,
    /// Unit normals, #vertices.
    pub normals: Vec<Point3>,
}

impl ShapeModel {
    /// Reads the files of a scene and prepares everything.
    ///
    /// # Errors
    /// [`ShapeModelError`] if a file cannot be used, forms are not of one topology, or the places allow no weights.
    pub fn open(scene: &ShapeScene) -> Result<Self, ShapeModelError> {
        let (topology, forms) = files::forms(scene)?;
        let rig = files::rig(scene, topology.vertex_count())?;
        let subdivision = subdivision(scene, &topology)?;
        let surface = match &subdivision {
            Some(fine) => subdivided_topology(scene, fine, &topology)?,
            None => topology.clone(),
        };
        let mut notes = Vec::new();
        let mut model_forms = forms;
        let mut per_frame = subdivision;
        let mut blended_topology = topology;
        let mut poser = None;
        if let Some(coarse) = rig {
            let mut rig = coarse;
            if let Some(fine) = per_frame.take() {
                let skin = rig.skin().combined(fine.stencils())?;
                rig = Rig::new(rig.skeleton().clone(), skin)?;
                for form in &mut model_forms {
                    *form = fine
                        .positions(form)
                        .map_err(|error| of_subdivision(scene, &error.to_string()))?;
                }
                blended_topology = surface.clone();
            }
            let mut rest_forms = Vec::new();
            for (form, example) in model_forms.iter_mut().zip(&scene.examples) {
                let rest = rig.untransform(&example.at, form)?;
                notes.extend(ShapeNote::near_singular(&example.name, &rest.near_singular, &rig));
                form.clone_from(&rest.positions);
                rest_forms.push(rest);
            }
            poser = Some(rig.poser(&rest_forms));
        }
        let examples = (model_forms.into_iter().zip(&scene.examples))
            .map(|(positions, example)| {
                let form = Form::new(&blended_topology, positions)
                    .map_err(|error| scene.unusable(&example.form, &error.to_string()))?;
                let at = example.at.clone();
                Ok(Example { form, at })
            })
            .collect::<Result<Vec<_>, ShapeModelError>>()?;
        let shape = Shape::new(blended_topology, examples, &space::options(scene, Subject::Geometry));
        let shape = shape.map_err(|error| match error {
            ShapeError::Weights(error) => space::refusal(scene, Subject::Geometry, &error),
            other => other.into(),
        })?;
        Ok(Self {
            shape,
            poser,
            subdivision: per_frame,
            surface,
            textures: Textures::read(scene)?,
            notes,
        })
    }

    /// The vertices, faces and texture coordinates of its forms: as they were modelled, or subdivided.
    #[must_use]
    pub fn topology(&self) -> &FormTopology {
        &self.surface
    }

    /// The shape that is blended: with a skeleton its forms are in the rest position.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What the designer should know: vertices whose joints leave no usable inverse.
    #[must_use]
    pub fn notes(&self) -> &[ShapeNote] {
        &self.notes
    }

    /// The weights of the examples at a place (#adjectives).
    ///
    /// # Errors
    /// [`ShapeModelError`] if the place has the wrong number of values or is not finite.
    pub fn weights_at(&self, place: &[f64]) -> Result<Vec<f64>, ShapeModelError> {
        Ok(self.shape.weights().weights_at(place)?)
    }

    /// The texture at a place of the textures; `None` without textures.
    ///
    /// # Errors
    /// As [`Self::weights_at`].
    pub fn texture_at(&self, place: &[f64]) -> Result<Option<Frame>, ShapeModelError> {
        self.textures.as_ref().map(|textures| textures.at(place)).transpose()
    }

    /// The form at a place (#adjectives): blended, taken to its pose, subdivided.
    ///
    /// # Errors
    /// As [`Self::weights_at`].
    pub fn form_at(&self, place: &[f64]) -> Result<ShapeForm, ShapeModelError> {
        let weights = self.weights_at(place)?;
        let mut control = vec![Point3::zeros(); self.shape.topology().vertex_count()];
        self.shape.blend(&weights, &mut control)?;
        if let Some(poser) = &self.poser {
            poser.pose(place, &weights, &mut control, &mut RigScratch::default())?;
        }
        let (positions, normals) = self.surface_of(control)?;
        Ok(ShapeForm {
            weights,
            positions,
            normals,
        })
    }

    /// Positions and normals of the surface that a control form stands for.
    pub(super) fn surface_of(&self, control: Vec<Point3>) -> Result<(Vec<Point3>, Vec<Point3>), ShapeModelError> {
        let Some(fine) = &self.subdivision else {
            let normals = vertex_normals(&control, self.surface.triangles(), NormalWeighting::Angle);
            return Ok((control, normals));
        };
        let mut positions = vec![Point3::zeros(); fine.vertex_count()];
        let mut normals = positions.clone();
        fine.apply(&control, &mut positions, &mut normals)?;
        Ok((positions, normals))
    }
}

fn subdivision(scene: &ShapeScene, topology: &FormTopology) -> Result<Option<LoopSubdivision>, ShapeModelError> {
    let SubdivisionSettings { steps, points } = scene.subdivision;
    if steps == 0 {
        return Ok(None);
    }
    let options = SubdivisionOptions {
        steps,
        positions: match points {
            SurfacePoints::Limit => SubdividedPositions::Limit,
            SurfacePoints::Refined => SubdividedPositions::Refined,
        },
    };
    LoopSubdivision::new(topology.vertex_count(), topology.triangles(), &options)
        .map(Some)
        .map_err(|error| of_subdivision(scene, &error.to_string()))
}

fn of_subdivision(scene: &ShapeScene, reason: &str) -> ShapeModelError {
    scene
        .unusable(&scene.examples[0].form, &format!("it cannot be subdivided: {reason}"))
        .into()
}

fn subdivided_topology(
    scene: &ShapeScene,
    fine: &LoopSubdivision,
    topology: &FormTopology,
) -> Result<FormTopology, ShapeModelError> {
    let texture = subdivide_texture(
        topology.texture_coordinates(),
        topology.texture_triangles(),
        scene.subdivision.steps,
    )
    .map_err(|error| of_subdivision(scene, &error.to_string()))?;
    let triangles = fine.triangles().to_vec();
    FormTopology::from_textured_triangles(fine.vertex_count(), triangles, texture.coordinates, texture.triangles)
        .map_err(|error| of_subdivision(scene, &error.to_string()))
}
