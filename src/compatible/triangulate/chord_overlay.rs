//! Stage IV: the last resort that always succeeds, the overlay of the poses' own triangulations (Aronov, Seidel,
//! Souvaine 1993).
//!
//! 1. Each pose gets a triangulation of its own, chosen by dynamic programming over its diagonals so that it crosses
//!    the other poses' as little as possible; a few rounds over the poses.
//! 2. All of them are drawn as chords of one convex polygon with m corners. Where two chords cross there is a Steiner
//!    point. The corners are jittered off the regular polygon, whose diagonals meet in common points.
//! 3. The cells between the chords are convex; each is cut into triangles.
//! 4. In pose p, every cell lies in one triangle of pose p. Crossings on a chord of pose p are spaced evenly along it;
//!    those inside a triangle of pose p are placed by a Tutte embedding with the triangle's sides fixed, which is
//!    one-to-one (Floater 2003).
//!
//! Differences from the paper: it maps the cells affinely, which makes needles; even spacing and Tutte's embedding give
//! smallest angles that are thousands of times larger. Guarantee: in exact arithmetic all triangles are positive; after
//! rounding they are proven with exact predicates, and other jitters are tried before giving up.
//! Cost O(k^1.5) for k crossings, of which there are at most C(N,2)(m-3)^2.

use std::collections::BTreeMap;

use super::visibility::{Relation, Sight};
use crate::math::{Point, point, predicate};
use crate::solve::{SparseCholesky, Triplets};

/// Jitters tried before giving up. One is enough unless a corridor is about as narrow as rounding.
const ATTEMPTS: u64 = 4;

/// Rounds in which every pose's triangulation is chosen anew against the others'.
const ROUNDS: usize = 6;

/// The overlay: triangles on the m polygon vertices followed by the Steiner points, and the latter's places per pose.
#[derive(Debug, Clone)]
pub(super) struct Overlay {
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) points: Vec<Vec<Point>>,
}

impl Overlay {
    pub(super) fn steiner_count(&self) -> usize {
        self.points.first().map_or(0, Vec::len)
    }
}

/// A chord of the convex polygon, `from < to`.
type Chord = (usize, usize);

/// Overlays the poses' triangulations; `None` if no attempt survives rounding.
pub(super) fn overlay(sights: &[Sight]) -> Option<Overlay> {
    let triangulations = least_crossing_triangulations(sights);
    (0..ATTEMPTS).find_map(|attempt| {
        let arrangement = Arrangement::new(sights.first()?.points.len(), &triangulations, attempt)?;
        let triangles = arrangement.triangles()?;
        let points = sights
            .iter()
            .zip(&triangulations)
            .map(|(sight, own)| arrangement.embed(&sight.points, own, &triangles))
            .collect::<Option<Vec<_>>>()?;
        Some(Overlay { triangles, points })
    })
}

