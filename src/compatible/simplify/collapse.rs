//! Greedy collapse of edges of tuple rings, in all poses at once, that never loses a point of any outline.
//!
//! A tuple can be removed when every pose has a way to merge the ends of the edge ([`EdgeInPose`]). The cheapest edge goes first, where no
//! pose's rings would touch.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::drift::Drift;
use super::edge_grid::EdgeGrid;
use super::merging::{EdgeInPose, Merge};
use super::original::PoseOriginal;
use super::tuples::{Tuple, TupleRing};
use crate::math::{Point, point, predicate, wrapped};

/// The share of its area that a hole keeps at least. One that is no larger than the tolerance would become a line.
const LEAST_HOLE: f64 = 0.01;

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
    /// What holds vertices to corresponding places, if anything does.
    drift: Option<&'a Drift<'a>>,
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
            drift: None,
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

    /// With vertices held to corresponding places.
    pub(super) fn held(mut self, drift: Option<&'a Drift<'a>>) -> Self {
        self.drift = drift;
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
    /// The cost is the worst squared relative deviation (or drift) over the poses; the sum over the poses, scaled down, decides
    /// between equals.
    fn candidate(&self, b: usize) -> Option<(f64, Vec<Merge>)> {
        let c = self.next[b];
        if self.is_on_triangle(b) || (self.is_landmark(b) && self.is_landmark(c)) {
            return None;
        }
        let edges: Vec<EdgeInPose<'_>> = (0..self.originals.len()).map(|pose| self.edge(pose, b)).collect();
        let mut ways = Vec::with_capacity(edges.len());
        for edge in &edges {
            let merges = edge.merges(self.tolerance);
            if merges.is_empty() {
                return None;
            }
            let relative = |merge: Merge| (merge, merge.deviation / edge.size);
            ways.push(merges.into_iter().map(relative).collect::<Vec<_>>());
        }
        let chosen = match self.drift {
            Some(drift) => {
                let ends: Vec<[f64; 2]> = (edges.iter())
                    .map(|edge| [edge.parameters[1], edge.parameters[2]])
                    .collect();
                drift.together(self.ring_of[b], &ways, &ends)?
            }
            None => (ways.into_iter())
                .filter_map(|ways| ways.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)))
                .collect(),
        };
        let (mut worst, mut sum) = (0.0_f64, 0.0);
        let mut merges = Vec::with_capacity(chosen.len());
        for (merge, relative) in chosen {
            worst = worst.max(relative * relative);
            sum += relative * relative;
            merges.push(merge);
        }
        const SUM_SHARE: f64 = 1e-2;
        let weight = self.weights.get(b).copied().unwrap_or(1.0);
        Some(((worst + SUM_SHARE * sum) * weight, merges))
    }

    /// The edge from `b` to its successor in one pose.
    fn edge(&self, pose: usize, b: usize) -> EdgeInPose<'_> {
        let (a, c) = (self.previous[b], self.next[b]);
        let around = [a, b, c, self.next[c]];
        let original = &self.originals[pose];
        EdgeInPose {
            ring: &original.rings[self.ring_of[b]],
            size: original.size,
            points: around.map(|v| self.point(pose, v)),
            parameters: around.map(|v| self.tuples[v].parameters[pose]),
            keeps: [b, c].map(|v| self.is_landmark(v)),
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
        let least = LEAST_HOLE * self.originals[pose].rings[ring].doubled_area();
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
