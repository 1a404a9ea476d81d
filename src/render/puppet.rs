//! The character as textured meshes: what formats of deformed meshes write, and what an engine draws.
//!
//! A [`Puppet`] does not change over an animation; a [`PuppetFrame`] is what does. Meshes enclose the drawings, so what is seen is
//! decided by the textures' alpha, not by the mesh's edge.
//!
//! A layer of the character that lies over itself is one layer of the puppet a region: the parts of it that can be drawn one after another, each with the triangles around
//! it, in which it shows the same as its neighbours, and with pictures that are cut out by its edge and whole where another region hides it. The order of a frame says
//! which of them lies in front.

use super::painter::weights_of_drawings;
use super::{Camera, RegionMesh, Sampling};
use crate::math::Point;
use crate::pose::Mapping;

/// A character as textured meshes.
#[derive(Debug, Clone, PartialEq)]
pub struct Puppet {
    /// Columns and rows of the frames that positions are given in.
    pub size: [usize; 2],
    /// In the order of the scene; the regions of one layer follow one another.
    pub layers: Vec<PuppetLayer>,
    /// How colours are taken from the textures.
    pub sampling: Sampling,
}

/// One layer: a mesh and its textures.
#[derive(Debug, Clone, PartialEq)]
pub struct PuppetLayer {
    /// Its name; of a region of a layer that lies over itself the layer's and the limb's, as in `body/limb 2.1`.
    pub name: String,
    /// Three vertices each; positive (x right, y down) in every pose.
    pub triangles: Vec<[usize; 3]>,
    /// Outer boundary first, then holes, as vertices.
    pub rings: Vec<Vec<usize>>,
    /// The poses that have this layer.
    pub poses: Vec<PuppetPose>,
    /// The drawings' pictures.
    pub textures: Vec<PuppetTexture>,
}

/// A pose of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct PuppetPose {
    /// Its name.
    pub name: String,
    /// #vertices positions, in pixels of the frame.
    pub positions: Vec<Point>,
    /// Which texture it shows.
    pub texture: usize,
}

/// A picture and where the mesh's vertices lie on it.
#[derive(Clone, PartialEq)]
pub struct PuppetTexture {
    /// The name of the pose that it was drawn for.
    pub name: String,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row: red, green, blue, alpha, not premultiplied. Clear pixels have the colour of the drawing next to them, so
    /// that a reader that interpolates shows no fringe.
    pub pixels: Vec<[u8; 4]>,
    /// #vertices places, in pixels of the picture from its upper left corner.
    pub places: Vec<Point>,
}

impl std::fmt::Debug for PuppetTexture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PuppetTexture")
            .field("name", &self.name)
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

/// What changes from frame to frame.
#[derive(Debug, Clone, PartialEq)]
pub struct PuppetFrame {
    /// One a layer of the puppet, in its order.
    pub layers: Vec<PuppetLayerFrame>,
    /// The layers from back to front.
    pub order: Vec<usize>,
}

/// One layer in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct PuppetLayerFrame {
    /// #vertices positions, in pixels of the frame.
    pub positions: Vec<Point>,
    /// How much of each texture is seen; they sum to 1.
    pub textures: Vec<f64>,
    /// Of the layer, in [0, 1].
    pub opacity: f64,
}

impl PuppetLayer {
    /// The layer of a mapping seen by `camera`: its poses show the `textures` that `texture_of` says, one index a pose.
    #[must_use]
    pub fn new(
        name: &str,
        mapping: &Mapping,
        textures: Vec<PuppetTexture>,
        texture_of: &[usize],
        camera: &Camera,
    ) -> Self {
        let poses = mapping.poses.names().iter().zip(mapping.poses.positions());
        Self {
            name: name.to_owned(),
            triangles: mapping.poses.topology().triangles().to_vec(),
            rings: mapping.rings.clone(),
            poses: poses
                .zip(texture_of)
                .map(|((name, positions), texture)| PuppetPose {
                    name: name.clone(),
                    positions: positions.iter().map(|p| camera.to_pixels(*p)).collect(),
                    texture: *texture,
                })
                .collect(),
            textures,
        }
    }

    /// A region of a layer that lies over itself, from its mesh; `textures` are those of the region.
    #[must_use]
    pub(crate) fn of_region(
        name: String,
        mapping: &Mapping,
        mesh: &RegionMesh,
        textures: Vec<PuppetTexture>,
        texture_of: &[usize],
        camera: &Camera,
    ) -> Self {
        let whole = Self::new("", mapping, textures, texture_of, camera);
        let pose = |pose: PuppetPose| PuppetPose {
            positions: mesh.vertices.iter().map(|v| pose.positions[*v]).collect(),
            ..pose
        };
        Self {
            name,
            poses: whole.poses.into_iter().map(pose).collect(),
            textures: whole.textures,
            triangles: mesh.triangles.clone(),
            rings: mesh.rings.clone(),
        }
    }

    /// What the layer looks like with its vertices at `positions`, in source units, and `weights` of its poses for textures.
    #[must_use]
    pub fn frame(&self, positions: &[Point], weights: &[f64], opacity: f64, camera: &Camera) -> PuppetLayerFrame {
        let texture_of = self.poses.iter().map(|pose| pose.texture);
        let textures = weights_of_drawings(self.textures.len(), texture_of, weights);
        PuppetLayerFrame {
            positions: positions.iter().map(|p| camera.to_pixels(*p)).collect(),
            textures,
            opacity,
        }
    }
}
