//! The curve through the keys.

use super::Key;
use super::spacing::SpacingChart;

/// A curve through keys, once or as a loop.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// At least one; times increase strictly.
    pub(super) keys: Vec<Key>,
    /// The last key of a loop that repeats its first, which is not among the others.
    pub(super) closing: Option<Key>,
    /// The time after which a loop starts over.
    pub(super) period: Option<f64>,
    /// The velocity at each key, as it is without charts.
    tangents: Vec<Vec<f64>>,
    /// The chart of the piece from each key to its successor, where that has one.
    charts: Vec<Option<SpacingChart>>,
}

impl Path {
    /// A curve through `keys`, which are known to be fit.
    pub(super) fn new(mut keys: Vec<Key>, looped: bool) -> Self {
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
        // The way back of a loop that does not repeat its first key has none.
        let ends = keys.iter().skip(1).map(Some).chain([closing.as_ref()]);
        let chart = |end: Option<&Key>| {
            end.filter(|key| !key.spacing.is_empty())
                .map(|key| SpacingChart::new(&key.spacing))
        };
        let charts = ends.map(chart).collect();
        Self {
            keys,
            closing,
            period,
            tangents,
            charts,
        }
    }

    /// The place at `time`, in seconds.
    pub(super) fn at(&self, time: f64) -> Vec<f64> {
        let Self {
            keys,
            period,
            tangents,
            charts,
            ..
        } = self;
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
        let share = (time - keys[from].time) / length;
        let u = charts[from].as_ref().map_or(share, |chart| chart.way(share));
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
