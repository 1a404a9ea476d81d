//! A file that appears whole or not at all.

use std::fs::File;
use std::io::{BufWriter, IntoInnerError, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::ExportError;

/// How the names of temporary files begin and end.
const PREFIX: &str = ".inbetween-";
const SUFFIX: &str = ".part";

/// A file under a temporary name beside its target. Dropped without [`PendingFile::commit`], it vanishes.
///
/// The temporary file is locked as long as it is written. One without a lock was left by a process that was killed:
/// [`PendingFile::create`] removes such files beside its own.
///
/// A target that is there and no file of a disk (a pipe, a device such as `/dev/null`) is written to at once: a rename would put a file in its
/// place.
#[derive(Debug)]
pub struct PendingFile {
    bytes: Destination,
    target: PathBuf,
}

/// Where bytes go until they are committed.
#[derive(Debug)]
enum Destination {
    Temporary(BufWriter<NamedTempFile>),
    Device(BufWriter<File>),
}

impl PendingFile {
    /// Opens a temporary file beside `target`; an existing target stays untouched until the commit.
    ///
    /// # Errors
    /// [`ExportError`] if the folder does not exist or cannot be written to, or if the target is a folder.
    pub fn create(target: &Path) -> Result<Self, ExportError> {
        remove_abandoned(folder_of(target));
        Self::create_among_others(target)
    }

    /// The same where files that were left behind have been removed already.
    pub(super) fn create_among_others(target: &Path) -> Result<Self, ExportError> {
        if target.is_dir() {
            return Err(ExportError::cannot_write(target, "it is a folder, but a file is meant"));
        }
        if target.file_name().is_none() {
            return Err(ExportError::cannot_write(target, "it names no file"));
        }
        if std::fs::metadata(target).is_ok_and(|there| !there.is_file()) {
            let device = File::options().write(true).open(target);
            let device = device.map_err(|error| ExportError::cannot_write(target, error))?;
            return Ok(Self {
                bytes: Destination::Device(BufWriter::new(device)),
                target: target.to_owned(),
            });
        }
        loop {
            let temporary = builder()
                .tempfile_in(folder_of(target))
                .map_err(|error| ExportError::cannot_write(target, error))?;
            // Where the system has no locks, nobody takes the file for a forgotten one either.
            let locked = temporary.as_file().lock();
            // Before it was locked, another process may have taken it for a forgotten one.
            if locked.is_ok() && !temporary.path().exists() {
                continue;
            }
            return Ok(Self {
                bytes: Destination::Temporary(BufWriter::new(temporary)),
                target: target.to_owned(),
            });
        }
    }

    /// The path the file will have.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// The path it has until then, for another program to write to.
    pub(super) fn temporary_path(&self) -> &Path {
        match &self.bytes {
            Destination::Temporary(temporary) => temporary.get_ref().path(),
            Destination::Device(_) => &self.target,
        }
    }

    /// Flushes, and renames the file to its target, replacing what is there.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses; the temporary file is removed.
    pub fn commit(self) -> Result<(), ExportError> {
        Self::commit_all([self])
    }

    /// Commits files that belong together: none gets its name before all are written.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses; then none of them is there.
    pub fn commit_all(files: impl IntoIterator<Item = Self>) -> Result<(), ExportError> {
        let flushed = |file: Self| -> Result<(Option<NamedTempFile>, PathBuf), ExportError> {
            let temporary = match file.bytes {
                Destination::Temporary(bytes) => bytes.into_inner().map(Some).map_err(IntoInnerError::into_error),
                Destination::Device(mut bytes) => bytes.flush().map(|()| None),
            };
            let refusal = |error| ExportError::cannot_write(&file.target, error);
            Ok((temporary.map_err(refusal)?, file.target))
        };
        let files = files.into_iter().map(flushed).collect::<Result<Vec<_>, _>>()?;
        let mut named: Vec<PathBuf> = Vec::new();
        for (temporary, target) in files {
            let Some(temporary) = temporary else { continue };
            if let Err(error) = temporary.persist(&target) {
                for other in named {
                    let _ = std::fs::remove_file(other);
                }
                return Err(ExportError::cannot_write(&target, error.error));
            }
            named.push(target);
        }
        Ok(())
    }

    /// A file that holds `bytes` and awaits its commit.
    #[cfg(feature = "shape3d")]
    pub(super) fn filled(target: &Path, bytes: &[u8]) -> Result<Self, ExportError> {
        let mut file = Self::create_among_others(target)?;
        file.write_all(bytes)
            .map_err(|error| ExportError::cannot_write(target, error))?;
        Ok(file)
    }

    /// Writes `bytes` as a whole file.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses.
    pub fn write_whole(target: &Path, bytes: &[u8]) -> Result<(), ExportError> {
        Self::create(target)?.fill(bytes)
    }

    /// Writes files that belong together, each whole: all of them or none.
    ///
    /// # Errors
    /// As [`Self::commit_all`].
    pub fn write_together<'a>(files: impl IntoIterator<Item = (PathBuf, &'a [u8])>) -> Result<(), ExportError> {
        let pending = files.into_iter().map(|(target, bytes)| {
            let mut file = Self::create(&target)?;
            file.write_all(bytes)
                .map_err(|error| ExportError::cannot_write(&target, error))?;
            Ok(file)
        });
        Self::commit_all(pending.collect::<Result<Vec<_>, ExportError>>()?)
    }

    /// Writes `bytes` and commits.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses; the temporary file is removed.
    pub fn fill(mut self, bytes: &[u8]) -> Result<(), ExportError> {
        self.write_all(bytes)
            .map_err(|error| ExportError::cannot_write(&self.target, error))?;
        self.commit()
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match &mut self.bytes {
            Destination::Temporary(temporary) => temporary.write(bytes),
            Destination::Device(device) => device.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match &mut self.bytes {
            Destination::Temporary(temporary) => temporary.flush(),
            Destination::Device(device) => device.flush(),
        }
    }
}

