//! Stage I: diagonals with line of sight in all poses (NWM 3.1), chosen well.
//!
//! The paper takes any common diagonal it finds. Here interval dynamic programming over the relation of common diagonals
//! finds, if there is one, the complete triangulation whose worst angle over all poses is largest
//! ([`best_triangulation`]), and otherwise the set of common diagonals whose faces will need the fewest Steiner points, as
//! far as that can be told from their sides ([`cheapest_partition`]). It is not the largest set: a pentagon needs one
//! point, two quadrilaterals two. Cost O(m d^2) for m vertices with d common diagonals each, O(m^3) at worst, and so for
//! pieces of bounded size only.
//!
//! Larger pieces are divided along one diagonal after another ([`balanced_diagonal`]), each of which is proven to take
//! part in a complete triangulation if there is one (up to [`LARGEST_EXHAUSTIVE`] vertices): O(m^2) to choose, and m^3 / 64
//! operations on words to prove.

use super::visibility::Relation;

/// The triangulation by common diagonals that maximises the smallest value of `quality` over its triangles; `None` if
/// the common diagonals do not triangulate the polygon.
pub(super) fn best_triangulation(
    count: usize,
    common: &Relation,
    quality: impl Fn([usize; 3]) -> f64,
) -> Option<Vec<[usize; 3]>> {
    // best[i][j]: of the sub-polygon i..=j, (quality, apex of the triangle on the edge i j).
    let mut best = vec![(f64::NEG_INFINITY, usize::MAX); count * count];
    for i in 0..count.saturating_sub(1) {
        best[i * count + i + 1].0 = f64::INFINITY;
    }
    let reach: Vec<Vec<usize>> = (0..count)
        .map(|i| (i + 1..count).filter(|&j| common.get(i, j)).collect())
        .collect();
    for span in 2..count {
        for i in 0..count - span {
            let j = i + span;
            if !common.get(i, j) {
                continue;
            }
            let mut champion = (f64::NEG_INFINITY, usize::MAX);
            for &k in reach[i].iter().take_while(|&&k| k < j) {
                let parts = best[i * count + k].0.min(best[k * count + j].0);
                // Only then is the triangle worth measuring.
                if parts > champion.0 {
                    let value = parts.min(quality([i, k, j]));
                    if value > champion.0 {
                        champion = (value, k);
                    }
                }
            }
            best[i * count + j] = champion;
        }
    }
    if count < 3 || best[count - 1].1 == usize::MAX {
        return None;
    }
    let mut triangles = Vec::with_capacity(count - 2);
    let mut stack = vec![(0, count - 1)];
    while let Some((i, j)) = stack.pop() {
        if j - i < 2 {
            continue;
        }
        let k = best[i * count + j].1;
        triangles.push([i, k, j]);
        stack.push((i, k));
        stack.push((k, j));
    }
    Some(triangles)
}

/// The Steiner points that a face is expected to need, by its number of sides less one. Triangles need none; every
/// quadrilateral and pentagon has a kernel, so that one point is enough in all poses; what larger faces need is an estimate.
const FACE_COST: [f64; 9] = [0.0, 0.0, 0.0, 1.0, 1.0, 1.4, 1.9, 2.5, 3.1];

/// What every further side adds to the last of them.
const SIDE_COST: f64 = 0.6;

/// The whole weight of the lengths of diagonals against Steiner points: they decide between equals only.
const LENGTH_WEIGHT: f64 = 1e-3;

