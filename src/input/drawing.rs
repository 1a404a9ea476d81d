//! What the input stage hands on: one pose's outline with its pixels.

use super::{Art, Canvas, LoosePart, Picture};
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
    /// How many pixels of the page a source unit is: 1 for a bitmap, 3.78 for an SVG file in millimetres.
    pub unit_px: f64,
    /// The page that it is on.
    pub canvas: Canvas,
    /// All its pieces, the largest one, which is the drawing's outline, among them, in the order in which they are drawn; empty if there is
    /// only one.
    pub parts: Vec<LoosePart>,
}

/// Something in a drawing that its outline does not show.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum InputNote {
    /// The figure is what differs from the background.
    FigurePainted {
        /// How many places inside look like the background and belong to the figure nevertheless.
        enclosed: usize,
    },
    /// The figure is what lines enclose.
    FigureOfLines {
        /// How many gaps in them were closed.
        bridged: usize,
    },
    /// A line has a gap that is too wide to be closed.
    LineOpen {
        /// Its middle, in source units.
        place: Point,
        /// How wide it is, in source units.
        width: f64,
        /// The same, as a fraction of the drawing's diagonal.
        gap: f64,
    },
    /// What was taken for the sheet lies on something else, as in a photograph; the figure is what is drawn on it.
    PageTaken,
    /// The figure touches all four borders.
    FillsCanvas,
    /// Something narrow along a whole border of the picture: the sheet's shadow, or what it lies on.
    BorderStripLeftOut,
    /// What covers the page behind an SVG drawing.
    BackgroundLeftOut,
    /// A shadow or glow outside of the outline.
    SoftEdgeCut,
    /// Variables of an SVG file that nothing gives a value.
    VariablesUnknown {
        /// Their names.
        names: Vec<String>,
    },
    /// Later pictures of an animated file.
    FramesLeftOut {
        /// How many, at least.
        count: usize,
    },
    /// Parts that are not connected to the largest one; the outline goes without them.
    PartsLeftOut {
        /// How many.
        count: usize,
        /// The area of all together, in source units squared.
        area: f64,
        /// The centroid of the largest, in source units.
        place: Point,
    },
    /// Several parts too small to be named one by one.
    SpecksLeftOut {
        /// How many.
        count: usize,
        /// The area of all together, in source units squared.
        area: f64,
    },
    /// A place under `keep` or `drop` that names no part of this drawing, but maybe one of another that lies over it.
    PlacePassedOver {
        /// The place, in source units.
        place: Point,
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
    /// What of a layer of a layered file is not kept.
    #[cfg(feature = "layered")]
    Layer {
        /// The path of the layer.
        layer: String,
        /// What.
        note: super::layered::LayerNote,
    },
    /// Translucent groups whose elements overlap: as curves, each element is translucent by itself.
    TranslucentGroups {
        /// How many.
        count: usize,
    },
}

impl InputNote {
    /// Whether an artist is to be told. What concerns one of several drawings alone is not for itself.
    #[must_use]
    pub fn is_told(&self) -> bool {
        !matches!(self, Self::PlacePassedOver { .. })
    }
}

impl std::fmt::Display for InputNote {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::FigurePainted { enclosed: 0 } => {
                f.write_str("the figure is what differs from the background, which is taken out")
            }
            Self::FigurePainted { enclosed } => write!(
                f,
                "the figure is what differs from the background, which is taken out around it; {} inside {} like the background \
                 and {} kept",
                counted(*enclosed, "place"),
                if *enclosed == 1 { "looks" } else { "look" },
                if *enclosed == 1 { "is" } else { "are" },
            ),
            Self::FigureOfLines { bridged: 0 } => f.write_str("the figure is what the lines enclose, with its inside"),
            Self::FigureOfLines { bridged } => write!(
                f,
                "the figure is what the lines enclose, with its inside; {} in the lines {} closed",
                counted(*bridged, "gap"),
                if *bridged == 1 { "is" } else { "are" },
            ),
            Self::LineOpen { place, width, gap } => write!(
                f,
                "the line is open near ({:.0}, {:.0}), by {width:.0} pixels: close it there, or set `gap = {:.3}` under [input]",
                place.x,
                place.y,
                // A little more than it takes.
                gap * 1.1 + 0.001
            ),
            Self::PageTaken => f.write_str("the drawing lies on a sheet, which lies on something else: the figure is looked for on the sheet"),
            Self::FillsCanvas => f.write_str(
                "the figure touches all four borders of the picture; if that is its background, cut the figure out or leave a margin of \
                 plain background around it",
            ),
            Self::BorderStripLeftOut => f.write_str(
                "a strip along a whole border of the picture, such as the shadow at the edge of a sheet, is left out; if it belongs to the \
                 drawing, a point on it under `keep` of the pose says so",
            ),
            Self::BackgroundLeftOut => f.write_str("a background that covers the page is left out"),
            Self::SoftEdgeCut => f.write_str(
                "a soft shadow or glow around the figure is cut off at its outline; draw it as a layer of its own if it is to be seen",
            ),
            Self::VariablesUnknown { names } => write!(
                f,
                "{} has no value, and nothing is drawn with it; define it, or write the colour itself",
                names.iter().map(|name| format!("var({name})")).collect::<Vec<_>>().join(", ")
            ),
            Self::FramesLeftOut { count } => write!(
                f,
                "the file is animated: only its first frame is used, {count} other frames or more are left out; `frame = 1` in a pose \
                 takes the second, and `inbetween new` makes a pose of each"
            ),
            Self::PartsLeftOut { count: 1, area, place } => write!(
                f,
                "a loose part of area {area:.0} near ({:.0}, {:.0}) is left out; join it to the body or give it its own layer",
                place.x, place.y
            ),
            Self::PartsLeftOut { count, area, place } => write!(
                f,
                "{count} loose parts with an area of {area:.0} together are left out, the largest near ({:.0}, {:.0}); join them to the \
                 body or give them their own layers",
                place.x, place.y
            ),
            Self::SpecksLeftOut { count, area } => write!(
                f,
                "{} with an area of {area:.0} together {} left out",
                counted(*count, "speck"),
                if *count == 1 { "is" } else { "are" }
            ),
            Self::PlacePassedOver { place } => write!(
                f,
                "no loose part is near ({:.1}, {:.1}), where `keep` or `drop` has a place",
                place.x, place.y
            ),
            Self::PinHolesClosed { count, area } => write!(
                f,
                "{} with an area of {area:.0} together {} closed",
                counted(*count, "pin-hole"),
                if *count == 1 { "is" } else { "are" }
            ),
            Self::HolesFilled { count } => write!(
                f,
                "{} {} filled, as asked",
                counted(*count, "hole"),
                if *count == 1 { "is" } else { "are" }
            ),
            Self::NotDrawn { what, count } => {
                write!(
                    f,
                    "{what} ({count} of them) cannot be drawn; convert to paths before export"
                )
            }
            Self::NotCurves { reason } => {
                write!(f, "it is drawn from pixels, not as curves, because {reason}")
            }
            #[cfg(feature = "layered")]
            Self::Layer { layer, note } => write!(f, "layer '{layer}': {note}"),
            Self::TranslucentGroups { count } => write!(
                f,
                "{count} translucent groups have elements that overlap, which show through one another when drawn as curves; \
                 unite the elements or give each its own opacity"
            ),
        }
    }
}

/// "1 gap", "2 gaps".
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
