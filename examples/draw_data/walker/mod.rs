//! The walker: five bitmaps of one figure, drawn from a skeleton.
//!
//! The figure is seen from the front. Its limbs stay apart from the body and from one another in every pose, so each
//! pose is one outline without holes, and going round it meets the same features in the same order: pompom, ear, thumb,
//! hand, shoe, crotch, shoe, hand, thumb, ear. What is drawn inside a part is fixed to that part, so the five pictures
//! coincide when they are warped onto one another.

mod body;
mod head;
mod landmarks;
mod posture;
mod style;

use std::error::Error;
use std::path::Path;

use kurbo::Affine;

use crate::canvas::Canvas;
use crate::scene::{self, Pose, Scene};
use body::{Arm, Leg, draw_scarf, draw_shoes, draw_sweater, draw_trousers};
use head::{draw_cap, draw_cap_tip, draw_head};
use landmarks::landmarks;
use posture::{Posture, Side, postures};

const WIDTH_PX: u32 = 640;
const HEIGHT_PX: u32 = 720;

const SETTINGS: &str = "\
[texture]
sharpness = 0.8
";

const ANIMATION: &str = "\
[animation]
fps = 24
loop = true
size = [480, 540]
background = \"white\"
# Two steps to either side with a little hop between them, a jump, a wave; every pose is held for a moment.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.3, at = [-1.0, 0.0] },
  { time = 0.45, at = [-1.0, 0.0] },
  { time = 0.75, at = [0.0, 0.15] },
  { time = 1.05, at = [1.0, 0.0] },
  { time = 1.2, at = [1.0, 0.0] },
  { time = 1.5, at = [0.0, 0.15] },
  { time = 1.8, at = [-1.0, 0.0] },
  { time = 1.95, at = [-1.0, 0.0] },
  { time = 2.25, at = [0.0, 0.15] },
  { time = 2.55, at = [1.0, 0.0] },
  { time = 2.7, at = [1.0, 0.0] },
  { time = 3.0, at = [0.0, 0.0] },
  { time = 3.2, at = [0.0, 0.0] },
  { time = 3.5, at = [0.0, 1.0] },
  { time = 3.75, at = [0.0, 1.0] },
  { time = 4.05, at = [0.0, 0.0] },
  { time = 4.25, at = [0.0, 0.0] },
  { time = 4.6, at = [0.0, -1.0] },
  { time = 4.8, at = [0.0, -0.76] },
  { time = 5.0, at = [0.0, -1.0] },
  { time = 5.2, at = [0.0, -0.76] },
  { time = 5.4, at = [0.0, -1.0] },
  { time = 5.65, at = [0.0, -1.0] },
  { time = 6.0, at = [0.0, 0.0] },
  { time = 6.2, at = [0.0, 0.0] },
]
";

/// Draws the five poses into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut poses = Vec::new();
    for posture in postures() {
        let mut canvas = Canvas::new(WIDTH_PX, HEIGHT_PX)?;
        let figure = Figure::new(&posture);
        figure.draw(&mut canvas, &posture);
        let file = format!("{}.png", posture.name);
        canvas.save(&folder.join(&file))?;
        poses.push(Pose {
            name: posture.name,
            file,
            at: posture.at,
            landmarks: landmarks(&canvas, &figure, &posture)?,
        });
    }
    scene::save(
        folder,
        &Scene {
            element: None,
            poses,
            settings: SETTINGS,
            animation: ANIMATION,
        },
    )
}

/// The parts of a figure, placed.
#[derive(Debug)]
struct Figure {
    torso: Affine,
    head: Affine,
    legs: [Leg; 2],
    arms: [Arm; 2],
}

impl Figure {
    fn new(posture: &Posture) -> Self {
        let torso = posture.torso();
        Self {
            torso,
            head: posture.head(),
            legs: [
                Leg::new(posture.hips, Side::Left, posture.left_leg),
                Leg::new(posture.hips, Side::Right, posture.right_leg),
            ],
            arms: [
                Arm::new(torso, Side::Left, posture.left_arm),
                Arm::new(torso, Side::Right, posture.right_arm),
            ],
        }
    }

    /// From the feet up to the cap.
    fn draw(&self, canvas: &mut Canvas, posture: &Posture) {
        draw_shoes(canvas, &self.legs);
        draw_trousers(canvas, self.torso, &self.legs);
        for arm in &self.arms {
            arm.draw_hand(canvas);
        }
        draw_sweater(canvas, self.torso, &self.arms);
        draw_cap_tip(canvas, self.head, posture.flop_deg);
        draw_scarf(canvas, self.torso);
        draw_head(canvas, self.head, posture);
        draw_cap(canvas, self.head, posture.flop_deg);
    }
}
