//! A ring measured by arc length.

use super::Ring;
use crate::math::{Point, point, wrapped};

/// The arc-length parameter of a ring: 0 at its first point, growing along it, 1 back at the first point.
///
/// Cost: built in O(#points), each query O(1) where points are spread evenly, but for [`ArcLength::nearest`], which looks
/// at every edge that the way from the others does not rule out.
#[derive(Debug, Clone)]
pub struct ArcLength {
    points: Vec<Point>,
    /// Parameter of each point, and a final 1.
    parameters: Vec<f64>,
    /// For as many even shares of the length as there are points, the edge at the beginning of each: where to look first.
    guide: Vec<usize>,
    perimeter: f64,
}

/// Of so many points one is looked at before a search for the nearest.
const SCOUTED: usize = 32;

impl ArcLength {
    /// Measures `ring`.
    #[must_use]
    pub fn new(ring: &Ring) -> Self {
        let mut parameters = Vec::with_capacity(ring.len() + 1);
        let mut travelled = 0.0;
        for (a, b) in ring.edges() {
            parameters.push(travelled);
            travelled += (b - a).norm();
        }
        for parameter in &mut parameters {
            *parameter /= travelled;
        }
        parameters.push(1.0);
        let count = ring.len();
        let mut edge = 0;
        let guide = (0..count)
            .map(|share| {
                while edge + 1 < count && parameters[edge + 1] <= share as f64 / count as f64 {
                    edge += 1;
                }
                edge
            })
            .collect();
        Self {
            points: ring.points().to_vec(),
            parameters,
            guide,
            perimeter: travelled,
        }
    }

    /// The ring's length, in source units.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.perimeter
    }

    /// The parameter of each point of the ring, in `[0, 1)` and increasing.
    #[must_use]
    pub fn vertex_parameters(&self) -> &[f64] {
        &self.parameters[..self.points.len()]
    }

    /// The edge that holds parameter `t` (taken modulo 1) and how far along that edge it lies, in `[0, 1]`.
    #[must_use]
    pub fn locate(&self, t: f64) -> (usize, f64) {
        let t = wrapped(t);
        let count = self.points.len();
        // The last edge that does not begin after `t`; rounding may have put the guide one edge too far.
        let mut edge = self.guide[((t * count as f64) as usize).min(count - 1)];
        while edge > 0 && self.parameters[edge] > t {
            edge -= 1;
        }
        while edge + 1 < count && self.parameters[edge + 1] <= t {
            edge += 1;
        }
        let (start, end) = (self.parameters[edge], self.parameters[edge + 1]);
        let along = if end > start {
            ((t - start) / (end - start)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (edge, along)
    }

    /// The point at parameter `t`, taken modulo 1.
    #[must_use]
    pub fn at(&self, t: f64) -> Point {
        let (edge, along) = self.locate(t);
        let (a, b) = (self.points[edge], self.points[(edge + 1) % self.points.len()]);
        if along == 0.0 { a } else { a + (b - a) * along }
    }

    /// The parameter, in `[0, 1)`, of the point of the ring nearest to `p`, and its distance.
    #[must_use]
    pub fn nearest(&self, p: Point) -> (f64, f64) {
        let count = self.points.len();
        // Known before the walk, so that it passes far parts quickly from the beginning.
        let scouted = self.points.iter().step_by(SCOUTED).map(|q| (p - q).norm_squared());
        let within = scouted.fold(f64::INFINITY, f64::min).sqrt();
        let mut best = (0.0, f64::INFINITY);
        let mut edge = 0;
        while edge < count {
            let (a, b) = (self.points[edge], self.points[(edge + 1) % count]);
            let (along, distance) = point::nearest_on_segment(p, a, b);
            let on_edge = self.parameters[edge] + along * (self.parameters[edge + 1] - self.parameters[edge]);
            if distance < best.1 {
                best = (wrapped(on_edge), distance);
            }
            edge = self.passed(edge, on_edge + (distance - best.1.min(within)) / self.perimeter);
        }
        best
    }

    /// The first edge after `edge` that ends beyond parameter `t`, or a little before: rounding must not pass what is as
    /// near. For one who walks along the ring, the distance to a place changes by no more than the way.
    fn passed(&self, edge: usize, t: f64) -> usize {
        const ROUNDING: f64 = 1e-9;
        let (count, t) = (self.points.len(), t - ROUNDING);
        let next = edge + 1;
        if next >= count || t <= self.parameters[next + 1] {
            return next;
        }
        if t >= 1.0 {
            return count;
        }
        let guided = self.guide[((t * count as f64) as usize).min(count - 1)];
        // The guide is at or before the edge that holds `t`, but for rounding.
        guided.saturating_sub(1).max(next)
    }
}

/// How far two parameters of a closed curve are apart, the shorter way around: at most 1/2.
#[must_use]
pub(crate) fn parameter_gap(a: f64, b: f64) -> f64 {
    let gap = wrapped(a - b);
    gap.min(1.0 - gap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::testing::rings;
    use proptest::prelude::*;

    #[test]
    fn parameters_follow_the_edges() {
        let ring = Ring::new([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]].map(Point::from)).expect("a ring");
        let arc = ArcLength::new(&ring);
        assert_eq!(arc.perimeter(), 8.0);
        assert_eq!(arc.vertex_parameters(), &[0.0, 0.375, 0.5, 0.875]);
        assert_eq!(arc.at(0.25), Point::new(2.0, 0.0));
        assert_eq!(arc.at(1.25), arc.at(0.25));
        assert_eq!(arc.at(0.375), Point::new(3.0, 0.0));
        assert_eq!(arc.nearest(Point::new(2.0, -5.0)), (0.25, 5.0));
    }

    proptest! {
        #[test]
        fn the_nearest_place_is_that_of_looking_at_every_edge(
            points in rings(3..60), x in -0.5..1.5f64, y in -0.5..1.5f64,
        ) {
            let arc = ArcLength::new(&Ring::new(points).expect("a ring"));
            let p = Point::new(x, y);
            let (t, distance) = arc.nearest(p);
            let edges = (0..arc.points.len()).map(|k| (arc.points[k], arc.points[(k + 1) % arc.points.len()]));
            let least = edges.map(|(a, b)| point::nearest_on_segment(p, a, b).1).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(distance, least);
            prop_assert!(((arc.at(t) - p).norm() - least).abs() < 1e-9);
        }
    }
}
