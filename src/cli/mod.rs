//! Arguments and messages, one file a verb.
//!
//! Exit codes: 0 done, 1 bad input or failed work, 2 wrong usage. Results go to files or standard output, everything
//! else to standard error.

mod add;
mod blend;
mod certificate;
mod check;
#[cfg(feature = "explorer")]
mod explore;
mod frame;
mod frames;
mod layer;
mod map;
mod new;
mod output;
mod progress;
mod reach;
mod render;
mod separate;
mod shape;
mod show;
mod stage_table;
mod triangulate;
mod values;
mod weights;

use std::io::Write as _;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Everything a stranger needs first.
const AFTER_HELP: &str = "\
Start with a folder of drawings of one character in several poses (PNG with a transparent or plain background):
  inbetween new cat drawings/*.png         writes cat/scene.toml
  inbetween render cat/scene.toml -o cat.gif
  inbetween show cat/scene.toml -o cat.png    how the drawings were matched, meshed and weighted
`inbetween help VERB` explains a verb.";

#[derive(Parser)]
#[command(name = "inbetween", version, about = "N-way morphing for 2D animation", after_help = AFTER_HELP)]
struct Arguments {
    /// Print nothing but errors
    #[arg(long, global = true)]
    quiet: bool,
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    New(new::Arguments),
    Add(add::Arguments),
    Separate(separate::Arguments),
    Render(render::Arguments),
    Frame(frame::Arguments),
    Map(map::Arguments),
    Triangulate(triangulate::Arguments),
    Blend(blend::Arguments),
    Weights(weights::Arguments),
    Reach(reach::Arguments),
    Check(check::Arguments),
    Show(show::Arguments),
    #[cfg(feature = "explorer")]
    Explore(explore::Arguments),
    Shape(shape::Arguments),
}

/// Why a verb did not do its work.
pub(crate) enum Failure {
    /// The command line asks for something that does not exist: exit code 2.
    Usage(String),
    /// Bad input or failed work: exit code 1.
    Work(anyhow::Error),
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Work(error.into())
    }
}

/// Messages for the person at the terminal.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verbosity {
    /// Errors only.
    Quiet,
    /// Notes and progress, too.
    Normal,
}

impl Verbosity {
    /// Prints what the artist should know, a line each, unless quiet.
    pub(crate) fn notes<N: std::fmt::Display>(self, notes: impl IntoIterator<Item = N>) {
        for note in notes {
            self.note(&format!("note: {note}"));
        }
    }

    /// Prints a line to standard error, unless quiet.
    pub(crate) fn note(self, line: &str) {
        if self == Self::Normal {
            // Nobody listens: nothing to be done.
            let _ = writeln!(std::io::stderr(), "{line}");
        }
    }
}

/// Runs the command line.
pub(crate) fn run() -> ExitCode {
    fail_on_long_files();
    let arguments = Arguments::parse();
    let verbosity = if arguments.quiet {
        Verbosity::Quiet
    } else {
        Verbosity::Normal
    };
    let outcome = match arguments.verb {
        Verb::New(verb) => new::run(&verb, verbosity),
        Verb::Add(verb) => add::run(&verb, verbosity),
        Verb::Separate(verb) => separate::run(&verb, verbosity),
        Verb::Render(verb) => render::run(&verb, verbosity),
        Verb::Frame(verb) => frame::run(&verb, verbosity),
        Verb::Map(verb) => map::run(&verb, verbosity),
        Verb::Triangulate(verb) => triangulate::run(&verb),
        Verb::Blend(verb) => blend::run(&verb, verbosity),
        Verb::Weights(verb) => weights::run(&verb),
        Verb::Reach(verb) => reach::run(&verb),
        Verb::Check(verb) => check::run(&verb),
        Verb::Show(verb) => show::run(&verb, verbosity),
        #[cfg(feature = "explorer")]
        Verb::Explore(verb) => explore::run(&verb, verbosity),
        Verb::Shape(verb) => shape::run(&verb, verbosity),
    };
    let (code, message) = match outcome {
        Ok(()) => return ExitCode::SUCCESS,
        Err(Failure::Work(error)) => (1, told_once(&error)),
        Err(Failure::Usage(message)) => (2, message),
    };
    let _ = writeln!(std::io::stderr(), "inbetween: {message}");
    ExitCode::from(code)
}

/// A file that grows beyond what the system allows (`ulimit -f`) is an error that is told, not the end of the process.
fn fail_on_long_files() {
    #[cfg(unix)]
    {
        // Any handler makes the write fail; nobody looks at the flag.
        let flag = std::sync::Arc::default();
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, flag);
    }
}

/// The error and its causes, left out where the text above already says them.
fn told_once(error: &anyhow::Error) -> String {
    let mut message = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if message.is_empty() {
            message = cause;
        } else if !message.contains(&cause) {
            message.push_str(": ");
            message.push_str(&cause);
        }
    }
    message
}
