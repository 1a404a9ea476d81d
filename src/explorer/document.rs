//! The scene's text: what stands in the file, what is being tried, what can be undone.
//!
//! Every edit that is taken is saved at once, atomically, unless the file on the disk is no longer the one that was read or
//! written last: then there is a conflict, and the artist says which of the two is meant.

use std::io;
use std::path::{Path, PathBuf};

use inbetween::export::PendingFile;

/// Steps that can be undone.
const MOST_STEPS: usize = 500;

/// One step of undo or redo.
#[derive(Debug, Clone)]
struct Step {
    label: String,
    /// The text to go back, or forth, to.
    text: String,
    /// Edits with the same word, one right after the other, are one step.
    merge: Option<String>,
}

/// The text of a scene and its past.
#[derive(Debug)]
pub(crate) struct Document {
    file: PathBuf,
    /// Without what is being tried.
    text: String,
    /// What a drag shows in its place.
    tried: Option<String>,
    /// The file's bytes, as they were read or written last; `None` if it could not be read.
    on_disk: Option<Vec<u8>>,
    past: Vec<Step>,
    future: Vec<Step>,
    save_error: Option<String>,
    is_in_conflict: bool,
    place: Place,
}

/// Where the file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Where the artist wants it.
    Kept,
    /// In a temporary folder, until the artist names another.
    Temporary,
}

/// What a look at the disk found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outside {
    /// Nothing has to be done.
    Same,
    /// The text was taken from the file.
    Taken,
    /// The file has changed, and so has what is here.
    Conflict,
}

impl Document {
    /// Opens a file. If it cannot be read, there is no text, and it may appear later.
    pub(crate) fn open(file: &Path, place: Place) -> Self {
        let on_disk = std::fs::read(file).ok();
        let text = on_disk.clone().and_then(|bytes| String::from_utf8(bytes).ok());
        Self {
            file: file.to_owned(),
            text: text.unwrap_or_default(),
            tried: None,
            on_disk,
            past: Vec::new(),
            future: Vec::new(),
            save_error: None,
            is_in_conflict: false,
            place,
        }
    }

    /// The scene file.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    pub(crate) fn is_temporary(&self) -> bool {
        self.place == Place::Temporary
    }

    /// Goes on with another file, which the artist has named and which has the text.
    pub(crate) fn move_to(&mut self, file: PathBuf) {
        self.tried = None;
        self.on_disk = Some(self.text.clone().into_bytes());
        (self.file, self.place) = (file, Place::Kept);
        (self.save_error, self.is_in_conflict) = (None, false);
    }

    /// What is shown.
    pub(crate) fn text(&self) -> &str {
        self.tried.as_deref().unwrap_or(&self.text)
    }

    /// What edits are applied to.
    pub(crate) fn base(&self) -> &str {
        &self.text
    }

    pub(crate) fn is_dragging(&self) -> bool {
        self.tried.is_some()
    }

    pub(crate) fn is_in_conflict(&self) -> bool {
        self.is_in_conflict
    }

    pub(crate) fn save_error(&self) -> Option<&str> {
        self.save_error.as_deref()
    }

    /// Whether the file has what is shown.
    pub(crate) fn is_saved(&self) -> bool {
        self.tried.is_none() && !self.is_in_conflict && self.on_disk.as_deref() == Some(self.text.as_bytes())
    }

    /// What would be undone, and redone.
    pub(crate) fn labels(&self) -> [Option<&str>; 2] {
        [&self.past, &self.future].map(|steps| steps.last().map(|step| step.label.as_str()))
    }

    /// Shows a text that is being tried.
    pub(crate) fn try_out(&mut self, text: String) {
        self.tried = Some(text);
    }

    /// Ends a trial.
    pub(crate) fn cancel(&mut self) {
        self.tried = None;
    }

    /// Takes an edit, and saves it.
    pub(crate) fn take(&mut self, text: String, label: &str, merge: Option<&str>) {
        self.tried = None;
        if text == self.text {
            return;
        }
        let before = std::mem::replace(&mut self.text, text);
        self.future.clear();
        let continues = merge.is_some() && self.past.last().is_some_and(|step| step.merge.as_deref() == merge);
        if !continues {
            self.past.push(Step {
                label: label.to_owned(),
                text: before,
                merge: merge.map(str::to_owned),
            });
            if self.past.len() > MOST_STEPS {
                self.past.remove(0);
            }
        }
        self.save();
    }

    /// Goes one step back. `false` if there is none.
    pub(crate) fn undo(&mut self) -> bool {
        self.tried = None;
        let Some(step) = self.past.pop() else { return false };
        let text = std::mem::replace(&mut self.text, step.text);
        self.future.push(Step {
            label: step.label,
            text,
            merge: None,
        });
        self.save();
        true
    }

    /// Goes one step forth again.
    pub(crate) fn redo(&mut self) -> bool {
        self.tried = None;
        let Some(step) = self.future.pop() else { return false };
        let text = std::mem::replace(&mut self.text, step.text);
        self.past.push(Step {
            label: step.label,
            text,
            merge: None,
        });
        self.save();
        true
    }

    /// Writes the text, if the file is still the one that was read or written last.
    pub(crate) fn save(&mut self) {
        let found = std::fs::read(&self.file).ok();
        if found == self.on_disk {
            self.write();
        } else {
            self.is_in_conflict = true;
        }
    }

    /// Writes the text, whatever the file is now.
    fn write(&mut self) {
        match write_whole(&self.file, self.text.as_bytes()) {
            Ok(()) => {
                self.on_disk = Some(self.text.clone().into_bytes());
                (self.save_error, self.is_in_conflict) = (None, false);
            }
            Err(error) => self.save_error = Some(error.to_string()),
        }
    }

    /// Looks whether the file was changed by someone else, and takes its text if nothing here is in the way.
    pub(crate) fn look(&mut self) -> Outside {
        // One that is being replaced may be missing for a moment; the next look will find it.
        let Ok(found) = std::fs::read(&self.file) else {
            return Outside::Same;
        };
        if self.on_disk.as_ref() == Some(&found) || self.is_in_conflict {
            return Outside::Same;
        }
        let is_free = self.tried.is_none() && (self.on_disk.is_none() || self.is_saved());
        if !is_free {
            self.is_in_conflict = true;
            return Outside::Conflict;
        }
        self.accept(found);
        Outside::Taken
    }

    fn accept(&mut self, found: Vec<u8>) {
        let text = String::from_utf8_lossy(&found).into_owned();
        let before = std::mem::replace(&mut self.text, text);
        if self.on_disk.is_some() && before != self.text {
            self.past.push(Step {
                label: "change from outside".to_owned(),
                text: before,
                merge: None,
            });
            self.future.clear();
        }
        self.on_disk = Some(found);
        (self.save_error, self.is_in_conflict) = (None, false);
    }

    /// Ends a conflict: what is here is written.
    pub(crate) fn keep_mine(&mut self) {
        self.write();
    }

    /// Ends a conflict: what is in the file is read; what was here can be had back by undo.
    pub(crate) fn take_theirs(&mut self) -> io::Result<()> {
        let found = std::fs::read(&self.file)?;
        self.tried = None;
        self.accept(found);
        Ok(())
    }
}

