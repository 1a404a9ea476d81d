//! From a recorded path to a few keys, and from keys to the path that is played.
//!
//! 1. The samples are smoothed: a line is fitted to each one's neighbourhood in time (weights fall off like a Gaussian), so that the
//!    ends stay where they are.
//! 2. Times are scaled to the length that is asked for.
//! 3. Keys: the first and the last sample; then, while the scene's own path through the keys is further from the samples than
//!    allowed, the sample that is furthest off; at last every key is left out that is not needed.

use std::path::Path;

use inbetween::animation::{Animation, Hold};
use inbetween::scene::Scene;
use serde::Deserialize;
use serde_json::{Value, json};

use super::edit::KeyText;
use super::problem::Refusal;
use super::scene_json::plane;
use super::session::Session;

/// Samples of a recording: ten minutes at a hundred a second.
const MOST_SAMPLES: usize = 60_000;
/// Samples that keys are fitted to.
const MOST_FITTED: usize = 1_500;
/// Keys of a gesture.
const MOST_KEYS: usize = 120;
/// Frames of a path that is previewed.
const MOST_FRAMES: usize = 20_000;

/// A moment and a place.
#[derive(Debug, Clone, PartialEq)]
struct Sample {
    time: f64,
    at: Vec<f64>,
}

/// The body of `POST api/gesture`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GestureRequest {
    samples: Vec<Vec<f64>>,
    #[serde(default)]
    smoothing: f64,
    tolerance: Option<f64>,
    duration: Option<f64>,
    #[serde(default, rename = "loop")]
    looped: bool,
}

/// `POST api/gesture`.
pub(super) fn gesture(body: &[u8], session: &Session) -> Result<Value, Refusal> {
    let asked: GestureRequest = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let shown = session.shown();
    let scene = shown.framed_scene()?;
    let dimension = scene.dimension();
    if asked.samples.len() > MOST_SAMPLES {
        return Err(Refusal::bad(format!("at most {MOST_SAMPLES} samples")));
    }
    let mut samples: Vec<Sample> = Vec::new();
    for numbers in &asked.samples {
        match numbers.split_first() {
            Some((time, at)) if at.len() == dimension && numbers.iter().all(|v| v.is_finite()) => {
                // Of two at one time, the later one counts.
                if samples.last().is_some_and(|last| last.time >= *time) {
                    samples.pop();
                }
                let is_later = samples.last().is_none_or(|last| last.time < *time);
                if is_later {
                    samples.push(Sample {
                        time: *time,
                        at: at.to_vec(),
                    });
                }
            }
            _ => return Err(Refusal::bad(format!("a sample is [t, {dimension} coordinates]"))),
        }
    }
    let start = match samples.first() {
        Some(first) => first.time,
        None => return Err(Refusal::bad("there is no sample")),
    };
    let length = samples.last().map_or(0.0, |last| last.time - start);
    let scale = match asked.duration {
        Some(duration) if duration > 0.0 && duration.is_finite() && length > 0.0 => duration / length,
        None => 1.0,
        Some(_) => return Err(Refusal::bad("`duration` must be a positive number of seconds")),
    };
    for sample in &mut samples {
        sample.time = (sample.time - start) * scale;
    }
    let extent = plane(scene).map_or(1.0, |(low, high)| (high[0] - low[0]).hypot(high[1] - low[1]));
    let extent = if extent > 0.0 { extent } else { 1.0 };
    let tolerance = asked.tolerance.unwrap_or(0.02).clamp(1e-4, 1.0) * extent;
    let smoothed = thinned(smoothed(&samples, asked.smoothing.clamp(0.0, 10.0)));
    let keys = keys_through(&smoothed, tolerance, 1e-4 * extent, asked.looped)?;
    let animation = animation(&keys, asked.looped, Animation::DEFAULT_FPS, dimension)?;
    let error = smoothed
        .iter()
        .map(|sample| away(&animation, sample))
        .fold(0.0, f64::max);
    let path = smoothed.iter().map(|sample| {
        let mut numbers = vec![sample.time];
        numbers.extend(&sample.at);
        numbers
    });
    Ok(json!({
        "keys": keys.iter().map(|key| json!({"time": key.time, "at": key.at})).collect::<Vec<_>>(),
        "error": error / extent,
        "path": path.collect::<Vec<_>>(),
    }))
}

/// Each sample on the line that fits its neighbourhood.
fn smoothed(samples: &[Sample], width: f64) -> Vec<Sample> {
    if width <= 0.0 {
        return samples.to_vec();
    }
    let reach = 3.0 * width;
    let smooth = |here: &Sample| {
        let from = samples.partition_point(|s| s.time < here.time - reach);
        let to = samples.partition_point(|s| s.time <= here.time + reach);
        let dimension = here.at.len();
        let (mut w0, mut w1, mut w2) = (0.0, 0.0, 0.0);
        let (mut y0, mut y1) = (vec![0.0; dimension], vec![0.0; dimension]);
        for sample in &samples[from..to] {
            let t = (sample.time - here.time) / width;
            let weight = (-0.5 * t * t).exp();
            (w0, w1, w2) = (w0 + weight, w1 + weight * t, w2 + weight * t * t);
            for d in 0..dimension {
                y0[d] += weight * sample.at[d];
                y1[d] += weight * t * sample.at[d];
            }
        }
        let determinant = w0 * w2 - w1 * w1;
        let value = |d: usize| {
            if determinant > 1e-12 * w0 * w2.max(1e-12) {
                (w2 * y0[d] - w1 * y1[d]) / determinant
            } else {
                y0[d] / w0
            }
        };
        Sample {
            time: here.time,
            at: (0..dimension).map(value).collect(),
        }
    };
    samples.iter().map(smooth).collect()
}

