//! One frame as curves.

use super::super::Frame;
use crate::input::{Fill, Stroke, Subpath};
use crate::math::Point;

/// One frame as a tree of curves, in pixels of the frame: x to the right, y down, the frame's corner at the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorFrame {
    /// Columns and rows.
    pub size: [usize; 2],
    /// What is behind everything: red, green, blue, alpha, not premultiplied.
    pub background: Option<[u8; 4]>,
    /// From back to front.
    pub nodes: Vec<VectorNode>,
}

/// A part of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum VectorNode {
    /// Nodes that are composed first, then drawn as one.
    Group(VectorGroup),
    /// A filled or stroked path.
    Shape(Box<VectorShape>),
    /// Pixels: what was drawn as a bitmap.
    Picture(VectorPicture),
}

impl VectorNode {
    /// What follows the node through the frames; unique in its frame.
    #[must_use]
    pub fn id(&self) -> &str {
        match self {
            Self::Group(group) => &group.id,
            Self::Shape(shape) => &shape.id,
            Self::Picture(picture) => &picture.id,
        }
    }
}

impl VectorNode {
    /// Puts `name` and a slash before the ids of the node and all that is in it.
    pub fn put_under(&mut self, name: &str) {
        let id = match self {
            Self::Group(group) => {
                for node in &mut group.nodes {
                    node.put_under(name);
                }
                &mut group.id
            }
            Self::Shape(shape) => &mut shape.id,
            Self::Picture(picture) => &mut picture.id,
        };
        id.insert(0, '/');
        id.insert_str(0, name);
    }
}

/// Nodes that are drawn as one.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorGroup {
    /// What follows it through the frames.
    pub id: String,
    /// Of the group as a whole, in [0, 1].
    pub opacity: f64,
    /// What is seen of it: closed rings, non-zero rule; `None` for all.
    pub clip: Option<Vec<Vec<Point>>>,
    /// From back to front.
    pub nodes: Vec<VectorNode>,
}

/// Pixels as large as the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorPicture {
    /// What follows it through the frames.
    pub id: String,
    /// The pixels; the picture's upper left corner is the frame's.
    pub frame: Frame,
    /// In [0, 1].
    pub opacity: f64,
}

/// A path with its fill and stroke.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorShape {
    /// What follows it through the frames.
    pub id: String,
    /// The path's pieces.
    pub subpaths: Vec<Subpath>,
    /// The inside, drawn before the stroke.
    pub fill: Option<Fill>,
    /// The line.
    pub stroke: Option<Stroke>,
    /// Of fill and stroke together, in [0, 1].
    pub opacity: f64,
}
