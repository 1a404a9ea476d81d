//! Layered drawings: PSD and PSB, OpenRaster, Krita and Aseprite files.
//!
//! Bytes -> [`LayeredFile`]: the tree of layers and groups, their names, places and settings; -> the pixels of the whole visible picture, or of one layer
//! or group, on the file's canvas.
//!
//! Sources: "Adobe Photoshop File Formats Specification" (2019), with what other readers know of its gaps; the OpenRaster layer stack specification 0.0.6;
//! Krita's `maindoc.xml` and tiles as Krita 5 writes them; "Aseprite File Format Specifications" of Aseprite 1.3. Compositing: W3C "Compositing and Blending Level 1".
//!
//! 1. The kind of file is told by its first bytes (module `kind`), whatever its name.
//! 2. The tree is read; pixels stay where they are. Each format is a module (`psd`, `ora`, `kra`, `ase`) that gives a tree and a `PixelSource`.
//! 3. What is asked for is composed from back to front in sixteen bits, one layer decoded at a time (modules `compose`, `raster`). Pixels that one layer alone shows
//!    come out exactly as they are stored; 16-bit ones are rounded to eight.
//!
//! An element that is named is drawn whether its eye is open or not, since the poses of a file are hidden in turns while they are drawn; in it, what
//! is hidden stays hidden. Opacity and masks of its own and of the groups around it count, and so does what it is clipped by; layers that are clipped
//! by it are drawn with it. Its own blend mode has nothing to act on.
//!
//! Memory: the file, one layer, and one sheet of eight bytes a pixel for each group that has to be composed by itself, together at most as much as three of the
//! largest picture take (`MOST_SHEETS`). Every size that a file claims is
//! compared with a limit, or with the bytes that are there, before it is allocated. Limits: blend modes other than normal and multiply, live effects, adjustment
//! layers and vector masks are not drawn, which a note says; colours are taken as they are stored, without colour profiles.

mod archive;
mod ase;
mod bytes;
mod compose;
mod error;
mod kind;
mod kra;
mod note;
mod ora;
mod psd;
mod raster;
mod tree;
mod work;

use super::decode::{Decoded, check_size};
use super::{InputError, InputNote};

pub use error::LayeredError;
pub use kind::LayeredKind;
pub use note::LayerNote;
pub use tree::{BlendMode, Clipping, Layer, LayerContent};

use bytes::Bytes;
use raster::{CanvasSize, Mask, Tile};
use work::Work;

/// The most pixels of all sheets that are composed at once, as multiples of the largest picture: 1.5 GiB.
const MOST_SHEETS: u64 = 3;

/// What gives a file's pixels when they are needed.
trait PixelSource: std::fmt::Debug + Sync {
    /// The pixels of a layer, by its number, in a frame; `None` if there are none on the canvas.
    fn tile(&self, layer: usize, frame: usize, work: &mut Work) -> Result<Option<Tile>, LayeredError>;

    /// A mask, by its number.
    fn mask(&self, mask: usize, work: &mut Work) -> Result<Mask, LayeredError>;
}

/// A named range of frames.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct FrameTag {
    /// Its name.
    pub name: String,
    /// Its first frame, counted from 0.
    pub first: usize,
    /// Its last frame.
    pub last: usize,
}

/// A layered drawing whose tree is read, and whose pixels are read when they are asked for.
#[derive(Debug)]
pub struct LayeredFile<'a> {
    kind: LayeredKind,
    canvas: CanvasSize,
    layers: Vec<Layer>,
    frame_count: usize,
    tags: Vec<FrameTag>,
    pixels: Box<dyn PixelSource + 'a>,
}

/// What a layered file or one of its elements shows.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LayeredPicture {
    /// Columns and rows of the file's canvas.
    pub size: [usize; 2],
    /// Red, green, blue and alpha of each pixel, row by row, colours not multiplied by alpha.
    pub rgba: Vec<u8>,
    /// What of the layers in it is not kept, with the path of each layer.
    pub notes: Vec<(String, LayerNote)>,
}

impl<'a> LayeredFile<'a> {
    /// The layered drawing in the bytes of a file.
    ///
    /// # Errors
    /// [`InputError::Layered`] if it is of no known kind, damaged, or has colours that are not read; [`InputError::TooManyPixels`] and
    /// [`InputError::NoPixels`] for its canvas.
    pub fn open(bytes: &'a [u8]) -> Result<Self, InputError> {
        match LayeredKind::of(bytes) {
            Some(LayeredKind::Photoshop) => psd::open(bytes),
            Some(LayeredKind::OpenRaster) => ora::open(bytes),
            Some(LayeredKind::Krita) => kra::open(bytes),
            Some(LayeredKind::Aseprite) => ase::open(bytes),
            None if bytes.is_empty() => Err(InputError::EmptyFile),
            None => Err(LayeredError::Unsupported {
                what: "this kind of file is".to_owned(),
                remedy: "give a PSD, OpenRaster, Krita or Aseprite file",
            }
            .into()),
        }
    }

    /// Which kind of file it is.
    #[must_use]
    pub fn kind(&self) -> LayeredKind {
        self.kind
    }

    /// Columns and rows of its canvas.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.canvas.width, self.canvas.height]
    }

    /// Its outermost layers and groups, from back to front.
    #[must_use]
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// How many pictures it has one after the other: 1 of anything that is not animated.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.frame_count
    }

    /// Its named ranges of frames.
    #[must_use]
    pub fn tags(&self) -> &[FrameTag] {
        &self.tags
    }

    /// What is seen of the layer or group whose path is `element`, or of everything that is visible, in a frame.
    ///
    /// # Errors
    /// [`InputError::NoSuchFrame`]; [`InputError::Layered`] if there is no such element, nothing is drawn in it, or a layer of it cannot be read.
    pub fn picture(&self, element: Option<&str>, frame: usize) -> Result<LayeredPicture, InputError> {
        if frame >= self.frame_count {
            return Err(InputError::NoSuchFrame {
                frame,
                count: self.frame_count,
            });
        }
        Ok(compose::compose(self, element, frame)?)
    }
}

/// The size of the canvas that a file claims, if it is one that is read.
fn canvas_of(width: u32, height: u32) -> Result<CanvasSize, InputError> {
    check_size(width, height)?;
    Ok(CanvasSize {
        width: width as usize,
        height: height as usize,
    })
}

/// What is seen of an element, or of everything that is visible, as a picture to be outlined.
pub(super) fn decode(bytes: &[u8], element: Option<&str>, frame: Option<usize>) -> Result<Decoded, InputError> {
    let file = LayeredFile::open(bytes)?;
    let picture = file.picture(element, frame.unwrap_or(0))?;
    let image = super::decode::image_of_pixels(picture.size, &picture.rgba)?;
    let notes = picture.notes.into_iter();
    Ok(Decoded {
        later_frames: if frame.is_some() { 0 } else { file.frame_count - 1 },
        layer_notes: notes.map(|(layer, note)| InputNote::Layer { layer, note }).collect(),
        ..Decoded::exact(image)
    })
}

/// Columns and rows of the canvas of a layered file.
pub(super) fn canvas_size(bytes: &[u8]) -> Result<[u32; 2], InputError> {
    let size = LayeredFile::open(bytes)?.size();
    // A canvas has at most `LARGEST_SIDE` columns and rows.
    Ok(size.map(|side| side as u32))
}
