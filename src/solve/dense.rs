//! Small dense systems.
//!
//! - [`DenseMatrix`]: least squares and row space by the singular values, which one-sided Jacobi rotations find (Hestenes 1958):
//!   rows or columns, whichever are fewer, are turned against one another until all are at right angles. Small singular values
//!   come out as accurately as large ones (Demmel and Veselić 1992), and a matrix of four columns takes a microsecond.
//! - [`SolvedDense`]: Gaussian elimination with partial pivoting.
//!
//! Entries lie row by row, so that every inner loop runs along rows, in wide registers. Each entry sees the same operations
//! in the same order as in the textbook: results do not depend on the registers.

use super::SolveError;
use crate::math::vectorised;

/// Rows are at right angles if the cosine between them is at most this: the rounding of a scalar product of tens of terms.
const RIGHT_ANGLE: f64 = 1e-15;

/// Sweeps of rotations after which rows are taken as they are. Convergence is quadratic: six to eight is usual.
const MOST_SWEEPS: usize = 40;

/// Largest entries between these need no scaling: their squares neither overflow nor vanish.
const SAFE: std::ops::Range<f64> = 1e-100..1e100;

/// Columns of a right-hand side that are solved for together, in two wide registers: one alone would take as long.
const TOGETHER: usize = 8;

/// A dense matrix, for systems of tens of unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DenseMatrix {
    rows: usize,
    columns: usize,
    /// Row by row.
    entries: Vec<f64>,
}

impl DenseMatrix {
    /// The matrix with `entry(row, column)` at each place, asked for row by row.
    #[must_use]
    pub(crate) fn from_fn(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Self {
        let mut entries = Vec::with_capacity(rows * columns);
        for row in 0..rows {
            entries.extend((0..columns).map(|column| entry(row, column)));
        }
        Self { rows, columns, entries }
    }

    /// Rows.
    #[must_use]
    pub(crate) fn row_count(&self) -> usize {
        self.rows
    }

    /// Columns.
    #[must_use]
    pub(crate) fn column_count(&self) -> usize {
        self.columns
    }

    /// The entry at `(row, column)`.
    ///
    /// # Panics
    /// If the place is outside the matrix, like indexing a slice.
    #[must_use]
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        assert!(column < self.columns, "column {column} of {}", self.columns);
        self.entries[row * self.columns + column]
    }

