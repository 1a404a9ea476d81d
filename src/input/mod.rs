//! Drawings: a file's bytes in, an outline and its pixels out.
//!
//! [`read_bitmap`] is pure; [`open_bitmap`] is the one that touches the disk. What was left out of a drawing (loose
//! parts, specks, pin-holes) is told in its [`InputNote`]s; what cannot be used is an [`InputError`].

mod bitmap;
mod coverage;
mod decode;
mod drawing;
mod error;
mod iso_line;
mod picture;

pub use bitmap::{BitmapOptions, HoleRule, open_bitmap, read_bitmap};
pub use drawing::{Drawing, InputNote};
pub use error::InputError;
pub use picture::Picture;
