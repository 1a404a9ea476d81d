//! What tells a file from an older one of the same name.

use std::path::Path;
use std::time::SystemTime;

/// A file's length, and when it was written if the system knows.
pub(super) type Stamp = (u64, Option<SystemTime>);

/// The stamp of a file; `None` if it is not there.
pub(super) fn stamp(file: &Path) -> Option<Stamp> {
    let data = std::fs::metadata(file).ok()?;
    Some((data.len(), data.modified().ok()))
}
