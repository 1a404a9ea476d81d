//! The animation: keys, rate, size, background.

use toml::Spanned;

use super::{Checked, Reader};
use crate::animation::{Animation, AnimationError, Key};
use crate::scene::error::SceneProblem;
use crate::scene::file::AnimationTable;
use crate::scene::settings::ScenePose;

/// The largest side of a frame, in pixels.
const LARGEST_FRAME: i64 = 16_384;
/// The highest frame rate.
const HIGHEST_RATE: f64 = 1000.0;
/// The longest animation, in seconds: with the highest rate its frames can still be counted exactly.
const LATEST_TIME: f64 = 1e6;

impl Reader<'_> {
    pub(super) fn animation(&self, table: &AnimationTable, poses: &[ScenePose]) -> Checked<Animation> {
        let animation = match &table.keys {
            Some(keys) if !keys.get_ref().is_empty() => {
                let dimension = poses.first().map_or(0, |p| p.at.len());
                let mut checked: Vec<Key> = Vec::new();
                for (index, key) in keys.get_ref().iter().enumerate() {
                    let start = key.span().start;
                    let written = key.get_ref();
                    let before = checked.last().map(|k| k.time);
                    let time = self.key_time(index, written.time, before, start)?;
                    let at = Spanned::new(key.span(), written.at.clone());
                    checked.push(Key {
                        time,
                        at: self.place(&at, &format!("`at` of animation key {index}"), Some(dimension))?,
                    });
                }
                Animation::new(checked, table.looped.unwrap_or(false))
            }
            _ => Animation::visiting(poses.iter().map(|p| p.at.as_slice()), table.looped.unwrap_or(true)),
        };
        let mut animation = self.checked(animation)?;
        animation.fps = self.frame_rate(&table.fps)?;
        if let Some(size) = &table.size {
            let (start, sides) = (size.span().start, size.get_ref());
            let bad = |value: i64| {
                self.fail(
                    start,
                    SceneProblem::BadNumber {
                        key: "[animation] size".to_owned(),
                        value: value as f64,
                        allowed: "two whole numbers [columns, rows] between 1 and 16384",
                    },
                )
            };
            let [columns, rows] = sides[..] else {
                return Err(bad(sides.len() as i64));
            };
            for side in [columns, rows] {
                if !(1..=LARGEST_FRAME).contains(&side) {
                    return Err(bad(side));
                }
            }
            animation.size = [columns as u32, rows as u32];
        }
        if let Some(background) = &table.background {
            animation.background = background.get_ref().parse().map_err(|allowed| {
                self.fail(
                    background.span().start,
                    SceneProblem::BadChoice {
                        key: "[animation] background".to_owned(),
                        value: background.get_ref().clone(),
                        allowed,
                    },
                )
            })?;
        }
        Ok(animation)
    }

    /// An animation whose keys were checked one by one.
    pub(in crate::scene) fn checked(&self, animation: Result<Animation, AnimationError>) -> Checked<Animation> {
        animation.map_err(|error| self.fail(self.text.len(), SceneProblem::Format(error.to_string())))
    }

    /// Frames a second.
    pub(in crate::scene) fn frame_rate(&self, fps: &Option<Spanned<f64>>) -> Checked<f64> {
        self.number(
            fps,
            "[animation] fps",
            Animation::DEFAULT_FPS,
            |v| v > 0.0 && v <= HIGHEST_RATE,
            "above 0 and at most 1000",
        )
    }

    /// The time of a key, which comes after the one before.
    pub(in crate::scene) fn key_time(
        &self,
        index: usize,
        time: f64,
        before: Option<f64>,
        start: usize,
    ) -> Checked<f64> {
        if !time.is_finite() || time.abs() > LATEST_TIME {
            return Err(self.fail(
                start,
                SceneProblem::BadNumber {
                    key: format!("time of animation key {index}"),
                    value: time,
                    allowed: "finite and at most a million seconds",
                },
            ));
        }
        match before.filter(|before| *before >= time) {
            Some(before) => Err(self.fail(start, SceneProblem::KeyOrder { index, time, before })),
            None => Ok(time),
        }
    }
}
