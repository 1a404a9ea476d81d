//! What the input stage hands on: one pose's outline with its pixels.

use super::Picture;
use crate::math::Point;
use crate::outline::Outline;

/// One drawing, ready for matching and rendering.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// The shape, in source coordinates.
    pub outline: Outline,
    /// The pixels, background removed.
    pub picture: Picture,
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
        }
    }
}
