//! The specification of a character: everything that the artist says about it, as a plain value.
//!
//! [`CharacterSpec`] -> [`Build`](super::Build) -> [`Character`](super::Character). A specification holds drawings, numbers and the
//! stages' own options: no path, no line of a file, no text to be parsed. A front end makes it (the scene file's is
//! [`scene`](crate::scene)), or a program from drawings in memory:
//!
//! ```
//! use inbetween::input::{BitmapOptions, read_pixels};
//! use inbetween::pipeline::{CharacterSpec, LayerSpec, PoseSpec};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let bar = |columns: std::ops::Range<usize>| {
//!     let is_ink = |k: usize| columns.contains(&(k % 40)) && (8..32).contains(&(k / 40));
//!     let pixels: Vec<u8> = (0..1600).flat_map(|k| [0, 0, 0, if is_ink(k) { 255 } else { 0 }]).collect();
//!     read_pixels([40, 40], &pixels, &BitmapOptions::default())
//! };
//! let poses = vec![PoseSpec::drawn("wide", bar(4..36)?), PoseSpec::drawn("narrow", bar(16..24)?)];
//! let spec = CharacterSpec::new(vec![LayerSpec::new("bar", poses)]);
//! assert_eq!(spec.space.poses, ["wide", "narrow"]);
//! # Ok(())
//! # }
//! ```
//!
//! Words: a *pose* is a place of the space where the character is drawn; a *layer* is a part of it with a mesh of its own; poses of
//! different layers with the same name are the same pose. Coordinates are those of each drawing.

mod error;
mod queries;
mod validity;

pub use error::SpecError;

use std::sync::Arc;

use super::note::Note;
use crate::blend::BlendOptions;
use crate::compatible::{RefineOptions, SimplifyOptions};
use crate::input::{Drawing, SvgOptions};
use crate::math::Point;
use crate::render::{ColourBlend, Sampling};
use crate::weights::{BiharmonicOptions, RbfOptions};

/// Everything the artist says about a character.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CharacterSpec {
    /// Its parts, from back to front; at least one.
    pub layers: Vec<LayerSpec>,
    /// For each pose of the space all layers from back to front, by index; empty (the default) if they never change places.
    pub draw_orders: Vec<Vec<usize>>,
    /// The pose space.
    pub space: SpaceSpec,
    /// What the layers are drawn with.
    pub texture: TextureSpec,
    /// What frames show. [`CharacterSpec::on_canvas`] sets it together with what else that takes.
    pub camera: CameraRule,
    /// What the artist should know of how it was made; the first notes of its build.
    pub notes: Vec<Note>,
}

/// What frames show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum CameraRule {
    /// All poses and the whole animation, as large as they fit.
    #[default]
    Fit,
    /// The canvas of the drawings: a frame at a pose lies over its drawing.
    Drawing,
}

impl CameraRule {
    /// What each is called in scene files and on the command line.
    pub const NAMED: [(&'static str, Self); 2] = [("fit", Self::Fit), ("drawing", Self::Drawing)];
}

/// The pose space: which poses there are, where they lie, how their weights fall off.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SpaceSpec {
    /// The names of the poses, in the order of weights and places.
    pub poses: Vec<String>,
    /// Where they lie.
    pub places: Places,
    /// Which weights, and their options.
    pub weights: WeightOptions,
}

/// Where poses lie in the pose space.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum Places {
    /// One place a pose, all of one dimension, no two at the same.
    Given(Vec<Vec<f64>>),
    /// In the plane, by how far the drawings are from one another ([`automatic_places`](super::automatic_places)).
    #[default]
    Automatic,
}

/// Which weights, with the options of their own stage.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum WeightOptions {
    /// Biharmonic on a mesh of the plane (NWM 4.1).
    Biharmonic(BiharmonicOptions),
    /// Cardinal radial basis functions in any dimension (SBE 3).
    Rbf(RbfOptions),
}

impl Default for WeightOptions {
    fn default() -> Self {
        Self::Biharmonic(BiharmonicOptions::default())
    }
}

