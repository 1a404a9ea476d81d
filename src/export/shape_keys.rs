//! The motion of a shape as formats with morph targets and joints have it, and where it needs keys.
//!
//! Samples of weights and of joints' poses -> some of them, between which players interpolate: weights and translations straight,
//! rotations by the shorter arc at even speed. A key goes as far as every sample on the way stays within the tolerance at
//! every vertex; ever longer ways are tried, then bisected. Of a motion between two keys not the weights but the vertices are
//! compared, bent by the joints as players bend them.
//!
//! Difference from [`place_keys`](super::place_keys): the keys are not the fewest there can be, since bent vertices do not move
//! straight between keys; but no way between two keys could be one sample longer.

use rayon::prelude::*;

use super::MotionError;
use crate::math::Point3;
use crate::shape3d::{Form, FormTopology, LocalPose, Matrix3, Rig, Transform};

/// Quaternions whose cosine is above this are interpolated straight: the sine of their angle has no digits left.
const NEARLY_EQUAL: f64 = 1.0 - 1e-9;

/// A shape that moves.
#[derive(Debug, Clone, Copy)]
pub struct ShapeMotion<'a> {
    /// What it is called.
    pub name: &'a str,
    /// Triangles and places in the texture.
    pub topology: &'a FormTopology,
    /// The examples' names, #examples.
    pub examples: &'a [String],
    /// The examples' forms, #examples at least 1; with a rig those in the rest position.
    pub forms: &'a [Form],
    /// Unit normals of the forms, #examples x #vertices.
    pub normals: &'a [Vec<Point3>],
    /// Joints and the skin on them.
    pub rig: Option<&'a Rig>,
    /// The picture on it, a PNG file.
    pub texture: Option<&'a [u8]>,
    /// Increasing, in seconds, at least one.
    pub times: &'a [f64],
    /// The state at each time.
    pub states: &'a [ShapeState],
    /// How far a vertex may be from where it belongs at any of the times, in the forms' unit.
    pub max_error: f64,
}

/// What a shape is at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeState {
    /// The weights of the examples, which sum to 1.
    pub weights: Vec<f64>,
    /// Each joint's pose relative to its parent; none without a rig.
    pub joints: Vec<LocalPose>,
}

/// What was written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeReport {
    /// How many keys there are.
    pub keys: usize,
    /// The largest distance of a vertex, at any of the times, from where the weights and joints of that time have it.
    pub worst: f64,
}

impl ShapeMotion<'_> {
    /// Says what does not fit together.
    pub(super) fn check(&self) -> Result<(), MotionError> {
        let count = self.forms.len();
        let joints = self.rig.map_or(0, |rig| rig.skeleton().joints().len());
        let vertices = self.topology.vertex_count();
        let fits = count > 0
            && self.examples.len() == count
            && self.normals.len() == count
            && self.normals.iter().all(|normals| normals.len() == vertices)
            && self.forms.iter().all(|form| form.positions().len() == vertices)
            && self.rig.is_none_or(|rig| rig.skin().vertex_count() == vertices);
        if !fits {
            return Err(MotionError::Vertices { expected: vertices });
        }
        let states = || self.states.iter();
        if self.times.is_empty()
            || self.times.len() != self.states.len()
            || states().any(|state| state.weights.len() != count || state.joints.len() != joints)
        {
            return Err(MotionError::States {
                times: self.times.len(),
                states: self.states.len(),
            });
        }
        Ok(())
    }

    /// The samples that are keys; the first and the last always are.
    pub(super) fn keys(&self) -> Vec<usize> {
        let last = self.states.len() - 1;
        let mut keys = vec![0];
        let mut from = 0;
        while from < last {
            let (mut fits, mut tried) = (from + 1, from + 2);
            while tried <= last && self.fits(from, tried) {
                fits = tried;
                tried = from + 2 * (tried - from);
            }
            // The end, if it was jumped over.
            if tried > last && fits < last && self.fits(from, last) {
                fits = last;
            }
            let mut fails = tried.min(last);
            while fails > fits + 1 {
                let middle = fits.midpoint(fails);
                if self.fits(from, middle) {
                    fits = middle;
                } else {
                    fails = middle;
                }
            }
            keys.push(fits);
            from = fits;
        }
        keys
    }

    /// What a player makes of the keys, compared with the samples.
    pub(super) fn worst(&self, keys: &[usize]) -> f64 {
        let pairs = keys.windows(2);
        let apart = |pair: &[usize]| {
            let (from, to) = (pair[0], pair[1]);
            (from + 1..to)
                .into_par_iter()
                .map(|at| self.error(from, at, to))
                .reduce(|| 0.0, f64::max)
        };
        pairs.map(apart).fold(0.0, f64::max)
    }

    fn fits(&self, from: usize, to: usize) -> bool {
        (from + 1..to)
            .into_par_iter()
            .all(|at| self.error(from, at, to) <= self.max_error)
    }

    /// The largest distance of a vertex at sample `at`.
    fn error(&self, from: usize, at: usize, to: usize) -> f64 {
        let part = (self.times[at] - self.times[from]) / (self.times[to] - self.times[from]);
        let between = self.states[from].toward(&self.states[to], part);
        let (shown, wanted) = (self.positions(&between), self.positions(&self.states[at]));
        let distances = shown.iter().zip(&wanted).map(|(a, b)| (a - b).norm());
        // Not a number is as far as can be.
        distances.fold(0.0, |worst, d| if d <= worst { worst } else { d })
    }

    /// Where vertices are, computed as players do: the first example, plus the others' differences to it times their weights,
    /// bent by the joints.
    pub(super) fn positions(&self, state: &ShapeState) -> Vec<Point3> {
        let base = self.forms[0].positions();
        let mut positions = base.to_vec();
        for (form, &weight) in self.forms.iter().zip(&state.weights).skip(1) {
            for ((sum, p), from) in positions.iter_mut().zip(form.positions()).zip(base) {
                *sum += (p - from) * weight;
            }
        }
        if let Some(rig) = self.rig {
            let transforms = joint_transforms(rig, &state.joints);
            for (vertex, p) in positions.iter_mut().enumerate() {
                *p = rig.skin().blended(vertex, &transforms).apply(*p);
            }
        }
        positions
    }
}

