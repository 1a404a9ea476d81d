//! An animated PNG.

use inbetween::export::{ApngWriter, PendingFile};

use super::job::Job;
use crate::cli::frames;

pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let character = job.character()?;
    let progress = job.progress();
    let animation = job.animation();
    let mut writer = ApngWriter::new(file, job.size(), animation.fps, job.numbers.len(), job.repetition())?;
    frames::in_order(&character, animation, &job.numbers, &progress, |frame| {
        Ok(writer.add(frame)?)
    })?;
    writer.finish()?;
    job.done(&character, &progress)
}
