//! Triangle meshes: topology that knows only indices, geometry on given positions, point location, validity.

pub mod geometry;
mod locate;
mod topology;
pub mod validity;

pub use locate::{Located, PointLocator};
pub use topology::{Topology, TopologyError, directed_edges};
