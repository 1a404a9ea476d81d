//! The walk around a region and the islands in it, as bridges make one walk of them.
//!
//! A bridge divides the visits at its ends in two, one to each side of it; an island of one vertex is visited once.

use super::free_space::Visits;

/// Walks that are being joined.
#[derive(Debug)]
pub(super) struct Joining {
    pub(super) visits: Visits,
    /// For each visit at first, the walk it was on; 0 is the one around the region.
    of: Vec<usize>,
    /// Whether a walk is one with that around the region.
    is_joined: Vec<bool>,
    /// For each visit at first, the visits that it has been divided into.
    parts: Vec<Vec<usize>>,
    /// For each visit, the one at first that it is a part of.
    whole: Vec<usize>,
}

impl Joining {
    pub(super) fn new(walk: &Vec<usize>, islands: &[Vec<usize>]) -> Self {
        let visits = Visits::new(std::iter::once(walk).chain(islands));
        let count = visits.vertex.len();
        let walks = visits.starts.windows(2).enumerate();
        Self {
            of: walks
                .flat_map(|(walk, ends)| std::iter::repeat_n(walk, ends[1] - ends[0]))
                .collect(),
            is_joined: (0..=islands.len()).map(|walk| walk == 0).collect(),
            parts: (0..count).map(|visit| vec![visit]).collect(),
            whole: (0..count).collect(),
            visits,
        }
    }

    /// The walk that a visit was on at first.
    pub(super) fn walk_of(&self, visit: usize) -> usize {
        self.of[visit]
    }

    /// Whether a visit, as they were at first, is on the walk around the region.
    pub(super) fn is_joined(&self, visit: usize) -> bool {
        self.is_joined[self.of[visit]]
    }

    /// What a visit, as they were at first, has been divided into.
    pub(super) fn parts(&self, visit: usize) -> &[usize] {
        &self.parts[visit]
    }

    /// Leads the walk from visit `from` over vertices `via` to visit `to` of an island, once around that, and back.
    pub(super) fn build(&mut self, from: usize, via: &[usize], to: usize) {
        self.is_joined[self.of[self.whole[to]]] = true;
        let (after, before) = (self.visits.next[from], self.visits.previous[to]);
        let on = self.divide(from);
        let back = if before == to { to } else { self.divide(to) };
        let there: Vec<usize> = via.iter().map(|&vertex| self.visit(vertex)).collect();
        let home: Vec<usize> = via.iter().rev().map(|&vertex| self.visit(vertex)).collect();
        self.link([from].into_iter().chain(there).chain([to]));
        if back != to {
            self.link([before, back]);
        }
        self.link([back].into_iter().chain(home).chain([on, after]));
    }

    /// The walk with what was joined, and the islands that were not.
    pub(super) fn walks(&self) -> (Vec<usize>, Vec<Vec<usize>>) {
        let islands = (1..self.is_joined.len()).filter(|&island| !self.is_joined[island]);
        (
            self.around(0),
            islands.map(|island| self.around(self.visits.starts[island])).collect(),
        )
    }

    fn around(&self, start: usize) -> Vec<usize> {
        let mut walk = vec![self.visits.vertex[start]];
        let mut at = self.visits.next[start];
        while at != start {
            walk.push(self.visits.vertex[at]);
            at = self.visits.next[at];
        }
        walk
    }

    /// A second visit of the same vertex.
    fn divide(&mut self, visit: usize) -> usize {
        let part = self.visit(self.visits.vertex[visit]);
        let whole = self.whole[visit];
        self.whole[part] = whole;
        self.parts[whole].push(part);
        part
    }

    /// A visit more, of a vertex, on no walk yet.
    fn visit(&mut self, vertex: usize) -> usize {
        let visit = self.whole.len();
        self.whole.push(visit);
        self.visits.vertex.push(vertex);
        self.visits.next.push(visit);
        self.visits.previous.push(visit);
        visit
    }

    /// Makes each visit the next of the one before.
    fn link(&mut self, visits: impl IntoIterator<Item = usize>) {
        let mut visits = visits.into_iter();
        let Some(mut last) = visits.next() else { return };
        for visit in visits {
            self.visits.next[last] = visit;
            self.visits.previous[visit] = last;
            last = visit;
        }
    }
}
