//! As rigid as possible with soft targets: the regulariser of the registration.
//!
//! Minimises `stiffness * sum over edges |(y_i - y_j) - R_ij (x_i - x_j)|^2 + sum over vertices (y_i - m_i)' Q_i (y_i - m_i)`, `R_ij` the mean of
//! the rotations at both ends. Source: Sorkine and Alexa 2007, by alternating the best rotations and a linear solve; every vertex has a
//! target `m` with a trust `Q` that may differ by direction, as in the aperture problem of optical flow.
//!
//! What is squashed as a whole is compared with its squashed form: `x` is then the lattice at rest under a linear map.
//!
//! One Cholesky factorisation serves all alternations with the same trusts.

use super::lattice::Lattice;
use crate::math::{Matrix, Point, point};
use crate::solve::{SolveError, SparseCholesky, Triplets};

/// What keeps a vertex without any trust from floating away, beside a stiffness of about 1.
const LEAST_TRUST: f64 = 1e-9;

/// Targets of all vertices.
pub(super) struct Targets<'a> {
    pub(super) places: &'a [Point],
    /// Symmetric and positive.
    pub(super) trust: &'a [Matrix],
}

/// The rotation by the angle whose cosine and sine `turn` has.
pub(super) fn turning(turn: Point) -> Matrix {
    Matrix::new(turn.x, -turn.y, turn.y, turn.x)
}

/// A lattice, at rest where a linear map has its points.
pub(super) struct Rigid<'a> {
    lattice: &'a Lattice,
    form: Matrix,
}

impl<'a> Rigid<'a> {
    pub(super) fn new(lattice: &'a Lattice, form: Matrix) -> Self {
        Self { lattice, form }
    }

    fn rest(&self, [a, b]: [usize; 2]) -> Point {
        self.form * (self.lattice.points[a] - self.lattice.points[b])
    }

    /// By vertex, the linear map of what is around it: the form at rest, turned.
    pub(super) fn frames(&self, places: &[Point], smoothings: usize) -> Vec<Matrix> {
        let rotations = self.rotations(places, smoothings).into_iter();
        rotations.map(|turn| turning(turn) * self.form).collect()
    }

    /// By vertex, cosine and sine of the best rotation of its edges, averaged with its neighbours' in `smoothings` steps.
    fn rotations(&self, places: &[Point], smoothings: usize) -> Vec<Point> {
        let mut sums = vec![Point::zeros(); places.len()];
        for &[a, b] in &self.lattice.edges {
            let (rest, now) = (self.rest([a, b]), places[a] - places[b]);
            let turn = Point::new(rest.dot(&now), point::cross(rest, now));
            sums[a] += turn;
            sums[b] += turn;
        }
        for _ in 0..smoothings {
            sums = (0..sums.len())
                .map(|v| {
                    let around = &self.lattice.neighbours[v];
                    let sum: Point = around.iter().map(|&w| sums[w]).sum();
                    sums[v] + sum * (0.5 / around.len().max(1) as f64)
                })
                .collect();
        }
        (sums.into_iter())
            .map(|sum| match sum.norm() {
                length if length > 0.0 => sum / length,
                _ => Point::new(1.0, 0.0),
            })
            .collect()
    }

    /// The least energy, alternating `iterations` times from `places`.
    pub(super) fn solve(
        &self,
        places: &[Point],
        targets: &Targets,
        stiffness: f64,
        iterations: usize,
    ) -> Result<Vec<Point>, SolveError> {
        let count = places.len();
        let mut system = Triplets::new(2 * count, 2 * count);
        for &[a, b] in &self.lattice.edges {
            for axis in 0..2 {
                let (a, b) = (2 * a + axis, 2 * b + axis);
                system.add(a, a, stiffness);
                system.add(b, b, stiffness);
                system.add(a.max(b), a.min(b), -stiffness);
            }
        }
        for (v, trust) in targets.trust.iter().enumerate() {
            system.add(2 * v, 2 * v, trust.m11 + LEAST_TRUST);
            system.add(2 * v + 1, 2 * v, trust.m21);
            system.add(2 * v + 1, 2 * v + 1, trust.m22 + LEAST_TRUST);
        }
        let factor = SparseCholesky::new(&system.build())?;
        let pulled: Vec<Point> = (targets.trust.iter().zip(targets.places)).map(|(q, m)| q * m).collect();
        let mut places = places.to_vec();
        let mut buffer = Vec::new();
        for _ in 0..iterations {
            let rotations = self.rotations(&places, 0);
            let mut right = pulled.clone();
            for &[a, b] in &self.lattice.edges {
                let turn = turning((rotations[a] + rotations[b]) * 0.5);
                let turned = turn * self.rest([a, b]) * stiffness;
                right[a] += turned;
                right[b] -= turned;
            }
            let mut unknowns: Vec<[f64; 1]> = right.iter().flat_map(|p| [[p.x], [p.y]]).collect();
            factor.solve(&mut unknowns, &mut buffer)?;
            for (place, solved) in places.iter_mut().zip(unknowns.chunks_exact(2)) {
                *place = Point::new(solved[0][0], solved[1][0]);
            }
        }
        Ok(places)
    }
}
