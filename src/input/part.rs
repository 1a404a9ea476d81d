//! Which pieces belong to a drawing, and what is handed on of each.

use super::{Art, Picture};
use crate::math::Point;
use crate::outline::Outline;

/// What becomes of loose parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PartRule {
    /// They are handed on.
    #[default]
    Apart,
    /// Only the largest piece is handed on, and those that are asked for; a note tells of the others.
    Largest,
}

impl PartRule {
    /// What each is called in scene files.
    pub const NAMED: [(&'static str, Self); 2] = [("layers", Self::Apart), ("largest", Self::Largest)];
}

/// What places that name pieces are places of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlaceRule {
    /// Of this drawing: one without a piece is refused.
    #[default]
    OwnDrawing,
    /// Of one of several drawings that lie over one another, as those of layers: one without a piece is passed over
    /// ([`InputNote::PlacePassedOver`](super::InputNote::PlacePassedOver)), and so is one of `drop` on the largest piece, which is what the drawing is of.
    SeveralDrawings,
}

/// Which pieces belong to a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct PartOptions {
    /// What becomes of loose parts. Default: they are handed on.
    pub rule: PartRule,
    /// Places, in source units, of pieces that belong to it, however small. Default: none.
    pub keep: Vec<Point>,
    /// Places, in source units, of pieces that do not belong to it. Default: none.
    pub drop: Vec<Point>,
    /// What the places are places of. Default: of this drawing.
    pub places: PlaceRule,
}

/// A piece of a drawing that is in several.
#[derive(Debug, Clone, PartialEq)]
pub struct LoosePart {
    /// Its shape, in source units.
    pub outline: Outline,
    /// What it covers, in source units squared: of a few pixels more than lies inside the smooth outline around their centres.
    pub area: f64,
    /// Its pixels; `None` for those of the drawing itself.
    pub picture: Option<Picture>,
    /// Its curves, if the drawing has any.
    pub art: Option<Art>,
    /// Whether it was asked for.
    pub is_kept: bool,
}