/// The set of common diagonals without crossings whose faces are expected to need the fewest Steiner points; of
/// several, one whose diagonals have the least total `length`.
pub(super) fn cheapest_partition(
    count: usize,
    common: &Relation,
    length: impl Fn(usize, usize) -> f64,
) -> Vec<(usize, usize)> {
    const MOST: usize = FACE_COST.len() - 1;
    let is_side = |i: usize, j: usize| j == i + 1 || common.get(i, j);
    // Chains of sides and diagonals from i to j, within i..=j: for each number of links (the last one: or more), what
    // the pieces that they cut off cost, and the vertex before j. One link: the chord itself.
    let mut chains = vec![[(f64::INFINITY, usize::MAX); MOST + 1]; count * count];
    // The number of links of the chain that makes the best face with the chord i j.
    let mut closing = vec![0_usize; count * count];
    let before: Vec<Vec<usize>> = (0..count)
        .map(|j| (0..j).filter(|&k| is_side(k, j)).collect())
        .collect();
    for i in 0..count.saturating_sub(1) {
        chains[i * count + i + 1][1] = (0.0, i);
    }
    for span in 2..count {
        for i in 0..count - span {
            let j = i + span;
            let mut here = [(f64::INFINITY, usize::MAX); MOST + 1];
            for &k in before[j].iter().rev().take_while(|&&k| k > i) {
                let last = chains[k * count + j][1].0;
                let first = &chains[i * count + k];
                for links in 2..=MOST {
                    let mut price = first[links - 1].0;
                    if links == MOST {
                        price = price.min(first[MOST].0 + SIDE_COST);
                    }
                    if price + last < here[links].0 {
                        here[links] = (price + last, k);
                    }
                }
            }
            if is_side(i, j) {
                let total = |links: usize| here[links].0 + FACE_COST[links];
                let best = (2..=MOST)
                    .min_by(|&a, &b| total(a).total_cmp(&total(b)))
                    .unwrap_or(MOST);
                let own = if span == count - 1 {
                    0.0
                } else {
                    LENGTH_WEIGHT * length(i, j)
                };
                closing[i * count + j] = best;
                here[1] = (total(best) + own, i);
            }
            chains[i * count + j] = here;
        }
    }
    let mut chosen = Vec::new();
    let mut stack = if count > 3 { vec![(0, count - 1)] } else { Vec::new() };
    while let Some((i, j)) = stack.pop() {
        if j - i < 2 {
            continue;
        }
        if j - i < count - 1 {
            chosen.push((i, j));
        }
        let (mut at, mut links) = (j, closing[i * count + j]);
        while at != i {
            let before = if links == 1 { i } else { chains[i * count + at][links].1 };
            stack.push((before, at));
            if links == MOST {
                let at_least = &chains[i * count + before];
                if at_least[MOST - 1].0 <= at_least[MOST].0 + SIDE_COST {
                    links -= 1;
                }
            } else {
                links -= 1;
            }
            at = before;
        }
    }
    chosen.sort_unstable();
    chosen
}

/// The faces into which non-crossing diagonals divide a polygon, each as its vertices in order.
pub(super) fn faces(count: usize, diagonals: &[(usize, usize)]) -> Vec<Vec<usize>> {
    // From each vertex, its chords to later vertices, farthest first: nested chords form a tree.
    let mut farther: Vec<Vec<usize>> = vec![Vec::new(); count];
    for &(i, j) in diagonals {
        farther[i].push(j);
    }
    for list in &mut farther {
        list.sort_unstable_by(|a, b| b.cmp(a));
    }
    let mut faces = Vec::new();
    // A face is walked from the chord that closes it: from i, always over the longest chord that stays inside.
    let mut stack = vec![(0, count - 1)];
    while let Some((i, j)) = stack.pop() {
        let mut face = vec![i];
        let mut at = i;
        while at != j {
            let next = farther[at]
                .iter()
                .copied()
                .find(|&k| k <= j && !(at == i && k == j))
                .unwrap_or(at + 1);
            if next > at + 1 {
                stack.push((at, next));
            }
            face.push(next);
            at = next;
        }
        faces.push(face);
    }
    faces
}

/// The common diagonal along which to divide a large polygon: of those that leave both parts a quarter of the vertices,
/// or else of the most even ones, the one with the least `cost` for which `is_clear` holds.
///
/// Where the common diagonals triangulate the whole polygon, only diagonals that take part in such a triangulation are
/// considered, so that none is lost. That is found out exactly, by dynamic programming over rows of bits.
pub(super) fn balanced_diagonal(
    count: usize,
    common: &Relation,
    cost: impl Fn(usize, usize) -> f64,
    is_clear: impl Fn(usize, usize) -> bool,
) -> Option<(usize, usize)> {
    let completable = Completable::new(count, common);
    // One at a time: all pairs together would be most of the memory.
    let mut best: Option<(usize, f64, (usize, usize))> = None;
    for i in 0..count {
        for j in i + 2..count {
            if (i, j) == (0, count - 1) || !common.get(i, j) || !completable.allows(i, j) {
                continue;
            }
            let evenness = (j - i).min(count - (j - i)).min(count / 4);
            if best.is_some_and(|best| best.0 > evenness) {
                continue;
            }
            let cost = cost(i, j);
            let is_better = best.is_none_or(|best| best.0 < evenness || cost < best.1);
            if is_better && is_clear(i, j) {
                best = Some((evenness, cost, (i, j)));
            }
        }
    }
    best.map(|(_, _, diagonal)| diagonal)
}

/// Larger polygons are divided without knowing whether a complete triangulation is lost by it.
const LARGEST_EXHAUSTIVE: usize = 2048;

