//! Boundary matching.

mod correspondence;

pub use correspondence::{Correspondence, CorrespondenceError};
