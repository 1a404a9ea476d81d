//! `inbetween frame`.

use std::path::PathBuf;

use anyhow::Context as _;
use inbetween::animation::Background;
use inbetween::export::{png_bytes, svg_text};
use inbetween::pipeline::{CameraRule, checked_weights};
use inbetween::scene::Scene;

use super::output::Output;
use super::values::{Grid, Numbers, background, camera, supersample};
use super::{Failure, Verbosity};

/// Render one frame of a scene
///
/// At a place of the pose space, or for weights given one a pose in the scene's order. Weights must sum to 1; they may
/// be negative or larger than 1.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween frame walker/scene.toml --at 0.5,0.5 -o between.png
  inbetween frame walker/scene.toml --weights 0.5,0.5,0,0,0 -o half.png
  inbetween frame face/scene.toml --at 0.5,0.5 -o between.svg")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// A place of the pose space: X,Y or as many numbers as it has dimensions
    #[arg(
        long,
        value_name = "X,Y",
        allow_hyphen_values = true,
        required_unless_present = "weights",
        conflicts_with = "weights"
    )]
    at: Option<Numbers>,
    /// Weights, one a pose
    #[arg(long, value_name = "W0,W1,...", allow_hyphen_values = true)]
    weights: Option<Numbers>,
    /// The picture, a .png or .svg file, or - for a PNG on standard output
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,
    /// Columns and rows, such as 1920x1080; the scene's otherwise
    #[arg(long, value_name = "WxH")]
    size: Option<Grid>,
    /// What the frame shows: fit (all poses and the whole animation) or drawing (the drawings' own canvas); the scene's otherwise
    #[arg(long, value_name = "RULE", value_parser = camera)]
    camera: Option<CameraRule>,
    /// What is behind the character: transparent, white, black, #rrggbb or #rrggbbaa; the scene's otherwise
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    background: Option<Background>,
    /// Final quality: look at K x K points of each pixel, K from 1 to 4
    #[arg(long, value_name = "K", default_value = "1", value_parser = supersample)]
    supersample: usize,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let suffix = arguments.output.extension().map(|s| s.to_string_lossy().to_lowercase());
    let as_curves = suffix.as_deref() == Some("svg");
    if arguments.output.as_os_str() != "-" && suffix.as_deref() != Some("png") && !as_curves {
        return Err(Failure::Usage(format!(
            "{}: a frame is written as .png or .svg; name the file so",
            arguments.output.display()
        )));
    }
    let mut scene = Scene::open(&arguments.scene)?;
    scene.camera = arguments.camera.unwrap_or(scene.camera);
    if let Some(Numbers(weights)) = &arguments.weights {
        checked_weights(weights, &scene.names()).context("--weights")?;
    }
    if let Some(Numbers(place)) = &arguments.at {
        super::weights::check_place(place, &scene)?;
    }
    let output = Output::open(&arguments.output)?;
    let mut scene = scene.with_automatic_places()?;
    if let Some(background) = arguments.background {
        scene.animation.background = background;
    }
    let size = arguments
        .size
        .map_or(scene.animation.size.map(|side| side as usize), |grid| grid.0);
    let character = scene.character(size, arguments.supersample)?;
    verbosity.notes(character.notes());
    let posed = match (&arguments.at, &arguments.weights) {
        (_, Some(Numbers(weights))) => character.posed_of(weights)?,
        (Some(Numbers(place)), None) => character.posed_at(place)?,
        (None, None) => return Err(Failure::Usage("give --at or --weights".to_owned())),
    };
    if posed.flipped() > 0 {
        verbosity.note(&format!(
            "note: {} triangles are inverted in this frame; `guard = \"repair\"` under [blend] repairs it",
            posed.flipped()
        ));
    }
    let bytes = if as_curves {
        svg_text(&character.draw(&posed))?.into_bytes()
    } else {
        png_bytes(&character.paint(&posed))
            .map_err(|reason| anyhow::anyhow!("{}: {reason}", arguments.output.display()))?
    };
    Ok(output.write(&bytes)?)
}
