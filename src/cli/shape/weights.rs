//! `inbetween shape weights`.

use std::path::PathBuf;

use inbetween::scene::ShapeScene;
use inbetween::scene::ShapeSpace;
use serde::Serialize;

use super::check_place;
use crate::cli::Failure;
use crate::cli::output::Output;
use crate::cli::values::Numbers;

/// Print the weights of a shape's examples at places of its space
///
/// One JSON object a line: {"weights": [...], "texture_weights": [...]}, one number an example in the scene's order. Examples without
/// a texture have the texture weight 0; without any texture the list is empty. No form is opened.
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  inbetween shape weights bendable/scene.toml --at 0,0.5 --at=-1,0 -o -")]
pub(super) struct Arguments {
    /// The shape's scene file
    scene: PathBuf,
    /// A place: one value an adjective, in the scene's order; may be repeated
    #[arg(long, value_name = "A,B,...", allow_hyphen_values = true, required = true)]
    at: Vec<Numbers>,
    /// A place of the textures, one for each --at; the same otherwise
    #[arg(long, value_name = "A,B,...", allow_hyphen_values = true)]
    texture_at: Vec<Numbers>,
    /// A file, or - for standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub(super) output: PathBuf,
}

#[derive(Serialize)]
struct WeightsText {
    weights: Vec<f64>,
    texture_weights: Vec<f64>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let texture_at = match arguments.texture_at.as_slice() {
        [] => &arguments.at,
        given if given.len() == arguments.at.len() => &arguments.texture_at,
        given => {
            return Err(Failure::Usage(format!(
                "{} --texture-at for {} --at; give one for each, or none",
                given.len(),
                arguments.at.len()
            )));
        }
    };
    let scene = ShapeScene::open(&arguments.scene)?;
    let output = Output::open(&arguments.output)?;
    let space = ShapeSpace::new(&scene)?;
    let mut text = String::new();
    for (Numbers(place), Numbers(texture_place)) in arguments.at.iter().zip(texture_at) {
        check_place(place, &scene, "--at")?;
        check_place(texture_place, &scene, "--texture-at")?;
        text.push_str(&serde_json::to_string(&WeightsText {
            weights: space.weights_at(place)?,
            texture_weights: space.texture_weights_at(texture_place)?,
        })?);
        text.push('\n');
    }
    Ok(output.write(text.as_bytes())?)
}
