//! Stage III: a path of Steiner points between two vertices, as short as possible over all poses (NWM 3.1).
//!
//! 1. In each pose, candidate points: the centres of the triangles of the polygon's own triangulation and the middles of
//!    its diagonals. Two candidates, or a vertex and a candidate, are linked if they see one another.
//! 2. The link distance of two vertices is that of the shortest path over candidates, by breadth-first search.
//! 3. The pair with the fewest Steiner points, taken over the pose that needs most, is joined; the other poses' paths
//!    are cut into as many links.
//!
//! Differences from the paper: it runs Floyd and Warshall's algorithm on distances between *vertices*, so a path may
//! lead through vertices of the polygon and pinch it; here all inner points of a path are inside, which may take more of
//! them. A path is taken only if it shrinks both parts; the shortest one often does not, and then the overlay takes over.
//! Cost O(m^3), for polygons of at most [`LARGEST_POLYGON`] vertices.
//!
//! Guarantee: the path is the shortest over the candidates, and takes no more points than the triangulation has diagonals
//! between a triangle at one end and one at the other (one point if there is none between): their middles are such a
//! path. That may be several times the true link distance: where one point sees both ends but no candidate does, as from
//! between two long thin triangles. Pairs of that kind are rarely left: the division over a hub, which is tried before,
//! looks for such points.

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
                if is_clear(points, candidates[a], candidates[b]) {
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

    /// The path from one vertex to another with exactly `length` points between; `None` if it would cross itself, or touch an
    /// edge after rounding.
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
        let interior = &points[1..points.len() - 1];
        let is_simple = (0..points.len() - 1).all(|a| {
            (a + 2..points.len() - 1).all(|b| !predicate::touch(points[a], points[a + 1], points[b], points[b + 1]))
        });
        // The middle of a link may be off it by rounding.
        let ring = &self.sight.points;
        let is_inside = sees(ring, from, *interior.first()?)
            && sees(ring, to, *interior.last()?)
            && interior.iter().zip(&interior[1..]).all(|(p, q)| is_clear(ring, *p, *q));
        (is_simple && is_inside).then(|| interior.to_vec())
    }
}

/// Whether the segment between two inner points touches no edge.
fn is_clear(points: &[Point], p: Point, q: Point) -> bool {
    let count = points.len();
    (0..count).all(|e| !predicate::touch(points[e], points[(e + 1) % count], p, q))
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

    /// The fewest diagonals between a triangle at `from` and one at each vertex.
    fn diagonals_between(sight: &Sight, from: usize) -> Vec<usize> {
        let triangles = &sight.triangles;
        let is_next = |a: usize, b: usize| triangles[a].iter().filter(|v| triangles[b].contains(v)).count() == 2;
        let mut distances: Vec<Option<usize>> = triangles.iter().map(|t| t.contains(&from).then_some(0)).collect();
        for step in 0..triangles.len() {
            for k in 0..triangles.len() {
                let is_reached = |other: usize| distances[other] == Some(step) && is_next(other, k);
                if distances[k].is_none() && (0..triangles.len()).any(is_reached) {
                    distances[k] = Some(step + 1);
                }
            }
        }
        (0..sight.points.len())
            .map(|v| {
                let at = (0..triangles.len()).filter(|&k| triangles[k].contains(&v));
                at.filter_map(|k| distances[k]).min().expect("connected")
            })
            .collect()
    }

    /// The fewest candidates between all pairs of vertices, by relaxing every link until nothing changes.
    fn over_candidates(graph: &LinkGraph, from: usize, to: usize) -> Option<usize> {
        let sees = |v: usize, candidate: usize| graph.vertices[candidate].contains(&v);
        let count = graph.candidates.len();
        let mut steps: Vec<Option<usize>> = (0..count).map(|k| sees(from, k).then_some(1)).collect();
        loop {
            let before = steps.clone();
            for k in 0..count {
                let over = graph.links[k].iter().filter_map(|&other| steps[other]).min();
                steps[k] = [steps[k], over.map(|step| step + 1)].into_iter().flatten().min();
            }
            if steps == before {
                return (0..count).filter(|&k| sees(to, k)).filter_map(|k| steps[k]).min();
            }
        }
    }

    /// Every path is inside, takes as many points as asked for, and no more than the module promises.
    fn prove(points: &[Point]) {
        let count = points.len();
        let sight = sight_of(points.to_vec());
        let graph = LinkGraph::new(&sight);
        for from in 0..count {
            let search = graph.search(from);
            let between = diagonals_between(&sight, from);
            for to in (0..count).filter(|&to| to != from) {
                let found = search.steiner_to(to).expect("a path over the middles of the diagonals");
                assert!(
                    found <= between[to].max(1),
                    "{from} to {to}: {found} points over {} diagonals",
                    between[to]
                );
                assert_eq!(Some(found), over_candidates(&graph, from, to), "{from} to {to}");
                for length in [found, found + 1] {
                    let Some(path) = graph.path(from, to, length) else {
                        continue;
                    };
                    assert_eq!(path.len(), length);
                    assert!(sees(points, from, path[0]) && sees(points, to, path[length - 1]));
                    for (p, q) in path.iter().zip(&path[1..]) {
                        assert!(is_clear(points, *p, *q));
                    }
                }
            }
        }
    }

    #[test]
    fn a_staircase_takes_a_point_at_each_of_its_five_bends() {
        let points = staircase(3);
        let sight = sight_of(points.clone());
        let graph = LinkGraph::new(&sight);
        assert_eq!(graph.search(0).steiner_to(points.len() / 2), Some(5));
        prove(&points);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        #[test]
        fn paths_are_inside_and_the_shortest_over_the_candidates(points in rings(3..20)) {
            prove(&points);
        }
    }
}
