//! Why a file is no drawing.

use std::path::PathBuf;

use crate::outline::{OutlineError, RingError};

/// Why a drawing cannot be used. Only [`InputError::Unreadable`] knows a path; whoever reads bytes adds the name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// There are not four bytes a pixel.
    #[error("{found} bytes for {width} x {height} pixels; give four bytes a pixel: red, green, blue, alpha")]
    PixelBytes {
        /// How many bytes there are.
        found: usize,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}; check the path and its permissions", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A place that is to name a piece of the drawing is far from all of them.
    #[error("`keep` and `drop`: there is nothing drawn near ({x:.1}, {y:.1}); give a place on the part that is meant")]
    NoPartThere {
        /// Its place.
        x: f64,
        /// Its place.
        y: f64,
    },
    /// The file has fewer pictures.
    #[error("there is no frame {frame}: the file has {count}, counted from 0; give one of them with `frame`")]
    NoSuchFrame {
        /// Which was asked for, from 0.
        frame: usize,
        /// How many there are.
        count: usize,
    },
    /// An element was asked for of a picture that has no layers.
    #[error(
        "`element = \"{element}\"` names a layer, but this picture has no layers; remove `element`, or give a file with layers"
    )]
    NoLayers {
        /// What was asked for.
        element: String,
    },
    /// A layered file cannot be used.
    #[cfg(feature = "layered")]
    #[error(transparent)]
    Layered(#[from] super::layered::LayeredError),
    /// The sheet has fewer cells.
    #[error(
        "there is no cell [{}, {}] in a sheet of {} x {} cells and {} x {} pixels; cells are counted from [0, 0]",
        at[0], at[1], of[0], of[1], size[0], size[1]
    )]
    NoSuchCell {
        /// Column and row.
        at: [usize; 2],
        /// How many columns and rows.
        of: [usize; 2],
        /// The sheet's columns and rows of pixels.
        size: [u32; 2],
    },
    /// No piece of the drawing is left.
    #[error("`drop` leaves nothing of the drawing; drop fewer parts")]
    AllDropped,
    /// The file has no bytes.
    #[error("the file is empty; export the drawing again")]
    EmptyFile,
    /// No known image format starts like this.
    #[error("this is not a PNG, JPEG, WebP, GIF, BMP or TIFF image; export the drawing as PNG")]
    NotAnImage,
    /// The image is damaged or of an unsupported kind.
    #[error("the image cannot be decoded ({reason}); export the drawing again as PNG")]
    Undecodable {
        /// What the decoder said.
        reason: String,
    },
    /// The image has no pixels.
    #[error("the image is {width} x {height} pixels: there is nothing in it")]
    NoPixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The image is larger than is read.
    #[error(
        "the image claims {width} x {height} pixels; at most {largest_side} a side and {largest_count} in all are read, so scale it down"
    )]
    TooManyPixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Most columns or rows.
        largest_side: u32,
        /// Most pixels.
        largest_count: u64,
    },
    /// The threshold is not strictly between 0 and 1.
    #[error("the threshold is {threshold}, but a coverage that counts as inside lies between 0.01 and 0.99")]
    BadThreshold {
        /// The value given.
        threshold: f64,
    },
    /// The gap is no fraction of the diagonal.
    #[error("the gap is {gap}, but a gap that is closed is a fraction of the diagonal between 0 and 0.2")]
    BadGap {
        /// The value given.
        gap: f64,
    },
    /// Alpha was asked to tell the figure, but there is none.
    #[error("`figure = \"alpha\"`, but all pixels are equally opaque; cut the figure out, or set `figure = \"auto\"`")]
    NoAlpha,
    /// Neither alpha nor a plain background tells the figure.
    #[error(
        "the figure cannot be told from its background: it is not cut out, and the background along the border is not plain (a \
         painted checkerboard is no transparency); cut it out and save it with transparency, or draw it on plain paper"
    )]
    BackgroundNotPlain,
    /// The file ends before the picture does.
    #[error("the image is cut off: the file ends before the picture does; copy or export it again")]
    CutOff,
    /// No pixel is covered enough.
    #[error(
        "there is no drawing in the {width} x {height} image: no pixel {}; give it a transparent or plain background",
        if *by_alpha { "is opaque enough" } else { "differs from the background" }
    )]
    NothingDrawn {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Whether the alpha channel decided, not the colour.
        by_alpha: bool,
    },
    /// The largest part is only a few pixels large.
    #[error(
        "the largest part, near ({x:.1}, {y:.1}), covers only {area:.2} pixels; draw it larger or lower the threshold"
    )]
    TooSmall {
        /// Its area, in pixels.
        area: f64,
        /// Its centroid.
        x: f64,
        /// Its centroid.
        y: f64,
    },
    /// The file is no SVG document.
    #[error("this is no SVG drawing: {reason}")]
    NotSvg {
        /// Why.
        reason: String,
    },
    /// A number of an SVG file is not finite or too large.
    #[error(
        "line {line}: '{attribute}' of {element} holds the number {number}; coordinates must be finite and at most {limit:e}"
    )]
    BadNumber {
        /// The element and its id.
        element: String,
        /// The attribute.
        attribute: String,
        /// Line of the file, from 1.
        line: u32,
        /// The number, as written.
        number: String,
        /// The largest that is read.
        limit: f64,
    },
    /// No element of an SVG file has the id asked for.
    #[error(
        "there is no element with the id '{id}'; {}",
        if known.is_empty() { "no element has an id".to_owned() } else { format!("there are: {}", known.join(", ")) }
    )]
    NoSuchElement {
        /// The id.
        id: String,
        /// The first ids of the file.
        known: Vec<String>,
    },
    /// An SVG file of nothing but text.
    #[error("the drawing is all text, which is not drawn; convert the text to paths (outlines) and save it again")]
    OnlyText,
    /// An SVG file of nothing but embedded pictures.
    #[error(
        "the drawing is an embedded picture, which is not drawn from an SVG file; export the picture as PNG and use that"
    )]
    OnlyPictures,
    /// Nothing that is drawn encloses an area.
    #[error("nothing that is drawn encloses an area: draw a closed shape with a fill or a stroke")]
    NoClosedShape,
    /// The resolution of a picture is not positive.
    #[error("the resolution is {pixels_per_unit} pixels a unit, but must be a positive number")]
    BadResolution {
        /// The value given.
        pixels_per_unit: f64,
    },
    /// A contour is no closed polygon.
    #[error("the outline cannot be used: {0}")]
    Ring(#[from] RingError),
    /// The contour is no outline.
    #[error("the outline cannot be used: {0}")]
    Outline(#[from] OutlineError),
}
