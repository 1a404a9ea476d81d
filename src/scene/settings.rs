//! The validated scene.

use std::path::{Path, PathBuf};

use super::SceneLayer;
use crate::animation::Animation;
use crate::blend::BlendOptions;
use crate::input::{Extent, FigureRule, PaperRule, PartOptions, PartRule, PictureChoice};
use crate::math::Point;
use crate::pipeline::OverlapSearch;
use crate::pipeline::{ArtChoice, CameraRule, DeformedCopy, Facing, MeshOptions, Register};
use crate::render::{ColourBlend, Sampling};
use crate::weights::{PseudoPose, Radial, Range};

/// A scene: everything the artist says about a character.
///
/// Every pose has a place of the same dimension, no two at the same; pose indices are in range; numbers are finite. Places
/// that the file does not give are an even circle until the drawings are mapped, see [`Layout`].
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The scene file.
    pub file: PathBuf,
    /// The pose whose outline is `B0` (NWM 3.1); `None` lets the matching choose.
    pub reference: Option<usize>,
    /// How drawings become outlines.
    pub input: InputSettings,
    /// How fine the mesh is.
    pub mesh: MeshOptions,
    /// Whether the poses are where the file says.
    pub layout: Layout,
    /// How weights fall off over the pose space.
    pub pose_space: PoseSpaceSettings,
    /// How shapes are blended: points are landmarks, by their places in `landmarks`; whole turns are those of the poses.
    pub blend: BlendOptions,
    /// How sharply textures follow the nearest pose, `sigma`, from 0 (as the shape) to 1 (nearest pose only).
    pub texture_sharpness: f64,
    /// In which light colours are averaged.
    pub colour_blend: ColourBlend,
    /// Whether vector drawings are drawn as curves.
    pub art: ArtChoice,
    /// How colours are taken from pictures.
    pub sampling: Sampling,
    /// Whether pictures are registered to one another below the size of the mesh's triangles.
    pub register: Register,
    /// What frames show.
    pub camera: CameraRule,
    /// Where the size of frames comes from.
    pub frame_size: FrameSize,
    /// The poses, at least one.
    pub poses: Vec<ScenePose>,
    /// Blends that are wanted elsewhere than they are (SBE 4).
    pub pseudo_poses: Vec<PseudoPose>,
    /// Points that correspond.
    pub landmarks: Vec<SceneLandmark>,
    /// Lines that correspond, named by `path = true` landmarks.
    pub paths: Vec<ScenePath>,
    /// Limbs that lie over other parts of a drawing, as far as the file names them.
    pub limbs: Vec<SceneLimb>,
    /// Parts in front of one another, from back to front; empty if the drawings are whole.
    pub layers: Vec<SceneLayer>,
    /// What is played.
    pub animation: Animation,
}

/// Where the size of frames comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FrameSize {
    /// The animation has it.
    #[default]
    Given,
    /// The file gives none: it is the animation's default, or with [`CameraRule::Drawing`] that of the drawings' canvas, which is known
    /// when they are read ([`Scene::with_automatic_places`]).
    Open,
}

/// Whether holes of the drawings are holes of the shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Holes {
    /// Those that all poses have are, and correspond. The others open and close in the texture.
    #[default]
    Match,
    /// They are, and correspond between the poses, which must have equally many.
    Keep,
    /// The shape is filled; what is transparent in the drawing stays transparent in its texture.
    Fill,
}

/// How drawings become outlines.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InputSettings {
    /// Whether holes count.
    pub holes: Holes,
    /// How the drawings of poses that do not say it themselves are read.
    pub reading: ReadingSettings,
    /// What becomes of loose parts.
    pub parts: PartRule,
    /// Whether poses are looked for in which parts of the figure lie over one another.
    pub overlaps: OverlapSearch,
    /// How many columns and rows of cells sheets have, where poses name a cell.
    pub cells: Option<[usize; 2]>,
}

