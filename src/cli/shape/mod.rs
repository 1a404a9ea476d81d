//! `inbetween shape`: shapes in space, Shape by Example.

mod format;
mod render;
mod weights;

use std::path::Path;

use clap::Subcommand;

use super::{Failure, Verbosity};

/// Shapes in space: 3D forms of one topology, blended at any place of the space of their adjectives
///
/// A shape's scene.toml lists example forms (OBJ) with values for named adjectives, such as bend and thickness.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween shape render bendable/scene.toml -o sheet.png                the whole space in one picture
  inbetween shape render bendable/scene.toml --at 0.2,0.4 -o form.obj    one form
  inbetween shape render bendable/scene.toml -o bendable.glb             the animation, for game engines
  inbetween shape weights bendable/scene.toml --at 0.2,0.4               the examples' weights")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    Render(render::Arguments),
    Weights(weights::Arguments),
}

impl Arguments {
    /// The file or folder that is made.
    pub(super) fn output(&self) -> &Path {
        match &self.verb {
            Verb::Render(verb) => &verb.output,
            Verb::Weights(verb) => &verb.output,
        }
    }
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    match &arguments.verb {
        Verb::Render(verb) => render::run(verb, verbosity),
        Verb::Weights(verb) => weights::run(verb),
    }
}

/// Refuses a place that the scene's space does not have.
fn check_place(place: &[f64], scene: &inbetween::scene::ShapeScene, flag: &str) -> anyhow::Result<()> {
    if place.len() != scene.dimension() {
        anyhow::bail!(
            "{flag} has {} values, but the adjectives of {} are {}, in this order",
            place.len(),
            scene.file.display(),
            scene.adjectives.join(", ")
        );
    }
    match place.iter().find(|v| !v.is_finite()) {
        Some(bad) => anyhow::bail!("{flag}: {bad} is no place; give finite numbers"),
        None => Ok(()),
    }
}
