//! `inbetween new`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use inbetween::export::PendingFile;
use inbetween::input::{BitmapOptions, InputError, Picture, PictureChoice, find_cells, frame_count, read_bitmap};
use inbetween::pipeline::{Build, PipelineError};
use inbetween::scene::{NewPose, Scene, scene_text};
use inbetween::weights::arrange;

use super::values::Grid;
use super::{Failure, Verbosity};

/// The kinds of drawings, by suffix.
const SUFFIXES: [&str; 10] = ["png", "apng", "jpg", "jpeg", "webp", "gif", "bmp", "tif", "tiff", "svg"];

/// Write a scene file for some drawings
///
/// Writes DIR/scene.toml with one pose a drawing, named after its file. The drawings are mapped onto one another to lay the poses
/// out: those that are alike come near one another. They are taken in the order of the numbers in their names; an animated GIF, APNG or
/// WebP gives a pose a frame, a sheet one a cell (--cells; where one drawing is given with a figure in each of four or more equal cells, they are found). If they cannot be mapped, the scene is written with
/// its poses evenly on a circle, so that it can be mended there, and the command fails as a render would. What was taken for the figure is said for every drawing; one that cannot be used is refused. Drawings that are not in
/// DIR are copied into it, so that the folder is complete. An existing scene file is only overwritten with --force.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  inbetween new cat stand.png run.png jump.png\n  inbetween render cat/scene.toml -o cat.gif"
)]
pub(crate) struct Arguments {
    /// The folder of the scene; made if it does not exist
    pub(super) dir: PathBuf,
    /// The drawings: PNG, JPEG, WebP, GIF, BMP, TIFF or SVG
    #[arg(required = true, value_name = "POSE")]
    pub(super) poses: Vec<PathBuf>,
    /// Sheets: how many columns and rows of cells each drawing has, such as 4x2; a pose for every cell that is not empty
    #[arg(long, value_name = "COLSxROWS")]
    pub(super) cells: Option<Grid>,
    /// Write over the scene file and the drawings of an earlier run
    #[arg(long)]
    pub(super) force: bool,
}

/// A drawing that has to be copied, and where to.
pub(super) struct Copy {
    pub(super) original: PathBuf,
    pub(super) bytes: Vec<u8>,
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
        mut poses,
        copies,
        notes,
    } = plan(arguments)?;
    verbosity.notes(&notes);
    std::fs::create_dir_all(&arguments.dir)
        .with_context(|| format!("cannot make the folder {}", arguments.dir.display()))?;
    let replaced: Vec<bool> = copies.iter().map(|copy| copy.target.exists()).collect();
    let written = write(&copies, &scene_file, &mut poses, verbosity);
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
    pub(super) poses: Vec<NewPose>,
    pub(super) copies: Vec<Copy>,
    /// What is left out of animated files and sheets.
    pub(super) notes: Vec<String>,
}

/// Whether a file is a drawing, by its name.
pub(super) fn is_drawing(path: &Path) -> bool {
    SUFFIXES.contains(&suffix(path).as_str())
}

fn suffix(path: &Path) -> String {
    let suffix = path.extension().map(|s| s.to_string_lossy().to_lowercase());
    suffix.unwrap_or_default()
}

pub(super) fn plan(arguments: &Arguments) -> anyhow::Result<Plan> {
    let folder = arguments.dir.canonicalize().ok();
    let mut poses: Vec<NewPose> = Vec::new();
    let mut copies: Vec<Copy> = Vec::new();
    let mut notes: Vec<String> = Vec::new();
    let mut paths: Vec<&PathBuf> = arguments.poses.iter().collect();
    paths.sort_by_cached_key(|path| natural_key(path));
    for path in paths {
        if !is_drawing(path) {
            bail!(
                "{} is no drawing; give files that end in {}",
                path.display(),
                SUFFIXES.join(", ")
            );
        }
        let whole = path
            .canonicalize()
            .with_context(|| format!("cannot open the drawing {}", path.display()))?;
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
                    bytes: std::fs::read(path)
                        .with_context(|| format!("cannot read the drawing {}", path.display()))?,
                    target,
                });
                name
            }
        };
        if poses.iter().any(|pose: &NewPose| pose.source == source) {
            bail!("{} is given twice; give every drawing once", path.display());
        }
        let stem = path
            .file_stem()
            .map(|s| s.to_string_lossy().into_owned())
            .unwrap_or_default();
        let cells = match arguments.cells {
            Some(grid) => Some(grid),
            None if arguments.poses.len() == 1 => sheet_of(path, &mut notes)?,
            None => None,
        };
        let pictures = pictures_of(path, cells, &mut notes)?;
        for (number, &picture) in pictures.iter().enumerate() {
            let own = match pictures.len() {
                1 => stem.clone(),
                _ => format!("{stem}-{}", number + 1),
            };
            let mut name = own.clone();
            let mut further = 2;
            while poses.iter().any(|pose| pose.name == name) {
                name = format!("{own}-{further}");
                further += 1;
            }
            let source = source.clone();
            poses.push(NewPose {
                name,
                source,
                picture,
                at: None,
            });
        }
    }
    Ok(Plan { poses, copies, notes })
}

