//! By how many whole turns each pose is turned as a whole.
//!
//! The mesh fixes each pose's angles up to whole turns for all triangles together. What is left is a choice between
//! turning to the left and to the right, made on the mean angles:
//! - against a reference pose, the mean nearest to zero (the paper's rule);
//! - without one, the means are points of a circle, and the circle is cut at the largest gap. The rule uses neither
//!   the order of the poses nor a zero direction. Between equally large gaps it takes the one followed by the larger
//!   gaps; only if the whole circle looks the same from both cuts does the first pose decide. Either case is reported,
//!   for then the artist had better say so with `turns`.

use std::cmp::Ordering;
use std::f64::consts::TAU;

/// Two gaps count as equally large within this angle. Means carry rounding errors of about 1e-13 radians, and a choice
/// that hangs on a difference of a micro-radian is no choice an artist would understand.
const GAP_TOLERANCE_RAD: f64 = 1e-6;

/// Whole turns to add to each pose.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Branch {
    /// Turns by pose.
    pub turns: Vec<f64>,
    /// Whether another choice was equally good.
    pub ambiguous: bool,
}

/// The branch on which every mean angle is nearest to zero.
#[must_use]
pub(super) fn nearest_zero(means_rad: &[f64]) -> Branch {
    let turns: Vec<f64> = means_rad.iter().map(|mean| -(mean / TAU).round_ties_even()).collect();
    let half_turn =
        |(mean, turns): (&f64, &f64)| ((mean + TAU * turns).abs() - std::f64::consts::PI).abs() < GAP_TOLERANCE_RAD;
    Branch {
        ambiguous: means_rad.iter().zip(&turns).any(half_turn),
        turns,
    }
}

/// The branch on which the mean angles span the least: the circle cut at its largest gap.
#[must_use]
pub(super) fn largest_gap(means_rad: &[f64]) -> Branch {
    let count = means_rad.len();
    let place_rad: Vec<f64> = means_rad.iter().map(|mean| mean.rem_euclid(TAU)).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| place_rad[a].total_cmp(&place_rad[b]).then(a.cmp(&b)));
    let gap_rad = |k: usize| {
        let (here, next) = (order[k % count], order[(k + 1) % count]);
        let whole = if (k + 1).is_multiple_of(count) { TAU } else { 0.0 };
        place_rad[next] - place_rad[here] + whole
    };
    // Cuts are compared by the gaps that follow, and last by whether the first pose comes right after the cut.
    let compare = |a: usize, b: usize| {
        (0..count)
            .map(|step| compare_gaps(gap_rad(a + step), gap_rad(b + step)))
            .find(|ordering| ordering.is_ne())
            .unwrap_or_else(|| order[(b + 1) % count].cmp(&order[(a + 1) % count]))
    };
    let cut = (0..count).max_by(|&a, &b| compare(a, b)).unwrap_or(0);
    let ambiguous = (0..count).any(|k| k != cut && compare_gaps(gap_rad(k), gap_rad(cut)).is_eq());
    let mut turns = vec![0.0; count];
    for (k, &pose) in order.iter().enumerate() {
        let lifted_rad = place_rad[pose] + if k <= cut { TAU } else { 0.0 };
        turns[pose] = ((lifted_rad - means_rad[pose]) / TAU).round();
    }
    Branch { turns, ambiguous }
}

fn compare_gaps(a: f64, b: f64) -> Ordering {
    if (a - b).abs() <= GAP_TOLERANCE_RAD {
        Ordering::Equal
    } else {
        a.total_cmp(&b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lifted_degrees(degrees: &[f64]) -> (Vec<f64>, bool) {
        let means: Vec<f64> = degrees.iter().map(|d| d.to_radians()).collect();
        let branch = largest_gap(&means);
        let lifted: Vec<f64> = means.iter().zip(&branch.turns).map(|(m, t)| m + TAU * t).collect();
        (
            lifted.iter().map(|l| (l - lifted[0]).to_degrees().round()).collect(),
            branch.ambiguous,
        )
    }

    #[test]
    fn angles_on_both_sides_of_the_half_turn_stay_together() {
        assert_eq!(lifted_degrees(&[170.0, -170.0, 150.0]), (vec![0.0, 20.0, -20.0], false));
        assert_eq!(
            lifted_degrees(&[0.0, 70.0, -50.0, 385.0]),
            (vec![0.0, 70.0, -50.0, 25.0], false)
        );
        assert_eq!(lifted_degrees(&[0.0]), (vec![0.0], false));
        assert!(largest_gap(&[]).turns.is_empty());
    }

    #[test]
    fn equal_gaps_are_reported_and_settled_by_what_follows() {
        let (lifted, ambiguous) = lifted_degrees(&[0.0, 216.0, 144.0]);
        let (swapped, _) = lifted_degrees(&[0.0, 144.0, 216.0]);
        assert!(ambiguous);
        assert_eq!((lifted[1], lifted[2]), (swapped[2], swapped[1]));
        assert_eq!(lifted_degrees(&[0.0, 180.0]), (vec![0.0, 180.0], true));
    }

    #[test]
    fn nearest_zero_follows_the_mean() {
        assert_eq!(nearest_zero(&[7.0, -0.5, -13.0]).turns, [-1.0, 0.0, 2.0]);
        assert!(nearest_zero(&[std::f64::consts::PI]).ambiguous);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn turning_all_poses_changes_no_difference(
            means in proptest::collection::vec(-9.0..9.0f64, 2..6),
            by in -9.0..9.0f64,
        ) {
            let branch = largest_gap(&means);
            prop_assume!(!branch.ambiguous);
            let lifted: Vec<f64> = means.iter().zip(&branch.turns).map(|(m, t)| m + TAU * t).collect();
            let turned: Vec<f64> = means.iter().map(|m| m + by).collect();
            let again = largest_gap(&turned);
            for (k, (m, t)) in turned.iter().zip(&again.turns).enumerate() {
                let difference = m + TAU * t - (turned[0] + TAU * again.turns[0]);
                prop_assert!((difference - (lifted[k] - lifted[0])).abs() < 1e-9);
            }
        }
    }
}
