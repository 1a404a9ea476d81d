//! What a frame depends on, as a short text: by it `--resume` knows which frames are those of this scene.
//!
//! A hash (SHA-256) over this program's version, the bytes of the scene file and of every drawing, and what the command line
//! says about the picture. Where the files lie does not count, so that any computer of a farm can go on with the frames
//! of another.

use anyhow::Context as _;
use inbetween::animation::{Animation, Background};
use inbetween::export::Label;
use inbetween::pipeline::CameraRule;
use sha2::{Digest as _, Sha256};

use super::job::Job;

/// The hash that all frames of one run share.
pub(super) struct Fingerprint(Sha256);

impl Fingerprint {
    /// Reads every file of `scene`, in which what the command line says is in the place of what the file says; what only the
    /// command line says is in `job`.
    pub(super) fn of(job: &Job<'_>) -> anyhow::Result<Self> {
        let scene = job.scene;
        let mut fingerprint = Self(Sha256::new());
        fingerprint.add(concat!("inbetween ", env!("CARGO_PKG_VERSION")).as_bytes());
        let sources = scene.source_files()?;
        for file in std::iter::once(&scene.file).chain(&sources) {
            let bytes = std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
            fingerprint.add(&bytes);
        }
        let animation = &scene.animation;
        fingerprint.add(&animation.fps.to_bits().to_le_bytes());
        fingerprint.add(&animation.size.map(u32::to_le_bytes).concat());
        match animation.background {
            Background::Transparent => fingerprint.add(b"transparent"),
            Background::Colour(colour) => fingerprint.add(&colour),
        }
        // What the frames of other scenes carry is the same as ever.
        if scene.camera == CameraRule::Drawing {
            fingerprint.add(b"drawing");
        }
        fingerprint.add(&job.supersample.to_le_bytes());
        Ok(fingerprint)
    }

    /// What frame `number`, counted from 1, carries: the same as every frame that shows its drawing, whose files are then equal.
    pub(super) fn label(&self, animation: &Animation, number: usize) -> Label {
        let drawn = animation.drawn_frame(number.saturating_sub(1)) + 1;
        let mut of_frame = Self(self.0.clone());
        of_frame.add(&drawn.to_le_bytes());
        let digits: String = of_frame.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        Label::new(&digits)
    }

    /// With its length, so that no two lists of parts are the same bytes.
    fn add(&mut self, part: &[u8]) {
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
    }
}
