//! A skeleton with its skin, and the runtime that takes a blended form to its pose.
//!
//! Source: SBE section 5. [`Rig`] unbends every example at its own place (equation 7); the blend of the unbent forms goes through
//! [`Poser`] at the place that is wanted (equation 8).
//!
//! Cost: O(joints + entries of the skin) a frame, no allocation once [`RigScratch`] has been used.

use super::rig_error::RigError;
use super::skeleton::Skeleton;
use super::skin::Skin;
use super::transform::Transform;
use super::untransform::{Residuals, RestForm, untransform};
use crate::math::Point3;

/// A skeleton and the skin on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    skeleton: Skeleton,
    skin: Skin,
}

/// What a [`Poser`] works with; one a thread, used again for every frame.
#[derive(Debug, Clone, Default)]
pub struct RigScratch {
    transforms: Vec<Transform>,
    /// The transforms' rows in single precision.
    rows: Vec<[f32; 12]>,
}

impl Rig {
    /// A skeleton and the skin on it.
    ///
    /// # Errors
    /// [`RigError::WrongJointCount`] if the skin was made for another number of joints.
    pub fn new(skeleton: Skeleton, skin: Skin) -> Result<Self, RigError> {
        if skeleton.joints().len() != skin.joint_count() {
            return Err(RigError::WrongJointCount {
                expected: skeleton.joints().len(),
                found: skin.joint_count(),
            });
        }
        Ok(Self { skeleton, skin })
    }

    /// The skeleton.
    #[must_use]
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// The skin.
    #[must_use]
    pub fn skin(&self) -> &Skin {
        &self.skin
    }

    /// Takes an example, modelled in the pose that the skeleton has at `place`, to the rest position (equation 7).
    ///
    /// # Errors
    /// [`RigError`] if the place or a position is not finite, or a length is wrong.
    pub fn untransform(&self, place: &[f64], posed: &[Point3]) -> Result<RestForm, RigError> {
        untransform(&self.skin, &self.skeleton.transforms(place)?, posed)
    }

    /// The runtime for blends of these examples, in the order of their weights.
    #[must_use]
    pub fn poser(self, examples: &[RestForm]) -> Poser {
        let residuals = Residuals::new(&self.skin, examples);
        Poser { rig: self, residuals }
    }
}

/// Takes blends of unbent examples to their pose (equation 8).
#[derive(Debug, Clone, PartialEq)]
pub struct Poser {
    rig: Rig,
    residuals: Residuals,
}

impl Poser {
    /// The skeleton and its skin.
    #[must_use]
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Moves `positions` (#vertices), the blend of the unbent examples with `weights`, to the pose at `place`.
    ///
    /// # Errors
    /// [`RigError`] if the place is not finite or a length is wrong.
    pub fn pose(
        &self,
        place: &[f64],
        weights: &[f64],
        positions: &mut [Point3],
        scratch: &mut RigScratch,
    ) -> Result<(), RigError> {
        let transforms = self.transforms(place, scratch)?;
        self.rig.skin.apply(transforms, positions)?;
        for (vertex, offset) in self.residuals.offsets(weights, transforms) {
            positions[vertex] += offset;
        }
        Ok(())
    }

    /// The same in single precision: `planes` are the x, the y and the z of all vertices.
    ///
    /// # Errors
    /// As [`Self::pose`].
    pub fn pose_planes(
        &self,
        place: &[f64],
        weights: &[f64],
        planes: [&mut [f32]; 3],
        scratch: &mut RigScratch,
    ) -> Result<(), RigError> {
        self.transforms(place, scratch)?;
        let RigScratch { transforms, rows } = scratch;
        let [xs, ys, zs] = planes;
        for plane in [&xs, &ys, &zs] {
            self.rig.skin.check(transforms.len(), plane.len())?;
        }
        rows.clear();
        rows.extend(transforms.iter().map(rows_of));
        for (vertex, ((x, y), z)) in xs.iter_mut().zip(&mut *ys).zip(&mut *zs).enumerate() {
            let blended;
            let row = match self.rig.skin.of(vertex) {
                &[(joint, _)] => &rows[joint],
                entries => {
                    blended = blended_rows(rows, entries);
                    &blended
                }
            };
            let (a, b, c) = (*x, *y, *z);
            *x = row[0] * a + row[1] * b + row[2] * c + row[3];
            *y = row[4] * a + row[5] * b + row[6] * c + row[7];
            *z = row[8] * a + row[9] * b + row[10] * c + row[11];
        }
        for (vertex, offset) in self.residuals.offsets(weights, transforms) {
            xs[vertex] += offset.x as f32;
            ys[vertex] += offset.y as f32;
            zs[vertex] += offset.z as f32;
        }
        Ok(())
    }

    fn transforms<'s>(&self, place: &[f64], scratch: &'s mut RigScratch) -> Result<&'s [Transform], RigError> {
        scratch
            .transforms
            .resize(self.rig.skeleton.joints().len(), Transform::IDENTITY);
        self.rig.skeleton.transforms_into(place, &mut scratch.transforms)?;
        Ok(&scratch.transforms)
    }
}

fn rows_of(transform: &Transform) -> [f32; 12] {
    let (m, t) = (&transform.linear, &transform.translation);
    [
        m.m11, m.m12, m.m13, t.x, m.m21, m.m22, m.m23, t.y, m.m31, m.m32, m.m33, t.z,
    ]
    .map(|x| x as f32)
}

fn blended_rows(rows: &[[f32; 12]], entries: &[(usize, f64)]) -> [f32; 12] {
    let mut blended = [0.0_f32; 12];
    for &(joint, weight) in entries {
        for (sum, value) in blended.iter_mut().zip(&rows[joint]) {
            *sum += weight as f32 * value;
        }
    }
    blended
}
