//! Where linearly interpolated formats need keys.
//!
//! Samples of a motion at increasing times -> the fewest of them between which straight lines stay near all others. A
//! rigid turn is an arc, so formats that interpolate linearly need keys along it; a drawing that is moved straight needs two.
//!
//! 1. From a key `i`, sample `j` can be the next key if for every sample `k` between them and every point, the distance
//!    between the sample and the straight line, both at time `t_k`, is within the tolerance. Divided by `t_k - t_i`: the mean
//!    velocity from `i` to `j` lies in a disc around that from `i` to `k`.
//! 2. Every point keeps a box around the intersection of its discs so far. A velocity outside its box rules `j` out, an empty
//!    box all later ones; only what passes is compared with every sample between.
//! 3. Breadth first from the first sample, so the last is reached through as few keys as there can be. A sample that has been
//!    reached is not tried again.
//!
//! The number of keys is the least there is, not only of those in reach of a greedy choice: the two differ, because a longer
//! line may fit where a shorter one does not.
//!
//! Cost: for n samples of p points O(n² p) at most, and n reached samples are compared with up to n others; as a rule lines
//! are far shorter than that. Memory: four numbers a point.

use crate::math::Point;

/// Differences below this fraction of the largest coordinate are rounding: a tolerance below it could not even be met by a
/// straight motion.
const ROUNDING: f64 = 1e-12;
/// By how much a velocity may miss its box, relative to the box, before it is ruled out without a closer look: more than the
/// rounding of velocities, which is 1e-16 of coordinates where the box is at least [`ROUNDING`] of them.
const BOX_SLACK: f64 = 1e-3;

/// Which samples are keys.
#[derive(Debug, Clone, PartialEq)]
pub struct Keys {
    /// Increasing; the first and the last sample are always among them.
    pub indices: Vec<usize>,
    /// The largest distance of any point, at any sample's time, from where interpolation between the keys puts it.
    pub worst: f64,
}

/// The fewest of the samples such that linear interpolation between successive ones is within `tolerance` of every sample.
///
/// `times` are strictly increasing; `samples` are #times x #points. A tolerance below the rounding of the coordinates
/// ([`Keys::worst`] says what was reached) means that rounding. What is not finite is never interpolated over.
///
/// ```
/// use inbetween::{export::place_keys, math::Point};
///
/// let times = [0.0, 1.0, 2.0, 3.0, 4.0];
/// let there_and_back = [0.0, 1.0, 2.0, 1.0, 0.0].map(|x| vec![Point::new(x, 0.0)]);
/// assert_eq!(place_keys(&times, &there_and_back, 0.1).indices, [0, 2, 4]);
/// ```
#[must_use]
pub fn place_keys(times: &[f64], samples: &[Vec<Point>], tolerance: f64) -> Keys {
    let motion = Motion::new(times, samples, tolerance);
    let indices = motion.fewest();
    let worst = indices
        .windows(2)
        .map(|key| motion.deviation(key[0], key[1]))
        .fold(0.0, f64::max);
    Keys { indices, worst }
}

struct Motion<'a> {
    times: &'a [f64],
    samples: &'a [Vec<Point>],
    tolerance: f64,
}

impl<'a> Motion<'a> {
    fn new(times: &'a [f64], samples: &'a [Vec<Point>], tolerance: f64) -> Self {
        let count = times.len().min(samples.len());
        let (times, samples) = (&times[..count], &samples[..count]);
        let size = samples
            .iter()
            .flatten()
            .map(|p| p.amax())
            .filter(|size| size.is_finite())
            .fold(0.0, f64::max);
        Self {
            times,
            samples,
            tolerance: tolerance.max(ROUNDING * size),
        }
    }

