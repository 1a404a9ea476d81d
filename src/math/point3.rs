//! Points of space.

/// A point, or a displacement, in space: nalgebra's three-vector.
pub type Point3 = nalgebra::Vector3<f64>;
