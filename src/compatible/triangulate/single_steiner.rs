//! Stage II: one interior Steiner point that several vertices see in all poses (NWM 3.1).
//!
//! The paper joins one pair of vertices over one point. Here the point is joined to every vertex that can be made to
//! see it in all poses: to all of them where each pose has a kernel (always so for four and five vertices), otherwise
//! to the pair that starts the search and all that can be added; several such hubs are offered. The polygon falls into one part between every two
//! successive spokes; a partition is taken only if every part has fewer vertices than the polygon, so that the
//! recursion ends.
//!
//! Regions are found by clipping triangles with the cones of [`super::visibility`]; the point is the centre of the
//! region, and each spoke is then proven with exact predicates. Cost O(m) regions for each of a bounded number of pairs
//! of vertices.

use super::convex::Convex;
use super::ear_clipping::in_angle;
use super::visibility::{Sight, View};
use crate::math::{Point, point, predicate};

/// Up to this many vertices every pair is a candidate; of larger polygons, as many vertices spread evenly.
const CANDIDATES: usize = 64;

/// How many starting pairs are tried, those with the roomiest common region first; fewer in larger polygons, in
/// proportion, but never fewer than in a narrow search.
const STARTING_PAIRS: usize = 150;

/// Likewise in a narrow search.
const FEW_STARTING_PAIRS: usize = 12;

/// Larger polygons go to the overlay.
const LARGEST_POLYGON: usize = 256;

/// A region is used if the circle about its centre has at least this radius, as a fraction of the polygon's diagonal.
const SMALLEST_CLEARANCE: f64 = 1e-7;

/// One Steiner point: its place in each pose, and the vertices it is joined to, in order.
#[derive(Debug, Clone)]
pub(super) struct Hub {
    pub(super) points: Vec<Point>,
    pub(super) spokes: Vec<usize>,
}

/// A point that all vertices see, in every pose; `None` if some pose has no kernel.
pub(super) fn star(sights: &[Sight]) -> Option<Hub> {
    let count = sights.first()?.points.len();
    let points = sights
        .iter()
        .map(|sight| {
            let (low, high) = point::bounding_box(&sight.points)?;
            let corners = vec![low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)];
            let mut kernel = Convex::new(corners);
            for k in 0..count {
                kernel.clip(sight.points[k], sight.points[(k + 1) % count]);
            }
            let (centre, _) = kernel.centre()?;
            let positive = |k: usize| predicate::is_positive(centre, sight.points[k], sight.points[(k + 1) % count]);
            (0..count).all(positive).then_some(centre)
        })
        .collect::<Option<Vec<Point>>>()?;
    Some(Hub {
        points,
        spokes: (0..count).collect(),
    })
}

/// How many starting pairs are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Search {
    /// [`STARTING_PAIRS`].
    Wide,
    /// [`FEW_STARTING_PAIRS`], other ones for every number as long as there are others.
    Narrow(usize),
}