/// Replaces a file in one step. A link stays a link, and permissions stay.
fn write_whole(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let target = file.canonicalize().unwrap_or_else(|_| file.to_owned());
    let permissions = std::fs::metadata(&target).ok().map(|data| data.permissions());
    if permissions.as_ref().is_some_and(std::fs::Permissions::readonly) {
        anyhow::bail!("cannot write {}: it is read-only", target.display());
    }
    PendingFile::write_whole(&target, bytes)?;
    if let Some(permissions) = permissions {
        // The text is saved already, whether or not they can be set.
        let _ = std::fs::set_permissions(&target, permissions);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> (tempfile::TempDir, PathBuf, Document) {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("scene.toml");
        std::fs::write(&file, text).expect("written");
        let document = Document::open(&file, Place::Kept);
        (folder, file, document)
    }

    fn read(file: &Path) -> String {
        std::fs::read_to_string(file).expect("there")
    }

    #[test]
    fn undo_gives_the_bytes_back_and_redo_the_edit() {
        let (_folder, file, mut document) = document("a # first\r\n");
        document.take("b".to_owned(), "to b", None);
        assert_eq!((read(&file).as_str(), document.labels()), ("b", [Some("to b"), None]));
        document.try_out("c".to_owned());
        assert_eq!(
            (document.text(), document.is_saved(), read(&file).as_str()),
            ("c", false, "b")
        );
        document.try_out("d".to_owned());
        document.take("d".to_owned(), "to d", None);
        assert!(document.undo() && document.undo() && !document.undo());
        assert_eq!(read(&file), "a # first\r\n");
        assert!(document.is_saved() && document.redo());
        assert_eq!(
            (read(&file).as_str(), document.labels()),
            ("b", [Some("to b"), Some("to d")])
        );
        document.take("e".to_owned(), "to e", None);
        assert!(!document.redo());
    }

    #[test]
    fn edits_of_one_kind_can_be_one_step() {
        let (_folder, file, mut document) = document("0");
        for text in ["1", "2", "3"] {
            document.take(text.to_owned(), "nudge", Some("nudge"));
        }
        document.take("4".to_owned(), "other", None);
        assert!(document.undo());
        assert_eq!(read(&file), "3");
        assert!(document.undo());
        assert_eq!(read(&file), "0");
    }

    #[test]
    fn what_changes_outside_is_taken_or_asked_about() {
        let (_folder, file, mut document) = document("a");
        assert_eq!(document.look(), Outside::Same);
        std::fs::write(&file, "b").expect("written");
        assert_eq!((document.look(), document.text()), (Outside::Taken, "b"));
        assert!(document.undo());
        assert_eq!(read(&file), "a");
        document.try_out("mine".to_owned());
        std::fs::write(&file, "theirs").expect("written");
        assert_eq!(document.look(), Outside::Conflict);
        document.take("mine".to_owned(), "edit", None);
        assert_eq!((document.is_in_conflict(), read(&file).as_str()), (true, "theirs"));
        document.keep_mine();
        assert_eq!((document.is_in_conflict(), read(&file).as_str()), (false, "mine"));
        // Saving notices by itself, too.
        std::fs::write(&file, "again").expect("written");
        document.take("mine 2".to_owned(), "edit", None);
        assert!(document.is_in_conflict());
        document.take_theirs().expect("readable");
        assert_eq!((document.text(), document.is_saved()), ("again", true));
        assert!(document.undo());
        assert_eq!(read(&file), "mine 2");
    }
}
