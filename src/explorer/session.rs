//! The state of an explored scene.
//!
//! What is shown is one immutable [`Shown`]; requests take it and never wait for work. Edits change the document at once and tell
//! the worker which scene is wanted; it shows the newest as soon as it can.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use inbetween::scene::Scene;
use serde_json::{Value, json};

use super::model::Shown;
use super::pictures::{self, Kind};
use super::problem::{Problem, Refusal};

/// A picture's place and its file.
type EncodedPicture = (Value, Result<Arc<Vec<u8>>, Refusal>);

/// The state of an explored scene.
#[derive(Debug)]
pub(crate) struct Session {
    file: PathBuf,
    state: Mutex<State>,
    /// Told whenever `seq` changes.
    changed: Condvar,
    /// Told whenever there is something to compute.
    wanted: Condvar,
    /// By layer, drawing and kind, of the pictures' revision.
    pictures: Mutex<(u64, BTreeMap<(usize, usize, bool), EncodedPicture>)>,
}

#[derive(Debug)]
struct State {
    seq: u64,
    text: String,
    shown: Arc<Shown>,
    /// What the worker has to do.
    wanted: Option<Wanted>,
    working: bool,
    mapping_ms: Option<f64>,
}

/// A scene to be computed.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    pub(crate) scene: Arc<Scene>,
    pub(crate) since: Instant,
}

impl Session {
    /// Opens a scene file, as far as it can be.
    pub(crate) fn open(file: &Path) -> Self {
        let session = Self {
            file: file.to_owned(),
            state: Mutex::new(State {
                seq: 1,
                text: String::new(),
                shown: Arc::new(Shown::default()),
                wanted: None,
                working: false,
                mapping_ms: None,
            }),
            changed: Condvar::new(),
            wanted: Condvar::new(),
            pictures: Mutex::default(),
        };
        let text = std::fs::read_to_string(file);
        let mut state = session.lock();
        match text {
            Ok(text) => {
                state.text = text;
                session.read_scene(&mut state);
            }
            Err(_) => {
                let problem = Scene::open(file).err().map(|error| Problem::from(&error));
                state.shown = Arc::new(Shown::new(
                    None,
                    None,
                    problem.into_iter().collect(),
                    Default::default(),
                ));
            }
        }
        drop(state);
        session
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn touch(&self, state: &mut State) {
        state.seq += 1;
        self.changed.notify_all();
    }

    /// Takes the scene that the text says, and wants it computed.
    fn read_scene(&self, state: &mut State) {
        let before = Arc::clone(&state.shown);
        let mut revisions = before.revisions;
        revisions.scene += 1;
        match Scene::parse(&state.text, &self.file) {
            Ok(scene) => {
                let scene = Arc::new(scene);
                state.wanted = Some(Wanted {
                    scene: Arc::clone(&scene),
                    since: Instant::now(),
                });
                self.wanted.notify_one();
                state.shown = Arc::new(Shown::new(Some(scene), before.bench.clone(), Vec::new(), revisions));
            }
            Err(error) => {
                let problems = vec![Problem::from(&error)];
                state.shown = Arc::new(Shown::new(
                    before.scene.clone(),
                    before.bench.clone(),
                    problems,
                    revisions,
                ));
            }
        }
        self.touch(state);
    }

    /// What is shown.
    pub(crate) fn shown(&self) -> Arc<Shown> {
        Arc::clone(&self.lock().shown)
    }

    /// The scene's path, as it was given.
    pub(crate) fn typed(&self) -> String {
        self.file.display().to_string()
    }

    pub(crate) fn file_name(&self) -> String {
        self.file
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// The scene's text.
    pub(crate) fn text(&self) -> String {
        self.lock().text.clone()
    }

    /// `GET api/state`.
    pub(crate) fn state_json(&self) -> Value {
        state_json(&self.lock())
    }

    /// The state when its number is not `after`, or after `patience`.
    pub(crate) fn state_after(&self, after: u64, patience: Duration) -> Value {
        let state = self.lock();
        let is_old = |state: &mut State| state.seq == after;
        let (state, _) = self
            .changed
            .wait_timeout_while(state, patience, is_old)
            .unwrap_or_else(PoisonError::into_inner);
        state_json(&state)
    }

    /// The next scene to compute; waits until there is one.
    pub(crate) fn next_wanted(&self) -> (Wanted, Arc<Shown>) {
        let state = self.lock();
        let mut state = self
            .wanted
            .wait_while(state, |state| state.wanted.is_none())
            .unwrap_or_else(PoisonError::into_inner);
        state.working = true;
        self.touch(&mut state);
        match state.wanted.take() {
            Some(wanted) => (wanted, Arc::clone(&state.shown)),
            None => unreachable!("it was waited for"),
        }
    }

    /// Shows what has been computed.
    pub(crate) fn show(&self, wanted: &Wanted, made: Result<Arc<inbetween::pipeline::Workbench>, Problem>) {
        let mut state = self.lock();
        let before = Arc::clone(&state.shown);
        let mut revisions = before.revisions;
        let is_newest = state.wanted.is_none();
        state.working = !is_newest;
        state.shown = Arc::new(match made {
            Ok(bench) => {
                let old = before.bench.as_ref();
                revisions.scene += 1;
                revisions.weights += 1;
                if !old.is_some_and(|old| old.has_pictures_of(&bench)) {
                    revisions.pictures += 1;
                }
                if !old.is_some_and(|old| old.has_meshes_of(&bench)) {
                    revisions.shape += 1;
                    state.mapping_ms = Some(1e3 * wanted.since.elapsed().as_secs_f64());
                }
                let scene = if is_newest {
                    Some(Arc::new(bench.scene().clone()))
                } else {
                    before.scene.clone()
                };
                Shown::new(scene, Some(bench), before.problems.clone(), revisions)
            }
            Err(problem) => {
                let problems = if is_newest {
                    vec![problem]
                } else {
                    before.problems.clone()
                };
                Shown::new(before.scene.clone(), before.bench.clone(), problems, revisions)
            }
        });
        self.touch(&mut state);
    }

    /// The picture of a layer's drawing: where it lies, and its PNG file. Made once.
    pub(super) fn picture(&self, shown: &Shown, layer: usize, index: usize, kind: Kind) -> EncodedPicture {
        let revision = shown.revisions.pictures;
        let key = (layer, index, kind == Kind::Colour);
        {
            let mut kept = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
            if kept.0 < revision {
                *kept = (revision, BTreeMap::new());
            }
            if let Some(picture) = kept.1.get(&key).filter(|_| kept.0 == revision) {
                return picture.clone();
            }
        }
        let Some(bench) = &shown.bench else {
            return (Value::Null, Err(Refusal::failed("there is no drawing")));
        };
        let placed = pictures::picture(bench, layer, index, kind);
        let picture = (placed.place(), pictures::png(&placed.texture).map(Arc::new));
        let mut kept = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.0 == revision {
            kept.1.insert(key, picture.clone());
        }
        picture
    }
}

fn state_json(state: &State) -> Value {
    json!({
        "seq": state.seq,
        "revisions": state.shown.revisions,
        "working": state.working || state.wanted.is_some(),
        "dragging": false, "saved": true, "conflict": false, "save_error": null,
        "undo": null, "redo": null,
        "problems": state.shown.problems,
        "timings": {"mapping_ms": state.mapping_ms},
        "job": null,
    })
}
