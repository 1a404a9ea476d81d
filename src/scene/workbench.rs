//! A scene that is being edited: its drawings are kept, its character is updated.
//!
//! A [`Workbench`] is a [`Build`] with the scene that it was made of and a camera. An edited scene reads only drawings that it names
//! or reads in another way; which stages run again is what [`Build::update`] says.

use std::sync::Arc;

use super::drawings::read_drawing;
use super::settings::{DrawnSource, Scene};
use super::{Layout, SceneBuildError};
use crate::pipeline::{Build, Character, CharacterSpec, DrawnPose, EditableWeights, LayerSpec};
use crate::render::Camera;

/// Whether the drawings' files are as they were.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingFiles {
    /// They are: what was read of them is kept.
    Unchanged,
    /// They may not be: they are read again.
    Reread,
}

/// A scene's character before it is painted, made again after every edit from what the edit leaves alone.
///
/// Its shapes are those of a [`Character`] of the same scene, to the last bit; its camera after [`Workbench::filmed_anew`].
#[derive(Debug, Clone)]
pub struct Workbench {
    /// Laid out.
    scene: Scene,
    /// Its drawings as they were read, before loose parts became layers.
    read: Arc<CharacterSpec>,
    build: Build,
    camera: Camera,
}

impl Workbench {
    /// Reads and maps the drawings of `scene`.
    ///
    /// # Errors
    /// [`SceneBuildError`] from any stage.
    pub fn new(scene: &Scene) -> Result<Self, SceneBuildError> {
        let read = scene.spec_with(&read_drawing)?;
        let made = Build::new(&scene.arranged(read.clone()));
        let build = made.map_err(|error| scene.refusal(error))?;
        let scene = placed(scene, &build);
        let camera = camera(&scene, &build)?;
        Ok(Self {
            scene,
            read: Arc::new(read),
            build,
            camera,
        })
    }

    /// The workbench of an edited scene.
    ///
    /// # Errors
    /// As [`Self::new`]; this workbench stays as it is.
    pub fn edited(&self, scene: &Scene, files: DrawingFiles) -> Result<Self, SceneBuildError> {
        let read = match files {
            DrawingFiles::Reread => scene.spec_with(&read_drawing)?,
            DrawingFiles::Unchanged => scene.spec_with(&|own: &Scene, layer: Option<&str>, pose: usize| {
                let kept = self.kept(own, layer, pose);
                kept.map_or_else(|| read_drawing(own, layer, pose), Ok)
            })?,
        };
        let spec = scene.arranged(read.clone());
        let build = self.build.update(&spec).map_err(|error| scene.refusal(error))?;
        Ok(Self {
            scene: placed(scene, &build),
            read: Arc::new(read),
            build,
            camera: self.camera,
        })
    }

    /// The workbench with the camera of a new one. Edits keep the camera that was there, since looking at the whole animation takes
    /// as long as dozens of frames.
    ///
    /// # Errors
    /// [`SceneBuildError`] if the animation leaves the pose space.
    pub fn filmed_anew(&self) -> Result<Self, SceneBuildError> {
        let camera = camera(&self.scene, &self.build)?;
        Ok(Self { camera, ..self.clone() })
    }

    /// The same shapes with other weights, of `scene`, which is laid out and differs in what weights are made of alone. The
    /// camera stays.
    #[must_use]
    pub fn reweighted(&self, scene: &Scene, weights: Arc<EditableWeights>) -> Self {
        Self {
            scene: scene.clone(),
            read: Arc::clone(&self.read),
            build: self.build.reweighted(scene.places(), weights),
            camera: self.camera,
        }
    }

    /// The drawing of one pose of a layer of an edited scene, by its index there, as its file has it: read only if it is not one that
    /// is known and read in the same way.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn read_drawing(&self, edited: &Scene, layer: usize, pose: usize) -> Result<DrawnPose, SceneBuildError> {
        let named = edited.layers.get(layer).map(|layer| layer.name.as_str());
        let kept = self.kept(edited.of_layer(layer), named, pose);
        kept.map_or_else(|| edited.read_drawing(layer, pose), Ok)
    }

    /// The drawing of a pose of a layer, by their names in the edited scene, if it is one that is known and read in the same way.
    fn kept(&self, edited: &Scene, layer: Option<&str>, pose: usize) -> Option<DrawnPose> {
        let (_, wanted) = edited.drawing_of(pose)?;
        let is_same = |known: &DrawnSource| {
            // Where it stands in the scene file makes no difference.
            let line = known.line;
            *known == DrawnSource { line, ..wanted.clone() }
        };
        let known = |(own, spec): (&Scene, &LayerSpec)| {
            if own.file != edited.file || own.input != edited.input {
                return None;
            }
            let place = own.drawn_poses().into_iter().position(|k| {
                let drawing = own.drawing_of(k);
                drawing.is_some_and(|(_, known)| is_same(known))
            })?;
            spec.drawn().nth(place).cloned()
        };
        let layers = &self.read.layers;
        // Other layers are not asked: a file that two of them share is read by each in its own way.
        let index = match layer {
            Some(name) => self.scene.layers.iter().position(|own| own.name == name)?,
            None if self.scene.layers.is_empty() => 0,
            None => return None,
        };
        known((self.scene.of_layer(index), layers.get(index)?))
    }

    /// The scene, laid out.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What its shapes are made of.
    #[must_use]
    pub fn build(&self) -> &Build {
        &self.build
    }

    /// The camera of frames of the animation's own size.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The character of this shape, for frames of the animation's own size: what is left to make is its art.
    ///
    /// # Errors
    /// [`SceneBuildError`] if a drawing cannot be prepared.
    pub fn character(&self) -> Result<Character, SceneBuildError> {
        let made = self.build.character(&self.scene.animation, self.camera, 1);
        made.map_err(|error| self.scene.refusal(error))
    }

    /// Whether both have the same shapes, drawn with the same art and seen by the same camera; their weights may differ.
    #[must_use]
    pub fn draws_like(&self, other: &Self) -> bool {
        self.build.draws_like(&other.build) && self.camera == other.camera
    }
}

impl std::ops::Deref for Workbench {
    type Target = Build;

    /// A workbench is asked for shapes as its build is.
    fn deref(&self) -> &Build {
        &self.build
    }
}

/// The scene with the places of a build of it.
fn placed(scene: &Scene, build: &Build) -> Scene {
    match scene.layout {
        Layout::Given => scene.clone(),
        Layout::Automatic => scene.laid_out(build.places()),
    }
}

/// The camera of frames of the animation's own size.
fn camera(scene: &Scene, build: &Build) -> Result<Camera, SceneBuildError> {
    let size = scene.animation.size.map(|side| side as usize);
    build
        .camera(&scene.animation, size)
        .map_err(|error| scene.refusal(error))
}
