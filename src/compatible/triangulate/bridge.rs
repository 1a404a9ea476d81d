//! Joins what lies inside N polygons (holes, landmarks, paths) to their outer rings, so that one weakly simple polygon
//! a pose is left.
//!
//! A bridge leads from a visit of the walk around the region to a visit of an island; see [`super::free_space`] for
//! these words. Islands are joined one after another, each time
//! 1. by the segment that is inside every pose and the shortest relative to the pose's size, in the pose where it is
//!    longest ([`super::in_sight`]); where no such segment is left,
//! 2. by a path over Steiner points, as many in every pose: the one with the fewest of them, and of these the shortest
//!    ([`super::bridge_path`]).
//!
//! The walk then runs along the bridge to the island, once around it, and back. There is always a bridge: free space is
//! connected in every pose, and the paths of different poses need nothing in common but their ends and their length.
//! The paper has neither holes nor landmarks.
//! Cost O(m^2), m the number of vertices, and as much again for each island that needs Steiner points.

use super::bridge_path;
use super::in_sight::join_in_sight;
use super::joining::Joining;
use super::sights::{Narrow, Sights, free_spaces};
use crate::math::{Point, point};

/// The walk around everything, and how many Steiner points were added.
#[derive(Debug)]
pub(super) struct Joined {
    pub(super) walk: Vec<usize>,
    pub(super) steiner: usize,
}

/// The region around which `walk` runs, with its islands joined. Steiner points are added to `positions` (per pose).
///
/// # Errors
/// [`Narrow`] where double precision has no room for a bridge.
pub(super) fn join_islands(
    positions: &mut [Vec<Point>],
    mut walk: Vec<usize>,
    mut islands: Vec<Vec<usize>>,
) -> Result<Joined, Narrow> {
    let diagonals: Vec<f64> = positions.iter().map(point::diagonal).collect();
    let mut steiner = 0;
    while !islands.is_empty() {
        let mut joining = Joining::new(&walk, &islands);
        let spaces = free_spaces(positions, &joining.visits)?;
        let sights = Sights::new(&spaces, &joining.visits);
        if !join_in_sight(&mut joining, positions, &diagonals, &sights) {
            let bridge = bridge_path::fewest_bends(positions, &diagonals, &joining.visits, &spaces, &sights)?;
            let first = positions[0].len();
            for (positions, interior) in positions.iter_mut().zip(&bridge.interior) {
                positions.extend(interior);
            }
            let points: Vec<usize> = (first..positions[0].len()).collect();
            steiner += points.len();
            joining.build(bridge.from, &points, bridge.to);
        }
        (walk, islands) = joining.walks();
    }
    Ok(Joined { walk, steiner })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_landmark_is_visited_once_and_left_the_way_it_was_reached() {
        let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [1.0, 2.0], [2.0, 2.0]]
            .map(Point::from)
            .to_vec();
        let joined = join_islands(&mut [points], vec![0, 1, 2, 3], vec![vec![4], vec![5]]).expect("all visible");
        assert_eq!((joined.walk.len(), joined.steiner), (4 + 2 * 2, 0));
        assert_eq!(joined.walk.iter().filter(|&&v| v == 5).count(), 1);
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
        let islands = vec![(4..8).collect(), (8..12).collect()];
        let joined = join_islands(&mut [points], (0..4).collect(), islands).expect("all visible");
        // Twelve vertices, and two more for each bridge.
        assert_eq!((joined.walk.len(), joined.steiner), (16, 0));
        for v in 0..12 {
            assert!(joined.walk.contains(&v));
        }
    }
}
