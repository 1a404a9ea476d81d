//! Properties with and without keys.

use serde_json::{Value, json};

use crate::export::{KeyInterpolation, SampleTiming};
use crate::math::Point;

/// Decimals of lengths.
const DECIMALS: i32 = 2;

/// Turns samples into key frames.
#[derive(Debug, Clone, Copy)]
pub(super) struct Timeline {
    timing: SampleTiming,
    interpolation: KeyInterpolation,
}

impl Timeline {
    pub(super) fn new(timing: &SampleTiming, interpolation: KeyInterpolation) -> Self {
        Self {
            timing: *timing,
            interpolation,
        }
    }

    /// A property whose value is one number.
    pub(super) fn scalar(&self, keys: &[usize], value: impl Fn(usize) -> Value) -> Value {
        self.property(keys, |k| (value(k), true), json!([1]), json!([0]))
    }

    /// A property whose value is a list of numbers.
    pub(super) fn list(&self, keys: &[usize], value: impl Fn(usize) -> Value) -> Value {
        self.property(keys, |k| (value(k), false), json!([1]), json!([0]))
    }

    /// A property whose value is a path, which changes as a whole.
    pub(super) fn single(&self, keys: &[usize], value: impl Fn(usize) -> Value) -> Value {
        self.property(keys, |k| (value(k), true), json!(1), json!(0))
    }

    /// `value` says whether a key wants its value in a list; `end` and `start` are the handles of a straight line.
    fn property(&self, keys: &[usize], value: impl Fn(usize) -> (Value, bool), end: Value, start: Value) -> Value {
        if let [only] = keys {
            return json!({"a": 0, "k": value(*only).0});
        }
        let frames: Vec<Value> = keys
            .iter()
            .enumerate()
            .map(|(k, key)| {
                let (value, in_list) = value(*key);
                let value = if in_list { Value::Array(vec![value]) } else { value };
                let time = rounded(self.timing.frame_of(*key), 6);
                match self.interpolation {
                    _ if k + 1 == keys.len() => json!({"t": time, "s": value}),
                    KeyInterpolation::Linear => {
                        json!({"t": time, "s": value, "i": {"x": end, "y": end}, "o": {"x": start, "y": start}})
                    }
                    KeyInterpolation::Held => json!({"t": time, "s": value, "h": 1}),
                }
            })
            .collect();
        json!({"a": 1, "k": frames})
    }
}

/// A number with at most so many decimals.
pub(super) fn rounded(value: f64, decimals: i32) -> Value {
    /// Whole numbers up to here are written as such.
    const WHOLE: f64 = 1e15;
    if !value.is_finite() {
        return json!(0);
    }
    let scale = 10_f64.powi(decimals);
    let short = (value * scale).round() / scale;
    if short.fract() == 0.0 && short.abs() < WHOLE {
        json!(short as i64)
    } else {
        json!(short)
    }
}

/// A point in pixels.
pub(super) fn pair(point: Point) -> Value {
    Value::Array(vec![rounded(point.x, DECIMALS), rounded(point.y, DECIMALS)])
}
