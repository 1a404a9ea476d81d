//! The bear: six vector drawings of one bear in a coat, each of four layers that overlap.
//!
//! An arm hangs down, crosses the chest, waves, or is hidden behind the back; a flower is in its hand, or behind the back
//! with it. Every layer is a group of the drawing. The two arms are one drawing, hung on either shoulder; all shapes are made of
//! the same number of curves in every pose, and elements that correspond have the same id.

mod arm;
mod body;
mod flower;
mod head;

use std::error::Error;
use std::path::Path;

use kurbo::{BezPath, Point, Vec2};

use crate::curves::{at, right_of, smooth_closed};
use crate::layered::{self, Layer, Scene};
use crate::svg::{Drawing, Gradient, GradientShape, Group};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 720.0;
/// Thickness of the ink line around the parts.
const LINE: f64 = 5.0;

const INK: &str = "#2b1a16";
const FUR: &str = "#a86a3c";
const FUR_LIGHT: &str = "#c1844f";
const FUR_DARK: &str = "#80492a";
const CLOTH: &str = "#3f9590";
const CLOTH_DARK: &str = "#226069";
const BRASS: &str = "#e0a235";
const BRASS_LIGHT: &str = "#ffe9a3";

const LAYERS: [Layer; 4] = [
    Layer {
        name: "far_arm",
        anchor: Some(("body", "far_shoulder")),
    },
    Layer {
        name: "flower",
        anchor: Some(("arm", "stem")),
    },
    Layer {
        name: "body",
        anchor: None,
    },
    Layer {
        name: "arm",
        anchor: Some(("body", "shoulder")),
    },
];

const SETTINGS: &str = "\
[mesh]
simplify = 0.006
edge_length = 0.06

[blend]
# The boots stay on the ground. Layers without these landmarks are hung on others anyway.
anchor = [\"left_toe\", \"right_toe\"]

[texture]
sharpness = 0.8
";

const KEYS: &str = "\
# A hand on the heart, a bow; then a flower from behind the back, waved, handed over across the chest, and hidden again.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.3, at = [0.0, 0.0] },
  { time = 0.7, at = [1.0, 0.0] },
  { time = 1.2, at = [1.0, 0.0] },
  { time = 1.6, at = [0.6, -1.0] },
  { time = 2.0, at = [0.6, -1.0] },
  { time = 2.5, at = [0.0, 0.0] },
  { time = 2.7, at = [0.0, 0.0] },
  { time = 3.1, at = [-1.0, 0.0] },
  { time = 3.5, at = [-1.0, 0.0] },
  { time = 4.0, at = [-0.6, 1.0] },
  { time = 4.2, at = [-0.6, 0.8] },
  { time = 4.4, at = [-0.6, 1.0] },
  { time = 4.6, at = [-0.6, 0.8] },
  { time = 4.8, at = [-0.6, 1.0] },
  { time = 5.3, at = [0.6, 1.0] },
  { time = 6.0, at = [0.6, 1.0] },
  { time = 6.5, at = [-0.6, 1.0] },
  { time = 7.0, at = [-1.0, 0.0] },
  { time = 7.3, at = [-1.0, 0.0] },
  { time = 7.7, at = [0.0, 0.0] },
]
";

/// Two bones of an arm, degrees from straight down, outwards positive.
#[derive(Debug, Clone, Copy)]
struct ArmAngles {
    upper: f64,
    lower: f64,
}

const fn arm(upper: f64, lower: f64) -> ArmAngles {
    ArmAngles { upper, lower }
}

/// How the bear is posed in one drawing.
#[derive(Debug, Clone, Copy)]
struct Attitude {
    name: &'static str,
    /// Place in pose space.
    at: [f64; 2],
    /// How far the hips are moved from where they are when it stands.
    hips: Vec2,
    /// Of the back, and of the head against the picture, clockwise from upright, degrees.
    lean_deg: f64,
    tilt_deg: f64,
    /// How far the head sinks towards the chest.
    nod: f64,
    /// Where on the head the face is.
    look: Vec2,
    /// 0 closed, 1 open.
    eyes: f64,
    /// 0 closed, 1 laughing.
    mouth: f64,
    /// The arm that moves, on the picture's left.
    near: ArmAngles,
    far: ArmAngles,
    /// The flower's direction, clockwise from upright, and how far its stem bends on the way, degrees.
    flower: Option<(f64, f64)>,
    order: &'static [&'static str],
}

