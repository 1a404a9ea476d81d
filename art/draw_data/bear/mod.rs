//! The bear: six vector drawings of one bear in a coat, each of four layers that overlap.
//!
//! An arm hangs down, crosses the chest, waves, or is hidden behind the back; a flower is in its hand, or behind the back
//! with it. Every layer is a group of the drawing. The two arms are one drawing, hung on either shoulder; all shapes are made of
//! the same number of curves in every pose, and elements that correspond have the same id.

mod arm;
mod attitude;
mod body;
mod flower;
mod head;
mod shapes;

use std::error::Error;
use std::path::Path;

use kurbo::Point;

use crate::layered::{self, Layer, Scene};
use crate::svg::{Drawing, Group};
use attitude::ATTITUDES;

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

/// Where the boots stand, and where layers hang.
const LANDMARKS: [&str; 5] = ["left_toe", "right_toe", "shoulder", "far_shoulder", "stem"];

const SETTINGS: &str = "\
[mesh]
simplify = 0.006
edge_length = 0.06

[blend]
# Where the paw turns fastest a triangle would be turned over.
guard = \"repair\"
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
            landmarks: &LANDMARKS,
            settings: SETTINGS,
            size_px: [480, 540],
            keys: KEYS,
        },
    )
}