impl Seek for PendingFile {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        match &mut self.bytes {
            Destination::Temporary(temporary) => temporary.seek(place),
            Destination::Device(device) => device.seek(place),
        }
    }
}

fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Removes the temporary files in `folder` that nobody is writing any more.
pub(super) fn remove_abandoned(folder: &Path) {
    // What cannot be read or removed is left alone: it is in nobody's way.
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name
            .to_str()
            .is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if !is_ours || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        if let Ok(file) = File::options().write(true).open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Names that say what they are; the permissions any new file would have (temporary files are private by default).
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
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
    fn what_a_killed_process_left_is_removed_and_what_another_writes_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let left = folder.path().join(".inbetween-abc.part");
        std::fs::write(&left, b"half").expect("written");
        std::fs::write(folder.path().join("other.part"), b"not ours").expect("written");
        let mut first = PendingFile::create(&folder.path().join("a")).expect("writable");
        assert!(!left.exists());
        PendingFile::write_whole(&folder.path().join("b"), b"b").expect("written");
        first.write_all(b"a").expect("written");
        first.commit().expect("still there");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 3);
    }

    #[test]
    fn files_that_belong_together_appear_together() {
        let folder = tempfile::tempdir().expect("a folder");
        let [one, two] = ["one", "two"].map(|name| folder.path().join(name));
        let pending = [&one, &two].map(|target| PendingFile::create(target).expect("writable"));
        std::fs::create_dir(&two).expect("a folder in the way");
        PendingFile::commit_all(pending).expect_err("a folder is in the way");
        assert!(!one.exists());
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_written_to_and_stays_one() {
        use std::os::unix::fs::FileTypeExt as _;
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.expect("mkfifo").success());
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || std::fs::read(pipe).expect("readable"))
        };
        PendingFile::write_whole(&pipe, b"through").expect("written");
        assert_eq!(reader.join().expect("read"), b"through");
        assert!(std::fs::metadata(&pipe).expect("there").file_type().is_fifo());
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
