//! Rasterising.
