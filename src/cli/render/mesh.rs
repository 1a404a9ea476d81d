//! Textured meshes that are deformed: glTF, Spine, the crate's own file for playing.

use inbetween::export::runtime::{Precision, runtime_bytes};
use inbetween::export::{PendingFile, PuppetMotion, PuppetReport, gltf_bytes, texture_png, write_spine};
use inbetween::pipeline::Character;
use inbetween::render::puppet::{Puppet, PuppetFrame};
use rayon::prelude::*;

use super::job::Job;
use crate::cli::frames::drawings;

/// Writes one `.glb` file.
pub(super) fn glb(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let take = Take::new(&job)?;
    let (bytes, report) = gltf_bytes(&take.motion(&job))?;
    file.fill(&bytes)?;
    take.done(&job, &report)
}

/// Writes a skeleton with its pictures into a folder, or beside the `.json` file that is named.
pub(super) fn spine(job: Job<'_>) -> anyhow::Result<()> {
    let take = Take::new(&job)?;
    let (_, report) = write_spine(job.output, &take.motion(&job))?;
    take.done(&job, &report)
}

/// Writes one file with all that a player needs. It holds the whole animation, whichever frames are asked for.
pub(super) fn runtime(job: Job<'_>) -> anyhow::Result<()> {
    let file = PendingFile::create(job.output)?;
    let character = job.character()?;
    let whole = character.runtime_file(job.animation(), texture_png)?;
    let written = runtime_bytes(&whole, Precision::Quantised).or_else(|_| runtime_bytes(&whole, Precision::Single));
    let (bytes, read) = written?;
    file.fill(&bytes)?;
    let layers = whole.layers.iter().zip(&read.layers);
    let pairs = layers.flat_map(|(a, b)| a.mesh.positions().iter().zip(b.mesh.positions()));
    let worst = pairs
        .flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).norm()))
        .fold(0.0, f64::max);
    job.verbosity.note(&format!(
        "{} bytes; vertices of the poses are at most {worst:.4} pixels from where they belong",
        bytes.len()
    ));
    job.done(&character, &job.progress())
}

/// The frames that are wanted, as meshes.
struct Take {
    character: Character,
    name: String,
    puppet: Puppet,
    times: Vec<f64>,
    frames: Vec<PuppetFrame>,
    progress: crate::cli::progress::Progress,
}

impl Take {
    fn new(job: &Job<'_>) -> anyhow::Result<Self> {
        let character = job.character()?;
        let progress = job.progress();
        let animation = job.animation();
        let puppet = character.puppet();
        let drawings: Vec<Vec<PuppetFrame>> = drawings(animation, &job.numbers)
            .par_iter()
            .map(|shown| {
                let posed = character.posed(animation, shown[0] - 1)?;
                shown.iter().for_each(|_| progress.advance());
                Ok(vec![character.puppet_frame(&puppet, &posed); shown.len()])
            })
            .collect::<anyhow::Result<_>>()?;
        let mut frames = drawings.concat();
        let first = job.numbers.first().copied().unwrap_or(1);
        let mut times: Vec<f64> = (job.numbers.iter())
            .map(|number| (number - first) as f64 / animation.fps)
            .collect();
        // A loop comes back to where it began, a frame's time after its last frame.
        if animation.is_loop() && frames.len() == animation.frame_count() && frames.len() > 1 {
            frames.push(frames[0].clone());
            times.push(times.len() as f64 / animation.fps);
        }
        Ok(Self {
            name: job.scene.short_name(),
            character,
            puppet,
            times,
            frames,
            progress,
        })
    }

    fn motion(&self, job: &Job<'_>) -> PuppetMotion<'_> {
        PuppetMotion {
            name: &self.name,
            puppet: &self.puppet,
            times: &self.times,
            frames: &self.frames,
            max_error: job.max_error,
        }
    }

    fn done(&self, job: &Job<'_>, report: &PuppetReport) -> anyhow::Result<()> {
        let keys = report.keys.iter().max().copied().unwrap_or(0);
        job.verbosity.note(&format!(
            "{keys} keys for {} frames; vertices are at most {:.3} pixels from where the frames have them",
            self.frames.len(),
            report.worst
        ));
        job.done(&self.character, &self.progress)
    }
}
