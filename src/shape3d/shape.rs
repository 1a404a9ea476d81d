//! Examples and their space, open to editing.
//!
//! Source: SBE 3 (equations 1 and 3) and 4.
//!
//! Forms of one topology, each with its place -> a form at any place: the sum of the forms times the weights of that place
//! (equation 3), extrapolated likewise. The weights are [`RbfWeights`], which refer to places alone, so
//! - moving an example, or changing pseudo-examples, fits the small system of the weights again and touches no form;
//! - inserting or removing an example fits it again and copies no other form;
//! - changing a form fits nothing.
//!
//! A blend that is nearly right is repaired like this: [`Shape::form_at`] its place, move vertices, [`Shape::insert_example`] there.
//!
//! With a skeleton the forms are those in the rest position (SBE 5), and so are the blends.

use super::{Form, FormError, FormTopology, ShapeError};
use crate::math::Point3;
use crate::weights::{PseudoPose, RbfOptions, RbfWeights, WeightProvider};

/// A form and its place in the space: one value an adjective.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// The form.
    pub form: Form,
    /// Where it belongs.
    pub at: Vec<f64>,
}

/// Forms of one topology and the weights that blend them.
///
/// ```
/// use inbetween::math::Point3;
/// use inbetween::shape3d::{Example, Form, FormTopology, Shape};
/// use inbetween::weights::RbfOptions;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let topology = FormTopology::from_triangles(3, vec![[0, 1, 2]])?;
/// let form = |height: f64| {
///     Form::new(&topology, vec![Point3::zeros(), Point3::x(), Point3::new(0.0, height, 0.0)])
/// };
/// let examples = vec![
///     Example { form: form(1.0)?, at: vec![0.0] },
///     Example { form: form(3.0)?, at: vec![1.0] },
/// ];
/// let shape = Shape::new(topology.clone(), examples, &RbfOptions::default())?;
/// let between = shape.form_at(&[0.5])?;
/// assert!((between.positions()[2].y - 2.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Shape {
    topology: FormTopology,
    forms: Vec<Form>,
    weights: RbfWeights,
}

impl Shape {
    /// The shape of `examples`, all of them forms of `topology`.
    ///
    /// # Errors
    /// [`ShapeError::Form`] if a form has another number of vertices, [`ShapeError::Weights`] if there is no example or the
    /// places do not define weights.
    pub fn new(topology: FormTopology, examples: Vec<Example>, options: &RbfOptions) -> Result<Self, ShapeError> {
        for (example, Example { form, .. }) in examples.iter().enumerate() {
            of_example(form.check(&topology), example)?;
        }
        let (forms, places): (Vec<Form>, Vec<Vec<f64>>) =
            examples.into_iter().map(|example| (example.form, example.at)).unzip();
        let weights = RbfWeights::new(&places, options)?;
        Ok(Self {
            topology,
            forms,
            weights,
        })
    }

    /// What the forms share.
    #[must_use]
    pub fn topology(&self) -> &FormTopology {
        &self.topology
    }

    /// The examples' forms.
    #[must_use]
    pub fn forms(&self) -> &[Form] {
        &self.forms
    }

    /// The weights over the space; their poses are the examples.
    #[must_use]
    pub fn weights(&self) -> &RbfWeights {
        &self.weights
    }

    /// How many adjectives there are.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.weights.dimension()
    }

    /// The form at a place (#adjectives).
    ///
    /// # Errors
    /// [`ShapeError::Weights`] if the place has the wrong number of values or is not finite, [`ShapeError::Form`] if the
    /// blend is not.
    pub fn form_at(&self, at: &[f64]) -> Result<Form, ShapeError> {
        let weights = self.weights.weights_at(at)?;
        let mut positions = vec![Point3::zeros(); self.topology.vertex_count()];
        self.blend(&weights, &mut positions)?;
        let form = Form::new(&self.topology, positions);
        form.map_err(|_| ShapeError::Weights(crate::weights::WeightError::NotFinite { at: at.to_vec() }))
    }

    /// The sum of the forms times `weights` (#examples), into `positions` (#vertices). See [`FormBlender`](super::FormBlender)
    /// for the fast way.
    ///
    /// # Errors
    /// [`ShapeError::WrongLength`].
    pub fn blend(&self, weights: &[f64], positions: &mut [Point3]) -> Result<(), ShapeError> {
        check_length("weights", self.forms.len(), weights.len())?;
        check_length("positions", self.topology.vertex_count(), positions.len())?;
        positions.fill(Point3::zeros());
        for (form, weight) in self.forms.iter().zip(weights) {
            for (sum, position) in positions.iter_mut().zip(form.positions()) {
                *sum += *position * *weight;
            }
        }
        Ok(())
    }

    /// Moves an example to another place. On an error nothing has changed.
    ///
    /// # Errors
    /// [`ShapeError::NoSuchExample`], [`ShapeError::Weights`].
    pub fn move_example(&mut self, example: usize, at: &[f64]) -> Result<(), ShapeError> {
        self.check_example(example)?;
        Ok(self.weights.move_pose(example, at)?)
    }

    /// Adds an example after the last one. On an error nothing has changed.
    ///
    /// # Errors
    /// [`ShapeError::Form`], [`ShapeError::Weights`].
    pub fn insert_example(&mut self, form: Form, at: &[f64]) -> Result<(), ShapeError> {
        of_example(form.check(&self.topology), self.forms.len())?;
        self.weights.insert_pose(at)?;
        self.forms.push(form);
        Ok(())
    }

    /// Takes an example out and hands its form back; later ones move up by one. On an error nothing has changed.
    ///
    /// # Errors
    /// [`ShapeError::NoSuchExample`], [`ShapeError::Weights`].
    pub fn remove_example(&mut self, example: usize) -> Result<Form, ShapeError> {
        self.check_example(example)?;
        self.weights.remove_pose(example)?;
        Ok(self.forms.remove(example))
    }

    /// Gives an example another form and hands the old one back. On an error nothing has changed.
    ///
    /// # Errors
    /// [`ShapeError::NoSuchExample`], [`ShapeError::Form`].
    pub fn replace_form(&mut self, example: usize, form: Form) -> Result<Form, ShapeError> {
        self.check_example(example)?;
        of_example(form.check(&self.topology), example)?;
        Ok(std::mem::replace(&mut self.forms[example], form))
    }

    /// Replaces the pseudo-examples: each takes the blend found at one place, without any pseudo-example, to another. On an
    /// error nothing has changed.
    ///
    /// # Errors
    /// [`ShapeError::Weights`].
    pub fn set_pseudo_examples(&mut self, pseudo_examples: Vec<PseudoPose>) -> Result<(), ShapeError> {
        Ok(self.weights.set_pseudo_poses(pseudo_examples)?)
    }

    fn check_example(&self, example: usize) -> Result<(), ShapeError> {
        let count = self.forms.len();
        match example < count {
            true => Ok(()),
            false => Err(ShapeError::NoSuchExample { example, count }),
        }
    }
}

fn of_example(checked: Result<(), FormError>, example: usize) -> Result<(), ShapeError> {
    checked.map_err(|problem| ShapeError::Form { example, problem })
}

pub(super) fn check_length(what: &'static str, expected: usize, found: usize) -> Result<(), ShapeError> {
    if expected == found {
        Ok(())
    } else {
        Err(ShapeError::WrongLength { what, expected, found })
    }
}

#[cfg(test)]
mod tests;
