//! Drawings: a file's bytes in, an outline and its pixels out.
//!
//! [`read_bitmap`], [`read_pixels`] and [`read_svg`] are pure; [`open_bitmap`] and [`open_svg`] are the ones that touch the disk. What was left out of a drawing (loose
//! parts, specks, pin-holes) is told in its [`InputNote`]s; what cannot be used is an [`InputError`].

mod art;
mod canvas;
mod drawing;
mod error;
mod options;
mod part;
mod path;
mod picture;

// Pixels.
#[cfg(feature = "images")]
mod alone;
#[cfg(feature = "images")]
mod averaged;
#[cfg(feature = "images")]
mod bitmap;
#[cfg(feature = "images")]
mod border_strip;
#[cfg(feature = "images")]
mod box_filter;
#[cfg(feature = "images")]
mod coverage;
#[cfg(feature = "images")]
mod decode;
#[cfg(feature = "images")]
mod edges;
#[cfg(feature = "images")]
mod enclosure;
#[cfg(feature = "images")]
mod figure;
#[cfg(feature = "images")]
mod found;
#[cfg(feature = "images")]
mod gaps;
#[cfg(feature = "images")]
mod interior;
#[cfg(feature = "images")]
mod iso_line;
#[cfg(feature = "images")]
mod lines;
#[cfg(feature = "images")]
mod loose;
#[cfg(feature = "images")]
mod paper;
#[cfg(feature = "images")]
mod picture_file;
#[cfg(feature = "images")]
mod runs;
#[cfg(feature = "images")]
mod sheet;

// Layers.
#[cfg(feature = "layered")]
pub mod layered;

// Curves.
#[cfg(feature = "svg")]
mod art_parts;
#[cfg(feature = "svg")]
mod svg;
#[cfg(feature = "svg")]
mod svg_art;
#[cfg(feature = "svg")]
mod svg_effects;
#[cfg(feature = "svg")]
mod svg_numbers;
#[cfg(feature = "svg")]
mod svg_page;
#[cfg(feature = "svg")]
mod svg_silhouette;
#[cfg(feature = "svg")]
mod svg_text;

// Forms in space.
#[cfg(feature = "shape3d")]
mod obj;

pub use art::{Art, ArtElement};
pub use canvas::Canvas;
pub use drawing::{Drawing, InputNote};
pub use error::InputError;
pub use options::{Extent, HoleRule, SvgOptions};
pub use part::{LoosePart, PartOptions, PartRule, PlaceRule};
pub use path::{
    Cubic, Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stop, Stroke, Subpath,
};
pub use picture::Picture;

#[cfg(feature = "images")]
pub use bitmap::{BitmapOptions, bitmap_size, frame_count, open_bitmap, read_bitmap, read_pixels};
#[cfg(feature = "images")]
pub use decode::PictureChoice;
#[cfg(feature = "images")]
pub use figure::{FigureKind, FigureRule, PaperRule};
#[cfg(feature = "images")]
pub use picture_file::{read_chosen_picture, read_picture};
#[cfg(feature = "images")]
pub use sheet::find_cells;

#[cfg(feature = "svg")]
pub use svg::{open_svg, read_svg, read_svg_page, svg_page_px};

#[cfg(feature = "shape3d")]
pub use obj::{ObjError, ObjForm, ObjProblem, open_obj, read_obj};
