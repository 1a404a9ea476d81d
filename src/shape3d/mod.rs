//! Shape by Example in three dimensions: forms of one topology, annotated with adjectives, blended at any place of their space.
//!
//! Source: Sloan, Rose, Cohen, "Shape by Example" (2001), called SBE.
//!
//! - [`FormTopology`] is what all forms share, [`Form`] where one has its vertices.
//! - [`Shape`] is the forms with their places, open to editing: examples are moved, inserted, removed, and pseudo-examples
//!   bend the space (SBE 4).
//!
//! A place of the space is one value an adjective, in the order in which the adjectives are given.

mod error;
mod face;
mod form;
mod shape;
mod topology;

pub use error::{FormError, ShapeError};
pub use form::Form;
pub use shape::{Example, Shape};
pub use topology::{FormFace, FormTopology};
