//! The scene file: which drawings, where they lie in the pose space, how they are meshed, blended and played.
//!
//! `scene.toml` -> [`Scene`]. A scene is validated once, here: names are unique, numbers finite, poses placed apart,
//! sources inside the scene's folder. Later stages take its fields as they are. Every [`SceneError`] carries the file
//! and, where there is one, the line.
//!
//! Keys that a later release will serve are known and refused by name, never ignored.

mod animation;
mod convert;
mod error;
mod file;
mod layers;
mod new;
mod settings;
mod shape;
mod source;

pub use animation::{Animation, Key};
pub use error::{SceneError, SceneProblem};
pub use layers::{LayerAnchor, SceneLayer};
pub use new::{NewPose, scene_text};
pub use settings::{
    Anchor, ArtChoice, Background, BlendSettings, ColourBlend, DeformedCopy, DrawnSource, Extent, Facing, HandleMove,
    Holes, InputSettings, Layout, MeshSettings, PoseSource, PoseSpaceSettings, Provider, PseudoPose, Radial,
    ReadingSettings, Region, Scene, SceneLandmark, ScenePath, ScenePose, SoftAnchor, WeightRange,
};
pub use shape::{
    AxisSettings, JointScaling, JointSettings, JointShift, JointTurn, PseudoExample, ShapeExample, ShapeFile,
    ShapeProblem, ShapeScene, SheetSettings, SkeletonSettings, SkinWeights, SubdivisionSettings, Subject,
    SurfacePoints,
};
