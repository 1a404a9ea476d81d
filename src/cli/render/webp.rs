//! An animated WebP.

use inbetween::export::{PendingFile, WebPWriter, WriteError};

use super::job::Job;
use crate::cli::frames;

pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    let mut file = PendingFile::create(job.output)?;
    let refusal = |error: WriteError| error.at(job.output);
    let character = job.character()?;
    let progress = job.progress();
    let animation = job.animation();
    let mut writer = WebPWriter::new(&mut file, job.size(), animation.fps, job.repetition()).map_err(refusal)?;
    frames::in_order(&character, animation, &job.numbers, &progress, |frame, shown| {
        Ok(writer.add_held(frame, shown.len()).map_err(refusal)?)
    })?;
    writer.finish().map_err(refusal)?;
    file.commit()?;
    job.done(&character, &progress)
}
