//! `inbetween reach`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::anyhow;
use inbetween::math::Point;
use inbetween::pipeline::{ReachOptions, reach_landmarks};
use inbetween::scene::Scene;
use serde::Serialize;

use super::Failure;
use super::output::Output;
use super::values::Numbers;

/// Find the place of the pose space whose drawing brings landmarks to given places
///
/// Give landmarks of the scene, on the outline or inside, and where each should be, in the units of the drawings as
/// `inbetween blend` prints them. Prints {"at": [...], "weights": [...], "error": ..., "handles": {"NAME": [x, y]}}: the place, the
/// weights there, how far the landmarks are from their targets (root of the mean square) and where they come to lie. The
/// place is looked for in the box of the poses, widened by a quarter of its diagonal on every side.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween reach clown/scene.toml --handle left_hand=60,300
  inbetween reach clown/scene.toml --handle left_hand=80,120 --handle right_hand=560,420")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// A landmark and where it should be; may be repeated
    #[arg(long, value_name = "NAME=X,Y", required = true)]
    handle: Vec<Handle>,
    /// A file, or - for standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub(super) output: PathBuf,
}

/// `NAME=X,Y`.
#[derive(Debug, Clone, PartialEq)]
struct Handle {
    name: String,
    target: [f64; 2],
}

impl std::str::FromStr for Handle {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not NAME=X,Y with finite numbers, such as hand=120,80");
        let (name, place) = text.rsplit_once('=').ok_or_else(wrong)?;
        let Numbers(place) = place.parse()?;
        match place.as_slice() {
            [x, y] if !name.is_empty() && x.is_finite() && y.is_finite() => Ok(Self {
                name: name.to_owned(),
                target: [*x, *y],
            }),
            _ => Err(wrong()),
        }
    }
}

#[derive(Serialize)]
struct ReachText<'a> {
    at: &'a [f64],
    weights: &'a [f64],
    error: f64,
    handles: BTreeMap<&'a str, [f64; 2]>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    for (k, handle) in arguments.handle.iter().enumerate() {
        if arguments.handle[..k].iter().any(|other| other.name == handle.name) {
            return Err(Failure::Usage(format!(
                "--handle {} is given twice; give every landmark once",
                handle.name
            )));
        }
    }
    let scene = Scene::open(&arguments.scene)?;
    let in_scene = || scene.file.display().to_string();
    let names: Vec<&String> = (scene.landmarks.iter().map(|l| &l.name))
        .chain(scene.paths.iter().map(|path| &path.name))
        .collect();
    if names.is_empty() {
        return Err(anyhow!(
            "{}: the scene has no landmark that could reach anything; add one",
            in_scene()
        )
        .into());
    }
    let output = Output::open(&arguments.output)?;
    let targets: Vec<(String, Point)> = (arguments.handle.iter())
        .map(|handle| (handle.name.clone(), Point::from(handle.target)))
        .collect();
    let found = reach_landmarks(&scene.spec()?, &targets, &ReachOptions::default());
    let found = found.map_err(|error| scene.refusal(error))?;
    let named = targets.iter().zip(&found.reached);
    let mut text = serde_json::to_string(&ReachText {
        at: &found.at,
        weights: &found.weights,
        error: found.error,
        handles: named
            .map(|((name, _), place)| (name.as_str(), [place.x, place.y]))
            .collect(),
    })?;
    text.push('\n');
    Ok(output.write(text.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_is_a_name_and_a_place() {
        let handle: Handle = "left = hand=-3.5,1e2".parse().expect("a handle");
        assert_eq!((handle.name.as_str(), handle.target), ("left = hand", [-3.5, 100.0]));
        for bad in ["hand", "=1,2", "hand=1", "hand=1,2,3", "hand=1,x", "hand=1,inf"] {
            assert!(bad.parse::<Handle>().is_err(), "{bad}");
        }
    }
}
