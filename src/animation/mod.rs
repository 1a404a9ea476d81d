//! A path through the pose space over time.
//!
//! Keys -> a curve that passes through each key at its time with a continuous velocity: cubic Hermite pieces whose
//! tangent at a key is the derivative of the parabola through the key and its two neighbours (Catmull-Rom for uneven
//! times). Two equal keys in a row are a hold: the curve rests between them, and comes to rest and leaves smoothly.
//! A loop is closed with the same rule at its seam.
//!
//! The place at a time depends on the keys and the time alone, so every frame can be computed on its own.

mod background;

pub use background::Background;

/// A place to be at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// When, in seconds.
    pub time: f64,
    /// Where in the pose space.
    pub at: Vec<f64>,
}

/// What is played, and how it is framed.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// Frames a second.
    pub fps: f64,
    /// Columns and rows of a frame.
    pub size: [u32; 2],
    /// What is behind the character.
    pub background: Background,
    path: Path,
    route: Route,
}

/// Why keys are no animation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnimationError {
    /// There is no key.
    #[error("an animation needs at least one key")]
    NoKey,
    /// A number is not finite.
    #[error("animation key {index} has a time or place that is not finite")]
    NotFinite {
        /// Which key, from 0.
        index: usize,
    },
    /// A place of another dimension.
    #[error("animation key {index} has {found} coordinates, the first has {expected}")]
    Dimension {
        /// Which key, from 0.
        index: usize,
        /// Its coordinates.
        found: usize,
        /// Those of the first.
        expected: usize,
    },
    /// Keys whose times do not increase.
    #[error("animation key {index} is at time {time}, not after its predecessor at {before}; sort the keys by time")]
    KeyOrder {
        /// Which key, from 0.
        index: usize,
        /// Its time.
        time: f64,
        /// The time before.
        before: f64,
    },
}

/// Where the keys come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Route {
    /// Given as they are.
    Keys,
    /// From the places of the poses; whether as a loop.
    Poses { looped: bool },
}

#[derive(Debug, Clone, PartialEq)]
struct Path {
    /// At least one; times increase strictly.
    keys: Vec<Key>,
    /// The last key of a loop that repeats its first, which is not among the others.
    closing: Option<Key>,
    /// The time after which a loop starts over.
    period: Option<f64>,
    /// The velocity at each key.
    tangents: Vec<Vec<f64>>,
}

impl Animation {
    /// Frames a second when the scene does not say.
    pub const DEFAULT_FPS: f64 = 24.0;
    /// Columns and rows when the scene does not say.
    pub const DEFAULT_SIZE: [u32; 2] = [1280, 720];
    /// The time between two poses of the default animation.
    pub const SECONDS_A_POSE: f64 = 1.0;

    /// An animation through `keys`, which are not empty and whose times increase strictly; rate, size and background are the
    /// defaults.
    ///
    /// A loop whose last key lies where the first one does ends there; any other loop takes the mean time between keys
    /// to return from the last to the first.
    ///
    /// # Errors
    /// [`AnimationError`] if there is no key, or one is not finite, has another dimension or is not after its predecessor.
    pub fn new(keys: Vec<Key>, looped: bool) -> Result<Self, AnimationError> {
        let dimension = keys.first().ok_or(AnimationError::NoKey)?.at.len();
        let mut before = None;
        for (index, key) in keys.iter().enumerate() {
            if !(key.time.is_finite() && key.at.iter().all(|v| v.is_finite())) {
                return Err(AnimationError::NotFinite { index });
            }
            if key.at.len() != dimension {
                return Err(AnimationError::Dimension {
                    index,
                    found: key.at.len(),
                    expected: dimension,
                });
            }
            if let Some(before) = before.replace(key.time).filter(|before| *before >= key.time) {
                return Err(AnimationError::KeyOrder {
                    index,
                    time: key.time,
                    before,
                });
            }
        }
        Ok(Self::of_keys(keys, looped))
    }

    /// As [`Self::new`] for keys that are known to be fit.
    fn of_keys(mut keys: Vec<Key>, looped: bool) -> Self {
        let span = match (keys.first(), keys.last()) {
            (Some(first), Some(last)) => last.time - first.time,
            _ => 0.0,
        };
        let (mut period, mut closing) = (None, None);
        if looped && keys.len() > 1 {
            if keys.first().map(|k| &k.at) == keys.last().map(|k| &k.at) {
                closing = keys.pop();
                period = Some(span);
            } else {
                period = Some(span * keys.len() as f64 / (keys.len() - 1) as f64);
            }
        }
        let tangents = tangents(&keys, period);
        Self {
            fps: Self::DEFAULT_FPS,
            size: Self::DEFAULT_SIZE,
            background: Background::Transparent,
            path: Path {
                keys,
                closing,
                period,
                tangents,
            },
            route: Route::Keys,
        }
    }

