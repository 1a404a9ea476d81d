//! Salient points of a closed curve, found in curvature scale space.
//!
//! Source: Mokhtarian and Mackworth 1992, "A theory of multiscale, curvature-based shape representation". The curve is
//! smoothed by Gaussians of growing width; an extremum of curvature that survives much smoothing is salient.
//!
//! 1. Sample the curve evenly and smooth the positions at each of [`SCALES`].
//! 2. At each scale, take the samples where the curvature has a local extremum away from zero.
//! 3. From the coarsest scale down, follow each extremum to the nearest one of its sign at the next finer scale; what is
//!    left over there starts a new point. Its place is where it ends at the finest scale.
//!
//! *Difference from the source*: extrema are followed, not zero crossings: what a person would name (a tip, a notch) is an
//! extremum.
//!
//! Cost O(#samples x #scales x width).

use std::f64::consts::TAU;

use super::curve::Curve;
use crate::math::{Point, angle};

/// Even samples of the curve.
const SAMPLES: usize = 256;
/// Standard deviations of the smoothing, coarse to fine, as fractions of the perimeter.
const SCALES: [f64; 7] = [0.04, 0.028, 0.02, 0.014, 0.01, 0.007, 0.005];
/// Least curvature of an extremum, relative to that of a circle of the same length.
const LEAST_CURVATURE: f64 = 2.0;
/// How far an extremum may move from one scale to the next, in standard deviations of the coarser.
const REACH: f64 = 1.5;

/// A tip or a notch of an outline that stays while the outline is smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SalientPoint {
    /// Its normalised arc-length parameter, in `[0, 1)`.
    pub parameter: f64,
    /// The widest smoothing that it survives, as a fraction of the perimeter.
    pub scale: f64,
    /// The curvature there, relative to a circle of the same length: positive at tips, negative at notches.
    pub curvature: f64,
}

/// The salient points of `curve`, in order of their parameter.
pub(super) fn salient_points(curve: &Curve) -> Vec<SalientPoint> {
    let points: Vec<Point> = (0..SAMPLES).map(|k| curve.at(k as f64 / SAMPLES as f64)).collect();
    let mut followed: Vec<(usize, SalientPoint)> = Vec::new();
    for (level, scale) in SCALES.into_iter().enumerate() {
        let mut extrema = curvature_extrema(&smoothed(&points, scale * SAMPLES as f64));
        let reach = REACH * SCALES[level.saturating_sub(1)] * SAMPLES as f64;
        for (at, point) in &mut followed {
            let nearest = extrema
                .iter()
                .enumerate()
                .filter(|(_, (_, curvature))| curvature * point.curvature > 0.0)
                .map(|(index, (place, _))| (cyclic_distance(*place, *at), index))
                .min();
            if let Some((distance, index)) = nearest
                && distance as f64 <= reach
            {
                (*at, _) = extrema.swap_remove(index);
            }
        }
        for (at, curvature) in extrema {
            let point = SalientPoint {
                parameter: 0.0,
                scale,
                curvature,
            };
            followed.push((at, point));
        }
    }
    let mut found: Vec<SalientPoint> = followed
        .into_iter()
        .map(|(at, point)| SalientPoint {
            parameter: at as f64 / SAMPLES as f64,
            ..point
        })
        .collect();
    found.sort_by(|a, b| a.parameter.total_cmp(&b.parameter));
    found
}

fn cyclic_distance(a: usize, b: usize) -> usize {
    let gap = a.abs_diff(b);
    gap.min(SAMPLES - gap)
}

fn smoothed(points: &[Point], deviation: f64) -> Vec<Point> {
    let reach = (3.0 * deviation).ceil() as usize;
    let mut kernel: Vec<f64> = (0..=reach)
        .map(|k| (-0.5 * (k as f64 / deviation).powi(2)).exp())
        .collect();
    let sum = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
    kernel.iter_mut().for_each(|weight| *weight /= sum);
    let count = points.len();
    (0..count)
        .map(|k| {
            let mut mean = points[k] * kernel[0];
            for (offset, weight) in kernel.iter().enumerate().skip(1) {
                mean += (points[(k + offset) % count] + points[(k + count - offset % count) % count]) * *weight;
            }
            mean
        })
        .collect()
}

/// The samples where the curvature is a local extremum, with it, relative to a circle of the same length.
fn curvature_extrema(points: &[Point]) -> Vec<(usize, f64)> {
    let count = points.len();
    let edge = |k: usize| points[(k + 1) % count] - points[k % count];
    let length: f64 = (0..count).map(|k| edge(k).norm()).sum();
    let curvature: Vec<f64> = (0..count)
        .map(|k| {
            let (before, after) = (edge(k + count - 1), edge(k));
            let step = 0.5 * (before.norm() + after.norm());
            if step > 0.0 {
                angle::between(before, after) / step * length / TAU
            } else {
                0.0
            }
        })
        .collect();
    (0..count)
        .filter(|k| {
            let (before, here, after) = (
                curvature[(k + count - 1) % count],
                curvature[*k],
                curvature[(k + 1) % count],
            );
            let sign = here.signum();
            here.abs() >= LEAST_CURVATURE && sign * here > sign * before && sign * here >= sign * after
        })
        .map(|k| (k, curvature[k]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Ring;

    #[test]
    fn a_cross_has_eight_tips_and_four_notches() {
        let corners = [
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 3.0],
            [1.0, 3.0],
            [1.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
            [1.0, 1.0],
        ];
        let ring = Ring::new(corners.map(Point::from)).expect("a ring");
        let points = salient_points(&Curve::new(&ring).expect("a curve"));
        let tips: Vec<_> = points.iter().filter(|p| p.curvature > 0.0).collect();
        let notches: Vec<_> = points.iter().filter(|p| p.curvature < 0.0).collect();
        assert_eq!((tips.len(), notches.len()), (8, 4), "{points:?}");
        for point in points {
            let corner = point.parameter * 12.0;
            assert!((corner - corner.round()).abs() < 0.06, "{point:?}");
        }
    }

    #[test]
    fn a_circle_has_no_salient_point() {
        let circle = (0..100).map(|k| crate::math::rotation(k as f64 * TAU / 100.0) * Point::new(50.0, 0.0));
        let curve = Curve::new(&Ring::new(circle).expect("a ring")).expect("a curve");
        assert_eq!(salient_points(&curve), vec![]);
    }
}
