//! `inbetween add`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use inbetween::export::PendingFile;
use inbetween::math::Point;
use inbetween::pipeline::Note;
use inbetween::scene::Scene;
use toml_edit::{Array, DocumentMut, Item, Table, TableLike, Value};

use super::values::Numbers;
use super::{Failure, Verbosity};
use crate::tables::{name_of, tables};

/// Add one more drawing to a scene
///
/// The drawing becomes a pose of the scene: it is matched to the others, their landmarks are carried onto it, and it is placed by how like
/// it is to them, unless --at says where. What stands in the scene file stays as it is, comments too. A drawing that is not in the scene's
/// folder is copied into it.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween add walker/scene.toml sneak.png
  inbetween add walker/scene.toml sneak.png --at 0.5,-0.8")]
pub(crate) struct Arguments {
    /// The scene file
    pub(super) scene: PathBuf,
    /// The drawing: PNG, JPEG, WebP, GIF, BMP, TIFF or SVG
    drawing: PathBuf,
    /// Its place in the pose space: X,Y or as many numbers as it has dimensions; found if none is given
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    at: Option<Numbers>,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let file = &arguments.scene;
    let scene = Scene::open(file)?;
    if !scene.layers.is_empty() {
        return Err(anyhow::anyhow!(
            "{}: the scene has layers, and a pose needs a drawing a layer; write a [[pose]] with `source = {{ LAYER = \"FILE\" }}` by hand",
            file.display()
        )
        .into());
    }
    if let Some(Numbers(at)) = &arguments.at {
        super::weights::check_place(at, &scene)?;
    }
    let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    let mut document: DocumentMut = text
        .parse()
        .with_context(|| format!("cannot edit {}", file.display()))?;
    let (source, copied) = brought(&arguments.drawing, file)?;
    let added = added(&scene, &mut document, arguments, &source);
    if added.is_err()
        && let Some(copy) = &copied
    {
        // Nothing is left of a failed run.
        let _ = std::fs::remove_file(copy);
    }
    let (name, at, notes) = added?;
    verbosity.notes(&notes);
    let place = at.map_or_else(String::new, |at| {
        let words: Vec<String> = at.iter().map(|v| format!("{v}")).collect();
        format!(" at {}", words.join(", "))
    });
    verbosity.note(&format!("added pose '{name}'{place} to {}", file.display()));
    Ok(())
}

/// Writes the scene with the new pose: its name, its place, what there is to say.
fn added(
    scene: &Scene,
    document: &mut DocumentMut,
    arguments: &Arguments,
    source: &str,
) -> anyhow::Result<(String, Option<Vec<f64>>, Vec<Note>)> {
    let file = &arguments.scene;
    let stem = arguments
        .drawing
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    let stem = stem.unwrap_or_default();
    let taken = scene.names();
    let numbered = (2..).map(|number| format!("{stem}-{number}"));
    let name = std::iter::once(stem.clone())
        .chain(numbered)
        .find(|name| !taken.contains(name));
    let name = name.unwrap_or(stem);
    // Poses without places are laid out by the drawings, all of them.
    let has_places = first_pose(document).is_some_and(|pose| pose.contains_key("at"));
    let at = arguments.at.as_ref().map(|Numbers(at)| at.clone());
    if at.is_some() && !has_places {
        bail!(
            "{}: the poses of this scene have no places of their own; leave out --at, or give each pose one",
            file.display()
        );
    }
    // Until its place is known it is beside all others.
    let beside = || {
        let mut place = scene.poses[0].at.clone();
        let furthest = scene
            .poses
            .iter()
            .flat_map(|pose| &pose.at)
            .fold(0.0_f64, |most, v| most.max(v.abs()));
        place.fill(2.0 * furthest + 1.0);
        place
    };
    push_pose(
        document,
        &name,
        source,
        has_places.then(|| at.clone().unwrap_or_else(beside)),
    )?;
    let grown = Scene::parse(&document.to_string(), file)?;
    let newcomer = grown.newcomer(grown.poses.len() - 1)?;
    for (landmark, place) in &newcomer.landmarks {
        set_place(document, landmark, &name, point(*place));
    }
    for (path, places) in &newcomer.paths {
        set_place(
            document,
            path,
            &name,
            Value::Array(places.iter().map(|p| point(*p)).collect()),
        );
    }
    let at = has_places.then(|| at.unwrap_or(newcomer.at));
    if let (Some(at), Some(pose)) = (&at, tables(document, "pose").pop()) {
        pose.insert("at", Item::Value(Value::Array(at.iter().copied().collect())));
    }
    let text = document.to_string();
    // What would not open again is not written.
    Scene::parse(&text, file)?;
    PendingFile::write_whole(file, text.as_bytes())?;
    Ok((name, at, newcomer.notes))
}

