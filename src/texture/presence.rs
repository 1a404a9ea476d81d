//! Weights for what only some poses have: a layer, an element of a drawing.

/// The weights of the poses `present`, by index into `weights`, made to sum to 1: what is missing from the sum goes to those that
/// count already, in the same proportions.
///
/// `u_i = w_i + (1 - s) w_i⁺ / Σ w⁺` over the poses present, where `s = Σ w` over them and `w⁺` is `w` where that is positive,
/// else 0. So where all other weights are 0 nothing changes, a pose's own place gives that pose alone, and no division by a sum
/// that passes through 0 makes weights grow without bound. Where none of them is positive, what is missing is shared evenly.
///
/// ```
/// let weights = [0.5, 0.25, 0.25];
/// assert_eq!(inbetween::texture::weights_among(&weights, &[0, 1]), [2.0 / 3.0, 1.0 / 3.0]);
/// assert_eq!(inbetween::texture::weights_among(&weights, &[0, 1, 2]), weights);
/// ```
///
/// Poses that do not exist are left out.
#[must_use]
pub fn weights_among(weights: &[f64], present: &[usize]) -> Vec<f64> {
    let own: Vec<f64> = present.iter().filter_map(|&pose| weights.get(pose).copied()).collect();
    if own.len() == weights.len() {
        return own;
    }
    let missing = 1.0 - own.iter().sum::<f64>();
    let positive: f64 = own.iter().map(|w| w.max(0.0)).sum();
    let share = |w: f64| {
        if positive > 0.0 {
            w.max(0.0) / positive
        } else {
            1.0 / own.len() as f64
        }
    };
    own.iter().map(|&w| w + missing * share(w)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_absent_hands_its_weight_on() {
        assert_eq!(weights_among(&[0.0, 1.0, 0.0], &[1, 2]), [1.0, 0.0]);
        // At the place of a pose that is absent, the present ones are even.
        assert_eq!(weights_among(&[1.0, 0.0, 0.0], &[1, 2]), [0.5, 0.5]);
        assert_eq!(weights_among(&[0.2, 1.2, -0.4], &[1, 2]), [1.2 + 0.2, -0.4]);
    }

    proptest! {
        #[test]
        fn they_sum_to_one_and_stay_bounded(free in prop::collection::vec(-2.0..2.0f64, 4)) {
            let mut weights = free.clone();
            weights.push(1.0 - free.iter().sum::<f64>());
            let some = weights_among(&weights, &[0, 2, 3]);
            prop_assert!((some.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let most = weights.iter().fold(1.0, |most: f64, w| most.max(w.abs()));
            prop_assert!(some.iter().all(|w| w.abs() <= 4.0 * most + 1.0), "{some:?}");
        }
    }
}
