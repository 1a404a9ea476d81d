//! A path through the pose space over time.
//!
//! Keys -> a curve that passes through each key at its time with a continuous velocity: cubic Hermite pieces whose
//! tangent at a key is the derivative of the parabola through the key and its two neighbours (Catmull-Rom for uneven
//! times). Two equal keys in a row are a hold: the curve rests between them, and comes to rest and leaves smoothly.
//! A loop is closed with the same rule at its seam.
//!
//! The place at a time depends on the keys and the time alone, so every frame can be computed on its own.
//!
//! # Spacing
//!
//! Without more, the path is at half of the curve between two keys at half the time, as the parameter of the cubic counts it. The
//! [spacing chart](Key::spacing) of a key says how far along that parameter the path is at even steps of the time since the key before; between the
//! steps it goes on along a monotone cubic. The places that are passed are the same with a chart and without; only when they are
//! passed differs, and with it how fast the path comes to a key and leaves it: a chart may stop there.
//!
//! The parameter, and not the length of the curve, is what is measured: on the straight, even way between two keys they are one, and
//! a chart that is even leaves any path as it is.
//!
//! A chart does not leave the way between its keys. Anticipation and overshoot are places of their own in the pose space, so
//! they are keys, before and beyond.
//!
//! # Holds
//!
//! On ones every frame is a drawing of its own; on twos or threes ([`Hold`]) a drawing is shown for two or three frames, and the path
//! is looked at only where one begins:
//!
//! 1. A key is at the first frame that is not before its time, and is in force up to the frame of the next key.
//! 2. Drawings are counted from the first frame of the animation. Counting begins anew at the frame of a key that has a hold of its own, and at
//!    that of the next key, where the animation's own hold is in force again. Other keys leave the count alone, so that a
//!    recorded path with keys at any time plays evenly. A key that has to be drawn where the count would pass over it is given a hold.
//! 3. Frame `k` shows the path at the last frame up to `k` where a drawing begins ([`Animation::drawn_frame`]). A loop is counted
//!    from its first frame each time around.

mod background;
mod hold;
mod key;
mod path;
mod spacing;

pub use background::Background;
pub use hold::Hold;
pub use key::Key;

use path::Path;

/// By how much a key may come after a frame and still belong to it, in frames: times such as 0.7 s are rounded, and at rates up to
/// 1000 over a million seconds a frame's time is known to about 1e-7 of a frame.
const SAME_FRAME: f64 = 1e-6;

