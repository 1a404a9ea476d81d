//! Sharpened weights for colours.
//!
//! Source: NWM 4.2, "texture blending". Colours look washed out or dark under extrapolation, and a slow cross-fade of
//! drawings with strong edges looks poor, so the limited weights `w'` are sharpened by `sigma` in [0, 1]:
//! `w*_i = sigma phi(t_i, sigma/2, 1 - sigma/2) + (1 - sigma) w'_i`, then scaled to sum 1.
//!
//! Difference from the paper: it takes `t_i = w'_i`, which fails for three and more poses: at `sigma` = 1 all `w*` can
//! be 0, and wherever every `w'` is below `sigma / 2` nothing is sharpened. Here `t_i = w'_i / (w'_i + max of the other
//! w')`, equal to the paper's for two poses (where `w'` sum to 1) and defined for every number of poses and every
//! `sigma`: the strongest pose always has `t >= 1/2`.
//!
//! Poses that show the same drawing, a drawn pose and its deformed copies, are one texture: their limited weights are
//! added first and the sums are sharpened. Otherwise a drawing would fade the more the more copies share its weight,
//! and two drawings would be seen in one another where one of them, split over copies, is nearly all there is.

use crate::math::{limit_weights, smooth_step};

/// Why there are no texture weights.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// The sharpness is outside [0, 1] or NaN.
    #[error("the texture sharpness is {0}, but must lie between 0 and 1")]
    BadSharpness(f64),
    /// A weight is NaN or infinite, or no weight is positive.
    #[error("weights {0:?} have no texture weights: they must be finite and sum to 1")]
    BadWeights(Vec<f64>),
}

/// The texture weights `w''` of some blend weights: in [0, 1], with sum 1, and equal to `weights` at every pose.
/// `sharpness` 0 fades linearly between two poses (in the limited weights), 1 switches.
///
/// ```
/// # fn main() -> Result<(), inbetween::texture::TextureError> {
/// let weights = inbetween::texture::texture_weights(&[0.6, 0.4], 1.0)?;
/// assert_eq!(weights, [1.0, 0.0]);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`TextureError`] for weights that are not finite or of which none is positive, or a sharpness outside [0, 1].
pub fn texture_weights(weights: &[f64], sharpness: f64) -> Result<Vec<f64>, TextureError> {
    let each_its_own: Vec<usize> = (0..weights.len()).collect();
    shared_texture_weights(weights, &each_its_own, sharpness)
}

