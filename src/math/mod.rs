//! Numbers every stage shares: points, 2 x 2 matrices with their polar split, angles, exact predicates.
//!
//! Coordinates are `f64`, x to the right and y down as in the source file. Every formula uses the usual signs
//! (`cross((1, 0), (0, 1)) = 1`), so a positive signed area is counter-clockwise in the formula and clockwise on
//! the screen; the documentation says *positive* and *negative*, never *clockwise*.
//!
//! Decisions (left or right, crossing or not) are taken by [`predicate`], which is exact; measurements (lengths,
//! areas, angles) are plain floating point.

pub(crate) mod angle;
mod cells;
mod disjoint_sets;
pub mod matrix;
pub mod point;
mod point3;
pub mod predicate;
mod restricted;
pub(crate) mod sine;
mod single_precision;
mod smooth_step;
mod vectorised;
mod wrapped;

pub(crate) use cells::for_each_cell;
pub(crate) use disjoint_sets::DisjointSets;
pub(crate) use matrix::PolarSplit;
pub use matrix::{Matrix, rotation};
pub use point::Point;
pub use point3::Point3;
pub use restricted::restricted_weights;
pub use single_precision::{NotSingle, SinglePrecision};
pub(crate) use smooth_step::limit_weights;
pub use smooth_step::smooth_step;
pub(crate) use vectorised::vectorised;
pub(crate) use wrapped::wrapped;