/// What the layers are drawn with.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TextureSpec {
    /// How sharply textures follow the nearest pose, from 0 (as the shape) to 1 (nearest pose only). Default: 0.5.
    pub sharpness: f64,
    /// In which light colours are averaged. Default: as the numbers stand in the files.
    pub blending: ColourBlend,
    /// Whether vector drawings are drawn as curves. Default: they are.
    pub art: ArtChoice,
    /// How colours are taken from pictures. Default: smoothly.
    pub sampling: Sampling,
    /// Whether pictures are registered to one another below the size of the mesh's triangles. Default: they are.
    pub register: Register,
}

/// Whether pictures are registered to one another on the mesh, so that a cross-fade shows one line where two drawings have one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Register {
    /// Where something is drawn inside and the drawings show the same character. Pixel art, whose texels are squares, keeps to the mesh.
    #[default]
    Auto,
    /// Never.
    Off,
}

impl Register {
    /// What each is called in scene files.
    pub const NAMED: [(&'static str, Self); 2] = [("auto", Self::Auto), ("off", Self::Off)];
}

impl Default for TextureSpec {
    fn default() -> Self {
        Self {
            sharpness: 0.5,
            blending: ColourBlend::default(),
            art: ArtChoice::default(),
            sampling: Sampling::default(),
            register: Register::default(),
        }
    }
}

/// Whether vector drawings are drawn as curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ArtChoice {
    /// As curves, where all drawings of a layer are vector drawings.
    #[default]
    Curves,
    /// From pixels.
    Pixels,
}

/// A part of a character: its poses become one mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LayerSpec {
    /// Its name.
    pub name: String,
    /// The poses that have it; at least one of them is drawn.
    pub poses: Vec<PoseSpec>,
    /// The drawn pose whose outline all others are matched to, by its place in `poses`; `None` (the default) lets the matching choose.
    pub reference: Option<usize>,
    /// Points that correspond.
    pub landmarks: Vec<LandmarkSpec>,
    /// Lines that correspond.
    pub paths: Vec<PathSpec>,
    /// Limbs that lie over other parts of the figure in some poses, as far as the artist says something of them.
    pub limbs: Vec<LimbSpec>,
    /// For each pose names of limbs from back to front, [`LimbSpec::TRUNK`] for what belongs to none; empty where nothing is said of the pose, or (the
    /// default) of any. A limb that no one has named is called as [`Overlaps::limbs`](crate::pose::Overlaps) calls it, up to the point.
    pub limb_orders: Vec<Vec<String>>,
    /// How fine the mesh is.
    pub mesh: MeshOptions,
    /// How its shapes are blended. Points are landmarks, by their places in `landmarks`; poses are those of the layer.
    pub blend: BlendOptions,
    /// What it hangs on; `None` (the default) if it moves by itself.
    pub attachment: Option<Attachment>,
    /// What becomes of holes that not all of its drawings have.
    pub unshared_holes: UnsharedHoles,
    /// Whether poses are looked for in which parts of the figure lie over one another.
    pub overlaps: OverlapSearch,
    /// What it is of the character.
    pub role: LayerRole,
}

/// Whether poses are looked for in which parts of the figure lie over one another: an arm in front of the chest, legs that cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum OverlapSearch {
    /// Such poses are found by what is drawn, where outlines are clearly shorter than that of the most open drawing.
    #[default]
    Auto,
    /// Outlines have to correspond as they are.
    Refuse,
}

impl OverlapSearch {
    /// What each is called in scene files.
    pub const NAMED: [(&'static str, Self); 2] = [("auto", Self::Auto), ("refuse", Self::Refuse)];
}

/// What a layer is of a character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LayerRole {
    /// A layer that the artist made, or the largest of the parts that it fell into.
    #[default]
    Body,
    /// A loose part of one ([`CharacterSpec::with_loose_parts`]).
    LoosePart,
}

/// What becomes of holes that not all drawings of a layer have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum UnsharedHoles {
    /// The mesh covers them; in the drawings that have them the texture is open there, and in between it opens and closes.
    #[default]
    Cover,
    /// They are refused.
    Refuse,
}

/// One pose of a layer.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PoseSpec {
    /// Its name, which is that of a pose of the space.
    pub name: String,
    /// Where its shape comes from.
    pub shape: PoseShape,
}

