//! Numbered files in a folder: PNG, SVG or OBJ.

use std::path::{Path, PathBuf};

use super::pending::remove_abandoned;
use super::{ExportError, Label, PendingFile, png_bytes_with, svg_text_with};
use crate::render::Frame;
use crate::render::VectorFrame;

/// What the files of a sequence are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SequenceKind {
    /// Pixels.
    Png,
    /// Curves.
    Svg,
    /// Forms in space.
    Obj,
}

impl SequenceKind {
    fn suffix(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Obj => "obj",
        }
    }
}

/// A folder of files `NAME.0001.png`, `NAME.0002.png`, ...
#[derive(Debug)]
pub struct Sequence {
    folder: PathBuf,
    name: String,
    kind: SequenceKind,
    /// Whether the folder is ours to remove if nothing gets written.
    is_new: bool,
}

impl Sequence {
    /// Opens the folder, making it where needed, and proves that it can be written to.
    ///
    /// # Errors
    /// [`ExportError`] if it cannot.
    pub fn create(folder: &Path, name: &str, kind: SequenceKind) -> Result<Self, ExportError> {
        let is_new = !folder.exists();
        std::fs::create_dir_all(folder).map_err(|error| ExportError::cannot_write(folder, error))?;
        let sequence = Self {
            folder: folder.to_owned(),
            name: name.to_owned(),
            kind,
            is_new,
        };
        remove_abandoned(folder);
        PendingFile::create_among_others(&sequence.path(1))?;
        Ok(sequence)
    }

    /// The path of frame `number`, counted from 1.
    #[must_use]
    pub fn path(&self, number: usize) -> PathBuf {
        self.folder
            .join(format!("{}.{number:04}.{}", self.name, self.kind.suffix()))
    }

    /// Whether the file of frame `number` is there, whole and with this label. Forms carry none.
    #[must_use]
    pub fn has(&self, number: usize, label: &Label) -> bool {
        let path = self.path(number);
        match self.kind {
            SequenceKind::Png => label.is_on(&path),
            SequenceKind::Svg => label.is_on_svg(&path),
            SequenceKind::Obj => false,
        }
    }

    /// Writes frame `number`, counted from 1, with a label inside. Frames may be written in any order and from any thread.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses.
    pub fn write(&self, number: usize, frame: &Frame, label: &Label) -> Result<(), ExportError> {
        let path = self.path(number);
        let bytes = png_bytes_with(frame, label).map_err(|error| ExportError::Unsuitable {
            path: path.clone(),
            reason: error.to_string(),
        })?;
        PendingFile::create_among_others(&path)?.fill(&bytes)
    }

    /// Writes frame `number` of a sequence of SVG files, as [`Sequence::write`] does.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses.
    pub fn write_curves(&self, number: usize, frame: &VectorFrame, label: &Label) -> Result<(), ExportError> {
        let path = self.path(number);
        let text = svg_text_with(frame, label).map_err(|reason| ExportError::Unsuitable {
            path: path.clone(),
            reason: reason.to_string(),
        })?;
        PendingFile::create_among_others(&path)?.fill(text.as_bytes())
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
        drop(Sequence::create(&inner, "cat", SequenceKind::Png).expect("writable"));
        assert!(!inner.exists());
        let sequence = Sequence::create(&inner, "cat", SequenceKind::Png).expect("writable");
        sequence
            .write(7, &Frame::filled(2, 2, [1, 2, 3, 255]), &Label::new("a"))
            .expect("written");
        drop(sequence);
        assert!(inner.join("cat.0007.png").is_file());
        std::fs::write(inner.join(".inbetween-x.part"), b"left behind").expect("written");
        drop(Sequence::create(&inner, "cat", SequenceKind::Png).expect("writable"));
        assert_eq!(std::fs::read_dir(&inner).expect("a folder").count(), 1);
    }

    #[test]
    fn curves_are_found_again_by_their_label_if_they_are_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let sequence = Sequence::create(folder.path(), "cat", SequenceKind::Svg).expect("writable");
        let frame = VectorFrame {
            size: [4, 3],
            background: Some([1, 2, 3, 255]),
            nodes: Vec::new(),
        };
        let (label, other) = (Label::new("0123abcd"), Label::new("abcd"));
        assert!(!sequence.has(1, &label));
        sequence.write_curves(1, &frame, &label).expect("written");
        assert!(sequence.has(1, &label) && !sequence.has(1, &other));
        let path = folder.path().join("cat.0001.svg");
        let text = std::fs::read_to_string(&path).expect("there");
        std::fs::write(&path, &text[..text.len() - 1]).expect("written");
        assert!(!sequence.has(1, &label));
    }
}
