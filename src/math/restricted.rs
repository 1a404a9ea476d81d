//! Weights over those of several poses that have something.

/// The weights over the poses that are `present`: each keeps its weight, and what the others have is shared out in proportion to
/// the positive weights of those present. `w_i + (1 - s) max(w_i, 0) / p`, where `s` is the sum and `p` the sum of the
/// positive ones over the poses present; 0 for the others.
///
/// They sum to 1 if the weights do, and are `weights` where all poses are present. At a pose that is present they are 1 for it and
/// 0 for the others. Where no pose that is present has a positive weight, nothing of it is seen; they are then shared evenly.
#[must_use]
pub fn restricted_weights(weights: &[f64], present: &[bool]) -> Vec<f64> {
    let of_present = || weights.iter().zip(present).filter(|(_, present)| **present);
    let missing = 1.0 - of_present().map(|(weight, _)| weight).sum::<f64>();
    let positive: f64 = of_present().map(|(weight, _)| weight.max(0.0)).sum();
    let count = of_present().count();
    weights
        .iter()
        .zip(present)
        .map(|(&weight, &present)| match present {
            false => 0.0,
            // Then nothing is missing, but for rounding.
            true if count == weights.len() => weight,
            true if positive > 0.0 => weight + missing * weight.max(0.0) / positive,
            true => 1.0 / count as f64,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_missing_is_shared_out() {
        assert_eq!(
            restricted_weights(&[0.5, 0.25, 0.25], &[true, true, false]),
            [0.5 + 0.25 * 0.5 / 0.75, 0.25 + 0.25 * 0.25 / 0.75, 0.0]
        );
        assert_eq!(
            restricted_weights(&[0.0, 1.0, 0.0], &[true, true, false]),
            [0.0, 1.0, 0.0]
        );
        assert_eq!(
            restricted_weights(&[0.0, 0.0, 1.0], &[true, true, false]),
            [0.5, 0.5, 0.0]
        );
        assert_eq!(restricted_weights(&[1.5, -0.5], &[true, true]), [1.5, -0.5]);
        assert_eq!(restricted_weights(&[1.0], &[false]), [0.0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn they_sum_to_one(
            parts in proptest::collection::vec((-0.5..1.0f64, any::<bool>()), 1..6),
            first_is_present in any::<bool>(),
        ) {
            let rest: f64 = parts.iter().map(|(weight, _)| weight).sum();
            let weights: Vec<f64> = std::iter::once(1.0 - rest).chain(parts.iter().map(|p| p.0)).collect();
            let present: Vec<bool> = std::iter::once(first_is_present).chain(parts.iter().map(|p| p.1)).collect();
            let found = restricted_weights(&weights, &present);
            let expected = if present.contains(&true) { 1.0 } else { 0.0 };
            prop_assert!((found.iter().sum::<f64>() - expected).abs() < 1e-9);
            prop_assert!(found.iter().zip(&present).all(|(weight, present)| *present || *weight == 0.0));
        }
    }
}
