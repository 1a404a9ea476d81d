//! Outlines and vector frames as the paths of other crates, and back.
//!
//! | feature | path | precision |
//! |---|---|---|
//! | `lyon` | `lyon_path::Path` | single: coordinates go through a [`SinglePrecision`](crate::math::SinglePrecision) |
//! | `kurbo` | `kurbo::BezPath` | double: nothing is lost |
//! | `tiny_skia` | `tiny_skia::Path` | single |
//!
//! [`Outline`](crate::outline::Outline)s, [`VectorShape`]s and whole
//! [`VectorFrame`]s get methods `to_lyon`, `from_lyon` and so on. All of them go by way of
//! [`Subpath`]s, which need no feature:
//!
//! 1. An outline's edges become lines ([`Subpath::line_to`]); a cubic curve that is such a line is
//!    written as a line.
//! 2. On the way back, lines become such curves again and quadratic curves are raised to cubic ones, exactly. An outline is made
//!    of polygons: curves are divided until no chord is further from its curve than the tolerance
//!    ([`Outline::from_subpaths`](crate::outline::Outline::from_subpaths)); the ring with the largest area is the outer one.
//!
//! Limits: paints and widths of lines are not part of a path; they stay with the caller.

mod flattening;
mod outline;

#[cfg(feature = "kurbo")]
mod kurbo;
#[cfg(feature = "lyon")]
mod lyon;
#[cfg(feature = "tiny_skia")]
mod tiny_skia;

#[cfg(test)]
mod tests;

pub use outline::PathOutlineError;

use crate::input::Subpath;
use crate::math::Point;
use crate::render::{VectorFrame, VectorNode, VectorShape};

/// One piece of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Segment {
    /// A line to a place.
    Line(Point),
    /// A cubic curve: two control points and its end.
    Cubic([Point; 3]),
}

impl Subpath {
    /// A subpath without any piece.
    #[must_use]
    pub fn starting_at(start: Point) -> Self {
        Self {
            start,
            cubics: Vec::new(),
            is_closed: false,
        }
    }

    /// Adds a line: a curve whose control points divide it in three.
    pub fn line_to(&mut self, to: Point) {
        self.cubics.push(line_from(self.end(), to));
    }

    /// Adds a quadratic curve, as the cubic one that it is.
    pub fn quadratic_to(&mut self, control: Point, to: Point) {
        let raised = |end: Point| end + (control - end) * (2.0 / 3.0);
        let from = self.end();
        self.cubics.push([raised(from), raised(to), to]);
    }

    /// Its pieces, lines where they are such.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let starts = std::iter::once(self.start).chain(self.cubics.iter().map(|[_, _, end]| *end));
        self.cubics.iter().zip(starts).map(|(cubic, from)| {
            if *cubic == line_from(from, cubic[2]) {
                Segment::Line(cubic[2])
            } else {
                Segment::Cubic(*cubic)
            }
        })
    }
}

fn line_from(from: Point, to: Point) -> [Point; 3] {
    let third = (to - from) / 3.0;
    [from + third, to - third, to]
}

impl VectorFrame {
    /// A frame of shapes, from back to front.
    #[must_use]
    pub fn of_shapes(size: [usize; 2], shapes: impl IntoIterator<Item = VectorShape>) -> Self {
        Self {
            size,
            background: None,
            nodes: shapes
                .into_iter()
                .map(|shape| VectorNode::Shape(Box::new(shape)))
                .collect(),
        }
    }

    /// All shapes, from back to front, out of their groups.
    #[must_use]
    pub fn shapes(&self) -> Vec<&VectorShape> {
        let mut shapes = Vec::new();
        let mut left: Vec<&VectorNode> = self.nodes.iter().rev().collect();
        while let Some(node) = left.pop() {
            match node {
                VectorNode::Group(group) => left.extend(group.nodes.iter().rev()),
                VectorNode::Shape(shape) => shapes.push(shape.as_ref()),
                VectorNode::Picture(_) => {}
            }
        }
        shapes
    }
}

impl VectorShape {
    /// A shape that is neither filled nor stroked.
    #[must_use]
    pub fn of_subpaths(id: impl Into<String>, subpaths: Vec<Subpath>) -> Self {
        Self {
            id: id.into(),
            subpaths,
            fill: None,
            stroke: None,
            opacity: 1.0,
        }
    }
}
