//! Affine maps of space: what a joint does to the skin, and the quaternions that animation formats want.

use crate::math::Point3;

/// A 3 x 3 matrix that acts on column displacements: nalgebra's.
pub type Matrix3 = nalgebra::Matrix3<f64>;

/// An affine map of space: `x -> linear x + translation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// What displacements are multiplied by.
    pub linear: Matrix3,
    /// Where the origin goes.
    pub translation: Point3,
}

impl Transform {
    /// Nothing moves.
    pub const IDENTITY: Self = Self {
        linear: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        translation: Point3::new(0.0, 0.0, 0.0),
    };

    /// Everything becomes nothing: what a sum of transforms starts from.
    pub const ZERO: Self = Self {
        linear: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        translation: Point3::new(0.0, 0.0, 0.0),
    };

    /// Where `point` goes.
    #[must_use]
    pub fn apply(&self, point: Point3) -> Point3 {
        self.linear * point + self.translation
    }

    /// First `inner`, then this.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        Self {
            linear: self.linear * inner.linear,
            translation: self.apply(inner.translation),
        }
    }

    /// Adds `weight` times another transform, number by number.
    pub fn add_scaled(&mut self, weight: f64, other: &Self) {
        self.linear += other.linear * weight;
        self.translation += other.translation * weight;
    }

    /// Whether all twelve numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.linear.iter().chain(self.translation.iter()).all(|x| x.is_finite())
    }
}

/// The quaternion `(x, y, z, w)` of the turn by `angle_rad` about the unit vector `axis`, by the right-hand rule.
pub(super) fn quaternion_about(axis: Point3, angle_rad: f64) -> [f64; 4] {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    [axis.x * sin, axis.y * sin, axis.z * sin, cos]
}

/// The quaternion of the turn `b` followed by the turn `a`.
pub(super) fn quaternion_product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    let [ax, ay, az, aw] = a;
    let [bx, by, bz, bw] = b;
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// The matrix of a unit quaternion.
pub(super) fn rotation_of([x, y, z, w]: [f64; 4]) -> Matrix3 {
    Matrix3::new(
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - z * w),
        2.0 * (x * z + y * w),
        2.0 * (x * y + z * w),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - x * w),
        2.0 * (x * z - y * w),
        2.0 * (y * z + x * w),
        1.0 - 2.0 * (x * x + y * y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

    #[test]
    fn quarter_turns_by_hand() {
        let z = quaternion_about(Point3::z(), FRAC_PI_2);
        assert!((rotation_of(z) * Point3::x() - Point3::y()).norm() < 1e-15);
        // First about z, which takes x to y, then about x, which takes y to z.
        let both = quaternion_product(quaternion_about(Point3::x(), FRAC_PI_2), z);
        assert!((rotation_of(both) * Point3::x() - Point3::z()).norm() < 1e-15);
    }

    #[test]
    fn products_of_quaternions_are_products_of_matrices() {
        let a = quaternion_about(Point3::new(1.0, 2.0, -0.5).normalize(), 0.7);
        let b = quaternion_about(Point3::new(-0.3, 0.2, 0.9).normalize(), FRAC_PI_3);
        let difference = rotation_of(quaternion_product(a, b)) - rotation_of(a) * rotation_of(b);
        assert!(difference.norm() < 1e-14);
    }

    #[test]
    fn one_after_the_other() {
        let shift = Transform {
            translation: Point3::x(),
            ..Transform::IDENTITY
        };
        let turn = Transform {
            linear: rotation_of(quaternion_about(Point3::z(), FRAC_PI_2)),
            ..Transform::IDENTITY
        };
        assert!((turn.after(&shift).apply(Point3::zeros()) - Point3::y()).norm() < 1e-15);
        assert!((shift.after(&turn).apply(Point3::zeros()) - Point3::x()).norm() < 1e-15);
    }
}
