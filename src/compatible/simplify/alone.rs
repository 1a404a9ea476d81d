//! Each outline simplified alone, before they are joined: several times fewer tuples than of full outlines.

use std::sync::Arc;

use rayon::prelude::*;

use super::collapse::Collapser;
use super::original::{OriginalRing, PoseOriginal};
use super::tuples::{Pin, TupleRing};
use super::{RingPoint, SimplifyError, SimplifyOptions};
use crate::outline::{Outline, Ring};

/// How much finer than the tolerance each outline alone is simplified first: fine enough that the joint step, not
/// this one, decides the shape.
const PRELIMINARY_SHARE: f64 = 0.05;

/// A shape is thin if its diagonal exceeds this many of its mean half-widths; its deviation is then measured against
/// those instead, or the polygon would be half as wide again as the shape. With the default tolerance it may deviate by
/// 0.32 half-widths.
const THIN_SHAPE: f64 = 16.0;

/// Outlines simplified each alone: what of a simplification needs no correspondence, so that it can be made while that is looked
/// for.
#[derive(Debug, Clone, Default)]
pub(crate) struct SimplifiedAlone {
    /// One a pose; none where a landmark's place is not known.
    pub(super) poses: Vec<Option<Arc<PoseAlone>>>,
    pub(super) tolerance: f64,
}

impl SimplifiedAlone {
    /// Simplifies those of the outlines whose landmarks all have a place: `landmarks` are #landmarks x #poses. What is in `before` already is
    /// taken from there.
    ///
    /// # Errors
    /// [`SimplifyError::BadTolerance`].
    pub(crate) fn new(
        outlines: &[Outline],
        landmarks: &[Vec<Option<RingPoint>>],
        options: &SimplifyOptions,
        before: &Self,
    ) -> Result<Self, SimplifyError> {
        options.check()?;
        let known = |pose: usize| -> Option<Vec<Pin>> {
            pins(landmarks.iter().map(|row| row.get(pose).copied().flatten())).collect()
        };
        let pins: Vec<Option<Vec<Pin>>> = (0..outlines.len()).map(known).collect();
        Ok(before.for_pins(outlines, &pins, options.tolerance))
    }

    /// Those for some landmarks a pose, from these as far as they are the same; none where there are no landmarks given.
    pub(super) fn for_pins(&self, outlines: &[Outline], pins: &[Option<Vec<Pin>>], tolerance: f64) -> Self {
        let pose = |(pose, (outline, pins)): (usize, (&Outline, &Option<Vec<Pin>>))| {
            let pins = pins.as_ref()?;
            let made = self.poses.get(pose).and_then(Option::as_ref);
            let is_same =
                |made: &&Arc<PoseAlone>| self.tolerance == tolerance && made.pins == *pins && made.outline == *outline;
            Some(match made.filter(is_same) {
                Some(same) => Arc::clone(same),
                None => Arc::new(PoseAlone::new(outline, pins.clone(), PRELIMINARY_SHARE * tolerance)),
            })
        };
        Self {
            poses: outlines.par_iter().zip(pins).enumerate().map(pose).collect(),
            tolerance,
        }
    }
}

/// What a simplification makes of each pose without regard to the others.
#[derive(Debug)]
pub(super) struct PoseAlone {
    pub(super) outline: Outline,
    pub(super) original: PoseOriginal,
    /// The landmarks on its rings.
    pub(super) pins: Vec<Pin>,
    /// Its rings, simplified alone.
    pub(super) rings: Vec<TupleRing>,
}

/// Area over perimeter: half the width of a long strip, a quarter of the diameter of a disc.
fn mean_half_width(outline: &Outline) -> f64 {
    outline.area() / outline.rings().iter().map(Ring::perimeter).sum::<f64>()
}

/// The landmarks of one pose, of which `places` has one each, if it is known.
pub(super) fn pins(places: impl Iterator<Item = Option<RingPoint>>) -> impl Iterator<Item = Option<Pin>> {
    places.enumerate().map(|(landmark, place)| {
        let at = place?;
        Some(Pin { landmark, at })
    })
}

impl PoseAlone {
    /// An outline simplified alone, to `tolerance` of its size.
    pub(super) fn new(outline: &Outline, pins: Vec<Pin>, tolerance: f64) -> Self {
        let original = PoseOriginal {
            rings: outline.rings().iter().map(OriginalRing::new).collect(),
            size: outline.diagonal().min(THIN_SHAPE * mean_half_width(outline)),
        };
        let single = |(ring, points): (usize, &Ring)| TupleRing::single(points, ring, &pins);
        let single = outline.rings().iter().enumerate().map(single).collect();
        let mut rings = Collapser::new(single, &[&original], tolerance).run();
        for ring in &mut rings {
            ring.tuples.sort_by(|a, b| a.parameters[0].total_cmp(&b.parameters[0]));
        }
        Self {
            outline: outline.clone(),
            original,
            pins,
            rings,
        }
    }
}
