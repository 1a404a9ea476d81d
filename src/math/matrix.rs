//! 2 x 2 matrices and their split into a rotation and a stretch.

/// A 2 x 2 matrix that acts on column displacements. It is nalgebra's: `m * point`, `m.transpose()`, `m.determinant()`.
pub type Matrix = nalgebra::Matrix2<f64>;

/// The rotation by `angle_rad`, from x towards y.
#[must_use]
pub fn rotation(angle_rad: f64) -> Matrix {
    let (sin, cos) = libm::sincos(angle_rad);
    Matrix::new(cos, -sin, sin, cos)
}

/// A matrix written as `rotation(angle_rad) * stretch` with a symmetric `stretch`.
///
/// For a positive determinant this is the polar decomposition (Shoemake and Duff 1992) and `stretch` is positive
/// definite; for a negative one `stretch` is symmetric but indefinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolarSplit {
    /// The angle in `(-pi, pi]`.
    pub angle_rad: f64,
    /// The symmetric factor.
    pub stretch: Matrix,
}

impl PolarSplit {
    /// Splits `matrix`. In two dimensions the best-aligned rotation has the closed form
    /// `atan2(m21 - m12, m11 + m22)`, which needs no iteration.
    #[must_use]
    pub fn of(matrix: &Matrix) -> Self {
        let (along, across) = (matrix.m11 + matrix.m22, matrix.m21 - matrix.m12);
        let length = libm::hypot(along, across);
        // The rotation back by the angle, without its sine and cosine. A matrix without a direction is not turned.
        let (cos, sin) = if length > 0.0 {
            (along / length, across / length)
        } else {
            (1.0, 0.0)
        };
        let stretch = Matrix::new(cos, sin, -sin, cos) * matrix;
        // Symmetric up to rounding: the mean of the off-diagonals makes it exact.
        let off_diagonal = 0.5 * (stretch.m12 + stretch.m21);
        Self {
            angle_rad: Self::angle_rad_of(matrix),
            stretch: Matrix::new(stretch.m11, off_diagonal, off_diagonal, stretch.m22),
        }
    }

    /// The angle alone.
    #[must_use]
    pub fn angle_rad_of(matrix: &Matrix) -> f64 {
        libm::atan2(matrix.m21 - matrix.m12, matrix.m11 + matrix.m22)
    }

    /// The matrix again.
    #[must_use]
    pub fn matrix(&self) -> Matrix {
        rotation(self.angle_rad) * self.stretch
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turn_with_double_width() {
        let split = PolarSplit::of(&(rotation(std::f64::consts::FRAC_PI_2) * Matrix::new(2.0, 0.0, 0.0, 1.0)));
        assert!((split.angle_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!((split.stretch - Matrix::new(2.0, 0.0, 0.0, 1.0)).norm() < 1e-15);
    }

    proptest! {
        #[test]
        fn split_multiplies_back(a in -5.0..5.0f64, b in -5.0..5.0f64, c in -5.0..5.0f64, d in -5.0..5.0f64) {
            let matrix = Matrix::new(a, b, c, d);
            let split = PolarSplit::of(&matrix);
            prop_assert!((split.matrix() - matrix).norm() < 1e-12);
            if matrix.determinant() > 1e-6 {
                prop_assert!(split.stretch.determinant() > 0.0 && split.stretch.trace() > 0.0);
            }
        }
    }
}
