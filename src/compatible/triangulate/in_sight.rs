//! Bridges along segments that are inside every pose: the islands in sight are joined to the walk as a minimum spanning
//! tree grows (Prim 1957), always the nearest.
//!
//! Who sees whom is asked once, before the first bridge. Bridges only take sight away: a pair is asked again when its turn
//! comes, against the bridges built by then, and most pairs' turn never comes. A bridge divides the visits at its ends in
//! two; which of them a pair means is the one that opens to its other end, and must be the same one in every pose.
//!
//! Cost O(p log p + p i) for i islands and p pairs of visits in sight, and exact tests for each pair whose turn comes.

use super::free_space::Visits;
use super::sights::{Sights, relative_length};
use crate::math::{Point, predicate};

/// Two visits that see one another in every pose, as long as there is no bridge between.
#[derive(Debug, Clone, Copy)]
struct Pair {
    length: f64,
    /// Of different walks; the second is an island's.
    ends: [usize; 2],
}

/// The walk around a region, the islands in it, and the bridges that join them.
#[derive(Debug)]
pub(super) struct InSight<'a> {
    positions: &'a [Vec<Point>],
    pub(super) visits: Visits,
    /// For each visit at first, the walk it was on; 0 is the one around the region.
    of: Vec<usize>,
    /// Whether a walk is one with that around the region.
    is_joined: Vec<bool>,
    /// For each visit at first, the visits that it has been divided into.
    parts: Vec<Vec<usize>>,
    /// For each visit, the one at first that it is a part of.
    whole: Vec<usize>,
    /// As pairs of vertices.
    bridges: Vec<[usize; 2]>,
}

impl<'a> InSight<'a> {
    /// Joins all islands that are in sight of the walk, or of an island that was joined before.
    pub(super) fn join(positions: &'a [Vec<Point>], diagonals: &[f64], visits: Visits, sights: &Sights) -> Self {
        let count = visits.vertex.len();
        let walks = visits.starts.windows(2).enumerate();
        let of: Vec<usize> = walks
            .flat_map(|(walk, ends)| std::iter::repeat_n(walk, ends[1] - ends[0]))
            .collect();
        let mut this = Self {
            positions,
            is_joined: (1..visits.starts.len()).map(|walk| walk == 1).collect(),
            parts: (0..count).map(|visit| vec![visit]).collect(),
            whole: (0..count).collect(),
            bridges: Vec::new(),
            of,
            visits,
        };
        let mut pairs = this.pairs(diagonals, sights);
        while let Some([from, to]) = this.nearest(&mut pairs) {
            this.build(from, to);
        }
        this
    }

    /// Whether no island was.
    pub(super) fn is_empty(&self) -> bool {
        self.bridges.is_empty()
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

    /// All pairs, the shortest first.
    fn pairs(&self, diagonals: &[f64], sights: &Sights) -> Vec<Pair> {
        let vertex = &self.visits.vertex;
        let mut pairs: Vec<Pair> = (self.visits.starts[1]..vertex.len())
            .flat_map(|to| sights.common(to).map(move |from| [from, to]))
            .filter(|&[from, to]| self.of[from] < self.of[to])
            .map(|ends| Pair {
                length: relative_length(self.positions, diagonals, ends.map(|visit| vertex[visit])),
                ends,
            })
            .collect();
        pairs.sort_by(|a, b| a.length.total_cmp(&b.length).then(a.ends.cmp(&b.ends)));
        pairs
    }

    /// The ends of the shortest bridge from what is joined to what is not. Pairs that can be none any more are taken out.
    fn nearest(&self, pairs: &mut Vec<Pair>) -> Option<[usize; 2]> {
        let mut found = None;
        pairs.retain(|pair| match pair.ends.map(|end| self.is_joined[self.of[end]]) {
            _ if found.is_some() => true,
            [false, false] => true,
            [true, true] => false,
            [is_first_joined, _] => {
                let [first, second] = pair.ends;
                found = self.in_sight(if is_first_joined {
                    [first, second]
                } else {
                    [second, first]
                });
                false
            }
        });
        found
    }

    /// The visits that the ends of a pair are by now, if they still see one another in every pose.
    fn in_sight(&self, ends: [usize; 2]) -> Option<[usize; 2]> {
        let [a, b] = ends.map(|visit| self.visits.vertex[visit]);
        let is_blocked = self
            .bridges
            .iter()
            .filter(|bridge| !bridge.contains(&a) && !bridge.contains(&b))
            .any(|&[c, d]| (self.positions.iter()).any(|at| predicate::touch(at[a], at[b], at[c], at[d])));
        if is_blocked {
            return None;
        }
        let part = |visit: usize, target: usize| {
            let opens = |&part: &usize| (self.positions.iter()).all(|at| self.visits.opens_to(part, at, at[target]));
            let parts = &self.parts[visit];
            if parts.len() == 1 {
                Some(visit)
            } else {
                parts.iter().copied().find(opens)
            }
        };
        Some([part(ends[0], b)?, part(ends[1], a)?])
    }

    /// Leads the walk from visit `from` to `to`, once around the island there, and back.
    fn build(&mut self, from: usize, to: usize) {
        let vertex = &self.visits.vertex;
        self.bridges.push([vertex[from], vertex[to]]);
        self.is_joined[self.of[self.whole[to]]] = true;
        let (after, before) = (self.visits.next[from], self.visits.previous[to]);
        let on = self.divide(from);
        self.link(from, to);
        if before == to {
            // A single vertex is visited once.
            self.link(to, on);
        } else {
            let back = self.divide(to);
            self.link(before, back);
            self.link(back, on);
        }
        self.link(on, after);
    }

    /// A second visit of the same vertex.
    fn divide(&mut self, visit: usize) -> usize {
        let (part, whole) = (self.whole.len(), self.whole[visit]);
        self.whole.push(whole);
        self.parts[whole].push(part);
        self.visits.vertex.push(self.visits.vertex[visit]);
        self.visits.next.push(part);
        self.visits.previous.push(part);
        part
    }

    fn link(&mut self, visit: usize, next: usize) {
        self.visits.next[visit] = next;
        self.visits.previous[next] = visit;
    }
}

#[cfg(test)]
mod tests {
    use super::super::sights::free_spaces;
    use super::*;
    use crate::math::point;
    use proptest::prelude::*;

