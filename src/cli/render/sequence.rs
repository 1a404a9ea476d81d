//! Numbered PNG files.

use inbetween::export::Sequence;
use rayon::prelude::*;

use super::fingerprint::Fingerprint;
use super::job::Job;

pub(super) fn run(mut job: Job<'_>) -> anyhow::Result<()> {
    let sequence = Sequence::create(job.output, &job.scene.short_name())?;
    let fingerprint = Fingerprint::of(&job)?;
    if job.resume {
        let wanted = job.numbers.len();
        let there = |number: &usize| sequence.path(*number).exists();
        let files = job.numbers.iter().filter(|number| there(number)).count();
        job.numbers
            .retain(|number| !sequence.has(*number, &fingerprint.label(*number)));
        let complete = wanted - job.numbers.len();
        job.verbosity
            .note(&format!("{complete} of {wanted} frames are already there"));
        if files > complete {
            job.verbosity.note(&format!(
                "note: {} files are of another scene, size or version, or not whole, and are rendered again",
                files - complete
            ));
        }
        if job.numbers.is_empty() {
            return Ok(());
        }
    }
    let character = job.character()?;
    let progress = job.progress();
    job.numbers.par_iter().try_for_each(|number| -> anyhow::Result<()> {
        let frame = character.frame(job.animation(), number - 1)?;
        sequence.write(*number, &frame, &fingerprint.label(*number))?;
        progress.advance();
        Ok(())
    })?;
    job.done(&character, &progress)
}
