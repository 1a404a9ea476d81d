//! How drawings are read, as far as it concerns others than the readers.

use super::PartOptions;
use crate::math::Point;

/// What becomes of holes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HoleRule {
    /// They are part of the outline.
    #[default]
    Keep,
    /// They are closed, and the picture keeps its pixels there.
    Fill,
}

/// How an SVG file is read.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct SvgOptions {
    /// The id of the element whose outline is meant. Default: everything that is drawn.
    pub element: Option<String>,
    /// What belongs to the drawing. Default: everything in the file.
    pub extent: Extent,
    /// Pixels to a user unit of the picture, at most as many as make it 8192 pixels long. Default: as many as make the
    /// longer side of the outline 1024 pixels long.
    pub pixels_per_unit: Option<f64>,
    /// What becomes of holes. Default: kept.
    pub holes: HoleRule,
    /// Which loose parts belong to it. Default: those that are no dirt.
    pub parts: PartOptions,
    /// The corners, in user units, of what the picture is to show. Default: the box of the outline.
    pub around: Option<[Point; 2]>,
}

/// What of an SVG file belongs to a drawing of which an element is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Extent {
    /// Everything in the file: the element is the shape's silhouette, painted over by the others.
    #[default]
    Everything,
    /// Only the element, with all that is in it: a file that holds several layers.
    Element,
}
