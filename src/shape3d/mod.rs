//! Shape by Example in three dimensions: forms of one topology, annotated with adjectives, blended at any place of their space.
//!
//! Source: Sloan, Rose, Cohen, "Shape by Example" (2001), called SBE.
//!
//! - [`FormTopology`] is what all forms share, [`Form`] where one has its vertices.
//! - [`Shape`] is the forms with their places, open to editing: examples are moved, inserted, removed, and pseudo-examples
//!   bend the space (SBE 4).
//! - [`FormBlender`] blends the forms at run time, in single precision; [`ImageBlend`] their textures.
//!
//! A place of the space is one value an adjective, in the order in which the adjectives are given.

mod blender;
mod error;
mod face;
mod form;
mod image_blend;
mod shape;
mod topology;

pub use blender::{FormBlender, FormLayout};
pub use error::{FormError, ShapeError};
pub use form::Form;
pub use image_blend::ImageBlend;
pub use shape::{Example, Shape};
pub use topology::{FormFace, FormTopology};
