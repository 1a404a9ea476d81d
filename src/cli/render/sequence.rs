//! Numbered PNG files.

use inbetween::export::Sequence;
use rayon::prelude::*;

use super::job::Job;

pub(super) fn run(mut job: Job<'_>) -> anyhow::Result<()> {
    let sequence = Sequence::create(job.output, &job.scene.short_name())?;
    if job.resume {
        let before = job.numbers.len();
        job.numbers.retain(|number| !sequence.path(*number).is_file());
        let there = before - job.numbers.len();
        job.verbosity
            .note(&format!("{there} of {before} frames are already there"));
        if job.numbers.is_empty() {
            return Ok(());
        }
    }
    let character = job.character()?;
    let progress = job.progress();
    job.numbers.par_iter().try_for_each(|number| -> anyhow::Result<()> {
        let frame = character.frame(job.animation(), number - 1)?;
        sequence.write(*number, &frame)?;
        progress.advance();
        Ok(())
    })?;
    job.done(&character, &progress)
}
