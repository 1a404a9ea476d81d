//! kurbo's paths (feature `kurbo`). Both have double precision.

use kurbo::{BezPath, PathEl};

use super::{PathOutlineError, Segment};
use crate::input::Subpath;
use crate::math::Point;
use crate::outline::Outline;
use crate::render::{VectorFrame, VectorShape};

impl Subpath {
    /// A path of several pieces.
    #[must_use]
    pub fn to_kurbo(subpaths: &[Self]) -> BezPath {
        let at = |p: Point| kurbo::Point::new(p.x, p.y);
        let mut path = BezPath::new();
        for subpath in subpaths {
            path.move_to(at(subpath.start));
            for segment in subpath.segments() {
                match segment {
                    Segment::Line(to) => path.line_to(at(to)),
                    Segment::Cubic([a, b, to]) => path.curve_to(at(a), at(b), at(to)),
                }
            }
            if subpath.is_closed {
                path.close_path();
            }
        }
        path
    }

    /// The pieces of a path. What follows a closed piece without a move begins where that began, as kurbo has it.
    #[must_use]
    pub fn from_kurbo(path: &BezPath) -> Vec<Self> {
        let at = |p: kurbo::Point| Point::new(p.x, p.y);
        let mut subpaths: Vec<Self> = Vec::new();
        for element in path.elements() {
            if let PathEl::MoveTo(start) = element {
                subpaths.push(Self::starting_at(at(*start)));
                continue;
            }
            if let Some(closed) = subpaths.last().filter(|last| last.is_closed) {
                let start = closed.start;
                subpaths.push(Self::starting_at(start));
            }
            // kurbo's paths begin with a move.
            let Some(last) = subpaths.last_mut() else { continue };
            match element {
                PathEl::MoveTo(_) => {}
                PathEl::LineTo(to) => last.line_to(at(*to)),
                PathEl::QuadTo(control, to) => last.quadratic_to(at(*control), at(*to)),
                PathEl::CurveTo(a, b, to) => last.cubics.push([at(*a), at(*b), at(*to)]),
                PathEl::ClosePath => last.is_closed = true,
            }
        }
        subpaths
    }
}

impl Outline {
    /// The outline as a path of lines.
    #[must_use]
    pub fn to_kurbo(&self) -> BezPath {
        Subpath::to_kurbo(&self.to_subpaths())
    }

    /// The outline of a path; see [`Outline::from_subpaths`].
    ///
    /// # Errors
    /// [`PathOutlineError`] as there.
    pub fn from_kurbo(path: &BezPath, tolerance: f64) -> Result<Self, PathOutlineError> {
        Self::from_subpaths(&Subpath::from_kurbo(path), tolerance)
    }
}

impl VectorShape {
    /// The shape's path.
    #[must_use]
    pub fn to_kurbo(&self) -> BezPath {
        Subpath::to_kurbo(&self.subpaths)
    }

    /// A shape with this path, neither filled nor stroked yet.
    #[must_use]
    pub fn from_kurbo(id: impl Into<String>, path: &BezPath) -> Self {
        Self::of_subpaths(id, Subpath::from_kurbo(path))
    }
}

impl VectorFrame {
    /// The paths of all its shapes with their ids, from back to front, in pixels of the frame.
    #[must_use]
    pub fn to_kurbo(&self) -> Vec<(String, BezPath)> {
        let shapes = self.shapes().into_iter();
        shapes.map(|shape| (shape.id.clone(), shape.to_kurbo())).collect()
    }
}
