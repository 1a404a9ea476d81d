//! Scenes that were begun for drawings: they lie in a temporary folder until the artist names another one.
//!
//! The scene uses copies of the drawings, since a scene's drawings lie in its folder. Until it is kept elsewhere, the copies follow the
//! drawings that they were made of.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use inbetween::export::PendingFile;
use inbetween::scene::Scene;
use serde::Deserialize;
use serde_json::Value;

use super::problem::{Problem, Refusal};
use super::session::Session;
use super::stamp::{Stamp, stamp};

/// What the scene file of a folder is called.
const SCENE_FILE: &str = "scene.toml";

/// A scene that was begun for drawings.
#[derive(Debug)]
pub(crate) struct Begun {
    /// Its file.
    pub(crate) file: PathBuf,
    /// The folder that goes when the scene is kept elsewhere.
    pub(crate) temporary: PathBuf,
    /// Its drawings.
    pub(crate) copies: Vec<DrawingCopy>,
}

/// A drawing, and the copy of it that the scene uses.
#[derive(Debug)]
pub(crate) struct DrawingCopy {
    original: PathBuf,
    copy: PathBuf,
    taken: Option<Stamp>,
}

impl DrawingCopy {
    /// A copy that was just made.
    pub(crate) fn new(original: PathBuf, copy: PathBuf) -> Self {
        let taken = stamp(&original);
        Self { original, copy, taken }
    }

    /// Copies the drawing again if its file has changed. One that is gone is looked at again later.
    fn refresh(&mut self) {
        let now = stamp(&self.original);
        if now.is_none() || now == self.taken {
            return;
        }
        let bytes = std::fs::read(&self.original);
        if bytes.is_ok_and(|bytes| PendingFile::write_whole(&self.copy, &bytes).is_ok()) {
            self.taken = now;
        }
    }
}

/// What is in a temporary folder of a session: a scene that was begun, or nothing any more.
#[derive(Debug)]
pub(super) struct Temporary(Mutex<Option<Begun>>);

impl Temporary {
    pub(super) fn new(begun: Option<Begun>) -> Self {
        Self(Mutex::new(begun))
    }

    /// Takes drawings again that have changed since they were copied.
    pub(super) fn refresh_copies(&self) {
        let mut begun = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for copy in begun.iter_mut().flat_map(|begun| &mut begun.copies) {
            copy.refresh();
        }
    }

    /// The scene lies elsewhere now: the folder goes.
    fn forget(&self) {
        let mut begun = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(begun) = begun.take() {
            // What cannot be removed the system removes some day.
            let _ = std::fs::remove_dir_all(begun.temporary);
        }
    }
}

/// The body of `POST api/keep`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Keep {
    folder: String,
}

/// `POST api/keep`: writes the scene and its drawings into a folder, where it is edited from then on.
pub(super) fn keep(body: &[u8], session: &Session) -> Result<Value, Refusal> {
    let asked: Keep = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let folder = Path::new(asked.folder.trim());
    if folder.as_os_str().is_empty() {
        return Err(Refusal::bad("name a folder for the scene"));
    }
    let mut document = session.lock_document();
    if !document.is_temporary() {
        return Err(refused("the scene has a folder already"));
    }
    let scene = Scene::parse(document.base(), document.file());
    let scene = scene.map_err(|error| Refusal::conflict(Problem::from(&error)))?;
    let file = folder.join(SCENE_FILE);
    write_all(&wanted_files(&scene, document.base(), &file)?, folder)?;
    document.move_to(file);
    session.temporary.forget();
    session.read_document(&document);
    drop(document);
    Ok(session.state_json())
}

fn refused(message: impl std::fmt::Display) -> Refusal {
    Refusal::conflict(Problem::new(message))
}

/// The files that have to be written so that `file` is the scene: its drawings, and last its text. What is there and has the same bytes
/// is left out, what is there and has others is refused.
fn wanted_files(scene: &Scene, text: &str, file: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, Refusal> {
    if file.exists() {
        return Err(refused(format!("{} exists; name another folder", file.display())));
    }
    let folder = |file: &Path| file.parent().unwrap_or(Path::new(".")).to_owned();
    let home = folder(&scene.file).canonicalize().map_err(Refusal::failed)?;
    let sources = scene.source_files();
    let mut wanted = Vec::new();
    for source in sources.map_err(|error| Refusal::conflict(Problem::from(&error)))? {
        let target = folder(file).join(source.strip_prefix(&home).map_err(Refusal::failed)?);
        let bytes = std::fs::read(&source);
        let bytes = bytes.map_err(|error| refused(format!("cannot read the drawing {}: {error}", source.display())))?;
        match std::fs::read(&target) {
            Ok(there) if there == bytes => {}
            Ok(_) => {
                return Err(refused(format!(
                    "{} is another drawing of that name; name another folder",
                    target.display()
                )));
            }
            Err(_) => wanted.push((target, bytes)),
        }
    }
    wanted.push((file.to_owned(), text.as_bytes().to_vec()));
    Ok(wanted)
}

/// Writes all files, or none.
fn write_all(wanted: &[(PathBuf, Vec<u8>)], folder: &Path) -> Result<(), Refusal> {
    let is_new = !folder.exists();
    let written = || -> anyhow::Result<()> {
        for (target, _) in wanted {
            std::fs::create_dir_all(target.parent().unwrap_or(folder))?;
        }
        let whole = wanted.iter().map(|(target, bytes)| (target.clone(), bytes.as_slice()));
        Ok(PendingFile::write_together(whole)?)
    };
    written().map_err(|error| {
        if is_new {
            let _ = std::fs::remove_dir(folder);
        }
        refused(format!(
            "cannot write into {}: {error:#}; name another folder",
            folder.display()
        ))
    })
}