/// Where the shape of a pose comes from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum PoseShape {
    /// A drawing of its own.
    Drawn(DrawnPose),
    /// Another pose of the layer, deformed (NWM 3.2).
    Deformed(DeformedCopy),
    /// Another pose of the layer, shrunk to almost a point: the pose lacks the layer, which grows from there.
    Shrunk(ShrunkCopy),
}

/// Where a layer that a pose lacks grows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShrunkCopy {
    /// A pose that is drawn, by its place in the layer.
    pub of: usize,
    /// The place that it grows from, in the coordinates of the pose that lacks it, as its other layers are used there.
    pub to: Point,
}

/// A pose with a drawing of its own.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct DrawnPose {
    /// The drawing, as it is in its file.
    pub drawing: Arc<Drawing>,
    /// Whether it is reflected. Default: as drawn. Landmarks and handles are given on the drawing as it is.
    pub facing: Facing,
    /// What the pixels of a vector drawing can be made of again, finer; `None` (the default) if they are all there is.
    pub svg: Option<Arc<SvgSource>>,
    /// Twice the x of the line about which it is reflected, if it is; `None` (the default) for the middle of its outline.
    pub axis: Option<f64>,
    /// By how much it is moved, after it was reflected, in source units; zero (the default) if it is where its file has it. Landmarks
    /// and handles are given on the drawing as it is.
    pub shift: Point,
}

impl PartialEq for DrawnPose {
    fn eq(&self, other: &Self) -> bool {
        let is_same_svg = match (&self.svg, &other.svg) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other) || own == other,
            (None, None) => true,
            _ => false,
        };
        // Drawings are shared rather than copied: most often one look tells.
        self.facing == other.facing
            && self.axis == other.axis
            && self.shift == other.shift
            && is_same_svg
            && (Arc::ptr_eq(&self.drawing, &other.drawing) || self.drawing == other.drawing)
    }
}

/// The bytes of an SVG file and how they were read.
#[derive(Debug, Clone, PartialEq)]
pub struct SvgSource {
    /// The file's bytes.
    pub bytes: Arc<[u8]>,
    /// How the drawing was read from them.
    pub options: SvgOptions,
}

/// Whether a drawing is used as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Facing {
    /// As drawn.
    #[default]
    AsDrawn,
    /// Reflected left to right about the middle of its outline.
    Mirrored,
    /// As what is drawn says: [`CharacterSpec::with_facings`] settles it, and nothing is built before that.
    Auto,
}

/// A copy of another pose whose handles are moved as rigidly as possible (NWM 3.2). It has the other's picture, and what
/// reflects that reflects it, too.
#[derive(Debug, Clone, PartialEq)]
pub struct DeformedCopy {
    /// The pose of the layer that is deformed; it may be a copy itself. Never the pose itself, directly or by way of others.
    pub of: usize,
    /// Where points go; without any, the copy is as the other pose is.
    pub handles: Vec<HandleMove>,
}

/// A point of a pose and where it goes, in the coordinates of the drawing as it is in its file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandleMove {
    /// On the pose that is deformed.
    pub from: Point,
    /// On the copy.
    pub to: Point,
}

/// A point that is named on several poses.
///
/// In every pose that has it, it is at the outer outline (onto which it is snapped), at the rim of a hole (the same, and these holes are one), or inside.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LandmarkSpec {
    /// Its name.
    pub name: String,
    /// Where it lies on each pose of the layer; `None` where the pose lacks it, and on deformed copies, where the mesh carries it.
    pub at: Vec<Option<Point>>,
}

/// A line that is named on several poses.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathSpec {
    /// Its name.
    pub name: String,
    /// Its points on each pose of the layer from start to end: at least two, no two successive ones equal. `None` where the pose
    /// lacks it, and on deformed copies.
    pub at: Vec<Option<Vec<Point>>>,
}

/// A limb that lies over other parts of the figure in some poses: an arm in front of the chest, a leg behind the other.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LimbSpec {
    /// Its name.
    pub name: String,
    /// A place on it for poses of the layer: a hand, a knee, roughly the same one in all of them. One of these poses shows the limb apart from the rest; in the
    /// others it is sought near its place, and it is what is seen there. `None` of poses that nothing is said of, and of deformed copies.
    pub at: Vec<Option<Point>>,
    /// A line across the figure where the limb meets the rest, in a pose that shows it apart; without any it begins where the figure widens. At least two
    /// points, no two successive ones equal.
    pub cut: Vec<Option<Vec<Point>>>,
}

