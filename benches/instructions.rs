//! How many instructions a frame takes, which no other program on the machine can disturb:
//! `cargo bench --bench instructions`, half a minute. Needs valgrind, and says so where there is none.
//!
//! The program starts itself under callgrind twice, for few frames and for many, and divides the difference: what is
//! set up once falls out. Valgrind runs what the machine's AVX2 code path runs.

use std::error::Error;
use std::process::Command;

use inbetween::blend::{BlendOptions, RigidBlend, Stretch};
use strip::poses;

#[path = "common/strip.rs"]
mod strip;

/// Columns, rows and poses.
const CASES: [(usize, usize, usize); 3] = [(50, 40, 4), (50, 40, 16), (125, 80, 4)];
const FEW: usize = 2;
const MANY: usize = 22;

#[expect(clippy::print_stdout, reason = "the counts are what it is for")]
fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, columns, rows, count, frames] = &arguments[..] {
        return play(columns.parse()?, rows.parse()?, count.parse()?, frames.parse()?);
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("NOT MEASURED: there is no valgrind on this machine");
        return Ok(());
    }
    for (columns, rows, count) in CASES {
        let instructions = |frames| counted(columns, rows, count, frames);
        let a_frame = (instructions(MANY)? - instructions(FEW)?) / (MANY - FEW) as u64;
        let triangles = 2 * (columns - 1) * (rows - 1);
        println!(
            "{} vertices, {count} poses: {a_frame} instructions a frame, {:.1} a triangle",
            columns * rows,
            a_frame as f64 / triangles as f64
        );
    }
    Ok(())
}

/// Frames and nothing else.
fn play(columns: usize, rows: usize, count: usize, frames: usize) -> Result<(), Box<dyn Error>> {
    let mut options = BlendOptions::default();
    options.stretch = Stretch::Linear;
    let blend = RigidBlend::new(&poses(columns, rows, count), &options)?;
    let weights = vec![1.0 / count as f64; count];
    let (mut scratch, mut positions) = (blend.scratch(), Vec::new());
    for _ in 0..frames {
        blend.blend(&weights, &mut scratch, &mut positions)?;
    }
    Ok(())
}

/// The instructions of a run with this many frames.
fn counted(columns: usize, rows: usize, count: usize, frames: usize) -> Result<u64, Box<dyn Error>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe()?)
        .args([columns, rows, count, frames].map(|number| number.to_string()))
        .output()?;
    let text = String::from_utf8_lossy(&output.stderr);
    let collected = text.lines().find_map(|line| line.split("Collected :").nth(1));
    let number = collected.and_then(|number| number.trim().parse().ok());
    number.ok_or_else(|| format!("callgrind counted nothing:\n{text}").into())
}
