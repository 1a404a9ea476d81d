//! Smoothing thin-plate splines from one curve to the plane of another.
//!
//! Source: Wahba 1990, "Spline models for observational data"; Bookstein 1989, "Principal warps". The spline through
//! control points `p_i` with targets `q_i` is `f(p) = a + A p + sum w_i r_i^2 log r_i`, where
//! `(K + stiffness I) w + P (a, A) = q` and `P' w = 0`.
//!
//! The matrix depends only on the control points, so that one factorisation serves every pose and every iteration. Cost
//! O(m^3) to build for m control points, O(m (m + rows)) a use.

use nalgebra::{DMatrix, Dyn, LU};

use crate::math::{Point, point, vectorised};

/// A family of smoothing splines with the same control points, one for each stiffness.
#[derive(Debug, Clone)]
pub(super) struct ThinPlate {
    factors: Vec<LU<f64, Dyn, Dyn>>,
    /// Value at each place from the spline's coefficients: #places x (#controls + 3).
    basis: DMatrix<f64>,
    control_count: usize,
}

impl ThinPlate {
    /// Splines controlled at `controls`, to be evaluated at `places`.
    pub(super) fn new(controls: &[Point], places: &[Point], stiffnesses: &[f64]) -> Self {
        let m = controls.len();
        let plain = DMatrix::from_fn(m + 3, m + 3, |i, j| match (i < m, j < m) {
            (true, true) => kernel(controls[i], controls[j]),
            (true, false) => affine(controls[i], j - m),
            (false, true) => affine(controls[j], i - m),
            (false, false) => 0.0,
        });
        let factors = stiffnesses
            .iter()
            .map(|stiffness| {
                let mut system = plain.clone();
                for k in 0..m {
                    system[(k, k)] += stiffness;
                }
                system.lu()
            })
            .collect();
        let basis = DMatrix::from_fn(places.len(), m + 3, |i, j| {
            if j < m {
                kernel(places[i], controls[j])
            } else {
                affine(places[i], j - m)
            }
        });
        Self {
            factors,
            basis,
            control_count: m,
        }
    }

    /// Where the spline of stiffness number `level` takes the places, given the targets of its control points; `None` if
    /// the control points lie on a line.
    pub(super) fn carry(&self, level: usize, targets: &[Point]) -> Option<Vec<Point>> {
        let m = self.control_count;
        let right = DMatrix::from_fn(m + 3, 2, |i, j| if i < m { targets[i][j] } else { 0.0 });
        let coefficients = self.factors[level].solve(&right)?;
        let mut points = vec![Point::zeros(); self.basis.nrows()];
        vectorised(
            #[inline(always)]
            || {
                for (coefficient, values) in coefficients.row_iter().zip(self.basis.column_iter()) {
                    let (x, y) = (coefficient[0], coefficient[1]);
                    for (p, value) in points.iter_mut().zip(values.as_slice()) {
                        *p += Point::new(value * x, value * y);
                    }
                }
            },
        );
        points.iter().all(|p| point::is_finite(*p)).then_some(points)
    }
}

fn kernel(a: Point, b: Point) -> f64 {
    let squared = (a - b).norm_squared();
    if squared > 0.0 {
        0.5 * squared * squared.ln()
    } else {
        0.0
    }
}

fn affine(p: Point, column: usize) -> f64 {
    match column {
        0 => 1.0,
        1 => p.x,
        _ => p.y,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Matrix;

    #[test]
    fn an_affine_map_is_reproduced_at_any_stiffness() {
        let controls: Vec<Point> = (0..20)
            .map(|k| Point::new((k * k % 7) as f64, (k % 5) as f64) * 0.1)
            .collect();
        let places = [Point::new(0.33, 0.1), Point::new(-1.0, 2.0)];
        let map = |p: Point| Matrix::new(1.5, -0.4, 0.2, 0.8) * p + Point::new(0.3, 0.2);
        let plate = ThinPlate::new(&controls, &places, &[1e-3, 10.0]);
        let targets: Vec<Point> = controls.iter().map(|p| map(*p)).collect();
        for level in 0..2 {
            let carried = plate.carry(level, &targets).expect("not on a line");
            for (found, place) in carried.iter().zip(places) {
                assert!((found - map(place)).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn a_soft_spline_interpolates() {
        let controls: Vec<Point> = (0..12)
            .map(|k| crate::math::rotation(k as f64 * 0.5) * Point::new(0.2, 0.0))
            .collect();
        let targets: Vec<Point> = controls.iter().map(|p| p + Point::new(p.y * p.y, p.x * p.y)).collect();
        let plate = ThinPlate::new(&controls, &controls, &[1e-12]);
        let carried = plate.carry(0, &targets).expect("not on a line");
        for (found, target) in carried.iter().zip(targets) {
            assert!((found - target).norm() < 1e-8);
        }
    }
}
