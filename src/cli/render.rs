//! `inbetween render`.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use inbetween::export::{ApngWriter, Backdrop, GifWriter, Palette, PendingFile, Repetition, Sequence};
use inbetween::pipeline::{Character, laid_out};
use inbetween::scene::{Animation, Background, Scene};
use rayon::prelude::*;

use super::progress::Progress;
use super::values::{FrameNumbers, Grid, frame_rate, thread_count};
use super::{Failure, Verbosity, frames};

/// How many frames, spread over the animation, the colours of a GIF are chosen from.
const PALETTE_FRAMES: usize = 8;

/// Render the animation of a scene
///
/// The kind of output is taken from OUT's name: a folder gets numbered PNG files NAME.0001.png, a name ending in .gif
/// or .apng that one file. Any subset of frames has the same bytes as in a whole run, for any number of threads.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween render walker/scene.toml -o walker.gif
  inbetween render walker/scene.toml -o frames --size 1920x1080 --fps 30
  inbetween render walker/scene.toml -o frames --frames 101-200 --threads 8 --resume   one share of a render farm")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// A folder, or a file ending in .gif or .apng
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// The kind of output, where the name does not say: png (a folder), gif or apng
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Only these frames, counted from 1, such as 1-10,20
    #[arg(long, value_name = "LIST")]
    frames: Option<FrameNumbers>,
    /// Columns and rows, such as 1920x1080; the scene's otherwise
    #[arg(long, value_name = "WxH")]
    size: Option<Grid>,
    /// Frames a second; the scene's otherwise
    #[arg(long, value_parser = frame_rate)]
    fps: Option<f64>,
    /// How many threads; as many as there are cores otherwise
    #[arg(long, value_name = "N", value_parser = thread_count)]
    threads: Option<usize>,
    /// Leave out frames whose file is already there (folders only)
    #[arg(long)]
    resume: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Sequence,
    Gif,
    Apng,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let format = format(&arguments.output, arguments.format.as_deref()).map_err(Failure::Usage)?;
    if arguments.resume && format != Format::Sequence {
        return Err(Failure::Usage(
            "--resume works with a folder of PNG files only; a single file is written whole".to_owned(),
        ));
    }
    let scene = Scene::open(&arguments.scene)?;
    let file = scene.file.display().to_string();
    let scene = laid_out(scene).context(file)?;
    let mut animation = scene.animation.clone();
    if let Some(fps) = arguments.fps {
        animation.fps = fps;
    }
    if let Some(Grid([columns, rows])) = arguments.size {
        animation.size = [columns as u32, rows as u32];
    }
    let count = animation.frame_count();
    let numbers = match &arguments.frames {
        Some(frames) => frames.within(count).map_err(Failure::Usage)?,
        None => (1..=count).collect(),
    };
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = arguments.threads {
        pool = pool.num_threads(threads);
    }
    let pool = pool.build().context("cannot start the threads")?;
    pool.install(|| match format {
        Format::Sequence => sequence(arguments, &scene, &animation, numbers, verbosity),
        Format::Gif => gif(arguments, &scene, &animation, &numbers, verbosity),
        Format::Apng => apng(arguments, &scene, &animation, &numbers, verbosity),
    })?;
    Ok(())
}

fn format(output: &Path, named: Option<&str>) -> Result<Format, String> {
    let suffix = output.extension().map(|s| s.to_string_lossy().to_lowercase());
    let is_folder = output.is_dir() || output.to_string_lossy().ends_with('/');
    let what_works = "a folder (PNG files), .gif or .apng; --format png, gif or apng where the name does not say";
    match (named, suffix.as_deref()) {
        (Some("png"), _) => Ok(Format::Sequence),
        (Some("gif"), _) => Ok(Format::Gif),
        (Some("apng"), _) => Ok(Format::Apng),
        (Some(other), _) => Err(format!("format '{other}' is not supported yet; choose {what_works}")),
        (None, _) if is_folder => Ok(Format::Sequence),
        (None, None) => Ok(Format::Sequence),
        (None, Some("gif")) => Ok(Format::Gif),
        (None, Some("apng")) => Ok(Format::Apng),
        (None, Some(other)) => Err(format!(
            "{}: output ending in .{other} is not supported{}; choose {what_works}",
            output.display(),
            if other == "png" {
                " by render (one picture: `inbetween frame`)"
            } else {
                " yet"
            }
        )),
    }
}

