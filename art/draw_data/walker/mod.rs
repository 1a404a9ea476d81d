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

use crate::canvas::Canvas;
use crate::figure::{Attitude, Build, Figure, Skeleton, draw_poses};
use crate::scene::{self, Scene};
use body::{draw_hand, draw_scarf, draw_shoes, draw_sweater, draw_trousers};
use head::{draw_cap, draw_cap_tip, draw_head};
use posture::{BUILD, Posture, postures};

const KEYS: &str = "\
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
    let poses = draw_poses(folder, &postures())?;
    scene::save(
        folder,
        &Scene {
            element: None,
            poses,
            landmarks: &[],
            mesh: "",
            sharpness: 0.8,
            size_px: [480, 540],
            keys: KEYS,
        },
    )
}

impl Figure for Posture {
    const BUILD: Build = BUILD;

    fn attitude(&self) -> &Attitude {
        &self.body
    }

    /// From the feet up to the cap.
    fn paint(&self, canvas: &mut Canvas, skeleton: &Skeleton) {
        draw_shoes(canvas, &skeleton.legs);
        draw_trousers(canvas, skeleton.torso, &skeleton.legs);
        for arm in &skeleton.arms {
            draw_hand(canvas, arm);
        }
        draw_sweater(canvas, skeleton.torso, &skeleton.arms);
        draw_cap_tip(canvas, skeleton.head, self.flop_deg);
        draw_scarf(canvas, skeleton.torso);
        draw_head(canvas, skeleton.head, self);
        draw_cap(canvas, skeleton.head, self.flop_deg);
    }
}
