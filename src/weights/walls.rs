//! Walls: polylines that influence may not cross, as an arrangement of segments that meet at their ends only.
//!
//! 1. Points of a wall that are no distance apart are one; a wall needs two different ones.
//! 2. Segments are clipped to the square that is solved on.
//! 3. Ends that nearly touch another wall are made to touch it, and crossing walls share a point where they cross.
//! 4. A wall that touches a pose is refused: the pose would have to lie on one of its sides.
//!
//! Coordinates are those of the tessellation: the layout's centre at the origin, its diagonal 1.
//!
//! Cost: O(#segments^2 + #segments x #poses).

use std::collections::BTreeSet;

use super::{WallProblem, WeightError};
use crate::math::{Point, point, predicate};

/// Wall points this near to one another, in diagonals, are one point. A gap that small is a slip of the hand, and would
/// let influence through.
const SNAP: f64 = 1e-4;

/// A wall's point this near to another wall is on it. Half of [`SNAP`]: then of three points that are all further apart
/// than that, at most one lies on the line between the others, and splitting comes to an end.
const ON_WALL: f64 = 0.5 * SNAP;

/// A pose nearer to a wall than this, in diagonals, is on it.
const TOUCH: f64 = 2e-4;

/// More segments than this are not arranged.
const MOST_SEGMENTS: usize = 2_000;

/// Points, and segments between them that meet nowhere else.
#[derive(Debug, Clone, Default)]
pub(super) struct Walls {
    pub(super) points: Vec<Point>,
    pub(super) segments: Vec<[usize; 2]>,
}

impl Walls {
    /// The arrangement of `walls`, clipped to the square of half width `reach` about the origin.
    pub(super) fn new(walls: &[Vec<Point>], poses: &[Point], reach: f64) -> Result<Self, WeightError> {
        let mut all = Self::default();
        for (index, wall) in walls.iter().enumerate() {
            let refused = |problem| Err(WeightError::Wall { wall: index, problem });
            let mut line: Vec<Point> = Vec::with_capacity(wall.len());
            for &p in wall {
                if line.last().is_none_or(|last| (last - p).norm() > SNAP) {
                    line.push(p);
                }
            }
            if line.len() < 2 {
                return refused(WallProblem::Degenerate);
            }
            for ends in line.windows(2) {
                let touched = poses
                    .iter()
                    .position(|&pose| point::nearest_on_segment(pose, ends[0], ends[1]).1 < TOUCH);
                if let Some(pose) = touched {
                    return refused(WallProblem::TouchesPose { pose });
                }
                if let Some([a, b]) = clipped(ends[0], ends[1], reach) {
                    let ends = [all.point(a), all.point(b)];
                    if ends[0] != ends[1] {
                        all.segments.push(ends);
                    }
                }
            }
            if !all.arrange() {
                return refused(WallProblem::Tangled);
            }
        }
        Ok(all)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// The distance from `p` to the nearest wall; infinite without walls.
    pub(super) fn distance(&self, p: Point) -> f64 {
        let distances = self.ends().map(|[a, b]| point::nearest_on_segment(p, a, b).1);
        distances.fold(f64::INFINITY, f64::min)
    }

    fn ends(&self) -> impl Iterator<Item = [Point; 2]> + '_ {
        self.segments.iter().map(|&[a, b]| [self.points[a], self.points[b]])
    }

    /// Where a wall ends freely: points of one segment, but for those at the square's sides.
    pub(super) fn tips(&self, reach: f64) -> Vec<Point> {
        let mut degree = vec![0; self.points.len()];
        for end in self.segments.as_flattened() {
            degree[*end] += 1;
        }
        let inside = |p: &Point| p.amax() < reach;
        (self.points.iter().zip(degree))
            .filter(|(p, degree)| *degree == 1 && inside(p))
            .map(|(p, _)| *p)
            .collect()
    }

    /// The index of the point at `p`, a new one if there is none.
    fn point(&mut self, p: Point) -> usize {
        let near = self.points.iter().position(|q| (q - p).norm() <= SNAP);
        near.unwrap_or_else(|| {
            self.points.push(p);
            self.points.len() - 1
        })
    }

    /// Splits segments at points on them and where they cross, until they meet at their ends only.
    fn arrange(&mut self) -> bool {
        let mut next = 0;
        while next < self.segments.len() {
            if self.segments.len() > MOST_SEGMENTS {
                return false;
            }
            let split = self
                .point_on(next)
                .map(|on| (next, on))
                .or_else(|| self.cross_before(next));
            match split {
                Some((segment, on)) => {
                    let [a, b] = self.segments[segment];
                    self.segments[segment] = [a, on];
                    self.segments.push([on, b]);
                    // The new point may lie on any of them.
                    next = 0;
                }
                None => next += 1,
            }
        }
        // A segment may have been drawn twice.
        let mut seen = BTreeSet::new();
        self.segments
            .retain(|&[a, b]| a != b && seen.insert((a.min(b), a.max(b))));
        true
    }

    /// A point that lies on the inside of a segment.
    fn point_on(&self, segment: usize) -> Option<usize> {
        let [a, b] = self.segments[segment];
        (0..self.points.len()).find(|&k| {
            k != a && k != b && point::nearest_on_segment(self.points[k], self.points[a], self.points[b]).1 <= ON_WALL
        })
    }

