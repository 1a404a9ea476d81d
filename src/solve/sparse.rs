//! Sparse matrices from lists of entries.

use sprs::{CsMat, TriMat};

/// An entry of a matrix: row, column, value.
pub(crate) type Entry = (usize, usize, f64);

/// A list of matrix entries; entries at the same place add up.
#[derive(Debug)]
pub(crate) struct Triplets {
    rows: usize,
    columns: usize,
    entries: TriMat<f64>,
}

impl Triplets {
    /// No entries yet, of a matrix of `rows` x `columns`.
    #[must_use]
    pub(crate) fn new(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            entries: TriMat::new((rows, columns)),
        }
    }

    /// Adds `value` at `(row, column)`. Places outside the matrix are ignored: an eliminated unknown has no place.
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        if row < self.rows && column < self.columns {
            self.entries.add_triplet(row, column, value);
        }
    }

    /// The matrix.
    #[must_use]
    pub(crate) fn build(&self) -> SparseMatrix {
        SparseMatrix {
            columns: self.entries.to_csc(),
        }
    }
}

/// A sparse matrix, stored by columns with sorted rows.
#[derive(Debug, Clone)]
pub(crate) struct SparseMatrix {
    columns: CsMat<f64>,
}

impl SparseMatrix {
    /// Rows.
    #[must_use]
    pub(crate) fn row_count(&self) -> usize {
        self.columns.rows()
    }

    /// Columns.
    #[must_use]
    pub(crate) fn column_count(&self) -> usize {
        self.columns.cols()
    }

    /// Stored entries.
    #[cfg(test)]
    #[must_use]
    pub(crate) fn entry_count(&self) -> usize {
        self.columns.nnz()
    }

    /// The normal matrix `M^T M` (#columns x #columns) of the least-squares problem with this matrix.
    #[must_use]
    pub(crate) fn normal(&self) -> Self {
        let transposed = self.columns.transpose_view().to_csc();
        Self {
            columns: (&transposed * &self.columns).to_csc(),
        }
    }

    /// The entries `(row, column, value)`, by column and then row.
    pub(crate) fn entries(&self) -> impl Iterator<Item = Entry> + '_ {
        self.columns.outer_iterator().enumerate().flat_map(|(column, entries)| {
            entries
                .iter()
                .map(move |(row, &value)| (row, column, value))
                .collect::<Vec<_>>()
        })
    }

    /// The product with a dense vector; `None` if its length is not #columns.
    #[cfg(test)]
    #[must_use]
    pub(crate) fn multiply(&self, vector: &[f64]) -> Option<Vec<f64>> {
        if vector.len() != self.column_count() {
            return None;
        }
        let mut product = vec![0.0; self.row_count()];
        for (entries, &factor) in self.columns.outer_iterator().zip(vector) {
            for (row, &value) in entries.iter() {
                product[row] += value * factor;
            }
        }
        Some(product)
    }

    /// Column pointers, row indices and values.
    pub(super) fn raw(&self) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
        (
            self.columns.proper_indptr().into_owned(),
            self.columns.indices().to_vec(),
            self.columns.data().to_vec(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_places_add_up_and_the_normal_matrix_is_right() {
        let mut triplets = Triplets::new(3, 2);
        for (row, column, value) in [
            (0, 0, 1.0),
            (0, 0, 1.0),
            (1, 0, 3.0),
            (1, 1, -1.0),
            (2, 1, 4.0),
            (7, 0, 9.0),
        ] {
            triplets.add(row, column, value);
        }
        let matrix = triplets.build();
        assert_eq!(matrix.entry_count(), 4);
        assert_eq!(matrix.multiply(&[1.0, 2.0]), Some(vec![2.0, 1.0, 8.0]));
        assert_eq!(matrix.multiply(&[1.0]), None);
        let normal: Vec<_> = matrix.normal().entries().collect();
        assert_eq!(normal, vec![(0, 0, 13.0), (1, 0, -3.0), (0, 1, -3.0), (1, 1, 17.0)]);
    }
}
