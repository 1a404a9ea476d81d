//! N-way morphing for 2D animation.

pub mod math;

pub mod mesh;
pub mod outline;
pub mod solve;

pub mod blend;
pub mod compatible;
pub mod export;
pub mod input;
pub mod matching;
pub mod pipeline;
pub mod pose;
pub mod render;
pub mod scene;
pub mod texture;
pub mod weights;
