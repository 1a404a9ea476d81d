//! `inbetween render`: its arguments, and which file writes which kind of output.

mod apng;
mod certificates;
mod fingerprint;
mod format;
mod gif;
mod job;
mod mesh;
mod sequence;
mod sprites;
mod vector;
mod video;
mod webp;

use std::path::PathBuf;

use anyhow::Context as _;
use inbetween::animation::Background;
use inbetween::pipeline::CameraRule;
use inbetween::scene::Scene;

use self::certificates::Certification;
use self::format::Format;
use self::job::Job;
use super::progress::ProgressKind;
use super::values::{FrameNumbers, Grid, background, camera, frame_rate, pixels, supersample, thread_count};
use super::{Failure, Verbosity};

/// Render the animation of a scene
///
/// The kind of output is taken from OUT's name: a folder gets numbered PNG files NAME.0001.png, a name ending in .gif,
/// .apng, .webp, .svg, .json (Lottie), .glb (glTF), .inb (for players), .mp4 or .webm that one file (the last two need
/// the program ffmpeg). Any subset of frames has the same bytes as in a whole run, for any number of threads. Files appear
/// when they are complete; a run that is killed or fails leaves none that is torn.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween render walker/scene.toml -o walker.gif
  inbetween render walker/scene.toml -o walker.webm --size 1920x1080 --fps 30
  inbetween render walker/scene.toml -o walker.gif --certify   and walker.gif.certificates.jsonl
  inbetween render walker/scene.toml -o walker.png --format sprites --size 240x270 --fps 12
  inbetween render walker/scene.toml -o frames --frames 101-200 --threads 8 --resume   one share of a render farm")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// A folder, or a file whose ending says what it is
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,
    /// The kind of output, where the name does not say: png (a folder), sprites (a .png with a .json beside it), gif,
    /// apng, webp, mp4, webm, svg, svg-sequence (a folder), lottie, glb, spine (a folder, or a .json with its pictures
    /// beside it) or runtime
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
    /// What frames show: fit (all poses and the whole animation) or drawing (the drawings' own canvas); the scene's otherwise
    #[arg(long, value_name = "RULE", value_parser = camera)]
    camera: Option<CameraRule>,
    /// What is behind the character: transparent, white, black, #rrggbb or #rrggbbaa; the scene's otherwise
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    background: Option<Background>,
    /// Final quality: look at K x K points of each pixel, K from 1 to 4
    #[arg(long, value_name = "K", default_value = "1", value_parser = supersample)]
    supersample: usize,
    /// How many threads; as many as there are cores otherwise
    #[arg(long, value_name = "N", value_parser = thread_count)]
    threads: Option<usize>,
    /// Leave out frames whose file is already there, complete, of this scene and these settings (folders only)
    #[arg(long)]
    resume: bool,
    /// Write a certificate of each frame to OUT.certificates.jsonl, a line a frame, and exit with 1 where one does not hold: whether all triangles are positive and the outline
    /// does not cross itself, decided exactly, and the largest distortion beside that of the poses
    #[arg(long)]
    certify: bool,
    /// How progress is told
    #[arg(long, value_name = "KIND", default_value = "auto")]
    progress: ProgressKind,
    /// How far, in pixels, formats with keys may be from the frames (.svg, .json, .glb, spine)
    #[arg(long, value_name = "PX", value_parser = pixels, default_value_t = 0.5)]
    max_error: f64,
}

/// Writes one kind of output.
type Writer = fn(Job<'_>) -> anyhow::Result<()>;

/// What writes a kind of output.
fn writer(format: Format) -> Writer {
    match format {
        Format::Png => sequence::run,
        Format::Gif => gif::run,
        Format::Apng => apng::run,
        Format::WebP => webp::run,
        Format::Sprites => sprites::run,
        Format::Mp4 => video::mp4,
        Format::WebM => video::webm,
        Format::Glb => mesh::glb,
        Format::Spine => mesh::spine,
        Format::Svg => vector::svg,
        Format::SvgSequence => sequence::curves,
        Format::Lottie => vector::lottie,
        Format::Runtime => mesh::runtime,
    }
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let format = Format::of(&arguments.output, arguments.format.as_deref()).map_err(Failure::Usage)?;
    if arguments.resume && !format.is_sequence() {
        return Err(Failure::Usage(
            "--resume works with a folder of files only; a single file is written whole, so render it again".to_owned(),
        ));
    }
    let mut scene = Scene::open(&arguments.scene)?;
    scene.camera = arguments.camera.unwrap_or(scene.camera);
    let mut scene = scene.with_automatic_places()?;
    if let Some(fps) = arguments.fps {
        scene.animation.fps = fps;
    }
    if let Some(Grid([columns, rows])) = arguments.size {
        scene.animation.size = [columns as u32, rows as u32];
    }
    if let Some(background) = arguments.background {
        scene.animation.background = background;
    }
    let count = scene.animation.frame_count();
    let numbers = match &arguments.frames {
        Some(frames) => frames.within(count).map_err(Failure::Usage)?,
        None => (1..=count).collect(),
    };
    let certification = match arguments.certify {
        true => Some(Certification::beside(&arguments.output, &numbers).map_err(Failure::Usage)?),
        false => None,
    };
    if let Some(certification) = &certification {
        certification.open()?;
    }
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = arguments.threads {
        pool = pool.num_threads(threads);
    }
    let pool = pool.build().context("cannot start the threads")?;
    let job = Job {
        output: &arguments.output,
        scene: &scene,
        numbers,
        certification,
        supersample: arguments.supersample,
        resume: arguments.resume,
        progress: arguments.progress,
        max_error: arguments.max_error,
        verbosity,
    };
    pool.install(|| writer(format)(job))?;
    Ok(())
}
