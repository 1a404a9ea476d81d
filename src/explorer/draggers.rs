//! What is kept of a drag on the drawing from one request to the next.

use std::sync::Mutex;

use inbetween::pose::{HandleDeformation, HandleScratch};

/// The deformation that is being dragged.
#[derive(Debug, Default)]
pub(super) struct Draggers(pub(super) Mutex<Option<Dragger>>);

#[derive(Debug)]
pub(super) struct Dragger {
    /// Of the meshes, the layer and the pose.
    pub(super) key: (u64, usize, usize),
    pub(super) from: Vec<[f64; 2]>,
    pub(super) deformation: HandleDeformation,
    pub(super) scratch: HandleScratch,
}
