//! Bridges along segments that are inside every pose: the islands in sight are joined to the walk as a minimum spanning
//! tree grows (Prim 1957), always the nearest.
//!
//! Who sees whom is asked once, before the first bridge. Bridges only take sight away: a pair is asked again when its turn
//! comes, against the bridges built by then, and most pairs' turn never comes. A bridge divides the visits at its ends in
//! two; which of them a pair means is the one that opens to its other end, and must be the same one in every pose.
//!
//! Cost O(p log p + p i) for i islands and p pairs of visits in sight, and exact tests for each pair whose turn comes.

use super::joining::Joining;
use super::sights::{Sights, relative_length};
use crate::math::{Point, predicate};

/// Two visits that see one another in every pose, as long as there is no bridge between.
#[derive(Debug, Clone, Copy)]
struct Pair {
    length: f64,
    /// Of different walks; the second is an island's.
    ends: [usize; 2],
}

/// The bridges so far, as pairs of vertices.
#[derive(Debug)]
struct Bridges<'a> {
    positions: &'a [Vec<Point>],
    built: Vec<[usize; 2]>,
}

/// Joins all islands that are in sight of the walk, or of an island that was joined before; whether there was any.
pub(super) fn join_in_sight(
    joining: &mut Joining,
    positions: &[Vec<Point>],
    diagonals: &[f64],
    sights: &Sights,
) -> bool {
    let mut pairs = pairs(joining, positions, diagonals, sights);
    let mut bridges = Bridges {
        positions,
        built: Vec::new(),
    };
    while let Some([from, to]) = bridges.nearest(joining, &mut pairs) {
        bridges.built.push([from, to].map(|visit| joining.visits.vertex[visit]));
        joining.build(from, &[], to);
    }
    !bridges.built.is_empty()
}

/// All pairs, the shortest first.
fn pairs(joining: &Joining, positions: &[Vec<Point>], diagonals: &[f64], sights: &Sights) -> Vec<Pair> {
    let vertex = &joining.visits.vertex;
    let mut pairs: Vec<Pair> = (joining.visits.starts[1]..vertex.len())
        .flat_map(|to| sights.common(to).map(move |from| [from, to]))
        .filter(|&[from, to]| joining.walk_of(from) < joining.walk_of(to))
        .map(|ends| Pair {
            length: relative_length(positions, diagonals, ends.map(|visit| vertex[visit])),
            ends,
        })
        .collect();
    pairs.sort_by(|a, b| a.length.total_cmp(&b.length).then(a.ends.cmp(&b.ends)));
    pairs
}

impl Bridges<'_> {
    /// The ends of the shortest bridge from what is joined to what is not. Pairs that can be none any more are taken out.
    fn nearest(&self, joining: &Joining, pairs: &mut Vec<Pair>) -> Option<[usize; 2]> {
        let mut found = None;
        pairs.retain(|pair| match pair.ends.map(|end| joining.is_joined(end)) {
            _ if found.is_some() => true,
            [false, false] => true,
            [true, true] => false,
            [is_first_joined, _] => {
                let [first, second] = pair.ends;
                let ends = if is_first_joined {
                    [first, second]
                } else {
                    [second, first]
                };
                found = self.in_sight(joining, ends);
                false
            }
        });
        found
    }

    /// The visits that the ends of a pair are by now, if they still see one another in every pose.
    fn in_sight(&self, joining: &Joining, ends: [usize; 2]) -> Option<[usize; 2]> {
        let [a, b] = ends.map(|visit| joining.visits.vertex[visit]);
        let is_blocked = self
            .built
            .iter()
            .filter(|bridge| !bridge.contains(&a) && !bridge.contains(&b))
            .any(|&[c, d]| (self.positions.iter()).any(|at| predicate::touch(at[a], at[b], at[c], at[d])));
        if is_blocked {
            return None;
        }
        let part = |visit: usize, target: usize| match joining.parts(visit) {
            [only] => Some(*only),
            parts => {
                let opens = |&part: &usize| {
                    self.positions
                        .iter()
                        .all(|at| joining.visits.opens_to(part, at, at[target]))
                };
                parts.iter().copied().find(opens)
            }
        };
        Some([part(ends[0], b)?, part(ends[1], a)?])
    }
}

#[cfg(test)]
mod tests {
    use super::super::free_space::Visits;
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
            let mut joining = Joining::new(&walk, &islands);
            let sights = Sights::new(&free_spaces(&positions, &joining.visits).expect("room"), &joining.visits);
            prop_assert!(join_in_sight(&mut joining, &positions, &diagonals, &sights));
            let (joined, left) = joining.walks();
            prop_assert!(left.is_empty());
            prop_assert_eq!(joined, anew(&positions, walk, islands));
        }
    }
}
