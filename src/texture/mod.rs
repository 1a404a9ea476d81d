//! Texture weights.
