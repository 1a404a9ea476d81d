//! Sparse Cholesky factorisation: factored once, solved for many right-hand sides.
//!
//! The matrix is permuted by approximate minimum degree and factored `L L^T` column by column (faer's simplicial
//! form: the systems here have a few thousand unknowns and thin columns, where supernodes do not pay, and the plain
//! factor makes the solve below short). The two triangular solves are written here: they take `K` right-hand sides
//! side by side, so that the factor is read once for all of them, and allocate nothing once the buffer has grown. Rows are
//! kept in four bytes and diagonals as reciprocals: a solve is bound by how fast the factor is read.
//!
//! Cost for plane meshes of n vertices: about O(n^1.5) to factor, O(n log n) entries, each solve reads them twice.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Par, Side};

use super::{SolveError, SparseMatrix};
use crate::math::vectorised;

/// Sums that run side by side on the way back: an addition takes four times as long as the processor needs to start the
/// next one, so a single sum would wait for itself.
const PARTIAL_SUMS: usize = 4;

/// The factor of a symmetric positive definite matrix.
#[derive(Debug, Clone)]
pub(crate) struct SparseCholesky {
    size: usize,
    /// Unknown eliminated at each step.
    order: Vec<usize>,
    /// One over the factor's diagonal.
    reciprocals: Vec<f64>,
    /// Where each column's entries below the diagonal start; one more than there are columns.
    column_starts: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl SparseCholesky {
    /// Factors `matrix`, of which only the lower triangle is read.
    ///
    /// # Errors
    /// [`SolveError`] if it is not square, not finite or not positive definite.
    pub(crate) fn new(matrix: &SparseMatrix) -> Result<Self, SolveError> {
        let size = matrix.column_count();
        if matrix.row_count() != size {
            return Err(SolveError::WrongSize {
                expected: size,
                found: matrix.row_count(),
            });
        }
        if let Some((row, column, _)) = matrix.entries().find(|(_, _, value)| !value.is_finite()) {
            return Err(SolveError::NotFinite { row, column });
        }
        if size == 0 {
            return Ok(Self {
                size,
                order: Vec::new(),
                reciprocals: Vec::new(),
                column_starts: vec![0],
                rows: Vec::new(),
                values: Vec::new(),
            });
        }
        let (starts, rows, values) = matrix.raw();
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &starts, None, &rows);
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
                ..CholeskySymbolicParams::default()
            },
        )
        .map_err(|_| SolveError::OutOfMemory { size })?;
        let mut factor = vec![0.0; symbolic.len_val()];
        let request = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut buffer = MemBuffer::try_new(request).map_err(|_| SolveError::OutOfMemory { size })?;
        symbolic
            .factorize_numeric_llt(
                &mut factor,
                SparseColMatRef::new(pattern, &values),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|LltError::NonPositivePivot { index }| SolveError::NotPositiveDefinite { size, pivot: index })?;
        Self::from_factor(size, &symbolic, factor)
    }

    fn from_factor(size: usize, symbolic: &SymbolicCholesky<usize>, values: Vec<f64>) -> Result<Self, SolveError> {
        let SymbolicCholeskyRaw::Simplicial(factor) = symbolic.raw() else {
            return Err(SolveError::OutOfMemory { size });
        };
        let order = match symbolic.perm() {
            Some(permutation) => permutation.arrays().0.to_vec(),
            None => (0..size).collect(),
        };
        // Within a column of faer's factor the diagonal comes first.
        let starts = factor.col_ptr();
        let mut factored = Self {
            size,
            order,
            reciprocals: Vec::with_capacity(size),
            column_starts: vec![0],
            rows: Vec::with_capacity(values.len() - size),
            values: Vec::with_capacity(values.len() - size),
        };
        for column in 0..size {
            let (start, end) = (starts[column], starts[column + 1]);
            let reciprocal = values[start].recip();
            // NaN passes the pivot test of the factorisation, and an infinite reciprocal would hide as one.
            if !(reciprocal > 0.0 && reciprocal.is_finite()) {
                return Err(SolveError::NotPositiveDefinite { size, pivot: column });
            }
            factored.reciprocals.push(reciprocal);
            for &row in &factor.row_idx()[start + 1..end] {
                let row = u32::try_from(row).map_err(|_| SolveError::OutOfMemory { size })?;
                factored.rows.push(row);
            }
            factored.values.extend_from_slice(&values[start + 1..end]);
            factored.column_starts.push(factored.values.len());
        }
        Ok(factored)
    }

    /// Unknowns.
    #[must_use]
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// Entries of the factor.
    #[must_use]
    pub(crate) fn factor_entry_count(&self) -> usize {
        self.values.len() + self.size
    }

    /// The unknown that is eliminated at each step. [`Self::solve_in_order`] takes and gives entries in this order.
    #[must_use]
    pub(crate) fn order(&self) -> &[usize] {
        &self.order
    }

    /// Solves for `K` right-hand sides at once, in place: `vectors[i]` holds entry `i` of each of them. `buffer` is
    /// working space that callers keep between solves; its content does not matter.
    ///
    /// # Errors
    /// [`SolveError::WrongSize`] if there is not one entry for each unknown.
    pub(crate) fn solve<const K: usize>(
        &self,
        vectors: &mut [[f64; K]],
        buffer: &mut Vec<[f64; K]>,
    ) -> Result<(), SolveError> {
        if vectors.len() != self.size {
            return Err(SolveError::WrongSize {
                expected: self.size,
                found: vectors.len(),
            });
        }
        buffer.clear();
        buffer.extend(self.order.iter().map(|&unknown| vectors[unknown]));
        vectorised(|| self.sweep(buffer));
        for (&unknown, solved) in self.order.iter().zip(buffer.iter()) {
            vectors[unknown] = *solved;
        }
        Ok(())
    }

    /// As [`Self::solve`] for callers who keep their entries in the order of elimination ([`Self::order`]): nothing is
    /// copied, and no working space is needed.
    ///
    /// # Errors
    /// [`SolveError::WrongSize`] if there is not one entry for each unknown.
    pub(crate) fn solve_in_order<const K: usize>(&self, vectors: &mut [[f64; K]]) -> Result<(), SolveError> {
        if vectors.len() != self.size {
            return Err(SolveError::WrongSize {
                expected: self.size,
                found: vectors.len(),
            });
        }
        vectorised(|| self.sweep(vectors));
        Ok(())
    }

    /// Forth through the factor and back through its transpose.
    #[inline(always)]
    fn sweep<const K: usize>(&self, vectors: &mut [[f64; K]]) {
        let columns = || self.column_starts.windows(2).map(|bounds| bounds[0]..bounds[1]);
        for (column, (entries, &reciprocal)) in columns().zip(&self.reciprocals).enumerate() {
            let solved = vectors[column].map(|x| x * reciprocal);
            vectors[column] = solved;
            for (&row, &value) in self.rows[entries.clone()].iter().zip(&self.values[entries]) {
                for (entry, x) in vectors[row as usize].iter_mut().zip(solved) {
                    *entry -= value * x;
                }
            }
        }
        for (column, (entries, &reciprocal)) in columns().zip(&self.reciprocals).enumerate().rev() {
            let (rows, values) = (&self.rows[entries.clone()], &self.values[entries]);
            let mut sums = [[0.0; K]; PARTIAL_SUMS];
            let (mut row_groups, mut value_groups) =
                (rows.chunks_exact(PARTIAL_SUMS), values.chunks_exact(PARTIAL_SUMS));
            for (rows, values) in (&mut row_groups).zip(&mut value_groups) {
                for ((sum, &row), &value) in sums.iter_mut().zip(rows).zip(values) {
                    for (entry, x) in sum.iter_mut().zip(vectors[row as usize]) {
                        *entry += value * x;
                    }
                }
            }
            for (&row, &value) in row_groups.remainder().iter().zip(value_groups.remainder()) {
                for (entry, x) in sums[0].iter_mut().zip(vectors[row as usize]) {
                    *entry += value * x;
                }
            }
            let [a, b, c, d] = sums;
            let mut sum = vectors[column];
            for (k, entry) in sum.iter_mut().enumerate() {
                *entry -= (a[k] + b[k]) + (c[k] + d[k]);
            }
            vectors[column] = sum.map(|x| x * reciprocal);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::Triplets;
    use proptest::prelude::*;

    #[test]
    fn two_unknowns_by_hand() {
        let mut triplets = Triplets::new(2, 2);
        for (row, column, value) in [(0, 0, 4.0), (1, 0, 2.0), (0, 1, 2.0), (1, 1, 3.0)] {
            triplets.add(row, column, value);
        }
        let factor = SparseCholesky::new(&triplets.build()).expect("positive definite");
        let mut right = [[8.0, 4.0], [7.0, 2.0]];
        factor.solve(&mut right, &mut Vec::new()).expect("right size");
        for (found, expected) in right.as_flattened().iter().zip([1.25, 1.0, 1.5, 0.0]) {
            assert!((found - expected).abs() < 1e-14, "{right:?}");
        }
    }

    #[test]
    fn bad_systems_are_refused() {
        let build = |entries: &[(usize, usize, f64)]| {
            let mut triplets = Triplets::new(2, 2);
            for &(row, column, value) in entries {
                triplets.add(row, column, value);
            }
            triplets.build()
        };
        let indefinite = build(&[(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)]);
        let refused = SparseCholesky::new(&indefinite).expect_err("indefinite");
        assert!(
            matches!(refused, SolveError::NotPositiveDefinite { size: 2, .. }),
            "{refused}"
        );
        let empty_column = build(&[(0, 0, 1.0)]);
        assert!(SparseCholesky::new(&empty_column).is_err());
        let not_finite = build(&[(0, 0, 1.0), (1, 1, f64::NAN)]);
        assert_eq!(
            SparseCholesky::new(&not_finite).expect_err("NaN"),
            SolveError::NotFinite { row: 1, column: 1 }
        );
        let factor = SparseCholesky::new(&build(&[(0, 0, 1.0), (1, 1, 1.0)])).expect("identity");
        assert!(factor.solve(&mut [[1.0]; 3], &mut Vec::new()).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn agrees_with_the_residual(
            size in 1_usize..30,
            entries in proptest::collection::vec((0_usize..30, 0_usize..30, -2.0..2.0f64), 1..120),
        ) {
            // M^T M + I is positive definite whatever M is.
            let mut triplets = Triplets::new(30 + size, size);
            for (row, column, value) in entries {
                triplets.add(row, column, value);
            }
            for k in 0..size {
                triplets.add(30 + k, k, 1.0);
            }
            let normal = triplets.build().normal();
            let factor = SparseCholesky::new(&normal).expect("positive definite");
            let right: Vec<[f64; 1]> = (0..size).map(|k| [(k as f64).sin()]).collect();
            let mut solution = right.clone();
            factor.solve(&mut solution, &mut Vec::new()).expect("right size");
            let product = normal.multiply(solution.as_flattened()).expect("right size");
            for (found, [expected]) in product.iter().zip(right) {
                prop_assert!((found - expected).abs() < 1e-9);
            }
        }
    }
}
