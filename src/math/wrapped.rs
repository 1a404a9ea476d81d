//! Parameters of closed curves.

/// `t` without its whole turns: in `[0, 1)`, or 1 where a tiny negative number is rounded to it.
///
/// Nearly all of them have none, and the remainder of a division takes twenty times as long as asking.
#[must_use]
pub(crate) fn wrapped(t: f64) -> f64 {
    if (0.0..1.0).contains(&t) { t } else { t.rem_euclid(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_turns_are_left_out() {
        for (t, rest) in [
            (-2.0, 0.0),
            (-0.75, 0.25),
            (0.0, 0.0),
            (0.5, 0.5),
            (1.0, 0.0),
            (7.25, 0.25),
            (1e300, 0.0),
        ] {
            assert_eq!(wrapped(t), rest);
        }
        assert_eq!(wrapped(-1e-20), 1.0);
        assert!(wrapped(f64::INFINITY).is_nan() && wrapped(f64::NAN).is_nan());
    }
}
