//! A sprite sheet.

use inbetween::export::SpriteSheet;

use super::job::Job;
use crate::cli::frames;

pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    let animation = job.animation();
    let mut sheet = SpriteSheet::new(job.output, &job.scene.short_name(), animation.fps)?;
    let character = job.character()?;
    let progress = job.progress();
    frames::in_order(&character, animation, &job.numbers, &progress, |frame, shown| {
        for number in shown {
            sheet.add(*number, frame)?;
        }
        Ok(())
    })?;
    sheet.finish()?;
    job.done(&character, &progress)
}
