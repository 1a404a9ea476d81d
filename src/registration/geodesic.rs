//! How far vertices of a lattice are from one another along it: Dijkstra's algorithm.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::lattice::Lattice;

/// A vertex that waits for its turn, the nearest first.
#[derive(PartialEq)]
struct Waiting(f64, usize);

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Lattice {
    /// By vertex, how far the nearest of `sources` is along edges, in pixels; infinite where there is no way.
    pub(super) fn distances_from(&self, sources: &[usize]) -> Vec<f64> {
        self.distances_within(sources, &vec![true; self.points.len()])
    }

    /// By vertex, how far the nearest of `sources` is along vertices that are `within`, in pixels; infinite where there is no way.
    pub(super) fn distances_within(&self, sources: &[usize], within: &[bool]) -> Vec<f64> {
        let mut distance = vec![f64::INFINITY; self.points.len()];
        let mut waiting = BinaryHeap::new();
        for &source in sources {
            distance[source] = 0.0;
            waiting.push(Waiting(0.0, source));
        }
        while let Some(Waiting(travelled, v)) = waiting.pop() {
            if travelled > distance[v] {
                continue;
            }
            for &w in self.neighbours[v].iter().filter(|w| within[**w]) {
                let length = travelled + (self.points[w] - self.points[v]).norm();
                if length < distance[w] {
                    distance[w] = length;
                    waiting.push(Waiting(length, w));
                }
            }
        }
        distance
    }
}
