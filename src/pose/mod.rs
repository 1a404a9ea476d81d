//! One topology with N embeddings, and the mapping that the pipeline makes of N drawings.

mod carried;
mod distance;
mod handles;
mod json;
mod landmark;
mod mapping;
mod overlaps;
mod pose_set;
mod quality;
mod texture_mesh;

pub(crate) use carried::CarriedOutline;
pub use distance::deformation_distances;
pub use handles::{DragOptions, DragReport, HandleDeformation, HandleError, HandleScratch, Repair};
pub use json::{MappingFileError, Polygons};
pub use landmark::{LandmarkKind, PlacedLandmark};
pub use mapping::{Mapping, MappingError, Matching};
pub use overlaps::{OverlappingPose, Overlaps};
pub use pose_set::{PoseSet, PoseSetError};
pub use quality::MeshQuality;
pub use texture_mesh::TextureMesh;
