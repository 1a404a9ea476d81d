//! An animated WebP.

use inbetween::export::{PendingFile, WebPWriter};

use super::job::Job;
use crate::cli::frames;

pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let character = job.character()?;
    let progress = job.progress();
    let animation = job.animation();
    let mut writer = WebPWriter::new(file, job.size(), animation.fps, job.repetition())?;
    frames::in_order(&character, animation, &job.numbers, &progress, |frame| {
        Ok(writer.add(frame)?)
    })?;
    writer.finish()?;
    job.done(&character, &progress)
}
