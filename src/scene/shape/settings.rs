//! The validated scene of a shape.

use std::path::PathBuf;

use crate::animation::Animation;
use crate::math::Point3;
use crate::weights::Radial;

/// A scene of a shape in space (SBE): example forms, what they are examples of, and how the shape is looked at and played.
///
/// Every place has one coordinate an adjective, in their order; no two examples lie at one place, and no two textures;
/// indices are in range; numbers are finite.
///
/// The file, with every key there is:
///
/// ```
/// # let text = r#"
/// version = 1
/// adjectives = ["bend", "thickness"]
/// radial = "b-spline"                              # or "thin-plate"
///
/// [[example]]
/// name = "straight"
/// form = "straight.obj"                            # relative to this file's folder, inside it
/// at = { bend = 0.0, thickness = 0.0 }             # every adjective once
/// texture = "skin.png"                             # a picture, where the form has texture coordinates
/// texture_at = { bend = 0.0, thickness = 0.0 }     # the picture's own place; `at` otherwise
///
/// [[pseudo_example]]                               # the blend found at one place is wanted at another
/// from = { bend = 0.8, thickness = 0.7 }
/// at = { bend = 1.0, thickness = 1.0 }
/// of = "geometry"                                  # or "texture", or "both"
///
/// [skeleton]                                       # examples are modelled in the pose that it has at their place
/// weights = "weights.json"                         # {"joints": [names], "weights": [[[joint, weight], ...] a vertex]}
/// [[skeleton.joint]]
/// name = "upper"
/// origin = [0.0, 0.0, 0.0]                         # in the rest position, where nothing is turned
/// [[skeleton.joint]]
/// name = "lower"
/// parent = "upper"                                 # a joint above; without, it is a root
/// origin = [2.0, 0.0, 0.0]
/// turns = [                                        # in this order, by the right-hand rule
///     { adjective = "bend", axis = [0.0, 0.0, 1.0], degrees = 90.0, offset = 0.0 },
/// ]                                                # degrees for one unit, and offset where the adjective is 0
/// shifts = [ { adjective = "thickness", by = [0.1, 0.0, 0.0] } ]           # for one unit
/// scalings = [ { adjective = "thickness", factors = [1.0, 1.1, 1.1] } ]    # to the power of the adjective
///
/// [subdivision]
/// steps = 1                                        # 0, the default: none
/// limit = true                                     # points on the limit surface
///
/// [sheet]                                          # the contact sheet; without from and to as far as the examples reach
/// across = { adjective = "bend", from = 0.0, to = 1.0, columns = 5 }
/// up = { adjective = "thickness", from = 0.0, to = 1.0, rows = 5 }
/// fixed = {}                                       # values of the other adjectives; the examples' mean otherwise
/// view = { yaw = 20.0, pitch = 15.0 }              # degrees
///
/// [animation]                                      # without keys all examples in turn
/// fps = 24
/// loop = false
/// keys = [
///     { time = 0.0, at = { bend = 0.0, thickness = 0.0 } },
///     { time = 1.0, at = { bend = 1.0, thickness = 0.0 }, texture_at = { bend = 0.0, thickness = 0.0 } },
/// ]
/// # "#;
/// # use inbetween::scene::ShapeScene;
/// # use std::path::Path;
/// let scene = ShapeScene::parse(text, Path::new("arm/scene.toml"))?;
/// assert_eq!(scene.adjectives[scene.sheet.across.adjective], "bend");
/// # Ok::<(), inbetween::scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeScene {
    /// The scene file.
    pub file: PathBuf,
    /// What the axes of the space are called, at least one.
    pub adjectives: Vec<String>,
    /// The radial function of the weights.
    pub radial: Radial,
    /// The examples, at least one.
    pub examples: Vec<ShapeExample>,
    /// Blends that are wanted elsewhere than they are (SBE 4).
    pub pseudo_examples: Vec<PseudoExample>,
    /// The joints inside, where there are any (SBE 5).
    pub skeleton: Option<SkeletonSettings>,
    /// How forms are subdivided (SBE 6.1).
    pub subdivision: SubdivisionSettings,
    /// How the space is shown in one picture.
    pub sheet: SheetSettings,
    /// The path of the geometry's place over time.
    pub animation: Animation,
    /// The path of the textures' place, with the same times as [`Self::animation`].
    pub texture_animation: Animation,
}

/// A file of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShapeFile {
    /// Relative to the scene's folder.
    pub path: PathBuf,
    /// What names it, in words.
    pub key: String,
    /// The line of the scene file that names it.
    pub line: usize,
}

