//! Frames on the drawings' own canvas.
//!
//! Drawings -> where each of them lies on one canvas, and the camera that shows it.
//!
//! 1. The canvas is as wide as the widest drawing's page and as high as the highest one's.
//! 2. Each page is centred on it, to a whole pixel of that page; pages of the same size stay where they are.
//! 3. The camera shows it centred, as large as it fits: frames of a whole multiple of its size show every pixel as a square of
//!    whole pixels.
//!
//! Limits: user units of SVG files are taken to be of one size in all drawings, as everywhere.

use std::sync::Arc;

use super::spec::{CameraRule, CharacterSpec, DrawnPose, PoseShape};
use crate::input::{Canvas, Drawing};
use crate::math::Point;
use crate::render::Camera;

impl CharacterSpec {
    /// The specification for frames on the drawings' own canvas: every drawing is moved to where its page is centred on the largest.
    #[must_use]
    pub fn on_canvas(mut self) -> Self {
        self.camera = CameraRule::Drawing;
        let whole = (self.drawn().map(|pose| pose.drawing.canvas)).reduce(|largest, canvas| Canvas {
            low: largest.low,
            high: largest.low + largest.size().sup(&canvas.size()),
        });
        let Some(whole) = whole else { return self };
        let poses = self.layers.iter().flat_map(|layer| &layer.poses);
        let shifts: Vec<(String, Point)> = poses
            .filter_map(|pose| match &pose.shape {
                PoseShape::Drawn(drawn) => Some((pose.name.clone(), shift(&drawn.drawing, &whole))),
                PoseShape::Deformed(_) | PoseShape::Shrunk(_) => None,
            })
            .collect();
        let of_pose = |name: &String| shifts.iter().find(|(own, _)| own == name).map(|(_, shift)| *shift);
        for layer in &mut self.layers {
            for pose in &mut layer.poses {
                match &mut pose.shape {
                    PoseShape::Drawn(drawn) => drawn.shift = shift(&drawn.drawing, &whole),
                    // It lies among what the pose has.
                    PoseShape::Shrunk(copy) => copy.to += of_pose(&pose.name).unwrap_or_default(),
                    PoseShape::Deformed(_) => {}
                }
            }
        }
        self
    }

    fn drawn(&self) -> impl Iterator<Item = &DrawnPose> {
        self.layers.iter().flat_map(|layer| layer.drawn())
    }
}

/// What brings the page of a drawing to the middle of `whole`.
fn shift(drawing: &Drawing, whole: &Canvas) -> Point {
    let canvas = drawing.canvas;
    let room = 0.5 * (whole.size() - canvas.size());
    let whole_pixels = room.map(|v| (v * drawing.unit_px).floor() / drawing.unit_px);
    let room = if drawing.unit_px > 0.0 { whole_pixels } else { room };
    whole.low + room - canvas.low
}

/// The camera of frames of `size` (columns, rows) that show the canvas of `drawings`, which are where they lie on it.
pub(super) fn camera<'a>(drawings: impl Iterator<Item = &'a Arc<Drawing>>, size: [usize; 2]) -> Camera {
    let whole = drawings
        .map(|drawing| drawing.canvas)
        .reduce(|all, canvas| all.union(&canvas));
    let whole = whole.unwrap_or_else(|| Canvas::of_pixels(size[0], size[1]));
    Camera::of_canvas([whole.low, whole.high], size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{BitmapOptions, read_pixels};
    use crate::pipeline::{LayerSpec, PoseSpec};

    /// A black square of 4 x 4 in the middle of a clear picture.
    fn square(width: usize, height: usize) -> Drawing {
        let is_ink = |k: usize| {
            let (x, y) = (k % width, k / width);
            x.abs_diff(width / 2) < 3 && y.abs_diff(height / 2) < 3
        };
        let pixels: Vec<u8> = (0..width * height)
            .flat_map(|k| [0, 0, 0, if is_ink(k) { 255 } else { 0 }])
            .collect();
        read_pixels([width, height], &pixels, &BitmapOptions::default()).expect("a drawing")
    }

    #[test]
    fn smaller_pages_are_centred_on_whole_pixels_of_the_largest() {
        let poses = [("a", (20, 30)), ("b", (33, 20)), ("c", (33, 30))];
        let poses = poses.map(|(name, (width, height))| PoseSpec::drawn(name, square(width, height)));
        let spec = CharacterSpec::new(vec![LayerSpec::new("body", poses.to_vec())]).on_canvas();
        let shifts: Vec<Point> = spec.drawn().map(|pose| pose.shift).collect();
        // 13 columns are left beside a page of 20.
        assert_eq!(shifts, [[6.0, 0.0], [0.0, 5.0], [0.0, 0.0]].map(Point::from));
        let used: Vec<Arc<Drawing>> = spec.drawn().map(|pose| pose.as_used().expect("moved")).collect();
        let camera = camera(used.iter(), [66, 60]);
        assert_eq!(
            (camera.scale(), camera.to_pixels(Point::new(1.0, 2.0))),
            (2.0, Point::new(2.0, 4.0))
        );
    }
}