/// The drawing's path in the scene's folder, to which it is copied if it lies elsewhere, and the copy.
fn brought(drawing: &Path, scene: &Path) -> anyhow::Result<(String, Option<PathBuf>)> {
    let folder = match scene.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = folder
        .canonicalize()
        .with_context(|| format!("cannot open {}", folder.display()))?;
    let whole = drawing
        .canonicalize()
        .with_context(|| format!("cannot open the drawing {}", drawing.display()))?;
    if let Ok(inside) = whole.strip_prefix(&folder) {
        let words: Vec<_> = inside
            .components()
            .map(|word| word.as_os_str().to_string_lossy())
            .collect();
        return Ok((words.join("/"), None));
    }
    let name = drawing.file_name().and_then(|name| name.to_str());
    let name = name.with_context(|| format!("{} is no readable file name", drawing.display()))?;
    let target = folder.join(name);
    if target.exists() {
        bail!(
            "{} would overwrite {}; rename the drawing",
            drawing.display(),
            target.display()
        );
    }
    let bytes = std::fs::read(&whole).with_context(|| format!("cannot read the drawing {}", drawing.display()))?;
    PendingFile::write_whole(&target, &bytes)?;
    Ok((name.to_owned(), Some(target)))
}

fn push_pose(document: &mut DocumentMut, name: &str, source: &str, at: Option<Vec<f64>>) -> anyhow::Result<()> {
    let mut pose = Table::new();
    pose.insert("name", name.into());
    pose.insert("source", source.into());
    if let Some(at) = at {
        pose.insert("at", Item::Value(Value::Array(at.into_iter().collect())));
    }
    match document.get_mut("pose") {
        Some(Item::ArrayOfTables(poses)) => poses.push(pose),
        Some(Item::Value(Value::Array(poses))) => poses.push(pose.into_inline_table()),
        _ => bail!("the scene has no list of [[pose]] tables"),
    }
    Ok(())
}

fn first_pose(document: &DocumentMut) -> Option<&dyn TableLike> {
    match document.get("pose")? {
        Item::ArrayOfTables(poses) => poses.iter().next().map(|pose| pose as &dyn TableLike),
        Item::Value(Value::Array(poses)) => poses
            .iter()
            .next()?
            .as_inline_table()
            .map(|pose| pose as &dyn TableLike),
        _ => None,
    }
}

/// Writes where a landmark lies on a pose.
fn set_place(document: &mut DocumentMut, landmark: &str, pose: &str, place: Value) {
    let table = tables(document, "landmark")
        .into_iter()
        .find(|table| name_of(&**table) == Some(landmark));
    let places = table
        .and_then(|table| table.get_mut("at"))
        .and_then(Item::as_table_like_mut);
    if let Some(places) = places {
        places.insert(pose, Item::Value(place));
    }
}

/// A point, to five digits: finer than a hand draws, whatever the unit.
fn point(place: Point) -> Value {
    let size = place.x.abs().max(place.y.abs()).max(f64::MIN_POSITIVE);
    let decimals = 10f64.powf((4.0 - size.log10().floor()).clamp(0.0, 12.0));
    let rounded = |v: f64| (v * decimals).round() / decimals + 0.0;
    Value::Array(Array::from_iter([rounded(place.x), rounded(place.y)]))
}
