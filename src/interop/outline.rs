//! Outlines from paths and back.

use crate::input::Subpath;
use crate::outline::{Outline, OutlineError, Ring, RingError};

/// Why a path is no outline.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathOutlineError {
    /// There is no subpath, or none with an area.
    #[error("the path has no closed piece with an area; an outline needs one")]
    Empty,
    /// Curves cannot be divided so that they keep within the tolerance.
    #[error("the tolerance is {0}; it must be positive and finite")]
    BadTolerance(f64),
    /// A piece of the path is no ring.
    #[error("piece {piece} of the path: {source}")]
    Ring {
        /// Which, from 0.
        piece: usize,
        /// Why.
        source: RingError,
    },
    /// The rings are no outline.
    #[error(transparent)]
    Outline(#[from] OutlineError),
}

impl Outline {
    /// Its rings as closed paths of lines: the outer one first.
    #[must_use]
    pub fn to_subpaths(&self) -> Vec<Subpath> {
        let closed = |ring: &Ring| {
            let mut subpath = Subpath::starting_at(ring.point(0));
            for p in &ring.points()[1..] {
                subpath.line_to(*p);
            }
            subpath.is_closed = true;
            subpath
        };
        self.rings().iter().map(closed).collect()
    }

    /// The outline of a path whose pieces are closed by a line where they are open: the one with the largest area is the outer
    /// ring, the others are holes. No edge is further from its curve than `tolerance`, in the unit of the points. Pieces of fewer
    /// than three points are left out.
    ///
    /// # Errors
    /// [`PathOutlineError`] if there is no piece with an area, a coordinate is not finite or too large, or the rings meet or lie outside
    /// one another.
    pub fn from_subpaths(subpaths: &[Subpath], tolerance: f64) -> Result<Self, PathOutlineError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(PathOutlineError::BadTolerance(tolerance));
        }
        let mut rings = Vec::new();
        for (piece, subpath) in subpaths.iter().enumerate() {
            match Ring::new(subpath.polyline(&subpath.steps(tolerance))) {
                Ok(ring) => rings.push(ring),
                Err(RingError::TooFewPoints { .. }) => {}
                Err(source) => return Err(PathOutlineError::Ring { piece, source }),
            }
        }
        let largest = (0..rings.len())
            .max_by(|&a, &b| rings[a].signed_area().abs().total_cmp(&rings[b].signed_area().abs()))
            .ok_or(PathOutlineError::Empty)?;
        let outer = rings.remove(largest);
        Ok(Self::new(outer, rings)?)
    }
}
