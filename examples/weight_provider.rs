//! Weights of one's own: those of another provider, kept within 0 and 1, which radial weights do not do by themselves.
//! `cargo run --example weight_provider -- FOLDER` writes `between.png` there.

use std::path::{Path, PathBuf};

use inbetween::weights::{RbfOptions, RbfWeights, WeightError};
use inbetween::{Scene, WeightProvider, png_bytes};

/// What is negative becomes 0, and the rest is scaled to sum 1: still 1 at a pose's own place and 0 at the others.
#[derive(Debug)]
struct Clipped<W>(W);

impl<W: WeightProvider> WeightProvider for Clipped<W> {
    fn pose_count(&self) -> usize {
        self.0.pose_count()
    }
    fn dimension(&self) -> usize {
        self.0.dimension()
    }
    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        self.0.weights(at, weights)?;
        // They sum to 1, so some are positive.
        let sum: f64 = weights.iter().map(|weight| weight.max(0.0)).sum();
        weights.iter_mut().for_each(|weight| *weight = weight.max(0.0) / sum);
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: weight_provider FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let scene = Scene::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data/walker/scene.toml"))?;
    let character = scene.character([240, 270], 1)?;
    let weights = Clipped(RbfWeights::new(character.places(), &RbfOptions::default())?);
    let frame = character.frame_of(&weights.weights_at(&[1.1, 0.4])?)?;
    Ok(std::fs::write(folder.join("between.png"), png_bytes(&frame)?)?)
}
