//! One topology with N embeddings, and the mapping that the pipeline makes of N drawings.

mod json;
mod mapping;
mod pose_set;

pub use json::{MappingFileError, Polygons};
pub use mapping::{Mapping, MappingError, Matching};
pub use pose_set::{PoseSet, PoseSetError};
