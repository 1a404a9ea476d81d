//! Closed curves: rings of points, outlines with holes, arc length, simplicity.
//!
//! A [`Ring`] is any closed polygon with at least three distinct consecutive points; an [`Outline`] is one pose's
//! shape, an outer ring of positive area and holes of negative area. `simplicity` decides exactly whether the rings
//! of an outline cross or touch, `crossing` finds all places where closed polygons cross.

mod arc_length;
mod crossing;
mod ring;
mod shape;
pub(crate) mod simplicity;
#[cfg(test)]
pub(crate) mod testing;

pub use arc_length::ArcLength;
pub(crate) use arc_length::parameter_gap;
pub(crate) use crossing::ClosedCurves;
pub use ring::{Ring, RingError};
pub use shape::{Outline, OutlineError};
