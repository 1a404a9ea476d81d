//! Paths and what they are painted with: what an SVG file's elements are read to, what the mesh carries and what vector
//! formats write. Coordinates and lengths are in whatever unit the points are in: user units in a drawing, pixels in a frame.

use crate::math::Point;

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

impl Subpath {
    /// Where it ends.
    #[must_use]
    pub fn end(&self) -> Point {
        self.cubics.last().map_or(self.start, |[_, _, end]| *end)
    }

    /// Points on it: its start, and the middle and the end of every curve.
    pub(crate) fn ends_and_middles(&self) -> Vec<Point> {
        let mut places = vec![self.start];
        let mut from = self.start;
        for &[a, b, to] in &self.cubics {
            places.push((from + (a + b) * 3.0 + to) / 8.0);
            places.push(to);
            from = to;
        }
        places
    }

    /// Its start, then every curve's control points and end.
    pub fn points(&self) -> impl Iterator<Item = &Point> {
        std::iter::once(&self.start).chain(self.cubics.iter().flatten())
    }
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
    /// Its width, in the unit of the path's points.
    pub width: f64,
    /// Its ends.
    pub cap: LineCap,
    /// Its corners.
    pub join: LineJoin,
    /// How many times its width a mitred corner may reach before it is cut.
    pub miter_limit: f64,
    /// Lengths of dashes and gaps in turn, an even number of them; empty for a whole line.
    pub dashes: Vec<f64>,
    /// Where in the dashes the line starts.
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
    /// Where the gradient's own coordinates lie.
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
