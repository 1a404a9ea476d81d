//! A hundred walkers, each at a place of its own in the pose space, blended in one call: `cargo run --example crowd -- FOLDER` writes
//! `crowd.csv` there, a line a vertex: character, x, y.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use inbetween::{Build, Point, Scene, WeightProvider as _};

const CHARACTERS: usize = 100;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: crowd FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let scene = Scene::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data/walker/scene.toml"))?;
    // Meshes, factors and weights, once for all characters; nothing is painted, so no picture is prepared.
    let build = Build::new(&scene.spec()?)?;
    let blend = build.layers()[0].blend();
    let mut weights = Vec::new();
    for k in 0..CHARACTERS {
        let turn = std::f64::consts::TAU * k as f64 / CHARACTERS as f64;
        weights.extend(build.weights().weights_at(&[0.8 * turn.cos(), 0.8 * turn.sin()])?);
    }
    let mut positions = vec![Point::zeros(); CHARACTERS * blend.vertex_count()];
    let report = blend.blend_crowd(&weights, &mut blend.crowd_scratch(), &mut positions)?;
    let mut file = std::io::BufWriter::new(std::fs::File::create(folder.join("crowd.csv"))?);
    for (character, vertices) in positions.chunks_exact(blend.vertex_count()).enumerate() {
        for vertex in vertices {
            writeln!(file, "{character},{:.3},{:.3}", vertex.x, vertex.y)?;
        }
    }
    let told = format!("{CHARACTERS} characters, {} inverted triangles\n", report.flipped);
    Ok(std::io::stdout().write_all(told.as_bytes())?)
}
