//! Triangle meshes: topology that knows only indices, geometry on given positions, point location, even subdivision, how far
//! vertices can move before a triangle is turned over, validity.

mod flattening;
pub mod geometry;
mod locate;
mod mesh_point;
mod smooth_points;
mod subdivision;
mod topology;
pub mod validity;

pub(crate) use flattening::first_flat;
pub use locate::{Located, PointLocator};
pub use mesh_point::MeshPoint;
pub(crate) use smooth_points::{SmoothCarrier, SmoothPoints};
pub use subdivision::subdivided;
pub(crate) use topology::directed_edges;
pub(crate) use topology::undirected;
pub use topology::{Topology, TopologyError};
