//! Where the stages are wired together: a scene in; its mapping, its weights, its frames out.
//!
//! ```text
//! Scene --read_drawings--> [Drawing] --map_drawings--> Mapping
//!                                                         |
//!                     RigidBlend, Painter, WeightProvider v
//! place in pose space --weights--> w --blend--> vertices --paint--> Frame          (Character)
//! ```
//!
//! Everything left of `Character` is computed once; a frame needs two triangular solves and a pass over the pixels.
//! A [`Character`] is immutable and can be asked from many threads at once.

mod art;
mod blending;
mod boundaries;
mod character;
mod deformed;
mod drawings;
mod error;
mod figure;
mod inside;
mod landmark_path;
mod landmarks;
mod layer;
mod layout;
mod mapping;
mod reach;
mod report;
mod sides;
mod triangulation;
mod weighting;
mod workbench;

pub use character::Character;
pub use deformed::DeformedPose;
pub use drawings::{read_drawing_of, read_drawings};
pub use error::PipelineError;
pub use figure::Posed;
pub use landmarks::INTERIOR_DEPTH;
pub use layer::{LayerShape, PosedLayer};
pub use layout::{automatic_places, laid_out};
pub use mapping::{map_drawings, map_drawings_observed};
pub use reach::{Reach, ReachOptions, ShapePoint, reach, reach_landmarks, reach_near};
pub use report::{MappingReport, Stage};
pub use triangulation::{LandmarkLabel, Refinement, triangulate_polygons};
pub use weighting::{EditableWeights, checked_weights, editable_weights, weight_provider};
pub use workbench::{DrawingFiles, Workbench};
