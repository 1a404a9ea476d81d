//! `inbetween new`.

mod layered;
mod natural_order;
mod part_names;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context as _, bail};
use inbetween::export::PendingFile;
use inbetween::input::layered::{LayeredFile, LayeredKind};
use inbetween::input::{BitmapOptions, InputError, Picture, PictureChoice, find_cells, frame_count, read_bitmap};
use inbetween::pipeline::{Build, PipelineError};
use inbetween::scene::{NewElement, NewPose, Scene, scene_text};
use inbetween::weights::arrange;

use super::values::Grid;
use super::{Failure, Verbosity};
use layered::{LayerMeaning, Source};
use natural_order::natural_key;

/// The kinds of drawings without layers, by suffix.
const SUFFIXES: [&str; 10] = ["png", "apng", "jpg", "jpeg", "webp", "gif", "bmp", "tif", "tiff", "svg"];

/// Write a scene file for some drawings
///
/// Writes DIR/scene.toml with one pose a drawing, named after its file. The drawings are mapped onto one another to lay the poses
/// out: those that are alike come near one another. They are taken in the order of the numbers in their names; an animated GIF, APNG or
/// WebP gives a pose a frame, a sheet one a cell (--cells; where one drawing is given with a figure in each of four or more equal cells, they are found). Layered
/// files give poses with parts, which become layers of the scene: groups, files or frames are poses, as is said when it is done, and --layers says it otherwise. If they cannot be mapped, the scene is written with
/// its poses evenly on a circle, so that it can be mended there, and the command fails as a render would. What was taken for the figure is said for every drawing; one that cannot be used is refused. Drawings that are not in
/// DIR are copied into it, so that the folder is complete. An existing scene file is only overwritten with --force.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  inbetween new cat stand.png run.png jump.png\n  inbetween render cat/scene.toml -o cat.gif"
)]
pub(crate) struct Arguments {
    /// The folder of the scene; made if it does not exist
    pub(super) dir: PathBuf,
    /// The drawings: PNG, JPEG, WebP, GIF, BMP, TIFF, SVG or layered files
    #[arg(required = true, value_name = "POSE")]
    pub(super) poses: Vec<PathBuf>,
    /// Sheets: how many columns and rows of cells each drawing has, such as 4x2; a pose for every cell that is not empty
    #[arg(long, value_name = "COLSxROWS")]
    pub(super) cells: Option<Grid>,
    /// Layered files: what groups and layers are; without it, it is found
    #[arg(long, value_enum, value_name = "MEANING", conflicts_with = "cells")]
    pub(super) layers: Option<LayerMeaning>,
    /// Write over the scene file and the drawings of an earlier run
    #[arg(long)]
    pub(super) force: bool,
}

/// A drawing that has to be copied, and where to.
pub(super) struct Copy {
    pub(super) original: PathBuf,
    pub(super) bytes: Arc<Vec<u8>>,
    pub(super) target: PathBuf,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let scene_file = arguments.dir.join("scene.toml");
    let is_new = !arguments.dir.exists();
    // Everything is checked before anything is written.
    if scene_file.exists() && !arguments.force {
        return Err(anyhow::anyhow!(
            "{} exists; write over it with --force, remove it first or choose another folder",
            scene_file.display()
        )
        .into());
    }
    let Plan {
        layers,
        mut poses,
        copies,
        notes,
    } = plan(arguments)?;
    verbosity.notes(&notes);
    std::fs::create_dir_all(&arguments.dir)
        .with_context(|| format!("cannot make the folder {}", arguments.dir.display()))?;
    let replaced: Vec<bool> = copies.iter().map(|copy| copy.target.exists()).collect();
    let written = write(&copies, &scene_file, &layers, &mut poses, verbosity);
    if written.is_err() {
        for (copy, _) in copies.iter().zip(replaced).filter(|(_, replaced)| !replaced) {
            let _ = std::fs::remove_file(&copy.target);
        }
        if is_new {
            let _ = std::fs::remove_dir(&arguments.dir);
        }
    }
    if let Some(refusal) = written? {
        let file = scene_file.display();
        return Err(anyhow::Error::from(refusal)
            .context(format!(
                "wrote {file}, but its drawings cannot be mapped; mend the scene, or the drawings, and repeat this with --force"
            ))
            .into());
    }
    verbosity.note(&format!(
        "wrote {} with {} poses; next: inbetween render {0} -o {}.gif",
        scene_file.display(),
        poses.len(),
        arguments
            .dir
            .file_name()
            .map_or_else(|| "character".into(), |n| n.to_string_lossy()),
    ));
    Ok(())
}

/// What a scene is made of, before anything is written.
pub(super) struct Plan {
    /// From back to front; none if the drawings are whole.
    pub(super) layers: Vec<String>,
    pub(super) poses: Vec<NewPose>,
    pub(super) copies: Vec<Copy>,
    /// What is left out of animated files and sheets, and what layers were taken for.
    pub(super) notes: Vec<String>,
}

