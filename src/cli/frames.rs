//! Rendering many frames in parallel and handing them on in order.

use inbetween::animation::Animation;
use inbetween::pipeline::{Character, PipelineError};
use inbetween::render::Frame;
use rayon::prelude::*;

use super::Verbosity;
use super::progress::Progress;

/// Frames a thread renders before the batch is written: enough to keep threads busy while one frame is slow.
const FRAMES_A_THREAD: usize = 4;

/// Frames, given by their numbers from 1 in order, that show one drawing each.
pub(crate) fn drawings<'a>(animation: &Animation, numbers: &'a [usize]) -> Vec<&'a [usize]> {
    let drawn = |number: usize| animation.drawn_frame(number - 1);
    numbers.chunk_by(|a, b| drawn(*a) == drawn(*b)).collect()
}

/// Renders frames, given by their numbers from 1, and calls `each` with them in that order: with each drawing once, and the numbers
/// of the frames that show it.
pub(crate) fn in_order(
    character: &Character,
    animation: &Animation,
    numbers: &[usize],
    progress: &Progress,
    mut each: impl FnMut(&Frame, &[usize]) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    for batch in drawings(animation, numbers).chunks(FRAMES_A_THREAD * rayon::current_num_threads()) {
        let first: Vec<usize> = batch.iter().filter_map(|shown| shown.first().copied()).collect();
        for (frame, shown) in batch_of(character, animation, &first)?.iter().zip(batch) {
            each(frame, shown)?;
            shown.iter().for_each(|_| progress.advance());
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
    let flipped = |shown: &&[usize]| {
        let posed = character.posed(animation, shown[0] - 1)?;
        Ok(shown.iter().map(|number| (*number, posed.flipped())).collect())
    };
    let drawings = drawings(animation, numbers);
    let counted: Vec<Vec<(usize, usize)>> = drawings.par_iter().map(flipped).collect::<Result<_, PipelineError>>()?;
    let mut inverted = counted.concat();
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