    fn fewest(&self) -> Vec<usize> {
        let count = self.times.len();
        let Some(last) = count.checked_sub(1) else {
            return Vec::new();
        };
        // The key before each sample that has been reached.
        let mut before: Vec<Option<usize>> = vec![None; count];
        let mut reached_now = vec![0];
        'search: while before[last].is_none() && last > 0 {
            let mut reached_next = Vec::new();
            for &from in &reached_now {
                // The last sample first: reached, it ends the search.
                for to in self.candidates(from, &before).into_iter().rev() {
                    if before[to].is_none() && self.fits(from, to) {
                        before[to] = Some(from);
                        reached_next.push(to);
                        if to == last {
                            break 'search;
                        }
                    }
                }
            }
            // Those that lie furthest reach most.
            reached_next.sort_unstable_by(|a, b| b.cmp(a));
            reached_now = reached_next;
        }
        let mut indices = vec![last];
        while let Some(key) = before[indices[indices.len() - 1]] {
            indices.push(key);
        }
        indices.reverse();
        indices
    }

    /// The samples not reached yet that may follow the key `from`: all that do, and a few that do not.
    fn candidates(&self, from: usize, before: &[Option<usize>]) -> Vec<usize> {
        let start = &self.samples[from];
        let mut boxes = vec![[f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY]; start.len()];
        let mut candidates = Vec::new();
        for (to, reached) in before.iter().enumerate().skip(from + 1) {
            let per_time = 1.0 / (self.times[to] - self.times[from]);
            let radius = self.tolerance * (1.0 + BOX_SLACK) * per_time;
            let (mut is_inside, mut is_empty) = (true, false);
            for ((bounds, a), b) in boxes.iter_mut().zip(start).zip(&self.samples[to]) {
                let velocity = (b - a) * per_time;
                let [low_x, low_y, high_x, high_y] = *bounds;
                is_inside &= velocity.x >= low_x && velocity.x <= high_x && velocity.y >= low_y && velocity.y <= high_y;
                *bounds = [
                    low_x.max(velocity.x - radius),
                    low_y.max(velocity.y - radius),
                    high_x.min(velocity.x + radius),
                    high_y.min(velocity.y + radius),
                ];
                is_empty |= bounds[0] > bounds[2] || bounds[1] > bounds[3];
            }
            if (is_inside || to == from + 1) && reached.is_none() {
                candidates.push(to);
            }
            if is_empty {
                break;
            }
        }
        candidates
    }

    /// Whether the straight line from key `from` to key `to` is near every sample between.
    fn fits(&self, from: usize, to: usize) -> bool {
        (from + 1..to).all(|between| {
            let part = self.part(from, between, to);
            let (start, end) = (&self.samples[from], &self.samples[to]);
            start
                .iter()
                .zip(end)
                .zip(&self.samples[between])
                .all(|((a, b), p)| distance(a, b, part, p) <= self.tolerance)
        })
    }

    fn deviation(&self, from: usize, to: usize) -> f64 {
        (from + 1..to)
            .flat_map(|between| {
                let part = self.part(from, between, to);
                let ends = self.samples[from].iter().zip(&self.samples[to]);
                ends.zip(&self.samples[between])
                    .map(move |((a, b), p)| distance(a, b, part, p))
            })
            .fold(0.0, f64::max)
    }

    fn part(&self, from: usize, between: usize, to: usize) -> f64 {
        (self.times[between] - self.times[from]) / (self.times[to] - self.times[from])
    }
}

