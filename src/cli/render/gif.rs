//! An animated GIF.

use inbetween::export::{Backdrop, GifWriter, Palette, PendingFile};
use inbetween::scene::Background;

use super::job::Job;
use crate::cli::frames;

/// How many frames, spread over the animation, the colours are chosen from.
const PALETTE_FRAMES: usize = 8;

pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let character = job.character()?;
    let progress = job.progress();
    let animation = job.animation();
    // From the whole animation, whichever frames are asked for: their pixels must not depend on that.
    let count = animation.frame_count();
    let looked_at: Vec<usize> = (0..PALETTE_FRAMES.min(count))
        .map(|k| 1 + k * count / PALETTE_FRAMES.min(count))
        .collect();
    let palette = Palette::for_frames(&frames::batch_of(&character, animation, &looked_at)?);
    let backdrop = match animation.background {
        Background::Colour([_, _, _, 255]) => Backdrop::Opaque,
        _ => Backdrop::Clear,
    };
    let mut writer = GifWriter::new(file, job.size(), animation.fps, palette, backdrop, job.repetition())?;
    frames::in_order(&character, animation, &job.numbers, &progress, |frame| {
        Ok(writer.add(frame)?)
    })?;
    writer.finish()?;
    job.done(&character, &progress)
}
