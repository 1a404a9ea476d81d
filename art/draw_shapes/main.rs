//! Models the two shapes in `data/shapes`: `cargo run --example draw_shapes -- data/shapes`.
//!
//! The forms there were made by this program and are committed beside it. Modelling them again gives the same bytes.
//!
//! - [`bendable`]: five forms of a blob that bends and gets thicker, after figures 4 and 5 of "Shape by Example";
//! - [`arm`]: eight forms of an arm with a hand on a skeleton, after figure 9.

mod arm;
mod bendable;
mod object;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: draw_shapes FOLDER")?);
    bendable::draw(&folder.join("bendable"))?;
    arm::draw(&folder.join("arm"))?;
    Ok(())
}