fn distance(a: &Point, b: &Point, part: f64, p: &Point) -> f64 {
    (a + (b - a) * part - p).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn motion(points: usize) -> impl Strategy<Value = (Vec<f64>, Vec<Vec<Point>>)> {
        let step = (0.05..1.0, proptest::collection::vec((-2.0..2.0, -2.0..2.0), points));
        proptest::collection::vec(step, 1..14).prop_map(move |steps| {
            let mut time = 0.0;
            let mut places = vec![Point::zeros(); points];
            let mut samples = Vec::new();
            for (wait, moves) in steps {
                time += wait;
                for (place, (x, y)) in places.iter_mut().zip(moves) {
                    *place += Point::new(x, y);
                }
                samples.push((time, places.clone()));
            }
            samples.into_iter().unzip()
        })
    }

    fn worst(times: &[f64], samples: &[Vec<Point>], from: usize, to: usize) -> f64 {
        let mut worst: f64 = 0.0;
        for k in from..=to {
            let part = (times[k] - times[from]) / (times[to] - times[from]);
            for (p, place) in samples[k].iter().enumerate() {
                worst = worst.max((samples[from][p].lerp(&samples[to][p], part) - place).norm());
            }
        }
        worst
    }

    /// The fewest keys by trying every pair of samples.
    fn fewest(times: &[f64], samples: &[Vec<Point>], tolerance: f64) -> usize {
        let mut keys = vec![1];
        for to in 1..times.len() {
            let best = (0..to)
                .filter(|&from| to == from + 1 || worst(times, samples, from, to) <= tolerance)
                .map(|from| keys[from] + 1)
                .min();
            keys.push(best.expect("the sample before"));
        }
        keys[keys.len() - 1]
    }

    /// The keys of one who goes on for as long as the line fits.
    fn greedy(times: &[f64], samples: &[Vec<Point>], tolerance: f64) -> usize {
        let (mut from, mut keys) = (0, 1);
        while from + 1 < times.len() {
            let mut to = from + 1;
            while to + 1 < times.len() && worst(times, samples, from, to + 1) <= tolerance {
                to += 1;
            }
            (from, keys) = (to, keys + 1);
        }
        keys
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn keys_are_fewest_and_hold_the_tolerance((times, samples) in motion(3), tolerance in 0.0..4.0) {
            let keys = place_keys(&times, &samples, tolerance);
            prop_assert_eq!(keys.indices[0], 0);
            prop_assert_eq!(*keys.indices.last().expect("a key"), times.len() - 1);
            let found = keys.indices.windows(2).map(|key| worst(&times, &samples, key[0], key[1])).fold(0.0, f64::max);
            prop_assert!((found - keys.worst).abs() < 1e-12 && keys.worst <= tolerance);
            prop_assert_eq!(keys.indices.len(), fewest(&times, &samples, tolerance));
            prop_assert!(keys.indices.len() <= greedy(&times, &samples, tolerance));
        }
    }

    #[test]
    fn a_straight_motion_needs_two_keys_whatever_the_tolerance() {
        let times: Vec<f64> = (0..300).map(|k| f64::from(k) / 24.0).collect();
        let place = |t: f64, p: usize| Point::new(1e3 / 7.0 + 31.7 * t, p as f64 - t / 3.0);
        let samples: Vec<Vec<Point>> = times.iter().map(|&t| (0..50).map(|p| place(t, p)).collect()).collect();
        for tolerance in [0.0, 1e-6, 1.0] {
            assert_eq!(place_keys(&times, &samples, tolerance).indices, [0, 299]);
        }
    }

    #[test]
    fn an_arc_gets_as_many_keys_as_its_sagitta_asks_for() {
        let times: Vec<f64> = (0..=360).map(f64::from).collect();
        let samples: Vec<Vec<Point>> = times
            .iter()
            .map(|t| vec![Point::new(100.0 * t.to_radians().cos(), 100.0 * t.to_radians().sin())])
            .collect();
        // A chord over 2 x angle leaves its arc by 100 (1 - cos angle) in the middle, where time and arc agree.
        for chord in [30, 45, 90] {
            let tolerance = 100.0 * (1.0 - (f64::from(chord) / 2.0).to_radians().cos()) + 1e-9;
            let keys = place_keys(&times, &samples, tolerance);
            assert_eq!(keys.indices.len() as i32, 360 / chord + 1, "{keys:?}");
            assert!(keys.worst <= tolerance);
        }
    }

    #[test]
    fn a_longer_line_may_fit_where_a_shorter_does_not() {
        // From 0 the line to 2 misses sample 1, that to 3 fits; a greedy choice stops at 1.
        let samples = [0.0, 0.1, 2.9, 3.0].map(|x| vec![Point::new(x, 0.0)]);
        let times = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(place_keys(&times, &samples, 0.95).indices, [0, 3]);
        assert_eq!(greedy(&times, &samples, 0.95), 4);
    }

    #[test]
    fn nothing_and_nonsense_are_survived() {
        let none = Keys {
            indices: vec![],
            worst: 0.0,
        };
        assert_eq!(place_keys(&[], &[], 1.0), none);
        assert_eq!(place_keys(&[0.0], &[vec![]], 1.0).indices, [0]);
        assert_eq!(
            place_keys(&[0.0, 1.0, 2.0], &[vec![], vec![], vec![]], 1.0).indices,
            [0, 2]
        );
        let samples = [0.0, f64::NAN, 2.0, f64::INFINITY].map(|x| vec![Point::new(x, 0.0)]);
        assert_eq!(place_keys(&[0.0, 1.0, 2.0, 3.0], &samples, 1.0).indices, [0, 1, 2, 3]);
        assert_eq!(place_keys(&[0.0, 0.0, 0.0], &samples[..3], f64::NAN).indices.len(), 3);
    }
}