/// Which diagonals take part in a complete triangulation by common diagonals. Cost O(m^3 / 64).
struct Completable {
    /// `None` if there is no complete triangulation, or it was not looked for.
    diagonals: Option<BitRows>,
}

impl Completable {
    fn new(count: usize, common: &Relation) -> Self {
        let nothing = Self { diagonals: None };
        if !(3..=LARGEST_EXHAUSTIVE).contains(&count) {
            return nothing;
        }
        // inner: the chain i..=j with its chord can be triangulated. Rows by i, and by j.
        let (mut inner, mut inner_by_end) = (BitRows::new(count), BitRows::new(count));
        for span in 1..count {
            for i in 0..count - span {
                let j = i + span;
                if span == 1 || (common.get(i, j) && inner.row(i).meets(inner_by_end.row(j))) {
                    inner.set(i, j);
                    inner_by_end.set(j, i);
                }
            }
        }
        if !inner.get(0, count - 1) {
            return nothing;
        }
        // outer: what lies on the other side of the chord i j can be triangulated.
        let (mut outer, mut outer_by_end) = (BitRows::new(count), BitRows::new(count));
        outer.set(0, count - 1);
        outer_by_end.set(count - 1, 0);
        for span in (2..count - 1).rev() {
            for i in 0..count - span {
                let j = i + span;
                let apex_before = || inner_by_end.row(i).meets(outer_by_end.row(j));
                let apex_behind = || inner.row(j).meets(outer.row(i));
                if inner.get(i, j) && (apex_before() || apex_behind()) {
                    outer.set(i, j);
                    outer_by_end.set(j, i);
                }
            }
        }
        Self { diagonals: Some(outer) }
    }

    fn allows(&self, i: usize, j: usize) -> bool {
        self.diagonals.as_ref().is_none_or(|rows| rows.get(i, j))
    }
}

/// A square table of bits, for whole rows to be compared.
#[derive(Debug, Clone)]
struct BitRows {
    width: usize,
    words: Vec<u64>,
}

impl BitRows {
    fn new(count: usize) -> Self {
        let width = count.div_ceil(64);
        Self {
            width,
            words: vec![0; width * count],
        }
    }

    fn set(&mut self, row: usize, column: usize) {
        self.words[row * self.width + column / 64] |= 1 << (column % 64);
    }

    fn get(&self, row: usize, column: usize) -> bool {
        self.words[row * self.width + column / 64] >> (column % 64) & 1 == 1
    }

    fn row(&self, row: usize) -> BitRow<'_> {
        BitRow(&self.words[row * self.width..(row + 1) * self.width])
    }
}

/// One row of the table.
struct BitRow<'a>(&'a [u64]);

