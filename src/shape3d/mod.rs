//! Shape by Example in three dimensions: forms of one topology, annotated with adjectives, blended at any place of their space.
//!
//! Source: Sloan, Rose, Cohen, "Shape by Example" (2001), called SBE.
//!
//! - [`FormTopology`] is what all forms share, [`Form`] where one has its vertices.
//! - [`Shape`] is the forms with their places, open to editing: examples are moved, inserted, removed, and pseudo-examples
//!   bend the space (SBE 4).
//! - [`FormBlender`] blends the forms at run time, in single precision; [`ImageBlend`] their textures.
//! - [`Skeleton`] moves joints with the adjectives, [`Skin`] says what follows them; [`Rig`] takes examples to the rest
//!   position and [`Poser`] the blend of them to its pose (SBE 5).
//! - [`LoopSubdivision`] makes a smooth surface with normals of a form (SBE 6.1); [`vertex_normals`] are those of its triangles.
//!
//! A place of the space is one value an adjective, in the order in which the adjectives are given.

mod blender;
mod error;
mod face;
mod form;
mod image_blend;
mod loop_subdivision;
mod normals;
mod rig;
mod rig_error;
mod shape;
mod skeleton;
mod skin;
mod topology;
mod transform;
mod untransform;

pub use blender::{FormBlender, FormLayout};
pub use error::{FormError, ShapeError};
pub use form::Form;
pub use image_blend::ImageBlend;
pub use loop_subdivision::{
    LoopSubdivision, MOST_TRIANGLES, SubdividedPositions, SubdividedTexture, SubdivisionError, SubdivisionOptions,
    SubdivisionScratch, subdivide_texture,
};
pub use normals::{NormalWeighting, vertex_normals, vertex_normals_into, vertex_normals_planes};
pub use rig::{Poser, Rig, RigScratch};
pub use rig_error::RigError;
pub use shape::{Example, Shape};
pub use skeleton::{Joint, LocalPose, Scaling, Shift, Skeleton, Turn};
pub use skin::{Skin, WEIGHT_SUM_TOLERANCE};
pub use topology::{FormFace, FormTopology};
pub use transform::{Matrix3, Transform};
pub use untransform::{CONDITION_LIMIT, NearSingular, Residuals, RestForm, untransform};
