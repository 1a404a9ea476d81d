//! Stage I: diagonals with line of sight in all poses (NWM 3.1), chosen well.
//!
//! The paper takes any common diagonal it finds. Here interval dynamic programming over the relation of common
//! diagonals finds, if there is one, the complete triangulation whose worst angle over all poses is largest, and
//! otherwise a largest set of common diagonals that do not cross, so that what is left for Steiner points is as little
//! as it can be. Cost O(m d^2) for m vertices with d common diagonals each, O(m^3) at worst.

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

/// A largest set of common diagonals of which no two cross.
pub(super) fn largest_partition(count: usize, common: &Relation) -> Vec<(usize, usize)> {
    // most[i][j]: diagonals within the chain i..=j, the chord i j not counted; and the last partner of i, if any.
    let mut most = vec![(0_usize, usize::MAX); count * count];
    let is_diagonal = |i: usize, j: usize| j > i + 1 && !(i == 0 && j == count - 1) && common.get(i, j);
    let reach: Vec<Vec<usize>> = (0..count)
        .map(|i| (i + 2..count).filter(|&j| is_diagonal(i, j)).collect())
        .collect();
    for span in 2..count {
        for i in 0..count - span {
            let j = i + span;
            let mut champion = (
                most[(i + 1) * count + j].0 + usize::from(is_diagonal(i + 1, j)),
                usize::MAX,
            );
            for &k in reach[i].iter().take_while(|&&k| k < j) {
                let rest = most[k * count + j].0 + usize::from(is_diagonal(k, j));
                let value = 1 + most[i * count + k].0 + rest;
                if value > champion.0 {
                    champion = (value, k);
                }
            }
            most[i * count + j] = champion;
        }
    }
    let mut chosen = Vec::new();
    let mut stack = if count > 3 { vec![(0, count - 1)] } else { Vec::new() };
    while let Some((i, j)) = stack.pop() {
        if j - i < 2 {
            continue;
        }
        let k = most[i * count + j].1;
        let mut take = |a: usize, b: usize| {
            if is_diagonal(a, b) {
                chosen.push((a, b));
            }
            stack.push((a, b));
        };
        if k == usize::MAX {
            take(i + 1, j);
        } else {
            take(i, k);
            take(k, j);
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
        assert_eq!(largest_partition(6, &everything).len(), 3);
    }

    #[test]
    fn faces_of_two_chords() {
        let mut found = faces(7, &[(0, 2), (2, 6)]);
        found.sort();
        assert_eq!(found, vec![vec![0, 1, 2], vec![0, 2, 6], vec![2, 3, 4, 5, 6]]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn the_largest_partition_of_one_polygon_is_a_triangulation(
            radii in prop::collection::vec(0.1..1.0f64, 4..20)
        ) {
            let count = radii.len();
            let pairs = sight_of(star(&radii)).visible_pairs();
            let diagonals = largest_partition(count, &pairs);
            prop_assert_eq!(diagonals.len(), count - 3);
            prop_assert!(faces(count, &diagonals).iter().all(|face| face.len() == 3));
            prop_assert!(best_triangulation(count, &pairs, |_| 1.0).is_some());
        }
    }
}
