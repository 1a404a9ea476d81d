//! Rigid blending.