/// An example: a form, annotated with adjectives.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeExample {
    /// Its name.
    pub name: String,
    /// The OBJ file of its form.
    pub form: ShapeFile,
    /// Its place.
    pub at: Vec<f64>,
    /// The picture on it.
    pub texture: Option<ShapeFile>,
    /// The place of its picture, which need not be its own (SBE 6.3).
    pub texture_at: Vec<f64>,
}

/// What a pseudo-example is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Subject {
    /// The forms.
    #[default]
    Geometry,
    /// The textures.
    Texture,
    /// Both.
    Both,
}

impl Subject {
    /// Whether forms are meant.
    #[must_use]
    pub fn is_geometry(self) -> bool {
        self != Self::Texture
    }

    /// Whether textures are meant.
    #[must_use]
    pub fn is_texture(self) -> bool {
        self != Self::Geometry
    }
}

/// A blend that is wanted elsewhere than it is found (SBE 4).
#[derive(Debug, Clone, PartialEq)]
pub struct PseudoExample {
    /// Where the blend is found.
    pub from: Vec<f64>,
    /// Where it is wanted.
    pub at: Vec<f64>,
    /// Of what.
    pub of: Subject,
}

/// Joints, and how vertices follow them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SkeletonSettings {
    /// The file with the vertices' weights.
    pub weights: ShapeFile,
    /// The joints, at least one; each comes after its parent.
    pub joints: Vec<JointSettings>,
}

/// A joint.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JointSettings {
    /// Its name.
    pub name: String,
    /// The joint it hangs on; `None` for a root.
    pub parent: Option<usize>,
    /// Where it is in the rest position.
    pub origin: Point3,
    /// What turns it, in this order.
    pub turns: Vec<JointTurn>,
    /// What shifts it; shifts add up.
    pub shifts: Vec<JointShift>,
    /// What scales it about its origin, before it is turned; factors multiply.
    pub scalings: Vec<JointScaling>,
}

/// How an adjective shifts a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointShift {
    /// The adjective.
    pub adjective: usize,
    /// By how much for one unit of the adjective.
    pub by: Point3,
}

/// How an adjective scales a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointScaling {
    /// The adjective.
    pub adjective: usize,
    /// The factors along the axes for one unit of the adjective, all positive; their squares for two.
    pub factors: Point3,
}

/// How an adjective turns a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointTurn {
    /// The adjective.
    pub adjective: usize,
    /// About what, of length 1.
    pub axis: Point3,
    /// By how much for one unit of the adjective, in degrees.
    pub degrees: f64,
    /// By how much where the adjective is 0, in degrees.
    pub offset_degrees: f64,
}

/// Which points of the subdivided mesh are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfacePoints {
    /// Those on the surface that endless subdivision converges to.
    #[default]
    Limit,
    /// As the last step leaves them.
    Refined,
}

/// How forms are subdivided (Loop's scheme).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct SubdivisionSettings {
    /// How often every triangle is divided into four; 0 leaves forms as they are.
    pub steps: usize,
    /// Where the points are.
    pub points: SurfacePoints,
}

/// How the space is shown in one picture: two adjectives along its sides, the others fixed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SheetSettings {
    /// What grows to the right.
    pub across: AxisSettings,
    /// What grows upwards; `None` for a single row.
    pub up: Option<AxisSettings>,
    /// A whole place, whose other coordinates hold.
    pub fixed: Vec<f64>,
    /// How far the forms are turned to the right about the axis that points up, y, in degrees.
    pub yaw_degrees: f64,
    /// From how far above they are looked at, in degrees.
    pub pitch_degrees: f64,
}

/// One side of the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AxisSettings {
    /// The adjective.
    pub adjective: usize,
    /// Its first value.
    pub from: f64,
    /// Its last value.
    pub to: f64,
    /// How many values there are.
    pub count: usize,
}

impl AxisSettings {
    /// Value `index` of `count`.
    #[must_use]
    pub fn value(&self, index: usize) -> f64 {
        if self.count < 2 {
            return self.from;
        }
        let along = index as f64 / (self.count - 1) as f64;
        // Both ends exactly.
        self.from * (1.0 - along) + self.to * along
    }
}

impl ShapeScene {
    /// How many adjectives there are.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.adjectives.len()
    }

    /// Whether any example has a texture.
    #[must_use]
    pub fn is_textured(&self) -> bool {
        self.examples.iter().any(|example| example.texture.is_some())
    }

    /// A short name for files made from this scene: the file's own, or its folder's if it is called `scene.toml`.
    #[must_use]
    pub fn short_name(&self) -> String {
        crate::scene::settings::short_name(&self.file)
    }
}
