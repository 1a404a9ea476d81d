//! What is to be rendered, as every kind of output needs it.

use std::path::Path;

use inbetween::animation::Animation;
use inbetween::export::Repetition;
use inbetween::pipeline::Character;
use inbetween::scene::Scene;

use super::certificates::Certification;
use crate::cli::Verbosity;
use crate::cli::frames;
use crate::cli::progress::{Progress, ProgressKind};

/// A scene, the frames that are wanted of it, and where they go.
pub(super) struct Job<'a> {
    /// Where the output goes.
    pub(super) output: &'a Path,
    /// The scene, laid out, with what the command line says in place of the file.
    pub(super) scene: &'a Scene,
    /// The frames that are wanted, from 1, in order.
    pub(super) numbers: Vec<usize>,
    /// The frames that are certified, those that are there already included.
    pub(super) certification: Option<Certification>,
    /// Into how many samples a pixel is divided, in each direction.
    pub(super) supersample: usize,
    /// Whether frames that are there already are left out.
    pub(super) resume: bool,
    /// How progress is told.
    pub(super) progress: ProgressKind,
    /// How far, in pixels, formats with keys may be from the frames.
    pub(super) max_error: f64,
    /// What is told.
    pub(super) verbosity: Verbosity,
}

impl Job<'_> {
    /// What is played.
    pub(super) fn animation(&self) -> &Animation {
        &self.scene.animation
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> [usize; 2] {
        self.animation().size.map(|side| side as usize)
    }

    /// Whether it is played once.
    pub(super) fn repetition(&self) -> Repetition {
        if self.animation().is_loop() {
            Repetition::Forever
        } else {
            Repetition::Once
        }
    }

    /// The scene's character; its notes are told.
    pub(super) fn character(&self) -> anyhow::Result<Character> {
        let character = self.scene.character(self.size(), self.supersample)?;
        self.verbosity.notes(character.notes());
        Ok(character)
    }

    /// Progress over the frames that are wanted.
    pub(super) fn progress(&self) -> Progress {
        Progress::new(self.numbers.len(), self.progress, self.verbosity)
    }

    /// Ends the progress, tells what there is to tell about the frames, and certifies them if that is wanted. Called when all other files are written: where a certificate does
    /// not hold, this fails.
    pub(super) fn done(&self, character: &Character, progress: &Progress) -> anyhow::Result<()> {
        progress.finish();
        frames::tell_inverted(character, self.animation(), &self.numbers, self.verbosity)?;
        match &self.certification {
            Some(certification) => certification.write(character, self.animation()),
            None => Ok(()),
        }
    }
}
