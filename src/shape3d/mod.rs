//! Shape by Example in three dimensions: forms of one topology, annotated with adjectives, blended at any place of their space.
//!
//! Source: Sloan, Rose, Cohen, "Shape by Example" (2001), called SBE.
