//! `inbetween new`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use inbetween::export::PendingFile;
use inbetween::pipeline::{automatic_places, map_layer};
use inbetween::scene::{NewPose, Scene, scene_text};
use inbetween::weights::arrange;

use super::{Failure, Verbosity};

/// The kinds of drawings, by suffix.
const SUFFIXES: [&str; 7] = ["png", "jpg", "jpeg", "webp", "gif", "bmp", "svg"];

/// Write a scene file for some drawings
///
/// Writes DIR/scene.toml with one pose a drawing, named after its file. The drawings are mapped onto one another to lay the poses
/// out: those that are alike come near one another. They are taken in the order of the numbers in their names. If they cannot be mapped, the poses lie evenly on a circle and
/// a note says why. What was taken for the figure is said for every drawing; one that cannot be used is refused. Drawings that are not in
/// DIR are copied into it, so that the folder is complete. An existing scene file is only overwritten with --force.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  inbetween new cat stand.png run.png jump.png\n  inbetween render cat/scene.toml -o cat.gif"
)]
pub(crate) struct Arguments {
    /// The folder of the scene; made if it does not exist
    dir: PathBuf,
    /// The drawings: PNG, JPEG, WebP, GIF, BMP or SVG
    #[arg(required = true, value_name = "POSE")]
    poses: Vec<PathBuf>,
    /// Write over the scene file and the drawings of an earlier run
    #[arg(long)]
    force: bool,
}

/// A drawing that has to be copied, and where to.
struct Copy {
    bytes: Vec<u8>,
    target: PathBuf,
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
    let (mut poses, copies) = plan(arguments)?;
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
    written?;
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

fn plan(arguments: &Arguments) -> anyhow::Result<(Vec<NewPose>, Vec<Copy>)> {
    let folder = arguments.dir.canonicalize().ok();
    let mut poses: Vec<NewPose> = Vec::new();
    let mut copies: Vec<Copy> = Vec::new();
    let mut paths: Vec<&PathBuf> = arguments.poses.iter().collect();
    paths.sort_by_cached_key(|path| natural_key(path));
    for path in paths {
        let suffix = path
            .extension()
            .map(|s| s.to_string_lossy().to_lowercase())
            .unwrap_or_default();
        if !SUFFIXES.contains(&suffix.as_str()) {
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
                    bytes: std::fs::read(path)
                        .with_context(|| format!("cannot read the drawing {}", path.display()))?,
                    target,
                });
                name
            }
        };
        if poses.iter().any(|pose| pose.source == source) {
            bail!("{} is given twice; give every drawing once", path.display());
        }
        let stem = path
            .file_stem()
            .map(|s| s.to_string_lossy().into_owned())
            .unwrap_or_default();
        let mut name = stem.clone();
        let mut number = 2;
        while poses.iter().any(|pose| pose.name == name) {
            name = format!("{stem}-{number}");
            number += 1;
        }
        poses.push(NewPose { name, source, at: None });
    }
    Ok((poses, copies))
}

fn write(copies: &[Copy], scene_file: &Path, poses: &mut [NewPose], verbosity: Verbosity) -> anyhow::Result<()> {
    for copy in copies {
        PendingFile::write_whole(&copy.target, &copy.bytes)?;
    }
    let scene = Scene::parse(&scene_text(poses), scene_file)?;
    let places = match map_layer(&scene.layer_spec(0)?) {
        Ok((mapping, report)) => {
            for note in &report.notes {
                verbosity.note(&format!("note: {note}"));
            }
            automatic_places(&mapping)
        }
        Err(error) => {
            verbosity.note(&format!(
                "note: the poses are laid out evenly on a circle, because the drawings could not be mapped: {error}"
            ));
            even_circle(poses.len())
        }
    };
    for (pose, place) in poses.iter_mut().zip(places) {
        pose.at = place.first_chunk().copied();
    }
    Ok(PendingFile::write_whole(scene_file, scene_text(poses).as_bytes())?)
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
