//! A path of Steiner points that divides a large piece near its middle, found at little cost.
//!
//! [`super::link_path`] looks for the shortest path of all, which is cubic, and so for small pieces only. Here a few pairs
//! of vertices half the piece apart are joined through each pose's own Delaunay triangulation ([`super::free_space`]), and the
//! pair with the fewest bends wins, in the pose that needs most. The parts have about half the vertices, and the path's.
//!
//! The paper has nothing of the kind. Cost O(m log m) a pose for m vertices.

use super::bridge_path;
use super::free_space::{FreeSpace, Visits};
use super::link_path::LinkPath;
use crate::math::Point;

/// Pairs of vertices that are tried.
const PAIRS: usize = 32;

/// A path between two vertices about half the piece apart, one that leaves two smaller pieces; `None` if there is none.
/// Positions are per pose; its ends are places in the piece.
pub(super) fn halving_path(positions: &[Vec<Point>], piece: &[usize]) -> Option<LinkPath> {
    let count = piece.len();
    let visits = Visits::new([&piece.to_vec()]);
    let spaces: Vec<FreeSpace> = positions
        .iter()
        .map(|positions| FreeSpace::new(positions, &visits))
        .collect::<Option<_>>()?;
    let mut drawn: Vec<(usize, LinkPath)> = (0..PAIRS.min(count / 2))
        .filter_map(|pair| {
            let from = pair * (count / 2) / PAIRS.min(count / 2);
            let to = from + count / 2;
            let interior: Vec<Vec<Point>> = spaces.iter().map(|space| space.path(from, to)).collect::<Option<_>>()?;
            // At least one point: where some pose has line of sight, others have not.
            let bends = interior.iter().map(Vec::len).max()?.max(1);
            let shrinks = count / 2 + 1 + bends < count && count - count / 2 + 1 + bends < count;
            shrinks.then_some((bends, LinkPath { from, to, interior }))
        })
        .collect();
    drawn.sort_by_key(|(bends, path)| (*bends, path.from));
    drawn.into_iter().find_map(|(bends, mut path)| {
        for (positions, interior) in positions.iter().zip(&mut path.interior) {
            *interior = bridge_path::proven(positions, &visits, (path.from, path.to), interior, bends)?;
        }
        Some(path)
    })
}

#[cfg(test)]
mod tests {
    use super::super::single_steiner::sees;
    use super::*;
    use crate::outline::testing::{Kinship, Recipe, outlines};

    #[test]
    fn strangers_of_four_hundred_vertices_are_halved() {
        let recipe = Recipe {
            vertices: 400,
            poses: 3,
            holes: 0,
            kinship: Kinship::Strangers,
            seed: 1,
        };
        let positions: Vec<Vec<Point>> = outlines(&recipe)
            .iter()
            .map(|outline| outline.outer().points().to_vec())
            .collect();
        let piece: Vec<usize> = (0..400).collect();
        let path = halving_path(&positions, &piece).expect("a path");
        assert_eq!(path.to - path.from, 200);
        for (positions, interior) in positions.iter().zip(&path.interior) {
            assert_eq!(interior.len(), path.interior[0].len());
            assert!(interior.len() < 100, "{}", interior.len());
            assert!(sees(positions, path.from, interior[0]));
            assert!(sees(positions, path.to, interior[interior.len() - 1]));
        }
    }
}
