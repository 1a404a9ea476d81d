//! Greedy collapse of edges of tuple rings, in all poses at once, that never loses a point of any outline.
//!
//! For the edge `b c` with outer neighbours `a` and `d`, each pose has its own way to merge `b` and `c` into one point
//! without losing area:
//! - `b` is reflex or straight: `b` goes, the new vertex is `c`;
//! - `c` is reflex or straight: `c` goes, the new vertex is `b`;
//! - both are convex and turn by less than 180 degrees together: the new vertex is the apex where the lines `a b` and
//!   `d c` meet.
//!
//! Where two ways are open, the pose takes the one that deviates less from its outline. A tuple can be removed when
//! every pose has a way. Holes need no rule of their own: they run the other way round, so that the shape is on the
//! left of every edge, and "reflex" means a right turn for all rings alike.
//!
//! A landmark stays where it is: of an edge that ends in one only the other end may go.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::edge_grid::EdgeGrid;
use super::tuples::{Tuple, TupleRing};
use crate::math::{Point, point, predicate, wrapped};
use crate::outline::{ArcLength, Ring};

/// A vertex counts as straight if it is convex by less than this, as a fraction of the pose's size: points that
/// were interpolated on an edge lie off it by rounding, a few 1e-16.
const STRAIGHT: f64 = 1e-14;

/// The share of its area that a hole keeps at least. One that is no larger than the tolerance would become a line.
const LEAST_HOLE: f64 = 0.01;

/// The full-resolution ring that a simplified ring must enclose and stay close to.
#[derive(Debug)]
pub(super) struct OriginalRing {
    points: Vec<Point>,
    parameters: Vec<f64>,
    longest_edge: f64,
    doubled_area: f64,
}

impl OriginalRing {
    pub(super) fn new(ring: &Ring) -> Self {
        let parameters = ArcLength::new(ring).vertex_parameters().to_vec();
        Self {
            points: ring.points().to_vec(),
            parameters,
            longest_edge: ring.edges().map(|(a, b)| (b - a).norm()).fold(0.0, f64::max),
            doubled_area: 2.0 * ring.signed_area(),
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

    /// How far the points between two parameters lie from a segment, at most; gives up beyond `limit`.
    fn deviation(&self, (start, end): (f64, f64), from: Point, to: Point, limit: f64) -> f64 {
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

/// A way to merge `b` and `c` in one pose.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Merge {
    point: Point,
    parameter: f64,
    deviation: f64,
}

#[derive(Debug, PartialEq)]
struct Queued {
    cost: f64,
    vertex: usize,
    stamp: u32,
    /// How each pose would do it.
    merges: Vec<Merge>,
}

impl Eq for Queued {}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost
            .total_cmp(&other.cost)
            .then(self.vertex.cmp(&other.vertex))
            .then(self.stamp.cmp(&other.stamp))
    }
}

/// The state of a simplification: linked rings of tuples, an edge grid a pose, a queue of collapses.
#[derive(Debug)]
pub(super) struct Collapser<'a> {
    originals: &'a [&'a PoseOriginal],
    /// Largest deviation, as a fraction of each pose's size.
    tolerance: f64,
    tuples: Vec<Tuple>,
    ring_of: Vec<usize>,
    next: Vec<usize>,
    previous: Vec<usize>,
    alive: Vec<bool>,
    stamps: Vec<u32>,
    ring_sizes: Vec<usize>,
    /// Twice the signed area of each ring of each pose (#poses x #rings).
    areas: Vec<Vec<f64>>,
    grids: Vec<EdgeGrid>,
    /// Per tuple, what the cost of the edge that starts there is multiplied by; none where there are no tuples.
    weights: &'a [f64],
    queue: BinaryHeap<Reverse<Queued>>,
}

