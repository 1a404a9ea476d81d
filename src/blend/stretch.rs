//! Symmetric 2 x 2 stretches, and their blends.

use crate::math::Matrix;

/// A symmetric 2 x 2 matrix: entries (1,1), (1,2), (2,2).
pub type Symmetric = [f64; 3];

/// The three entries of a symmetric matrix.
#[must_use]
pub fn entries(matrix: &Matrix) -> Symmetric {
    [matrix.m11, 0.5 * (matrix.m12 + matrix.m21), matrix.m22]
}

/// The matrix with these entries.
#[must_use]
pub fn matrix([a, b, c]: Symmetric) -> Matrix {
    Matrix::new(a, b, b, c)
}

/// The sum of `terms`, each multiplied by its weight.
#[must_use]
pub fn combination(weights: &[f64], terms: &[Symmetric]) -> Symmetric {
    let mut sum = [0.0; 3];
    for (weight, term) in weights.iter().zip(terms) {
        for (entry, value) in sum.iter_mut().zip(term) {
            *entry += weight * value;
        }
    }
    sum
}

/// The logarithm of a positive definite matrix whose determinant is known; the determinant is taken as given because
/// for needles the entries no longer hold it.
#[must_use]
pub fn logarithm([a, b, c]: Symmetric, determinant: f64) -> Symmetric {
    let (mean, half, radius) = mean_and_radius([a, b, c]);
    let larger = mean + radius;
    // ln(larger) - ln(smaller), with smaller = determinant / larger.
    let difference = 2.0 * larger.ln() - determinant.ln();
    let middle = 0.5 * determinant.ln();
    // The limit for equal eigenvalues is 1 / mean.
    let slope = if radius > f64::EPSILON * mean {
        difference / (2.0 * radius)
    } else {
        mean.recip()
    };
    [middle + slope * half, slope * b, middle - slope * half]
}

/// The exponential of a symmetric matrix: always positive definite.
#[must_use]
pub fn exponential([a, b, c]: Symmetric) -> Symmetric {
    let (mean, half, radius) = mean_and_radius([a, b, c]);
    let scale = mean.exp();
    // sinh(r) / r is 1 at 0.
    let slope = if radius > 0.0 { radius.sinh() / radius } else { 1.0 };
    [
        scale * (radius.cosh() + slope * half),
        scale * slope * b,
        scale * (radius.cosh() - slope * half),
    ]
}

/// Half the trace, half the difference of the diagonal, and half the difference of the eigenvalues.
fn mean_and_radius([a, b, c]: Symmetric) -> (f64, f64, f64) {
    let half = 0.5 * (a - c);
    (0.5 * (a + c), half, half.hypot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn diagonal_matrices_by_hand() {
        let log = logarithm([std::f64::consts::E, 0.0, 1.0], std::f64::consts::E);
        for (found, expected) in log.iter().zip([1.0, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(exponential([0.0; 3]), [1.0, 0.0, 1.0]);
        assert_eq!(logarithm([2.0, 0.0, 2.0], 4.0), [2.0_f64.ln(), 0.0, 2.0_f64.ln()]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn logarithm_undoes_exponential(a in -3.0..3.0f64, b in -3.0..3.0f64, c in -3.0..3.0f64) {
            let power = exponential([a, b, c]);
            let back = logarithm(power, (a + c).exp());
            for (found, expected) in back.iter().zip([a, b, c]) {
                prop_assert!((found - expected).abs() < 1e-8, "{back:?}");
            }
        }
    }
}
