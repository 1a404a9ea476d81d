//! One pose's polygon with everything that is still to be joined in it, triangulated: who sees whom, and how to get
//! from one to the other.
//!
//! Input: the closed walk around the region and the closed walks of the islands in it (holes, landmarks, paths; an
//! island may be one vertex). A walk may visit a vertex several times, once for each sector of the free space there;
//! all questions are asked about *visits*, so that the two sides of a bridge are different places.
//!
//! 1. The constrained Delaunay triangulation of all vertices, with the edges of all walks as constraints (spade).
//! 2. Each visit owns the fan of triangles from the edge to its successor to the edge from its predecessor.
//! 3. The triangles with three owners are the free space; between owners that share an edge one may pass, but for the
//!    walks' own edges.
//!
//! Sight is then exact ([`super::visibility`]). A path between two visits runs through the fewest triangles, over the
//! middles of the edges between them, and is cut short wherever it can be straight within them; its points are proven
//! by the caller. Cost O(m log m) to build, O(m) for a path of a few bends.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::visibility::Sight;
use crate::math::{Point, predicate};

/// The visits of several closed walks, numbered through; the same in every pose.
#[derive(Debug)]
pub(super) struct Visits {
    /// The vertex of each visit.
    pub(super) vertex: Vec<usize>,
    pub(super) next: Vec<usize>,
    pub(super) previous: Vec<usize>,
    /// The first visit of each walk, and a final count.
    pub(super) starts: Vec<usize>,
}

impl Visits {
    pub(super) fn new<'a>(walks: impl IntoIterator<Item = &'a Vec<usize>>) -> Self {
        let mut visits = Self {
            vertex: Vec::new(),
            next: Vec::new(),
            previous: Vec::new(),
            starts: vec![0],
        };
        for walk in walks {
            let (first, count) = (visits.vertex.len(), walk.len());
            visits.vertex.extend(walk);
            visits.next.extend((0..count).map(|k| first + (k + 1) % count));
            visits
                .previous
                .extend((0..count).map(|k| first + (k + count - 1) % count));
            visits.starts.push(first + count);
        }
        visits
    }

    /// The edges of all walks as pairs of vertices, each once for every time it is walked along.
    pub(super) fn edges(&self) -> impl Iterator<Item = (usize, usize)> {
        self.next
            .iter()
            .enumerate()
            .filter(|&(visit, &next)| visit != next)
            .map(|(visit, &next)| (self.vertex[visit], self.vertex[next]))
    }

    /// Whether the free space at `visit` takes the direction towards `target` in. Exact; directions along the walk's own
    /// edges may go either way.
    pub(super) fn opens_to(&self, visit: usize, positions: &[Point], target: Point) -> bool {
        let (before, after) = (self.vertex[self.previous[visit]], self.vertex[self.next[visit]]);
        if before == after {
            // The end of a path, or a single vertex: all around.
            return true;
        }
        let (previous, here, next) = (positions[before], positions[self.vertex[visit]], positions[after]);
        let left_of_next = predicate::orientation(here, next, target).is_gt();
        let right_of_previous = predicate::orientation(here, target, previous).is_gt();
        if predicate::orientation(previous, here, next).is_gt() {
            left_of_next && right_of_previous
        } else {
            left_of_next || right_of_previous
        }
    }
}

/// The free space of one pose.
#[derive(Debug)]
pub(super) struct FreeSpace {
    /// Its points and triangles are numbered by visit.
    sight: Sight,
    /// The triangles at each visit.
    fans: Vec<Vec<usize>>,
}

impl FreeSpace {
    /// `None` if the walks are not what they should be (edges that touch), which exact input never is.
    pub(super) fn new(positions: &[Point], visits: &Visits) -> Option<Self> {
        let apexes = delaunay(positions, visits)?;
        let mut owners: BTreeMap<[usize; 3], [Option<usize>; 3]> = BTreeMap::new();
        for visit in 0..visits.vertex.len() {
            for (a, b, c) in fan(&apexes, visits, visit)? {
                // A triangle is known by its vertices, the lowest first.
                let mut corners = [a, b, c];
                let turn = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                corners.rotate_left(turn);
                owners.entry(corners).or_default()[(3 - turn) % 3] = Some(visit);
            }
        }
        let triangles: Vec<[usize; 3]> = owners
            .into_values()
            .map(|owners| Some([owners[0]?, owners[1]?, owners[2]?]))
            .collect::<Option<_>>()?;
        let walls: BTreeSet<(usize, usize)> = visits.next.iter().copied().enumerate().collect();
        let mut fans = vec![Vec::new(); visits.vertex.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for &visit in triangle {
                fans[visit].push(t);
            }
        }
        let points = visits.vertex.iter().map(|&v| positions[v]).collect();
        Some(Self {
            sight: Sight::between_walls(points, triangles, &walls),
            fans,
        })
    }

    /// The visits that `visit` sees.
    pub(super) fn seen_from(&self, visit: usize) -> Vec<usize> {
        self.sight.seen_from(visit)
    }

    /// How many triangle edges lie between `visit` and every visit at least; `None` where there is no way.
    pub(super) fn steps_from(&self, visit: usize) -> Vec<Option<usize>> {
        let (reached, _) = self.search(visit);
        self.fans
            .iter()
            .map(|fan| fan.iter().filter_map(|&t| reached[t]).min())
            .collect()
    }

    /// The inner points of a path from one visit to another through the fewest triangles, cut short.
    pub(super) fn path(&self, from: usize, to: usize) -> Option<Vec<Point>> {
        let gates = self.gates(from, to)?;
        let points = &self.sight.points;
        let mut stops = vec![points[from]];
        stops.extend(gates.iter().map(|&(right, left)| (points[right] + points[left]) * 0.5));
        stops.push(points[to]);
        let mut path = Vec::new();
        let mut at = 0;
        while at + 1 < stops.len() {
            at = self.farthest(&stops, &gates, at);
            path.push(stops[at]);
        }
        path.pop();
        Some(path)
    }