/// Whether a file is a drawing, by its name.
pub(super) fn is_drawing(path: &Path) -> bool {
    let suffix = suffix(path);
    SUFFIXES.contains(&suffix.as_str()) || LayeredKind::SUFFIXES.contains(&suffix.as_str())
}

fn suffix(path: &Path) -> String {
    let suffix = path.extension().map(|s| s.to_string_lossy().to_lowercase());
    suffix.unwrap_or_default()
}

/// A drawing that is given.
struct Given {
    path: PathBuf,
    /// As the scene names it.
    source: String,
    bytes: Arc<Vec<u8>>,
}

pub(super) fn plan(arguments: &Arguments) -> anyhow::Result<Plan> {
    let (given, copies) = read_given(arguments)?;
    let is_layered = |given: &Given| LayeredKind::of(&given.bytes).is_some();
    let mut notes: Vec<String> = Vec::new();
    // Together with pictures, which have no parts, each layered file is a picture.
    if given.iter().all(is_layered) && arguments.cells.is_none() {
        let sources = given.iter().map(|given| {
            let opened = LayeredFile::open(&given.bytes);
            Ok(Source {
                path: &given.path,
                source: given.source.clone(),
                file: opened.with_context(|| format!("cannot use the drawing {}", given.path.display()))?,
            })
        });
        let sources = sources.collect::<anyhow::Result<Vec<Source<'_>>>>()?;
        let found = layered::poses_of(&sources, arguments.layers)?;
        return Ok(Plan {
            layers: found.layers,
            poses: found.poses,
            copies,
            notes: found.notes,
        });
    }
    if arguments.layers.is_some() {
        bail!(
            "--layers says what the layers of files mean, but not all drawings that are given have layers; leave it out"
        );
    }
    let mut poses: Vec<NewPose> = Vec::new();
    for drawing in &given {
        let (path, source) = (&drawing.path, &drawing.source);
        let stem = path
            .file_stem()
            .map(|s| s.to_string_lossy().into_owned())
            .unwrap_or_default();
        let cells = match arguments.cells {
            Some(grid) => Some(grid),
            None if given.len() == 1 => sheet_of(drawing, &mut notes),
            None => None,
        };
        let pictures = pictures_of(drawing, cells, &mut notes)?;
        for (number, &picture) in pictures.iter().enumerate() {
            let own = match pictures.len() {
                1 => stem.clone(),
                _ => format!("{stem}-{}", number + 1),
            };
            let taken: Vec<String> = poses.iter().map(|pose| pose.name.clone()).collect();
            poses.push(NewPose {
                name: part_names::free_name(&own, &taken),
                source: source.clone(),
                picture,
                element: NewElement::Whole,
                at: None,
            });
        }
    }
    Ok(Plan {
        layers: Vec::new(),
        poses,
        copies,
        notes,
    })
}

/// The drawings that are given, in the order of the numbers in their names, and those that have to be copied.
fn read_given(arguments: &Arguments) -> anyhow::Result<(Vec<Given>, Vec<Copy>)> {
    let folder = arguments.dir.canonicalize().ok();
    let mut given: Vec<Given> = Vec::new();
    let mut copies: Vec<Copy> = Vec::new();
    let mut paths: Vec<&PathBuf> = arguments.poses.iter().collect();
    paths.sort_by_cached_key(|path| natural_key(path));
    for path in paths {
        if !is_drawing(path) {
            bail!(
                "{} is no drawing; give files that end in {}",
                path.display(),
                [&SUFFIXES[..], &LayeredKind::SUFFIXES].concat().join(", ")
            );
        }
        let whole = path
            .canonicalize()
            .with_context(|| format!("cannot open the drawing {}", path.display()))?;
        let bytes = std::fs::read(path).with_context(|| format!("cannot read the drawing {}", path.display()))?;
        let bytes = Arc::new(bytes);
        let inside = folder.as_ref().and_then(|folder| whole.strip_prefix(folder).ok());
        let source = match inside {
            Some(relative) => portable(relative),
            None => {
                let name = file_name(path)?;
                let target = arguments.dir.join(&name);
                if target.exists() && !arguments.force || copies.iter().any(|copy| copy.target == target) {
                    bail!(
                        "{} would overwrite {}; rename one of the drawings",
                        path.display(),
                        target.display()
                    );
                }
                copies.push(Copy {
                    original: whole,
                    bytes: Arc::clone(&bytes),
                    target,
                });
                name
            }
        };
        if given.iter().any(|given| given.source == source) {
            bail!("{} is given twice; give every drawing once", path.display());
        }
        given.push(Given {
            path: path.clone(),
            source,
            bytes,
        });
    }
    Ok((given, copies))
}

