//! The animation: keys, rate, size, background.

use toml::Spanned;

use super::{Checked, Reader};
use crate::animation::{Animation, AnimationError, Hold, Key, check_spacing};
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
                    let place = self.place(&at, &format!("`at` of animation key {index}"), Some(dimension))?;
                    let mut key = Key::new(time, place);
                    key.hold = self.hold(&written.hold, || format!("`hold` of animation key {index}"))?;
                    key.spacing = self.spacing(&written.spacing, index)?;
                    checked.push(key);
                }
                Animation::new(checked, table.looped.unwrap_or(false))
            }
            _ => Animation::visiting(poses.iter().map(|p| p.at.as_slice()), table.looped.unwrap_or(true)),
        };
        let mut animation = self.checked(animation)?;
        animation.fps = self.frame_rate(&table.fps)?;
        animation.hold = self
            .hold(&table.hold, || "[animation] hold".to_owned())?
            .unwrap_or_default();
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

    /// For how many frames a drawing is shown, where the file says it.
    fn hold(&self, written: &Option<Spanned<i64>>, key: impl Fn() -> String) -> Checked<Option<Hold>> {
        let Some(written) = written else { return Ok(None) };
        let frames = *written.get_ref();
        Hold::of_frames(frames).map(Some).ok_or_else(|| {
            self.fail(
                written.span().start,
                SceneProblem::BadNumber {
                    key: key(),
                    value: frames as f64,
                    allowed: "1, 2 or 3, the frames for which a drawing is shown",
                },
            )
        })
    }

    /// The spacing chart of a key.
    fn spacing(&self, written: &Option<Spanned<Vec<Spanned<f64>>>>, index: usize) -> Checked<Vec<f64>> {
        let Some(written) = written else { return Ok(Vec::new()) };
        let marks: Vec<f64> = written.get_ref().iter().map(|mark| *mark.get_ref()).collect();
        check_spacing(index, &marks).map_err(|error| {
            let place = match error {
                AnimationError::SpacingRange { mark, .. } | AnimationError::SpacingOrder { mark, .. } => {
                    written.get_ref().get(mark).map(|mark| mark.span().start)
                }
                _ => None,
            };
            let start = place.unwrap_or(written.span().start);
            self.fail(start, SceneProblem::Animation(error))
        })?;
        Ok(marks)
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