    /// An earlier segment that crosses this one, and the point where; the earlier one is split first, and this one at its
    /// next turn, when the point lies on it.
    fn cross_before(&mut self, segment: usize) -> Option<(usize, usize)> {
        let [a, b] = self.segments[segment];
        for other in 0..segment {
            let [c, d] = self.segments[other];
            if [c, d].contains(&a) || [c, d].contains(&b) {
                continue;
            }
            let (p, q) = (self.points[a], self.points[b]);
            if let Some(at) = crossing(p, q, self.points[c], self.points[d]) {
                let on = self.point(at);
                // At an end the point was snapped to: the other segment is the one to split.
                return Some(if on == c || on == d { (segment, on) } else { (other, on) })
                    .filter(|(split, on)| !self.segments[*split].contains(on));
            }
        }
        None
    }
}

/// Where the segments `p q` and `a b` cross, if they do so inside both: decided exactly, so that pieces of one line that
/// rounding has bent do not seem to cross far away.
fn crossing(p: Point, q: Point, a: Point, b: Point) -> Option<Point> {
    if !predicate::cross_properly(p, q, a, b) {
        return None;
    }
    let (along, across) = (q - p, b - a);
    let s = point::cross(a - p, across) / point::cross(along, across);
    // NaN, of segments that are nearly one, is nowhere.
    (0.0..=1.0).contains(&s).then(|| p + along * s)
}

/// The part of the segment `a b` in the square of half width `reach`; its ends lie exactly on the sides they were cut at.
fn clipped(a: Point, b: Point, reach: f64) -> Option<[Point; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let step = b - a;
    for axis in 0..2 {
        for (start, slope) in [(a[axis] + reach, step[axis]), (reach - a[axis], -step[axis])] {
            // Inside where start + t slope >= 0.
            if slope == 0.0 {
                if start < 0.0 {
                    return None;
                }
            } else if slope > 0.0 {
                from = from.max(-start / slope);
            } else {
                to = to.min(-start / slope);
            }
        }
    }
    let at = |t: f64, end: Point| {
        if t == 0.0 || t == 1.0 {
            return end;
        }
        (a + step * t).map(|v| {
            let side = reach.copysign(v);
            if (v - side).abs() < 1e-12 {
                side
            } else {
                v.clamp(-reach, reach)
            }
        })
    };
    (from < to).then(|| [at(from, a), at(to, b)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lines(walls: &[&[[f64; 2]]]) -> Vec<Vec<Point>> {
        walls
            .iter()
            .map(|wall| wall.iter().map(|&p| Point::from(p)).collect())
            .collect()
    }

    #[test]
    fn crossing_walls_share_a_point_and_touching_ones_an_end() {
        let cross = lines(&[&[[-1.0, 0.0], [1.0, 0.0]], &[[0.0, -1.0], [0.0, 1.0]]]);
        let walls = Walls::new(&cross, &[], 4.0).expect("walls");
        assert_eq!((walls.points.len(), walls.segments.len()), (5, 4));
        assert_eq!(walls.tips(4.0).len(), 4);
        // A T whose stem misses the bar by less than anyone can see.
        let tee = lines(&[&[[-1.0, 0.0], [1.0, 0.0]], &[[0.2, 3e-5], [0.2, 1.0]]]);
        let walls = Walls::new(&tee, &[], 4.0).expect("walls");
        assert_eq!((walls.points.len(), walls.segments.len()), (4, 3));
        // One wall drawn over part of another.
        let twice = lines(&[&[[-1.0, 0.0], [1.0, 0.0]], &[[-0.5, 0.0], [0.5, 0.0]]]);
        let walls = Walls::new(&twice, &[], 4.0).expect("walls");
        assert_eq!((walls.points.len(), walls.segments.len()), (4, 3));
    }

    #[test]
    fn walls_are_clipped_exactly_and_bad_ones_are_refused() {
        let long = lines(&[&[[0.5, -10.0], [0.5, 10.0]], &[[9.0, 9.0], [20.0, 9.0]]]);
        let walls = Walls::new(&long, &[], 4.0).expect("walls");
        assert_eq!(walls.points, [[0.5, -4.0], [0.5, 4.0]].map(Point::from));
        assert!(walls.tips(4.0).is_empty());
        let refused = |walls: &[Vec<Point>]| Walls::new(walls, &[Point::new(0.5, 0.0)], 4.0).expect_err("bad");
        assert_eq!(
            refused(&long),
            WeightError::Wall {
                wall: 0,
                problem: WallProblem::TouchesPose { pose: 0 }
            }
        );
        let dot = lines(&[&[[1.0, 0.0], [2.0, 0.0]], &[[1.0, 1.0], [1.0, 1.0]]]);
        assert_eq!(
            refused(&dot),
            WeightError::Wall {
                wall: 1,
                problem: WallProblem::Degenerate
            }
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn segments_of_any_arrangement_meet_at_ends_only(
            wall in proptest::collection::vec((-5.0..5.0f64, -5.0..5.0f64), 2..12),
        ) {
            let wall: Vec<Point> = wall.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let walls = Walls::new(&[wall], &[], 4.0).expect("walls");
            for (k, &[a, b]) in walls.segments.iter().enumerate() {
                for &[c, d] in &walls.segments[..k] {
                    if ![c, d].contains(&a) && ![c, d].contains(&b) {
                        let [p, q, r, s] = [a, b, c, d].map(|k| walls.points[k]);
                        prop_assert!(crossing(p, q, r, s).is_none());
                    }
                }
            }
        }
    }
}
