//! What is drawn over what.
//!
//! Each drawing states an order of the elements that it has. If they agree, one order serves every frame. Where they do not, the
//! drawing that is seen most (largest texture weight; of equal ones the first) decides; the others still say where elements go that it
//! does not have.
//!
//! An order is built from back to front: of the elements whose predecessors in every drawing are placed, the one first met
//! in the drawings; if there is none, the drawings contradict one another, and the next element of the deciding one is placed.
//!
//! Cost: O(all elements of all drawings) an order, times the number of elements that can be placed at once.

use std::collections::BTreeSet;

/// The order of `count` elements that drawing `deciding` leads to. `sequences[d]` holds the elements of drawing d, from back to
/// front, each at most once.
pub(super) fn merged(count: usize, sequences: &[Vec<usize>], deciding: usize) -> Vec<usize> {
    let mut waiting_for = vec![0_usize; count];
    let mut successors: Vec<Vec<usize>> = vec![Vec::new(); count];
    for sequence in sequences {
        for pair in sequence.windows(2) {
            successors[pair[0]].push(pair[1]);
            waiting_for[pair[1]] += 1;
        }
    }
    let mut ready: BTreeSet<usize> = (0..count).filter(|&element| waiting_for[element] == 0).collect();
    let mut is_placed = vec![false; count];
    let mut order = Vec::with_capacity(count);
    let mut deciders: Vec<usize> = vec![deciding];
    deciders.extend((0..sequences.len()).filter(|&other| other != deciding));
    let mut candidates: Vec<usize> = deciders
        .into_iter()
        .filter_map(|drawing| sequences.get(drawing))
        .flatten()
        .copied()
        .chain(0..count)
        .rev()
        .collect();
    while order.len() < count {
        let next = match ready.pop_first() {
            Some(element) => element,
            None => match candidates.pop() {
                Some(element) => element,
                None => break,
            },
        };
        if std::mem::replace(&mut is_placed[next], true) {
            continue;
        }
        order.push(next);
        for &successor in &successors[next] {
            waiting_for[successor] -= 1;
            if waiting_for[successor] == 0 && !is_placed[successor] {
                ready.insert(successor);
            }
        }
    }
    order
}

/// The drawing that is seen most; of equal ones the first.
pub(super) fn most_seen(weights: &[f64]) -> usize {
    (0..weights.len())
        .rev()
        .max_by(|&a, &b| weights[a].total_cmp(&weights[b]))
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_that_agree_share_one_order() {
        // 0 body, 1 arm, 2 hat, 3 scarf: the hat only in the first, the scarf only in the second.
        let sequences = [vec![0, 2, 1], vec![0, 3, 1]];
        assert_eq!(merged(4, &sequences, 0), [0, 2, 3, 1]);
        assert_eq!(merged(4, &sequences, 1), [0, 2, 3, 1]);
    }

    #[test]
    fn the_deciding_drawing_has_its_way_and_the_others_fill_in() {
        // The arm (1) is before the body (0) in one drawing and behind it in the other, which also has a hat (2) on top.
        let sequences = [vec![0, 1], vec![1, 0, 2]];
        assert_eq!(merged(3, &sequences, 0), [0, 1, 2]);
        assert_eq!(merged(3, &sequences, 1), [1, 0, 2]);
    }

    #[test]
    fn of_equal_drawings_the_first_is_seen_most() {
        assert_eq!(most_seen(&[0.2, 0.4, 0.4]), 1);
        assert_eq!(most_seen(&[0.5, 0.5]), 0);
        assert_eq!(most_seen(&[]), 0);
    }

    proptest::proptest! {
        #![proptest_config(proptest::prelude::ProptestConfig::with_cases(64))]
        #[test]
        fn every_element_once_and_the_deciding_sequence_kept(
            shuffles in proptest::collection::vec(proptest::sample::subsequence((0..8).collect::<Vec<usize>>(), 1..8), 1..4),
            turned in 0..4_usize,
            deciding in 0..4_usize,
        ) {
            let mut sequences = shuffles;
            let deciding = deciding % sequences.len();
            let turned = turned % sequences.len();
            sequences[turned].reverse();
            let order = merged(8, &sequences, deciding);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            proptest::prop_assert_eq!(sorted, (0..8).collect::<Vec<_>>());
            let kept: Vec<usize> = order.into_iter().filter(|element| sequences[deciding].contains(element)).collect();
            proptest::prop_assert_eq!(&kept, &sequences[deciding]);
        }
    }
}
