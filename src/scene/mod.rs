//! The scene file: which drawings, where they lie in the pose space, how they are meshed, blended and played.
//!
//! `scene.toml` -> [`Scene`]. A scene is validated once, here: names are unique, numbers finite, poses placed apart,
//! sources inside the scene's folder. Later stages take its fields as they are. Every [`SceneError`] carries the file
//! and, where there is one, the line.
//!
//! Keys that a later release will serve are known and refused by name, never ignored.

mod build_error;
mod convert;
mod drawings;
mod error;
mod file;
mod layers;
mod markable;
mod named_parts;
mod new;
mod newcomer;
mod separated;
mod settings;
mod shape;
mod shape_model;
mod source;
mod spec;
mod workbench;

pub use build_error::SceneBuildError;
pub use error::{SceneError, SceneProblem};
pub use layers::{LayerAnchor, SceneLayer};
pub use new::{NewElement, NewPose, scene_text};
pub use newcomer::Newcomer;
pub use separated::{Separated, SeparatedAnchor, SeparatedDrawing, SeparatedLandmark, SeparatedLayer};
pub use settings::{
    DeformedSource, DrawnSource, FrameSize, Holes, InputSettings, Layout, PoseSource, PoseSpaceSettings, Provider,
    ReadingSettings, Scene, SceneLandmark, SceneLimb, ScenePath, ScenePose,
};
pub use shape::{
    AxisSettings, JointScaling, JointSettings, JointShift, JointTurn, PseudoExample, ShapeExample, ShapeFile,
    ShapeProblem, ShapeScene, SheetSettings, SkeletonSettings, SkinWeights, SubdivisionSettings, Subject,
    SurfacePoints,
};
pub use shape_model::{ShapeForm, ShapeModel, ShapeModelError, ShapeNote, ShapeNoteKind, ShapeSpace, ShapeTake};
pub use workbench::{DrawingFiles, Workbench};
