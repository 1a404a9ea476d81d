//! Curves that move: animated SVG, Lottie.

use anyhow::bail;
use inbetween::export::{KeyInterpolation, KeyOptions, KeyReport, KeyedVector, PendingFile, Repetition, SampleTiming};
use inbetween::pipeline::{Character, PipelineError};
use inbetween::render::drawing::{VectorFrame, VectorNode};
use rayon::prelude::*;

use super::job::Job;
use crate::cli::progress::Progress;

/// How often curves are looked at from one frame to the next: players show any moment, not only frames.
const SAMPLES_A_FRAME: usize = 4;
/// Samples that a thread draws before they are handed on: pictures are large.
const SAMPLES_A_THREAD: usize = 4;

/// Writes one animated `.svg` file.
pub(super) fn svg(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let take = Take::new(&job)?;
    let (text, report) = take.keyed.to_smil(&take.options)?;
    file.fill(text.as_bytes())?;
    take.done(&job, &report)
}

/// Writes one Lottie `.json` file.
pub(super) fn lottie(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let take = Take::new(&job)?;
    let (text, report) = take.keyed.to_lottie(&job.scene.short_name(), &take.options)?;
    file.fill(text.as_bytes())?;
    take.done(&job, &report)
}

/// The frames that are wanted, as curves, with what lies between them.
struct Take {
    character: Character,
    keyed: KeyedVector,
    options: KeyOptions,
    progress: Progress,
}

impl Take {
    fn new(job: &Job<'_>) -> anyhow::Result<Self> {
        let (Some(&first), Some(&last)) = (job.numbers.first(), job.numbers.last()) else {
            bail!("there is no frame to write");
        };
        let frame_count = job.numbers.len();
        if last - first + 1 != frame_count {
            bail!("what moves between frames needs frames in a row; give --frames such as {first}-{last}");
        }
        let character = job.character()?;
        let progress = job.progress();
        let is_whole = frame_count == job.animation().frame_count();
        let repetition = if is_whole { job.repetition() } else { Repetition::Once };
        let is_held = job.animation().is_held();
        let start = draw(&character, job, first - 1, 0.0)?;
        let timing = SampleTiming {
            fps: job.animation().fps,
            frame_count,
            samples_a_frame: if has_curves(&start.nodes) && !is_held {
                SAMPLES_A_FRAME
            } else {
                1
            },
            repetition,
        };
        let step = timing.samples_a_frame;
        let samples: Vec<usize> = (0..timing.sample_count()).collect();
        let mut keyed = KeyedVector::empty(timing);
        for batch in samples.chunks(SAMPLES_A_THREAD * rayon::current_num_threads()) {
            // The end of a loop is its start, to the last bit.
            let frame_of = |sample: usize| first - 1 + sample / step % job.animation().frame_count();
            let drawings: Vec<&[usize]> = batch
                .chunk_by(|a, b| {
                    is_held && job.animation().drawn_frame(frame_of(*a)) == job.animation().drawn_frame(frame_of(*b))
                })
                .collect();
            let frames: Vec<VectorFrame> = drawings
                .par_iter()
                .map(|shown| {
                    draw(
                        &character,
                        job,
                        frame_of(shown[0]),
                        (shown[0] % step) as f64 / step as f64,
                    )
                })
                .collect::<Result<_, _>>()?;
            let shown = drawings.iter().zip(&frames);
            for (sample, frame) in shown.flat_map(|(shown, frame)| shown.iter().map(move |sample| (sample, frame))) {
                keyed.add(frame)?;
                if sample % step == 0 && sample / step < frame_count {
                    progress.advance();
                }
            }
        }
        let mut options = KeyOptions::default();
        options.max_error_px = job.max_error;
        if is_held {
            options.interpolation = KeyInterpolation::Held;
        }
        Ok(Self {
            character,
            keyed,
            options,
            progress,
        })
    }

    fn done(&self, job: &Job<'_>, report: &KeyReport) -> anyhow::Result<()> {
        job.verbosity.note(&format!(
            "{} keys; points are at most {:.3} pixels, colours {:.1} of 255 from where the drawing has them",
            report.keys, report.worst_px, report.worst_step
        ));
        for what in &report.approximations {
            job.verbosity.note(&format!("note: {what}"));
        }
        job.done(&self.character, &self.progress)
    }
}

/// The character as curves at `part` of the way from frame `index`, counted from 0, to the next one; in an animation with holds as
/// in that frame.
fn draw(character: &Character, job: &Job<'_>, index: usize, part: f64) -> Result<VectorFrame, PipelineError> {
    let animation = job.animation();
    if animation.is_held() {
        return Ok(character.draw(&character.posed(animation, index)?));
    }
    let time = animation.time_of_frame(index);
    let next = animation.time_of_frame(index + 1);
    let posed = character.posed_at(&animation.at(time + (next - time) * part))?;
    Ok(character.draw(&posed))
}

fn has_curves(nodes: &[VectorNode]) -> bool {
    nodes.iter().any(|node| match node {
        VectorNode::Group(group) => group.clip.is_some() || has_curves(&group.nodes),
        VectorNode::Shape(_) => true,
        VectorNode::Picture(_) => false,
    })
}
