//! Stage III: a path of Steiner points between two vertices, as short as possible over all poses (NWM 3.1).
//!
//! 1. In each pose, candidate points: the centres of the triangles of the polygon's own triangulation and the middles of
//!    its diagonals. Two candidates, or a vertex and a candidate, are linked if they see one another.
//! 2. The link distance of two vertices is that of the shortest path over candidates, by breadth-first search.
//! 3. The pair with the fewest Steiner points, taken over the pose that needs most, is joined; the other poses' paths
//!    are cut into as many links.
//!
//! Differences from the paper: it runs Floyd and Warshall's algorithm on distances between *vertices*, so a path may
//! lead through vertices of the polygon and pinch it; here all inner points of a path are inside. The distance over
//! candidates is an upper bound of the true link distance. A path is taken only if it shrinks both parts; the shortest
//! one often does not, and then the overlay takes over. Cost O(m^3), for polygons of at most
//! [`LARGEST_POLYGON`] vertices.

use std::collections::VecDeque;

use super::single_steiner::sees;
use super::visibility::Sight;
use crate::math::{Point, predicate};

/// Larger polygons go straight to the overlay.
const LARGEST_POLYGON: usize = 48;

/// A path between two vertices of a polygon, in every pose.
#[derive(Debug, Clone)]
pub(super) struct LinkPath {
    pub(super) from: usize,
    pub(super) to: usize,
    /// Per pose, the points between; equally many in every pose.
    pub(super) interior: Vec<Vec<Point>>,
}

/// The path with the fewest points that leaves two smaller polygons; `None` if there is none.
pub(super) fn shortest_path(sights: &[Sight]) -> Option<LinkPath> {
    let count = sights.first()?.points.len();
    if count > LARGEST_POLYGON {
        return None;
    }
    let graphs: Vec<LinkGraph> = sights.iter().map(LinkGraph::new).collect();
    let mut pairs = Vec::new();
    for from in 0..count {
        let searches: Vec<Search> = graphs.iter().map(|graph| graph.search(from)).collect();
        for to in from + 2..count {
            let Some(steps) = searches
                .iter()
                .map(|s| s.steiner_to(to))
                .collect::<Option<Vec<usize>>>()
            else {
                continue;
            };
            let steiner = steps.into_iter().max().unwrap_or(0);
            let gap = to - from;
            let shrinks = gap + 1 + steiner < count && count - gap + 1 + steiner < count;
            if shrinks {
                pairs.push((steiner, gap.abs_diff(count - gap), from, to));
            }
        }
    }
    pairs.sort_unstable();
    pairs.into_iter().find_map(|(steiner, _, from, to)| {
        let interior = graphs
            .iter()
            .map(|graph| graph.path(from, to, steiner))
            .collect::<Option<Vec<Vec<Point>>>>()?;
        Some(LinkPath { from, to, interior })
    })
}

/// Mutual visibility of the vertices and the candidate points of one pose.
struct LinkGraph<'a> {
    sight: &'a Sight,
    candidates: Vec<Point>,
    /// Per candidate, the vertices it sees.
    vertices: Vec<Vec<usize>>,
    /// Per candidate, the candidates it sees.
    links: Vec<Vec<usize>>,
}

/// Breadth-first distances from one vertex.
struct Search {
    /// Per candidate, its place on the path (1 = first Steiner point) and the candidate before it.
    reached: Vec<Option<(usize, Option<usize>)>>,
    /// Per vertex, the last candidate of the shortest path to it.
    last: Vec<Option<usize>>,
}

impl Search {
    fn steiner_to(&self, vertex: usize) -> Option<usize> {
        self.reached[self.last[vertex]?].map(|(steps, _)| steps)
    }
}

impl<'a> LinkGraph<'a> {
    fn new(sight: &'a Sight) -> Self {
        let points = &sight.points;
        let count = points.len();
        let mut candidates = Vec::new();
        for &[a, b, c] in &sight.triangles {
            candidates.push((points[a] + points[b] + points[c]) / 3.0);
            for (from, to) in crate::mesh::directed_edges([a, b, c]) {
                // Each diagonal once; polygon edges are no place for an inner point.
                if from < to && to - from > 1 && !(from == 0 && to == count - 1) {
                    candidates.push((points[from] + points[to]) / 2.0);
                }
            }
        }
        let vertices = candidates
            .iter()
            .map(|&p| (0..count).filter(|&v| sees(points, v, p)).collect())
            .collect();
        let mut links = vec![Vec::new(); candidates.len()];
        for a in 0..candidates.len() {
            for b in a + 1..candidates.len() {
                let (p, q) = (candidates[a], candidates[b]);
                if (0..count).all(|e| !predicate::touch(points[e], points[(e + 1) % count], p, q)) {
                    links[a].push(b);
                    links[b].push(a);
                }
            }
        }
        Self {
            sight,
            candidates,
            vertices,
            links,
        }
    }

    fn search(&self, from: usize) -> Search {
        let mut reached = vec![None; self.candidates.len()];
        let mut last: Vec<Option<usize>> = vec![None; self.sight.points.len()];
        let mut queue = VecDeque::new();
        for (candidate, seen) in self.vertices.iter().enumerate() {
            if seen.contains(&from) {
                reached[candidate] = Some((1, None));
                queue.push_back((candidate, 1));
            }
        }
        while let Some((candidate, steps)) = queue.pop_front() {
            for &vertex in &self.vertices[candidate] {
                last[vertex].get_or_insert(candidate);
            }
            for &next in &self.links[candidate] {
                if reached[next].is_none() {
                    reached[next] = Some((steps + 1, Some(candidate)));
                    queue.push_back((next, steps + 1));
                }
            }
        }
        Search { reached, last }
    }

