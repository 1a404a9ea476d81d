//! An explored scene: what is shown of it, what is edited, what is being computed.
//!
//! What is shown is one immutable [`Shown`]; requests take it and never wait for work. Edits change the [`Document`] at once and tell
//! the worker which scene is wanted; it shows the newest as soon as it can. Weights follow a pose that is moved at once.
//!
//! Locks are taken in this order: document, temporary folder, state, pictures.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use inbetween::scene::{DrawingFiles, Layout, Scene, Workbench};
use serde::Deserialize;
use serde_json::Value;

use super::document::{Document, Outside, Place};
use super::draggers::Draggers;
use super::edit::{self, Context, Op};
use super::jobs::Jobs;
use super::keeping::{Begun, Temporary};
use super::model::Shown;
use super::picture_cache::PictureCache;
use super::problem::{Problem, Refusal};
use super::reweighting::{Only, reweighted, with_places_of};
use super::state::{FileState, State, Wanted};

/// The state of an explored scene.
#[derive(Debug)]
pub(crate) struct Session {
    document: Mutex<Document>,
    state: Mutex<State>,
    /// Told whenever `seq` changes.
    changed: Condvar,
    /// Told whenever there is something to compute.
    wanted: Condvar,
    /// Those that were asked for.
    pub(super) pictures: PictureCache,
    /// Handles that are being dragged.
    pub(super) draggers: Draggers,
    /// The export.
    pub(super) jobs: Jobs,
    /// What the scene has in a temporary folder.
    pub(super) temporary: Temporary,
}

/// The body of `POST api/edit`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct EditRequest {
    ops: Vec<Op>,
    label: Option<String>,
    #[serde(default)]
    phase: Phase,
    merge: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Phase {
    Drag,
    #[default]
    Done,
    Cancel,
}

impl Session {
    /// Opens a scene file, as far as it can be.
    pub(crate) fn open(file: &Path) -> Self {
        Self::of(Document::open(file, Place::Kept), None)
    }

    /// Opens a scene that was begun for drawings.
    pub(crate) fn begun(begun: Begun) -> Self {
        Self::of(Document::open(&begun.file, Place::Temporary), Some(begun))
    }

    fn of(document: Document, begun: Option<Begun>) -> Self {
        let session = Self {
            document: Mutex::new(document),
            state: Mutex::new(State {
                seq: 1,
                ..State::default()
            }),
            changed: Condvar::new(),
            wanted: Condvar::new(),
            pictures: PictureCache::default(),
            draggers: Draggers::default(),
            jobs: Jobs::default(),
            temporary: Temporary::new(begun),
        };
        session.read_document(&session.lock_document());
        session
    }

    pub(super) fn lock_document(&self) -> MutexGuard<'_, Document> {
        self.document.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn touch(&self, state: &mut State) {
        state.seq += 1;
        self.changed.notify_all();
    }

    /// Takes the scene that the document says.
    pub(super) fn read_document(&self, document: &Document) {
        let read = if document.text().is_empty() {
            // Why there is none.
            Scene::open(document.file())
        } else {
            Scene::parse(document.text(), document.file())
        };
        match read {
            Ok(scene) => self.adopt(document, scene, Phase::Done),
            Err(error) => {
                let mut state = self.lock();
                let before = Arc::clone(&state.shown);
                let mut revisions = before.revisions;
                revisions.scene += 1;
                state.generation += 1;
                state.wanted = None;
                let problems = vec![Problem::from(&error)];
                state.shown = Arc::new(Shown::new(
                    before.scene.clone(),
                    before.bench.clone(),
                    problems,
                    revisions,
                    &before,
                ));
                state.file = FileState::of(document);
                self.touch(&mut state);
            }
        }
    }