/// The cells of the only drawing that is given, if it shows a figure in each: one drawing of one figure needs no scene. Animated files have their frames.
fn sheet_of(path: &Path, notes: &mut Vec<String>) -> anyhow::Result<Option<Grid>> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read the drawing {}", path.display()))?;
    // A file that cannot be read is refused with its cause when it is read.
    if frame_count(&bytes).unwrap_or(0) != 1 {
        return Ok(None);
    }
    let Ok(Some([columns, rows])) = find_cells(&bytes) else {
        return Ok(None);
    };
    notes.push(format!(
        "{} is taken for a sheet of {columns} x {rows} figures, a pose each; if it has other cells, say so with --cells, and with --cells 1x1 \
         if it is one figure",
        path.display()
    ));
    Ok(Some(Grid([columns, rows])))
}

/// What of a drawing's file are poses: the frames of an animated one, the cells of a sheet, row by row; those in which nothing is drawn,
/// or what an earlier one has, are left out and told of.
fn pictures_of(path: &Path, cells: Option<Grid>, notes: &mut Vec<String>) -> anyhow::Result<Vec<PictureChoice>> {
    if suffix(path) == "svg" {
        return match cells {
            None => Ok(vec![PictureChoice::Only]),
            Some(_) => bail!("{}: an SVG file has no cells; leave out --cells", path.display()),
        };
    }
    let bytes = std::fs::read(path).with_context(|| format!("cannot read the drawing {}", path.display()))?;
    let (choices, what): (Vec<PictureChoice>, &str) = match cells {
        Some(Grid(of)) => {
            let [columns, rows] = of;
            let at = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
            (at.map(|at| PictureChoice::Cell { at, of }).collect(), "cells")
        }
        // A file that cannot be read is refused with its cause when it is read.
        None => match frame_count(&bytes) {
            Ok(count) if count > 1 => ((0..count).map(PictureChoice::Frame).collect(), "frames"),
            _ => return Ok(vec![PictureChoice::Only]),
        },
    };
    let (mut found, mut seen): (Vec<PictureChoice>, Vec<Picture>) = (Vec::new(), Vec::new());
    let (mut empty, mut repeated) = (0, 0);
    for &picture in &choices {
        let mut options = BitmapOptions::default();
        options.picture = picture;
        match read_bitmap(&bytes, &options) {
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
    poses: &mut [NewPose],
    verbosity: Verbosity,
) -> anyhow::Result<Option<PipelineError>> {
    for copy in copies {
        PendingFile::write_whole(&copy.target, &copy.bytes)
            .with_context(|| format!("cannot copy the drawing {}", copy.original.display()))?;
    }
    let scene = Scene::parse(&scene_text(poses), scene_file)?;
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
    PendingFile::write_whole(scene_file, scene_text(poses).as_bytes())?;
    Ok(refusal)
}

/// A piece of a file's name by which names are sorted: numbers as numbers, so that walk2 comes before walk10.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum NamePiece {
    /// A number, by its digits without leading zeros: longer ones are larger.
    Number(usize, String),
    /// Letters, capital or not.
    Word(String),
}

/// By what drawings are sorted: the pieces of their file's name, then all of the path, so that no two are alike.
fn natural_key(path: &Path) -> (Vec<NamePiece>, PathBuf) {
    let stem = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    let letters: Vec<char> = stem.chars().collect();
    let pieces = letters
        .chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit())
        .map(|piece| {
            let word: String = piece.iter().collect();
            if word.starts_with(|c: char| c.is_ascii_digit()) {
                let digits = word.trim_start_matches('0').to_owned();
                NamePiece::Number(digits.len(), digits)
            } else {
                NamePiece::Word(word)
            }
        })
        .collect();
    (pieces, path.to_owned())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_sorted_by_their_numbers() {
        let shell = [
            "walk1.png",
            "walk10.png",
            "walk2.png",
            "Walk03.png",
            "b/walk2.svg",
            "idle.png",
        ];
        let mut paths: Vec<PathBuf> = shell.iter().map(PathBuf::from).collect();
        paths.sort_by_cached_key(|path| natural_key(path));
        let sorted: Vec<&str> = paths.iter().filter_map(|path| path.to_str()).collect();
        assert_eq!(
            sorted,
            [
                "idle.png",
                "walk1.png",
                "b/walk2.svg",
                "walk2.png",
                "Walk03.png",
                "walk10.png"
            ]
        );
    }
}
