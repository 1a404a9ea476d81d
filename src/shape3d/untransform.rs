//! Examples are unbent into the rest position, so that bending the blend of them gives the examples back.
//!
//! Source: SBE section 5, equations 7 and 8.
//!
//! - [`untransform`]: a form modelled in some pose in, the form in the rest position out that the blended transforms of this
//!   pose take to it: `x0 = (sum alpha_k T_k)^-1 x` (equation 7).
//! - [`Residuals`] and [`Skin::apply`]: the blend of such forms is taken to a pose by the blended transforms of that pose
//!   (equation 8).
//!
//! Difference from the paper, which says nothing about blends that have no inverse: half and half of two joints with half a turn
//! between them squashes space to a line. A blend is *near-singular* where its condition, the ratio of its largest and
//! smallest singular value, is above [`CONDITION_LIMIT`]. There:
//! 1. The vertex is put where the joint it follows most would have it in the rest position.
//! 2. From there it is corrected by the blend's inverse, whose singular values are limited to [`CONDITION_LIMIT`] times the
//!    smallest: in the directions that the blend keeps, nothing changes; in those that it squashes, the form in the rest
//!    position is not blown up.
//! 3. What is missing then at the example is kept as a [`NearSingular::residual`] in the frame of that joint. The residuals of
//!    the examples are blended with the examples' weights and added after the transform, so that every example is met
//!    exactly, wherever the rest of the body has been taken.
//!
//! Each such vertex is reported with its joints and its condition.

use super::rig_error::RigError;
use super::skin::Skin;
use super::transform::{Matrix3, Transform};
use crate::math::Point3;

/// Blended transforms with a larger condition are near-singular. For two joints that count half each it is reached at 168
/// degrees between them. A rest position is at most this many times as far stretched as the example.
pub const CONDITION_LIMIT: f64 = 10.0;

/// A blend whose largest singular value is below this fraction of the heaviest joint's own has no direction left.
const NOTHING_LEFT: f64 = 1e-9;

/// A vertex whose blended transform has no usable inverse.
#[derive(Debug, Clone, PartialEq)]
pub struct NearSingular {
    /// The vertex.
    pub vertex: usize,
    /// The joints it follows.
    pub joints: Vec<usize>,
    /// The ratio of the largest and the smallest singular value of its blended transform; infinite if that is singular.
    pub condition: f64,
    /// What the rest position lacks, as the joint that the vertex follows most sees it in the rest position.
    pub residual: Point3,
}

/// An example in the rest position.
#[derive(Debug, Clone, PartialEq)]
pub struct RestForm {
    /// #vertices.
    pub positions: Vec<Point3>,
    /// The vertices that could not simply be unbent, by their number.
    pub near_singular: Vec<NearSingular>,
}

/// Takes a form that was modelled in the pose of `transforms` (#joints) to the rest position (equation 7).
///
/// # Errors
/// [`RigError`] if a length is wrong or a position is not finite.
pub fn untransform(skin: &Skin, transforms: &[Transform], posed: &[Point3]) -> Result<RestForm, RigError> {
    skin.check(transforms.len(), posed.len())?;
    let mut rest = RestForm {
        positions: Vec::with_capacity(posed.len()),
        near_singular: Vec::new(),
    };
    for (vertex, &position) in posed.iter().enumerate() {
        if !position.iter().all(|x| x.is_finite()) {
            return Err(RigError::PositionNotFinite { vertex });
        }
        let blended = skin.blended(vertex, transforms);
        let singular = blended.linear.singular_values();
        let condition = condition_of(&singular);
        let exact = if condition <= CONDITION_LIMIT {
            solved(&blended, position)
        } else {
            None
        };
        if let Some(exact) = exact {
            rest.positions.push(exact);
            continue;
        }
        // Weights sum to 1, so there is a joint.
        let heaviest = skin
            .heaviest(vertex)
            .map_or(Transform::IDENTITY, |joint| transforms[joint]);
        let near = limited(&blended, &heaviest, position);
        rest.positions.push(near);
        rest.near_singular.push(NearSingular {
            vertex,
            joints: skin.of(vertex).iter().map(|entry| entry.0).collect(),
            condition,
            residual: pseudo_inverse(&heaviest.linear, f64::INFINITY) * (position - blended.apply(near)),
        });
    }
    Ok(rest)
}

