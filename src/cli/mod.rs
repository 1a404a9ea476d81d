//! Arguments and messages, one file a verb.
//!
//! Exit codes: 0 done, 1 bad input or failed work, 2 wrong usage. Results go to files or standard output, everything
//! else to standard error.

mod add;
mod answer;
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
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use self::answer::{Outcome, Told};

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
    /// End with one JSON object on the last line of standard error: what was made, notes, and the error with its kind, pose, place and remedy
    #[arg(long, global = true)]
    json: bool,
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

impl Verb {
    /// What it is called.
    fn name(&self) -> &'static str {
        match self {
            Self::New(_) => "new",
            Self::Add(_) => "add",
            Self::Separate(_) => "separate",
            Self::Render(_) => "render",
            Self::Frame(_) => "frame",
            Self::Map(_) => "map",
            Self::Triangulate(_) => "triangulate",
            Self::Blend(_) => "blend",
            Self::Weights(_) => "weights",
            Self::Reach(_) => "reach",
            Self::Check(_) => "check",
            Self::Show(_) => "show",
            #[cfg(feature = "explorer")]
            Self::Explore(_) => "explore",
            Self::Shape(_) => "shape",
        }
    }

    /// The file or folder that it makes, `-` for standard output; `None` if it makes nothing.
    fn makes(&self) -> Option<PathBuf> {
        let scene_in = |folder: &Path| folder.join("scene.toml");
        Some(match self {
            Self::New(verb) => scene_in(&verb.dir),
            Self::Add(verb) => verb.scene.clone(),
            Self::Separate(verb) => scene_in(&verb.output),
            Self::Render(verb) => verb.output.clone(),
            Self::Frame(verb) => verb.output.clone(),
            Self::Map(verb) => verb.output.clone(),
            Self::Triangulate(verb) => verb.output.clone(),
            Self::Blend(verb) => verb.output.clone(),
            Self::Weights(verb) => verb.output.clone(),
            Self::Reach(verb) => verb.output.clone(),
            Self::Show(verb) => verb.output.clone(),
            Self::Shape(verb) => verb.output().to_owned(),
            Self::Check(_) => return None,
            #[cfg(feature = "explorer")]
            Self::Explore(_) => return None,
        })
    }
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
    pub(crate) fn notes<N: Into<Told>>(self, notes: impl IntoIterator<Item = N>) {
        for note in notes {
            let note = note.into();
            self.print(&format!("note: {}", note.text));
            answer::keep_note(note);
        }
    }

    /// Prints a line to standard error, unless quiet.
    pub(crate) fn note(self, line: &str) {
        self.print(line);
        answer::keep_line(line);
    }

    fn print(self, line: &str) {
        if self == Self::Normal {
            // Nobody listens: nothing to be done.
            let _ = writeln!(std::io::stderr(), "{line}");
        }
    }
}

/// Runs the command line.
pub(crate) fn run() -> ExitCode {
    fail_on_long_files();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return refused(&error),
    };
    let verbosity = if arguments.quiet {
        Verbosity::Quiet
    } else {
        Verbosity::Normal
    };
    let (name, makes) = (arguments.verb.name(), arguments.verb.makes());
    let answer = |outcome: Outcome<'_>| {
        if arguments.json {
            let _ = writeln!(std::io::stderr(), "{}", answer::in_json(name, &outcome));
        }
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
    let tell = |message: &str| {
        let _ = writeln!(std::io::stderr(), "inbetween: {message}");
    };
    match outcome {
        Ok(()) => {
            answer(Outcome::Done(makes.as_deref()));
            ExitCode::SUCCESS
        }
        Err(Failure::Work(error)) => {
            let message = told_once(&error);
            tell(&message);
            answer(Outcome::Failed(&error, &message));
            ExitCode::from(1)
        }
        Err(Failure::Usage(message)) => {
            tell(&message);
            answer(Outcome::Usage(&message));
            ExitCode::from(2)
        }
    }
}

/// Tells what is wrong with the command line, or what was asked about it.
fn refused(error: &clap::Error) -> ExitCode {
    let _ = error.print();
    let wants_json = std::env::args_os().any(|argument| argument == "--json");
    if error.use_stderr() && wants_json {
        let text = error.render().to_string();
        let text = text.trim_start_matches("error: ").trim_end();
        let verb = std::env::args()
            .nth(1)
            .filter(|word| !word.starts_with('-'))
            .unwrap_or_default();
        let _ = writeln!(std::io::stderr(), "{}", answer::in_json(&verb, &Outcome::Usage(text)));
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
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
