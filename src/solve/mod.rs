//! Linear systems: sparse assembly, Cholesky factored once and solved often, small dense solves.
//!
//! Everything here is sequential, so results do not depend on the number of threads. The libraries that do the work
//! (sprs, faer) stay hidden.

mod cholesky;
mod dense;
mod sparse;

pub(crate) use cholesky::SparseCholesky;
pub(crate) use dense::{DenseMatrix, SolvedDense};
pub(crate) use sparse::{Entry, SparseMatrix, Triplets};

/// Why a linear system has no usable solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The matrix is not numerically positive definite.
    #[error("the system of {size} unknowns is not positive definite (pivot {pivot} in elimination order)")]
    NotPositiveDefinite {
        /// Unknowns.
        size: usize,
        /// Which pivot failed.
        pivot: usize,
    },
    /// The matrix is singular.
    #[error("the system of {size} unknowns is singular")]
    Singular {
        /// Unknowns.
        size: usize,
    },
    /// An entry is NaN or infinite.
    #[error("entry ({row}, {column}) of the system is not finite")]
    NotFinite {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
    },
    /// Sizes do not match.
    #[error("sizes do not match: {expected} expected, {found} found")]
    WrongSize {
        /// What the system has.
        expected: usize,
        /// What was given.
        found: usize,
    },
    /// The factorisation ran out of memory.
    #[error("no memory for a system of {size} unknowns")]
    OutOfMemory {
        /// Unknowns.
        size: usize,
    },
}