/// Up to `most` hubs that divide the polygon into smaller parts, those that the most vertices see in all poses first.
pub(super) fn hubs(sights: &[Sight], search: Search, most: usize) -> Vec<Hub> {
    let count = sights.first().map_or(0, |sight| sight.points.len());
    if count > LARGEST_POLYGON {
        return Vec::new();
    }
    let rooms: Vec<Rooms> = sights.iter().map(Rooms::new).collect();
    let mut starts: Vec<(f64, usize, usize)> = Vec::new();
    let stride = count.div_ceil(CANDIDATES);
    for i in (0..count).step_by(stride) {
        for j in (i + 2.max(stride)..count).step_by(stride) {
            let clearance = rooms.iter().try_fold(f64::INFINITY, |least, room| {
                let (_, clearance) = room.roomiest(&[i, j])?;
                (clearance > SMALLEST_CLEARANCE).then_some(clearance.min(least))
            });
            starts.extend(clearance.map(|clearance| (clearance, i, j)));
        }
    }
    starts.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (skipped, taken) = match search {
        Search::Wide => (0, (STARTING_PAIRS / (stride * stride)).max(FEW_STARTING_PAIRS)),
        Search::Narrow(variant) => (
            variant * FEW_STARTING_PAIRS % starts.len().max(1),
            FEW_STARTING_PAIRS.min(starts.len()),
        ),
    };
    let mut grown: Vec<(Vec<usize>, f64)> = starts
        .iter()
        .cycle()
        .skip(skipped)
        .take(taken.min(starts.len()))
        .filter_map(|&(_, i, j)| grown_hub(&rooms, i, j, count))
        .collect();
    grown.sort_by(|a, b| b.0.len().cmp(&a.0.len()).then(b.1.total_cmp(&a.1)).then(a.0.cmp(&b.0)));
    let mut hubs: Vec<Hub> = Vec::new();
    for (spokes, _) in grown {
        if hubs.len() == most {
            break;
        }
        if hubs.iter().any(|hub| hub.spokes == spokes) {
            continue;
        }
        let points = rooms
            .iter()
            .map(|room| room.place(&spokes))
            .collect::<Option<Vec<Point>>>();
        hubs.extend(points.map(|points| Hub { points, spokes }));
    }
    hubs
}

/// From the pair `i j`, all vertices that can be added one after another; `None` if a part would not shrink.
fn grown_hub(rooms: &[Rooms], i: usize, j: usize, count: usize) -> Option<(Vec<usize>, f64)> {
    let mut spokes = vec![i, j];
    let mut triangles: Vec<usize> = rooms
        .iter()
        .map(|room| room.roomiest(&spokes).map(|(t, _)| t))
        .collect::<Option<_>>()?;
    let mut clearance = 0.0;
    // Farthest along the polygon first: spreads the spokes.
    let mut others: Vec<usize> = (0..count).filter(|&k| k != i && k != j).collect();
    let ring_distance = |a: usize, b: usize| (a + count - b).rem_euclid(count).min((b + count - a).rem_euclid(count));
    others.sort_by_key(|&k| std::cmp::Reverse(ring_distance(k, i).min(ring_distance(k, j))));
    for k in others {
        spokes.push(k);
        let grown: Option<Vec<(usize, f64)>> = rooms
            .iter()
            .zip(&triangles)
            .map(|(room, &t)| {
                let here = room.clearance_in(t, &spokes).map(|clearance| (t, clearance));
                here.or_else(|| room.roomiest(&spokes))
                    .filter(|found| found.1 > SMALLEST_CLEARANCE)
            })
            .collect();
        match grown {
            Some(found) => {
                clearance = found.iter().map(|f| f.1).fold(f64::INFINITY, f64::min);
                triangles = found.into_iter().map(|f| f.0).collect();
            }
            None => {
                spokes.pop();
            }
        }
    }
    spokes.sort_unstable();
    let shrinks = (0..spokes.len()).all(|s| {
        let gap = (spokes[(s + 1) % spokes.len()] + count - spokes[s]) % count;
        gap + 2 < count
    });
    let proven = shrinks && rooms.iter().all(|room| room.place(&spokes).is_some());
    proven.then_some((spokes, clearance))
}

/// One pose's triangles with what every vertex sees of them.
struct Rooms<'a> {
    sight: &'a Sight,
    /// For each triangle, the view of each vertex into it.
    views: Vec<Vec<Option<View>>>,
}

impl<'a> Rooms<'a> {
    fn new(sight: &'a Sight) -> Self {
        let count = sight.points.len();
        let mut views = vec![vec![None; count]; sight.triangles.len()];
        for (vertex, seen) in (0..count).map(|vertex| (vertex, sight.views(vertex))) {
            for view in seen {
                views[view.triangle][vertex] = Some(view);
            }
        }
        Self { sight, views }
    }

