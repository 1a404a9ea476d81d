//! The drawings of a layer as they are used: reflected where their poses are, and as fine as frames need.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::landmark_ring::hole_ties;
use super::spec::{DrawnPose, Facing, LayerSpec, SvgSource, UnsharedHoles};
use crate::input::{Drawing, InputError};
use crate::matching::shared_holes;
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::outline::Outline;

impl DrawnPose {
    /// The drawing as it is used: reflected if the pose is. One that is not is shared, not copied.
    ///
    /// # Errors
    /// [`InputError`] if the reflected outline is none, for want of digits.
    pub fn as_used(&self) -> Result<Arc<Drawing>, InputError> {
        if self.facing != Facing::Mirrored && self.shift == Point::zeros() {
            return Ok(Arc::clone(&self.drawing));
        }
        self.placed(self.drawing.as_ref().clone()).map(Arc::new)
    }

    /// A place of the drawing in the drawing as it is used.
    #[must_use]
    pub fn used_place(&self, place: Point) -> Point {
        self.turned(place) + self.shift
    }

    /// The place of the drawing that [`Self::used_place`] takes to `place`.
    #[must_use]
    pub fn drawn_place(&self, place: Point) -> Point {
        self.turned(place - self.shift)
    }

    /// A place reflected if the pose is. Its own inverse.
    fn turned(&self, place: Point) -> Point {
        match self.facing {
            Facing::AsDrawn | Facing::Auto => place,
            Facing::Mirrored => reflected(place, self.axis.unwrap_or_else(|| mirror_axis(&self.drawing.outline))),
        }
    }

    /// A drawing of this pose reflected and moved as the pose says.
    fn placed(&self, drawing: Drawing) -> Result<Drawing, InputError> {
        let turned = match self.facing {
            Facing::AsDrawn | Facing::Auto => drawing,
            Facing::Mirrored => mirrored(drawing, self.axis)?,
        };
        if self.shift == Point::zeros() {
            return Ok(turned);
        }
        moved(turned, self.shift)
    }

    /// The drawing as it is used, of a vector drawing whose pixels are made again, `pixels_per_unit` of them.
    #[cfg(feature = "svg")]
    fn finer(&self, svg: &SvgSource, pixels_per_unit: f64) -> Result<Drawing, InputError> {
        let mut options = svg.options.clone();
        options.pixels_per_unit = Some(pixels_per_unit);
        self.placed(crate::input::read_svg(&svg.bytes, &options)?)
    }

    /// The drawing as it is used: nothing here can read a vector drawing.
    #[cfg(not(feature = "svg"))]
    fn finer(&self, _: &SvgSource, _: f64) -> Result<Drawing, InputError> {
        self.as_used().map(Arc::unwrap_or_clone)
    }
}

/// The drawings of a layer as they are used, one a drawn pose, in order.
pub(super) fn used_drawings(layer: &LayerSpec) -> Result<Vec<Arc<Drawing>>, PipelineError> {
    let placed = placed_drawings(layer, |_| None)?;
    Ok(match covered_outlines(layer, &placed)? {
        Some(outlines) => with_outlines(&placed, outlines),
        None => placed,
    })
}

/// The drawings of a layer reflected and moved as their poses say, with all their holes. Those whose pose `kept` knows are taken from there.
pub(super) fn placed_drawings(
    layer: &LayerSpec,
    kept: impl Fn(&DrawnPose) -> Option<Arc<Drawing>> + Sync,
) -> Result<Vec<Arc<Drawing>>, PipelineError> {
    let drawn: Vec<&DrawnPose> = layer.drawn().collect();
    let used: Vec<Result<Arc<Drawing>, InputError>> = (drawn.into_par_iter())
        .map(|pose| kept(pose).map_or_else(|| pose.as_used(), Ok))
        .collect();
    (used.into_iter().zip(layer.drawn_poses()))
        .map(|(drawing, pose)| drawing.map_err(|source| refusal(layer, pose, source)))
        .collect()
}

/// The outlines of drawings with the holes that not all of them have made openings: the mesh covers them, and the texture's alpha opens and closes
/// them. The others come to stand in one order. `None` where the drawings keep all their holes.
pub(super) fn covered_outlines(
    layer: &LayerSpec,
    drawings: &[Arc<Drawing>],
) -> Result<Option<Vec<Outline>>, PipelineError> {
    if layer.unshared_holes != UnsharedHoles::Cover || drawings.iter().all(|d| d.outline.holes().is_empty()) {
        return Ok(None);
    }
    let outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    let ties = hole_ties(&layer.only_drawn(), &outlines)?;
    let shared = shared_holes(&outlines, &ties);
    let is_every_hole = |outline: &Outline| outline.holes().len() == shared.len();
    if outlines.iter().all(is_every_hole) {
        // The order is that of the matching.
        return Ok(None);
    }
    let covered = outlines.iter().enumerate().map(|(pose, outline)| {
        let kept: Vec<usize> = shared.iter().map(|of_poses| of_poses[pose]).collect();
        outline.with_holes_in_order(&kept)
    });
    Ok(Some(covered.collect()))
}

