//! Drawings as curves: what vector formats write and what a rasteriser with fills and strokes draws.
//!
//! A [`VectorFrame`] is one frame as a tree of groups, shapes and pictures, back to front. All frames of one character have
//! the same nodes with the same ids and equally many curves, whatever is seen of them: only numbers change, and the order of
//! siblings where poses draw in different orders. So a format with keys can follow a node through the frames by its id.
//!
//! [`CarriedDrawing`] makes frames from the [`Art`](crate::input::Art) of a character's drawings; [`VectorFrame::rasterise`] makes pixels of them.
//! The order of drawing is that of the files; where they contradict one another, the drawing with the largest texture weight decides
//! (of equal ones the first), and the others say where elements go that it does not have.

mod alignment;
mod binding;
mod carried;
mod correspondence;
mod edge;
mod frame;
mod order;
mod placing;
mod raster;
mod strand;
mod style;

pub use carried::{CarriedDrawing, CrossFade, PoseArt};
pub use frame::{VectorFrame, VectorGroup, VectorNode, VectorPicture, VectorShape};

// The style of paths is the same in drawings and frames; only the unit differs.
pub use crate::input::{
    Cubic, Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stop, Stroke, Subpath,
};