    /// The entries of a row.
    ///
    /// # Panics
    /// If there is no such row, like indexing a slice.
    #[must_use]
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.columns..(row + 1) * self.columns]
    }

    /// Puts another entry at `(row, column)`.
    ///
    /// # Panics
    /// If the place is outside the matrix, like indexing a slice.
    pub(crate) fn set(&mut self, row: usize, column: usize, entry: f64) {
        self.row_mut(row)[column] = entry;
    }

    /// The entries of a row, to be changed.
    ///
    /// # Panics
    /// If there is no such row, like indexing a slice.
    #[must_use]
    pub(crate) fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.entries[row * self.columns..(row + 1) * self.columns]
    }

    /// The matrix product.
    ///
    /// # Errors
    /// [`SolveError::WrongSize`] if the inner sizes differ.
    pub(crate) fn times(&self, other: &Self) -> Result<Self, SolveError> {
        same_size(self.columns, other.rows)?;
        let mut product = Self::zeros(self.rows, other.columns);
        for row in 0..self.rows {
            let sum = product.row_mut(row);
            for (k, factor) in self.row(row).iter().enumerate() {
                add(sum, *factor, other.row(k));
            }
        }
        Ok(product)
    }

    /// The sum of two matrices of one size, `other` multiplied by `factor`.
    ///
    /// # Errors
    /// [`SolveError::WrongSize`] if the sizes differ.
    pub(crate) fn plus(&self, factor: f64, other: &Self) -> Result<Self, SolveError> {
        same_size(self.rows, other.rows)?;
        same_size(self.columns, other.columns)?;
        let mut sum = self.clone();
        add(&mut sum.entries, factor, &other.entries);
        Ok(sum)
    }

    /// The least-squares solution of smallest norm of `self * x = right`; singular values below `relative_cutoff`
    /// times the largest count as zero.
    ///
    /// # Errors
    /// [`SolveError`] if sizes differ or an entry is not finite.
    pub(crate) fn least_squares(&self, right: &Self, relative_cutoff: f64) -> Result<Self, SolveError> {
        same_size(self.rows, right.rows)?;
        self.finite()?;
        right.finite()?;
        let mut solution = Self::zeros(self.columns, right.columns);
        let mut share = vec![0.0; right.columns];
        let parts = SingularParts::of(self);
        for part in parts.above(relative_cutoff) {
            // `v (u^T b) / s`, `u` and `v` being of the lengths `s` and 1, or 1 and `s`.
            share.fill(0.0);
            for (row, factor) in part.along_rows.iter().enumerate() {
                add(&mut share, factor / part.value_squared, right.row(row));
            }
            for (row, factor) in part.along_columns.iter().enumerate() {
                add(solution.row_mut(row), factor / parts.scale, &share);
            }
        }
        Ok(solution)
    }

    /// An orthonormal basis (as columns) of the row space: the directions in which the rows extend, singular values
    /// below `relative_cutoff` times the largest being counted as zero.
    ///
    /// # Errors
    /// [`SolveError`] if an entry is not finite.
    pub(crate) fn row_space(&self, relative_cutoff: f64) -> Result<Self, SolveError> {
        self.finite()?;
        let parts = SingularParts::of(self);
        let kept: Vec<(&[f64], f64)> = parts
            .above(relative_cutoff)
            .map(|part| {
                let length = part.along_columns.iter().map(|x| x * x).sum::<f64>().sqrt();
                (part.along_columns, length)
            })
            .collect();
        Ok(Self::from_fn(self.columns, kept.len(), |row, column| {
            kept[column].0[row] / kept[column].1
        }))
    }

    fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            entries: vec![0.0; rows * columns],
        }
    }

    fn swap_rows(&mut self, a: usize, b: usize) {
        if a != b {
            let (low, high) = (a.min(b), a.max(b));
            let (before, from) = self.entries.split_at_mut(high * self.columns);
            before[low * self.columns..][..self.columns].swap_with_slice(&mut from[..self.columns]);
        }
    }

    fn finite(&self) -> Result<(), SolveError> {
        match self.entries.iter().position(|value| !value.is_finite()) {
            Some(at) => Err(SolveError::NotFinite {
                row: at / self.columns,
                column: at % self.columns,
            }),
            None => Ok(()),
        }
    }
}

/// Adds `factor` times `row` to `sum`.
#[inline(always)]
fn add(sum: &mut [f64], factor: f64, row: &[f64]) {
    for (sum, entry) in sum.iter_mut().zip(row) {
        *sum += factor * entry;
    }
}

fn same_size(expected: usize, found: usize) -> Result<(), SolveError> {
    if expected == found {
        Ok(())
    } else {
        Err(SolveError::WrongSize { expected, found })
    }
}

/// A matrix, divided by `scale`, as a sum of products of vectors at right angles.
struct SingularParts {
    /// Each row one part: the vector, then what it is made of.
    turned: DenseMatrix,
    /// Where the second half of a row begins.
    length: usize,
    /// Whether the vectors are made of columns, or else of rows.
    of_columns: bool,
    scale: f64,
    values_squared: Vec<f64>,
}

/// One of the products.
struct SingularPart<'a> {
    along_rows: &'a [f64],
    along_columns: &'a [f64],
    value_squared: f64,
}

impl SingularParts {
    fn of(matrix: &DenseMatrix) -> Self {
        let largest = matrix.entries.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let scale = if largest == 0.0 || SAFE.contains(&largest) {
            1.0
        } else {
            largest
        };
        let of_columns = matrix.columns <= matrix.rows;
        let (count, length) = if of_columns {
            (matrix.columns, matrix.rows)
        } else {
            (matrix.rows, matrix.columns)
        };
        let mut turned = DenseMatrix::from_fn(count, length + count, |row, k| match k.checked_sub(length) {
            Some(own) => f64::from(u8::from(own == row)),
            None if of_columns => matrix.at(k, row) / scale,
            None => matrix.at(row, k) / scale,
        });
        vectorised(
            #[inline(always)]
            || turn(&mut turned, length),
        );
        let square = |row: usize| turned.row(row)[..length].iter().map(|x| x * x).sum();
        Self {
            values_squared: (0..count).map(square).collect(),
            turned,
            length,
            of_columns,
            scale,
        }
    }

