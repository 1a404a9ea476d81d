//! One frame as curves.

use super::super::Frame;
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

/// A chain of cubic Bézier curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Subpath {
    /// Where it starts.
    pub start: Point,
    /// Each curve's two control points and its end.
    pub cubics: Vec<Cubic>,
    /// Whether its end is joined to its start.
    pub is_closed: bool,
}

/// A cubic Bézier curve from where the one before it ends: two control points and its end.
pub type Cubic = [Point; 3];

/// How the inside is filled.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// With what.
    pub paint: Paint,
    /// What is inside.
    pub rule: FillRule,
}

/// What is inside of a path that crosses itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FillRule {
    /// Where the winding number is not zero.
    #[default]
    NonZero,
    /// Where the winding number is odd.
    EvenOdd,
}

/// How a line is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// With what.
    pub paint: Paint,
    /// Its width, in pixels.
    pub width: f64,
    /// Its ends.
    pub cap: LineCap,
    /// Its corners.
    pub join: LineJoin,
    /// How many times its width a mitred corner may reach before it is cut.
    pub miter_limit: f64,
    /// Lengths of dashes and gaps in turn, in pixels, an even number of them; empty for a whole line.
    pub dashes: Vec<f64>,
    /// Where in the dashes the line starts, in pixels.
    pub dash_offset: f64,
}

/// How lines end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineCap {
    /// At the end.
    #[default]
    Butt,
    /// With a half disc.
    Round,
    /// With half a square.
    Square,
}

/// How lines turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineJoin {
    /// Pointed.
    #[default]
    Miter,
    /// Round.
    Round,
    /// Cut.
    Bevel,
}

/// What a path is painted with.
#[derive(Debug, Clone, PartialEq)]
pub enum Paint {
    /// One colour: red, green, blue, alpha, not premultiplied, each in [0, 1], in the encoding of sRGB.
    Solid([f64; 4]),
    /// Colours along a line or around a point.
    Gradient(Gradient),
}

/// Colours that change from place to place.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// Along what.
    pub kind: GradientKind,
    /// Where the gradient's own coordinates lie in the frame.
    pub placement: Placement,
    /// What is beyond its ends.
    pub spread: Spread,
    /// Its colours, by growing offset; at least one.
    pub stops: Vec<Stop>,
}

/// Along what the colours of a gradient change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GradientKind {
    /// From (0, 0) to (1, 0) in the gradient's own coordinates.
    Linear,
    /// From `focus` to the unit circle around (0, 0) in the gradient's own coordinates.
    Radial {
        /// Inside the unit circle.
        focus: Point,
    },
}

/// An affine map: (x, y) goes to x `along_x` + y `along_y` + `origin`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Where (1, 0) points.
    pub along_x: Point,
    /// Where (0, 1) points.
    pub along_y: Point,
    /// Where (0, 0) lies.
    pub origin: Point,
}

/// What is beyond the ends of a gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spread {
    /// The end's colour.
    #[default]
    Pad,
    /// The gradient there and back.
    Reflect,
    /// The gradient again.
    Repeat,
}

/// A colour of a gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Where, from 0 to 1.
    pub offset: f64,
    /// Red, green, blue, alpha, not premultiplied, each in [0, 1], in the encoding of sRGB.
    pub colour: [f64; 4],
}