    /// Breadth-first over triangles from those at a visit: how many edges lie before each, and from which triangle and
    /// over which of its edges it was reached.
    #[expect(clippy::type_complexity, reason = "used here only")]
    fn search(&self, visit: usize) -> (Vec<Option<usize>>, Vec<Option<(usize, usize)>>) {
        let count = self.sight.triangles.len();
        let (mut reached, mut before) = (vec![None; count], vec![None; count]);
        let mut queue: VecDeque<(usize, usize)> = self.fans[visit].iter().map(|&t| (t, 0)).collect();
        for &t in &self.fans[visit] {
            reached[t] = Some(0);
        }
        while let Some((t, steps)) = queue.pop_front() {
            for (edge, beyond) in self.sight.neighbours(t).into_iter().enumerate() {
                if let Some(beyond) = beyond.filter(|&beyond| reached[beyond].is_none()) {
                    reached[beyond] = Some(steps + 1);
                    before[beyond] = Some((t, edge));
                    queue.push_back((beyond, steps + 1));
                }
            }
        }
        (reached, before)
    }

    /// The edges that the way passes, as visits to the right and left of it.
    fn gates(&self, from: usize, to: usize) -> Option<Vec<(usize, usize)>> {
        let (reached, before) = self.search(from);
        let mut t = *self.fans[to]
            .iter()
            .filter(|&&t| reached[t].is_some())
            .min_by_key(|&&t| reached[t])?;
        let mut gates = Vec::new();
        while let Some((previous, edge)) = before[t] {
            let triangle = self.sight.triangles[previous];
            // Out of a positive triangle, its edges run from right to left.
            gates.push((triangle[edge], triangle[(edge + 1) % 3]));
            t = previous;
        }
        gates.reverse();
        Some(gates)
    }

    /// The last stop that stop `at` reaches in a straight line through all gates between.
    fn farthest(&self, stops: &[Point], gates: &[(usize, usize)], at: usize) -> usize {
        let eye = stops[at];
        let points = &self.sight.points;
        let mut best = at + 1;
        let mut cone: Option<(Point, Point)> = None;
        // Stop k + 1 lies on gate k.
        for k in at..stops.len() - 1 {
            let target = stops[k + 1];
            let is_within = cone.is_none_or(|(right, left)| {
                predicate::orientation(eye, right, target).is_gt() && predicate::orientation(eye, left, target).is_lt()
            });
            if is_within {
                best = k + 1;
            }
            let Some(&(right, left)) = gates.get(k) else { break };
            let (gate_right, gate_left) = (points[right], points[left]);
            let (right, left) = cone.unwrap_or((gate_right, gate_left));
            let narrower_right = predicate::orientation(eye, right, gate_right).is_gt();
            let narrower_left = predicate::orientation(eye, left, gate_left).is_lt();
            let right = if narrower_right { gate_right } else { right };
            let left = if narrower_left { gate_left } else { left };
            if !predicate::orientation(eye, right, left).is_gt() {
                break;
            }
            cone = Some((right, left));
        }
        best
    }
}

/// For each directed edge of the constrained Delaunay triangulation the corner opposite to it.
fn delaunay(positions: &[Point], visits: &Visits) -> Option<BTreeMap<(usize, usize), usize>> {
    let mut vertices = visits.vertex.clone();
    vertices.sort_unstable();
    vertices.dedup();
    // Spade refuses coordinates too small to be exact with.
    let admitted = |x: f64| if x.abs() < spade::MIN_ALLOWED_VALUE { 0.0 } else { x };
    let mut triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut handles = BTreeMap::new();
    let mut names = BTreeMap::new();
    for &vertex in &vertices {
        let p = positions[vertex];
        let handle = triangulation.insert(Point2::new(admitted(p.x), admitted(p.y))).ok()?;
        handles.insert(vertex, handle);
        if names.insert(handle.index(), vertex).is_some() {
            return None;
        }
    }
    for (a, b) in visits.edges() {
        let (from, to) = (handles[&a], handles[&b]);
        if !triangulation.exists_constraint(from, to) && triangulation.try_add_constraint(from, to).len() != 1 {
            return None;
        }
    }
    let mut apexes = BTreeMap::new();
    for face in triangulation.inner_faces() {
        let [a, b, c] = face.vertices().map(|handle| names[&handle.index()]);
        if !predicate::is_positive(positions[a], positions[b], positions[c]) {
            return None;
        }
        apexes.extend([((a, b), c), ((b, c), a), ((c, a), b)]);
    }
    Some(apexes)
}

/// The triangles at a visit, the visit's vertex first, from the edge to its successor on.
fn fan(apexes: &BTreeMap<(usize, usize), usize>, visits: &Visits, visit: usize) -> Option<Vec<(usize, usize, usize)>> {
    let here = visits.vertex[visit];
    let (first, last) = if visits.next[visit] == visit {
        // A single vertex: from any edge all around.
        let (&(_, any), _) = apexes.range((here, 0)..=(here, usize::MAX)).next()?;
        (any, any)
    } else {
        (visits.vertex[visits.next[visit]], visits.vertex[visits.previous[visit]])
    };
    let mut triangles = Vec::new();
    let mut at = first;
    loop {
        let beyond = *apexes.get(&(here, at))?;
        triangles.push((here, at, beyond));
        at = beyond;
        if at == last {
            return Some(triangles);
        }
        if triangles.len() > apexes.len() {
            return None;
        }
    }
}
