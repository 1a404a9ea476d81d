//! The clown: two bitmaps of one figure, and four poses that are these two deformed by handles.
//!
//! After Figure 3 of "N-way morphing for 2D animation". The limbs stay apart in both drawings, so that each is one outline; what
//! is drawn inside a part is fixed to that part, so the two pictures coincide when they are warped onto one another.

mod body;
mod head;
mod landmarks;
mod posture;

use std::error::Error;
use std::path::Path;

use kurbo::Point;

use crate::canvas::{Canvas, Rgb};
use crate::curves::at;
use crate::figure::{Attitude, Build, Figure, Skeleton, draw_poses};
use crate::scene::{self, Copy, Scene};
use posture::{BUILD, attitudes};

/// Thickness of the ink line around the figure, and of those inside.
const LINE: f64 = 5.5;
const FINE: f64 = 3.6;

const INK: Rgb = [0x2d, 0x1e, 0x2f];
const SKIN: Rgb = [0xff, 0xe3, 0xcb];
const WHITE: Rgb = [0xff, 0xfb, 0xf2];
const RED: Rgb = [0xe5, 0x3f, 0x45];
const ORANGE: Rgb = [0xf5, 0x84, 0x2b];
const YELLOW: Rgb = [0xf9, 0xc8, 0x3d];
const TEAL: Rgb = [0x27, 0x9f, 0xa6];
const GREEN: Rgb = [0x4a, 0x8f, 0x4f];
const CHEEK: Rgb = [0xf9, 0xa3, 0x93];
const DARK: Rgb = [0x74, 0x1f, 0x35];

const MESH: &str = "\
simplify = 0.012
";

const KEYS: &str = "\
# Swaying from one foot to the other, a deep bow of the knees, up with a cheer, a lean to the crowd, and back.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.35, at = [-1.0, 0.0] },
  { time = 0.5, at = [-1.0, 0.0] },
  { time = 0.9, at = [1.0, 0.0] },
  { time = 1.05, at = [1.0, 0.0] },
  { time = 1.45, at = [-1.0, 0.0] },
  { time = 1.6, at = [-1.0, 0.0] },
  { time = 2.0, at = [0.0, 0.0] },
  { time = 2.3, at = [0.0, -1.0] },
  { time = 2.55, at = [0.0, -1.0] },
  { time = 2.85, at = [0.0, 1.0] },
  { time = 3.15, at = [0.0, 1.0] },
  { time = 3.5, at = [1.0, 1.0] },
  { time = 3.75, at = [0.85, 1.0] },
  { time = 4.0, at = [1.0, 1.0] },
  { time = 4.4, at = [0.0, 1.0] },
  { time = 4.75, at = [0.0, -0.4] },
  { time = 5.05, at = [0.0, 0.0] },
  { time = 5.3, at = [0.0, 0.0] },
]
";

/// Draws the two poses into `folder` and writes the scene of all six.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    let drawings = attitudes().map(Clown);
    let poses = draw_poses(folder, &drawings)?;
    let [stand, cheer] = attitudes().map(|attitude| Skeleton::new(&BUILD, &attitude));
    scene::save_with_copies(
        folder,
        &Scene {
            element: None,
            poses,
            landmarks: &["left_hand", "right_hand"],
            mesh: MESH,
            sharpness: 0.8,
            size_px: [480, 540],
            keys: KEYS,
        },
        &copies(&stand, &cheer),
    )
}

/// The four deformed poses.
fn copies(stand: &Skeleton, cheer: &Skeleton) -> Vec<Copy> {
    let [left_foot, right_foot] = stand.legs.each_ref().map(|leg| leg.foot * at(-20.0, 28.0));
    let [left_toe, right_toe] = stand.legs.each_ref().map(|leg| leg.foot * at(100.0, 28.0));
    let [left_hand, right_hand] = stand.arms.each_ref().map(|arm| arm.hand * at(36.0, 0.0));
    let (hips, chest) = (stand.torso * at(0.0, -20.0), stand.torso * at(0.0, -120.0));
    let crown = stand.head * at(0.0, -120.0);
    let still = |p: Point| (p, p);
    let moved = |p: Point, x: f64, y: f64| (p, p + kurbo::Vec2::new(x, y));
    let feet = [still(left_foot), still(left_toe), still(right_foot), still(right_toe)];
    let sway = |sign: f64| {
        let (raised, lowered) = if sign > 0.0 {
            (left_hand, right_hand)
        } else {
            (right_hand, left_hand)
        };
        let mut handles = feet.to_vec();
        handles.extend([
            moved(hips, 30.0 * sign, 2.0),
            moved(chest, 58.0 * sign, 8.0),
            moved(crown, 118.0 * sign, 34.0),
            moved(raised, 16.0 * sign, -112.0),
            moved(lowered, 50.0 * sign, 34.0),
        ]);
        handles
    };
    let mut squash = feet.to_vec();
    squash.extend([
        moved(hips, 0.0, 46.0),
        moved(chest, 0.0, 66.0),
        moved(crown, 0.0, 78.0),
        moved(left_hand, -26.0, 0.0),
        moved(right_hand, 26.0, 0.0),
    ]);
    let [standing, kicking] = cheer.legs.each_ref().map(|leg| leg.foot * at(-20.0, 28.0));
    let standing_toe = cheer.legs[0].foot * at(100.0, 28.0);
    let [left_up, right_up] = cheer.arms.each_ref().map(|arm| arm.hand * at(36.0, 0.0));
    let lean = vec![
        still(standing),
        still(standing_toe),
        moved(kicking, 6.0, -58.0),
        moved(cheer.torso * at(0.0, -20.0), -14.0, 2.0),
        moved(cheer.torso * at(0.0, -120.0), -36.0, 4.0),
        moved(cheer.head * at(0.0, -120.0), -72.0, 12.0),
        moved(left_up, -72.0, 70.0),
        moved(right_up, -44.0, -22.0),
    ];
    let copy = |name, of, at, handles| Copy { name, of, at, handles };
    vec![
        copy("sway_left", "stand", [-1.0, 0.0], sway(-1.0)),
        copy("sway_right", "stand", [1.0, 0.0], sway(1.0)),
        copy("squash", "stand", [0.0, -1.0], squash),
        copy("lean", "cheer", [1.0, 1.0], lean),
    ]
}

/// One drawing of the clown.
#[derive(Debug)]
struct Clown(Attitude);

impl Figure for Clown {
    const BUILD: Build = BUILD;

    fn attitude(&self) -> &Attitude {
        &self.0
    }

    /// From the feet up to the hat.
    fn paint(&self, canvas: &mut Canvas, skeleton: &Skeleton) {
        for leg in &skeleton.legs {
            body::draw_shoe(canvas, leg);
        }
        for arm in &skeleton.arms {
            body::draw_glove(canvas, arm);
        }
        body::draw_suit(canvas, skeleton);
        body::draw_ruff(canvas, skeleton.torso);
        head::draw(canvas, skeleton.head, self.0.mouth);
    }
}
