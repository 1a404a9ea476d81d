//! Bridges over Steiner points, where no segment between the walk and an island is inside every pose.
//!
//! 1. Every pair of a visit of the walk and a visit of an island is rated by the edges of each pose's triangulation
//!    that lie between them; the pose that has most counts.
//! 2. For the best pairs the paths are drawn ([`FreeSpace::path`]). The fewest points win, in the pose that needs most,
//!    then the shortest path relative to the pose's size, in the pose where it is longest.
//! 3. In the poses that need fewer points the longest links get a point at their middle.
//! 4. The inner points are moved off the lines that they were put on, so that no three of them are in line by rounding.
//! 5. Every path is proven with exact predicates to touch nothing but its ends. What fails gives way to the next.
//!
//! The number of points is an upper bound: paths over the middles of edges are not the ones with the fewest links.
//! The decimation takes out what was not needed. Cost O(m^2) a pose.

use super::free_space::{FreeSpace, Visits};
use super::sights::{Narrow, Sights, relative_length};
use crate::math::{Point, predicate};

/// For how many pairs at once the paths are drawn. The rating counts triangles and not bends, so that a good pair may
/// stand a little down the list.
const DRAWN: usize = 64;

/// How many pairs are drawn at most. Past the first few only paths that leave no room in double precision fail.
const MOST_DRAWN: usize = 1024;

/// From a visit of the walk to a visit of an island, over as many points in every pose.
#[derive(Debug)]
pub(super) struct Bridge {
    pub(super) from: usize,
    pub(super) to: usize,
    /// #poses x #points.
    pub(super) interior: Vec<Vec<Point>>,
}

