//! Exports: the command's own `render`, in a process of its own, so that it can be watched and ended.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};

use inbetween::export::PendingFile;
use serde::Deserialize;
use serde_json::{Value, json};

use super::problem::{Problem, Refusal};
use super::session::Session;

/// Lines of what a render has to say that are kept.
const MOST_LINES: usize = 20;

/// What is asked for.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Export {
    output: String,
    format: Option<String>,
    size: Option<[u32; 2]>,
    fps: Option<f64>,
    frames: Option<String>,
    supersample: Option<u32>,
    background: Option<String>,
    max_error: Option<f64>,
}

impl Export {
    /// The words of the command line after `inbetween`.
    fn words(&self, scene: &Path) -> Vec<String> {
        // A name that begins with a hyphen is none of the command's options.
        let own = |path: String| {
            if path.starts_with('-') {
                format!("./{path}")
            } else {
                path
            }
        };
        let mut words = vec!["render".to_owned(), own(scene.display().to_string())];
        words.extend(["-o".to_owned(), own(self.output.clone())]);
        let options = [
            ("format", self.format.clone()),
            ("size", self.size.map(|[columns, rows]| format!("{columns}x{rows}"))),
            ("fps", self.fps.map(|v| v.to_string())),
            ("frames", self.frames.clone()),
            ("supersample", self.supersample.map(|v| v.to_string())),
            ("background", self.background.clone()),
            ("max-error", self.max_error.map(|v| v.to_string())),
        ];
        let given = options
            .into_iter()
            .filter_map(|(name, value)| Some(format!("--{name}={}", value?)));
        words.extend(given);
        words
    }
}

/// A command line for a shell.
fn quoted<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    let quote = |word: &str| {
        if !word.is_empty() && word.chars().all(plain) {
            word.to_owned()
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    };
    words.into_iter().map(quote).collect::<Vec<_>>().join(" ")
}

fn command_line(words: &[String]) -> String {
    quoted(std::iter::once("inbetween").chain(words.iter().map(String::as_str)))
}

/// `POST api/export`.
pub(super) fn start(body: &[u8], session: &Arc<Session>) -> Result<Value, Refusal> {
    let asked: Export = serde_json::from_slice(body).map_err(Refusal::bad)?;
    if asked.output.is_empty() || asked.output == "-" {
        return Err(Refusal::bad("name a file or a folder to write to"));
    }
    let words = asked.words(&session.file());
    let program = std::env::current_exe().map_err(Refusal::failed)?;
    let mut running = session.jobs.0.lock().unwrap_or_else(PoisonError::into_inner);
    if running.child.is_some() {
        return Err(Refusal::conflict(Problem::new(
            "an export is running; wait for it, or cancel it",
        )));
    }
    let mut child = Command::new(program)
        .args(&words)
        .arg("--progress=json")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(Refusal::failed)?;
    let lines = child.stderr.take();
    let child = Arc::new(Mutex::new(child));
    running.count += 1;
    running.is_cancelled = false;
    running.child = Some(Arc::clone(&child));
    let job = json!({
        "id": running.count, "output": asked.output, "command": command_line(&words),
        "done": 0, "total": null, "seconds": 0.0, "left": null, "state": "running", "message": "",
    });
    drop(running);
    session.tell_job(job.clone());
    let session_of_thread = Arc::clone(session);
    std::thread::spawn(move || {
        let session = session_of_thread;
        let lines = lines
            .into_iter()
            .flat_map(|lines| BufReader::new(lines).lines().map_while(Result::ok));
        follow(&session, job, lines, &child, Path::new(&asked.output));
    });
    Ok(session.state_json())
}

/// Reads what a render says until it ends.
fn follow(session: &Session, mut job: Value, lines: impl Iterator<Item = String>, child: &Mutex<Child>, output: &Path) {
    let mut said: Vec<String> = Vec::new();
    for line in lines {
        match serde_json::from_str::<Value>(&line) {
            Ok(Value::Object(progress)) => {
                for key in ["done", "total", "seconds", "left"] {
                    if let Some(value) = progress.get(key) {
                        job[key] = value.clone();
                    }
                }
            }
            _ => {
                said.push(line);
                if said.len() > MOST_LINES {
                    said.remove(0);
                }
                job["message"] = said.join("\n").into();
            }
        }
        session.tell_job(job.clone());
    }
    let status = child.lock().unwrap_or_else(PoisonError::into_inner).wait();
    let mut running = session.jobs.0.lock().unwrap_or_else(PoisonError::into_inner);
    running.child = None;
    let is_cancelled = std::mem::take(&mut running.is_cancelled);
    drop(running);
    let is_done = status.is_ok_and(|status| status.success());
    job["state"] = match (is_done, is_cancelled) {
        (true, _) => "done",
        (false, true) => "cancelled",
        (false, false) => "failed",
    }
    .into();
    if is_cancelled {
        // Beside a new file, what was left of unfinished ones is removed.
        let beside = if output.is_dir() {
            output.join("frame")
        } else {
            output.to_owned()
        };
        drop(PendingFile::create(&beside));
    }
    session.tell_job(job);
}

/// `POST api/export/cancel`.
pub(super) fn cancel(session: &Session) -> Result<Value, Refusal> {
    let mut running = session.jobs.0.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(child) = running.child.clone() else {
        return Err(Refusal::conflict(Problem::new("no export is running")));
    };
    running.is_cancelled = true;
    drop(running);
    // One that has ended already needs no end.
    let _ = child.lock().unwrap_or_else(PoisonError::into_inner).kill();
    Ok(session.state_json())
}

/// The body of `POST api/command`.
#[derive(Debug, Deserialize)]
#[serde(tag = "verb", rename_all = "lowercase")]
enum Asked {
    Frame { at: Vec<f64>, output: Option<String> },
    Weights { at: Vec<f64>, provider: Option<String> },
    Render(Export),
}

/// `POST api/command`.
pub(super) fn command(body: &[u8], session: &Session) -> Result<Value, Refusal> {
    let asked: Asked = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let scene = session.file().display().to_string();
    let at = |at: &[f64]| format!("--at={}", at.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
    let words = match &asked {
        Asked::Frame { at: place, output } => {
            let output = output.clone().unwrap_or_else(|| "frame.png".to_owned());
            vec!["frame".to_owned(), scene, at(place), "-o".to_owned(), output]
        }
        Asked::Weights { at: place, provider } => {
            let mut words = vec!["weights".to_owned(), scene, at(place)];
            words.extend(provider.iter().map(|provider| format!("--provider={provider}")));
            words
        }
        Asked::Render(export) => export.words(&session.file()),
    };
    Ok(json!({ "command": command_line(&words) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_line_can_be_given_to_a_shell() {
        let export = Export {
            output: "it's a walk.gif".to_owned(),
            format: None,
            size: Some([10, 20]),
            fps: Some(12.5),
            frames: Some("1-3".to_owned()),
            supersample: None,
            background: Some("#ff0000".to_owned()),
            max_error: None,
        };
        let words = export.words(Path::new("-scene.toml"));
        assert_eq!(
            command_line(&words),
            r"inbetween render ./-scene.toml -o 'it'\''s a walk.gif' --size=10x20 --fps=12.5 --frames=1-3 '--background=#ff0000'"
        );
    }
}
