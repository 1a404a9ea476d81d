//! Where a result goes: a file, or `-` for standard output.

use std::io::Write as _;
use std::path::Path;

use anyhow::Context as _;
use inbetween::export::PendingFile;

/// An opened target.
pub(crate) enum Output {
    /// Standard output.
    Standard,
    /// A file that appears when it is complete.
    File(PendingFile),
}

impl Output {
    /// Opens the target before any work is done.
    pub(crate) fn open(path: &Path) -> anyhow::Result<Self> {
        if path.as_os_str() == "-" {
            return Ok(Self::Standard);
        }
        Ok(Self::File(PendingFile::create(path)?))
    }

    /// Writes everything.
    pub(crate) fn write(self, bytes: &[u8]) -> anyhow::Result<()> {
        match self {
            Self::Standard => {
                let mut standard = std::io::stdout().lock();
                standard
                    .write_all(bytes)
                    .and_then(|()| standard.flush())
                    .context("cannot write to standard output")
            }
            Self::File(mut file) => {
                file.write_all(bytes)
                    .with_context(|| format!("cannot write {}", file.target().display()))?;
                Ok(file.commit()?)
            }
        }
    }
}

/// Reads a text file, named in the error.
pub(crate) fn read_text(path: &Path) -> anyhow::Result<String> {
    std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}