/// As [`texture_weights`], for poses of which some show the same drawing: `drawing_of` says which, one number a pose. The
/// drawings' weights are sharpened; each pose's is its part of its drawing's, in proportion to its limited weight. A pose without
/// a number shows what no other does.
///
/// # Errors
/// As [`texture_weights`].
pub fn shared_texture_weights(weights: &[f64], drawing_of: &[usize], sharpness: f64) -> Result<Vec<f64>, TextureError> {
    if !(0.0..=1.0).contains(&sharpness) {
        return Err(TextureError::BadSharpness(sharpness));
    }
    let usable = weights.iter().all(|weight| weight.is_finite()) && weights.iter().any(|&weight| weight > 0.0);
    if !usable {
        return Err(TextureError::BadWeights(weights.to_vec()));
    }
    let mut limited = Vec::new();
    limit_weights(weights, &mut limited);
    // A positive weight can be so small that its square, and so its step, underflows.
    if limited.iter().all(|&weight| weight == 0.0) {
        return Err(TextureError::BadWeights(weights.to_vec()));
    }
    let shows_same = |pose: usize, other: usize| match (drawing_of.get(pose), drawing_of.get(other)) {
        (Some(drawing), Some(others)) => drawing == others,
        _ => pose == other,
    };
    // Of each pose's drawing.
    let drawn: Vec<f64> = (0..limited.len())
        .map(|pose| {
            let same = limited.iter().enumerate().filter(|(other, _)| shows_same(pose, *other));
            same.map(|(_, weight)| weight).sum()
        })
        .collect();
    let sharpened: Vec<f64> = (0..limited.len())
        .map(|pose| {
            let own = drawn[pose];
            let others = drawn.iter().enumerate().filter(|(other, _)| !shows_same(pose, *other));
            let strongest_other = others.map(|(_, &other)| other).fold(0.0, f64::max);
            let share = if own > 0.0 { own / (own + strongest_other) } else { 0.0 };
            let part = if own > 0.0 { limited[pose] / own } else { 0.0 };
            part * (sharpness * smooth_step(share, 0.5 * sharpness, 1.0 - 0.5 * sharpness) + (1.0 - sharpness) * own)
        })
        .collect();
    let sum: f64 = sharpened.iter().sum();
    Ok(sharpened.iter().map(|weight| weight / sum).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn agrees_with_the_independent_implementation() {
        // Numbers from a separate implementation of the formula.
        for (sharpness, expected) in GOLDEN {
            let found = texture_weights(&[0.5, 0.3, 0.35, -0.15], sharpness).expect("weights");
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-12, "{sharpness}: {found:?}");
            }
        }
    }

    #[test]
    fn three_equal_weights_stay_equal_at_every_sharpness() {
        for sharpness in [0.0, 0.5, 0.9, 1.0] {
            let third = 1.0 / 3.0;
            for weight in texture_weights(&[third; 3], sharpness).expect("weights") {
                assert!((weight - third).abs() < 1e-15);
            }
        }
        assert_eq!(texture_weights(&[1.0], 1.0), Ok(vec![1.0]));
    }

    #[test]
    fn a_drawing_counts_alike_however_many_poses_show_it() {
        for sharpness in [0.0, 0.5, 0.9, 1.0] {
            let [first, second] = texture_weights(&[0.6, 0.4], sharpness).expect("weights")[..] else {
                panic!("two weights")
            };
            // The limited weights of three equal parts differ from that of their sum: compare with what adds up alike.
            let shared = shared_texture_weights(&[0.3, 0.4, 0.3], &[7, 1, 7], sharpness).expect("weights");
            assert!((shared.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            assert!((shared[0] - shared[2]).abs() < 1e-12);
            // Split over poses it is no weaker than the other drawing; each for itself it would be.
            assert!(shared[0] + shared[2] >= 0.5 && (first - second) * (shared[0] + shared[2] - shared[1]) >= 0.0);
        }
        let own = texture_weights(&[0.3, 0.4, 0.3], 1.0).expect("weights");
        assert!(own[1] > own[0] + own[2], "{own:?}");
        // A pose is its drawing, and no number is a drawing of its own.
        assert_eq!(
            shared_texture_weights(&[1.0, 0.0, 0.0], &[0, 0, 1], 0.8),
            Ok(vec![1.0, 0.0, 0.0])
        );
        assert_eq!(
            shared_texture_weights(&[0.5, 0.3, 0.2], &[], 0.8),
            texture_weights(&[0.5, 0.3, 0.2], 0.8)
        );
    }

    #[test]
    fn bad_input_is_refused() {
        assert_eq!(texture_weights(&[1.0], 1.5), Err(TextureError::BadSharpness(1.5)));
        assert!(matches!(
            texture_weights(&[1.0], f64::NAN),
            Err(TextureError::BadSharpness(_))
        ));
        assert!(matches!(
            texture_weights(&[f64::NAN, 1.0], 0.5),
            Err(TextureError::BadWeights(_))
        ));
        assert!(matches!(
            texture_weights(&[-1.0, 0.0], 0.5),
            Err(TextureError::BadWeights(_))
        ));
        assert!(matches!(
            texture_weights(&[1e-300, 0.0], 0.5),
            Err(TextureError::BadWeights(_))
        ));
        assert!(texture_weights(&[], 0.5).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn they_are_shares_and_equal_the_paper_for_two(
            parts in proptest::collection::vec(-0.5..1.0f64, 1..6),
            sharpness in 0.0..0.999f64,
        ) {
            let weights: Vec<f64> = std::iter::once(1.0 - parts.iter().sum::<f64>()).chain(parts).collect();
            let found = texture_weights(&weights, sharpness).expect("weights that sum to 1");
            prop_assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            prop_assert!(found.iter().all(|weight| (0.0..=1.0).contains(weight)));
            if let [first, second] = found[..] {
                let mut limited = Vec::new();
                limit_weights(&weights, &mut limited);
                let paper = |w: f64| {
                    sharpness * smooth_step(w, 0.5 * sharpness, 1.0 - 0.5 * sharpness) + (1.0 - sharpness) * w
                };
                let sum = paper(limited[0]) + paper(limited[1]);
                prop_assert!((first - paper(limited[0]) / sum).abs() < 1e-12);
                prop_assert!((second - paper(limited[1]) / sum).abs() < 1e-12);
            }
        }
    }

    const GOLDEN: [(f64, [f64; 4]); 4] = [
        (0.0, [0.5011275369581559, 0.21648709596592333, 0.28238536707592077, 0.0]),
        (0.5, [0.6780739240786979, 0.121351639818171, 0.20057443610313105, 0.0]),
        (0.9, [0.9501127536958156, 0.02164870959659233, 0.02823853670759207, 0.0]),
        (1.0, [1.0, 0.0, 0.0, 0.0]),
    ];
}