/// The drawings with these outlines; those whose outline it is already are shared, not copied.
pub(super) fn with_outlines(drawings: &[Arc<Drawing>], outlines: Vec<Outline>) -> Vec<Arc<Drawing>> {
    let drawn = |(drawing, outline): (&Arc<Drawing>, Outline)| {
        if outline == drawing.outline {
            return Arc::clone(drawing);
        }
        Arc::new(Drawing {
            outline,
            ..drawing.as_ref().clone()
        })
    };
    drawings.iter().zip(outlines).map(drawn).collect()
}

/// Draws vector drawings again whose pictures are coarser than frames at `frame_scale` pixels a unit.
pub(super) fn sharpen(layer: &LayerSpec, drawings: &mut [Arc<Drawing>], frame_scale: f64) -> Result<(), PipelineError> {
    let drawn: Vec<&DrawnPose> = layer.drawn().collect();
    let sharper: Vec<Result<(), InputError>> = drawings
        .par_iter_mut()
        .zip(drawn)
        .map(|(drawing, pose)| {
            let Some(svg) = &pose.svg else { return Ok(()) };
            if drawing.picture.pixels_per_unit < frame_scale {
                let picture = pose.finer(svg, frame_scale)?.picture;
                // The curves are drawn by themselves: here pixels are wanted.
                *drawing = Arc::new(Drawing {
                    picture,
                    outline: drawing.outline.clone(),
                    art: None,
                    notes: Vec::new(),
                    unit_px: drawing.unit_px,
                    canvas: drawing.canvas,
                    parts: Vec::new(),
                });
            }
            Ok(())
        })
        .collect();
    (sharper.into_iter().zip(layer.drawn_poses()))
        .try_for_each(|(done, pose)| done.map_err(|source| refusal(layer, pose, source)))
}

fn refusal(layer: &LayerSpec, pose: usize, source: InputError) -> PipelineError {
    PipelineError::Drawing {
        pose: layer.poses[pose].name.clone(),
        source: Box::new(source),
    }
}

/// The drawing reflected left to right, about the middle of its outline if nothing else is said, so that it stays where it is. Without its
/// parts, which are drawings of their own by then.
pub(super) fn mirrored(drawing: Drawing, axis: Option<f64>) -> Result<Drawing, InputError> {
    let Drawing {
        outline,
        mut picture,
        art,
        notes,
        unit_px,
        canvas,
        parts: _,
    } = drawing;
    for row in picture.pixels.chunks_exact_mut(picture.width.max(1)) {
        row.reverse();
    }
    let axis = axis.unwrap_or_else(|| mirror_axis(&outline));
    picture.origin.x = axis - picture.origin.x - picture.width as f64 / picture.pixels_per_unit;
    Ok(Drawing {
        outline: outline.map(|p| reflected(p, axis))?,
        picture,
        art: art.map(|art| art.mirrored(axis)),
        notes,
        unit_px,
        canvas,
        parts: Vec::new(),
    })
}

/// The drawing moved by `shift`, its page with it.
fn moved(drawing: Drawing, shift: Point) -> Result<Drawing, InputError> {
    let outline = drawing.outline.map(|p| p + shift)?;
    let mut picture = drawing.picture;
    picture.origin += shift;
    Ok(Drawing {
        outline,
        picture,
        art: drawing.art.map(|art| art.moved(shift)),
        notes: drawing.notes,
        unit_px: drawing.unit_px,
        canvas: drawing.canvas.moved(shift),
        parts: Vec::new(),
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
    use crate::input::{Canvas, Picture};
    use crate::outline::Ring;

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
            canvas: Canvas::of_pixels(4, 1),
            parts: vec![],
        };
        let once = mirrored(drawing.clone(), None).expect("a drawing");
        // The outline is one unit wide, from 1 to 2, and stays there; so does the pixel under it.
        assert!(once.outline.outer().points().contains(&Point::new(2.0, 2.0)));
        assert_eq!((once.picture.origin.x, once.picture.pixels[2]), (-1.0, [1; 4]));
        assert_eq!(once.outline.area(), drawing.outline.area());
        let twice = mirrored(once, None).expect("a drawing");
        assert_eq!(twice.picture, drawing.picture);
        assert_eq!(twice.outline, drawing.outline);
    }
}
