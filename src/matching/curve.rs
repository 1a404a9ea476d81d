//! A ring prepared for matching: place and size taken out, position and turning cheap to ask for.

use crate::math::point::{cross, nearest_on_segment};
use crate::math::{Point, angle, wrapped};
use crate::outline::{ArcLength, Ring, RingError};

/// Half-windows over which turning is measured, as fractions of the perimeter, with the weight each has in the match.
type Windows = &'static [(f64, f32)];

/// Windows of the fine match.
///
/// Fine detail is the signal: on silhouettes warped by known maps, smoothed outlines match worse. The longest window
/// counts half; it is what holds a match in place when the outline is noisy.
const FINE_WINDOWS: Windows = &[(0.003, 1.0), (0.006, 1.0), (0.012, 1.0), (0.025, 0.5)];

/// Windows of the coarse match besides those. It decides what corresponds to what, and long windows see whole limbs: of
/// unlike drawings only those are alike.
const LONG_WINDOWS: Windows = &[(0.05, 1.0), (0.1, 1.0), (0.2, 1.0)];

/// Even samples that stand in for the ring when positions are asked for: a twentieth of a percent of the perimeter.
const FINE_SAMPLES: usize = 2048;

/// A closed curve of length 1 around the origin.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    arc: ArcLength,
    /// The centroid of the ring's length and its perimeter, in source units.
    centre: Point,
    perimeter: f64,
    /// Even samples of two turns and a bit: what is near to a place is in one piece.
    fine: Vec<Point>,
    /// The parameter of the vertex farthest from the centroid: it depends on the shape, not on the ring's first point.
    pub(super) start: f64,
}

impl Curve {
    /// `ring` scaled to length 1, the centroid of its length moved to the origin.
    pub(super) fn new(ring: &Ring) -> Result<Self, RingError> {
        let perimeter = ring.perimeter();
        let mut centre = Point::zeros();
        for (a, b) in ring.edges() {
            centre += (a + b) * (0.5 * (b - a).norm() / perimeter);
        }
        let scaled = ring.map(|p| (p - centre) / perimeter)?;
        let arc = ArcLength::new(&scaled);
        let mut farthest = (0, 0.0);
        for (vertex, p) in scaled.points().iter().enumerate() {
            if p.norm_squared() > farthest.1 {
                farthest = (vertex, p.norm_squared());
            }
        }
        let start = arc.vertex_parameters()[farthest.0];
        let turn: Vec<Point> = (0..FINE_SAMPLES)
            .map(|k| arc.at(k as f64 / FINE_SAMPLES as f64))
            .collect();
        let mut fine = turn.repeat(2);
        fine.push(turn[0]);
        Ok(Self {
            arc,
            centre,
            perimeter,
            fine,
            start,
        })
    }

    /// The curve seen in a mirror, run so that its area keeps its sign: its parameter `t` is this one's `1 - t`.
    pub(super) fn mirrored(ring: &Ring) -> Result<Self, RingError> {
        Self::new(&ring.map(|p| Point::new(-p.x, p.y))?.reversed())
    }

    /// A place of the source in the coordinates of the curve.
    pub(super) fn normalised(&self, place: Point) -> Point {
        (place - self.centre) / self.perimeter
    }

    /// A place in the coordinates of the curve in those of the source.
    pub(super) fn in_source(&self, place: Point) -> Point {
        place * self.perimeter + self.centre
    }

    /// The point at parameter `t`.
    pub(super) fn at(&self, t: f64) -> Point {
        let (index, along) = fine_position(t);
        let (a, b) = (self.fine[index], self.fine[index + 1]);
        a + (b - a) * along
    }

    /// The turning at parameter `t`, whose point is `here`, over a half-window: the angle between the chords to the points
    /// that far behind and ahead, in radians.
    fn turning_rad(&self, here: Point, t: f64, window: f64) -> f64 {
        let (behind, ahead) = (self.arc.at(t - window), self.arc.at(t + window));
        angle::between(here - behind, ahead - here)
    }

    /// The parameter, in `[t - reach, t + reach]`, of the point nearest to `p`; not wrapped. `reach` is half a turn at most.
    pub(super) fn nearest_within(&self, p: Point, t: f64, reach: f64) -> f64 {
        let count = FINE_SAMPLES as f64;
        let (first, last) = (
            ((t - reach) * count).floor() as i64,
            ((t + reach) * count).ceil() as i64,
        );
        let begin = first.rem_euclid(FINE_SAMPLES as i64) as usize;
        let points = &self.fine[begin..=begin + (last - first).clamp(0, FINE_SAMPLES as i64) as usize];
        // Chords are no longer than their arcs: what begins farther away comes no nearer than the nearest end.
        let within = (least_squared(points, p).sqrt() + 1.5 / count).powi(2);
        let mut best = (f64::INFINITY, 0);
        for (k, ends) in points.windows(2).enumerate() {
            let (from, along) = (p - ends[0], ends[1] - ends[0]);
            let squared = from.norm_squared();
            if squared > within {
                continue;
            }
            let (ahead, length_squared) = (from.dot(&along), along.norm_squared());
            let squared = if ahead <= 0.0 {
                squared
            } else if ahead >= length_squared {
                (p - ends[1]).norm_squared()
            } else {
                cross(along, from).powi(2) / length_squared
            };
            if squared < best.0 {
                best = (squared, k);
            }
        }
        let Some(&[a, b]) = points[best.1..].first_chunk() else {
            return t;
        };
        let (along, _) = nearest_on_segment(p, a, b);
        (((first + best.1 as i64) as f64 + along) / count).clamp(t - reach, t + reach)
    }
}

