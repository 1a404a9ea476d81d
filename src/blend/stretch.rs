//! Symmetric 2 x 2 stretches, and their blends.

use crate::math::Matrix;

/// A symmetric 2 x 2 matrix: entries (1,1), (1,2), (2,2).
pub(super) type Symmetric = [f64; 3];

/// The three entries of a symmetric matrix.
#[must_use]
pub(super) fn entries(matrix: &Matrix) -> Symmetric {
    [matrix.m11, 0.5 * (matrix.m12 + matrix.m21), matrix.m22]
}

/// The logarithm of a positive definite matrix whose determinant is known; the determinant is taken as given because
/// for needles the entries no longer hold it.
#[must_use]
pub(super) fn logarithm([a, b, c]: Symmetric, determinant: f64) -> Symmetric {
    let (mean, half, radius) = mean_and_radius([a, b, c]);
    let larger = mean + radius;
    // ln(larger) - ln(smaller), with smaller = determinant / larger.
    let difference = 2.0 * libm::log(larger) - libm::log(determinant);
    let middle = 0.5 * libm::log(determinant);
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
pub(super) fn exponential([a, b, c]: Symmetric) -> Symmetric {
    let (mean, half, radius) = mean_and_radius([a, b, c]);
    let scale = libm::exp(mean);
    // sinh(r) / r is 1 at 0.
    let slope = if radius > 0.0 { libm::sinh(radius) / radius } else { 1.0 };
    [
        scale * (libm::cosh(radius) + slope * half),
        scale * slope * b,
        scale * (libm::cosh(radius) - slope * half),
    ]
}

/// Between what and what the eigenvalues of a stretch have to stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StretchRange {
    smallest: f64,
    largest: f64,
}

impl StretchRange {
    /// No limit.
    pub(super) const ALL: Self = Self {
        smallest: f64::NEG_INFINITY,
        largest: f64::INFINITY,
    };

    /// The eigenvalues of `stretches`, widened by the factor `limit` on both sides.
    #[must_use]
    pub(super) fn around(stretches: impl Iterator<Item = Symmetric>, limit: f64) -> Self {
        // Without a limit even eigenvalues that are not positive are left alone.
        if limit.is_infinite() {
            return Self::ALL;
        }
        let mut range = Self {
            smallest: f64::INFINITY,
            largest: 0.0,
        };
        for entries in stretches {
            let (mean, _, radius) = mean_and_radius(entries);
            range.smallest = range.smallest.min(mean - radius);
            range.largest = range.largest.max(mean + radius);
        }
        range.smallest /= limit;
        range.largest *= limit;
        range
    }

    /// The matrix with the same directions and its eigenvalues within the range. Continuous in the entries.
    #[must_use]
    pub(super) fn clamp(self, entries: Symmetric) -> Symmetric {
        let (mean, half, radius) = mean_and_radius(entries);
        let larger = (mean + radius).max(self.smallest).min(self.largest);
        let smaller = (mean - radius).max(self.smallest).min(self.largest);
        if larger == mean + radius && smaller == mean - radius {
            return entries;
        }
        // Equal eigenvalues have no directions, and their difference is 0 whatever they are moved to.
        let scale = if radius > 0.0 {
            0.5 * (larger - smaller) / radius
        } else {
            0.0
        };
        let middle = 0.5 * (larger + smaller);
        [middle + scale * half, scale * entries[1], middle - scale * half]
    }
}

/// Half the trace, half the difference of the diagonal, and half the difference of the eigenvalues.
fn mean_and_radius([a, b, c]: Symmetric) -> (f64, f64, f64) {
    let half = 0.5 * (a - c);
    (0.5 * (a + c), half, (half * half + b * b).sqrt())
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
