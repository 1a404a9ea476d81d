//! What a run did, for programs: with `--json` the last line of standard error is one object.
//!
//! What verbs tell a person on the way is kept here besides; nothing else that is printed changes.

use std::error::Error;
use std::fmt::Debug;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use inbetween::pipeline::{Note, PipelineError};
use inbetween::scene::{SceneBuildError, SceneError, ShapeNote};
use serde_json::{Map, Value, json};

/// What was told so far: notes, and lines that say what was done.
static TOLD: Mutex<Lines> = Mutex::new(Lines {
    notes: Vec::new(),
    said: Vec::new(),
});

struct Lines {
    notes: Vec<Told>,
    said: Vec<String>,
}

/// A note in its words, and what it is about.
pub(crate) struct Told {
    pub(super) text: String,
    kind: Option<String>,
    layer: Option<String>,
    pose: Option<String>,
}

impl From<&Note> for Told {
    fn from(note: &Note) -> Self {
        Self {
            text: note.to_string(),
            kind: Some(kind_of(&note.kind)),
            layer: note.layer.clone(),
            pose: note.pose.clone(),
        }
    }
}

impl From<&ShapeNote> for Told {
    fn from(note: &ShapeNote) -> Self {
        Self::from(note.to_string())
    }
}

impl From<&String> for Told {
    fn from(text: &String) -> Self {
        Self::from(text.clone())
    }
}

impl From<String> for Told {
    fn from(text: String) -> Self {
        Self {
            text,
            kind: None,
            layer: None,
            pose: None,
        }
    }
}

fn told() -> std::sync::MutexGuard<'static, Lines> {
    // What was pushed is whole whoever panicked.
    TOLD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps a note.
pub(super) fn keep_note(note: Told) {
    told().notes.push(note);
}

/// Keeps a line, which may be a note in words.
pub(super) fn keep_line(line: &str) {
    match line.strip_prefix("note: ") {
        Some(note) => keep_note(Told::from(note.to_owned())),
        None => told().said.push(line.to_owned()),
    }
}

/// How a run ended.
pub(super) enum Outcome<'a> {
    /// With what it was to make, if that is a file or folder.
    Done(Option<&'a Path>),
    /// The command line asks for what does not exist.
    Usage(&'a str),
    Failed(&'a anyhow::Error, &'a str),
}

/// The object, in one line.
pub(super) fn in_json(verb: &str, outcome: &Outcome<'_>) -> String {
    let lines = told();
    let notes: Vec<Value> = lines.notes.iter().map(of_note).collect();
    let (made, error) = match outcome {
        Outcome::Done(made) => {
            let names = made.iter().filter(|path| path.as_os_str() != "-");
            (names.map(|path| path.display().to_string()).collect(), Value::Null)
        }
        Outcome::Usage(text) => (Vec::new(), of_text("usage", text)),
        Outcome::Failed(error, text) => (Vec::new(), of_error(error, text)),
    };
    json!({
        "verb": verb,
        "done": error.is_null(),
        "made": made,
        "said": lines.said,
        "notes": notes,
        "error": error,
    })
    .to_string()
}

fn of_note(note: &Told) -> Value {
    let mut object = Map::new();
    object.insert("text".to_owned(), json!(note.text));
    for (key, value) in [("kind", &note.kind), ("layer", &note.layer), ("pose", &note.pose)] {
        if let Some(value) = value {
            object.insert(key.to_owned(), json!(value));
        }
    }
    Value::Object(object)
}

/// An error in its words: the remedy is what stands behind the last semicolon.
fn of_text(kind: &str, text: &str) -> Value {
    json!({
        "kind": kind,
        "text": text,
        "remedy": text.rsplit_once("; ").map(|(_, remedy)| remedy),
    })
}

fn of_error(error: &anyhow::Error, text: &str) -> Value {
    let mut object = of_text("other", text);
    let mut put = |key: &str, value: Value| {
        if !value.is_null() {
            object[key] = value;
        }
    };
    for cause in error.chain() {
        if let Some(error) = cause.downcast_ref::<SceneError>() {
            put("kind", json!(kind_of(&error.problem)));
            put("file", json!(error.file.display().to_string()));
            put("line", json!(error.line));
        } else if let Some(error) = cause.downcast_ref::<SceneBuildError>() {
            put("kind", json!(kind_of(error)));
            match error {
                SceneBuildError::Pipeline { file, line, source } => {
                    put("file", json!(file.display().to_string()));
                    put("line", json!(line));
                    of_pipeline(source, &mut put);
                }
                SceneBuildError::Drawing {
                    file,
                    line,
                    layer,
                    pose,
                    ..
                } => {
                    put("file", json!(file.display().to_string()));
                    put("line", json!(line));
                    put("layer", json!(layer));
                    put("pose", json!(pose));
                }
                SceneBuildError::NoPartInLayers {
                    file, line, pose, x, y, ..
                } => {
                    put("file", json!(file.display().to_string()));
                    put("line", json!(line));
                    put("pose", json!(pose));
                    put("place", json!([x, y]));
                }
                _ => {}
            }
        } else if let Some(error) = cause.downcast_ref::<PipelineError>() {
            of_pipeline(error, &mut put);
        } else if cause.downcast_ref::<std::io::Error>().is_some() {
            put("kind", json!("io"));
        }
    }
    object
}

fn of_pipeline(error: &PipelineError, put: &mut impl FnMut(&str, Value)) {
    let within = error.within_layer();
    put("kind", json!(kind_of(within)));
    put("layer", json!(error.layer()));
    put("pose", json!(error.pose()));
    put("landmark", json!(error.landmark()));
    put("part", json!(error.limb()));
    put("place", json!(error.place().map(|p| [p.x, p.y])));
    if let Some(source) = within.source() {
        put("cause", json!(source.to_string()));
    }
}

/// The name of a value's variant, in small letters with dashes.
fn kind_of(value: &impl Debug) -> String {
    let debug = format!("{value:?}");
    let name = debug.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    let mut kind = String::new();
    for c in name.chars() {
        if c.is_uppercase() && !kind.is_empty() {
            kind.push('-');
        }
        kind.extend(c.to_lowercase());
    }
    kind
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_the_names_of_variants() {
        #[derive(Debug)]
        #[expect(dead_code, reason = "what it holds is looked at by Debug alone")]
        enum Thing {
            Plain,
            WithField { at: usize },
        }
        assert_eq!(kind_of(&Thing::Plain), "plain");
        assert_eq!(kind_of(&Thing::WithField { at: 3 }), "with-field");
    }

    #[test]
    fn the_remedy_is_what_stands_last() {
        let object = of_text("usage", "there is no layer 'arm'; correct the name");
        assert_eq!(object["remedy"], "correct the name");
        assert_eq!(of_text("usage", "no")["remedy"], Value::Null);
    }
}