/// One triangulation a pose, as triangles, chosen so that chords of different poses cross seldom.
fn least_crossing_triangulations(sights: &[Sight]) -> Vec<Vec<[usize; 3]>> {
    let count = sights[0].points.len();
    let visible: Vec<Relation> = sights.iter().map(Sight::visible_pairs).collect();
    let mut chosen: Vec<Vec<[usize; 3]>> = sights.iter().map(|sight| sight.triangles.clone()).collect();
    for round in 0..ROUNDS {
        let mut changed = false;
        for pose in 0..sights.len() {
            let others: Vec<Chord> = (0..sights.len())
                // In the first round the later poses' triangulations mean nothing yet.
                .filter(|&other| other != pose && (round > 0 || other < pose))
                .flat_map(|other| chords_of(count, &chosen[other]))
                .collect();
            let crossings = CrossingCount::new(count, &others);
            let best = cheapest_triangulation(count, &visible[pose], |chord| crossings.of(chord));
            if let Some(best) = best.filter(|best| *best != chosen[pose]) {
                chosen[pose] = best;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    chosen
}

/// How many of a multiset of chords cross a given one, by sums over a table. O(m^2) to build, O(1) to ask.
struct CrossingCount {
    count: usize,
    /// sums[i][j]: chords (a, b) with a < i and b < j.
    sums: Vec<u32>,
}

impl CrossingCount {
    fn new(count: usize, chords: &[Chord]) -> Self {
        let width = count + 1;
        let mut sums = vec![0_u32; width * width];
        for &(a, b) in chords {
            sums[(a + 1) * width + b + 1] += 1;
        }
        for i in 1..width {
            for j in 1..width {
                let index = i * width + j;
                sums[index] = sums[index] + sums[index - width] + sums[index - 1] - sums[index - width - 1];
            }
        }
        Self { count, sums }
    }

    fn within(&self, first: std::ops::Range<usize>, second: std::ops::Range<usize>) -> u32 {
        let width = self.count + 1;
        let at = |i: usize, j: usize| self.sums[i * width + j];
        at(first.end, second.end) + at(first.start, second.start)
            - at(first.start, second.end)
            - at(first.end, second.start)
    }

    /// Chords with one end strictly between the ends of this one and the other strictly outside.
    fn of(&self, (from, to): Chord) -> u32 {
        self.within(from + 1..to, to + 1..self.count) + self.within(0..from, from + 1..to)
    }
}

/// The triangulation by `allowed` diagonals with the least total cost of its diagonals. The cost of a chord counts each
/// crossing; one more is added so that among equals fewer distinct chords cross.
fn cheapest_triangulation(count: usize, allowed: &Relation, cost: impl Fn(Chord) -> u32) -> Option<Vec<[usize; 3]>> {
    let mut best = vec![(u32::MAX, usize::MAX); count * count];
    for i in 0..count - 1 {
        best[i * count + i + 1].0 = 0;
    }
    for span in 2..count {
        for i in 0..count - span {
            let j = i + span;
            if !allowed.get(i, j) {
                continue;
            }
            let own = if (i, j) == (0, count - 1) { 0 } else { cost((i, j)) };
            let mut champion = (u32::MAX, usize::MAX);
            for k in i + 1..j {
                let (left, right) = (best[i * count + k].0, best[k * count + j].0);
                if left != u32::MAX && right != u32::MAX && left + right < champion.0 {
                    champion = (left + right, k);
                }
            }
            if champion.1 != usize::MAX {
                best[i * count + j] = (champion.0 + own, champion.1);
            }
        }
    }
    let mut triangles = Vec::with_capacity(count - 2);
    let mut stack = vec![(0, count - 1)];
    while let Some((i, j)) = stack.pop() {
        if j - i >= 2 {
            let k = best[i * count + j].1;
            if k == usize::MAX {
                return None;
            }
            triangles.push([i, k, j]);
            stack.extend([(i, k), (k, j)]);
        }
    }
    Some(triangles)
}

/// The diagonals of a triangulated polygon with `count` corners, sorted.
fn chords_of(count: usize, triangles: &[[usize; 3]]) -> Vec<Chord> {
    let mut chords: Vec<Chord> = triangles
        .iter()
        .flat_map(|&t| crate::mesh::directed_edges(t))
        .map(|(a, b)| crate::mesh::undirected(a, b))
        .filter(|&(a, b)| b - a > 1 && !(a == 0 && b == count - 1))
        .collect();
    chords.sort_unstable();
    chords.dedup();
    chords
}

/// Chords of a convex polygon and their crossings.
struct Arrangement {
    count: usize,
    /// Corners, then crossings.
    places: Vec<Point>,
    chords: Vec<Chord>,
    /// Per chord, its vertices in order from one end to the other.
    along: Vec<Vec<usize>>,
}

impl Arrangement {
    fn new(count: usize, triangulations: &[Vec<[usize; 3]>], attempt: u64) -> Option<Self> {
        let mut places = jittered_polygon(count, attempt);
        let mut chords: Vec<Chord> = triangulations.iter().flat_map(|own| chords_of(count, own)).collect();
        chords.sort_unstable();
        chords.dedup();
        // Per chord, (place along it, vertex).
        let mut stops: Vec<Vec<(f64, usize)>> = chords.iter().map(|&(a, b)| vec![(0.0, a), (1.0, b)]).collect();
        for first in 0..chords.len() {
            let (a, b) = chords[first];
            for second in first + 1..chords.len() {
                let (c, d) = chords[second];
                if c >= b {
                    // Sorted by their first ends: no later chord starts inside.
                    break;
                }
                if !(a < c && b < d) {
                    continue;
                }
                let (pa, pb, pc, pd) = (places[a], places[b], places[c], places[d]);
                let (u, v) = (pb - pa, pd - pc);
                let denominator = point::cross(u, v);
                let at_first = point::cross(pc - pa, v) / denominator;
                let at_second = point::cross(pc - pa, u) / denominator;
                let vertex = places.len();
                places.push(pa + u * at_first);
                stops[first].push((at_first, vertex));
                stops[second].push((at_second, vertex));
            }
        }
        let mut along = Vec::with_capacity(chords.len());
        for list in &mut stops {
            list.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            // Crossings that coincide to rounding could stand in the wrong order: try another jitter.
            const SMALLEST_GAP: f64 = 1e-13;
            if list.windows(2).any(|pair| pair[1].0 - pair[0].0 < SMALLEST_GAP) {
                return None;
            }
            along.push(list.iter().map(|stop| stop.1).collect());
        }
        Some(Self {
            count,
            places,
            chords,
            along,
        })
    }

    /// The triangulated cells.
    fn triangles(&self) -> Option<Vec<[usize; 3]>> {
        let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); self.places.len()];
        let corners = (0..self.count).map(|k| [k, (k + 1) % self.count]);
        let pieces = self
            .along
            .iter()
            .flat_map(|list| list.windows(2).map(|pair| [pair[0], pair[1]]));
        for [a, b] in corners.chain(pieces) {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        for (v, list) in neighbours.iter_mut().enumerate() {
            let direction = |w: usize| {
                let d = self.places[w] - self.places[v];
                d.y.atan2(d.x)
            };
            list.sort_by(|&a, &b| direction(a).total_cmp(&direction(b)));
        }
        // Each directed edge has the cell on its left; from (u, v) the next edge turns as far left as possible.
        let mut used: Vec<Vec<bool>> = neighbours.iter().map(|list| vec![false; list.len()]).collect();
        let mut triangles = Vec::new();
        for start in 0..self.places.len() {
            for first in 0..neighbours[start].len() {
                if used[start][first] {
                    continue;
                }
                let mut cell = Vec::new();
                let (mut at, mut slot) = (start, first);
                while !used[at][slot] {
                    used[at][slot] = true;
                    cell.push(at);
                    let next = neighbours[at][slot];
                    let back = neighbours[next].iter().position(|&w| w == at)?;
                    let degree = neighbours[next].len();
                    slot = (back + degree - 1) % degree;
                    at = next;
                }
                let area: f64 = (0..cell.len())
                    .map(|k| point::cross(self.places[cell[k]], self.places[cell[(k + 1) % cell.len()]]))
                    .sum();
                if area > 0.0 {
                    self.cut_cell(&cell, &mut triangles);
                }
            }
        }
        Some(triangles)
    }

    /// Cuts a convex cell into triangles, shortest diagonals first.
    fn cut_cell(&self, cell: &[usize], triangles: &mut Vec<[usize; 3]>) {
        let mut remaining = cell.to_vec();
        while remaining.len() > 3 {
            let count = remaining.len();
            let length = |k: usize| {
                let (before, after) = (remaining[(k + count - 1) % count], remaining[(k + 1) % count]);
                (self.places[after] - self.places[before]).norm_squared()
            };
            let ear = (0..count).min_by(|&a, &b| length(a).total_cmp(&length(b))).unwrap_or(0);
            triangles.push([
                remaining[(ear + count - 1) % count],
                remaining[ear],
                remaining[(ear + 1) % count],
            ]);
            remaining.remove(ear);
        }
        if let [a, b, c] = remaining[..] {
            triangles.push([a, b, c]);
        }
    }

    /// The crossings' places in a pose with the given corners and own triangulation; `None` if a triangle is not
    /// positive after rounding.
    fn embed(&self, corners: &[Point], own: &[[usize; 3]], triangles: &[[usize; 3]]) -> Option<Vec<Point>> {
        let mut places: Vec<Option<Point>> = corners.iter().copied().map(Some).collect();
        places.resize(self.places.len(), None);
        for chord in chords_of(self.count, own) {
            let list = &self.along[self.chords.binary_search(&chord).ok()?];
            let (a, b) = (corners[chord.0], corners[chord.1]);
            for (k, &v) in list.iter().enumerate() {
                if v >= self.count {
                    places[v] = Some(a + (b - a) * (k as f64 / (list.len() - 1) as f64));
                }
            }
        }
        self.embed_inside(&mut places, triangles)?;
        let places: Vec<Point> = places.into_iter().collect::<Option<_>>()?;
        let positive = triangles
            .iter()
            .all(|&[a, b, c]| predicate::is_positive(places[a], places[b], places[c]));
        positive.then(|| places[self.count..].to_vec())
    }

    /// Tutte's embedding of the vertices inside each triangle of the pose.
    fn embed_inside(&self, places: &mut [Option<Point>], triangles: &[[usize; 3]]) -> Option<()> {
        let mut neighbours: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &triangle in triangles {
            for (a, b) in crate::mesh::directed_edges(triangle) {
                // Interior vertices: each edge appears in both directions, so this lists every neighbour once.
                if places[a].is_none() {
                    neighbours.entry(a).or_default().push(b);
                }
            }
        }
        // The unknowns fall into one system a triangle: components of free vertices.
        let mut component: BTreeMap<usize, usize> = BTreeMap::new();
        let mut members: Vec<Vec<usize>> = Vec::new();
        for &seed in neighbours.keys() {
            if component.contains_key(&seed) {
                continue;
            }
            let mut list = vec![seed];
            component.insert(seed, members.len());
            let mut next = 0;
            while next < list.len() {
                for &w in &neighbours[&list[next]] {
                    if places[w].is_none() && !component.contains_key(&w) {
                        component.insert(w, members.len());
                        list.push(w);
                    }
                }
                next += 1;
            }
            members.push(list);
        }
        for list in members {
            solve_tutte(places, &list, &neighbours)?;
        }
        Some(())
    }
}

/// Larger systems are solved as sparse ones: dense ones are cubic, and a triangle may hold thousands of crossings.
const LARGEST_DENSE: usize = 48;

/// Solves for the free vertices in `list`: each is the mean of its neighbours.
fn solve_tutte(places: &mut [Option<Point>], list: &[usize], neighbours: &BTreeMap<usize, Vec<usize>>) -> Option<()> {
    let index: BTreeMap<usize, usize> = list.iter().enumerate().map(|(k, &v)| (v, k)).collect();
    let size = list.len();
    if size > LARGEST_DENSE {
        return solve_sparse_tutte(places, list, &index, neighbours);
    }
    let mut matrix = nalgebra::DMatrix::<f64>::zeros(size, size);
    let mut right = nalgebra::DMatrix::<f64>::zeros(size, 2);
    for (row, v) in list.iter().enumerate() {
        for w in &neighbours[v] {
            matrix[(row, row)] += 1.0;
            match (places[*w], index.get(w)) {
                (Some(p), _) => {
                    right[(row, 0)] += p.x;
                    right[(row, 1)] += p.y;
                }
                (None, Some(&column)) => matrix[(row, column)] -= 1.0,
                (None, None) => return None,
            }
        }
    }
    let solution = matrix.cholesky()?.solve(&right);
    for (row, &v) in list.iter().enumerate() {
        places[v] = Some(Point::new(solution[(row, 0)], solution[(row, 1)]));
    }
    Some(())
}

/// As [`solve_tutte`].
fn solve_sparse_tutte(
    places: &mut [Option<Point>],
    list: &[usize],
    index: &BTreeMap<usize, usize>,
    neighbours: &BTreeMap<usize, Vec<usize>>,
) -> Option<()> {
    let mut system = Triplets::new(list.len(), list.len());
    let mut solution = vec![[0.0; 2]; list.len()];
    for (row, v) in list.iter().enumerate() {
        for w in &neighbours[v] {
            system.add(row, row, 1.0);
            match (places[*w], index.get(w)) {
                (Some(p), _) => {
                    solution[row][0] += p.x;
                    solution[row][1] += p.y;
                }
                (None, Some(&column)) => system.add(row, column, -1.0),
                (None, None) => return None,
            }
        }
    }
    let factor = SparseCholesky::new(&system.build()).ok()?;
    factor.solve(&mut solution, &mut Vec::new()).ok()?;
    for (&v, place) in list.iter().zip(solution) {
        places[v] = Some(Point::from(place));
    }
    Some(())
}

/// A convex polygon with `count` corners on the unit circle, moved off even spacing so that no three chords meet.
fn jittered_polygon(count: usize, attempt: u64) -> Vec<Point> {
    // A fixed linear congruential sequence (Knuth's MMIX constants): the same bytes every time.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64.wrapping_add(attempt);
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count)
        .map(|k| {
            let angle = std::f64::consts::TAU * (k as f64 + 0.6 * (random() - 0.5)) / count as f64;
            Point::new(angle.cos(), angle.sin())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::visibility::tests::{sight_of, star};
    use super::*;

    #[test]
    fn crossings_are_counted_like_by_hand() {
        let counted = CrossingCount::new(6, &[(0, 3), (1, 4), (1, 3)]);
        assert_eq!(counted.of((2, 5)), 3);
        assert_eq!(counted.of((0, 2)), 2);
        assert_eq!(counted.of((0, 3)), 1);
    }

    #[test]
    fn the_overlay_of_opposite_stars_is_positive_in_both() {
        let radii = |phase: usize| {
            (0..12)
                .map(|k| if (k + phase).is_multiple_of(2) { 1.0 } else { 0.3 })
                .collect::<Vec<_>>()
        };
        let sights = [sight_of(star(&radii(0))), sight_of(star(&radii(1)))];
        let overlay = overlay(&sights).expect("it always exists");
        assert!(overlay.steiner_count() > 0);
        for (sight, added) in sights.iter().zip(&overlay.points) {
            let mut places = sight.points.clone();
            places.extend(added);
            assert!(
                overlay
                    .triangles
                    .iter()
                    .all(|&[a, b, c]| predicate::is_positive(places[a], places[b], places[c]))
            );
        }
        // V - E + F = 1 for a disc, with E = (3 F + boundary) / 2.
        let vertices = 12 + overlay.steiner_count();
        assert_eq!(overlay.triangles.len(), 2 * vertices - 12 - 2);
    }
}
