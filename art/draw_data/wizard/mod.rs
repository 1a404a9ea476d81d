//! The wizard: three scans of one figure in ink on paper.
//!
//! Lines are drawn with a broad nib, so their width follows their direction; what is white is paper. The limbs stay apart, as
//! those of the other figures do. The hat floats over the head, sparks are about the wand, and in one drawing there is a drop of sweat:
//! all of these are loose. Nothing is said of what corresponds.

mod body;
mod head;
mod landmarks;
mod loose;
mod posture;

use std::error::Error;
use std::path::Path;

use kurbo::BezPath;

use crate::canvas::{Canvas, Rgb};
use crate::figure::{Build, Figure, Skeleton, drawn};
use crate::scene::{self, Pose, Scene};
use posture::{BUILD, Posture, postures};

/// Width of the nib around the figure, and inside it.
const LINE: f64 = 9.0;
const FINE: f64 = 5.5;

const INK: Rgb = [0, 0, 0];
const PAPER: Rgb = [0xff, 0xff, 0xff];

const KEYS: &str = "\
# Waits, conjures, is startled by what comes of it, and pretends that nothing was.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.5, at = [0.0, 0.0] },
  { time = 1.0, at = [1.0, 0.0] },
  { time = 1.25, at = [0.85, 0.0] },
  { time = 1.5, at = [1.0, 0.0] },
  { time = 1.7, at = [1.0, 0.0] },
  { time = 2.05, at = [0.5, 0.9] },
  { time = 2.5, at = [0.5, 0.9] },
  { time = 3.1, at = [0.0, 0.0] },
  { time = 3.4, at = [0.0, 0.0] },
]
";

/// Draws and scans the three poses into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let pose = |posture: &Posture| -> Result<Pose, Box<dyn Error>> {
        let (canvas, landmarks) = drawn(posture)?;
        let file = format!("{}.jpg", posture.body.name);
        posture.sheet.save(&canvas, &folder.join(&file))?;
        let scanned = |(name, point)| (name, posture.sheet.scanned(point));
        Ok(Pose {
            name: posture.body.name,
            file,
            at: posture.body.at,
            landmarks: landmarks.into_iter().map(scanned).collect(),
        })
    };
    scene::save(
        folder,
        &Scene {
            element: None,
            poses: postures().iter().map(pose).collect::<Result<_, _>>()?,
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

    fn attitude(&self) -> &crate::figure::Attitude {
        &self.body
    }

    /// From the feet up to the hat.
    fn paint(&self, canvas: &mut Canvas, skeleton: &Skeleton) {
        body::draw_legs(canvas, skeleton);
        for arm in &skeleton.arms {
            body::draw_hand(canvas, arm);
        }
        body::draw_wand(canvas, skeleton);
        body::draw_coat(canvas, skeleton);
        head::draw(canvas, skeleton.head, self);
        body::draw_scarf(canvas, skeleton.torso);
        loose::draw_hat(canvas, skeleton.head, self);
        loose::draw_sparks(canvas, skeleton, self);
        loose::draw_drop(canvas, skeleton.head, self);
    }
}

/// Paper with a line of ink around it.
fn outlined(canvas: &mut Canvas, path: &BezPath, width: f64) {
    canvas.fill(path, PAPER);
    canvas.nib(path, width, INK);
}