impl ShapeState {
    /// The state that players show a part of the way from this to another.
    fn toward(&self, other: &Self, part: f64) -> Self {
        let mixed = |a: f64, b: f64| a + (b - a) * part;
        Self {
            weights: self
                .weights
                .iter()
                .zip(&other.weights)
                .map(|(&a, &b)| mixed(a, b))
                .collect(),
            joints: (self.joints.iter().zip(&other.joints))
                .map(|(a, b)| LocalPose {
                    translation: a.translation.lerp(&b.translation, part),
                    rotation: slerp(a.rotation, b.rotation, part),
                    scale: a.scale.lerp(&b.scale, part),
                })
                .collect(),
        }
    }
}

/// What each joint does to the rest position.
fn joint_transforms(rig: &Rig, poses: &[LocalPose]) -> Vec<Transform> {
    let joints = rig.skeleton().joints();
    let mut nodes: Vec<Option<Transform>> = vec![None; joints.len()];
    // Parents may stand behind their children; no joint is its own ancestor.
    while nodes.iter().any(Option::is_none) {
        for (index, joint) in joints.iter().enumerate() {
            let own = Transform {
                linear: matrix_of(poses[index].rotation) * Matrix3::from_diagonal(&poses[index].scale),
                translation: poses[index].translation,
            };
            nodes[index] = match joint.parent {
                None => Some(own),
                Some(parent) => nodes[parent].map(|parent| parent.after(&own)),
            };
        }
    }
    let from_rest = |(node, joint): (Option<Transform>, &crate::shape3d::Joint)| {
        let node = node.unwrap_or(Transform::IDENTITY);
        Transform {
            linear: node.linear,
            translation: node.apply(-joint.origin),
        }
    };
    nodes.into_iter().zip(joints).map(from_rest).collect()
}

fn matrix_of([x, y, z, w]: [f64; 4]) -> Matrix3 {
    nalgebra::Unit::new_normalize(nalgebra::Quaternion::new(w, x, y, z))
        .to_rotation_matrix()
        .into_inner()
}

/// The rotation a part of the shorter way from `a` to `b`.
fn slerp(a: [f64; 4], b: [f64; 4], part: f64) -> [f64; 4] {
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    let cosine = dot.abs();
    let (from, to) = if cosine > NEARLY_EQUAL {
        (1.0 - part, part)
    } else {
        let angle = libm::acos(cosine);
        let sine = libm::sin(angle);
        (libm::sin((1.0 - part) * angle) / sine, libm::sin(part * angle) / sine)
    };
    std::array::from_fn(|k| a[k] * from + b[k] * to * sign)
}
