//! An animated GIF.

use inbetween::animation::{Animation, Background};
use inbetween::export::{Backdrop, ColourCount, FASTEST_GIF, GifWriter, Palette, PendingFile, WriteError};
use inbetween::pipeline::Character;

use super::job::Job;
use crate::cli::frames;

/// How many frames, spread over the animation, the colours are chosen from.
const PALETTE_FRAMES: usize = 32;

pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    let mut file = PendingFile::create(job.output)?;
    let refusal = |error: WriteError| error.at(job.output);
    let character = job.character()?;
    let animation = job.animation();
    if animation.fps > FASTEST_GIF {
        job.verbosity.note(&format!(
            "note: a GIF shows at most {} frames a second, so it will play slower than it should; choose a lower --fps",
            FASTEST_GIF
        ));
    }
    let palette = palette(&character, animation)?;
    let progress = job.progress();
    let backdrop = match animation.background {
        Background::Colour([_, _, _, 255]) => Backdrop::Opaque,
        _ => Backdrop::Clear,
    };
    let mut writer = GifWriter::new(
        &mut file,
        job.size(),
        animation.fps,
        palette,
        backdrop,
        job.repetition(),
    )
    .map_err(refusal)?;
    frames::in_order(&character, animation, &job.numbers, &progress, |frame, shown| {
        Ok(writer.add_held(frame, shown.len()).map_err(refusal)?)
    })?;
    writer.finish().map_err(refusal)?;
    file.commit()?;
    job.done(&character, &progress)
}

/// Colours from the whole animation, whichever frames are asked for: their pixels must not depend on that.
fn palette(character: &Character, animation: &Animation) -> anyhow::Result<Palette> {
    let count = animation.frame_count();
    let looked_at = PALETTE_FRAMES.min(count);
    let numbers: Vec<usize> = (0..looked_at).map(|k| 1 + k * count / looked_at).collect();
    let mut colours = ColourCount::default();
    for batch in numbers.chunks(rayon::current_num_threads()) {
        for frame in frames::batch_of(character, animation, batch)? {
            colours.add(&frame);
        }
    }
    Ok(Palette::new(&colours))
}