impl BitRow<'_> {
    /// Whether a column is set in both rows.
    fn meets(&self, other: BitRow<'_>) -> bool {
        self.0.iter().zip(other.0).any(|(mine, theirs)| mine & theirs != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::visibility::tests::{sight_of, star};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_convex_polygon_is_triangulated_by_its_best_diagonals() {
        let everything = Relation::full(6);
        let triangles = best_triangulation(6, &everything, |_| 1.0).expect("convex");
        assert_eq!(triangles.len(), 4);
        assert_eq!(cheapest_partition(6, &everything, |_, _| 1.0).len(), 3);
    }

    #[test]
    fn faces_of_two_chords() {
        let mut found = faces(7, &[(0, 2), (2, 6)]);
        found.sort();
        assert_eq!(found, vec![vec![0, 1, 2], vec![0, 2, 6], vec![2, 3, 4, 5, 6]]);
    }

    fn is_edge(count: usize, (i, j): (usize, usize)) -> bool {
        j == i + 1 || (i, j) == (0, count - 1)
    }

    fn diagonals(count: usize) -> Vec<(usize, usize)> {
        (0..count)
            .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
            .filter(|&chord| !is_edge(count, chord))
            .collect()
    }

    /// The relation that has the polygon's edges and those diagonals whose bit is set.
    fn relation(count: usize, bits: &[bool]) -> Relation {
        let mut relation = Relation::full(count);
        for ((i, j), _) in diagonals(count).into_iter().zip(bits).filter(|(_, bit)| !**bit) {
            relation.clear(i, j);
        }
        relation
    }

    /// Whether the vertices, in order, are triangulated by common diagonals among them.
    fn is_triangulable(common: &Relation, vertices: &[usize]) -> bool {
        let mut part = Relation::full(vertices.len());
        for (i, j) in diagonals(vertices.len()) {
            if !common.get(vertices[i], vertices[j]) {
                part.clear(i, j);
            }
        }
        best_triangulation(vertices.len(), &part, |_| 1.0).is_some()
    }

    fn price(count: usize, chosen: &[(usize, usize)]) -> f64 {
        let cost = |sides: usize| {
            let most = FACE_COST.len() - 1;
            FACE_COST[sides.min(most)] + SIDE_COST * sides.saturating_sub(most) as f64
        };
        faces(count, chosen).iter().map(|face| cost(face.len() - 1)).sum()
    }

    /// The least price over all sets of common diagonals without crossings.
    fn least_price(count: usize, left: &[(usize, usize)], chosen: &mut Vec<(usize, usize)>) -> f64 {
        let Some((&(c, d), rest)) = left.split_first() else {
            return price(count, chosen);
        };
        let without = least_price(count, rest, chosen);
        let crosses = |&(a, b): &(usize, usize)| (a < c && c < b && b < d) || (c < a && a < d && d < b);
        if chosen.iter().any(crosses) {
            return without;
        }
        chosen.push((c, d));
        let with = least_price(count, rest, chosen);
        chosen.pop();
        with.min(without)
    }

    #[test]
    fn one_pentagon_is_cheaper_than_two_quadrilaterals() {
        // Of a heptagon, either (0, 4) alone or (0, 3) with (3, 6): the latter leaves two quadrilaterals.
        let common = relation(
            7,
            &diagonals(7)
                .iter()
                .map(|d| [(0, 4), (0, 2), (3, 6)].contains(d))
                .collect::<Vec<_>>(),
        );
        let chosen = cheapest_partition(7, &common, |_, _| 1.0);
        assert!(price(7, &chosen) <= 2.0, "{chosen:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn no_partition_is_cheaper_than_the_cheapest(
            (count, bits) in (4_usize..9).prop_flat_map(|n| (Just(n), prop::collection::vec(prop::bool::weighted(0.3), 27))),
        ) {
            let common = relation(count, &bits);
            let chosen = cheapest_partition(count, &common, |_, _| 0.0);
            prop_assert!(chosen.iter().all(|&(i, j)| common.get(i, j) && !is_edge(count, (i, j))));
            let all: Vec<_> = diagonals(count).into_iter().filter(|&(i, j)| common.get(i, j)).collect();
            let least = least_price(count, &all, &mut Vec::new());
            prop_assert!((price(count, &chosen) - least).abs() < 1e-9, "{chosen:?} costs more than {least}");
        }

        #[test]
        fn faces_beyond_the_table_cost_by_their_sides(count in 10_usize..40, chord in (0_usize..40, 2_usize..20)) {
            // One diagonal at most: the price must be that of the whole, or of the two faces.
            let (i, j) = (chord.0 % (count / 2), (chord.0 % (count / 2) + chord.1).min(count - 2));
            prop_assume!(j > i + 1);
            let bits: Vec<bool> = diagonals(count).iter().map(|&d| d == (i, j)).collect();
            let chosen = cheapest_partition(count, &relation(count, &bits), |_, _| 0.0);
            prop_assert!(price(count, &chosen) <= price(count, &[]).min(price(count, &[(i, j)])) + 1e-9);
        }

        #[test]
        fn completable_diagonals_are_those_of_complete_triangulations(
            (count, bits) in (4_usize..12).prop_flat_map(|n| (Just(n), prop::collection::vec(prop::bool::weighted(0.6), 60))),
        ) {
            let common = relation(count, &bits);
            let completable = Completable::new(count, &common);
            let whole: Vec<usize> = (0..count).collect();
            prop_assert_eq!(completable.diagonals.is_some(), is_triangulable(&common, &whole));
            if completable.diagonals.is_some() {
                for (i, j) in diagonals(count) {
                    let inside: Vec<usize> = (i..=j).collect();
                    let outside: Vec<usize> = (j..count).chain(0..=i).collect();
                    let both = common.get(i, j) && is_triangulable(&common, &inside) && is_triangulable(&common, &outside);
                    prop_assert_eq!(completable.allows(i, j), both, "{} {}", i, j);
                }
            }
        }

        #[test]
        fn the_cheapest_partition_of_one_polygon_is_a_triangulation(
            radii in prop::collection::vec(0.1..1.0f64, 4..20)
        ) {
            let count = radii.len();
            let pairs = sight_of(star(&radii)).visible_pairs();
            let diagonals = cheapest_partition(count, &pairs, |_, _| 1.0);
            prop_assert_eq!(diagonals.len(), count - 3);
            prop_assert!(faces(count, &diagonals).iter().all(|face| face.len() == 3));
            prop_assert!(best_triangulation(count, &pairs, |_| 1.0).is_some());
        }
    }
}
