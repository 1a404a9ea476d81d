//! What the input stage hands on: one pose's outline with its pixels.

use super::{Art, Picture};
use crate::math::Point;
use crate::outline::Outline;

/// One drawing, ready for matching and rendering.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// The shape, in source coordinates.
    pub outline: Outline,
    /// The pixels, background removed.
    pub picture: Picture,
    /// The drawing as curves. `None` for a bitmap, and for an SVG file with something that curves cannot say, which a note names.
    pub art: Option<Art>,
    /// What was left out, for the artist to know.
    pub notes: Vec<InputNote>,
}

/// Something in a drawing that its outline does not show.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum InputNote {
    /// A part that is not connected to the largest one; the outline goes without it.
    PartLeftOut {
        /// Its centroid, in source units.
        place: Point,
        /// Its area, in source units squared.
        area: f64,
    },
    /// Several parts too small to be named one by one.
    SpecksLeftOut {
        /// How many.
        count: usize,
        /// The area of all together, in source units squared.
        area: f64,
    },
    /// Pin-holes that were closed.
    PinHolesClosed {
        /// How many.
        count: usize,
        /// The area of all together, in source units squared.
        area: f64,
    },
    /// Holes that were filled because the options asked for it.
    HolesFilled {
        /// How many.
        count: usize,
    },
    /// Elements of an SVG file that are not drawn.
    NotDrawn {
        /// What they are.
        what: &'static str,
        /// How many.
        count: usize,
    },
    /// Vector art that has to be shown from its pixels.
    NotCurves {
        /// Which element, and what about it.
        reason: String,
    },
    /// Translucent groups whose elements overlap: as curves, each element is translucent by itself.
    TranslucentGroups {
        /// How many.
        count: usize,
    },
}

impl std::fmt::Display for InputNote {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::PartLeftOut { place, area } => write!(
                f,
                "a loose part of area {area:.0} near ({:.0}, {:.0}) is left out; join it to the body or give it its own layer",
                place.x, place.y
            ),
            Self::SpecksLeftOut { count, area } => {
                write!(f, "{count} specks with an area of {area:.0} together are left out")
            }
            Self::PinHolesClosed { count, area } => {
                write!(f, "{count} pin-holes with an area of {area:.0} together are closed")
            }
            Self::HolesFilled { count } => write!(f, "{count} holes are filled, as asked"),
            Self::NotDrawn { what, count } => {
                write!(
                    f,
                    "{what} ({count} of them) cannot be drawn; convert to paths before export"
                )
            }
            Self::NotCurves { reason } => {
                write!(f, "it is drawn from pixels, not as curves, because {reason}")
            }
            Self::TranslucentGroups { count } => write!(
                f,
                "{count} translucent groups have elements that overlap, which show through one another when drawn as curves; \
                 unite the elements or give each its own opacity"
            ),
        }
    }
}
