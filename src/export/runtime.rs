//! The crate's own file for playing and posing a character elsewhere (`.inb`), and its reader.
//!
//! Everything that a frame is computed from, nothing that can be computed from it: meshes, poses, options of the blend,
//! textures. The reader factorises. Little-endian throughout; no padding; `str` is a `u16` number of bytes and as much UTF-8;
//! `idx` is a `u16` in a layer of at most 65,536 vertices, else a `u32`.
//!
//! | part | bytes |
//! |---|---|
//! | `INBT` | 4 |
//! | version, 1, or 2 where a layer has regions | `u16` |
//! | precision: 0 single, 1 quantised | `u8` |
//! | 0 | `u8` |
//! | columns and rows of the frame | 2 × `u32` |
//! | sharpness of textures, as in the scene file | `f64` |
//! | P, number of poses; D, dimension of the pose space; L, number of layers | `u32`, `u32`, `u32` |
//! | each pose: name; place; layers from back to front | `str`, D × `f64`, L × `u32` |
//! | weights over the plane: 0, or 1 and a grid | `u8` |
//! | … lowest and highest place; columns C and rows R; weights row by row, P at each place | 4 × `f64`, 2 × `u32`, C R P × `f32` |
//! | animation: frames a second; 1 for a loop; F, number of frames; weights | `f64`, `u8`, `u32`, F P × `f32` |
//! | L layers | |
//!
//! A layer:
//!
//! | part | bytes |
//! |---|---|
//! | name | `str` |
//! | N, its poses; which they are; which texture each shows | `u32`, N × `u32`, N × `u32` |
//! | V, vertices; T, triangles; the triangles | `u32`, `u32`, 3 T × `idx` |
//! | number of rings; each: number of vertices, vertices | `u32`, (`u32`, × `idx`) |
//! | reference: `u32` pose, or 2³² − 1 for canonical | `u32` |
//! | stretch: 0 linear, 1 limited, 2 logarithmic; guard: 0 off, 1 repair | `u8`, `u8` |
//! | anchor: 0 centroid; 1 a vertex; 2 soft anchors: number, each vertex and stiffness | `u8`; `idx`; `u32`, (`idx`, `f64`) |
//! | whole turns: 0 or N of them | `u32`, × `i32` |
//! | regions: number; each vertex, radius, stiffness, limit of stretch | `u32`, (`idx`, 3 × `f64`) |
//! | tie: 0, or 1 and the layer it hangs on, its own point, the other's point; a point has for each of the N poses three vertices with shares | `u8`, `u32`, 2 N × 3 × (`u32`, `f64`) |
//! | single: N V positions | 2 N V × `f32` |
//! | quantised: lowest x and y, step; N V positions in steps above the lowest | 3 × `f64`, 2 N V × `u16` |
//! | number of textures; each: name, length of a PNG file, the file, V places on it as fractions of its width and height: single as they are, quantised times 65,535 | `u32`, (`str`, `u32`, bytes, 2 V × `f32` or `u16`) |
//! | version 2: R, number of regions, 0 of a layer that does not lie over itself | `u32` |
//! | version 2, each region: name; W, its vertices; which of the layer's they are | `str`, `u32`, W × `idx` |
//! | … number of triangles; the triangles, of its own vertices counted from 0 | `u32`, 3 × `idx` |
//! | … its textures, as those of a layer, with W places each; the layer itself then has none | as above |
//! | version 2, R > 0: for each of the N poses which region lies in front of which, row by row: 1 where that of the row does, −1 where that of the column does, 0 where they do not meet | N R R × `i8` |
//!
//! - **Size**: a vertex takes 4 bytes a pose quantised, 8 single, and as much for each texture. As text in the mapping file it takes about 40.
//! - **Precision**: quantised positions are off by at most half a step in x and y; the step is a power of two, and there are at most
//!   65,535 over the layer's extent in all poses, so an extent of 1,000 pixels gives 1/64 of a pixel and an error below 0.011. Singles
//!   are good to 6e-8 of a coordinate. Positions are pixels of the frame.
//! - **Weights** are those of the scene's provider, sampled: over the plane bilinear in between (an approximation; not quite 1 at a pose's
//!   own place), over the animation exact at frames. Beyond the grid the border holds.
//! - **Drawing** a frame: as [`Puppet`](crate::render::Puppet)s are drawn. There is no outline in the file: the textures' alpha is
//!   the edge.
//! - **Regions** are how a layer is drawn whose parts lie over one another in some poses, an arm over the chest: blended as one mesh, then drawn region by region, from back to
//!   front, each with its own triangles and textures. The order of a frame is found from the signs of the poses: their sum, each pose counting as its texture does (and a
//!   millionth of its weight besides, where no texture tells). Of the regions that are left, the one is drawn next whose row has the least sum of positive entries in the
//!   columns of those that are left, the first of equal ones. [`DepthOrder`] does so.
//! - A layer's weights are those of the poses it has, [restricted](crate::math::restricted_weights) and summing to 1 again.
//!
//! The reader trusts nothing: every count is held against the bytes that are left before anything is allocated, every index against what
//! it points into, every number must be finite, every triangle positive in every pose. It never panics.

