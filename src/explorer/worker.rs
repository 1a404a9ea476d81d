//! What takes longer than a request may wait.

use std::sync::Arc;

use inbetween::pipeline::{DrawingFiles, Workbench};

use super::problem::Problem;
use super::session::Session;

/// Computes what is wanted, the newest first, for as long as the process lives.
pub(crate) fn run(session: &Session) {
    loop {
        let (wanted, shown) = session.next_wanted();
        let make = || match &shown.bench {
            Some(bench) => bench.edited(&wanted.scene, DrawingFiles::Unchanged),
            None => Workbench::new(&wanted.scene),
        };
        let made = std::panic::catch_unwind(std::panic::AssertUnwindSafe(make));
        let made = match made {
            Ok(Ok(bench)) => Ok(Arc::new(bench)),
            Ok(Err(error)) => Err(Problem::from(&error)),
            Err(_) => Err(Problem::new("this scene failed inside inbetween; undo the last edit")),
        };
        session.show(&wanted, made);
    }
}