    /// An animation that visits the places of the poses in order, [`Self::SECONDS_A_POSE`] apart, as a loop or once.
    ///
    /// # Errors
    /// [`AnimationError`] if there is no place, or one is not finite or has another dimension.
    pub fn visiting<'a>(places: impl IntoIterator<Item = &'a [f64]>, looped: bool) -> Result<Self, AnimationError> {
        let keys = places
            .into_iter()
            .enumerate()
            .map(|(k, at)| Key {
                time: k as f64 * Self::SECONDS_A_POSE,
                at: at.to_vec(),
            })
            .collect();
        Ok(Self {
            route: Route::Poses { looped },
            ..Self::new(keys, looped)?
        })
    }

    /// The animation with the poses at other places; one with keys of its own stays as it is.
    ///
    /// # Errors
    /// As [`Self::visiting`].
    pub fn through<'a>(&self, places: impl IntoIterator<Item = &'a [f64]>) -> Result<Self, AnimationError> {
        let moved = match self.route {
            Route::Keys => return Ok(self.clone()),
            Route::Poses { looped } => Self::visiting(places, looped)?,
        };
        Ok(Self {
            fps: self.fps,
            size: self.size,
            background: self.background,
            ..moved
        })
    }

    /// The keys, in order of time. The last key of a loop that repeats its first is not among them.
    #[must_use]
    pub fn keys(&self) -> &[Key] {
        &self.path.keys
    }

    /// The keys as they were given: of a loop that ends where it begins, its last key, too.
    pub fn given_keys(&self) -> impl Iterator<Item = &Key> {
        self.path.keys.iter().chain(&self.path.closing)
    }

    /// Whether it is a loop.
    #[must_use]
    pub fn is_loop(&self) -> bool {
        self.path.period.is_some()
    }

    /// How long it plays, in seconds: from the first key to the last, or once around the loop.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.path
            .period
            .unwrap_or_else(|| self.path.keys[self.path.keys.len() - 1].time - self.path.keys[0].time)
    }

    /// How many frames there are, at least 1. Of a loop the last frame is the one before the first comes again.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        let steps = (self.duration() * self.fps).round() as usize;
        match self.path.period {
            Some(_) => steps.max(1),
            None => steps.saturating_add(1),
        }
    }

    /// The time of frame `index`, counted from 0, in seconds. Frames are `1 / fps` apart; those of a loop are spread
    /// evenly over it, so that it closes without a stutter.
    #[must_use]
    pub fn time_of_frame(&self, index: usize) -> f64 {
        let start = self.path.keys[0].time;
        match self.path.period {
            Some(period) => start + period * index as f64 / self.frame_count() as f64,
            None => (start + index as f64 / self.fps).min(start + self.duration()),
        }
    }

    /// The place in the pose space at `time`, in seconds. Before the first and after the last key it rests.
    #[must_use]
    pub fn at(&self, time: f64) -> Vec<f64> {
        let Path {
            keys, period, tangents, ..
        } = &self.path;
        let start = keys[0].time;
        let time = match period {
            Some(period) => start + (time - start).rem_euclid(*period),
            None => time,
        };
        if time <= start || keys.len() == 1 {
            return keys[0].at.clone();
        }
        let after = keys.partition_point(|k| k.time <= time);
        let from = after - 1;
        let (to, end) = match (keys.get(after), period) {
            (Some(key), _) => (after, key.time),
            (None, Some(period)) => (0, start + period),
            (None, None) => return keys[from].at.clone(),
        };
        let length = end - keys[from].time;
        let u = (time - keys[from].time) / length;
        // The cubic Hermite basis.
        let to_value = u * u * (3.0 - 2.0 * u);
        let (from_slope, to_slope) = (u * (1.0 - u) * (1.0 - u) * length, u * u * (u - 1.0) * length);
        (0..keys[from].at.len())
            .map(|d| {
                keys[from].at[d]
                    + to_value * (keys[to].at[d] - keys[from].at[d])
                    + from_slope * tangents[from][d]
                    + to_slope * tangents[to][d]
            })
            .collect()
    }
}

