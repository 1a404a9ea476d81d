//! Shapes in space wired together: a scene in, its forms, textures and pictures out.
//!
//! ```text
//! ShapeScene --read_obj--> [Form]  --untransform--> [Form at rest] --Shape--+
//!            --skin_weights--> Rig ----------------------------------Poser  v
//! place in the space --weights--> w --blend--> form at rest --pose--> control form --LoopSubdivision--> ShapeForm
//! place of the textures --weights--> w' --blend--> picture
//! ```
//!
//! Subdivision is linear, and comes last where there is no skeleton: few vertices are blended, and normals are those of the
//! limit surface. With a skeleton it comes first: examples and skin are subdivided when the scene is opened, and the fine forms are
//! unbent and blended. Either way an example's place gives its subdivided form exactly; and what is exported as morph
//! targets and skin, which know no subdivision, moves as the forms here do.

mod error;
mod files;
mod model;
mod motion;
mod note;
mod sheet;
mod space;
mod textures;

pub use error::ShapeModelError;
pub use model::{ShapeForm, ShapeModel};
pub use motion::ShapeTake;
pub use note::{ShapeNote, ShapeNoteKind};
pub use space::ShapeSpace;
