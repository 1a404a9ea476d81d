//! `inbetween explore`.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::Context as _;
use inbetween::export::PendingFile;
use inbetween::scene::scene_text;

use super::new::{self, Copy};
use super::values::Grid;
use super::{Failure, Verbosity};
use crate::explorer::{Begun, DrawingCopy, Explorer, Opened};

/// Open a scene, or drawings, in the browser: drag through the pose space, edit it, record a gesture
///
/// Serves an interactive page on this machine alone, at an address with a secret in it, until it is stopped (Ctrl-C).
/// Edits made there are saved to the scene file; its comments stay. Given drawings, it begins a scene for them as `new` does, in a
/// temporary folder and not beside them: nothing else is written until "Save…" in the page names a folder. Until then the drawings are
/// looked at where they are, and changes to them are shown.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween explore walker/scene.toml
  inbetween explore walker/*.png
  inbetween explore sheet.png --cells 4x2
  inbetween explore walker/scene.toml --port 8000 --no-open")]
pub(crate) struct Arguments {
    /// The scene file; or drawings, a pose each: PNG, JPEG, WebP, GIF, BMP, TIFF or SVG
    #[arg(required = true, value_name = "SCENE|DRAWING")]
    paths: Vec<PathBuf>,
    /// Sheets: how many columns and rows of cells each drawing has, such as 4x2; a pose for every cell that is not empty
    #[arg(long, value_name = "COLSxROWS")]
    cells: Option<Grid>,
    /// The port to listen at; 0, the default, is any free one
    #[arg(long, value_name = "P", default_value_t = 0)]
    port: u16,
    /// Print the address and do not open a browser
    #[arg(long)]
    no_open: bool,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let opened = match arguments.paths.as_slice() {
        [scene] if !new::is_drawing(scene) => {
            if arguments.cells.is_some() {
                return Err(Failure::Usage(
                    "--cells goes with drawings; in a scene `cells` stands under [input]".to_owned(),
                ));
            }
            Opened::Scene(scene.clone())
        }
        drawings => match drawings.iter().find(|path| !new::is_drawing(path)) {
            Some(other) => {
                return Err(Failure::Usage(format!(
                    "{} is no drawing; give one scene file, or drawings alone",
                    other.display()
                )));
            }
            None => Opened::Begun(begin(drawings, arguments.cells, verbosity)?),
        },
    };
    let explorer = Explorer::open(opened, Some(arguments.port).filter(|port| *port != 0))?;
    let address = explorer.address();
    let mut standard = std::io::stdout().lock();
    writeln!(standard, "{address}")
        .and_then(|()| standard.flush())
        .context("cannot write to standard output")?;
    drop(standard);
    if !arguments.no_open && open_browser(&address).is_err() {
        verbosity.note("note: no browser could be opened; open the address above");
    }
    explorer.run();
    Ok(())
}

/// Begins a scene for some drawings, in a temporary folder. Its poses have no places of their own: they are laid out when they are mapped.
fn begin(drawings: &[PathBuf], cells: Option<Grid>, verbosity: Verbosity) -> anyhow::Result<Begun> {
    let temporary = tempfile::Builder::new()
        .prefix("inbetween-")
        .tempdir()
        .context("cannot make a temporary folder")?;
    // A scene is called by its folder.
    let name = drawings.first().and_then(|drawing| folder_name(drawing));
    let dir = temporary.path().join(name.as_deref().unwrap_or("drawings"));
    std::fs::create_dir(&dir).with_context(|| format!("cannot make the folder {}", dir.display()))?;
    let plan = new::plan(&new::Arguments {
        dir: dir.clone(),
        poses: drawings.to_vec(),
        cells,
        layers: None,
        force: false,
    })?;
    verbosity.notes(&plan.notes);
    let mut copies = Vec::new();
    for Copy {
        original,
        bytes,
        target,
    } in plan.copies
    {
        PendingFile::write_whole(&target, &bytes)?;
        copies.push(DrawingCopy::new(original, target));
    }
    let file = dir.join("scene.toml");
    PendingFile::write_whole(&file, scene_text(&plan.layers, &plan.poses).as_bytes())?;
    verbosity.note(&format!(
        "note: the scene is in {} until it is saved in the page",
        dir.display()
    ));
    Ok(Begun {
        file,
        // It outlives this process, which may be ended at any time, so that no work is lost.
        temporary: temporary.keep(),
        copies,
    })
}

/// What the folder of a drawing is called.
fn folder_name(drawing: &Path) -> Option<String> {
    let whole = drawing.canonicalize().ok()?;
    Some(whole.parent()?.file_name()?.to_str()?.to_owned())
}

/// Hands the address to the system's browser.
fn open_browser(address: &str) -> std::io::Result<()> {
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(target_os = "windows") {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else {
        Command::new("xdg-open")
    };
    let mut child = command
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    // Waited for, so that it leaves no dead process behind.
    std::thread::spawn(move || child.wait());
    Ok(())
}