/// The velocity at each key.
fn tangents(keys: &[Key], period: Option<f64>) -> Vec<Vec<f64>> {
    let count = keys.len();
    let dimension = keys.first().map_or(0, |k| k.at.len());
    // The piece from key k to its successor: its length in time and its mean velocity.
    let piece = |k: usize| -> Option<(f64, Vec<f64>)> {
        let next = (k + 1) % count;
        let length = if next > k {
            keys[next].time - keys[k].time
        } else {
            keys[0].time + period? - keys[k].time
        };
        let velocity = (0..dimension)
            .map(|d| (keys[next].at[d] - keys[k].at[d]) / length)
            .collect();
        Some((length, velocity))
    };
    let rests = |velocity: &[f64]| velocity.iter().all(|v| *v == 0.0);
    (0..count)
        .map(|k| {
            if count == 1 {
                return vec![0.0; dimension];
            }
            let before = if k > 0 || period.is_some() {
                piece((k + count - 1) % count)
            } else {
                None
            };
            match (before, piece(k)) {
                (Some((_, v)), _) | (_, Some((_, v))) if rests(&v) => v,
                (Some((a, u)), Some((b, v))) if !rests(&v) => {
                    (0..dimension).map(|d| (b * u[d] + a * v[d]) / (a + b)).collect()
                }
                // The open ends: the chord. A straight path keeps its speed.
                (Some((_, v)), _) | (_, Some((_, v))) => v,
                (None, None) => vec![0.0; dimension],
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn key(time: f64, x: f64, y: f64) -> Key {
        Key { time, at: vec![x, y] }
    }

    #[test]
    fn two_keys_are_a_straight_even_path() {
        let path = Animation::new(vec![key(1.0, 0.0, 0.0), key(3.0, 4.0, 2.0)], false).expect("keys");
        assert_eq!(path.at(1.5), vec![1.0, 0.5]);
        assert_eq!(path.at(0.0), vec![0.0, 0.0]);
        assert_eq!(path.at(9.0), vec![4.0, 2.0]);
        assert_eq!(path.frame_count(), 49);
        assert_eq!(path.time_of_frame(48), 3.0);
    }

    #[test]
    fn a_hold_rests() {
        let keys = vec![
            key(0.0, 0.0, 0.0),
            key(1.0, 1.0, 0.0),
            key(2.0, 1.0, 0.0),
            key(3.0, 0.0, 1.0),
        ];
        let path = Animation::new(keys, false).expect("keys");
        for k in 0..=10 {
            assert_eq!(path.at(1.0 + f64::from(k) / 10.0), vec![1.0, 0.0]);
        }
    }

    #[test]
    fn a_loop_that_repeats_its_first_key_ends_there() {
        let keys = vec![key(0.0, 0.0, 0.0), key(1.0, 1.0, 0.0), key(2.5, 0.0, 0.0)];
        let path = Animation::new(keys, true).expect("keys");
        assert_eq!(path.duration(), 2.5);
        assert_eq!(path.frame_count(), 60);
        assert_eq!(path.at(2.5), path.at(0.0));
        let given: Vec<Key> = path.given_keys().cloned().collect();
        assert_eq!((path.keys().len(), given.len()), (2, 3));
        assert_eq!(Animation::new(given, true).expect("keys"), path);
    }

    #[test]
    fn one_key_is_one_frame() {
        let path = Animation::new(vec![key(0.0, 0.3, 0.4)], true).expect("keys");
        assert_eq!((path.frame_count(), path.time_of_frame(0)), (1, 0.0));
        assert_eq!(path.at(7.0), vec![0.3, 0.4]);
    }

    #[test]
    fn keys_that_are_no_animation_are_refused() {
        let refused = |keys: Vec<Key>| Animation::new(keys, true).expect_err("no animation");
        assert_eq!(refused(vec![]), AnimationError::NoKey);
        assert_eq!(
            refused(vec![key(0.0, f64::NAN, 0.0)]),
            AnimationError::NotFinite { index: 0 }
        );
        let (time, before) = (1.0, 1.0);
        assert_eq!(
            refused(vec![key(1.0, 0.0, 0.0), key(1.0, 1.0, 0.0)]),
            AnimationError::KeyOrder { index: 1, time, before }
        );
        let line = Key {
            time: 2.0,
            at: vec![0.5],
        };
        let (found, expected) = (1, 2);
        assert_eq!(
            refused(vec![key(1.0, 0.0, 0.0), line]),
            AnimationError::Dimension {
                index: 1,
                found,
                expected
            }
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn passes_through_its_keys_with_continuous_velocity(
            steps in prop::collection::vec((0.1..2.0f64, -3.0..3.0f64, -3.0..3.0f64), 2..7),
            looped: bool,
        ) {
            let mut time = 0.0;
            let keys: Vec<Key> = steps.iter().map(|(dt, x, y)| { time += dt; key(time, *x, *y) }).collect();
            let path = Animation::new(keys.clone(), looped).expect("keys");
            for k in &keys {
                for (a, b) in path.at(k.time).iter().zip(&k.at) {
                    prop_assert!((a - b).abs() < 1e-9);
                }
            }
            // The velocity from both sides of each key, ends of an open path left out.
            let inner = if looped { 0..keys.len() } else { 1..keys.len() - 1 };
            for k in inner {
                let (h, t) = (1e-6, keys[k].time);
                let (before, here, after) = (path.at(t - h), path.at(t), path.at(t + h));
                for d in 0..2 {
                    let jump = (after[d] - 2.0 * here[d] + before[d]).abs() / h;
                    prop_assert!(jump < 0.05, "velocity jumps by {jump} at key {k}");
                }
            }
        }
    }
}