    /// The walk by the nearest pair in sight, which is looked for anew for every island.
    fn anew(positions: &[Vec<Point>], mut walk: Vec<usize>, mut islands: Vec<Vec<usize>>) -> Vec<usize> {
        let diagonals: Vec<f64> = positions.iter().map(point::diagonal).collect();
        while !islands.is_empty() {
            let visits = Visits::new(std::iter::once(&walk).chain(&islands));
            let sights = Sights::new(&free_spaces(positions, &visits).expect("room"), &visits);
            let length = |from: usize, to: usize| {
                relative_length(positions, &diagonals, [visits.vertex[from], visits.vertex[to]])
            };
            let nearest = (walk.len()..visits.vertex.len())
                .flat_map(|to| sights.common(to).map(move |from| (from, to)))
                .filter(|&(from, _)| from < walk.len())
                .min_by(|a, b| length(a.0, a.1).total_cmp(&length(b.0, b.1)));
            let Some((from, to)) = nearest else { break };
            let which = visits.starts.partition_point(|&start| start <= to) - 2;
            let island = islands.remove(which);
            let entered = to - visits.starts[which + 1];
            let mut detour: Vec<usize> = (0..island.len())
                .map(|k| island[(entered + k) % island.len()])
                .collect();
            if island.len() > 1 {
                detour.push(island[entered]);
            }
            detour.push(walk[from]);
            walk.splice(from + 1..from + 1, detour);
        }
        walk
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn bridges_are_those_of_looking_anew_for_each(
            moved in prop::collection::vec(prop::collection::vec((-0.7..0.7f64, -0.7..0.7f64), 7), 3),
        ) {
            // A square with a notch; in it a hole of three vertices, a line of two, and landmarks here and there.
            let fixed = [
                [0.0, 0.0], [10.1, -0.2], [9.8, 10.3], [5.3, 5.1], [-0.3, 9.9],
                [2.0, 2.0], [2.3, 3.1], [3.1, 2.4], [7.0, 2.0], [7.6, 3.6],
            ];
            let landmarks = [[0.9, 0.9], [4.6, 1.1], [8.9, 1.2], [1.0, 5.0], [4.7, 3.8], [8.8, 6.1], [0.8, 7.5]];
            let pose = |moves: &Vec<(f64, f64)>| -> Vec<Point> {
                let moved = landmarks.iter().zip(moves).map(|(&[x, y], by)| Point::new(x + by.0, y + by.1));
                fixed.map(Point::from).into_iter().chain(moved).collect()
            };
            let positions: Vec<Vec<Point>> = moved.iter().map(pose).collect();
            let walk: Vec<usize> = (0..5).collect();
            let islands: Vec<Vec<usize>> =
                [vec![5, 6, 7], vec![8, 9]].into_iter().chain((10..17).map(|v| vec![v])).collect();
            let diagonals: Vec<f64> = positions.iter().map(point::diagonal).collect();
            let visits = Visits::new(std::iter::once(&walk).chain(&islands));
            let sights = Sights::new(&free_spaces(&positions, &visits).expect("room"), &visits);
            let (joined, left) = InSight::join(&positions, &diagonals, visits, &sights).walks();
            prop_assert!(left.is_empty());
            prop_assert_eq!(joined, anew(&positions, walk, islands));
        }
    }
}
