//! Joins the holes and interior landmarks of N polygons to their outer rings, so that one weakly simple polygon a pose is left.
//!
//! A bridge is a pair of vertices of two rings that see one another in every pose. Holes are joined one after another,
//! each time by the bridge that is shortest relative to the pose's size, in the pose where it is longest. The polygon
//! then runs along the bridge to the hole, once around the hole, and back. A landmark is a hole of one vertex. The paper has
//! neither.
//! Cost O(e) for each pair of vertices looked at, e the number of edges.

use crate::math::{Point, point, predicate};

/// The vertices of all rings as one closed walk; the ends of bridges appear twice. `positions` are per pose, `rings`
/// index them, outer ring first.
///
/// # Errors
/// The number of a ring that no bridge reaches.
pub(super) fn join_rings(positions: &[Vec<Point>], rings: &[Vec<usize>]) -> Result<Vec<usize>, usize> {
    let mut walk = rings[0].clone();
    let mut bridges: Vec<(usize, usize)> = Vec::new();
    let mut waiting: Vec<usize> = (1..rings.len()).collect();
    let diagonals: Vec<f64> = positions.iter().map(point::diagonal).collect();
    while let Some(&first) = waiting.first() {
        let bridge = shortest_bridge(positions, rings, &walk, &waiting, &bridges, &diagonals).ok_or(first)?;
        let ring = &rings[bridge.ring];
        // Back to where it was entered; a ring of one vertex is visited once.
        let visits = if ring.len() == 1 { 1 } else { ring.len() + 1 };
        let mut detour: Vec<usize> = (0..visits).map(|k| ring[(bridge.in_ring + k) % ring.len()]).collect();
        detour.push(walk[bridge.in_walk]);
        bridges.push((walk[bridge.in_walk], ring[bridge.in_ring]));
        walk.splice(bridge.in_walk + 1..bridge.in_walk + 1, detour);
        waiting.retain(|&r| r != bridge.ring);
    }
    Ok(walk)
}

struct Bridge {
    in_walk: usize,
    ring: usize,
    in_ring: usize,
}

fn shortest_bridge(
    positions: &[Vec<Point>],
    rings: &[Vec<usize>],
    walk: &[usize],
    waiting: &[usize],
    bridges: &[(usize, usize)],
    diagonals: &[f64],
) -> Option<Bridge> {
    let mut candidates = Vec::new();
    for (in_walk, &from) in walk.iter().enumerate() {
        for &ring in waiting {
            for (in_ring, &to) in rings[ring].iter().enumerate() {
                let length = positions
                    .iter()
                    .zip(diagonals)
                    .map(|(p, diagonal)| (p[to] - p[from]).norm() / diagonal)
                    .fold(0.0, f64::max);
                candidates.push((length, in_walk, ring, in_ring));
            }
        }
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2, a.3).cmp(&(b.1, b.2, b.3))));
    candidates.into_iter().find_map(|(_, in_walk, ring, in_ring)| {
        let (from, to) = (walk[in_walk], rings[ring][in_ring]);
        let clear = positions
            .iter()
            .all(|p| is_clear(p, rings, bridges, from, to) && starts_inside(p, walk, in_walk, to));
        clear.then_some(Bridge { in_walk, ring, in_ring })
    })
}

/// Whether the segment between two vertices of different rings touches no edge and no bridge but at its ends.
fn is_clear(points: &[Point], rings: &[Vec<usize>], bridges: &[(usize, usize)], from: usize, to: usize) -> bool {
    let edges = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|k| (ring[k], ring[(k + 1) % ring.len()])));
    edges.chain(bridges.iter().copied()).all(|(a, b)| {
        if a == from || b == from || a == to || b == to {
            let other = if a == from || a == to { b } else { a };
            other == from || other == to || !predicate::on_segment(points[other], points[from], points[to])
        } else {
            !predicate::touch(points[a], points[b], points[from], points[to])
        }
    })
}

/// Whether the segment leaves the walk, at this visit of its start, into the interior. Only vertices that the walk
/// visits twice can fail: the interior angle is divided between the visits.
fn starts_inside(points: &[Point], walk: &[usize], at: usize, to: usize) -> bool {
    let count = walk.len();
    let place = |k: usize| points[walk[k % count]];
    let (previous, here, next) = (place(at + count - 1), place(at), place(at + 1));
    let left_of_next = predicate::orientation(here, next, points[to]).is_gt();
    let right_of_previous = predicate::orientation(here, points[to], previous).is_gt();
    if predicate::orientation(previous, here, next).is_gt() {
        left_of_next && right_of_previous
    } else {
        left_of_next || right_of_previous
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_landmark_is_visited_once_and_left_the_way_it_was_reached() {
        let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [1.0, 2.0], [2.0, 2.0]]
            .map(Point::from)
            .to_vec();
        let walk = join_rings(&[points], &[vec![0, 1, 2, 3], vec![4], vec![5]]).expect("all visible");
        assert_eq!(walk.len(), 4 + 2 * 2);
        assert_eq!(walk.iter().filter(|&&v| v == 5).count(), 1);
    }

    #[test]
    fn two_holes_are_joined_without_crossing() {
        let square = |x: f64, y: f64, s: f64| [[x, y], [x, y + s], [x + s, y + s], [x + s, y]].map(Point::from);
        let outer = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]].map(Point::from);
        let points: Vec<Point> = outer
            .into_iter()
            .chain(square(1.0, 1.0, 2.0))
            .chain(square(5.0, 5.0, 2.0))
            .collect();
        let rings = vec![(0..4).collect(), (4..8).collect(), (8..12).collect()];
        let walk = join_rings(&[points], &rings).expect("all visible");
        // Twelve vertices, and two more for each bridge.
        assert_eq!(walk.len(), 16);
        for v in 0..12 {
            assert!(walk.contains(&v));
        }
    }
}