const REST: Attitude = Attitude {
    name: "rest",
    at: [0.0, 0.0],
    hips: Vec2::ZERO,
    lean_deg: 0.0,
    tilt_deg: 0.0,
    nod: 0.0,
    look: Vec2::ZERO,
    eyes: 1.0,
    mouth: 0.1,
    near: arm(24.0, 10.0),
    far: arm(24.0, 10.0),
    flower: None,
    order: &[],
};

const ATTITUDES: [Attitude; 6] = [
    REST,
    Attitude {
        name: "heart",
        at: [1.0, 0.0],
        hips: Vec2::new(3.0, 0.0),
        lean_deg: -3.0,
        tilt_deg: 9.0,
        nod: 6.0,
        look: Vec2::new(8.0, 4.0),
        eyes: 0.0,
        mouth: 0.1,
        near: arm(7.0, -101.0),
        far: arm(28.0, 18.0),
        ..REST
    },
    Attitude {
        name: "bow",
        at: [0.6, -1.0],
        hips: Vec2::new(-46.0, 8.0),
        lean_deg: 17.0,
        tilt_deg: 27.0,
        nod: 34.0,
        look: Vec2::new(10.0, 24.0),
        eyes: 0.0,
        mouth: 0.1,
        near: arm(-8.0, -86.0),
        far: arm(46.0, 64.0),
        ..REST
    },
    Attitude {
        name: "behind",
        at: [-1.0, 0.0],
        hips: Vec2::new(-2.0, 0.0),
        lean_deg: 3.0,
        tilt_deg: -7.0,
        nod: 4.0,
        look: Vec2::new(14.0, -4.0),
        mouth: 0.0,
        near: arm(34.0, -50.0),
        far: arm(20.0, 6.0),
        flower: Some((22.0, 0.0)),
        order: &["far_arm", "flower", "arm", "body"],
        ..REST
    },
    Attitude {
        name: "wave",
        at: [-0.6, 1.0],
        hips: Vec2::new(5.0, 0.0),
        lean_deg: -4.0,
        tilt_deg: -10.0,
        look: Vec2::new(-12.0, -6.0),
        mouth: 1.0,
        near: arm(120.0, 166.0),
        far: arm(34.0, 26.0),
        flower: Some((6.0, -12.0)),
        order: &["far_arm", "body", "flower", "arm"],
        ..REST
    },
    Attitude {
        name: "offer",
        at: [0.6, 1.0],
        hips: Vec2::new(-4.0, 0.0),
        lean_deg: 5.0,
        tilt_deg: 6.0,
        nod: 3.0,
        look: Vec2::new(16.0, 4.0),
        mouth: 0.5,
        near: arm(-34.0, -100.0),
        far: arm(22.0, 4.0),
        flower: Some((34.0, 18.0)),
        order: &["far_arm", "body", "flower", "arm"],
        ..REST
    },
];

/// A layer of one drawing, and the points of it that the artist names.
struct Part {
    group: Group,
    landmarks: Vec<(String, Point)>,
}