/// The cells of the only drawing that is given, if it shows a figure in each: one drawing of one figure needs no scene. Animated files have their frames.
fn sheet_of(drawing: &Given, notes: &mut Vec<String>) -> Option<Grid> {
    // A file that cannot be read is refused with its cause when it is read.
    if frame_count(&drawing.bytes).unwrap_or(0) != 1 {
        return None;
    }
    let Ok(Some([columns, rows])) = find_cells(&drawing.bytes) else {
        return None;
    };
    notes.push(format!(
        "{} is taken for a sheet of {columns} x {rows} figures, a pose each; if it has other cells, say so with --cells, and with --cells 1x1 \
         if it is one figure",
        drawing.path.display()
    ));
    Some(Grid([columns, rows]))
}

/// What of a drawing's file are poses: the frames of an animated one, the cells of a sheet, row by row; those in which nothing is drawn,
/// or what an earlier one has, are left out and told of.
fn pictures_of(drawing: &Given, cells: Option<Grid>, notes: &mut Vec<String>) -> anyhow::Result<Vec<PictureChoice>> {
    let Given { path, bytes, .. } = drawing;
    if suffix(path) == "svg" {
        return match cells {
            None => Ok(vec![PictureChoice::Only]),
            Some(_) => bail!("{}: an SVG file has no cells; leave out --cells", path.display()),
        };
    }
    let (choices, what): (Vec<PictureChoice>, &str) = match cells {
        Some(Grid(of)) => {
            let [columns, rows] = of;
            let at = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
            (at.map(|at| PictureChoice::Cell { at, of }).collect(), "cells")
        }
        // A file that cannot be read is refused with its cause when it is read.
        None => match frame_count(bytes) {
            Ok(count) if count > 1 => ((0..count).map(PictureChoice::Frame).collect(), "frames"),
            _ => return Ok(vec![PictureChoice::Only]),
        },
    };
    let (mut found, mut seen): (Vec<PictureChoice>, Vec<Picture>) = (Vec::new(), Vec::new());
    let (mut empty, mut repeated) = (0, 0);
    for &picture in &choices {
        let mut options = BitmapOptions::default();
        options.picture = picture;
        match read_bitmap(bytes, &options) {
            Err(InputError::NothingDrawn { .. }) => empty += 1,
            Ok(drawing) if seen.contains(&drawing.picture) => repeated += 1,
            Ok(drawing) => {
                seen.push(drawing.picture);
                found.push(picture);
            }
            // It is refused, with its pose, when the scene is read.
            Err(_) => found.push(picture),
        }
    }
    if found.is_empty() {
        bail!(
            "{}: nothing is drawn in any of its {} {what}",
            path.display(),
            choices.len()
        );
    }
    if empty + repeated > 0 {
        notes.push(format!(
            "{}: {} of {} {what} are poses; {empty} are empty, {repeated} repeat an earlier one",
            path.display(),
            found.len(),
            choices.len()
        ));
    }
    Ok(found)
}

/// Writes the drawings and the scene; returns why they cannot be mapped, if they cannot.
fn write(
    copies: &[Copy],
    scene_file: &Path,
    layers: &[String],
    poses: &mut [NewPose],
    verbosity: Verbosity,
) -> anyhow::Result<Option<PipelineError>> {
    for copy in copies {
        PendingFile::write_whole(&copy.target, &copy.bytes)
            .with_context(|| format!("cannot copy the drawing {}", copy.original.display()))?;
    }
    let scene = Scene::parse(&scene_text(layers, poses), scene_file)?;
    let (places, refusal) = match Build::new(&scene.spec()?) {
        Ok(build) => {
            verbosity.notes(build.notes());
            (build.places().to_vec(), None)
        }
        Err(refusal) => (even_circle(poses.len()), Some(refusal)),
    };
    for (pose, place) in poses.iter_mut().zip(places) {
        pose.at = place.first_chunk().copied();
    }
    PendingFile::write_whole(scene_file, scene_text(layers, poses).as_bytes())?;
    Ok(refusal)
}

/// Places in order around a circle: as if each drawing were one step from the next, and the last from the first.
fn even_circle(count: usize) -> Vec<Vec<f64>> {
    let steps = |a: usize, b: usize| a.abs_diff(b).min(count - a.abs_diff(b)) as f64;
    let distances: Vec<Vec<f64>> = (0..count).map(|a| (0..count).map(|b| steps(a, b)).collect()).collect();
    arrange(&distances).into_iter().map(Vec::from).collect()
}

fn file_name(path: &Path) -> anyhow::Result<String> {
    let name = path.file_name().and_then(|n| n.to_str());
    Ok(name
        .with_context(|| format!("{} is no readable file name", path.display()))?
        .to_owned())
}

/// The path with slashes, on every system.
fn portable(path: &Path) -> String {
    let words: Vec<_> = path.components().map(|c| c.as_os_str().to_string_lossy()).collect();
    words.join("/")
}
