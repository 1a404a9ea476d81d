//! Small dense systems.

use nalgebra::{DMatrix, Dyn, LU, SVD};

use super::SolveError;

/// A dense matrix, for systems of tens of unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct DenseMatrix {
    inner: DMatrix<f64>,
}

impl DenseMatrix {
    /// The matrix with `entry(row, column)` at each place.
    #[must_use]
    pub fn from_fn(rows: usize, columns: usize, entry: impl FnMut(usize, usize) -> f64) -> Self {
        Self {
            inner: DMatrix::from_fn(rows, columns, entry),
        }
    }

    /// Rows.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.inner.nrows()
    }

    /// Columns.
    #[must_use]
    pub fn column_count(&self) -> usize {
        self.inner.ncols()
    }

    /// The entry at `(row, column)`.
    ///
    /// # Panics
    /// If the place is outside the matrix, like indexing a slice.
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.inner[(row, column)]
    }

    /// The matrix product.
    ///
    /// # Errors
    /// [`SolveError::WrongSize`] if the inner sizes differ.
    pub fn times(&self, other: &Self) -> Result<Self, SolveError> {
        same_size(self.column_count(), other.row_count())?;
        Ok(Self {
            inner: &self.inner * &other.inner,
        })
    }

    /// The sum of two matrices of one size, `other` multiplied by `factor`.
    ///
    /// # Errors
    /// [`SolveError::WrongSize`] if the sizes differ.
    pub fn plus(&self, factor: f64, other: &Self) -> Result<Self, SolveError> {
        same_size(self.row_count(), other.row_count())?;
        same_size(self.column_count(), other.column_count())?;
        Ok(Self {
            inner: &self.inner + &other.inner * factor,
        })
    }

    /// The least-squares solution of smallest norm of `self * x = right`; singular values below `relative_cutoff`
    /// times the largest count as zero.
    ///
    /// # Errors
    /// [`SolveError`] if sizes differ or an entry is not finite.
    pub fn least_squares(&self, right: &Self, relative_cutoff: f64) -> Result<Self, SolveError> {
        same_size(self.row_count(), right.row_count())?;
        self.finite()?;
        right.finite()?;
        let size = self.column_count();
        let decomposition = SVD::new(self.inner.clone(), true, true);
        let cutoff = relative_cutoff * decomposition.singular_values.max();
        // A zero matrix: everything is cut off, and the smallest solution is zero.
        let inner = decomposition
            .solve(&right.inner, cutoff.max(f64::MIN_POSITIVE))
            .map_err(|_| SolveError::Singular { size })?;
        Ok(Self { inner })
    }

    /// An orthonormal basis (as columns) of the row space: the directions in which the rows extend, singular values
    /// below `relative_cutoff` times the largest being counted as zero.
    ///
    /// # Errors
    /// [`SolveError`] if an entry is not finite.
    pub fn row_space(&self, relative_cutoff: f64) -> Result<Self, SolveError> {
        self.finite()?;
        let decomposition = SVD::new(self.inner.clone(), false, true);
        let largest = decomposition.singular_values.max();
        let kept: Vec<usize> = (0..decomposition.singular_values.len())
            .filter(|&k| largest > 0.0 && decomposition.singular_values[k] > relative_cutoff * largest)
            .collect();
        let size = self.column_count();
        let directions = decomposition.v_t.ok_or(SolveError::Singular { size })?;
        Ok(Self::from_fn(size, kept.len(), |row, column| {
            directions[(kept[column], row)]
        }))
    }

    fn finite(&self) -> Result<(), SolveError> {
        let rows = self.row_count();
        match self.inner.iter().position(|value| !value.is_finite()) {
            Some(at) => Err(SolveError::NotFinite {
                row: at % rows,
                column: at / rows,
            }),
            None => Ok(()),
        }
    }
}

fn same_size(expected: usize, found: usize) -> Result<(), SolveError> {
    if expected == found {
        Ok(())
    } else {
        Err(SolveError::WrongSize { expected, found })
    }
}

/// A square system, factored once with partial pivoting.
#[derive(Debug, Clone)]
pub struct SolvedDense {
    factor: LU<f64, Dyn, Dyn>,
    size: usize,
}

impl SolvedDense {
    /// Factors `matrix`.
    ///
    /// # Errors
    /// [`SolveError`] if it is not square, not finite or singular.
    pub fn new(matrix: &DenseMatrix) -> Result<Self, SolveError> {
        same_size(matrix.row_count(), matrix.column_count())?;
        matrix.finite()?;
        let size = matrix.row_count();
        let factor = LU::new(matrix.inner.clone());
        if !factor.is_invertible() {
            return Err(SolveError::Singular { size });
        }
        Ok(Self { factor, size })
    }

    /// The solution for every column of `right`.
    ///
    /// # Errors
    /// [`SolveError`] if the sizes differ.
    pub fn solve(&self, right: &DenseMatrix) -> Result<DenseMatrix, SolveError> {
        same_size(self.size, right.row_count())?;
        let inner = self
            .factor
            .solve(&right.inner)
            .ok_or(SolveError::Singular { size: self.size })?;
        if inner.iter().all(|value| value.is_finite()) {
            Ok(DenseMatrix { inner })
        } else {
            Err(SolveError::Singular { size: self.size })
        }
    }
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
}
