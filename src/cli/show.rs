//! `inbetween show`.

use std::path::PathBuf;

use inbetween::export::png_bytes;
use inbetween::pipeline::map_layer;
use inbetween::render::diagram::{self, Diagram, DiagramPose, Sections};
use inbetween::scene::Scene;
use inbetween::weights::WeightProvider as _;

use super::layer::{self, Chosen};
use super::output::Output;
use super::{Failure, Verbosity};

/// Explain a scene in one picture
///
/// Top: the outlines of all poses; equal numbers correspond, the colour between two says how unlike the outlines are, so
/// that you see where to put a landmark. Middle: what corresponds inside has one colour, under the mesh of every pose, whose thinnest
/// triangles are marked. Bottom: the pose
/// space, each place coloured by the weights of the poses there, the animation's path drawn in.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  inbetween show walker/scene.toml -o walker.png")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The picture, a .png file, or - for standard output
    #[arg(short, long, value_name = "OUT.png")]
    pub(super) output: PathBuf,
    /// The layer, in a scene with layers
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let Chosen {
        scene, layer, notes, ..
    } = layer::chosen(Scene::open(&arguments.scene)?, arguments.layer.as_deref())?;
    let output = Output::open(&arguments.output)?;
    let scene = scene.with_automatic_places()?;
    let in_scene = || scene.file.display().to_string();
    let provider = scene.weights(None)?;
    let (mapping, report) = map_layer(&layer).map_err(|error| scene.refusal(error))?;
    verbosity.notes(notes);
    verbosity.notes(&report.notes);
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
    let weights = |place: &[f64]| provider.weights_at(place).ok();
    let sections = Sections::new(&mapping, &report.matching, &report.landmarks);
    let diagram = Diagram {
        mapping: &mapping,
        matching: &report.matching,
        landmarks: &report.landmarks,
        poses: &poses,
        path: &path,
    };
    let picture = diagram::draw(&diagram, &sections, weights).map_err(|e| anyhow::anyhow!("{}: {e}", in_scene()))?;
    let bytes = png_bytes(&picture).map_err(|reason| anyhow::anyhow!("{}: {reason}", arguments.output.display()))?;
    output.write(&bytes)?;
    for line in in_words(&sections, mapping.poses.names()) {
        verbosity.note(&line);
    }
    Ok(())
}

/// Where a landmark is worth trying: the worst section of every pose that has a doubtful one.
fn in_words(sections: &Sections, names: &[String]) -> Vec<String> {
    let line = |(pose, name): (usize, &String)| {
        let worst = *sections.doubtful(pose).first()?;
        let (from, to) = sections.numbers(worst);
        (pose != sections.reference()).then(|| {
            format!(
                "pose '{name}': between links {from} and {to} the outlines differ most; a landmark there would help"
            )
        })
    };
    names.iter().enumerate().filter_map(line).collect()
}
