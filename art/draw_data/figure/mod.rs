//! What the drawn figures have in common: a skeleton seen from the front, and landmarks found on the finished picture.
//!
//! A figure says how long its bones are, how it stands in each picture, what is drawn over the skeleton and where its
//! landmarks lie. Placing the skeleton, drawing picture after picture and walking round the outline is the same for all.

mod landmarks;
mod skeleton;

use std::error::Error;
use std::path::Path;

use kurbo::Point;

use crate::canvas::Canvas;
use crate::scene::Pose;

pub(crate) use landmarks::{Landmarks, Ray, arm_rays, leg_rays};
pub(crate) use skeleton::{Arm, Attitude, Bones, Build, Leg, Mouth, Side, Skeleton, Stance, limb};

/// Size of every picture of a figure.
pub(crate) const WIDTH_PX: u32 = 640;
pub(crate) const HEIGHT_PX: u32 = 720;

/// One drawing of a figure.
pub(crate) trait Figure: Landmarks {
    /// The measures of its skeleton, the same in all drawings.
    const BUILD: Build;

    /// How its skeleton is posed.
    fn attitude(&self) -> &Attitude;

    /// Draws it over its skeleton.
    fn paint(&self, canvas: &mut Canvas, skeleton: &Skeleton);
}

/// Draws a figure once for each of `drawings` and saves the pictures in `folder`.
pub(crate) fn draw_poses<F: Figure>(folder: &Path, drawings: &[F]) -> Result<Vec<Pose>, Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let draw = |figure: &F| {
        let attitude = figure.attitude();
        let (canvas, landmarks) = drawn(figure)?;
        let file = format!("{}.png", attitude.name);
        canvas.save(&folder.join(&file))?;
        Ok(Pose {
            name: attitude.name,
            file,
            at: attitude.at,
            landmarks,
        })
    };
    drawings.iter().map(draw).collect()
}

/// Points of a drawing that are known, by name.
pub(crate) type KnownPoints = Vec<(String, Point)>;

/// A figure drawn, and where its landmarks are.
pub(crate) fn drawn<F: Figure>(figure: &F) -> Result<(Canvas, KnownPoints), Box<dyn Error>> {
    let skeleton = Skeleton::new(&F::BUILD, figure.attitude());
    let mut canvas = Canvas::new(WIDTH_PX, HEIGHT_PX)?;
    figure.paint(&mut canvas, &skeleton);
    let landmarks = landmarks::landmarks(figure, &canvas, &skeleton)?;
    Ok((canvas, landmarks))
}