impl<'a> Collapser<'a> {
    pub(super) fn new(rings: Vec<TupleRing>, originals: &'a [&'a PoseOriginal], tolerance: f64) -> Self {
        let total: usize = rings.iter().map(|ring| ring.tuples.len()).sum();
        let mut collapser = Self {
            originals,
            tolerance,
            tuples: Vec::with_capacity(total),
            ring_of: Vec::with_capacity(total),
            next: Vec::with_capacity(total),
            previous: Vec::with_capacity(total),
            alive: vec![true; total],
            stamps: vec![0; total],
            ring_sizes: rings.iter().map(|ring| ring.tuples.len()).collect(),
            areas: Vec::with_capacity(originals.len()),
            grids: Vec::with_capacity(originals.len()),
            weights: &[],
            queue: BinaryHeap::with_capacity(2 * total),
        };
        for pose in 0..originals.len() {
            collapser
                .areas
                .push(rings.iter().map(|ring| ring.doubled_area(pose)).collect());
        }
        for (index, ring) in rings.into_iter().enumerate() {
            let (start, count) = (collapser.tuples.len(), ring.tuples.len());
            for k in 0..count {
                collapser.next.push(start + (k + 1) % count);
                collapser.previous.push(start + (k + count - 1) % count);
                collapser.ring_of.push(index);
            }
            collapser.tuples.extend(ring.tuples);
        }
        for pose in 0..originals.len() {
            let points = collapser.tuples.iter().map(|tuple| &tuple.points[pose]);
            let (low, high) = point::bounding_box(points).unwrap_or_default();
            let mut grid = EdgeGrid::new(low, high, total);
            for b in 0..total {
                grid.insert(b, collapser.point(pose, b), collapser.point(pose, collapser.next[b]));
            }
            collapser.grids.push(grid);
        }
        collapser
    }

    /// With the costs of edges multiplied by `weights`, one for each tuple of all rings in a row.
    pub(super) fn weighted(mut self, weights: &'a [f64]) -> Self {
        self.weights = weights;
        self
    }

    /// Collapses the cheapest edges until none is left within the tolerance; gives the rings that remain.
    pub(super) fn run(self) -> Vec<TupleRing> {
        self.survivors().0
    }

    /// As [`Self::run`], and which of the tuples, all rings in a row, remain.
    pub(super) fn survivors(mut self) -> (Vec<TupleRing>, Vec<usize>) {
        let candidates: Vec<_> = (0..self.tuples.len())
            .into_par_iter()
            .map(|b| self.candidate(b))
            .collect();
        for (b, candidate) in candidates.into_iter().enumerate() {
            self.enqueue(b, candidate);
        }
        let mut blocked: Vec<usize> = Vec::new();
        let mut progress = false;
        loop {
            while let Some(Reverse(queued)) = self.queue.pop() {
                let b = queued.vertex;
                if !self.alive[b] || self.stamps[b] != queued.stamp || self.is_on_triangle(b) {
                    continue;
                }
                if self.stays_simple(b, &queued.merges) {
                    self.collapse(b, &queued.merges);
                    progress = true;
                } else {
                    blocked.push(b);
                }
            }
            // What stood in the way may have gone.
            if !progress || blocked.is_empty() {
                break;
            }
            progress = false;
            for b in std::mem::take(&mut blocked) {
                if self.alive[b] {
                    self.enqueue(b, self.candidate(b));
                }
            }
        }
        let survivors = (0..self.tuples.len()).filter(|&b| self.alive[b]).collect();
        (self.rings(), survivors)
    }

    fn rings(self) -> Vec<TupleRing> {
        let mut rings = vec![TupleRing::default(); self.ring_sizes.len()];
        for (b, tuple) in self.tuples.into_iter().enumerate() {
            if self.alive[b] {
                rings[self.ring_of[b]].tuples.push(tuple);
            }
        }
        rings
    }

    fn point(&self, pose: usize, vertex: usize) -> Point {
        self.tuples[vertex].points[pose]
    }

    fn is_landmark(&self, vertex: usize) -> bool {
        self.tuples[vertex].landmark.is_some()
    }

    /// Whether the vertex is on a ring of three, which may lose none.
    fn is_on_triangle(&self, vertex: usize) -> bool {
        self.ring_sizes[self.ring_of[vertex]] <= 3
    }

    fn enqueue(&mut self, b: usize, candidate: Option<(f64, Vec<Merge>)>) {
        self.stamps[b] += 1;
        if let Some((cost, merges)) = candidate {
            self.queue.push(Reverse(Queued {
                cost,
                vertex: b,
                stamp: self.stamps[b],
                merges,
            }));
        }
    }

    /// The cost of collapsing the edge that starts at `b`, and how each pose would do it; `None` if some pose cannot
    /// within the tolerance.
    ///
    /// The cost is the worst squared relative deviation over the poses; the sum over the poses, scaled down, decides
    /// between equals.
    fn candidate(&self, b: usize) -> Option<(f64, Vec<Merge>)> {
        let c = self.next[b];
        if self.is_on_triangle(b) || (self.is_landmark(b) && self.is_landmark(c)) {
            return None;
        }
        let mut merges = Vec::with_capacity(self.originals.len());
        let (mut worst, mut sum) = (0.0_f64, 0.0);
        for pose in 0..self.originals.len() {
            let merge = self.merge(pose, b)?;
            let relative = merge.deviation / self.originals[pose].size;
            worst = worst.max(relative * relative);
            sum += relative * relative;
            merges.push(merge);
        }
        const SUM_SHARE: f64 = 1e-2;
        let weight = self.weights.get(b).copied().unwrap_or(1.0);
        Some(((worst + SUM_SHARE * sum) * weight, merges))
    }

    /// The best way to merge `b` and its successor in one pose.
    fn merge(&self, pose: usize, b: usize) -> Option<Merge> {
        let original = &self.originals[pose];
        let ring = &original.rings[self.ring_of[b]];
        let (a, c) = (self.previous[b], self.next[b]);
        let d = self.next[c];
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.point(pose, v));
        let [ta, tb, tc, td] = [a, b, c, d].map(|v| self.tuples[v].parameters[pose]);
        let limit = self.tolerance * original.size;
        let straight = STRAIGHT * original.size;
        let can_drop = |before: Point, vertex: Point, after: Point| {
            !predicate::is_positive(before, vertex, after)
                || point::cross(vertex - before, after - before) <= straight * (after - before).norm()
        };
        let mut best: Option<Merge> = None;
        let mut offer = |merge: Merge| {
            if merge.deviation <= limit && best.is_none_or(|b| merge.deviation < b.deviation) {
                best = Some(merge);
            }
        };
        let (keeps_b, keeps_c) = (self.is_landmark(b), self.is_landmark(c));
        if !keeps_b && can_drop(pa, pb, pc) {
            offer(Merge {
                point: pc,
                parameter: tc,
                deviation: ring.deviation((ta, tc), pa, pc, limit),
            });
        }
        if !keeps_c && can_drop(pb, pc, pd) {
            offer(Merge {
                point: pb,
                parameter: tb,
                deviation: ring.deviation((tb, td), pb, pd, limit),
            });
        }
        let both_convex = predicate::is_positive(pa, pb, pc) && predicate::is_positive(pb, pc, pd);
        if both_convex && !keeps_b && !keeps_c {
            let (into, out) = (pb - pa, pd - pc);
            let denominator = point::cross(into, out);
            if denominator > 0.0 {
                let apex = pb + into * (point::cross(pc - pb, out) / denominator);
                let distance = point::nearest_on_segment(apex, pb, pc).1;
                if distance <= 2.0 * limit {
                    offer(self.apex_merge(pose, b, apex, limit));
                }
            }
        }
        best
    }

    /// The merge of `b` and its successor at `apex`: it stands for the outline point nearest to it, and deviates by
    /// that point's distance or by what the two new edges leave.
    fn apex_merge(&self, pose: usize, b: usize, apex: Point, limit: f64) -> Merge {
        let ring = &self.originals[pose].rings[self.ring_of[b]];
        let (a, c) = (self.previous[b], self.next[b]);
        let d = self.next[c];
        let parameter_of = |v: usize| self.tuples[v].parameters[pose];
        let (tb, tc) = (parameter_of(b), parameter_of(c));
        // A point of the chain, or failing that the middle of its parameters.
        let middle = wrapped(tb + 0.5 * wrapped(tc - tb));
        let nearest = ring
            .between(tb, tc)
            .map(|(t, p)| ((p - apex).norm(), t))
            .min_by(|x, y| x.0.total_cmp(&y.0));
        let to_edge = point::nearest_on_segment(apex, self.point(pose, b), self.point(pose, c)).1;
        let (distance, parameter) = nearest.map_or((to_edge, middle), |(distance, t)| (distance, t));
        let before = ring.deviation((parameter_of(a), parameter), self.point(pose, a), apex, limit);
        let after = ring.deviation((parameter, parameter_of(d)), apex, self.point(pose, d), limit);
        Merge {
            point: apex,
            parameter,
            deviation: distance.max(before).max(after),
        }
    }

    /// Whether all poses stay simple, and every parameter stays in order.
    fn stays_simple(&self, b: usize, merges: &[Merge]) -> bool {
        (0..merges.len()).all(|pose| self.pose_stays_simple(pose, b, &merges[pose]))
    }

    fn pose_stays_simple(&self, pose: usize, b: usize, merge: &Merge) -> bool {
        let (a, c) = (self.previous[b], self.next[b]);
        let d = self.next[c];
        let (before, after) = (self.previous[a], self.next[d]);
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.point(pose, v));
        let apex = merge.point;
        if apex == pa || apex == pd {
            return false;
        }
        let (ta, td) = (self.tuples[a].parameters[pose], self.tuples[d].parameters[pose]);
        let span = wrapped(td - ta);
        let at = wrapped(merge.parameter - ta);
        if !(at > 0.0 && at < span) {
            return false;
        }
        let ring = self.ring_of[b];
        if self.ring_sizes[ring] == 4 {
            // What is left is the triangle of three: it must keep the sense of its ring.
            let sense = if ring == 0 { Ordering::Greater } else { Ordering::Less };
            if predicate::orientation(pa, apex, pd) != sense {
                return false;
            }
        }
        // Holes run the other way round: their areas are negative.
        let least = LEAST_HOLE * self.originals[pose].rings[ring].doubled_area;
        if ring > 0 && self.areas[pose][ring] + gained_area([pa, pb, pc, pd], apex) > least {
            return false;
        }
        let swept_first = swept(pa, pb, apex);
        let swept_second = swept(apex, pc, pd);
        let crosses = |edge: usize| {
            if !self.alive[edge] || edge == a || edge == b || edge == c {
                return false;
            }
            let (p, q) = (self.point(pose, edge), self.point(pose, self.next[edge]));
            if edge == before {
                // Shares `a`: it may not leave into the swept area, nor meet the second new edge.
                return in_closed_triangle(p, swept_first)
                    || folds(p, pa, apex)
                    || (before != d && predicate::touch(p, q, apex, pd));
            }
            if edge == d {
                return in_closed_triangle(q, swept_second)
                    || folds(q, pd, apex)
                    || (after != a && predicate::touch(p, q, pa, apex));
            }
            predicate::touch(p, q, pa, apex) || predicate::touch(p, q, apex, pd)
        };
        let grid = &self.grids[pose];
        !grid.any_near(pa, apex, crosses) && !grid.any_near(apex, pd, crosses)
    }

    fn collapse(&mut self, b: usize, merges: &[Merge]) {
        let (a, c) = (self.previous[b], self.next[b]);
        let d = self.next[c];
        for (pose, merge) in merges.iter().enumerate() {
            let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.point(pose, v));
            self.areas[pose][self.ring_of[b]] += gained_area([pa, pb, pc, pd], merge.point);
            let grid = &mut self.grids[pose];
            grid.remove(a, pa, pb);
            grid.remove(b, pb, pc);
            grid.remove(c, pc, pd);
            grid.insert(a, pa, merge.point);
            grid.insert(b, merge.point, pd);
            self.tuples[b].points[pose] = merge.point;
            self.tuples[b].parameters[pose] = merge.parameter;
        }
        self.tuples[b].landmark = self.tuples[b].landmark.or(self.tuples[c].landmark);
        self.alive[c] = false;
        self.next[b] = d;
        self.previous[d] = b;
        self.ring_sizes[self.ring_of[b]] -= 1;
        for edge in [self.previous[a], a, b, d] {
            self.enqueue(edge, self.candidate(edge));
        }
    }
}

/// By how much twice the signed area of a ring grows as its vertices `b` and `c` are merged at `apex`.
fn gained_area([a, b, c, d]: [Point; 4], apex: Point) -> f64 {
    let [b, c, d, apex] = [b, c, d, apex].map(|p| p - a);
    point::cross(apex, d) - point::cross(b, c) - point::cross(c, d)
}

/// The triangle that an edge's move sweeps, or `None` where it sweeps nothing.
fn swept(a: Point, b: Point, c: Point) -> Option<[Point; 3]> {
    match predicate::orientation(a, b, c) {
        Ordering::Greater => Some([a, b, c]),
        Ordering::Less => Some([a, c, b]),
        Ordering::Equal => None,
    }
}

fn in_closed_triangle(p: Point, triangle: Option<[Point; 3]>) -> bool {
    triangle.is_some_and(|[a, b, c]| {
        [(a, b), (b, c), (c, a)]
            .into_iter()
            .all(|(from, to)| predicate::orientation(from, to, p).is_ge())
    })
}

/// Whether the segments `p at` and `at q` leave `at` in the same direction.
fn folds(p: Point, at: Point, q: Point) -> bool {
    predicate::orientation(p, at, q).is_eq() && (p - at).dot(&(q - at)) > 0.0
}