    /// Shows an edited scene, and wants computed what cannot be shown at once.
    fn adopt(&self, document: &Document, mut scene: Scene, phase: Phase) {
        let before = self.shown();
        if let Some(bench) = &before.bench
            && scene.layout == Layout::Automatic
            && bench.scene().names() == scene.names()
        {
            let places: Vec<Vec<f64>> = bench.scene().poses.iter().map(|pose| pose.at.clone()).collect();
            let as_given = scene.layout;
            scene = scene.laid_out(&places);
            scene.layout = as_given;
        }
        let at_once = before.bench.as_ref().and_then(|bench| reweighted(bench, &scene));
        let scene = Arc::new(scene);
        let mut state = self.lock();
        let before = Arc::clone(&state.shown);
        let mut revisions = before.revisions;
        revisions.scene += 1;
        state.generation += 1;
        let is_complete = phase == Phase::Drag && at_once.as_ref().is_some_and(|(_, only)| *only == Only::Weights);
        if at_once.is_some() {
            revisions.weights += 1;
            state.reweighted = state.generation;
        }
        // A drag leaves undone what was wanted before it only if it says all there is to say.
        if is_complete {
            state.wanted = None;
        } else {
            state.wanted = Some(Wanted {
                scene: Arc::clone(&scene),
                files: if state.is_stale {
                    DrawingFiles::Reread
                } else {
                    DrawingFiles::Unchanged
                },
                is_dragged: phase == Phase::Drag,
                since: Instant::now(),
                generation: state.generation,
            });
            self.wanted.notify_one();
        }
        let bench = at_once
            .map(|(bench, _)| Arc::new(bench))
            .or_else(|| before.bench.clone());
        let problems = if is_complete {
            Vec::new()
        } else {
            before.problems.clone()
        };
        state.shown = Arc::new(Shown::new(Some(scene), bench, problems, revisions, &before));
        state.file = FileState::of(document);
        self.touch(&mut state);
    }

    /// `POST api/edit`.
    pub(crate) fn edit(&self, body: &[u8]) -> Result<Value, Refusal> {
        let request: EditRequest = serde_json::from_slice(body).map_err(Refusal::bad)?;
        let mut document = self.lock_document();
        let mut names = Vec::new();
        if request.phase == Phase::Cancel {
            if document.is_dragging() {
                document.cancel();
                self.read_document(&document);
            }
        } else {
            let shown = self.shown();
            let context = Context {
                scene: shown.scene.as_deref(),
                bench: shown.bench.as_deref(),
            };
            let edited = edit::apply(document.base(), &request.ops, &context)?;
            let scene = Scene::parse(&edited.text, document.file());
            let scene = scene.map_err(|error| Refusal::conflict(Problem::from(&error)))?;
            names = edited.names;
            if request.phase == Phase::Drag {
                document.try_out(edited.text);
            } else {
                let label = request.label.or_else(|| request.ops.first().map(Op::label));
                document.take(
                    edited.text,
                    label.as_deref().unwrap_or("edit"),
                    request.merge.as_deref(),
                );
            }
            self.adopt(&document, scene, request.phase);
        }
        let mut answer = self.state_json();
        answer["names"] = names.into();
        answer["revision"] = self.shown().revisions.scene.into();
        Ok(answer)
    }

    /// `POST api/undo` and `api/redo`.
    pub(crate) fn step(&self, step: fn(&mut Document) -> bool) -> Result<Value, Refusal> {
        let mut document = self.lock_document();
        if !step(&mut document) {
            return Err(Refusal::conflict(Problem::new("there is no such step")));
        }
        self.read_document(&document);
        Ok(self.state_json())
    }

    /// `POST api/save`.
    pub(crate) fn save(&self) -> Value {
        let mut document = self.lock_document();
        document.save();
        self.lock().file = FileState::of(&document);
        self.touch(&mut self.lock());
        self.state_json()
    }

