//! Why something could not be written.

use std::path::{Path, PathBuf};

/// Why frames could not be encoded, or what takes their bytes refuses them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// What takes the bytes refuses them.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The encoder refuses.
    #[error("{0}")]
    Encoding(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// The format cannot hold it.
    #[error("{reason}")]
    Unsuitable {
        /// What the format cannot hold, and what to do.
        reason: String,
    },
}

impl WriteError {
    /// What the format cannot hold, and what to do.
    pub(super) fn unsuitable(reason: impl Into<String>) -> Self {
        Self::Unsuitable { reason: reason.into() }
    }

    /// The same about a file.
    #[must_use]
    pub fn at(self, path: &Path) -> ExportError {
        match self {
            Self::Unsuitable { reason } => ExportError::Unsuitable {
                path: path.to_owned(),
                reason,
            },
            other => ExportError::cannot_write(path, other),
        }
    }
}

impl From<gif::EncodingError> for WriteError {
    fn from(error: gif::EncodingError) -> Self {
        match error {
            gif::EncodingError::Io(error) => Self::Io(error),
            other => Self::Encoding(Box::new(other)),
        }
    }
}

impl From<png::EncodingError> for WriteError {
    fn from(error: png::EncodingError) -> Self {
        match error {
            png::EncodingError::IoError(error) => Self::Io(error),
            other => Self::Encoding(Box::new(other)),
        }
    }
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The system refuses.
    #[error("cannot write {}: {reason}; choose a place that exists, has room and that you may write to", path.display())]
    CannotWrite {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// Another program that is needed for it is missing or failed.
    #[error("cannot write {}: {reason}", path.display())]
    Program {
        /// The file.
        path: PathBuf,
        /// What happened, and what to do.
        reason: String,
    },
    /// The format cannot hold it.
    #[error("{}: {reason}", path.display())]
    Unsuitable {
        /// The file.
        path: PathBuf,
        /// What the format cannot hold, and what to do.
        reason: String,
    },
}

impl ExportError {
    pub(super) fn cannot_write(path: &Path, reason: impl std::fmt::Display) -> Self {
        Self::CannotWrite {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}