mod read;
#[cfg(test)]
mod tests;
mod write;

pub use read::read_runtime;
pub use write::runtime_bytes;

use crate::blend::BlendOptions;
use crate::math::Point;
use crate::mesh::MeshPoint;
use crate::pose::PoseSet;
use crate::render::DepthOrder;

/// The first bytes of a file.
const MAGIC: [u8; 4] = *b"INBT";
/// The version that is written where no layer has regions.
const VERSION: u16 = 1;
/// The version that is written where one has, and the last one that is read.
const VERSION_WITH_REGIONS: u16 = 2;
/// In place of a pose: the canonical reference.
const CANONICAL: u32 = u32::MAX;

/// How positions are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// 32-bit floating point.
    Single,
    /// 16-bit steps over the layer's extent.
    #[default]
    Quantised,
}

/// A character for playing and posing.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeFile {
    /// Columns and rows of the frame that positions are given in.
    pub size: [u32; 2],
    /// How sharply textures follow the nearest pose, from 0 to 1.
    pub texture_sharpness: f64,
    /// At least one.
    pub poses: Vec<RuntimePose>,
    /// Weights over a plane of poses.
    pub field: Option<WeightField>,
    /// What is played.
    pub animation: RuntimeAnimation,
    /// At least one.
    pub layers: Vec<RuntimeLayer>,
}

/// A pose of the character.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimePose {
    /// Its name.
    pub name: String,
    /// Its place in the pose space; all have one dimension.
    pub at: Vec<f64>,
    /// The layers from back to front.
    pub order: Vec<usize>,
}

/// Weights sampled on an even grid.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightField {
    /// Where the first sample lies.
    pub low: [f64; 2],
    /// Where the last sample lies.
    pub high: [f64; 2],
    /// At least 2.
    pub columns: usize,
    /// At least 2.
    pub rows: usize,
    /// Row by row, one weight a pose at each place.
    pub weights: Vec<f32>,
}

impl WeightField {
    /// The weights at a place of the plane, one for each of `pose_count` poses, their sum 1.
    #[must_use]
    pub fn at(&self, place: [f64; 2], pose_count: usize) -> Vec<f64> {
        let along = |axis: usize, count: usize| {
            let part = (place[axis] - self.low[axis]) / (self.high[axis] - self.low[axis]);
            // Written so that NaN becomes 0.
            let at = (part * (count - 1) as f64).max(0.0).min((count - 1) as f64);
            let cell = (at as usize).min(count - 2);
            (cell, at - cell as f64)
        };
        let ((x, across), (y, down)) = (along(0, self.columns), along(1, self.rows));
        let sample = |x: usize, y: usize, pose: usize| {
            let at = (y * self.columns + x) * pose_count + pose;
            self.weights.get(at).copied().map_or(0.0, f64::from)
        };
        let mut weights: Vec<f64> = (0..pose_count)
            .map(|pose| {
                let row = |y: usize| sample(x, y, pose) * (1.0 - across) + sample(x + 1, y, pose) * across;
                row(y) * (1.0 - down) + row(y + 1) * down
            })
            .collect();
        let sum: f64 = weights.iter().sum();
        if sum != 0.0 {
            weights.iter_mut().for_each(|weight| *weight /= sum);
        }
        weights
    }
}

