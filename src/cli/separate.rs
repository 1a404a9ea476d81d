//! `inbetween separate`.

mod document;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use inbetween::export::{PendingFile, png_bytes, svg_text};
use inbetween::input::{Art, Canvas, Picture};
use inbetween::render::{Frame, VectorFrame, VectorNode, VectorShape};
use inbetween::scene::{Scene, Separated, SeparatedDrawing};
use toml_edit::{DocumentMut, InlineTable};

use super::{Failure, Verbosity};

/// Write the parts that were found as layers
///
/// Loose parts of the drawings (a hat that floats, a spark, an eyebrow) and parts that lie over one another (an arm in front of the chest)
/// become the layers of a new scene in DIR: a picture a part and pose, PNG of bitmaps and SVG of vector drawings, on the canvas of the
/// drawing that it was found in, and a scene.toml with everything that the old one says. What one part hides of another is filled from the
/// other poses; such parts hang on one another by landmarks, come in each pose's order, and are PNG pictures of vector drawings, too. A
/// frame at a pose stays as it is. Between poses a part that only some of them have appears where it is, instead of growing.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  inbetween separate wizard/scene.toml -o wizard-layers")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The folder of the new scene; made if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
    /// Write over the files of an earlier run
    #[arg(long)]
    force: bool,
}

/// A file of the new scene.
struct Written {
    name: String,
    bytes: Vec<u8>,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let file = &arguments.scene;
    let scene = Scene::open(file)?;
    if let [first, others @ ..] = scene.layers.as_slice() {
        let names: Vec<String> = std::iter::once(first)
            .chain(others)
            .map(|layer| format!("'{}'", layer.name))
            .collect();
        return Err(anyhow::anyhow!(
            "{}: the scene has layers already ({}), and loose parts of theirs stay with them; there is nothing to separate",
            file.display(),
            names.join(", ")
        )
        .into());
    }
    let scene = scene.with_automatic_places()?;
    let separated = scene.separated()?;
    verbosity.notes(&separated.notes);
    if separated.layers.len() < 2 {
        return Err(anyhow::anyhow!(
            "{}: the drawings have no loose parts, and none that lie over one another; there is nothing to separate",
            file.display()
        )
        .into());
    }
    let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    let files = files(&scene, &separated, &text, &arguments.output)?;
    write(&files, arguments)?;
    verbosity.note(&format!(
        "wrote {} with {} layers and {} pictures; next: inbetween render {0} -o {}.gif",
        arguments.output.join("scene.toml").display(),
        separated.layers.len(),
        files.len() - 1,
        arguments
            .output
            .file_name()
            .map_or_else(|| "layers".into(), |name| name.to_string_lossy()),
    ));
    Ok(())
}

/// All files, the scene last.
fn files(scene: &Scene, separated: &Separated, text: &str, folder: &Path) -> anyhow::Result<Vec<Written>> {
    let mut written: Vec<Written> = Vec::new();
    let mut sources: Vec<InlineTable> = vec![InlineTable::new(); scene.poses.len()];
    for layer in &separated.layers {
        for ((pose, drawing), source) in scene.poses.iter().zip(&layer.drawings).zip(&mut sources) {
            let Some(drawing) = drawing else { continue };
            let (bytes, suffix) = match drawing {
                SeparatedDrawing::Pixels(picture) => (png_bytes(&frame(picture))?, "png"),
                SeparatedDrawing::Curves(art, canvas) => (page(art, canvas)?.into_bytes(), "svg"),
                SeparatedDrawing::Unwritable => bail!(
                    "the drawing of pose '{}' has something that curves cannot say, so its part '{}' cannot be written; export it as a \
                     PNG with a transparent background, and separate that",
                    pose.name,
                    layer.name
                ),
            };
            let name = file_name(&pose.name, &layer.name, suffix, &written);
            source.insert(&layer.name, name.as_str().into());
            written.push(Written { name, bytes });
        }
    }
    let mut document: DocumentMut = text
        .parse()
        .with_context(|| format!("cannot edit {}", scene.file.display()))?;
    document::edit(&mut document, scene, separated, sources)?;
    let text = document.to_string();
    Scene::parse(&text, &folder.join("scene.toml"))
        .context("the scene cannot be put into layers; take out what its cause names, and put it back afterwards")?;
    written.push(Written {
        name: "scene.toml".to_owned(),
        bytes: text.into_bytes(),
    });
    Ok(written)
}

/// A name that no other file has, of letters that every system takes.
fn file_name(pose: &str, layer: &str, suffix: &str, written: &[Written]) -> String {
    let plain = |word: &str| -> String {
        let letters = word.chars();
        letters
            .map(|c| if c.is_alphanumeric() || c == '_' { c } else { '-' })
            .collect()
    };
    let stem = format!("{}-{}", plain(pose), plain(layer));
    // Some systems do not tell capitals apart.
    let is_free = |name: &String| {
        !written
            .iter()
            .any(|file| file.name.to_lowercase() == name.to_lowercase())
    };
    let numbered = (2..).map(|number| format!("{stem}-{number}.{suffix}"));
    let mut names = std::iter::once(format!("{stem}.{suffix}")).chain(numbered);
    names.find(is_free).unwrap_or_default()
}

fn frame(picture: &Picture) -> Frame {
    Frame {
        width: picture.width,
        height: picture.height,
        pixels: picture.pixels.clone(),
    }
}

/// The curves of a part as an SVG document on the page of the drawing that it was found in.
fn page(art: &Art, canvas: &Canvas) -> anyhow::Result<String> {
    let nodes = art.elements.iter().enumerate().map(|(number, element)| {
        VectorNode::Shape(Box::new(VectorShape {
            id: element.id.clone().unwrap_or_else(|| format!("path-{}", number + 1)),
            subpaths: element.subpaths.clone(),
            fill: element.fill.clone(),
            stroke: element.stroke.clone(),
            opacity: element.opacity,
        }))
    });
    let text = svg_text(&VectorFrame {
        size: [1, 1],
        background: None,
        nodes: nodes.collect(),
    })?;
    let (low, size) = (canvas.low, canvas.size());
    let own = format!(
        "viewBox=\"{} {} {} {}\" width=\"{2}\" height=\"{3}\"",
        low.x, low.y, size.x, size.y
    );
    Ok(text.replacen("viewBox=\"0 0 1 1\" width=\"1\" height=\"1\"", &own, 1))
}

/// Writes all files or none.
fn write(files: &[Written], arguments: &Arguments) -> anyhow::Result<()> {
    let folder = &arguments.output;
    let targets: BTreeSet<PathBuf> = files.iter().map(|file| folder.join(&file.name)).collect();
    if let Some(target) = targets.iter().find(|target| target.exists() && !arguments.force) {
        bail!(
            "{} exists; write over it with --force, or choose another folder",
            target.display()
        );
    }
    let is_new = !folder.exists();
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let whole = files
        .iter()
        .map(|file| (folder.join(&file.name), file.bytes.as_slice()));
    let done = PendingFile::write_together(whole);
    if done.is_err() && is_new {
        let _ = std::fs::remove_dir(folder);
    }
    Ok(done?)
}
