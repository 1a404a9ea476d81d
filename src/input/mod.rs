//! Drawings.

mod picture;

pub use picture::Picture;
