//! MP4 and WebM, by ffmpeg.

use inbetween::animation::Background;
use inbetween::export::{PendingFile, VideoKind, VideoWriter};

use super::job::Job;
use crate::cli::frames;

/// What an MP4 without a background is put before.
const WHITE: [u8; 3] = [255; 3];

pub(super) fn mp4(job: Job<'_>) -> anyhow::Result<()> {
    let background = match job.animation().background {
        Background::Colour([r, g, b, 255]) => [r, g, b],
        _ => {
            job.verbosity.note(
                "note: an MP4 has no transparency, so the animation is put before white; --background sets another \
                 colour, a .webm keeps the transparency",
            );
            WHITE
        }
    };
    let kind = VideoKind::Mp4 { background };
    let ([columns, rows], [padded_columns, padded_rows]) = (job.size(), kind.padded(job.size()));
    if [columns, rows] != [padded_columns, padded_rows] {
        job.verbosity.note(&format!(
            "note: an MP4 has even sides, so {columns}x{rows} is padded to {padded_columns}x{padded_rows}"
        ));
    }
    video(&job, kind)
}

pub(super) fn webm(job: Job<'_>) -> anyhow::Result<()> {
    video(&job, VideoKind::WebM)
}

fn video(job: &Job<'_>, kind: VideoKind) -> anyhow::Result<()> {
    let animation = job.animation();
    let file = PendingFile::create(job.output)?;
    let mut writer = VideoWriter::new(file, job.size(), animation.fps, kind)?;
    let character = job.character()?;
    let progress = job.progress();
    frames::in_order(&character, animation, &job.numbers, &progress, |frame, shown| {
        for _ in shown {
            writer.add(frame)?;
        }
        Ok(())
    })?;
    writer.finish()?;
    job.done(&character, &progress)
}
