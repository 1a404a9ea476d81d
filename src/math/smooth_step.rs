//! The Hermite cubic step, and weights limited by it.

/// Rises from 0 at `from` to 1 at `to` along `3 t^2 - 2 t^3`, and is constant beyond. For `to <= from` it is a step:
/// 1/2 at `from` itself.
#[must_use]
pub fn smooth_step(value: f64, from: f64, to: f64) -> f64 {
    if to <= from {
        return if value < from {
            0.0
        } else if value > from {
            1.0
        } else {
            0.5
        };
    }
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The limited weights `w'` of NWM 4.2: each weight through the Hermite cubic, then scaled to sum 1. They lie in
/// `[0, 1]` for any weights that sum to 1, and equal them at every pose. `limited` is overwritten.
pub(crate) fn limit_weights(weights: &[f64], limited: &mut Vec<f64>) {
    limited.clear();
    limited.extend(weights.iter().map(|&weight| smooth_step(weight, 0.0, 1.0)));
    // Weights that sum to 1 have a positive one, and so a positive step.
    let sum: f64 = limited.iter().sum();
    if sum > 0.0 {
        for weight in limited {
            *weight /= sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_and_limit_by_hand() {
        assert_eq!(smooth_step(0.25, 0.0, 1.0), 0.15625);
        assert_eq!(smooth_step(0.5, 0.5, 0.5), 0.5);
        assert_eq!((smooth_step(-1.0, 0.0, 1.0), smooth_step(9.0, 0.0, 1.0)), (0.0, 1.0));
        let mut limited = Vec::new();
        limit_weights(&[1.6, -0.4, -0.2], &mut limited);
        assert_eq!(limited, [1.0, 0.0, 0.0]);
        limit_weights(&[0.5, 0.5], &mut limited);
        assert_eq!(limited, [0.5, 0.5]);
    }
}