fn character(scene: &Scene, animation: &Animation, verbosity: Verbosity) -> anyhow::Result<Character> {
    let character = Character::new(scene, animation.size.map(|side| side as usize))
        .with_context(|| scene.file.display().to_string())?;
    for note in character.notes() {
        verbosity.note(&format!("note: {note}"));
    }
    Ok(character)
}

fn sequence(
    arguments: &Arguments,
    scene: &Scene,
    animation: &Animation,
    mut numbers: Vec<usize>,
    verbosity: Verbosity,
) -> anyhow::Result<()> {
    let sequence = Sequence::create(&arguments.output, &scene.short_name())?;
    if arguments.resume {
        let before = numbers.len();
        numbers.retain(|number| !sequence.path(*number).is_file());
        verbosity.note(&format!(
            "{} of {before} frames are already there",
            before - numbers.len()
        ));
        if numbers.is_empty() {
            return Ok(());
        }
    }
    let character = character(scene, animation, verbosity)?;
    let progress = Progress::new(numbers.len(), verbosity);
    numbers.par_iter().try_for_each(|number| -> anyhow::Result<()> {
        let frame = character.frame(animation, number - 1)?;
        sequence.write(*number, &frame)?;
        progress.advance();
        Ok(())
    })?;
    progress.finish();
    frames::tell_inverted(&character, animation, &numbers, verbosity)?;
    Ok(())
}

fn repetition(animation: &Animation) -> Repetition {
    if animation.is_loop() {
        Repetition::Forever
    } else {
        Repetition::Once
    }
}

fn gif(
    arguments: &Arguments,
    scene: &Scene,
    animation: &Animation,
    numbers: &[usize],
    verbosity: Verbosity,
) -> anyhow::Result<()> {
    let file = PendingFile::create(&arguments.output)?;
    let character = character(scene, animation, verbosity)?;
    let progress = Progress::new(numbers.len(), verbosity);
    // From the whole animation, whichever frames are asked for: their pixels must not depend on that.
    let count = animation.frame_count();
    let looked_at: Vec<usize> = (0..PALETTE_FRAMES.min(count))
        .map(|k| 1 + k * count / PALETTE_FRAMES.min(count))
        .collect();
    let palette = Palette::for_frames(&frames::batch_of(&character, animation, &looked_at)?);
    let backdrop = match scene.animation.background {
        Background::Colour([_, _, _, 255]) => Backdrop::Opaque,
        _ => Backdrop::Clear,
    };
    let size = animation.size.map(|side| side as usize);
    let mut writer = GifWriter::new(file, size, animation.fps, palette, backdrop, repetition(animation))?;
    frames::in_order(
        &character,
        animation,
        numbers,
        &progress,
        |frame| Ok(writer.add(frame)?),
    )?;
    writer.finish()?;
    progress.finish();
    frames::tell_inverted(&character, animation, numbers, verbosity)?;
    Ok(())
}

fn apng(
    arguments: &Arguments,
    scene: &Scene,
    animation: &Animation,
    numbers: &[usize],
    verbosity: Verbosity,
) -> anyhow::Result<()> {
    let file = PendingFile::create(&arguments.output)?;
    let character = character(scene, animation, verbosity)?;
    let progress = Progress::new(numbers.len(), verbosity);
    let size = animation.size.map(|side| side as usize);
    let mut writer = ApngWriter::new(file, size, animation.fps, numbers.len(), repetition(animation))?;
    frames::in_order(
        &character,
        animation,
        numbers,
        &progress,
        |frame| Ok(writer.add(frame)?),
    )?;
    writer.finish()?;
    progress.finish();
    frames::tell_inverted(&character, animation, numbers, verbosity)?;
    Ok(())
}
