//! `inbetween show`.

use std::path::PathBuf;

use anyhow::Context as _;
use inbetween::export::png_bytes;
use inbetween::pipeline::{map_drawings, read_drawings, weight_provider};
use inbetween::render::diagram::{self, DiagramPose};
use inbetween::scene::Scene;

use super::output::Output;
use super::{Failure, Verbosity};

/// Explain a scene in one picture
///
/// Top: the outlines of all poses; equal colours and numbers correspond. Middle: the mesh on every pose. Bottom: the
/// pose space, each place coloured by the weights of the poses there, the animation's path drawn in.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  inbetween show walker/scene.toml -o walker.png")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The picture, a .png file, or - for standard output
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let scene = Scene::open(&arguments.scene)?;
    let output = Output::open(&arguments.output)?;
    let in_scene = || scene.file.display().to_string();
    let provider = weight_provider(&scene, None).with_context(in_scene)?;
    let drawings = read_drawings(&scene).with_context(in_scene)?;
    let (mapping, report) = map_drawings(&scene, &drawings).with_context(in_scene)?;
    for note in &report.notes {
        verbosity.note(&format!("note: {note}"));
    }
    let poses: Vec<DiagramPose> = scene
        .poses
        .iter()
        .map(|pose| DiagramPose {
            name: pose.name.clone(),
            at: pose.at.clone(),
        })
        .collect();
    let animation = &scene.animation;
    let path: Vec<Vec<f64>> = (0..=animation.frame_count())
        .map(|k| animation.at(animation.time_of_frame(k)))
        .collect();
    let weights = |place: &[f64]| {
        let mut weights = Vec::new();
        provider.weights(place, &mut weights).ok().map(|()| weights)
    };
    let picture =
        diagram::draw(&mapping, &poses, &path, weights).map_err(|e| anyhow::anyhow!("{}: {e}", in_scene()))?;
    let bytes = png_bytes(&picture).map_err(|reason| anyhow::anyhow!("{}: {reason}", arguments.output.display()))?;
    Ok(output.write(&bytes)?)
}
