//! From blended meshes to pixels.
//!
//! A frame is a picture of one blended shape: the textures of all poses warped on its mesh and cross-faded
//! ([`painter`](Painter)), cut out by the blended full-resolution outline ([`Silhouette`]). Alphas are not
//! cross-faded, so the edge stays crisp while the colours change: each pose's texture is opaque beyond its own
//! edge ([`Texture`]), and the one edge of the frame is drawn with the exact area that it covers of each pixel
//! (`coverage.rs`).

mod affine_map;
mod band;
mod camera;
mod colour_blend;
pub(crate) mod coverage;
pub mod diagram;
pub mod drawing;
mod error;
mod frame;
mod level;
mod nearest_seed;
mod nearest_texel;
mod overlap;
mod painter;
pub mod puppet;
mod puppet_texture;
pub(crate) mod raster;
mod reached;
mod sampler;
#[cfg(feature = "scene")]
pub(crate) mod shaded;
mod silhouette;
mod texture;

pub use camera::Camera;
pub use colour_blend::ColourBlend;
pub use drawing::{
    CarriedDrawing, CrossFade, Cubic, Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement,
    PoseArt, Spread, Stop, Stroke, Subpath, VectorFrame, VectorGroup, VectorNode, VectorPicture, VectorShape,
};
pub use error::PictureError;
pub use frame::Frame;
pub use overlap::DepthOrder;
pub(crate) use overlap::{OverlapPainter, RegionMesh, RegionPictures, Regions, cut_out};
pub use painter::{PaintOptions, Painter, PoseTexture, Sampling};
pub use puppet::{Puppet, PuppetFrame, PuppetLayer, PuppetLayerFrame, PuppetPose, PuppetTexture};
pub use silhouette::Silhouette;
pub use texture::Texture;