    /// The part of triangle `t` that all of `vertices` see.
    fn region(&self, t: usize, vertices: &[usize]) -> Option<Convex> {
        if vertices.iter().any(|&v| self.views[t][v].is_none()) {
            return None;
        }
        let corners = self.sight.triangles[t].map(|v| self.sight.points[v]);
        let mut region = Convex::new(corners.to_vec());
        for &v in vertices {
            if let Some((right, left)) = self.views[t][v]?.rays {
                let eye = self.sight.points[v];
                region.clip(eye, self.sight.points[right]);
                region.clip(self.sight.points[left], eye);
            }
        }
        Some(region)
    }

    fn clearance_in(&self, t: usize, vertices: &[usize]) -> Option<f64> {
        let (_, clearance) = self.region(t, vertices)?.centre()?;
        Some(clearance / self.sight.diagonal)
    }

    /// The triangle in which the common region of `vertices` is roomiest, and its relative clearance.
    fn roomiest(&self, vertices: &[usize]) -> Option<(usize, f64)> {
        (0..self.sight.triangles.len())
            .filter_map(|t| self.clearance_in(t, vertices).map(|clearance| (t, clearance)))
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
    }

    /// A point that all `spokes` see, proven.
    fn place(&self, spokes: &[usize]) -> Option<Point> {
        let (t, _) = self.roomiest(spokes)?;
        let (centre, _) = self.region(t, spokes)?.centre()?;
        let [a, b, c] = self.sight.triangles[t].map(|v| self.sight.points[v]);
        let inside = predicate::is_positive(a, b, centre)
            && predicate::is_positive(b, c, centre)
            && predicate::is_positive(c, a, centre);
        (inside && spokes.iter().all(|&v| sees(&self.sight.points, v, centre))).then_some(centre)
    }
}

/// Whether the segment from vertex `v` to the interior point `p` touches the polygon at `v` only, and starts in the
/// interior angle there. Exact. Where the polygon passes the place of `v` several times, along bridges, only the visit
/// whose angle holds `p` sees it.
pub(super) fn sees(points: &[Point], v: usize, p: Point) -> bool {
    let count = points.len();
    let eye = points[v];
    let clear = (0..count).all(|e| {
        let (a, b) = (points[e], points[(e + 1) % count]);
        if a == eye || b == eye {
            let other = if a == eye { b } else { a };
            predicate::orientation(eye, other, p).is_ne() || (other - eye).dot(&(p - eye)) < 0.0
        } else {
            !predicate::touch(a, b, eye, p)
        }
    });
    clear && in_angle(points[(v + count - 1) % count], eye, points[(v + 1) % count], p)
}

#[cfg(test)]
mod tests {
    use super::super::visibility::tests::sight_of;
    use super::*;

    fn points(list: &[[f64; 2]]) -> Vec<Point> {
        list.iter().copied().map(Point::from).collect()
    }

    #[test]
    fn two_quads_with_different_dents_share_a_star() {
        let first = points(&[[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]]);
        let second = points(&[[0.0, 0.0], [1.0, 1.0], [4.0, 0.0], [1.0, 4.0]]);
        let sights = [sight_of(first), sight_of(second)];
        let hub = star(&sights).expect("every quad has a kernel");
        assert_eq!(hub.spokes, vec![0, 1, 2, 3]);
    }

    #[test]
    fn a_hub_sees_its_spokes_in_a_corridor() {
        // A U: no kernel, but points at the bend see much.
        let shape = points(&[
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 9.0],
            [8.0, 9.0],
            [8.0, 1.0],
            [1.0, 1.0],
            [1.0, 9.0],
            [0.0, 9.0],
        ]);
        let sights = [sight_of(shape.clone())];
        assert!(star(&sights).is_none());
        let hub = hubs(&sights, Search::Wide, 1).pop().expect("a hub");
        assert!(hub.spokes.len() >= 4, "{hub:?}");
        assert!(hub.spokes.iter().all(|&v| sees(&shape, v, hub.points[0])));
    }
}
