//! Compatible simplification and triangulation.