/// As many samples as keys can be fitted to quickly; the first and the last stay.
fn thinned(samples: Vec<Sample>) -> Vec<Sample> {
    let every = samples.len().div_ceil(MOST_FITTED).max(1);
    let last = samples.len() - 1;
    let keep = |k: usize| k.is_multiple_of(every) || k == last;
    samples
        .into_iter()
        .enumerate()
        .filter(|(k, _)| keep(*k))
        .map(|(_, sample)| sample)
        .collect()
}

/// How far the path is from a sample at its time.
fn away(animation: &Animation, sample: &Sample) -> f64 {
    let at = animation.at(sample.time);
    at.iter()
        .zip(&sample.at)
        .map(|(a, b)| (a - b) * (a - b))
        .sum::<f64>()
        .sqrt()
}

/// The keys of step 3, rounded: times to milliseconds, places to `grain`.
fn keys_through(samples: &[Sample], tolerance: f64, grain: f64, looped: bool) -> Result<Vec<KeyText>, Refusal> {
    let dimension = samples[0].at.len();
    let rounded = |sample: &Sample| KeyText {
        time: (sample.time * 1e3).round() / 1e3,
        at: sample.at.iter().map(|v| round_to(*v, grain)).collect(),
        hold: None,
        spacing: Vec::new(),
    };
    let keys_of = |chosen: &[usize]| {
        let mut keys: Vec<KeyText> = chosen.iter().map(|&k| rounded(&samples[k])).collect();
        keys.dedup_by(|later, earlier| later.time <= earlier.time);
        // A loop ends where it began.
        if looped && keys.len() > 1 {
            let first = keys[0].at.clone();
            if let Some(last) = keys.last_mut() {
                last.at = first;
            }
        }
        keys
    };
    // What cannot be met, the end of a loop that does not close, is not tried for.
    let fitted = if looped { samples.len() - 1 } else { samples.len() };
    let worst = |chosen: &[usize]| -> Result<(usize, f64), Refusal> {
        let animation = animation(&keys_of(chosen), looped, Animation::DEFAULT_FPS, dimension)?;
        let errors = samples[..fitted]
            .iter()
            .map(|sample| away(&animation, sample))
            .enumerate();
        Ok(errors.fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best }))
    };
    let mut chosen = vec![0];
    if samples.len() > 1 {
        chosen.push(samples.len() - 1);
    }
    while chosen.len() < MOST_KEYS {
        let (k, error) = worst(&chosen)?;
        let is_new = chosen
            .iter()
            .all(|&c| (samples[c].time - samples[k].time).abs() >= 2e-3);
        if error <= tolerance || !is_new {
            break;
        }
        chosen.push(k);
        chosen.sort_unstable();
    }
    let mut k = 1;
    while k + 1 < chosen.len() {
        let mut without = chosen.clone();
        without.remove(k);
        if worst(&without)?.1 <= tolerance {
            chosen = without;
        } else {
            k += 1;
        }
    }
    Ok(keys_of(&chosen))
}

/// The nearest number of few digits that is at most half a `grain` away.
fn round_to(value: f64, grain: f64) -> f64 {
    let digits = (-grain.log10()).ceil().clamp(-6.0, 12.0);
    let scale = 10f64.powf(digits);
    let rounded = (value * scale).round() / scale;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// What a scene with these keys plays.
fn animation(keys: &[KeyText], looped: bool, fps: f64, dimension: usize) -> Result<Animation, Refusal> {
    let list = |numbers: &[f64]| numbers.iter().map(|v| format!("{v:?}")).collect::<Vec<_>>().join(", ");
    let keys: Vec<String> = (keys.iter())
        .map(|key| {
            let hold = key.hold.map(|hold| format!(", hold = {hold}")).unwrap_or_default();
            let spacing = match key.spacing.as_slice() {
                [] => String::new(),
                marks => format!(", spacing = [{}]", list(marks)),
            };
            format!("{{ time = {:?}, at = [{}]{hold}{spacing} }}", key.time, list(&key.at))
        })
        .collect();
    let text = format!(
        "version = 1\n[[pose]]\nname = \"a\"\nsource = \"a.png\"\nat = [{}]\n[animation]\nfps = {fps:?}\nloop = {looped}\nkeys = [{}]\n",
        list(&vec![0.0; dimension]),
        keys.join(", ")
    );
    let scene = Scene::parse(&text, Path::new("scene.toml")).map_err(|error| Refusal::bad(error.problem))?;
    Ok(scene.animation)
}

/// The body of `POST api/path`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PathRequest {
    keys: Option<Vec<KeyText>>,
    #[serde(rename = "loop")]
    looped: Option<bool>,
    fps: Option<f64>,
    hold: Option<i64>,
}

