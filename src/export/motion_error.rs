//! Why a motion of deformed meshes cannot be written.

use super::WriteError;

/// Why the motion of a puppet or of a shape in space cannot be written. Frames, times and layers are meant by their indices.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// There are no frames, or not one a time.
    #[error("{frames} frames at {times} times; at least one is needed")]
    FrameCount {
        /// The number of frames.
        frames: usize,
        /// The number of times.
        times: usize,
    },
    /// A time is not finite, or not later than the one before.
    #[error("the times of the frames do not increase")]
    Times {
        /// The index of the first such time.
        frame: usize,
    },
    /// The puppet has no layers, or its frame no pixels.
    #[error("there is nothing to show")]
    Empty,
    /// A layer is no textured mesh.
    #[error("layer '{name}': {fault}")]
    Layer {
        /// The layer.
        layer: usize,
        /// The layer's name.
        name: String,
        /// What is wrong with it.
        fault: LayerFault,
    },
    /// A frame does not show each layer of the puppet once.
    #[error("a frame does not have the layers of the puppet")]
    FrameLayers {
        /// The frame.
        frame: usize,
    },
    /// In a frame, positions, weights or the opacity of a layer are too few, too many or not finite.
    #[error("a frame does not fit layer '{name}'")]
    FrameFit {
        /// The frame.
        frame: usize,
        /// The layer.
        layer: usize,
        /// The layer's name.
        name: String,
    },
    /// The examples of a shape do not belong to one mesh.
    #[error("forms, normals and skin do not have the same vertices")]
    Vertices {
        /// The number of vertices of the mesh.
        expected: usize,
    },
    /// The states of a shape do not belong to its times, examples and joints.
    #[error("there is not one state a time, with a weight an example and a pose a joint")]
    States {
        /// The number of times.
        times: usize,
        /// The number of states.
        states: usize,
    },
    /// The file would be larger than its format allows.
    #[error("the file would be larger than the format allows (4 GB)")]
    TooLarge {
        /// Its size in bytes.
        bytes: usize,
    },
    /// A texture or the description of the mesh could not be encoded.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// What is wrong with a layer of a puppet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LayerFault {
    /// It has no triangles.
    #[error("there are no triangles")]
    NoTriangles,
    /// A triangle or ring is made of vertices that the textures do not place.
    #[error("a triangle or ring has a vertex that does not exist")]
    MissingVertex {
        /// The vertex.
        vertex: usize,
    },
    /// A texture does not place every vertex, or has not as many pixels as its size says, or none.
    #[error("a texture does not fit the mesh")]
    Texture {
        /// The texture.
        texture: usize,
    },
}