impl LimbSpec {
    /// What belongs to no limb is called so in [`LayerSpec::limb_orders`].
    pub const TRUNK: &'static str = "trunk";

    /// The limb of this name with a place or `None` for each pose of the layer, without a line where it begins.
    #[must_use]
    pub fn new(name: impl Into<String>, at: Vec<Option<Point>>) -> Self {
        Self {
            name: name.into(),
            cut: vec![None; at.len()],
            at,
        }
    }
}

/// How fine the mesh of a layer is: the options of the two stages that decide it.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct MeshOptions {
    /// How far the boundary may be from the outline.
    pub simplify: SimplifyOptions,
    /// How long edges may be.
    pub refine: RefineOptions,
}

/// A point at which a layer hangs on another one: there, both stay together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attachment {
    /// The other layer. Following attachments leads to a layer without one.
    pub to: usize,
    /// The point, one of the layer's own landmarks, which lies at the same coordinates on the other layer's drawings.
    pub landmark: usize,
}

impl CharacterSpec {
    /// A character of `layers`, from back to front, with the poses that they name, in that order, placed automatically; everything
    /// else as its default says.
    #[must_use]
    pub fn new(layers: Vec<LayerSpec>) -> Self {
        let mut poses: Vec<String> = Vec::new();
        for pose in layers.iter().flat_map(|layer| &layer.poses) {
            if !poses.contains(&pose.name) {
                poses.push(pose.name.clone());
            }
        }
        Self {
            layers,
            draw_orders: Vec::new(),
            space: SpaceSpec {
                poses,
                places: Places::default(),
                weights: WeightOptions::default(),
            },
            texture: TextureSpec::default(),
            camera: CameraRule::default(),
            notes: Vec::new(),
        }
    }

    /// The specification with the poses at `places`, one a pose in the order of [`SpaceSpec::poses`].
    #[must_use]
    pub fn with_places(mut self, places: Vec<Vec<f64>>) -> Self {
        self.space.places = Places::Given(places);
        self
    }
}

impl LayerSpec {
    /// A layer with these poses; everything else as its default says.
    #[must_use]
    pub fn new(name: impl Into<String>, poses: Vec<PoseSpec>) -> Self {
        Self {
            name: name.into(),
            poses,
            reference: None,
            landmarks: Vec::new(),
            paths: Vec::new(),
            limbs: Vec::new(),
            limb_orders: Vec::new(),
            mesh: MeshOptions::default(),
            blend: BlendOptions::default(),
            attachment: None,
            unshared_holes: UnsharedHoles::default(),
            overlaps: OverlapSearch::default(),
            role: LayerRole::default(),
        }
    }
}

impl LandmarkSpec {
    /// The landmark of this name, with a place or `None` for each pose of the layer.
    #[must_use]
    pub fn new(name: impl Into<String>, at: Vec<Option<Point>>) -> Self {
        Self { name: name.into(), at }
    }
}

impl PathSpec {
    /// The line of this name, with its points or `None` for each pose of the layer.
    #[must_use]
    pub fn new(name: impl Into<String>, at: Vec<Option<Vec<Point>>>) -> Self {
        Self { name: name.into(), at }
    }
}

impl PoseSpec {
    /// A pose with a drawing of its own.
    #[must_use]
    pub fn drawn(name: impl Into<String>, drawing: impl Into<Arc<Drawing>>) -> Self {
        Self {
            name: name.into(),
            shape: PoseShape::Drawn(DrawnPose::new(drawing)),
        }
    }

    /// A deformed copy of pose `of` of the layer.
    #[must_use]
    pub fn deformed(name: impl Into<String>, of: usize, handles: Vec<HandleMove>) -> Self {
        Self {
            name: name.into(),
            shape: PoseShape::Deformed(DeformedCopy { of, handles }),
        }
    }
}

impl DrawnPose {
    /// A drawing as it is, with no other pixels than it has.
    #[must_use]
    pub fn new(drawing: impl Into<Arc<Drawing>>) -> Self {
        Self {
            drawing: drawing.into(),
            facing: Facing::default(),
            svg: None,
            axis: None,
            shift: Point::zeros(),
        }
    }
}

#[cfg(test)]
mod tests;
