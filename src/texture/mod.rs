//! Texture weights: how much of each pose's drawing is seen in a frame.

mod weights;

pub use weights::{TextureError, texture_weights};
