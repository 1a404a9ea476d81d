//! The export that runs, to be watched and ended.

use std::process::Child;
use std::sync::{Arc, Mutex};

/// The export that runs, if any.
#[derive(Debug, Default)]
pub(super) struct Jobs(pub(super) Mutex<Running>);

#[derive(Debug, Default)]
pub(super) struct Running {
    pub(super) count: u64,
    pub(super) child: Option<Arc<Mutex<Child>>>,
    pub(super) is_cancelled: bool,
}
