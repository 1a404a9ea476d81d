//! From a scene's files to drawings.

use std::path::Path;

use rayon::prelude::*;

use super::PipelineError;
use crate::input::{BitmapOptions, Drawing, Extent, HoleRule, InputError, SvgOptions, open_bitmap, open_svg};
use crate::matching::shared_holes;
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::outline::{Outline, OutlineError, Ring};
use crate::scene::{self, Facing, Holes, Scene};

/// Reads the drawings of a scene, in parallel: one a pose that has one of its own (deformed copies have none), in the scene's
/// order. Mirrored poses are reflected, picture and outline.
///
/// # Errors
/// [`PipelineError`] naming the first pose, in the scene's order, whose drawing cannot be used.
pub fn read_drawings(scene: &Scene) -> Result<Vec<Drawing>, PipelineError> {
    let read: Vec<Result<Drawing, PipelineError>> = scene
        .drawn_poses()
        .into_par_iter()
        .map(|pose| read_drawing(scene, pose, None))
        .collect();
    let mut drawings: Vec<Drawing> = read.into_iter().collect::<Result<_, _>>()?;
    if scene.input.holes == Holes::Match {
        cover_unshared_holes(&mut drawings);
    }
    Ok(drawings)
}

/// Makes openings of the holes that not all drawings have: the mesh covers them, and the texture's alpha opens and closes them. The others
/// come to stand in one order.
fn cover_unshared_holes(drawings: &mut [Drawing]) {
    if drawings.iter().all(|drawing| drawing.outline.holes().is_empty()) {
        return;
    }
    let outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    let shared = shared_holes(&outlines);
    let is_every_hole = |outline: &Outline| outline.holes().len() == shared.len();
    if outlines.iter().all(is_every_hole) {
        // The order is that of the matching.
        return;
    }
    for (pose, drawing) in drawings.iter_mut().enumerate() {
        let kept: Vec<usize> = shared.iter().map(|of_poses| of_poses[pose]).collect();
        drawing.outline = drawing.outline.with_holes_in_order(&kept);
    }
}

/// Draws vector drawings again whose pictures are coarser than frames at `frame_scale` pixels a unit.
pub(super) fn sharpen(scene: &Scene, drawings: &mut [Drawing], frame_scale: f64) -> Result<(), PipelineError> {
    let sharper: Vec<Result<(), PipelineError>> = drawings
        .par_iter_mut()
        .zip(scene.drawn_poses())
        .map(|(drawing, pose)| {
            let is_vector = scene.drawing_of(pose).is_some_and(|(_, source)| is_svg(&source.file));
            if is_vector && drawing.picture.pixels_per_unit < frame_scale {
                drawing.picture = read_drawing(scene, pose, Some(frame_scale))?.picture;
            }
            Ok(())
        })
        .collect();
    sharper.into_iter().collect()
}

/// Reads the drawing of one pose that has one of its own, by its index.
///
/// # Errors
/// As [`read_drawings`].
pub fn read_drawing_of(scene: &Scene, pose: usize) -> Result<Drawing, PipelineError> {
    read_drawing(scene, pose, None)
}

/// The drawing of pose `pose`; a vector drawing has `pixels_per_unit` in its picture.
fn read_drawing(scene: &Scene, pose: usize, pixels_per_unit: Option<f64>) -> Result<Drawing, PipelineError> {
    let path = scene.source_path(pose)?;
    let name = &scene.poses[pose].name;
    let Some((_, said)) = scene.drawing_of(pose) else {
        return Err(PipelineError::stage(&scene.names(), Some(pose), "it has no drawing"));
    };
    let holes = match scene.input.holes {
        Holes::Match | Holes::Keep => HoleRule::Keep,
        Holes::Fill => HoleRule::Fill,
    };
    let read = if is_svg(&path) {
        open_svg(
            &path,
            &SvgOptions {
                element: said.element.clone(),
                pixels_per_unit,
                holes,
                extent: match said.extent {
                    scene::Extent::Everything => Extent::Everything,
                    scene::Extent::Element => Extent::Element,
                },
            },
        )
    } else {
        open_bitmap(
            &path,
            &BitmapOptions {
                figure: said.reading.figure,
                gap: said.reading.gap,
                paper: said.reading.paper,
                threshold: said.reading.threshold,
                holes,
            },
        )
    };
    read.and_then(|drawing| match said.facing {
        Facing::AsDrawn => Ok(drawing),
        Facing::Mirrored => mirrored(drawing),
    })
    .map_err(|source| PipelineError::Drawing {
        pose: name.clone(),
        file: said.file.clone(),
        source: Box::new(source),
    })
}

fn is_svg(path: &Path) -> bool {
    path.extension()
        .is_some_and(|suffix| suffix.eq_ignore_ascii_case("svg"))
}

/// The drawing reflected left to right about the middle of its outline, so that it stays where it is.
pub(super) fn mirrored(drawing: Drawing) -> Result<Drawing, InputError> {
    let Drawing {
        outline,
        mut picture,
        art,
        notes,
        unit_px,
    } = drawing;
    for row in picture.pixels.chunks_exact_mut(picture.width.max(1)) {
        row.reverse();
    }
    let axis = mirror_axis(&outline);
    picture.origin.x = axis - picture.origin.x - picture.width as f64 / picture.pixels_per_unit;
    let reflect = |ring: &Ring| ring.map(|p| reflected(p, axis));
    let degenerate = |_| OutlineError::NoArea { ring: 0 };
    let outer = reflect(outline.outer()).map_err(degenerate)?;
    let holes = outline
        .holes()
        .iter()
        .map(reflect)
        .collect::<Result<_, _>>()
        .map_err(degenerate)?;
    let openings = outline
        .openings()
        .iter()
        .map(reflect)
        .collect::<Result<_, _>>()
        .map_err(degenerate)?;
    Ok(Drawing {
        outline: Outline::new(outer, holes)?.with_openings(openings),
        picture,
        art: art.map(|art| art.mirrored(axis)),
        notes,
        unit_px,
    })
}

/// Twice the x of the line about which a drawing is reflected.
pub(super) fn mirror_axis(outline: &Outline) -> f64 {
    bounding_box(outline.outer().points()).map_or(0.0, |(low, high)| low.x + high.x)
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
            art: None,
            notes: vec![],
            unit_px: 1.0,
        };
        let once = mirrored(drawing.clone()).expect("a drawing");
        // The outline is one unit wide, from 1 to 2, and stays there; so does the pixel under it.
        assert!(once.outline.outer().points().contains(&Point::new(2.0, 2.0)));
        assert_eq!((once.picture.origin.x, once.picture.pixels[2]), (-1.0, [1; 4]));
        assert_eq!(once.outline.area(), drawing.outline.area());
        let twice = mirrored(once).expect("a drawing");
        assert_eq!(twice.picture, drawing.picture);
        assert_eq!(twice.outline, drawing.outline);
    }
}
