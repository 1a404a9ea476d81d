//! tiny-skia's paths (feature `tiny_skia`), in single precision.

use tiny_skia::{Path, PathBuilder, PathSegment};

use super::{PathOutlineError, Segment};
use crate::input::Subpath;
use crate::math::{NotSingle, SinglePrecision};
use crate::outline::Outline;
use crate::render::VectorShape;

impl Subpath {
    /// A path of several pieces, in single precision; `None` where tiny-skia has no path: without pieces, or all in one point.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite there.
    pub fn to_tiny_skia(subpaths: &[Self], single: &SinglePrecision) -> Result<Option<Path>, NotSingle> {
        let mut builder = PathBuilder::new();
        for subpath in subpaths {
            let [x, y] = single.to_single(subpath.start)?;
            builder.move_to(x, y);
            for segment in subpath.segments() {
                match segment {
                    Segment::Line(to) => {
                        let [x, y] = single.to_single(to)?;
                        builder.line_to(x, y);
                    }
                    Segment::Cubic([a, b, to]) => {
                        let ([ax, ay], [bx, by]) = (single.to_single(a)?, single.to_single(b)?);
                        let [x, y] = single.to_single(to)?;
                        builder.cubic_to(ax, ay, bx, by, x, y);
                    }
                }
            }
            if subpath.is_closed {
                builder.close();
            }
        }
        Ok(builder.finish())
    }

    /// The pieces of a path, in double precision. tiny-skia's paths are finite.
    #[must_use]
    pub fn from_tiny_skia(path: &Path, single: &SinglePrecision) -> Vec<Self> {
        let at = |p: tiny_skia::Point| single.to_double([p.x, p.y]);
        let mut subpaths: Vec<Self> = Vec::new();
        for segment in path.segments() {
            if let PathSegment::MoveTo(start) = segment {
                subpaths.push(Self::starting_at(at(start)));
                continue;
            }
            if let Some(closed) = subpaths.last().filter(|last| last.is_closed) {
                let start = closed.start;
                subpaths.push(Self::starting_at(start));
            }
            // tiny-skia's paths begin with a move.
            let Some(last) = subpaths.last_mut() else { continue };
            match segment {
                PathSegment::MoveTo(_) => {}
                PathSegment::LineTo(to) => last.line_to(at(to)),
                PathSegment::QuadTo(control, to) => last.quadratic_to(at(control), at(to)),
                PathSegment::CubicTo(a, b, to) => last.cubics.push([at(a), at(b), at(to)]),
                PathSegment::Close => last.is_closed = true,
            }
        }
        subpaths
    }
}

impl Outline {
    /// The outline as a path of lines, and how its coordinates became those of single precision; `None` where single precision
    /// leaves nothing of it.
    ///
    /// # Errors
    /// [`NotSingle`], which no outline gives: its coordinates are finite.
    pub fn to_tiny_skia(&self) -> Result<Option<(Path, SinglePrecision)>, NotSingle> {
        let single = SinglePrecision::fitting(self.outer().points())?;
        let path = Subpath::to_tiny_skia(&self.to_subpaths(), &single)?;
        Ok(path.map(|path| (path, single)))
    }

    /// The outline of a path; see [`Outline::from_subpaths`].
    ///
    /// # Errors
    /// [`PathOutlineError`] as there.
    pub fn from_tiny_skia(path: &Path, single: &SinglePrecision, tolerance: f64) -> Result<Self, PathOutlineError> {
        Self::from_subpaths(&Subpath::from_tiny_skia(path, single), tolerance)
    }
}

impl VectorShape {
    /// The shape's path; `None` where tiny-skia has none.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite in single precision.
    pub fn to_tiny_skia(&self, single: &SinglePrecision) -> Result<Option<Path>, NotSingle> {
        Subpath::to_tiny_skia(&self.subpaths, single)
    }

    /// A shape with this path, neither filled nor stroked yet.
    #[must_use]
    pub fn from_tiny_skia(id: impl Into<String>, path: &Path, single: &SinglePrecision) -> Self {
        Self::of_subpaths(id, Subpath::from_tiny_skia(path, single))
    }
}
