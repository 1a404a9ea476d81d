//! Progress: a bar on a terminal, a plain line now and then elsewhere.

use std::io::{IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

use super::Verbosity;

/// Frames between two plain lines.
const FRAMES_A_LINE: usize = 50;

/// Counts frames, from any thread.
pub(crate) struct Progress {
    kind: Kind,
    done: AtomicUsize,
    total: usize,
}

enum Kind {
    Silent,
    Lines,
    Bar(ProgressBar),
}

impl Progress {
    /// Progress over `total` frames.
    pub(crate) fn new(total: usize, verbosity: Verbosity) -> Self {
        let kind = if verbosity == Verbosity::Quiet {
            Kind::Silent
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(total as u64);
            if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} frames, {eta} left") {
                bar.set_style(style);
            }
            Kind::Bar(bar)
        } else {
            Kind::Lines
        };
        Self {
            kind,
            done: AtomicUsize::new(0),
            total,
        }
    }

    /// One more frame is done.
    pub(crate) fn advance(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        match &self.kind {
            Kind::Silent => {}
            Kind::Lines if done.is_multiple_of(FRAMES_A_LINE) || done == self.total => {
                let _ = writeln!(std::io::stderr(), "{done} of {} frames", self.total);
            }
            Kind::Lines => {}
            Kind::Bar(bar) => bar.inc(1),
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Kind::Bar(bar) = &self.kind {
            bar.finish_and_clear();
        }
    }
}
