//! The command `inbetween`.

mod cli;
#[cfg(feature = "explorer")]
mod explorer;
mod tables;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
