//! What a session knows at one time, and what the page is told of it.

use std::sync::Arc;
use std::time::Instant;

use inbetween::scene::{DrawingFiles, Scene};
use serde::Serialize;
use serde_json::{Value, json};

use super::document::Document;
use super::model::Shown;

/// The state behind a lock.
#[derive(Debug, Default)]
pub(super) struct State {
    pub(super) seq: u64,
    /// Counts edits.
    pub(super) generation: u64,
    /// The last edit whose weights were shown at once.
    pub(super) reweighted: u64,
    pub(super) shown: Arc<Shown>,
    /// What the worker has to do.
    pub(super) wanted: Option<Wanted>,
    pub(super) working: bool,
    /// The drawings' files have changed since they were read.
    pub(super) is_stale: bool,
    pub(super) mapping_ms: Option<f64>,
    pub(super) file: FileState,
    pub(super) job: Value,
}

/// What the page is told of the document.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(super) struct FileState {
    dragging: bool,
    saved: bool,
    conflict: bool,
    temporary: bool,
    save_error: Option<String>,
    undo: Option<String>,
    redo: Option<String>,
}

/// A scene to be computed.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    pub(crate) scene: Arc<Scene>,
    pub(crate) files: DrawingFiles,
    /// Whether it is in the middle of a drag.
    pub(crate) is_dragged: bool,
    pub(super) since: Instant,
    pub(super) generation: u64,
}

impl FileState {
    pub(super) fn of(document: &Document) -> Self {
        let [undo, redo] = document.labels().map(|label| label.map(str::to_owned));
        Self {
            dragging: document.is_dragging(),
            saved: document.is_saved(),
            conflict: document.is_in_conflict(),
            temporary: document.is_temporary(),
            save_error: document.save_error().map(str::to_owned),
            undo,
            redo,
        }
    }
}

impl State {
    /// `GET api/state`.
    pub(super) fn json(&self) -> Value {
        let mut answer = json!({
            "seq": self.seq,
            "revisions": self.shown.revisions,
            "working": self.working || self.wanted.is_some(),
            "problems": self.shown.problems,
            "timings": {"mapping_ms": self.mapping_ms},
            "job": self.job,
        });
        if let (Value::Object(answer), Ok(Value::Object(file))) = (&mut answer, serde_json::to_value(&self.file)) {
            answer.extend(file);
        }
        answer
    }
}