    /// The path from one vertex to another with exactly `length` points between; `None` if it would cross itself.
    fn path(&self, from: usize, to: usize, length: usize) -> Option<Vec<Point>> {
        let search = self.search(from);
        let mut points = vec![self.sight.points[to]];
        let mut at = search.last[to];
        while let Some(candidate) = at {
            points.push(self.candidates[candidate]);
            at = search.reached[candidate].and_then(|(_, before)| before);
        }
        points.push(self.sight.points[from]);
        points.reverse();
        while points.len() < length + 2 {
            let longest = (0..points.len() - 1).max_by(|&a, &b| {
                let length = |k: usize| (points[k + 1] - points[k]).norm();
                length(a).total_cmp(&length(b))
            })?;
            points.insert(longest + 1, (points[longest] + points[longest + 1]) / 2.0);
        }
        let simple = (0..points.len() - 1).all(|a| {
            (a + 2..points.len() - 1).all(|b| !predicate::touch(points[a], points[a + 1], points[b], points[b + 1]))
        });
        simple.then(|| points[1..points.len() - 1].to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::super::visibility::tests::sight_of;
    use super::*;
    use crate::outline::testing::rings;
    use proptest::prelude::*;

    /// A corridor with right-angled bends: a staircase of unit width.
    fn staircase(steps: usize) -> Vec<Point> {
        let mut lower = Vec::new();
        let mut upper = Vec::new();
        for k in 0..steps {
            let s = 4.0 * k as f64;
            lower.extend([Point::new(s, s), Point::new(s + 4.0, s)]);
            upper.extend([Point::new(s, s + 1.0), Point::new(s + 3.0, s + 1.0)]);
        }
        upper[0] = Point::new(0.0, 1.0);
        let end = 4.0 * steps as f64;
        lower.push(Point::new(end, end));
        upper.push(Point::new(end - 1.0, end));
        // The upper side needs the inner corner of each bend.
        let inner: Vec<Point> = upper.into_iter().filter(|p| p.x >= 0.0).collect();
        lower.extend(inner.into_iter().rev());
        lower
    }

    #[test]
    fn paths_stay_inside_and_shrink_both_parts() {
        let points = staircase(4);
        let count = points.len();
        let sights = [sight_of(points.clone())];
        let path = shortest_path(&sights).expect("a path");
        let steiner = path.interior[0].len();
        let gap = path.to - path.from;
        assert!(gap + 1 + steiner < count && count - gap + 1 + steiner < count);
        let mut along = vec![points[path.from]];
        along.extend(&path.interior[0]);
        along.push(points[path.to]);
        assert!(sees(&points, path.from, along[1]) && sees(&points, path.to, along[along.len() - 2]));
    }

    /// Steiner points between two vertices over a fine grid of points: an upper bound of the true number, close to it.
    fn over_grid(points: &[Point], from: usize) -> Vec<Option<usize>> {
        const CELLS: usize = 24;
        let (low, high) = crate::math::point::bounding_box(points).expect("points");
        let count = points.len();
        let ring = crate::outline::Ring::new(points.iter().copied()).expect("a ring");
        let grid: Vec<Point> = (0..CELLS * CELLS)
            .map(|k| [(k % CELLS) as f64 + 0.51, (k / CELLS) as f64 + 0.53].map(|x| x / CELLS as f64))
            .map(|[x, y]| Point::new(low.x + x * (high.x - low.x), low.y + y * (high.y - low.y)))
            .filter(|&p| ring.contains(p))
            .collect();
        let linked =
            |p: Point, q: Point| (0..count).all(|e| !predicate::touch(points[e], points[(e + 1) % count], p, q));
        let mut steps: Vec<Option<usize>> = grid.iter().map(|&p| sees(points, from, p).then_some(1)).collect();
        for step in 1.. {
            let edge: Vec<usize> = (0..grid.len()).filter(|&k| steps[k] == Some(step)).collect();
            if edge.is_empty() {
                break;
            }
            for k in 0..grid.len() {
                if steps[k].is_none() && edge.iter().any(|&e| linked(grid[e], grid[k])) {
                    steps[k] = Some(step + 1);
                }
            }
        }
        (0..count)
            .map(|v| {
                (0..grid.len())
                    .filter(|&k| sees(points, v, grid[k]))
                    .filter_map(|k| steps[k])
                    .min()
            })
            .collect()
    }

    fn assert_close_to_the_grid(points: &[Point], from: usize) {
        let sight = sight_of(points.to_vec());
        let graph = LinkGraph::new(&sight);
        let search = graph.search(from);
        for (to, least) in over_grid(points, from)
            .into_iter()
            .enumerate()
            .filter(|&(to, _)| to != from)
        {
            let found = search.steiner_to(to);
            let (Some(found), Some(least)) = (found, least) else {
                // The grid may miss thin parts; the candidates may not.
                assert!(found.is_some(), "no path from {from} to {to}");
                continue;
            };
            assert!(
                // The candidates are few: one point over the grid may take three of them.
                found <= 3 * least,
                "{from} to {to}: {found} points, {least} over the grid"
            );
        }
    }

    #[test]
    fn a_staircase_takes_a_point_at_each_of_its_five_bends() {
        let points = staircase(3);
        let sight = sight_of(points.clone());
        let graph = LinkGraph::new(&sight);
        assert_eq!(graph.search(0).steiner_to(points.len() / 2), Some(5));
        assert_close_to_the_grid(&points, 0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn link_distances_are_close_to_those_over_a_fine_grid(points in rings(4..12), from in 0_usize..12) {
            assert_close_to_the_grid(&points, from % points.len());
        }
    }
}
