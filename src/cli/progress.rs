//! Progress: a bar on a terminal, plain lines elsewhere, or lines of JSON for a program that listens.

use std::io::{IsTerminal as _, Write as _};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::Verbosity;

/// The time between two plain lines.
const BETWEEN_LINES: Duration = Duration::from_secs(5);
/// The time between two lines of JSON.
const BETWEEN_JSON: Duration = Duration::from_millis(100);

/// How progress is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub(crate) enum ProgressKind {
    /// A bar on a terminal, plain lines elsewhere
    #[default]
    Auto,
    /// Lines such as {"done":12,"total":48,"seconds":1.5,"left":4.5} on standard error
    Json,
    /// Not at all
    None,
}

/// Counts frames, from any thread.
pub(crate) struct Progress {
    kind: Kind,
    total: usize,
    state: Mutex<State>,
}

enum Kind {
    Silent,
    Lines,
    Json,
    Bar(ProgressBar),
}

struct State {
    done: usize,
    start: Instant,
    told: Instant,
}

impl Progress {
    /// Progress over `total` frames, of which the first begins now.
    pub(crate) fn new(total: usize, kind: ProgressKind, verbosity: Verbosity) -> Self {
        let kind = match kind {
            _ if verbosity == Verbosity::Quiet => Kind::Silent,
            ProgressKind::None => Kind::Silent,
            ProgressKind::Json => Kind::Json,
            ProgressKind::Auto if std::io::stderr().is_terminal() => {
                let bar = ProgressBar::new(total as u64);
                if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} frames, {eta} left") {
                    bar.set_style(style);
                }
                bar.tick();
                Kind::Bar(bar)
            }
            ProgressKind::Auto => Kind::Lines,
        };
        let now = Instant::now();
        let progress = Self {
            kind,
            total,
            state: Mutex::new(State {
                done: 0,
                start: now,
                told: now,
            }),
        };
        if matches!(progress.kind, Kind::Json) {
            tell(&json(0, total, 0.0));
        }
        progress
    }

    /// One more frame is done.
    pub(crate) fn advance(&self) {
        let pause = match &self.kind {
            Kind::Silent => return,
            Kind::Bar(bar) => return bar.inc(1),
            Kind::Lines => BETWEEN_LINES,
            Kind::Json => BETWEEN_JSON,
        };
        // Held while the line is written, so that lines come in order.
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.done += 1;
        let now = Instant::now();
        if state.done < self.total && now - state.told < pause {
            return;
        }
        state.told = now;
        let (done, seconds) = (state.done, (now - state.start).as_secs_f64());
        tell(&match self.kind {
            Kind::Json => json(done, self.total, seconds),
            _ => line(done, self.total, seconds),
        });
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Kind::Bar(bar) = &self.kind {
            bar.finish_and_clear();
        }
    }
}

fn tell(line: &str) {
    // Nobody listens: nothing to be done.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The seconds that are left if the rest goes as what is done.
fn left(done: usize, total: usize, seconds: f64) -> Option<f64> {
    (done > 0).then(|| seconds / done as f64 * (total - done) as f64)
}

fn line(done: usize, total: usize, seconds: f64) -> String {
    let percent = 100 * done / total.max(1);
    match left(done, total, seconds) {
        Some(left) if done < total => {
            format!("{done} of {total} frames ({percent} %), {} left", spoken(left))
        }
        _ => format!("{done} of {total} frames ({percent} %) in {}", spoken(seconds)),
    }
}

fn json(done: usize, total: usize, seconds: f64) -> String {
    let rounded = |seconds: f64| (seconds * 1000.0).round() / 1000.0;
    let left = left(done, total, seconds).map(rounded);
    serde_json::json!({ "done": done, "total": total, "seconds": rounded(seconds), "left": left }).to_string()
}

fn spoken(seconds: f64) -> String {
    match seconds.ceil() as u64 {
        s if s < 100 => format!("{s} s"),
        s if s < 6000 => format!("{} min", s.div_ceil(60)),
        s => format!("{} h {} min", s / 3600, s / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_told() {
        assert_eq!(line(12, 48, 1.5), "12 of 48 frames (25 %), 5 s left");
        assert_eq!(line(48, 48, 6.0), "48 of 48 frames (100 %) in 6 s");
        assert_eq!(json(12, 48, 1.5), r#"{"done":12,"left":4.5,"seconds":1.5,"total":48}"#);
        assert_eq!(json(0, 48, 0.0), r#"{"done":0,"left":null,"seconds":0.0,"total":48}"#);
        assert_eq!(
            (spoken(300.0), spoken(7260.0)),
            ("5 min".to_owned(), "2 h 1 min".to_owned())
        );
    }
}