/// The least squared distance of any of the points from `p`.
fn least_squared(points: &[Point], p: Point) -> f64 {
    // Several at a time, as the processor can.
    const LANES: usize = 4;
    let mut least = [f64::INFINITY; LANES];
    let mut lower = |points: &[Point]| {
        for (least, q) in least.iter_mut().zip(points) {
            let squared = (p - q).norm_squared();
            *least = if squared < *least { squared } else { *least };
        }
    };
    let mut chunks = points.chunks_exact(LANES);
    (&mut chunks).for_each(&mut lower);
    lower(chunks.remainder());
    least.into_iter().fold(f64::INFINITY, f64::min)
}

/// A curve at some parameters: what a match compares.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    /// The parameters: increasing, not wrapped, less than one turn.
    pub(super) parameters: Vec<f64>,
    /// The turning at each of them in radians, times the window's weight: #windows x #parameters.
    pub(super) turning: Vec<Vec<f32>>,
}

impl Samples {
    /// Measures `curve` at `parameters` for a fine match.
    pub(super) fn fine(curve: &Curve, parameters: Vec<f64>) -> Self {
        Self {
            turning: turning(curve, &parameters, FINE_WINDOWS),
            parameters,
        }
    }

    /// Measures `curve` at `parameters` for a coarse match.
    pub(super) fn coarse(curve: &Curve, parameters: Vec<f64>) -> Self {
        Self::fine(curve, parameters).with_long_windows(curve)
    }

    /// What a coarse match asks for besides.
    pub(super) fn with_long_windows(mut self, curve: &Curve) -> Self {
        self.turning.extend(turning(curve, &self.parameters, LONG_WINDOWS));
        self
    }

    /// Every `stride`-th sample from `first` on, once around.
    pub(super) fn around(&self, first: usize, stride: usize) -> Self {
        let count = self.parameters.len();
        let every = |values: &Vec<f32>| {
            (0..count)
                .step_by(stride)
                .map(|k| values[(first + k) % count])
                .collect()
        };
        Self {
            parameters: around(&self.parameters, first, stride),
            turning: self.turning.iter().map(every).collect(),
        }
    }
}

/// Every `stride`-th of a closed curve's parameters from `first` on, once around; whole turns are kept.
pub(super) fn around(parameters: &[f64], first: usize, stride: usize) -> Vec<f64> {
    let count = parameters.len();
    (0..count)
        .step_by(stride)
        .map(|k| parameters[(first + k) % count] + ((first + k) / count) as f64)
        .collect()
}

/// By window, the weighted turning at each of the parameters.
fn turning(curve: &Curve, parameters: &[f64], windows: Windows) -> Vec<Vec<f32>> {
    let mut turning = vec![Vec::with_capacity(parameters.len()); windows.len()];
    for &t in parameters {
        let here = curve.arc.at(t);
        for (&(window, weight), values) in windows.iter().zip(&mut turning) {
            values.push(weight * curve.turning_rad(here, t, window) as f32);
        }
    }
    turning
}

/// The fine sample before `t`, and how far `t` is towards the next.
fn fine_position(t: f64) -> (usize, f64) {
    let position = wrapped(t) * FINE_SAMPLES as f64;
    let index = (position as usize).min(FINE_SAMPLES - 1);
    (index, position - index as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_turns_by_a_quarter_at_its_corners() {
        let ring = Ring::new([[5.0, 5.0], [9.0, 5.0], [9.0, 9.0], [5.0, 9.0]].map(Point::from)).expect("a ring");
        let curve = Curve::new(&ring).expect("a curve");
        assert!((curve.at(0.0) - Point::new(-0.125, -0.125)).norm() < 1e-12);
        let turning = |t: f64| curve.turning_rad(curve.at(t), t, 0.003);
        assert!((turning(0.25) - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert!(turning(0.125).abs() < 1e-9);
        assert!((curve.nearest_within(Point::new(0.05, -0.3), 0.1, 0.2) - 0.175).abs() < 1e-9);
        assert_eq!(curve.nearest_within(Point::new(0.3, -0.3), 0.1, 0.05), 0.1 + 0.05);
    }
}