fn condition_of(singular: &nalgebra::Vector3<f64>) -> f64 {
    let (largest, smallest) = (singular.max(), singular.min());
    if smallest > 0.0 {
        largest / smallest
    } else {
        f64::INFINITY
    }
}

/// The point that `blended` takes to `position`, with one step of refinement.
fn solved(blended: &Transform, position: Point3) -> Option<Point3> {
    let inverse = blended.linear.try_inverse()?;
    let first = inverse * (position - blended.translation);
    Some(first + inverse * (position - blended.apply(first)))
}

/// Near where `heaviest` alone would have the point in the rest position, so that `blended` takes it near `position`.
fn limited(blended: &Transform, heaviest: &Transform, position: Point3) -> Point3 {
    let guess = solved(heaviest, position).unwrap_or(position);
    let largest = blended.linear.singular_values().max();
    if largest <= NOTHING_LEFT * heaviest.linear.singular_values().max() {
        return guess;
    }
    guess + pseudo_inverse(&blended.linear, CONDITION_LIMIT) * (position - blended.apply(guess))
}

/// The inverse with singular values up to `limit` times the smallest; what is squashed to nothing stays nothing.
fn pseudo_inverse(matrix: &Matrix3, limit: f64) -> Matrix3 {
    let parts = matrix.svd(true, true);
    let floor = parts.singular_values.max() / limit;
    let inverses = parts.singular_values.map(|value| {
        let limited = value.max(floor);
        if limited > 0.0 { 1.0 / limited } else { 0.0 }
    });
    match (parts.u, parts.v_t) {
        (Some(u), Some(v_t)) => v_t.transpose() * Matrix3::from_diagonal(&inverses) * u.transpose(),
        _ => Matrix3::zeros(),
    }
}

/// What the rest positions of all examples lack, by vertex.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Residuals {
    example_count: usize,
    /// The vertices that lack something in any example, increasing, and the joint that each follows most.
    vertices: Vec<(usize, usize)>,
    /// #vertices x #examples.
    residuals: Vec<Point3>,
}

impl Residuals {
    /// Collects what `examples` lack on `skin`.
    #[must_use]
    pub fn new(skin: &Skin, examples: &[RestForm]) -> Self {
        let mut lacking: Vec<usize> = examples
            .iter()
            .flat_map(|example| example.near_singular.iter().map(|near| near.vertex))
            .collect();
        lacking.sort_unstable();
        lacking.dedup();
        let vertices: Vec<(usize, usize)> = lacking
            .into_iter()
            .filter_map(|vertex| Some((vertex, skin.heaviest(vertex)?)))
            .collect();
        let mut residuals = vec![Point3::zeros(); vertices.len() * examples.len()];
        for (example, form) in examples.iter().enumerate() {
            for near in &form.near_singular {
                if let Ok(row) = vertices.binary_search_by_key(&near.vertex, |entry| entry.0) {
                    residuals[row * examples.len() + example] = near.residual;
                }
            }
        }
        Self {
            example_count: examples.len(),
            vertices,
            residuals,
        }
    }

    /// Whether every example could simply be unbent.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// What has to be added to each vertex in the pose of `transforms`, for the examples' `weights`: `(vertex, offset)`.
    /// Nothing is allocated.
    pub fn offsets<'a>(
        &'a self,
        weights: &'a [f64],
        transforms: &'a [Transform],
    ) -> impl Iterator<Item = (usize, Point3)> + 'a {
        let rows = self.residuals.chunks_exact(self.example_count.max(1));
        self.vertices.iter().zip(rows).map(move |(&(vertex, joint), row)| {
            let blended: Point3 = row
                .iter()
                .zip(weights)
                .map(|(residual, &weight)| residual * weight)
                .sum();
            let linear = transforms
                .get(joint)
                .map_or_else(Matrix3::zeros, |transform| transform.linear);
            (vertex, linear * blended)
        })
    }
}

#[cfg(test)]
mod tests;
