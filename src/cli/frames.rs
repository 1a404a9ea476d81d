//! Rendering many frames in parallel and handing them on in order.

use inbetween::animation::Animation;
use inbetween::pipeline::{Character, PipelineError};
use inbetween::render::Frame;
use rayon::prelude::*;

use super::Verbosity;
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

/// Tells of frames with inverted triangles: they show folds, and an animator wants to know where.
pub(crate) fn tell_inverted(
    character: &Character,
    animation: &Animation,
    numbers: &[usize],
    verbosity: Verbosity,
) -> Result<(), PipelineError> {
    let flipped = |number: &usize| Ok((*number, character.posed(animation, number - 1)?.flipped()));
    let mut inverted: Vec<(usize, usize)> = numbers.par_iter().map(flipped).collect::<Result<_, PipelineError>>()?;
    inverted.retain(|(_, count)| *count > 0);
    if let Some((number, count)) = inverted
        .iter()
        .max_by_key(|(number, count)| (*count, std::cmp::Reverse(*number)))
    {
        verbosity.note(&format!(
            "note: {} of {} frames have inverted triangles, frame {number} the most, {count}; `guard = \"repair\"` under \
             [blend] repairs them",
            inverted.len(),
            numbers.len()
        ));
    }
    Ok(())
}
