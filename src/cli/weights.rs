//! `inbetween weights`.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::anyhow;
use inbetween::scene::{Provider, Scene};
use inbetween::texture::shared_texture_weights;
use inbetween::weights::WeightProvider as _;
use serde::Serialize;

use super::Failure;
use super::output::Output;
use super::values::{Grid, Numbers};

/// Print the weights of a scene's poses at places of the pose space
///
/// Only the layout is used; drawings are opened only if the scene gives no places, to lay them out. With --at one JSON object a line:
/// {"weights": [...], "texture_weights": [...]}. With --grid rows of x,y,w0,w1,... over the box of the poses, widened
/// by half its diagonal on every side.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween weights walker/scene.toml --at 0,0.5 --at=-1,0 -o -
  inbetween weights walker/scene.toml --grid 40x40 -o weights.csv")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// A place of the pose space; may be repeated
    #[arg(
        long,
        value_name = "X,Y",
        allow_hyphen_values = true,
        required_unless_present = "grid",
        conflicts_with = "grid"
    )]
    at: Vec<Numbers>,
    /// A grid of places
    #[arg(long, value_name = "COLSxROWS")]
    grid: Option<Grid>,
    /// Which weights; the scene's choice otherwise
    #[arg(long, value_parser = Provider::NAMED.map(|(name, _)| name))]
    provider: Option<String>,
    /// A file, or - for standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub(super) output: PathBuf,
}

#[derive(Serialize)]
struct WeightsText<'a> {
    weights: &'a [f64],
    texture_weights: &'a [f64],
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::open(&arguments.scene)?;
    for Numbers(place) in &arguments.at {
        check_place(place, &scene)?;
    }
    let provider = arguments.provider.as_deref().and_then(Provider::named);
    let output = Output::open(&arguments.output)?;
    let scene = scene.with_automatic_places()?;
    let in_scene = || scene.file.display().to_string();
    let provider = scene.weights(provider)?;
    let mut text = String::new();
    let mut weights = Vec::new();
    for Numbers(place) in &arguments.at {
        provider.weights(place, &mut weights)?;
        let shown = shared_texture_weights(&weights, &scene.originals(), scene.texture_sharpness)?;
        text.push_str(&serde_json::to_string(&WeightsText {
            weights: &weights,
            texture_weights: &shown,
        })?);
        text.push('\n');
    }
    if let Some(Grid([columns, rows])) = arguments.grid {
        if scene.dimension() != 2 {
            return Err(anyhow!("{}: --grid needs a pose space of two dimensions; use --at", in_scene()).into());
        }
        text.push_str("x,y");
        for pose in 0..scene.poses.len() {
            let _ = write!(text, ",w{pose}");
        }
        text.push('\n');
        let ([left, top], [right, bottom]) = widened_box(&scene);
        let along = |from: f64, to: f64, k: usize, count: usize| from + (to - from) * (k as f64 + 0.5) / count as f64;
        for row in 0..rows {
            for column in 0..columns {
                let (x, y) = (along(left, right, column, columns), along(top, bottom, row, rows));
                provider.weights(&[x, y], &mut weights)?;
                let _ = write!(text, "{x},{y}");
                for weight in &weights {
                    let _ = write!(text, ",{weight}");
                }
                text.push('\n');
            }
        }
    }
    Ok(output.write(text.as_bytes())?)
}

/// The box of the poses' places in a plane, widened by half its diagonal (or 1 for a single pose) on every side.
pub(crate) fn widened_box(scene: &Scene) -> ([f64; 2], [f64; 2]) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for pose in &scene.poses {
        for (d, v) in pose.at.iter().take(2).enumerate() {
            low[d] = low[d].min(*v);
            high[d] = high[d].max(*v);
        }
    }
    let diagonal = (high[0] - low[0]).hypot(high[1] - low[1]);
    let reach = if diagonal > 0.0 { 0.5 * diagonal } else { 1.0 };
    (low.map(|v| v - reach), high.map(|v| v + reach))
}

/// Refuses a place that the scene's pose space does not have.
pub(crate) fn check_place(place: &[f64], scene: &Scene) -> anyhow::Result<()> {
    if place.len() != scene.dimension() {
        return Err(anyhow!(
            "--at has {} coordinates, but the pose space of {} has {}",
            place.len(),
            scene.file.display(),
            scene.dimension()
        ));
    }
    match place.iter().find(|v| !v.is_finite()) {
        Some(bad) => Err(anyhow!("--at: {bad} is no place; give finite numbers")),
        None => Ok(()),
    }
}
