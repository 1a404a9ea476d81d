//! Drawings as curves: what vector formats write and what a rasteriser with fills and strokes draws.
//!
//! A [`VectorFrame`] is one frame as a tree of groups, shapes and pictures, back to front. All frames of one character have
//! the same nodes with the same ids and equally many curves, whatever is seen of them: only numbers change, and the order of
//! siblings where poses draw in different orders. So a format with keys can follow a node through the frames by its id.

mod frame;

pub use frame::{
    Cubic, Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stop, Stroke, Subpath,
    VectorFrame, VectorGroup, VectorNode, VectorPicture, VectorShape,
};
