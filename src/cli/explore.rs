//! `inbetween explore`.

use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::Context as _;

use super::{Failure, Verbosity};
use crate::explorer;

/// Open a scene in the browser: drag through its pose space, edit it, record a gesture
///
/// Serves an interactive page on this machine alone, at an address with a secret in it, until it is stopped (Ctrl-C).
/// Edits made there are saved to the scene file; its comments stay.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween explore walker/scene.toml
  inbetween explore walker/scene.toml --port 8000 --no-open")]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The port to listen at; a free one otherwise
    #[arg(long, value_name = "P", value_parser = clap::value_parser!(u16).range(1..))]
    port: Option<u16>,
    /// Print the address and do not open a browser
    #[arg(long)]
    no_open: bool,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let explorer = explorer::Explorer::open(&arguments.scene, arguments.port)?;
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
