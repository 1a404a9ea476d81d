//! Writers, one a format: PNG, PNG sequences, GIF, APNG, WebP, sprite sheets; MP4 and WebM by way of ffmpeg; SVG, animated SVG,
//! Lottie; glTF, Spine; of forms in space OBJ and glTF.
//!
//! The writers of pictures take anything that takes bytes (`std::io::Write`, and `Seek` where the format needs it): a buffer in memory, a
//! socket, a file. They can be moved between threads, and their errors know no file; [`WriteError::at`] adds it.
//!
//! Whole or nothing: a file is written under a temporary name beside its target and renamed when it is complete
//! ([`PendingFile`]), so a run that is killed leaves no torn file, and a run that fails leaves none at all.

mod apng;
mod changes;
mod error;
mod ffmpeg;
mod gif;
mod gltf;
mod gltf_buffer;
mod keyed;
mod keys;
mod lottie;
mod motion_error;
#[cfg(feature = "shape3d")]
mod obj;
mod palette;
mod pending;
mod png;
mod puppet_motion;
pub mod runtime;
mod sequence;
#[cfg(feature = "shape3d")]
mod shape_gltf;
#[cfg(feature = "shape3d")]
mod shape_keys;
mod smil;
mod spine;
mod sprites;
mod svg;
mod timing;
#[cfg(feature = "lyon")]
mod vector_mesh;
mod webp;

pub use apng::ApngWriter;
pub use error::{ExportError, WriteError};
pub use ffmpeg::{VideoKind, VideoWriter};
pub use gif::{Backdrop, FASTEST_GIF, GifWriter};
pub use gltf::{LAYER_GAP, PIXELS_A_UNIT, gltf_bytes};
pub use keyed::{Approximation, KeyInterpolation, KeyOptions, KeyReport, KeyedError, KeyedVector, SampleTiming};
pub use keys::{Keys, place_keys};
pub use motion_error::{LayerFault, MotionError};
#[cfg(feature = "shape3d")]
pub use obj::{ObjForm, ObjTexture, mtl_text, obj_text, write_obj};
pub use palette::{ColourCount, Palette};
pub use pending::PendingFile;
pub use png::{Label, png_bytes, png_bytes_with, write_png};
pub use puppet_motion::{PuppetMotion, PuppetReport, texture_png};
pub use sequence::{Sequence, SequenceKind};
#[cfg(feature = "shape3d")]
pub use shape_gltf::shape_gltf_bytes;
#[cfg(feature = "shape3d")]
pub use shape_keys::{ShapeMotion, ShapeReport, ShapeState};
pub use spine::{SpineFiles, spine_files, write_spine};
pub use sprites::SpriteSheet;
pub use svg::{svg_text, svg_text_with};
#[cfg(feature = "lyon")]
pub use vector_mesh::{MeshPart, MeshVertex, PartKind, VectorMesh, VectorMeshError, VectorTessellator};
pub use webp::WebPWriter;

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
