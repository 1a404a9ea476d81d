//! A format of one's own: the walker as a stream of PAM pictures, which `ffmpeg -f pam_pipe -i walker.pam` makes a video of.
//! `cargo run --example exporter -- FOLDER` writes `walker.pam` there.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use inbetween::{Frame, Scene};

/// Writes frames to anything that takes bytes: a file, a socket, a process, a buffer in memory.
struct PamWriter<W: Write>(W);

impl<W: Write> PamWriter<W> {
    fn add(&mut self, frame: &Frame) -> io::Result<()> {
        let (width, height) = (frame.width, frame.height);
        writeln!(self.0, "P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH 4\nMAXVAL 255")?;
        writeln!(self.0, "TUPLTYPE RGB_ALPHA\nENDHDR")?;
        // Frames have colours multiplied by alpha; PAM, as most formats, wants them straight.
        self.0.write_all(&frame.straight())
    }

    fn finish(mut self) -> io::Result<()> {
        self.0.flush()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: exporter FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let scene = Scene::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data/walker/scene.toml"))?;
    let character = scene.character([160, 180], 1)?;
    let file = std::fs::File::create(folder.join("walker.pam"))?;
    let mut writer = PamWriter(BufWriter::new(file));
    for index in 0..scene.animation.frame_count() {
        writer.add(&character.frame(&scene.animation, index)?)?;
    }
    Ok(writer.finish()?)
}