    /// `POST api/conflict`.
    pub(crate) fn end_conflict(&self, body: &[u8]) -> Result<Value, Refusal> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Choice {
            take: Take,
        }
        #[derive(Deserialize)]
        #[serde(rename_all = "lowercase")]
        enum Take {
            Mine,
            Theirs,
        }
        let choice: Choice = serde_json::from_slice(body).map_err(Refusal::bad)?;
        let mut document = self.lock_document();
        if !document.is_in_conflict() {
            return Err(Refusal::conflict(Problem::new("there is no conflict")));
        }
        match choice.take {
            Take::Mine => document.keep_mine(),
            Take::Theirs => document.take_theirs().map_err(Refusal::failed)?,
        }
        self.read_document(&document);
        Ok(self.state_json())
    }

    /// Looks at the scene file.
    pub(crate) fn look_at_file(&self) {
        let mut document = self.lock_document();
        match document.look() {
            Outside::Same => {}
            Outside::Taken => self.read_document(&document),
            Outside::Conflict => {
                self.lock().file = FileState::of(&document);
                self.touch(&mut self.lock());
            }
        }
    }

    /// Reads the drawings again: their files have changed.
    pub(crate) fn reread_drawings(&self) {
        let document = self.lock_document();
        self.lock().is_stale = true;
        self.read_document(&document);
    }

    /// Whether the drawings' files have changed since they were read.
    pub(super) fn is_stale(&self) -> bool {
        self.lock().is_stale
    }

    /// What is shown.
    pub(crate) fn shown(&self) -> Arc<Shown> {
        Arc::clone(&self.lock().shown)
    }

    /// The scene's path, as it was given.
    pub(crate) fn file(&self) -> PathBuf {
        self.lock_document().file().to_owned()
    }

    /// The scene's text.
    pub(crate) fn text(&self) -> String {
        self.lock_document().text().to_owned()
    }

    /// `GET api/state`.
    pub(crate) fn state_json(&self) -> Value {
        self.lock().json()
    }

    /// The state when its number is not `after`, or after `patience`.
    pub(crate) fn state_after(&self, after: u64, patience: Duration) -> Value {
        let state = self.lock();
        let is_old = |state: &mut State| state.seq == after;
        let (state, _) = self
            .changed
            .wait_timeout_while(state, patience, is_old)
            .unwrap_or_else(PoisonError::into_inner);
        state.json()
    }

    /// Tells the page how the export is getting on.
    pub(crate) fn tell_job(&self, job: Value) {
        let mut state = self.lock();
        state.job = job;
        self.touch(&mut state);
    }

    /// The next scene to compute; waits until there is one.
    pub(crate) fn next_wanted(&self) -> (Wanted, Arc<Shown>) {
        let mut state = self.lock();
        loop {
            if let Some(wanted) = state.wanted.take() {
                state.working = true;
                self.touch(&mut state);
                return (wanted, Arc::clone(&state.shown));
            }
            state = self.wanted.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether there is something to compute already.
    pub(crate) fn is_busy(&self) -> bool {
        self.lock().wanted.is_some()
    }

    /// Shows what has been computed.
    pub(crate) fn show(&self, wanted: &Wanted, made: Result<Workbench, Problem>) {
        let mut state = self.lock();
        let before = Arc::clone(&state.shown);
        let mut revisions = before.revisions;
        let is_newest = state.wanted.is_none() && state.generation == wanted.generation;
        state.working = state.wanted.is_some();
        let mut shown = (before.scene.clone(), before.bench.clone(), before.problems.clone());
        match made {
            Ok(mut bench) => {
                let old = before.bench.as_ref();
                if wanted.files == DrawingFiles::Reread && is_newest {
                    state.is_stale = false;
                }
                if state.reweighted > wanted.generation
                    && let Some(old) = old.filter(|old| old.scene().names() == bench.scene().names())
                {
                    bench = bench.reweighted(&with_places_of(bench.scene(), old.scene()), Arc::clone(old.weights()));
                }
                revisions.scene += 1;
                if !old.is_some_and(|old| Arc::ptr_eq(old.weights(), bench.weights()) && old.has_figure_of(&bench)) {
                    revisions.weights += 1;
                }
                let is_sampled_alike = |old: &Workbench| old.scene().sampling == bench.scene().sampling;
                if !old.is_some_and(|old| old.has_pictures_of(&bench) && is_sampled_alike(old)) {
                    revisions.pictures += 1;
                }
                if !old.is_some_and(|old| old.has_meshes_of(&bench)) {
                    revisions.shape += 1;
                    state.mapping_ms = Some(1e3 * wanted.since.elapsed().as_secs_f64());
                }
                if is_newest {
                    let mut scene = bench.scene().clone();
                    // A layout that was found is not one that the file has.
                    scene.layout = wanted.scene.layout;
                    shown.0 = Some(Arc::new(scene));
                    shown.2 = Vec::new();
                }
                shown.1 = Some(Arc::new(bench));
            }
            Err(problem) if is_newest => shown.2 = vec![problem],
            Err(_) => {}
        }
        state.shown = Arc::new(Shown::new(shown.0, shown.1, shown.2, revisions, &before));
        self.touch(&mut state);
    }
}