/// Draws the six poses into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut poses = Vec::new();
    for attitude in &ATTITUDES {
        let back = body::back(attitude);
        let near = arm::Arm::new(&back, arm::Side::Near, attitude.near);
        let far = arm::Arm::new(&back, arm::Side::Far, attitude.far);
        let mut parts = vec![
            ("far_arm", far.draw()),
            ("body", body::draw(attitude, &back)),
            ("arm", near.draw()),
        ];
        if let Some((heading_deg, bend_deg)) = attitude.flower {
            parts.insert(1, ("flower", flower::draw(near.grip(), heading_deg, bend_deg)));
        }
        if !attitude.order.is_empty() {
            parts.sort_by_key(|(name, _)| attitude.order.iter().position(|layer| layer == name));
        }
        let mut drawing = Drawing::new(WIDTH, HEIGHT, &format!("bear, {}", attitude.name));
        let mut layers = Vec::new();
        for (name, part) in parts {
            drawing.group(part.group);
            layers.push((name, part.landmarks));
        }
        let file = format!("{}.svg", attitude.name);
        drawing.save(&folder.join(&file))?;
        poses.push(layered::Pose {
            name: attitude.name,
            file,
            at: attitude.at,
            order: attitude.order,
            layers,
        });
    }
    layered::save(
        folder,
        &Scene {
            layers: &LAYERS,
            poses,
            settings: SETTINGS,
            size_px: [480, 540],
            keys: KEYS,
        },
    )
}

/// A line that bends evenly, from which other points are measured: a back, a stem.
struct Spine {
    base: Point,
    /// Clockwise from upright.
    heading_rad: f64,
    bend_rad: f64,
    /// Where it stops bending.
    length: f64,
}

impl Spine {
    fn new(base: Point, heading_deg: f64, bend_deg: f64, length: f64) -> Self {
        Self {
            base,
            heading_rad: heading_deg.to_radians(),
            bend_rad: bend_deg.to_radians(),
            length,
        }
    }

    /// The point `up` along the line and `x` to its right.
    fn place(&self, x: f64, up: f64) -> Point {
        let bent = up.clamp(0.0, self.length);
        let turned_rad = self.bend_rad * bent / self.length;
        let ahead = |angle_rad: f64| Vec2::new(angle_rad.sin(), -angle_rad.cos());
        // The chord of an arc has half its turn.
        let chord = bent * sinc(0.5 * turned_rad);
        let along = ahead(self.heading_rad + turned_rad);
        self.base + ahead(self.heading_rad + 0.5 * turned_rad) * chord + along * (up - bent) + right_of(along) * x
    }

    fn places(&self, points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, up)| self.place(x, up)).collect()
    }
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-9 { 1.0 } else { x.sin() / x }
}

/// An ellipse whose half axes are these vectors, of eight curves.
fn ellipse(middle: Point, across: Vec2, down: Vec2) -> BezPath {
    let points: Vec<Point> = (0..8)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            middle + across * cos + down * sin
        })
        .collect();
    smooth_closed(&points)
}

fn circle(middle: Point, radius: f64) -> BezPath {
    ellipse(middle, Vec2::new(radius, 0.0), Vec2::new(0.0, radius))
}

/// One cubic curve through four points' hull.
fn curve(points: [Point; 4]) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(points[0]);
    path.curve_to(points[1], points[2], points[3]);
    path
}

fn linear(id: &str, from: Point, to: Point, colours: &[&'static str]) -> Gradient {
    Gradient {
        id: id.to_owned(),
        shape: GradientShape::Linear(from, to),
        stops: stops(colours),
    }
}

fn radial(id: &str, middle: Point, radius: f64, colours: &[&'static str]) -> Gradient {
    Gradient {
        id: id.to_owned(),
        shape: GradientShape::Radial(middle, radius),
        stops: stops(colours),
    }
}

fn stops(colours: &[&'static str]) -> Vec<(f64, &'static str, f64)> {
    let last = (colours.len() - 1) as f64;
    (colours.iter().enumerate())
        .map(|(k, colour)| (k as f64 / last, *colour, 1.0))
        .collect()
}

/// A button with a light on it, and the gradient of that.
fn button(group: &mut Group, id: &str, middle: Point, radius: f64) {
    let shine = format!("{id}-brass");
    let light = at(middle.x - 0.3 * radius, middle.y - 0.4 * radius);
    group.gradient(radial(&shine, light, 1.3 * radius, &[BRASS_LIGHT, BRASS]));
    group.path(
        id,
        crate::svg::Look::shaded(&shine).lined(INK, 2.5),
        circle(middle, radius),
    );
}
