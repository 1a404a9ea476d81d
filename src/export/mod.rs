//! Writers, one a format: PNG, PNG sequences, GIF, APNG, WebP, sprite sheets; MP4 and WebM by way of ffmpeg; SVG, animated SVG,
//! Lottie; glTF, Spine; of forms in space OBJ and glTF.
//!
//! Every file is written under a temporary name beside its target and renamed when it is complete
//! ([`PendingFile`]), so a run that is killed leaves no torn file, and a run that fails leaves none at all.

mod apng;
mod changes;
mod ffmpeg;
mod gif;
mod gltf;
mod gltf_buffer;
mod keyed;
mod keys;
mod lottie;
mod obj;
mod palette;
mod pending;
mod png;
mod puppet_motion;
pub mod runtime;
mod sequence;
mod shape_gltf;
mod shape_keys;
mod smil;
mod spine;
mod sprites;
mod svg;
mod timing;
mod webp;

pub use apng::ApngWriter;
pub use ffmpeg::{VideoKind, VideoWriter};
pub use gif::{Backdrop, GifWriter};
pub use gltf::{LAYER_GAP, PIXELS_A_UNIT, gltf_bytes};
pub use keyed::{KeyOptions, KeyReport, KeyedError, KeyedVector, SampleTiming};
pub use keys::{Keys, place_keys};
pub use obj::{ObjForm, ObjTexture, mtl_text, obj_text, write_obj};
pub use palette::{ColourCount, Palette};
pub use pending::PendingFile;
pub use png::{Label, png_bytes, png_bytes_with};
pub use puppet_motion::{PuppetMotion, PuppetReport, texture_png};
pub use sequence::{Sequence, SequenceKind};
pub use shape_gltf::shape_gltf_bytes;
pub use shape_keys::{ShapeMotion, ShapeReport, ShapeState};
pub use spine::{SpineFiles, spine_files, write_spine};
pub use sprites::SpriteSheet;
pub use svg::{svg_text, svg_text_with};
pub use webp::WebPWriter;

use std::path::{Path, PathBuf};

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The system refuses.
    #[error("cannot write {}: {reason}; choose a place that exists, has room and that you may write to", path.display())]
    CannotWrite {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// Another program that is needed for it is missing or failed.
    #[error("cannot write {}: {reason}", path.display())]
    Program {
        /// The file.
        path: PathBuf,
        /// What happened, and what to do.
        reason: String,
    },
    /// The format cannot hold it.
    #[error("{}: {reason}", path.display())]
    Unsuitable {
        /// The file.
        path: PathBuf,
        /// What the format cannot hold, and what to do.
        reason: String,
    },
}

impl ExportError {
    fn cannot_write(path: &Path, reason: impl std::fmt::Display) -> Self {
        Self::CannotWrite {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}

/// Whether an animation plays once or again and again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repetition {
    /// Once.
    Once,
    /// For ever.
    Forever,
}

/// The box of pixels for which `keep` holds, as left, top, width and height; `None` if it holds for none.
fn box_of(width: usize, height: usize, keep: impl Fn(usize) -> bool) -> Option<[usize; 4]> {
    let (mut left, mut top, mut right, mut bottom) = (width, height, 0, 0);
    for y in 0..height {
        for x in 0..width {
            if keep(y * width + x) {
                left = left.min(x);
                right = right.max(x + 1);
                top = top.min(y);
                bottom = y + 1;
            }
        }
    }
    (left < right).then(|| [left, top, right - left, bottom - top])
}