/// What is played.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeAnimation {
    /// Frames a second.
    pub fps: f64,
    /// Whether the first frame follows the last.
    pub is_loop: bool,
    /// #frames x #poses.
    pub weights: Vec<Vec<f32>>,
}

/// A layer of the character.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeLayer {
    /// Its name.
    pub name: String,
    /// Which of the character's poses have it, one for each pose of `mesh`.
    pub poses: Vec<usize>,
    /// The texture that each of these poses shows.
    pub texture_of: Vec<usize>,
    /// Its poses, in pixels of the frame.
    pub mesh: PoseSet,
    /// The boundary as vertex indices: outer ring first, then holes.
    pub rings: Vec<Vec<usize>>,
    /// How its poses are blended.
    pub options: BlendOptions,
    /// Where it hangs on another layer.
    pub tie: Option<RuntimeTie>,
    /// Its drawings; none of a layer with regions, which have their own.
    pub textures: Vec<RuntimeTexture>,
    /// What it is drawn in, where it lies over itself.
    pub regions: Option<RuntimeRegions>,
}

/// The regions of a layer that lies over itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeRegions {
    /// At least one.
    pub regions: Vec<RuntimeRegion>,
    /// Which of them lies in front of which, in each pose of the layer.
    pub order: DepthOrder,
}

/// A part of a layer that is drawn at once.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeRegion {
    /// Its name.
    pub name: String,
    /// Which vertices of the layer's mesh it has, in order.
    pub vertices: Vec<usize>,
    /// Three of its own vertices each, by their places in `vertices`.
    pub triangles: Vec<[usize; 3]>,
    /// Its pictures of the layer's drawings, with a place for each of its own vertices.
    pub textures: Vec<RuntimeTexture>,
}

/// A point of a mesh in each pose: three vertices and their shares.
pub type RuntimePoint = Vec<MeshPoint>;

/// A layer's point that is moved onto another layer's.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeTie {
    /// The other layer.
    pub to: usize,
    /// On the layer itself, one a pose of its own.
    pub own: RuntimePoint,
    /// On the other layer, one a pose of the layer that hangs.
    pub other: RuntimePoint,
}

/// A picture and where the mesh's vertices lie on it.
#[derive(Clone, PartialEq)]
pub struct RuntimeTexture {
    /// Its name.
    pub name: String,
    /// A PNG file.
    pub png: Vec<u8>,
    /// A place for each vertex, as fractions of its width and height from the upper left corner, in [0, 1].
    pub places: Vec<Point>,
}

impl std::fmt::Debug for RuntimeTexture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RuntimeTexture")
            .field("name", &self.name)
            .field("bytes", &self.png.len())
            .finish_non_exhaustive()
    }
}

/// Why bytes are no character.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RuntimeError {
    /// They are something else.
    #[error("this is no file of this kind: it does not begin with INBT")]
    NotOurs,
    /// They were written by a later version.
    #[error("the file has version {found}; this program reads versions 1 and 2")]
    Version {
        /// The file's.
        found: u16,
    },
    /// They end too early, or a count is too large.
    #[error("the file ends at byte {length}, in the middle of {what}; it is incomplete or damaged")]
    Short {
        /// Bytes there are.
        length: usize,
        /// What was being read.
        what: &'static str,
    },
    /// Something that was read makes no sense.
    #[error("byte {at}: {what}; the file is damaged")]
    Damaged {
        /// Where reading stood.
        at: usize,
        /// What is wrong.
        what: String,
    },
    /// It does not fit the format.
    #[error("{0}")]
    Unsuitable(String),
}
