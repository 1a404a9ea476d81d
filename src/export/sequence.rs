//! Numbered PNG files in a folder.

use std::path::{Path, PathBuf};

use super::pending::remove_abandoned;
use super::{ExportError, Label, PendingFile, png_bytes_with};
use crate::render::Frame;

/// A folder of files `NAME.0001.png`, `NAME.0002.png`, ...
#[derive(Debug)]
pub struct Sequence {
    folder: PathBuf,
    name: String,
    /// Whether the folder is ours to remove if nothing gets written.
    is_new: bool,
}

impl Sequence {
    /// Opens the folder, making it where needed, and proves that it can be written to.
    ///
    /// # Errors
    /// [`ExportError`] if it cannot.
    pub fn create(folder: &Path, name: &str) -> Result<Self, ExportError> {
        let is_new = !folder.exists();
        std::fs::create_dir_all(folder).map_err(|error| ExportError::cannot_write(folder, error))?;
        let sequence = Self {
            folder: folder.to_owned(),
            name: name.to_owned(),
            is_new,
        };
        remove_abandoned(folder);
        PendingFile::create_among_others(&sequence.path(1))?;
        Ok(sequence)
    }

    /// The path of frame `number`, counted from 1.
    #[must_use]
    pub fn path(&self, number: usize) -> PathBuf {
        self.folder.join(format!("{}.{number:04}.png", self.name))
    }

    /// Whether the file of frame `number` is there, whole and with this label.
    #[must_use]
    pub fn has(&self, number: usize, label: &Label) -> bool {
        label.is_on(&self.path(number))
    }

    /// Writes frame `number`, counted from 1, with a label inside. Frames may be written in any order and from any thread.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses.
    pub fn write(&self, number: usize, frame: &Frame, label: &Label) -> Result<(), ExportError> {
        let path = self.path(number);
        let bytes = png_bytes_with(frame, label).map_err(|reason| ExportError::Unsuitable {
            path: path.clone(),
            reason,
        })?;
        PendingFile::create_among_others(&path)?.fill(&bytes)
    }
}

impl Drop for Sequence {
    fn drop(&mut self) {
        if self.is_new {
            // Fails, as it should, if there is anything in the folder.
            let _ = std::fs::remove_dir(&self.folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_unused_folders_vanish() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("frames");
        drop(Sequence::create(&inner, "cat").expect("writable"));
        assert!(!inner.exists());
        let sequence = Sequence::create(&inner, "cat").expect("writable");
        sequence
            .write(7, &Frame::filled(2, 2, [1, 2, 3, 255]), &Label::new("a"))
            .expect("written");
        drop(sequence);
        assert!(inner.join("cat.0007.png").is_file());
        std::fs::write(inner.join(".inbetween-x.part"), b"left behind").expect("written");
        drop(Sequence::create(&inner, "cat").expect("writable"));
        assert_eq!(std::fs::read_dir(&inner).expect("a folder").count(), 1);
    }
}
