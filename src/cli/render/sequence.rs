//! Numbered files, PNG or SVG.

use inbetween::export::{Label, Sequence, SequenceKind};
use inbetween::pipeline::{Character, Posed};
use rayon::prelude::*;

use super::fingerprint::Fingerprint;
use super::job::Job;

/// Writes a frame where it belongs.
type Write = fn(&Sequence, usize, &Character, &Posed, &Label) -> anyhow::Result<()>;

/// Writes PNG files.
pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    written(job, SequenceKind::Png, |sequence, number, character, posed, label| {
        Ok(sequence.write(number, &character.paint(posed), label)?)
    })
}

/// Writes SVG files.
pub(super) fn curves(job: Job<'_>) -> anyhow::Result<()> {
    written(job, SequenceKind::Svg, |sequence, number, character, posed, label| {
        Ok(sequence.write_curves(number, &character.draw(posed), label)?)
    })
}

fn written(mut job: Job<'_>, kind: SequenceKind, write: Write) -> anyhow::Result<()> {
    let sequence = Sequence::create(job.output, &job.scene.short_name(), kind)?;
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
        if job.numbers.is_empty() && job.certification.is_none() {
            return Ok(());
        }
    }
    let character = job.character()?;
    let progress = job.progress();
    job.numbers.par_iter().try_for_each(|number| -> anyhow::Result<()> {
        let posed = character.posed(job.animation(), number - 1)?;
        write(&sequence, *number, &character, &posed, &fingerprint.label(*number))?;
        progress.advance();
        Ok(())
    })?;
    job.done(&character, &progress)
}