/// `POST api/path`.
pub(super) fn path(body: &[u8], session: &Session) -> Result<Value, Refusal> {
    let asked: PathRequest = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let shown = session.shown();
    let scene = shown.framed_scene()?;
    let own = &scene.animation;
    let fps = asked.fps.unwrap_or(own.fps);
    let looped = asked.looped.unwrap_or(own.is_loop());
    let hold = match asked.hold {
        Some(frames) => Hold::of_frames(frames).ok_or_else(|| Refusal::bad("`hold` must be 1, 2 or 3"))?,
        None => own.hold,
    };
    let mut played = match (&asked.keys, asked.looped) {
        (Some(keys), _) => animation(keys, looped, fps, scene.dimension())?,
        (None, None) => {
            let mut played = own.clone();
            played.fps = fps;
            played
        }
        (None, Some(_)) => {
            let keys = own.given_keys().map(|key| KeyText {
                time: key.time,
                at: key.at.clone(),
                hold: key.hold.map(|hold| hold.frames() as i64),
                spacing: key.spacing.clone(),
            });
            animation(&keys.collect::<Vec<_>>(), looped, fps, scene.dimension())?
        }
    };
    played.hold = hold;
    if !(fps > 0.0 && fps <= 1000.0) {
        return Err(Refusal::bad("`fps` must be above 0 and at most 1000"));
    }
    let count = played.frame_count();
    if count > MOST_FRAMES {
        return Err(Refusal::bad(format!(
            "{count} frames are too many to look at; at most {MOST_FRAMES}"
        )));
    }
    let places: Vec<Vec<f64>> = (0..count).map(|k| played.place_of_frame(k)).collect();
    Ok(json!({
        "duration": played.duration(), "frame_count": count, "fps": played.fps, "start": played.time_of_frame(0),
        "loop": played.is_loop(), "held": played.is_held(), "at": places,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(count: usize) -> Vec<Sample> {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / (count - 1) as f64;
        let sample = |k: usize| Sample {
            time: 2.0 * k as f64 / (count - 1) as f64,
            at: vec![angle(k).cos(), angle(k).sin()],
        };
        (0..count).map(sample).collect()
    }

    #[test]
    fn a_circle_needs_few_keys_and_is_met() {
        let samples = circle(200);
        for looped in [false, true] {
            let keys = keys_through(&samples, 0.02, 1e-4, looped).expect("keys");
            assert!((5..=14).contains(&keys.len()), "{} keys", keys.len());
            let played = animation(&keys, looped, 24.0, 2).expect("an animation");
            let worst = samples.iter().map(|sample| away(&played, sample)).fold(0.0, f64::max);
            assert!(worst <= 0.0201, "{worst}");
            assert!((played.duration() - 2.0).abs() < 1e-9);
        }
    }

    #[test]
    fn smoothing_takes_noise_away_and_leaves_lines_alone() {
        let line: Vec<Sample> = (0..50)
            .map(|k| Sample {
                time: 0.02 * k as f64,
                at: vec![0.3 * k as f64, 1.0],
            })
            .collect();
        for (a, b) in smoothed(&line, 0.1).iter().zip(&line) {
            assert!((a.at[0] - b.at[0]).abs() < 1e-9 && (a.at[1] - b.at[1]).abs() < 1e-9);
        }
        let noise = |k: usize| if k.is_multiple_of(2) { 0.05 } else { -0.05 };
        let mut noisy = circle(200);
        for (k, sample) in noisy.iter_mut().enumerate() {
            sample.at[0] += noise(k);
        }
        let largest = |samples: &[Sample]| {
            let off = |(a, b): (&Sample, &Sample)| (a.at[0] - b.at[0]).abs();
            // At the ends there is less to take a mean of.
            samples
                .iter()
                .zip(&circle(200))
                .skip(15)
                .take(170)
                .map(off)
                .fold(0.0, f64::max)
        };
        assert!(largest(&smoothed(&noisy, 0.05)) < 0.3 * largest(&noisy));
    }

    #[test]
    fn resting_is_a_hold() {
        let mut samples: Vec<Sample> = Vec::new();
        for k in 0..=60 {
            let x = (k.clamp(20, 40) - 20) as f64 / 20.0;
            samples.push(Sample {
                time: k as f64 / 20.0,
                at: vec![x, 0.0],
            });
        }
        let keys = keys_through(&samples, 0.02, 1e-4, false).expect("keys");
        assert!(keys.len() <= 8, "{keys:?}");
        assert_eq!((keys[0].at[0], keys[keys.len() - 1].at[0]), (0.0, 1.0));
    }

    #[test]
    fn one_sample_is_one_key() {
        let sample = Sample {
            time: 0.0,
            at: vec![0.5, 0.25],
        };
        assert_eq!(keys_through(&[sample], 0.1, 1e-4, true).expect("a key").len(), 1);
    }
}
