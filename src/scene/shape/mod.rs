//! The scene file of a shape in space (Shape by Example): which forms, what they are examples of, joints, subdivision,
//! how the space is shown and played.
//!
//! A `scene.toml` of its own kind -> [`ShapeScene`]. Conventions, checks and errors are those of
//! [`Scene`](super::Scene); places are written by name, `{ bend = 0.5, thickness = 1.0 }`, and become coordinates in the order of
//! `adjectives`.

mod convert;
mod error;
mod file;
mod playing;
mod settings;
mod sheet;
mod skeleton;
mod source;
#[cfg(test)]
mod tests;

pub use error::ShapeProblem;
pub use settings::{
    AxisSettings, JointSettings, JointTurn, PseudoExample, ShapeExample, ShapeFile, ShapeScene, SheetSettings,
    SkeletonSettings, SubdivisionSettings, Subject, SurfacePoints,
};
