//! Drawings: a file's bytes in, an outline and its pixels out.
//!
//! [`read_bitmap`], [`read_pixels`] and [`read_svg`] are pure; [`open_bitmap`] and [`open_svg`] are the ones that touch the disk. What was left out of a drawing (loose
//! parts, specks, pin-holes) is told in its [`InputNote`]s; what cannot be used is an [`InputError`].

mod alone;
mod art;
mod art_parts;
mod averaged;
mod bitmap;
mod border_strip;
mod box_filter;
mod canvas;
mod coverage;
mod decode;
mod drawing;
mod edges;
mod enclosure;
mod error;
mod figure;
mod found;
mod gaps;
mod interior;
mod iso_line;
mod lines;
mod loose;
mod obj;
mod paper;
mod path;
mod picture;
mod runs;
mod sheet;
mod svg;
mod svg_art;
mod svg_effects;
mod svg_numbers;
mod svg_silhouette;
mod svg_text;

pub use art::{Art, ArtElement};
pub use bitmap::{BitmapOptions, HoleRule, bitmap_size, frame_count, open_bitmap, read_bitmap, read_pixels};
pub use canvas::Canvas;
pub use decode::PictureChoice;
pub use drawing::{Drawing, InputNote};
pub use error::InputError;
pub use figure::{FigureKind, FigureRule, PaperRule};
pub use loose::{LoosePart, PartOptions, PartRule, PlaceRule};
pub use obj::{ObjError, ObjForm, ObjProblem, open_obj, read_obj};
pub use path::{
    Cubic, Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stop, Stroke, Subpath,
};
pub use picture::{Picture, read_chosen_picture, read_picture};
pub use sheet::find_cells;
pub use svg::{Extent, SvgOptions, open_svg, read_svg, read_svg_page, svg_page_px};