    /// The parts with singular values above `relative_cutoff` times the largest.
    fn above(&self, relative_cutoff: f64) -> impl Iterator<Item = SingularPart<'_>> {
        let largest = self.values_squared.iter().fold(0.0_f64, |most, value| most.max(*value));
        let cutoff = relative_cutoff * relative_cutoff * largest;
        let kept = move |&part: &usize| self.values_squared[part] > cutoff;
        (0..self.values_squared.len()).filter(kept).map(|part| {
            let (vector, made_of) = self.turned.row(part).split_at(self.length);
            let (along_rows, along_columns) = if self.of_columns {
                (vector, made_of)
            } else {
                (made_of, vector)
            };
            SingularPart {
                along_rows,
                along_columns,
                value_squared: self.values_squared[part],
            }
        })
    }
}

/// Turns the rows of `matrix` against one another until their first `length` entries are at right angles.
#[inline(always)]
fn turn(matrix: &mut DenseMatrix, length: usize) {
    for _ in 0..MOST_SWEEPS {
        let mut turned = false;
        for second in 1..matrix.rows {
            for first in 0..second {
                let (before, from) = matrix.entries.split_at_mut(second * matrix.columns);
                let p = &mut before[first * matrix.columns..][..matrix.columns];
                let q = &mut from[..matrix.columns];
                let [square_p, square_q, product] = scalar_products(&p[..length], &q[..length]);
                if product.abs() <= RIGHT_ANGLE * (square_p * square_q).sqrt() {
                    continue;
                }
                turned = true;
                let cotangent = (square_q - square_p) / (2.0 * product);
                let tangent = cotangent.signum() / (cotangent.abs() + (1.0 + cotangent * cotangent).sqrt());
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                let sine = cosine * tangent;
                for (p, q) in p.iter_mut().zip(q) {
                    (*p, *q) = (cosine * *p - sine * *q, sine * *p + cosine * *q);
                }
            }
        }
        if !turned {
            break;
        }
    }
}

/// `p p`, `q q` and `p q`, each summed in four lanes.
#[inline(always)]
fn scalar_products(p: &[f64], q: &[f64]) -> [f64; 3] {
    let mut sums = [[0.0; 4]; 3];
    let ((whole_p, rest_p), (whole_q, rest_q)) = (p.as_chunks::<4>(), q.as_chunks::<4>());
    for (p, q) in whole_p.iter().zip(whole_q) {
        for lane in 0..4 {
            sums[0][lane] += p[lane] * p[lane];
            sums[1][lane] += q[lane] * q[lane];
            sums[2][lane] += p[lane] * q[lane];
        }
    }
    for (lane, (p, q)) in rest_p.iter().zip(rest_q).enumerate() {
        sums[0][lane] += p * p;
        sums[1][lane] += q * q;
        sums[2][lane] += p * q;
    }
    sums.map(|[a, b, c, d]| (a + b) + (c + d))
}

/// A square system, factored once with partial pivoting.
#[derive(Debug, Clone)]
pub(crate) struct SolvedDense {
    /// `L` below the diagonal, where it is 1; `U` from there on.
    factor: DenseMatrix,
    /// Which row was exchanged with row k, in step k.
    exchanges: Vec<usize>,
}

impl SolvedDense {
    /// Factors `matrix`.
    ///
    /// # Errors
    /// [`SolveError`] if it is not square, not finite or singular.
    pub(crate) fn new(matrix: &DenseMatrix) -> Result<Self, SolveError> {
        same_size(matrix.rows, matrix.columns)?;
        matrix.finite()?;
        let mut factor = matrix.clone();
        let size = matrix.rows;
        let eliminated = vectorised(
            #[inline(always)]
            || eliminate(&mut factor),
        );
        let exchanges = eliminated.ok_or(SolveError::Singular { size })?;
        Ok(Self { factor, exchanges })
    }

