//! Increasing maps of the circle to itself, as lists of corresponding parameters.

/// Corresponding parameters on two closed curves: both lists increase strictly, neither is wrapped, and each ends one
/// whole turn after it begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CyclicMap {
    /// Parameters on the first curve.
    from: Vec<f64>,
    /// Parameters on the second curve.
    to: Vec<f64>,
}

impl CyclicMap {
    /// The map through `(from[k], to[k])`, closed by the first pair one turn later.
    pub(super) fn through(mut from: Vec<f64>, mut to: Vec<f64>) -> Self {
        if let (Some(a), Some(b)) = (from.first().copied(), to.first().copied()) {
            from.push(a + 1.0);
            to.push(b + 1.0);
        }
        Self { from, to }
    }

    /// The parameter on the second curve for `t` on the first, linear between the pairs; whole turns are kept, so that
    /// the result increases with `t`.
    pub(super) fn at(&self, t: f64) -> f64 {
        let turns = (t - self.from[0]).floor();
        let t = t - turns;
        let k = self.from.partition_point(|x| *x <= t).clamp(1, self.from.len() - 1);
        let along = (t - self.from[k - 1]) / (self.from[k] - self.from[k - 1]);
        turns + self.to[k - 1] + along * (self.to[k] - self.to[k - 1])
    }
}

/// Moves `values` as little as needed (in least squares) so that each lies at least `steps[k]` after its predecessor,
/// `values[0]` and the closing value `values[0] + 1` staying where they are, and so do the entries of `pinned`.
///
/// Pool adjacent violators (Ayer et al. 1955), on each stretch between pinned entries. `pinned` is increasing, starts
/// with 0, and its values leave room for the steps.
pub(super) fn make_increasing(values: &mut [f64], pinned: &[usize], least_step: f64) {
    let count = values.len();
    for (index, &start) in pinned.iter().enumerate() {
        let (end, end_value) = match pinned.get(index + 1) {
            Some(&next) => (next, values[next]),
            None => (count, values[0] + 1.0),
        };
        let start_value = values[start];
        let inner = end - start;
        let step = least_step.min(0.5 * (end_value - start_value) / inner as f64);
        let level = |k: usize| step * k as f64;
        let mut pools: Vec<(f64, usize)> = Vec::new();
        for k in 1..inner {
            let mut pool = (values[start + k] - level(k), 1);
            while let Some(&(mean, size)) = pools.last()
                && mean > pool.0
            {
                let joined = size + pool.1;
                pool = ((mean * size as f64 + pool.0 * pool.1 as f64) / joined as f64, joined);
                pools.pop();
            }
            pools.push(pool);
        }
        let mut k = 1;
        for (mean, size) in pools {
            let mean = mean.clamp(start_value, end_value - level(inner));
            for _ in 0..size {
                values[start + k] = mean + level(k);
                k += 1;
            }
        }
    }
}

/// Spreads steps larger than `largest_step` over their neighbours, entries of `pinned` staying where they are. Stretches
/// between pinned entries whose mean step is above half of that get a larger limit.
pub(super) fn limit_steps(values: &mut [f64], pinned: &[usize], largest_step: f64) {
    const SWEEPS: usize = 200;
    let count = values.len();
    for (index, &start) in pinned.iter().enumerate() {
        let end = pinned.get(index + 1).copied().unwrap_or(count);
        let closing = if end == count { values[0] + 1.0 } else { values[end] };
        let inner = end - start;
        let limit = largest_step.max(2.0 * (closing - values[start]) / inner as f64);
        for _ in 0..SWEEPS {
            let mut changed = false;
            for k in 0..inner {
                let next = if k + 1 == inner { closing } else { values[start + k + 1] };
                let excess = next - values[start + k] - limit;
                if excess <= 1e-12 {
                    continue;
                }
                changed = true;
                // An end that is pinned leaves the whole move to the other.
                let (lift, drop) = match (k == 0, k + 1 == inner) {
                    (true, true) => (0.0, 0.0),
                    (true, false) => (0.0, excess),
                    (false, true) => (excess, 0.0),
                    (false, false) => (0.5 * excess, 0.5 * excess),
                };
                values[start + k] += lift;
                if k + 1 < inner {
                    values[start + k + 1] -= drop;
                }
            }
            if !changed {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_map_closes_and_counts_turns() {
        let map = CyclicMap::through(vec![0.2, 0.7], vec![0.5, 0.75]);
        assert!((map.at(0.45) - 0.625).abs() < 1e-15);
        assert!((map.at(0.95) - 1.125).abs() < 1e-15);
        assert!((map.at(1.45) - 1.625).abs() < 1e-15);
        assert!((map.at(-0.3) - -0.25).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn steps_end_up_within_their_limits(
            noise in proptest::collection::vec(-0.2..0.2f64, 40),
            pin in 1..39_usize,
        ) {
            let mut values: Vec<f64> = noise.iter().enumerate().map(|(k, d)| k as f64 / 40.0 + d * 0.5).collect();
            values[0] = 0.0;
            values[pin] = pin as f64 / 40.0;
            let pinned = [0, pin];
            make_increasing(&mut values, &pinned, 0.005);
            limit_steps(&mut values, &pinned, 0.2);
            prop_assert_eq!(values[0], 0.0);
            prop_assert_eq!(values[pin], pin as f64 / 40.0);
            values.push(1.0);
            for pair in values.windows(2) {
                prop_assert!(pair[1] - pair[0] > 0.004 && pair[1] - pair[0] < 0.21, "{pair:?}");
            }
        }
    }
}
