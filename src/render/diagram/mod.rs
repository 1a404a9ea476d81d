//! A mapping and its pose space in one picture, for the artist who wants to know what happened.
//!
//! 1. The outlines: points of equal colour correspond; every few of them carry a number and are linked from pose to pose.
//! 2. The meshes: one triangulation, drawn on every pose; triangles keep their colour.
//! 3. The pose space: each place has the mean of the poses' colours by their weights, with lines where another
//!    pose becomes the heaviest; dots are the poses, the line is the animation's path.

mod canvas;
mod outlines;
mod pose_space;
mod stroke_font;

use canvas::{Canvas, Fit};
use tiny_skia::Color;

use super::Frame;
use crate::pose::Mapping;

/// The side of the square that each pose is drawn in, in pixels.
const CELL_PX: f64 = 300.0;
/// The side of the pose space's square, in pixels.
const SPACE_PX: f64 = 520.0;
/// The free border around everything, in pixels.
const BORDER_PX: f64 = 20.0;
/// The height of a line of text, in pixels.
const TEXT_PX: f64 = 14.0;
/// The widest picture, in pixels: poses are drawn smaller beyond.
const WIDEST_PX: f64 = 6000.0;

/// What the picture says about a pose beside its mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramPose {
    /// Its name.
    pub name: String,
    /// Its place in the pose space; the first two coordinates are drawn.
    pub at: Vec<f64>,
}

/// Draws the picture. `path` is the animation's path through the pose space, `weights` gives the weights at a place.
///
/// # Errors
/// A message if there is no pose, or as many that no picture holds them.
pub fn draw(
    mapping: &Mapping,
    poses: &[DiagramPose],
    path: &[Vec<f64>],
    weights: impl Fn(&[f64]) -> Option<Vec<f64>>,
) -> Result<Frame, String> {
    let count = mapping.poses.len();
    if count == 0 || poses.len() != count {
        return Err("there is nothing to show".to_owned());
    }
    let cell = CELL_PX.min((WIDEST_PX - 2.0 * BORDER_PX) / count as f64);
    let width = (count as f64 * cell).max(SPACE_PX) + 2.0 * BORDER_PX;
    let row = cell + 2.0 * TEXT_PX;
    let height = 2.0 * row + SPACE_PX + 2.0 * TEXT_PX + 2.0 * BORDER_PX;
    let mut canvas =
        Canvas::new(width.ceil() as u32, height.ceil() as u32).ok_or("there are too many poses for one picture")?;
    let fits: Vec<Fit> = mapping
        .poses
        .positions()
        .iter()
        .enumerate()
        .map(|(pose, positions)| {
            let corner = [BORDER_PX + pose as f64 * cell, BORDER_PX + TEXT_PX];
            Fit::new(positions, corner, cell)
        })
        .collect();
    for (pose, said) in poses.iter().enumerate() {
        let left = BORDER_PX + pose as f64 * cell + 6.0;
        canvas.text(&said.name, [left, BORDER_PX], TEXT_PX, pose_colour(pose, count));
    }
    outlines::draw_outlines(&mut canvas, mapping, &fits);
    outlines::draw_meshes(&mut canvas, mapping, &fits, row);
    pose_space::draw(
        &mut canvas,
        poses,
        path,
        &weights,
        [BORDER_PX, BORDER_PX + 2.0 * row + TEXT_PX],
    );
    Ok(canvas.into_frame())
}

/// A clear colour for a pose: hues spread evenly, dark ones and light ones in turn.
fn pose_colour(pose: usize, count: usize) -> Color {
    let light = if pose.is_multiple_of(2) { 0.48 } else { 0.60 };
    hue(pose as f64 / count.max(1) as f64, light)
}

/// A saturated colour of a hue in turns.
fn hue(turns: f64, lightness: f64) -> Color {
    let channel = |shift: f64| {
        let wave = 0.5 + 0.5 * (std::f64::consts::TAU * (turns - shift)).cos();
        (lightness * (0.35 + 1.15 * wave)).clamp(0.0, 1.0) as f32
    };
    Color::from_rgba(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0), 1.0).unwrap_or(Color::BLACK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::Correspondence;
    use crate::math::Point;
    use crate::mesh::Topology;
    use crate::outline::{Outline, Ring};
    use crate::pose::{Matching, PoseSet};

    #[test]
    fn shows_two_poses() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]
            .map(Point::from)
            .to_vec();
        let outline = Outline::new(Ring::new(corners.clone()).expect("a ring"), vec![]).expect("simple");
        let mapping = Mapping {
            poses: PoseSet::new(
                Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh"),
                vec![("a".to_owned(), corners.clone()), ("b".to_owned(), corners)],
            )
            .expect("poses"),
            outlines: vec![outline.clone(), outline],
            rings: vec![vec![0, 1, 2, 3]],
            steiner: 0,
            matching: Matching {
                reference: 0,
                outer: Correspondence::identity(2, 64),
            },
        };
        let poses: Vec<DiagramPose> = [("a", 0.0), ("b", 1.0)]
            .map(|(name, x)| DiagramPose {
                name: name.to_owned(),
                at: vec![x, 0.0],
            })
            .to_vec();
        let weights = |at: &[f64]| Some(vec![1.0 - at[0], at[0]]);
        let picture = draw(&mapping, &poses, &[vec![0.0, 0.0], vec![1.0, 0.0]], weights).expect("a picture");
        let white = picture.pixels.iter().filter(|p| **p == [255; 4]).count();
        assert!(white > picture.pixels.len() / 10 && white < picture.pixels.len() * 9 / 10);
        // The left side of the map belongs to pose a, the right side to pose b.
        let (y, left, right) = (picture.height - 40, 60, 500);
        assert_ne!(
            picture.pixels[y * picture.width + left],
            picture.pixels[y * picture.width + right]
        );
        assert!(draw(&mapping, &poses[..1], &[], |_| None).is_err());
    }
}