    /// The solution for every column of `right`.
    ///
    /// # Errors
    /// [`SolveError`] if the sizes differ.
    pub(crate) fn solve(&self, right: &DenseMatrix) -> Result<DenseMatrix, SolveError> {
        let size = self.factor.rows;
        same_size(size, right.rows)?;
        let mut columns = vec![[0.0; TOGETHER]; size];
        let mut solution = DenseMatrix::zeros(size, right.columns);
        for from in (0..right.columns).step_by(TOGETHER) {
            let count = TOGETHER.min(right.columns - from);
            for (row, to) in columns.iter_mut().enumerate() {
                to[..count].copy_from_slice(&right.row(row)[from..from + count]);
            }
            for (row, exchange) in self.exchanges.iter().enumerate() {
                columns.swap(row, *exchange);
            }
            vectorised(
                #[inline(always)]
                || self.substitute(&mut columns),
            );
            for (row, from_row) in columns.iter().enumerate() {
                solution.row_mut(row)[from..from + count].copy_from_slice(&from_row[..count]);
            }
        }
        if solution.entries.iter().all(|value| value.is_finite()) {
            Ok(solution)
        } else {
            Err(SolveError::Singular { size })
        }
    }

    /// Solves for a few columns; their sums stay in registers.
    #[inline(always)]
    fn substitute(&self, columns: &mut [[f64; TOGETHER]]) {
        let size = self.factor.rows;
        for row in 1..size {
            let (known, from) = columns.split_at_mut(row);
            let mut sum = from[0];
            for (factor, known) in self.factor.row(row).iter().zip(known) {
                for lane in 0..TOGETHER {
                    sum[lane] -= factor * known[lane];
                }
            }
            from[0] = sum;
        }
        for row in (0..size).rev() {
            let (before, known) = columns.split_at_mut(row + 1);
            let (pivot, factors) = (self.factor.at(row, row), &self.factor.row(row)[row + 1..]);
            let mut sum = before[row];
            // From the last one on, as unknowns become known.
            for (factor, known) in factors.iter().zip(known).rev() {
                for lane in 0..TOGETHER {
                    sum[lane] -= factor * known[lane];
                }
            }
            before[row] = sum.map(|value| value / pivot);
        }
    }
}

