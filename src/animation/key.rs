//! Keys of an animation.

use super::Hold;

/// A place to be at a time, and how the animation is drawn from there.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Key {
    /// When, in seconds.
    pub time: f64,
    /// Where in the pose space.
    pub at: Vec<f64>,
    /// For how many frames a drawing is shown from this key until the next one; `None`: as the animation says. On the last key
    /// of a loop that repeats its first, after which no frame comes, it says nothing.
    pub hold: Option<Hold>,
    /// The spacing chart of the way from the key before to this one: how far along it the path is at even steps of time, from 0 at
    /// the key before to 1 at this key. The time between the keys has one step more than there are marks. None: the path
    /// goes on evenly.
    ///
    /// Marks are within 0 and 1 and do not decrease; the first key has none.
    pub spacing: Vec<f64>,
}

impl Key {
    /// The place `at` at `time`, in seconds, with the animation's hold and without a spacing chart.
    #[must_use]
    pub fn new(time: f64, at: Vec<f64>) -> Self {
        Self {
            time,
            at,
            hold: None,
            spacing: Vec::new(),
        }
    }
}
