//! The full-resolution rings that simplified ones must enclose and stay close to.

use crate::math::{Point, point};
use crate::outline::{ArcLength, Ring};

/// The full-resolution ring that a simplified ring must enclose and stay close to.
#[derive(Debug)]
pub(super) struct OriginalRing {
    points: Vec<Point>,
    parameters: Vec<f64>,
    longest_edge: f64,
    doubled_area: f64,
    perimeter: f64,
}

impl OriginalRing {
    pub(super) fn new(ring: &Ring) -> Self {
        let parameters = ArcLength::new(ring).vertex_parameters().to_vec();
        Self {
            points: ring.points().to_vec(),
            parameters,
            longest_edge: ring.edges().map(|(a, b)| (b - a).norm()).fold(0.0, f64::max),
            doubled_area: 2.0 * ring.signed_area(),
            perimeter: ring.perimeter(),
        }
    }

    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    pub(super) fn longest_edge(&self) -> f64 {
        self.longest_edge
    }

    /// The points whose parameters lie strictly between `start` and `end`, cyclically.
    pub(super) fn between(&self, start: f64, end: f64) -> impl Iterator<Item = (f64, Point)> + '_ {
        let count = self.points.len();
        let first = self.parameters.partition_point(|&t| t <= start);
        let last = self.parameters.partition_point(|&t| t < end);
        let steps = if end >= start {
            last.saturating_sub(first)
        } else {
            count - first + last
        };
        (first..first + steps).map(move |k| (self.parameters[k % count], self.points[k % count]))
    }

    pub(super) fn perimeter(&self) -> f64 {
        self.perimeter
    }

    /// Twice the signed area.
    pub(super) fn doubled_area(&self) -> f64 {
        self.doubled_area
    }

    /// How far the points between two parameters lie from a segment, at most; gives up beyond `limit`.
    pub(super) fn deviation(&self, (start, end): (f64, f64), from: Point, to: Point, limit: f64) -> f64 {
        let mut worst = 0.0_f64;
        for (_, p) in self.between(start, end) {
            worst = worst.max(point::nearest_on_segment(p, from, to).1);
            if worst > limit {
                break;
            }
        }
        worst
    }
}

/// One pose as the collapser needs it.
#[derive(Debug)]
pub(super) struct PoseOriginal {
    pub(super) rings: Vec<OriginalRing>,
    /// The length that deviations are relative to.
    pub(super) size: f64,
}
