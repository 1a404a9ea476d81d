//! Numbered files, PNG or SVG.

use inbetween::export::{Label, Sequence, SequenceKind};
use inbetween::pipeline::{Character, Posed};
use rayon::prelude::*;

use super::fingerprint::Fingerprint;
use super::job::Job;
use crate::cli::frames;

/// Writes a drawing as the frames that show it, given by their numbers.
type Write = fn(&Sequence, &[usize], &Character, &Posed, &Label) -> anyhow::Result<()>;

/// Writes PNG files.
pub(super) fn run(job: Job<'_>) -> anyhow::Result<()> {
    written(job, SequenceKind::Png, |sequence, shown, character, posed, label| {
        let frame = character.paint(posed);
        for number in shown {
            sequence.write(*number, &frame, label)?;
        }
        Ok(())
    })
}

/// Writes SVG files.
pub(super) fn curves(job: Job<'_>) -> anyhow::Result<()> {
    written(job, SequenceKind::Svg, |sequence, shown, character, posed, label| {
        let frame = character.draw(posed);
        for number in shown {
            sequence.write_curves(*number, &frame, label)?;
        }
        Ok(())
    })
}

fn written(mut job: Job<'_>, kind: SequenceKind, write: Write) -> anyhow::Result<()> {
    let sequence = Sequence::create(job.output, &job.scene.short_name(), kind)?;
    let fingerprint = Fingerprint::of(&job)?;
    if job.resume {
        let animation = &job.scene.animation;
        let wanted = job.numbers.len();
        let there = |number: &usize| sequence.path(*number).exists();
        let files = job.numbers.iter().filter(|number| there(number)).count();
        job.numbers
            .retain(|number| !sequence.has(*number, &fingerprint.label(animation, *number)));
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
    let animation = job.animation();
    let drawings = frames::drawings(animation, &job.numbers);
    drawings.par_iter().try_for_each(|shown| -> anyhow::Result<()> {
        let posed = character.posed(animation, shown[0] - 1)?;
        let label = fingerprint.label(animation, shown[0]);
        write(&sequence, shown, &character, &posed, &label)?;
        shown.iter().for_each(|_| progress.advance());
        Ok(())
    })?;
    job.done(&character, &progress)
}
