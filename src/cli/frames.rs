//! Rendering many frames in parallel and handing them on in order.

use inbetween::pipeline::{Character, PipelineError};
use inbetween::render::Frame;
use inbetween::scene::Animation;
use rayon::prelude::*;

use super::progress::Progress;

/// Frames a thread renders before the batch is written: enough to keep threads busy while one frame is slow.
const FRAMES_A_THREAD: usize = 4;

/// Renders frames, given by their numbers from 1, and calls `each` with them in that order.
pub(crate) fn in_order(
    character: &Character,
    animation: &Animation,
    numbers: &[usize],
    progress: &Progress,
    mut each: impl FnMut(&Frame) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    for batch in numbers.chunks(FRAMES_A_THREAD * rayon::current_num_threads()) {
        for frame in batch_of(character, animation, batch)? {
            each(&frame)?;
            progress.advance();
        }
    }
    Ok(())
}

/// Renders a few frames, given by their numbers from 1, in parallel.
pub(crate) fn batch_of(
    character: &Character,
    animation: &Animation,
    numbers: &[usize],
) -> Result<Vec<Frame>, PipelineError> {
    numbers
        .par_iter()
        .map(|number| character.frame(animation, number - 1))
        .collect()
}
