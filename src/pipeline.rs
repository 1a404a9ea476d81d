//! Where the stages are wired together: a character's specification in; its mappings, its weights, its frames out.
//!
//! ```text
//! CharacterSpec --LayerSpec--> drawings --map_layer--> Mapping
//!                                                         |
//!                     RigidBlend, Painter, WeightProvider v
//! place in pose space --weights--> w --blend--> vertices --paint--> Frame          (Character)
//! ```
//!
//! Everything left of `Character` is computed once ([`Build`]); a frame needs two triangular solves and a pass over the pixels.
//! A [`Character`] is immutable and can be asked from many threads at once. Nothing here knows a file: whoever has one makes a
//! [`CharacterSpec`] of it, as [`scene`](crate::scene) does.

mod art;
mod blending;
mod boundaries;
mod build;
mod canvas;
mod character;
mod deformed;
mod drawings;
mod drawn;
mod error;
mod facing;
mod figure;
mod inside;
mod landmark_path;
mod landmark_ring;
mod landmarks;
mod layer;
mod layout;
mod limbs_said;
mod mapping;
mod named;
mod note;
mod overlap_regions;
mod overlapping;
mod overlapping_mapping;
mod parts;
mod reach;
mod report;
mod rims;
mod sides;
mod spec;
mod textures;
mod triangulation;
mod weighting;

pub use build::Build;
pub use character::Character;
pub use deformed::DeformedPose;
pub use error::{LandmarkPlace, OverlapMisfit, PipelineError};
pub use figure::Posed;
pub use landmark_ring::INTERIOR_DEPTH;
pub use layer::{LayerShape, PosedLayer};
pub use layout::automatic_places;
pub use mapping::{map_layer, map_layer_observed};
pub use note::{LoosePartName, Note, NoteKind};
pub use overlap_regions::{Joint, OverlapRegions, PixelGrid};
pub use parts::LayerParts;
pub use reach::{Reach, ReachOptions, ShapePoint, reach, reach_landmarks, reach_near};
pub use report::{MappingReport, Stage};
pub use spec::{
    ArtChoice, Attachment, CameraRule, CharacterSpec, DeformedCopy, DrawnPose, Facing, HandleMove, LandmarkSpec,
    LayerRole, LayerSpec, LimbSpec, MeshOptions, OverlapSearch, PathSpec, Places, PoseShape, PoseSpec, Register,
    ShrunkCopy, SpaceSpec, SpecError, SvgSource, TextureSpec, UnsharedHoles, WeightOptions,
};
pub use triangulation::{Refinement, triangulate_polygons};
pub use weighting::{EditableWeights, checked_weights, editable_weights};
