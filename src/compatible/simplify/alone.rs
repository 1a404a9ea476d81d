//! Each outline simplified alone, before they are joined: several times fewer tuples than of full outlines.

use super::collapse::{Collapser, OriginalRing, PoseOriginal};
use super::tuples::{Pin, TupleRing};
use crate::outline::{Outline, Ring};

/// A shape is thin if its diagonal exceeds this many of its mean half-widths; its deviation is then measured against
/// those instead, or the polygon would be half as wide again as the shape. With the default tolerance it may deviate by
/// 0.32 half-widths.
const THIN_SHAPE: f64 = 16.0;

/// What a simplification makes of each pose without regard to the others.
#[derive(Debug)]
pub(super) struct PoseAlone {
    pub(super) outline: Outline,
    pub(super) original: PoseOriginal,
    /// The landmarks on its outer ring.
    pub(super) pins: Vec<Pin>,
    /// Its rings, simplified alone.
    pub(super) rings: Vec<TupleRing>,
}

/// Area over perimeter: half the width of a long strip, a quarter of the diameter of a disc.
fn mean_half_width(outline: &Outline) -> f64 {
    outline.area() / outline.rings().iter().map(Ring::perimeter).sum::<f64>()
}

/// The landmarks of one pose: `landmarks` are #landmarks x #poses.
pub(super) fn pins(landmarks: &[Vec<f64>], pose: usize) -> Vec<Pin> {
    let numbered = landmarks.iter().enumerate();
    numbered
        .filter_map(|(landmark, row)| {
            let &parameter = row.get(pose)?;
            Some(Pin { landmark, parameter })
        })
        .collect()
}

impl PoseAlone {
    /// An outline simplified alone, to `tolerance` of its size.
    pub(super) fn new(outline: &Outline, pins: Vec<Pin>, tolerance: f64) -> Self {
        let original = PoseOriginal {
            rings: outline.rings().iter().map(OriginalRing::new).collect(),
            size: outline.diagonal().min(THIN_SHAPE * mean_half_width(outline)),
        };
        let single = |(ring, points): (usize, &Ring)| TupleRing::single(points, if ring == 0 { &pins } else { &[] });
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
