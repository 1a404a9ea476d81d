//! N-way morphing for 2D animation: independent drawings of one character in, drawings between them out.
//!
//! The poses of a character are drawn independently, and laid out as points of a space. At any place of that space this
//! crate makes the drawing that belongs there; a path through the space is an animation.
//!
//! Sources: Baxter, Barla, Anjyo, "N-way morphing for 2D animation" (2009), called NWM in these pages; the weights also after Sloan,
//! Rose, Cohen, "Shape by Example" (2001), called SBE.
//!
//! The [`guide`] says how to use it, chapter by chapter, with the command and as a library.
//!
//! # The pipeline
//!
//! | stage | from | to |
//! |---|---|---|
//! | [`input`] | a file's bytes | [`Drawing`]: outline and pixels |
//! | [`matching`] | N outlines | [`Correspondence`](matching::Correspondence) |
//! | [`compatible`] | N outlines in correspondence | [`CompatibleMesh`](compatible::CompatibleMesh) |
//! | [`pose`] | all of these | [`Mapping`]: one topology, N embeddings |
//! | [`weights`] | a place of the pose space | N weights that sum to 1 |
//! | [`blend`] | N weights | the vertices of one mesh |
//! | [`texture`] | N weights | how much of each drawing is seen |
//! | [`render`] | vertices and weights | [`Frame`] |
//! | [`export`] | frames | PNG, GIF, video, SVG, Lottie, glTF, … |
//! | [`shape3d`] | forms in space and a place among them | a form in space |
//!
//! [`pipeline`] wires them together: a [`CharacterSpec`], a plain value that holds drawings and options, becomes a
//! [`Character`], built once and asked for frames from any thread. The example `two_drawings` makes one of pixels in
//! memory. [`scene`] reads `scene.toml` and makes one of it. The names that most programs need are those of the root, too:
//!
//! ```
//! use inbetween::Scene;
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::open(Path::new("data/walker/scene.toml"))?;
//! let character = scene.character([96, 108], 1)?;
//! let frame = character.frame_at(&[0.5, 0.2])?;
//! assert_eq!((frame.width, frame.height), (96, 108));
//! # Ok(())
//! # }
//! ```
//!
//! # Conventions
//!
//! Coordinates are `f64`, x to the right and y down as in the source file; an outline has positive signed area, its holes negative.
//! Nothing here reads a clock or the environment, and results do not depend on the number of threads. Files are opened
//! by [`input`], [`scene`] and [`export`] alone.

// What there is to read, before what there is to call.
pub mod guide;

// Foundations.
pub mod math;

pub mod solve;

pub mod outline;

pub mod mesh;

// Stages, as data flows.
pub mod input;

mod parts;

pub mod appearance;

pub mod matching;

pub mod registration;

pub mod compatible;

pub mod pose;

pub mod weights;

pub mod blend;

pub mod texture;

pub mod render;

#[cfg(feature = "shape3d")]
pub mod shape3d;

pub mod animation;

#[cfg(feature = "export")]
pub mod export;

pub mod interop;

// What wires them together, and what stands above it.
pub mod pipeline;

#[cfg(feature = "scene")]
pub mod scene;

// The names that most programs need.
pub use animation::Animation;
pub use blend::{BlendOptions, RigidBlend, Stretch};
#[cfg(feature = "export")]
pub use export::{GifWriter, WriteError, png_bytes};
pub use input::Drawing;
#[cfg(feature = "svg")]
pub use input::read_svg;
#[cfg(feature = "images")]
pub use input::{BitmapOptions, read_bitmap, read_pixels};
pub use math::Point;
pub use outline::{Outline, Ring};
pub use pipeline::{Build, Character, CharacterSpec, LayerSpec, PipelineError, PoseSpec, map_layer};
pub use pose::{Mapping, PoseSet};
pub use render::{Frame, VectorFrame};
#[cfg(feature = "scene")]
pub use scene::Scene;
pub use weights::WeightProvider;

/// The README's example compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
