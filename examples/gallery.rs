//! Every picture in `data/pictures` but the explorer's, which is a photograph of its page: `cargo run --release --example gallery --
//! data/pictures` draws them again.
//!
//! The stages of the pipeline, the comparisons of blends and the cardinal basis come from the examples of those names; the animations, the
//! explained scene and the drawing carried as curves are drawn here.

#![expect(clippy::duplicate_mod, reason = "the examples have the sheet that they draw on")]

#[path = "blending.rs"]
mod blending;
#[path = "cardinal_basis.rs"]
mod cardinal_basis;
#[path = "stages.rs"]
mod stages;

use std::error::Error;
use std::path::{Path, PathBuf};

use blending::palette::png_with_palette;
use inbetween::animation::Background;
use inbetween::export::{Backdrop, ColourCount, GifWriter, Palette, PendingFile, Repetition, png_bytes};
use inbetween::pipeline::{ArtChoice, map_layer};
use inbetween::render::Frame;
use inbetween::render::diagram::{self, Diagram, DiagramPose, Sections};
use inbetween::scene::{Scene, ShapeModel, ShapeScene};
use inbetween::weights::WeightProvider as _;
use stages::common::Sheet;

type Drawn = Result<(), Box<dyn Error>>;

/// The animations: which scene, how large, frames a second.
const ANIMATIONS: [(&str, [usize; 2], f64); 3] = [
    ("walker", [270, 304], 12.0),
    ("clown", [270, 290], 15.0),
    ("bear", [270, 304], 12.0),
];
/// What is shown of the picture that explains the walker: its upper left part, columns and rows.
const EXPLAINED: [usize; 2] = [1890, 960];
/// Columns and rows of one face.
const FACE: [usize; 2] = [300, 300];
/// How much of the right one of two faces is seen in each step.
const STEPS: [f64; 3] = [0.25, 0.5, 0.75];

fn main() -> Drawn {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: gallery FOLDER")?);
    stages::main()?;
    blending::main()?;
    cardinal_basis::main()?;
    for (name, size, fps) in ANIMATIONS {
        animation(name, size, fps, &folder)?;
    }
    explained(&folder)?;
    curves(&folder)?;
    shape_sheet("bendable", [760, 1262], &folder)?;
    shape_sheet("arm", [1400, 1110], &folder)
}

fn data(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    folder.join(name).join("scene.toml")
}

fn scene(name: &str) -> Result<Scene, Box<dyn Error>> {
    Ok(Scene::open(&data(name))?)
}

/// The space of a shape in space.
fn shape_sheet(name: &str, size: [u32; 2], folder: &Path) -> Drawn {
    let scene = ShapeScene::open(&data(&format!("shapes/{name}")))?;
    let sheet = ShapeModel::open(&scene)?.sheet(&scene, Some(size))?;
    Ok(std::fs::write(
        folder.join(format!("shape-{name}.png")),
        png_with_palette(&sheet)?,
    )?)
}

/// A scene as a GIF that plays for ever.
fn animation(name: &str, size: [usize; 2], fps: f64, folder: &Path) -> Drawn {
    let mut scene = scene(name)?;
    scene.animation.background = Background::Colour([255; 4]);
    scene.animation.fps = fps;
    let character = scene.character(size, 1)?;
    let frames: Vec<Frame> = (0..scene.animation.frame_count())
        .map(|index| character.frame(&scene.animation, index))
        .collect::<Result<_, _>>()?;
    let mut colours = ColourCount::default();
    for frame in &frames {
        colours.add(frame);
    }
    let mut file = PendingFile::create(&folder.join(format!("{name}.gif")))?;
    let palette = Palette::new(&colours);
    let mut writer = GifWriter::new(&mut file, size, fps, palette, Backdrop::Opaque, Repetition::Forever)?;
    for frame in &frames {
        writer.add(frame)?;
    }
    writer.finish()?;
    Ok(file.commit()?)
}

/// What `inbetween show` draws of the walker.
fn explained(folder: &Path) -> Drawn {
    let scene = scene("walker")?;
    let provider = scene.weights(None)?;
    let layer = scene.layer_spec(0)?;
    let (mapping, report) = map_layer(&layer)?;
    let poses: Vec<DiagramPose> = scene
        .poses
        .iter()
        .map(|pose| DiagramPose {
            name: pose.name.clone(),
            at: pose.at.clone(),
        })
        .collect();
    let weights = |place: &[f64]| {
        let mut weights = Vec::new();
        provider.weights(place, &mut weights).ok().map(|()| weights)
    };
    let diagram = Diagram {
        mapping: &mapping,
        matching: &report.matching,
        landmarks: &report.landmarks,
        poses: &poses,
        path: &[],
    };
    let sections = Sections::new(&mapping, &report.matching, &report.landmarks);
    let whole = diagram::draw(&diagram, &sections, weights)?;
    let [width, height] = [EXPLAINED[0].min(whole.width), EXPLAINED[1].min(whole.height)];
    let rows = whole.pixels.chunks_exact(whole.width).take(height);
    let frame = Frame {
        width,
        height,
        pixels: rows.flat_map(|row| row[..width].iter().copied()).collect(),
    };
    Ok(std::fs::write(folder.join("show.png"), png_with_palette(&frame)?)?)
}

/// From one face to another: above cross-faded as pixels, below as curves.
fn curves(folder: &Path) -> Drawn {
    let mut sheet = Sheet::new([(STEPS.len() * FACE[0]) as u32, 2 * FACE[1] as u32])?;
    for (row, art) in [ArtChoice::Pixels, ArtChoice::Curves].into_iter().enumerate() {
        let mut scene = scene("face")?;
        scene.art = art;
        let character = scene.character(FACE, 1)?;
        let pose = |name: &str| {
            let found = scene.poses.iter().position(|pose| pose.name == name);
            found.ok_or_else(|| format!("no pose '{name}'"))
        };
        let (from, to) = (pose("calm_left")?, pose("laugh_right")?);
        for (column, step) in STEPS.into_iter().enumerate() {
            let mut weights = vec![0.0; scene.poses.len()];
            weights[from] += 1.0 - step;
            weights[to] += step;
            let corner = [(column * FACE[0]) as u32, (row * FACE[1]) as u32];
            sheet.paste(corner, &character.frame_of(&weights)?)?;
        }
    }
    Ok(std::fs::write(
        folder.join("pixels-and-curves.png"),
        png_bytes(&sheet.into_frame())?,
    )?)
}
