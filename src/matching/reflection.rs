//! Whether a pose faces the other way: how well its reflection fits the reference, beside itself.

use super::coarse::{Form, coarse_matches};
use super::curve::Samples;
use crate::math::Point;
use crate::math::point::cross;
use crate::outline::Ring;

/// Samples of the coarse matches that look for mirrored poses.
pub(super) const MIRROR_SAMPLES: usize = 96;
/// How many of them are looked at.
const MIRROR_CANDIDATES: usize = 3;
/// A reflection whose elastic cost exceeds the pose's own by more than this factor is not the better match.
const MIRROR_COST_MARGIN: f32 = 1.05;

/// How much worse the reflection of a pose fits the reference than the pose itself: the ratio of what is left of the
/// outlines' distance when one is moved, turned and scaled onto the other as its coarse match says; at least 1 where the
/// reflection costs clearly more in the match itself, since a bent symmetric form may be nearer to its reflection.
///
/// Facing left or right is a matter of the whole form, which the elastic cost alone, mostly fine detail, hardly shows.
pub(super) fn reflection_ratio(reference: (&Form, &Samples), ring: &Ring, form: &Form) -> f64 {
    let Ok(mirrored) = Form::mirrored(ring) else {
        return 1.0;
    };
    let (own, reflected) = (best_fit(reference, form), best_fit(reference, &mirrored));
    // Two equal forms leave nothing, whichever way.
    let ratio = if own.distance > 1e-9 {
        reflected.distance / own.distance
    } else {
        1.0
    };
    if reflected.cost > MIRROR_COST_MARGIN * own.cost {
        ratio.max(1.0)
    } else {
        ratio
    }
}

/// The least distance over some matches, and the least elastic cost.
struct Fit {
    distance: f64,
    cost: f32,
}

/// The least root mean square distance, relative to the second form's size, between the points that any of the best
/// coarse matches pairs, over all similarities.
fn best_fit((first, samples): (&Form, &Samples), second: &Form) -> Fit {
    let matches = coarse_matches(samples, &second.even_samples(MIRROR_SAMPLES), MIRROR_CANDIDATES);
    let cost = matches.first().map_or(f32::INFINITY, |matched| matched.cost);
    let distance = matches
        .iter()
        .map(|matched| {
            let pairs: Vec<(Point, Point)> = samples
                .parameters
                .iter()
                .map(|t| (first.curve.at(*t), second.curve.at(matched.map.at(*t))))
                .collect();
            let count = pairs.len() as f64;
            let centre = pairs.iter().fold((Point::zeros(), Point::zeros()), |c, (a, b)| {
                (c.0 + a / count, c.1 + b / count)
            });
            let (mut aa, mut bb, mut ab) = (0.0, 0.0, Point::zeros());
            for (a, b) in pairs {
                let (a, b) = (a - centre.0, b - centre.1);
                aa += a.norm_squared();
                bb += b.norm_squared();
                ab += Point::new(a.dot(&b), cross(a, b));
            }
            // The best similarity is the complex number `ab / aa`.
            (1.0 - ab.norm_squared() / (aa * bb)).max(0.0).sqrt()
        })
        .fold(f64::INFINITY, f64::min);
    Fit { distance, cost }
}
