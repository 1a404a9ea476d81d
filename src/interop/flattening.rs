//! Curves as chains of chords.
//!
//! A cubic curve is divided into equal steps of its parameter. How many are needed follows from its second differences (Wang 1984;
//! Sederberg, "Computer aided geometric design", 10.6): with `n` steps no chord is further from the curve than
//! `(6/8) max |second difference| / n²`.

use crate::input::Subpath;
use crate::math::Point;

/// The most steps of a curve: what needs more is finer than any screen.
const MOST_STEPS: f64 = 4096.0;

impl Subpath {
    /// How many equal steps each curve needs so that no chord is further from it than `tolerance`, in the unit of the points: at
    /// least 1, at most 4096.
    #[must_use]
    pub fn steps(&self, tolerance: f64) -> Vec<usize> {
        let mut from = self.start;
        let mut steps = Vec::with_capacity(self.cubics.len());
        for [a, b, to] in &self.cubics {
            let bend = (from - a * 2.0 + b).norm().max((a - b * 2.0 + to).norm());
            let needed = (0.75 * bend / tolerance).sqrt().ceil();
            // Written so that NaN counts as 1.
            steps.push(needed.clamp(1.0, MOST_STEPS).max(1.0) as usize);
            from = *to;
        }
        steps
    }

    /// The chain of chords with so many steps of each curve: its points from start to end.
    #[must_use]
    pub fn polyline(&self, steps: &[usize]) -> Vec<Point> {
        let mut points = vec![self.start];
        let mut from = self.start;
        for ([a, b, to], &count) in self.cubics.iter().zip(steps) {
            points.extend((1..count).map(|k| {
                let t = k as f64 / count as f64;
                let s = 1.0 - t;
                from * (s * s * s) + a * (3.0 * s * s * t) + b * (3.0 * s * t * t) + to * (t * t * t)
            }));
            points.push(*to);
            from = *to;
        }
        points
    }
}
