//! Texture weights: how much of each pose's drawing is seen in a frame.

mod weights;

pub use weights::{TextureError, shared_texture_weights, texture_weights};
