//! From a scene's files to drawings.

use std::path::Path;

use rayon::prelude::*;

use super::PipelineError;
use crate::input::{BitmapOptions, Drawing, HoleRule, InputError, open_bitmap};
use crate::math::Point;
use crate::outline::{Outline, OutlineError, Ring};
use crate::scene::{Facing, Holes, Scene};

/// Reads the drawings of all poses of a scene, in parallel; mirrored poses are reflected, picture and outline.
///
/// # Errors
/// [`PipelineError`] naming the first pose, in the scene's order, whose drawing cannot be used.
pub fn read_drawings(scene: &Scene) -> Result<Vec<Drawing>, PipelineError> {
    let paths: Vec<_> = (0..scene.poses.len())
        .map(|pose| scene.source_path(pose))
        .collect::<Result<_, _>>()?;
    let read: Vec<Result<Drawing, InputError>> = paths
        .par_iter()
        .zip(&scene.poses)
        .map(|(path, pose)| {
            let drawing = read_drawing(path, pose.element.as_deref(), scene)?;
            match pose.facing {
                Facing::AsDrawn => Ok(drawing),
                Facing::Mirrored => mirrored(drawing),
            }
        })
        .collect();
    read.into_iter()
        .zip(&scene.poses)
        .map(|(drawing, pose)| {
            drawing.map_err(|source| PipelineError::Drawing {
                pose: pose.name.clone(),
                file: pose.source.clone(),
                source,
            })
        })
        .collect()
}

fn read_drawing(path: &Path, _element: Option<&str>, scene: &Scene) -> Result<Drawing, InputError> {
    let holes = match scene.input.holes {
        Holes::Keep => HoleRule::Keep,
        Holes::Fill => HoleRule::Fill,
    };
    let options = BitmapOptions {
        threshold: scene.input.threshold,
        holes,
    };
    open_bitmap(path, &options)
}

/// The drawing reflected left to right within its picture.
pub(super) fn mirrored(drawing: Drawing) -> Result<Drawing, InputError> {
    let Drawing {
        outline,
        mut picture,
        notes,
    } = drawing;
    for row in picture.pixels.chunks_exact_mut(picture.width.max(1)) {
        row.reverse();
    }
    let axis = mirror_axis(&picture);
    let reflect = |ring: &Ring| ring.map(|p| reflected(p, axis));
    let degenerate = |_| OutlineError::NoArea { ring: 0 };
    let outer = reflect(outline.outer()).map_err(degenerate)?;
    let holes = outline
        .holes()
        .iter()
        .map(reflect)
        .collect::<Result<_, _>>()
        .map_err(degenerate)?;
    Ok(Drawing {
        outline: Outline::new(outer, holes)?,
        picture,
        notes,
    })
}

/// Twice the x of the line about which a picture is reflected.
pub(super) fn mirror_axis(picture: &crate::input::Picture) -> f64 {
    2.0 * picture.origin.x + picture.width as f64 / picture.pixels_per_unit
}

/// A point reflected about the line at half of `axis`.
pub(super) fn reflected(p: Point, axis: f64) -> Point {
    Point::new(axis - p.x, p.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Picture;

    #[test]
    fn mirroring_twice_changes_nothing_and_once_moves_pixels_with_the_outline() {
        let ring = Ring::new([[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0]].map(Point::from)).expect("a ring");
        let drawing = Drawing {
            outline: Outline::new(ring, vec![]).expect("simple"),
            picture: Picture {
                width: 4,
                height: 1,
                pixels: vec![[0; 4], [1; 4], [2; 4], [3; 4]],
                origin: Point::zeros(),
                pixels_per_unit: 1.0,
            },
            notes: vec![],
        };
        let once = mirrored(drawing.clone()).expect("a drawing");
        assert_eq!(once.picture.pixels[2], [1; 4]);
        assert!(once.outline.outer().points().contains(&Point::new(3.0, 2.0)));
        assert_eq!(once.outline.area(), drawing.outline.area());
        let twice = mirrored(once).expect("a drawing");
        assert_eq!(twice.picture, drawing.picture);
        assert_eq!(twice.outline, drawing.outline);
    }
}
