//! Spacing charts: how far along its way a path is at even steps of time.
//!
//! An animator marks on a chart beside a key where the drawings before it lie. The marks are met at even steps of time between the two
//! keys; between the steps the way goes on along a monotone cubic, so that any rate of frames can be drawn from one chart:
//! a cubic Hermite piece from mark to mark whose slopes are harmonic means of the slopes of the straight lines to both
//! sides (Fritsch and Butland, "A Method for Constructing Local Monotone Piecewise Cubic Interpolants", 1984), and at the ends
//! those of the parabola through three marks, limited in the same way. It never turns back, never leaves two marks' range, and is even for an even chart.

/// By how many times the slope of a line the slope of a monotone cubic over it may be, at either end.
const STEEPEST: f64 = 3.0;

/// The way between two keys over the time between them, both from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SpacingChart {
    /// 0, the marks, 1: at least two.
    marks: Vec<f64>,
    /// The slope at each mark, in way a step.
    slopes: Vec<f64>,
}

impl SpacingChart {
    /// The chart with these marks between 0 and 1, which are within that range and do not decrease.
    pub(super) fn new(spacing: &[f64]) -> Self {
        let mut marks = vec![0.0];
        marks.extend_from_slice(spacing);
        marks.push(1.0);
        let lines: Vec<f64> = marks.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut slopes = vec![end_slope(&lines)];
        slopes.extend(lines.windows(2).map(|pair| between(pair[0], pair[1])));
        let backwards: Vec<f64> = lines.iter().rev().copied().collect();
        slopes.push(end_slope(&backwards));
        Self { marks, slopes }
    }

    /// The way at `time`, both from 0 to 1.
    pub(super) fn way(&self, time: f64) -> f64 {
        let steps = self.marks.len() - 1;
        let at = (time * steps as f64).clamp(0.0, steps as f64);
        let step = (at as usize).min(steps - 1);
        let u = at - step as f64;
        let (from, to) = (self.marks[step], self.marks[step + 1]);
        let to_value = u * u * (3.0 - 2.0 * u);
        let way = from
            + to_value * (to - from)
            + u * (1.0 - u) * (1.0 - u) * self.slopes[step]
            + u * u * (u - 1.0) * self.slopes[step + 1];
        // Rounding alone could leave it.
        way.clamp(from, to)
    }
}

/// The slope between two lines over steps of the same length: their harmonic mean, 0 where either rests.
fn between(before: f64, after: f64) -> f64 {
    if before > 0.0 && after > 0.0 {
        2.0 * before * after / (before + after)
    } else {
        0.0
    }
}

/// The slope where the first of these lines begins.
fn end_slope(lines: &[f64]) -> f64 {
    match lines {
        [first, second, ..] => ((3.0 * first - second) / 2.0).clamp(0.0, STEEPEST * first),
        [only] => *only,
        [] => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_even_chart_is_even_time() {
        for spacing in [vec![], vec![0.5], vec![0.25, 0.5, 0.75]] {
            let chart = SpacingChart::new(&spacing);
            for k in 0..=40 {
                let time = f64::from(k) / 40.0;
                assert!((chart.way(time) - time).abs() < 1e-15, "{spacing:?} at {time}");
            }
        }
    }

    #[test]
    fn equal_marks_rest() {
        let chart = SpacingChart::new(&[0.0, 0.5, 0.5, 1.0]);
        for (from, to, way) in [(0.0, 0.2, 0.0), (0.4, 0.6, 0.5), (0.8, 1.0, 1.0)] {
            for k in 0..=10 {
                assert_eq!(chart.way(from + (to - from) * f64::from(k) / 10.0), way);
            }
        }
    }

    proptest! {
        #[test]
        fn it_meets_its_marks_and_never_turns_back(mut spacing in prop::collection::vec(0.0..=1.0f64, 0..8)) {
            spacing.sort_by(f64::total_cmp);
            let chart = SpacingChart::new(&spacing);
            let steps = spacing.len() + 1;
            for (k, mark) in spacing.iter().enumerate() {
                prop_assert!((chart.way((k + 1) as f64 / steps as f64) - mark).abs() < 1e-12);
            }
            prop_assert_eq!((chart.way(0.0), chart.way(1.0)), (0.0, 1.0));
            let mut before = 0.0;
            for k in 0..=500 {
                let way = chart.way(f64::from(k) / 500.0);
                prop_assert!(way >= before - 1e-15, "{} after {before} at {k}", way);
                before = way;
            }
        }
    }
}
