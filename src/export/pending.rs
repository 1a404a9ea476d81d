//! A file that appears whole or not at all.

use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::ExportError;

/// A file under a temporary name beside its target. Dropped without [`PendingFile::commit`], it vanishes.
#[derive(Debug)]
pub struct PendingFile {
    temporary: BufWriter<NamedTempFile>,
    target: PathBuf,
}

impl PendingFile {
    /// Opens a temporary file beside `target`; an existing target stays untouched until the commit.
    ///
    /// # Errors
    /// [`ExportError`] if the folder does not exist or cannot be written to, or if the target is a folder.
    pub fn create(target: &Path) -> Result<Self, ExportError> {
        if target.is_dir() {
            return Err(ExportError::cannot_write(target, "it is a folder, but a file is meant"));
        }
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        if target.file_name().is_none() {
            return Err(ExportError::cannot_write(target, "it names no file"));
        }
        let temporary = builder()
            .tempfile_in(folder)
            .map_err(|error| ExportError::cannot_write(target, error))?;
        Ok(Self {
            temporary: BufWriter::new(temporary),
            target: target.to_owned(),
        })
    }

    /// The path the file will have.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Flushes, and renames the file to its target, replacing what is there.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses; the temporary file is removed.
    pub fn commit(self) -> Result<(), ExportError> {
        let temporary = self
            .temporary
            .into_inner()
            .map_err(|error| ExportError::cannot_write(&self.target, error.error()))?;
        temporary
            .persist(&self.target)
            .map(|_: File| ())
            .map_err(|error| ExportError::cannot_write(&self.target, error.error))
    }

    /// Writes `bytes` as a whole file.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses.
    pub fn write_whole(target: &Path, bytes: &[u8]) -> Result<(), ExportError> {
        let mut pending = Self::create(target)?;
        pending
            .write_all(bytes)
            .map_err(|error| ExportError::cannot_write(target, error))?;
        pending.commit()
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.temporary.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.temporary.flush()
    }
}

impl Seek for PendingFile {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        self.temporary.seek(place)
    }
}

/// Names that say what they are; the permissions any new file would have (temporary files are private by default).
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".inbetween-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("a.txt");
        let mut pending = PendingFile::create(&target).expect("writable");
        pending.write_all(b"half").expect("written");
        drop(pending);
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
        PendingFile::write_whole(&target, b"whole").expect("written");
        PendingFile::write_whole(&target, b"again").expect("replaced");
        assert_eq!(std::fs::read(&target).expect("there"), b"again");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn a_folder_that_is_none_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        std::fs::write(&file, b"").expect("written");
        for target in [
            file.join("x.png"),
            folder.path().join("none/x.png"),
            folder.path().to_owned(),
        ] {
            let error = PendingFile::create(&target).expect_err("it is refused");
            assert!(error.to_string().contains(&target.display().to_string()), "{error}");
        }
    }
}
