//! lyon's paths (feature `lyon`).
//!
//! lyon has single precision, and in release builds takes coordinates that are not finite: they are refused before.

use lyon_path::geom::point;
use lyon_path::{Event, Path};

use super::{PathOutlineError, Segment};
use crate::input::Subpath;
use crate::math::{NotSingle, SinglePrecision};
use crate::outline::Outline;
use crate::render::{VectorFrame, VectorShape};

impl Subpath {
    /// A path of several pieces, in single precision.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite there.
    pub fn to_lyon(subpaths: &[Self], single: &SinglePrecision) -> Result<Path, NotSingle> {
        let at = |p| single.to_single(p).map(|[x, y]| point(x, y));
        let mut builder = Path::builder();
        for subpath in subpaths {
            builder.begin(at(subpath.start)?);
            for segment in subpath.segments() {
                match segment {
                    Segment::Line(to) => drop(builder.line_to(at(to)?)),
                    Segment::Cubic([a, b, to]) => drop(builder.cubic_bezier_to(at(a)?, at(b)?, at(to)?)),
                }
            }
            builder.end(subpath.is_closed);
        }
        Ok(builder.build())
    }

    /// The pieces of a path, in double precision.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite.
    pub fn from_lyon(path: &Path, single: &SinglePrecision) -> Result<Vec<Self>, NotSingle> {
        let at = |p: lyon_path::math::Point| {
            if p.x.is_finite() && p.y.is_finite() {
                return Ok(single.to_double([p.x, p.y]));
            }
            Err(NotSingle::NotFinite {
                x: f64::from(p.x),
                y: f64::from(p.y),
            })
        };
        let mut subpaths: Vec<Self> = Vec::new();
        for event in path.iter() {
            if let Event::Begin { at: start } = event {
                subpaths.push(Self::starting_at(at(start)?));
                continue;
            }
            // lyon's paths begin with a beginning.
            let Some(last) = subpaths.last_mut() else { continue };
            match event {
                Event::Begin { .. } => {}
                Event::Line { to, .. } => last.line_to(at(to)?),
                Event::Quadratic { ctrl, to, .. } => last.quadratic_to(at(ctrl)?, at(to)?),
                Event::Cubic { ctrl1, ctrl2, to, .. } => last.cubics.push([at(ctrl1)?, at(ctrl2)?, at(to)?]),
                Event::End { close, .. } => last.is_closed = close,
            }
        }
        Ok(subpaths)
    }
}

impl Outline {
    /// The outline as a path of lines, and how its coordinates became those of single precision.
    ///
    /// # Errors
    /// [`NotSingle`], which no outline gives: its coordinates are finite.
    pub fn to_lyon(&self) -> Result<(Path, SinglePrecision), NotSingle> {
        let single = SinglePrecision::fitting(self.outer().points())?;
        Ok((Subpath::to_lyon(&self.to_subpaths(), &single)?, single))
    }

    /// The outline of a path; see [`Outline::from_subpaths`].
    ///
    /// # Errors
    /// [`PathOutlineError`] as there; coordinates that are not finite are in no ring.
    pub fn from_lyon(path: &Path, single: &SinglePrecision, tolerance: f64) -> Result<Self, PathOutlineError> {
        let subpaths =
            Subpath::from_lyon(path, single).map_err(|NotSingle::NotFinite { x, y }| PathOutlineError::Ring {
                piece: 0,
                source: crate::outline::RingError::BadCoordinate { index: 0, x, y },
            })?;
        Self::from_subpaths(&subpaths, tolerance)
    }
}

impl VectorShape {
    /// The shape's path.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite there.
    pub fn to_lyon(&self, single: &SinglePrecision) -> Result<Path, NotSingle> {
        Subpath::to_lyon(&self.subpaths, single)
    }

    /// A shape with this path, neither filled nor stroked yet.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite.
    pub fn from_lyon(id: impl Into<String>, path: &Path, single: &SinglePrecision) -> Result<Self, NotSingle> {
        Ok(Self::of_subpaths(id, Subpath::from_lyon(path, single)?))
    }
}

impl VectorFrame {
    /// The paths of all its shapes with their ids, from back to front, in pixels of the frame.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite in single precision.
    pub fn to_lyon(&self) -> Result<Vec<(String, Path)>, NotSingle> {
        let path = |shape: &VectorShape| Ok((shape.id.clone(), shape.to_lyon(&SinglePrecision::UNCHANGED)?));
        self.shapes().into_iter().map(path).collect()
    }

    /// A frame of these paths, from back to front, in pixels of the frame, with the ids given; none is filled or stroked yet.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite.
    pub fn from_lyon<'a>(
        size: [usize; 2],
        paths: impl IntoIterator<Item = (String, &'a Path)>,
    ) -> Result<Self, NotSingle> {
        let shape = |(id, path): (String, &Path)| VectorShape::from_lyon(id, path, &SinglePrecision::UNCHANGED);
        let shapes: Vec<VectorShape> = paths.into_iter().map(shape).collect::<Result<_, _>>()?;
        Ok(Self::of_shapes(size, shapes))
    }
}