/// The proven path with the fewest points.
///
/// # Errors
/// [`Narrow`] if none of the best pairs has a path that double precision can prove.
pub(super) fn fewest_bends(
    positions: &[Vec<Point>],
    diagonals: &[f64],
    visits: &Visits,
    spaces: &[FreeSpace],
    sights: &Sights,
) -> Result<Bridge, Narrow> {
    let length =
        |from: usize, to: usize| relative_length(positions, diagonals, [visits.vertex[from], visits.vertex[to]]);
    let pairs = rated_pairs(visits, spaces, sights, &length);
    let mut narrow = Narrow {
        pose: 0,
        place: positions[0][visits.vertex[visits.starts[1]]],
    };
    for pairs in pairs[..pairs.len().min(MOST_DRAWN)].chunks(DRAWN) {
        let mut drawn: Vec<(usize, f64, Bridge)> = pairs
            .iter()
            .filter_map(|&(from, to)| {
                let interior = spaces
                    .iter()
                    .enumerate()
                    .map(|(pose, space)| {
                        if sights.sees(pose, from, to) {
                            Some(Vec::new())
                        } else {
                            space.path(from, to)
                        }
                    })
                    .collect::<Option<Vec<Vec<Point>>>>()?;
                let bends = interior.iter().map(Vec::len).max()?;
                let longest = (0..positions.len())
                    .map(|pose| {
                        let path = whole(&positions[pose], visits, from, to, &interior[pose]);
                        path.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>() / diagonals[pose]
                    })
                    .fold(0.0, f64::max);
                Some((bends, longest, Bridge { from, to, interior }))
            })
            .collect();
        drawn.sort_by(|a, b| (a.0).cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for (bends, _, mut bridge) in drawn {
            let ends = (bridge.from, bridge.to);
            let failed = (0..positions.len()).find(|&pose| {
                match proven(&positions[pose], visits, ends, &bridge.interior[pose], bends) {
                    Some(interior) => bridge.interior[pose] = interior,
                    None => return true,
                }
                false
            });
            match failed {
                None => return Ok(bridge),
                Some(pose) => {
                    narrow = Narrow {
                        pose,
                        place: positions[pose][visits.vertex[bridge.to]],
                    }
                }
            }
        }
    }
    Err(narrow)
}

/// The inner points of a path between two visits, `bends` of them, moved off the lines they were put on and proven;
/// `None` if the path touches anything but its ends.
pub(super) fn proven(
    positions: &[Point],
    visits: &Visits,
    (from, to): (usize, usize),
    interior: &[Point],
    bends: usize,
) -> Option<Vec<Point>> {
    let is_clear = |path: &[Point]| is_clear(positions, visits, from, to, path);
    let path = lengthened(whole(positions, visits, from, to, interior), bends);
    if !is_clear(&path) {
        return None;
    }
    let path = nudged(path, is_clear);
    Some(path[1..path.len() - 1].to_vec())
}

/// All pairs that a path can join, the most promising first.
fn rated_pairs(
    visits: &Visits,
    spaces: &[FreeSpace],
    sights: &Sights,
    length: &dyn Fn(usize, usize) -> f64,
) -> Vec<(usize, usize)> {
    let walk = visits.starts[1];
    let mut rated: Vec<(usize, usize, f64, usize, usize)> = Vec::new();
    for to in walk..visits.vertex.len() {
        let steps: Vec<Vec<Option<usize>>> = spaces.iter().map(|space| space.steps_from(to)).collect();
        for from in 0..walk {
            let (mut most, mut sum) = (Some(0), 0);
            for (pose, steps) in steps.iter().enumerate() {
                let steps = if sights.sees(pose, from, to) {
                    Some(0)
                } else {
                    steps[from]
                };
                most = most.and_then(|most| steps.map(|steps| steps.max(most)));
                sum += steps.unwrap_or(0);
            }
            if let Some(most) = most {
                rated.push((most, sum, length(from, to), from, to));
            }
        }
    }
    rated.sort_by(|a, b| {
        (a.0, a.1)
            .cmp(&(b.0, b.1))
            .then(a.2.total_cmp(&b.2))
            .then((a.3, a.4).cmp(&(b.3, b.4)))
    });
    rated.into_iter().map(|(_, _, _, from, to)| (from, to)).collect()
}

/// A path with its ends.
fn whole(positions: &[Point], visits: &Visits, from: usize, to: usize, interior: &[Point]) -> Vec<Point> {
    let mut path = vec![positions[visits.vertex[from]]];
    path.extend(interior);
    path.push(positions[visits.vertex[to]]);
    path
}

/// The path with `bends` inner points: the longest links get one at their middle.
fn lengthened(mut path: Vec<Point>, bends: usize) -> Vec<Point> {
    while path.len() < bends + 2 {
        let length = |k: usize| (path[k + 1] - path[k]).norm();
        let longest = (0..path.len() - 1)
            .max_by(|&a, &b| length(a).total_cmp(&length(b)).then(b.cmp(&a)))
            .unwrap_or(0);
        path.insert(longest + 1, (path[longest] + path[longest + 1]) * 0.5);
    }
    path
}

/// How far a point is moved off its line, in lengths of its shorter link; the first that keeps the path clear.
const NUDGES: [f64; 3] = [0.12, 0.04, 0.01];

/// Directions that each of these is tried in.
const DIRECTIONS: usize = 6;

/// The clear path with every inner point moved a little. Middles of links and of triangle edges are in line with others
/// but for rounding; a triangle of such three points would be needed, and could not be, positive.
fn nudged(mut path: Vec<Point>, is_clear: impl Fn(&[Point]) -> bool) -> Vec<Point> {
    // The golden angle: no direction twice.
    const TURN_RAD: f64 = 2.399_963_229_728_653;
    for k in 1..path.len() - 1 {
        let start = path[k];
        let reach = (path[k - 1] - start).norm().min((path[k + 1] - start).norm());
        let tries = NUDGES
            .iter()
            .flat_map(|nudge| (0..DIRECTIONS).map(move |d| (nudge * reach, d)));
        for (step, direction) in tries {
            let angle = TURN_RAD * (k * DIRECTIONS + direction) as f64;
            path[k] = start + Point::new(angle.cos(), angle.sin()) * step;
            if is_clear(&path) {
                break;
            }
            path[k] = start;
        }
    }
    path
}

/// Whether a path touches neither itself nor any walk but at its ends, and leaves and arrives in the free space of the
/// visits it joins. Exact.
fn is_clear(positions: &[Point], visits: &Visits, from: usize, to: usize, path: &[Point]) -> bool {
    let last = path.len() - 2;
    let links = || path.windows(2).map(|link| (link[0], link[1])).enumerate();
    let crosses_itself = links().any(|(k, (a, b))| {
        a == b
            || links().skip(k + 2).any(|(_, (c, d))| predicate::touch(a, b, c, d))
            || path.get(k + 2).is_some_and(|&c| predicate::folds_back(a, b, c))
    });
    let (start, end) = (visits.vertex[from], visits.vertex[to]);
    let is_free = |(k, (a, b)): (usize, (Point, Point)), (u, v): (usize, usize)| {
        let at_start = k == 0 && (u == start || v == start);
        let at_end = k == last && (u == end || v == end);
        if at_start {
            let other = if u == start { v } else { u };
            !(predicate::on_segment(positions[other], a, b) || predicate::folds_back(b, a, positions[other]))
        } else if at_end {
            let other = if u == end { v } else { u };
            !(predicate::on_segment(positions[other], a, b) || predicate::folds_back(a, b, positions[other]))
        } else {
            !predicate::touch(a, b, positions[u], positions[v])
        }
    };
    !crosses_itself
        && links().all(|link| visits.edges().all(|edge| is_free(link, edge)))
        // A single vertex has no edge.
        && links().all(|(k, (a, b))| {
            (visits.starts[1]..visits.vertex.len())
                .filter(|&visit| visits.next[visit] == visit && !(k == last && visit == to))
                .all(|visit| !predicate::on_segment(positions[visits.vertex[visit]], a, b))
        })
        && visits.opens_to(from, positions, path[1])
        && visits.opens_to(to, positions, path[last])
}