/// What is played, and how it is framed.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// Frames a second.
    pub fps: f64,
    /// Columns and rows of a frame.
    pub size: [u32; 2],
    /// What is behind the character.
    pub background: Background,
    /// For how many frames a drawing is shown, where a key does not say otherwise.
    pub hold: Hold,
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
    /// A spacing chart before which there is no key.
    #[error("animation key {index} has a spacing chart, but there is no key before it to come from; remove `spacing`")]
    SpacingWithoutWay {
        /// Which key, from 0.
        index: usize,
    },
    /// A mark of a spacing chart that is not between 0 and 1.
    #[error(
        "animation key {index}: mark {mark} of its spacing is {value}, but must be between 0 (the key before) and 1 (this key); to go \
         beyond a key, add one there"
    )]
    SpacingRange {
        /// Which key, from 0.
        index: usize,
        /// Which mark, from 0.
        mark: usize,
        /// Its value.
        value: f64,
    },
    /// A spacing chart that turns back.
    #[error(
        "animation key {index}: mark {mark} of its spacing is {value}, below the mark before, {before}; a chart goes one way, so to \
         turn back, add a key"
    )]
    SpacingOrder {
        /// Which key, from 0.
        index: usize,
        /// Which mark, from 0.
        mark: usize,
        /// Its value.
        value: f64,
        /// The value before.
        before: f64,
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
    /// [`AnimationError`] if there is no key, or one is not finite, has another dimension, is not after its predecessor, or has a
    /// spacing chart that is none.
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
            check_spacing(index, &key.spacing)?;
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
    fn of_keys(keys: Vec<Key>, looped: bool) -> Self {
        Self {
            fps: Self::DEFAULT_FPS,
            size: Self::DEFAULT_SIZE,
            background: Background::Transparent,
            hold: Hold::Ones,
            path: Path::new(keys, looped),
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
            .map(|(k, at)| Key::new(k as f64 * Self::SECONDS_A_POSE, at.to_vec()))
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
            hold: self.hold,
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

    /// Whether any drawing is shown for more than one frame.
    #[must_use]
    pub fn is_held(&self) -> bool {
        let is_long = |hold: Hold| hold != Hold::Ones;
        is_long(self.hold) || self.path.keys.iter().any(|key| key.hold.is_some_and(is_long))
    }

    /// The frame whose drawing is shown at frame `index`, both counted from 0: at most `index`, and `index` itself on ones. All
    /// frames for which it is the same are equal.
    #[must_use]
    pub fn drawn_frame(&self, index: usize) -> usize {
        if !self.is_held() {
            return index;
        }
        let within = if self.is_loop() {
            index % self.frame_count()
        } else {
            index
        };
        let keys = &self.path.keys;
        // Frames of keys do not decrease, and the first key is at frame 0.
        let current = keys
            .partition_point(|key| self.frame_of(key.time) <= within)
            .saturating_sub(1);
        let counted_from = (0..=current)
            .rev()
            .find(|&k| keys[k].hold.is_some() || (k > 0 && keys[k - 1].hold.is_some()))
            .unwrap_or(0);
        let first = self.frame_of(keys[counted_from].time);
        let hold = keys[current].hold.unwrap_or(self.hold);
        index - within.saturating_sub(first) % hold.frames()
    }

    /// The first frame that is not before `time`.
    fn frame_of(&self, time: f64) -> usize {
        let frames_a_second = match self.path.period {
            Some(period) => self.frame_count() as f64 / period,
            None => self.fps,
        };
        ((time - self.path.keys[0].time) * frames_a_second - SAME_FRAME).ceil() as usize
    }

    /// The place in the pose space that frame `index`, counted from 0, shows: where the path is at the time of the frame that
    /// is drawn for it.
    ///
    /// ```
    /// use inbetween::animation::{Animation, Hold, Key};
    ///
    /// let mut animation = Animation::new(vec![Key::new(0.0, vec![0.0]), Key::new(1.0, vec![24.0])], false)?;
    /// animation.hold = Hold::Twos;
    /// let places: Vec<f64> = (0..6).flat_map(|frame| animation.place_of_frame(frame)).collect();
    /// assert!(places.iter().zip([0.0, 0.0, 2.0, 2.0, 4.0, 4.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    /// # Ok::<(), inbetween::animation::AnimationError>(())
    /// ```
    #[must_use]
    pub fn place_of_frame(&self, index: usize) -> Vec<f64> {
        self.at(self.time_of_frame(self.drawn_frame(index)))
    }

    /// The place in the pose space at `time`, in seconds, without regard to holds. Before the first and after the last key it
    /// rests.
    #[must_use]
    pub fn at(&self, time: f64) -> Vec<f64> {
        self.path.at(time)
    }
}

/// Whether the spacing of key `index` is a chart.
pub(crate) fn check_spacing(index: usize, spacing: &[f64]) -> Result<(), AnimationError> {
    if index == 0 && !spacing.is_empty() {
        return Err(AnimationError::SpacingWithoutWay { index });
    }
    let mut before = 0.0;
    for (mark, &value) in spacing.iter().enumerate() {
        if !(0.0..=1.0).contains(&value) {
            return Err(AnimationError::SpacingRange { index, mark, value });
        }
        if value < before {
            return Err(AnimationError::SpacingOrder {
                index,
                mark,
                value,
                before,
            });
        }
        before = value;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
