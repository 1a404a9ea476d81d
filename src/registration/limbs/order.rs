//! Which part lies in front of which.
//!
//! Parts where they are in a pose -> by part, its rank from back to front.
//!
//! 1. Where two parts lie on the same cells, the one whose drawing is seen differs less: the sum of what the other differs more is the evidence.
//! 2. What an artist says of two parts outweighs everything that is seen.
//! 3. The order that contradicts the least evidence: parts are moved to where they contradict less until none is better elsewhere. Where nothing
//!    overlaps, parts stay in the order of their numbers.

use super::comparison::{BARE, Layer};

/// A difference between two differences counts for no more than this, in steps: one stray line is no evidence.
const MOST_EVIDENCE: i32 = 50;
/// What an artist says is worth this much: more than all cells of a picture.
const SAID: i64 = 1 << 40;
/// Moves of all parts at most.
const ROUNDS: usize = 20;

/// By part, its rank, the nearest the largest. Of each pair of `in_front` the first is said to lie in front of the second.
pub(super) fn ranks(layers: &[Layer], in_front: &[[usize; 2]]) -> Vec<usize> {
    let mut evidence = evidence(layers);
    let count = layers.len();
    for &[front, back] in in_front {
        evidence[front * count + back] += SAID;
        evidence[back * count + front] -= SAID;
    }
    let mut order: Vec<usize> = (0..count).collect();
    for _ in 0..ROUNDS {
        let mut has_moved = false;
        for part in 0..count {
            let at = order.iter().position(|other| *other == part).unwrap_or(0);
            order.remove(at);
            // What it gains by being in front of the first k of the others, less what it loses.
            let mut gain = 0;
            let gains: Vec<i64> = std::iter::once(0)
                .chain(order.iter().map(|other| {
                    gain += 2 * evidence[part * count + other];
                    gain
                }))
                .collect();
            let (mut best, mut best_gain) = (at, gains[at]);
            for (k, gain) in gains.iter().enumerate() {
                if *gain > best_gain {
                    (best, best_gain) = (k, *gain);
                }
            }
            order.insert(best, part);
            has_moved |= best != at;
        }
        if !has_moved {
            break;
        }
    }
    let mut ranks = vec![0; count];
    for (rank, part) in order.into_iter().enumerate() {
        ranks[part] = rank;
    }
    ranks
}

/// #parts x #parts: how much speaks for the first in front of the second, in steps and cells.
fn evidence(layers: &[Layer]) -> Vec<i64> {
    let count = layers.len();
    let mut evidence = vec![0; count * count];
    for a in 0..count {
        for b in 0..a {
            let both = layers[a].iter().zip(&layers[b]);
            let both = both.filter(|(a, b)| **a != BARE && **b != BARE);
            let sum: i64 = both
                .map(|(a, b)| i64::from((i32::from(*b) - i32::from(*a)).clamp(-MOST_EVIDENCE, MOST_EVIDENCE)))
                .sum();
            evidence[a * count + b] = sum;
            evidence[b * count + a] = -sum;
        }
    }
    evidence
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_less_lies_in_front() {
        let wide = vec![30, 30, 30, 30, 2];
        let left = vec![5, 5, BARE, BARE, BARE];
        let right = vec![BARE, 40, 4, 4, BARE];
        let layers = [left, wide.clone(), right];
        let as_seen = ranks(&layers, &[]);
        assert!(as_seen[0] > as_seen[2] && as_seen[2] > as_seen[1], "{as_seen:?}");
        let as_said = ranks(&layers, &[[1, 0], [1, 2]]);
        assert!(as_said[1] > as_said[0] && as_said[0] > as_said[2], "{as_said:?}");
        assert_eq!(ranks(&[wide.clone(), wide], &[]), [0, 1]);
    }
}
