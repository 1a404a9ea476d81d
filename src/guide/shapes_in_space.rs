//! Shapes in space: 3D forms as examples of adjectives, and every place among them a form.
//!
//! The idea of the pose space works in three dimensions, too; it is that of "Shape by Example" (Sloan, Rose, Cohen 2001). Forms with the
//! same vertices, exported from any modeller as OBJ, are examples of *adjectives* such as "bend" and "thickness". A place in the space of the
//! adjectives is a form. This is the blob of the repository's `data/shapes/bendable`; its five examples have names, and everything else is blended:
//!
#![doc = include_str!("figures/contact-sheet.svg")]
//!
//! # A scene
//!
//! ```toml
//! version = 1
//! adjectives = ["bend", "thickness"]
//!
//! [[example]]
//! name = "straight"
//! form = "straight.obj"
//! at = { bend = 0.0, thickness = 0.5 }
//!
//! [[example]]
//! name = "left"
//! form = "left.obj"
//! at = { bend = -1.0, thickness = 0.5 }
//!
//! [[example]]
//! name = "thick"
//! form = "thick.obj"
//! at = { bend = 0.0, thickness = 1.0 }
//!
//! [[pseudo_example]]   # the form found at one place is wanted at another
//! from = { bend = -0.6, thickness = 0.8 }
//! at = { bend = -1.0, thickness = 1.0 }
//!
//! [subdivision]
//! steps = 1
//! ```
//!
//! [`ShapeScene`](crate::scene::ShapeScene) has every key. All examples have the same vertices and faces, so they come from one model.
//!
//! - **Weights.** The weight of each example is the linear function that fits it best, and a spline about every example that makes good what
//!   that function misses. The figure shows three examples on a line: their weights in colours, and in black a value that is blended by them.
//!   Beyond the examples the shape is extrapolated.
//!
#![doc = include_str!("figures/cardinal-basis.svg")]
//!
//! - **Pseudo-examples.** Where a blend is not what it should be, but a better one is found elsewhere, a pseudo-example says so. It costs no modelling.
//!   Without the two pseudo-examples in its upper corners (grainy), the blob above would pass through itself there.
//! - **Skeletons.** A plain blend shrinks what bends. A `[skeleton]` of joints that turn, shift and scale with the adjectives bends it
//!   instead; the examples are modelled in the pose that the skeleton has at their places, and each is met exactly. A file of weights says which joints each vertex
//!   follows. Where the joints of a vertex leave no usable inverse (half a turn within one vertex), a note tells.
//! - **Subdivision.** `steps` divides every triangle into four, after Loop, so that coarse forms become smooth.
//! - **Textures** are blended apart from geometry. Each has a place of its own, `texture_at`.
//!
//! # What comes out
//!
//! ```text
//! inbetween shape render arm/scene.toml -o arm.png
//! inbetween shape render arm/scene.toml -o forms
//! inbetween shape render arm/scene.toml -o arm.glb
//! inbetween shape render arm/scene.toml --at 0,0.7,0,1 -o form.obj
//! inbetween shape weights arm/scene.toml --at 0,0.7,0,1
//! ```
//!
//! The first is the whole space in one picture, the contact sheet above. A folder gets the animation, an OBJ file a frame, or pictures with
//! `--format png`. A `.glb` file has the examples as morph targets, with the skin and the animation. One place is one form, or with `.png`
//! its picture. The weights are for an engine that blends by itself.
//!
//! # Limits
//!
//! The glTF file of a shape has one texture, that of its first frame, since glTF blends none. Pictures of forms are for looking at a space: they have
//! neither shadows nor perspective.
//!
//! # In a program
//!
//! ```no_run
//! use inbetween::scene::{ShapeModel, ShapeScene};
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = ShapeScene::open(Path::new("arm/scene.toml"))?;
//! let model = ShapeModel::open(&scene)?;
//! let form = model.form_at(&[0.0, 0.7, 0.0, 1.0])?;
//! assert_eq!(form.positions.len(), model.topology().vertex_count());
//! # Ok(())
//! # }
//! ```
//!
//! [`shape3d::Shape`](crate::shape3d::Shape) is the same for forms in memory, and [`FormBlender`](crate::shape3d::FormBlender) blends them in single
//! precision, as fast as memory can be read.
//!
//! The next chapter: [`library`](super::library).