/// How a drawing is read.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ReadingSettings {
    /// How the figure is told from its sheet.
    pub figure: FigureRule,
    /// Widest gap in lines that is closed, as a fraction of the drawing's diagonal.
    pub gap: f64,
    /// What becomes of the paper inside a figure of lines.
    pub paper: PaperRule,
    /// The coverage, between 0 and 1, that counts as inside.
    pub threshold: f64,
}

impl Default for InputSettings {
    /// Holes matched.
    fn default() -> Self {
        Self {
            holes: Holes::Match,
            reading: ReadingSettings::default(),
            parts: PartRule::default(),
            overlaps: OverlapSearch::default(),
            cells: None,
        }
    }
}

impl Default for ReadingSettings {
    /// The figure by evidence, gaps of a hundredth closed, paper kept, outline at half coverage.
    fn default() -> Self {
        Self {
            figure: FigureRule::Auto,
            gap: 0.01,
            paper: PaperRule::Keep,
            threshold: 0.5,
        }
    }
}

/// Which weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Provider {
    /// Biharmonic on a mesh of the plane (NWM 4.1).
    #[default]
    Biharmonic,
    /// Cardinal radial basis functions in any dimension (SBE 3).
    Rbf,
}

impl Provider {
    /// What each is called in scene files and on the command line.
    pub const NAMED: [(&'static str, Self); 2] = [("biharmonic", Self::Biharmonic), ("rbf", Self::Rbf)];

    /// The one of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMED.into_iter().find(|(own, _)| *own == name);
        found.map(|(_, provider)| provider)
    }
}

/// Where the places of the poses come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Layout {
    /// From the scene file.
    #[default]
    Given,
    /// From how far the drawings are from one another. That is known when they are mapped; [`Scene::laid_out`] then takes
    /// the places. Until then they are even on a circle.
    Automatic,
}

/// How weights fall off over the pose space.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PoseSpaceSettings {
    /// Which weights.
    pub provider: Provider,
    /// The radial function of [`Provider::Rbf`].
    pub radial: Radial,
    /// The weight of the squared gradient in [`Provider::Biharmonic`].
    pub epsilon: f64,
    /// What values the weights of [`Provider::Biharmonic`] may have.
    pub range: Range,
    /// Polylines that influence may not cross in [`Provider::Biharmonic`].
    pub walls: Vec<Vec<[f64; 2]>>,
}

impl Default for PoseSpaceSettings {
    /// Biharmonic with epsilon 1e-3, without bounds or walls.
    fn default() -> Self {
        Self {
            provider: Provider::default(),
            radial: Radial::default(),
            epsilon: 1e-3,
            range: Range::default(),
            walls: Vec::new(),
        }
    }
}

/// One pose of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenePose {
    /// Its name.
    pub name: String,
    /// Where its shape comes from.
    pub source: PoseSource,
    /// Its place in the pose space.
    pub at: Vec<f64>,
    /// Whole turns added to its mean rotation.
    pub turns: i32,
    /// All layers from back to front, by index; empty in a scene without.
    pub draw_order: Vec<usize>,
    /// Limbs from back to front, by name, in a scene without layers; empty where the file says nothing of them.
    pub limb_order: Vec<String>,
}

/// Where a pose's shape comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum PoseSource {
    /// A drawing of its own.
    Drawn(DrawnSource),
    /// Another pose, deformed.
    Deformed(DeformedSource),
    /// Each of its layers has its own; see [`Scene::layers`].
    Layered,
}

/// A drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnSource {
    /// Its file, relative to the scene's folder; see [`Scene::source_path`].
    pub file: PathBuf,
    /// The line of the scene file that names it.
    pub line: usize,
    /// The SVG element whose outline is meant.
    pub element: Option<String>,
    /// Whether it is reflected.
    pub facing: Facing,
    /// Whether only the element is drawn.
    pub extent: Extent,
    /// How it is read.
    pub reading: ReadingSettings,
    /// Which of its loose parts belong to it.
    pub parts: PartOptions,
    /// Which picture of a bitmap's file it is.
    pub picture: PictureChoice,
}

/// A copy of another pose, deformed.
#[derive(Debug, Clone, PartialEq)]
pub struct DeformedSource {
    /// The line of the scene file with the handles.
    pub line: usize,
    /// Which pose is deformed, and how. In a layer that stays as it is there are no handles.
    pub copy: DeformedCopy,
}

