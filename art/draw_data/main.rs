//! Draws the six scenes in `data/`: `cargo run -p inbetween-art --bin draw_data -- data`.
//!
//! The pictures there were made by this program and are committed beside it. Drawing them again gives the same bytes.
//!
//! - [`walker`]: five bitmaps of one figure, drawn from a skeleton;
//! - [`snake`]: five vector drawings of one body, bent along five centre lines;
//! - [`face`]: four vector drawings of one head, two expressions by two turns;
//! - [`clown`]: two bitmaps of one figure, and four poses that are these two deformed;
//! - [`bear`]: six vector drawings in groups, one a layer: a body, two arms, and a flower that is in three of them;
//! - [`wizard`]: three scans of one figure in ink on paper, with a hat that floats, sparks and a drop.
//!
//! The walker, the clown and the wizard are [`figure`]s.

mod bear;
mod canvas;
mod clown;
mod curves;
mod face;
mod figure;
mod layered;
mod scan;
mod scene;
mod snake;
mod svg;
mod walker;
mod wizard;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: draw_data FOLDER")?);
    walker::draw(&folder.join("walker"))?;
    snake::draw(&folder.join("snake"))?;
    face::draw(&folder.join("face"))?;
    clown::draw(&folder.join("clown"))?;
    bear::draw(&folder.join("bear"))?;
    wizard::draw(&folder.join("wizard"))?;
    Ok(())
}