/// Gaussian elimination in place; the exchanges of rows, or `None` if no pivot is left.
#[inline(always)]
fn eliminate(matrix: &mut DenseMatrix) -> Option<Vec<usize>> {
    let size = matrix.rows;
    let mut exchanges = Vec::with_capacity(size);
    for step in 0..size {
        let entry = |row: usize| matrix.entries[row * size + step].abs();
        let pivot = (step + 1..size).fold(step, |best, row| if entry(row) > entry(best) { row } else { best });
        if entry(pivot) == 0.0 {
            return None;
        }
        exchanges.push(pivot);
        matrix.swap_rows(step, pivot);
        let (done, below) = matrix.entries.split_at_mut((step + 1) * size);
        let pivot_row = &done[step * size + step..];
        let inverse = 1.0 / pivot_row[0];
        for row in below.chunks_exact_mut(size) {
            let factor = row[step] * inverse;
            row[step] = factor;
            add(&mut row[step + 1..], -factor, &pivot_row[1..]);
        }
    }
    Some(exchanges)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix<const C: usize>(rows: &[[f64; C]]) -> DenseMatrix {
        DenseMatrix::from_fn(rows.len(), C, |row, column| rows[row][column])
    }

    #[test]
    fn a_square_system_by_hand() {
        let system = matrix(&[[0.0, 2.0], [3.0, 1.0]]);
        let solution = SolvedDense::new(&system)
            .and_then(|factored| factored.solve(&matrix(&[[4.0], [5.0]])))
            .expect("regular");
        assert!((solution.at(0, 0) - 1.0).abs() < 1e-15 && (solution.at(1, 0) - 2.0).abs() < 1e-15);
        let singular = SolvedDense::new(&matrix(&[[1.0, 2.0], [2.0, 4.0]])).expect_err("singular");
        assert_eq!(singular, SolveError::Singular { size: 2 });
        assert!(SolvedDense::new(&matrix(&[[1.0, 2.0]])).is_err());
        assert!(SolvedDense::new(&matrix(&[[f64::NAN]])).is_err());
    }

    #[test]
    fn least_squares_has_the_smallest_norm() {
        // Both columns are equal, so the slope 1 is shared between them.
        let system = matrix(&[[1.0, 1.0], [2.0, 2.0]]);
        let solution = system.least_squares(&matrix(&[[1.0], [2.0]]), 1e-10).expect("finite");
        assert!((solution.at(0, 0) - 0.5).abs() < 1e-14 && (solution.at(1, 0) - 0.5).abs() < 1e-14);
        let zero = matrix(&[[0.0, 0.0]])
            .least_squares(&matrix(&[[1.0]]), 1e-10)
            .expect("finite");
        assert_eq!((zero.at(0, 0), zero.at(1, 0)), (0.0, 0.0));
    }

    #[test]
    fn row_space_of_collinear_rows_is_their_direction() {
        let basis = matrix(&[[3.0, 4.0], [-6.0, -8.0], [0.0, 0.0]])
            .row_space(1e-10)
            .expect("finite");
        assert_eq!((basis.row_count(), basis.column_count()), (2, 1));
        assert!((basis.at(0, 0).abs() - 0.6).abs() < 1e-14 && (basis.at(1, 0).abs() - 0.8).abs() < 1e-14);
        assert_eq!(
            matrix(&[[0.0, 0.0]]).row_space(1e-10).expect("finite").column_count(),
            0
        );
    }

    /// Numbers without a pattern.
    fn scattered(rows: usize, columns: usize) -> DenseMatrix {
        DenseMatrix::from_fn(rows, columns, |row, column| {
            let k = (row * columns + column) as f64;
            (0.4 + 0.83 * k * k).sin()
        })
    }

    #[test]
    fn solutions_solve_systems_of_every_size_and_with_any_number_of_right_hand_sides() {
        for (size, columns) in [(1, 1), (2, 5), (5, 1), (14, 28), (33, 7), (3, 0)] {
            let (system, right) = (scattered(size, size), scattered(size, columns));
            let solution = SolvedDense::new(&system)
                .and_then(|factored| factored.solve(&right))
                .expect("regular");
            let residual = system
                .times(&solution)
                .and_then(|found| right.plus(-1.0, &found))
                .expect("sizes");
            assert!(residual.entries.iter().all(|x| x.abs() < 1e-11), "{size} x {columns}");
        }
    }

    #[test]
    fn least_squares_agrees_with_nalgebra_for_tall_wide_and_deficient_matrices() {
        for (rows, columns, rank, scale) in [
            (14, 4, 4, 1.0),
            (4, 14, 4, 1.0),
            (9, 5, 3, 1.0),
            (5, 9, 2, 1.0),
            (6, 6, 6, 1e-160),
            (8, 3, 2, 1e150),
        ] {
            let deficient = scattered(rows, rank).times(&scattered(rank, columns)).expect("sizes");
            let matrix = DenseMatrix::from_fn(rows, columns, |r, c| scale * deficient.at(r, c));
            let right = scattered(rows, 3);
            let found = matrix.least_squares(&right, 1e-10).expect("finite");
            let oracle = nalgebra::DMatrix::from_fn(rows, columns, |r, c| deficient.at(r, c))
                .pseudo_inverse(1e-9)
                .expect("a cutoff");
            for row in 0..columns {
                for column in 0..3 {
                    let expected: f64 = (0..rows).map(|k| oracle[(row, k)] * right.at(k, column)).sum();
                    let error = (found.at(row, column) * scale - expected).abs();
                    assert!(error < 1e-9 * (1.0 + expected.abs()), "{rows} x {columns}: {error}");
                }
            }
            let basis = matrix.row_space(1e-10).expect("finite");
            assert_eq!(basis.column_count(), rank);
            for a in 0..rank {
                for b in 0..=a {
                    let product: f64 = (0..columns).map(|k| basis.at(k, a) * basis.at(k, b)).sum();
                    assert!((product - f64::from(u8::from(a == b))).abs() < 1e-13);
                }
            }
        }
    }
}
