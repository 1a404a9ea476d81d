//! Which visits of islands see one another and the walk, in each pose and in all.

use rayon::prelude::*;

use super::free_space::{FreeSpace, Visits};
use crate::math::Point;

/// Where there is no room between edges in double precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Narrow {
    pub(super) pose: usize,
    pub(super) place: Point,
}

/// The free space of every pose.
pub(super) fn free_spaces(positions: &[Vec<Point>], visits: &Visits) -> Result<Vec<FreeSpace>, Narrow> {
    let spaces: Vec<Option<FreeSpace>> = (positions.par_iter())
        .map(|points| FreeSpace::new(points, visits))
        .collect();
    let narrow = |pose: usize| Narrow {
        pose,
        place: positions[pose][visits.vertex[visits.starts[1]]],
    };
    let spaces = spaces.into_iter().enumerate();
    spaces.map(|(pose, space)| space.ok_or_else(|| narrow(pose))).collect()
}

/// How long a segment between two vertices is relative to the pose's size, in the pose where it is longest.
pub(super) fn relative_length(positions: &[Vec<Point>], diagonals: &[f64], [a, b]: [usize; 2]) -> f64 {
    positions
        .iter()
        .zip(diagonals)
        .map(|(p, diagonal)| (p[b] - p[a]).norm() / diagonal)
        .fold(0.0, f64::max)
}

/// Which visits each visit of an island sees.
#[derive(Debug)]
pub(super) struct Sights {
    /// How many visits the walk has: they are the first.
    walk: usize,
    /// #poses x #visits of islands, the visits it sees, in order.
    seen: Vec<Vec<Vec<usize>>>,
}

impl Sights {
    pub(super) fn new(spaces: &[FreeSpace], visits: &Visits) -> Self {
        let (walk, count) = (visits.starts[1], visits.vertex.len());
        Self {
            walk,
            seen: spaces
                .par_iter()
                .map(|space| (walk..count).map(|visit| space.seen_from(visit)).collect())
                .collect(),
        }
    }

    /// Whether a visit and one of an island see one another in a pose.
    pub(super) fn sees(&self, pose: usize, from: usize, to: usize) -> bool {
        self.seen[pose][to - self.walk].binary_search(&from).is_ok()
    }

    /// The visits that a visit of an island sees in every pose.
    pub(super) fn common(&self, to: usize) -> impl Iterator<Item = usize> {
        let seen = self.seen[0][to - self.walk].iter().copied();
        seen.filter(move |&from| (1..self.seen.len()).all(|pose| self.sees(pose, from, to)))
    }
}
