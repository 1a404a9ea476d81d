//! `inbetween map`.

use std::path::PathBuf;

use inbetween::pipeline::map_layer_observed;
use inbetween::scene::Scene;

use super::layer::{self, Chosen};
use super::output::Output;
use super::stage_table::{self, StageClock};
use super::{Failure, Verbosity};

/// Map the drawings of a scene onto one another and write the mapping
///
/// The mapping is one triangulation with a place of every vertex on every pose, as JSON: poses with outlines and
/// vertices, triangles, boundary rings and the matching of the outlines.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween map walker/scene.toml -o walker.json && inbetween check walker.json
  inbetween map walker/scene.toml -o walker.json --report   what each stage did, and its time")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The mapping, or - for standard output
    #[arg(short, long, value_name = "MAPPING.json")]
    pub(super) output: PathBuf,
    /// The layer, in a scene with layers
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
    /// Say what each stage did and how long it took, on standard error, instead of the summary
    #[arg(long)]
    report: bool,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let scene = Scene::open(&arguments.scene)?;
    let Chosen {
        scene,
        layer,
        outlines,
        notes,
    } = layer::chosen(scene, arguments.layer.as_deref())?;
    let output = Output::open(&arguments.output)?;
    let mut clock = StageClock::start();
    let observed = map_layer_observed(&layer, &mut |stage| clock.begins(stage));
    clock.stop();
    let (mapping, report) = observed.map_err(|error| scene.refusal(error))?;
    verbosity.notes(notes);
    verbosity.notes(&report.notes);
    let is_one_of_several = arguments.layer.is_some() || outlines.iter().any(|parts| parts.len() > 1);
    output.write(
        mapping
            .to_json_of(is_one_of_several.then_some(layer.name.as_str()), &outlines)
            .as_bytes(),
    )?;
    if arguments.report {
        for line in stage_table::lines(&layer, &mapping, &report, &clock) {
            verbosity.note(&line);
        }
        return Ok(());
    }
    verbosity.note(&format!(
        "{} poses, {} vertices, {} triangles, {} Steiner points, smallest angle {:.1} degrees",
        mapping.poses.len(),
        mapping.poses.topology().vertex_count(),
        mapping.poses.topology().triangles().len(),
        mapping.steiner,
        report.quality.smallest_angle_deg
    ));
    Ok(())
}
