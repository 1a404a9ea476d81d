//! Texture weights: how much of each pose's drawing is seen in a frame.

mod presence;
mod weights;

pub use presence::weights_among;
pub use weights::{TextureError, texture_weights};