/// A point that the artist names on several poses.
///
/// In every pose that has it, it is at the outer outline (onto which it is snapped), at the rim of a hole (the same, and these holes are one), or inside.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneLandmark {
    /// Its name.
    pub name: String,
    /// The line of the scene file.
    pub line: usize,
    /// The layer it is on, in a scene with layers.
    pub layer: Option<usize>,
    /// Where it lies on each pose, in source pixels or SVG user units; `None` where the pose lacks it.
    pub at: Vec<Option<Point>>,
}

/// A line that the artist names on several poses.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenePath {
    /// Its name.
    pub name: String,
    /// The line of the scene file.
    pub line: usize,
    /// The layer it is on, in a scene with layers.
    pub layer: Option<usize>,
    /// Its points on each pose from start to end, in source pixels or SVG user units; at least two, no two successive
    /// ones equal. `None` where the pose lacks it.
    pub at: Vec<Option<Vec<Point>>>,
}

/// A limb that the artist names since it lies over other parts in some poses.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneLimb {
    /// Its name.
    pub name: String,
    /// The line of the scene file.
    pub line: usize,
    /// The layer it is on, in a scene with layers.
    pub layer: Option<usize>,
    /// A place on it, in source pixels or SVG user units; `None` of poses that nothing is said of.
    pub at: Vec<Option<Point>>,
    /// A line where it meets the rest, in the same coordinates; at least two points, no two successive ones equal.
    pub cut: Vec<Option<Vec<Point>>>,
}

impl Scene {
    /// The dimension of the pose space.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.poses.first().map_or(0, |pose| pose.at.len())
    }

    /// The scene with its poses at `places`, one of the pose space's dimension for each; the animation goes through them if it
    /// has no keys of its own.
    #[must_use]
    pub fn laid_out(&self, places: &[Vec<f64>]) -> Self {
        let mut scene = self.clone();
        for (pose, place) in scene.poses.iter_mut().zip(places) {
            pose.at.clone_from(place);
        }
        let moved = self
            .animation
            .through(scene.poses.iter().map(|pose| pose.at.as_slice()));
        if let Ok(moved) = moved {
            scene.animation = moved;
        }
        scene.layout = Layout::Given;
        scene
    }

    /// The poses' names, in order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.poses.iter().map(|pose| pose.name.clone()).collect()
    }

    /// The poses that have a drawing of their own, in order.
    #[must_use]
    pub fn drawn_poses(&self) -> Vec<usize> {
        let is_drawn = |pose: &usize| matches!(self.poses[*pose].source, PoseSource::Drawn(_));
        (0..self.poses.len()).filter(is_drawn).collect()
    }

    /// The pose whose drawing pose `index` shows, and that drawing: itself, or the one that it is a copy of in the end.
    ///
    /// `None` for a pose that does not exist or is a copy of itself, which no validated scene has.
    #[must_use]
    pub fn drawing_of(&self, index: usize) -> Option<(usize, &DrawnSource)> {
        let mut at = index;
        for _ in 0..=self.poses.len() {
            match &self.poses.get(at)?.source {
                PoseSource::Drawn(drawing) => return Some((at, drawing)),
                PoseSource::Deformed(copy) => at = copy.copy.of,
                PoseSource::Layered => return None,
            }
        }
        None
    }

    /// A short name for files made from this scene: the file's own, or its folder's if it is called `scene.toml`.
    #[must_use]
    pub fn short_name(&self) -> String {
        short_name(&self.file)
    }
}

/// A short name for files made from the scene in `file`.
pub(super) fn short_name(file: &Path) -> String {
    let stem = file.file_stem().map(|s| s.to_string_lossy().into_owned());
    let folder = file
        .parent()
        .and_then(|p| p.file_name())
        .map(|s| s.to_string_lossy().into_owned());
    match (stem, folder) {
        (Some(stem), Some(folder)) if stem == "scene" => folder,
        (Some(stem), _) => stem,
        _ => "scene".to_owned(),
    }
}
