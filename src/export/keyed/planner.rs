//! Which samples become keys.

use std::ops::{Add, Mul, Sub};

use super::{Approximation, KeyInterpolation, KeyOptions, KeyReport, SampleTiming};
use crate::export::place_keys;
use crate::math::Point;

/// What moves less, in pixels, rests: numbers are written with two decimals.
const REST_PX: f64 = 0.005;
/// What changes less, of 255, rests.
const REST_STEPS: f64 = 0.1;

/// Places keys and keeps the account.
#[derive(Debug)]
pub(in crate::export) struct Planner<'a> {
    /// In frames.
    times: Vec<f64>,
    options: &'a KeyOptions,
    report: KeyReport,
}

impl<'a> Planner<'a> {
    pub(in crate::export) fn new(timing: &SampleTiming, options: &'a KeyOptions) -> Self {
        Self {
            times: (0..timing.sample_count())
                .map(|sample| timing.frame_of(sample))
                .collect(),
            options,
            report: KeyReport::default(),
        }
    }

    /// Puts values that are not seen where they cost no keys: on the straight line, in time, between where they are seen before
    /// and after, or where keys are held where they are seen before.
    pub(in crate::export) fn settled<T>(&self, samples: &[Vec<T>], seen: &[bool]) -> Vec<Vec<T>>
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
    {
        let mut settled = samples.to_vec();
        let mut before = None;
        let mut k = 0;
        while k < samples.len() {
            if seen[k] {
                before = Some(k);
                k += 1;
                continue;
            }
            let after = (k..samples.len()).find(|k| seen[*k]);
            let end = after.unwrap_or(samples.len());
            for (j, sample) in settled.iter_mut().enumerate().take(end).skip(k) {
                *sample = match (before, after) {
                    (Some(a), Some(b)) if self.options.interpolation == KeyInterpolation::Linear => {
                        let t = (j - a) as f64 / (b - a) as f64;
                        samples[a]
                            .iter()
                            .zip(&samples[b])
                            .map(|(a, b)| *a + (*b - *a) * t)
                            .collect()
                    }
                    (Some(only), _) | (None, Some(only)) => samples[only].clone(),
                    (None, None) => samples[0].clone(),
                };
            }
            k = end;
        }
        settled
    }

    /// The keys of points given in pixels, one list a sample; the first sample alone if they rest.
    pub(in crate::export) fn pixels(&mut self, samples: &[Vec<Point>]) -> Vec<usize> {
        let (keys, worst) = self.place(samples, self.options.max_error_px, REST_PX);
        self.report.worst_px = self.report.worst_px.max(worst);
        keys
    }

    /// The keys of numbers given in pixels, one list a sample.
    pub(in crate::export) fn lengths(&mut self, samples: &[Vec<f64>]) -> Vec<usize> {
        self.pixels(&on_a_line(samples, 1.0))
    }

    /// The keys of colours, opacities and offsets from 0 to 1, one list a sample.
    pub(in crate::export) fn steps(&mut self, samples: &[Vec<f64>]) -> Vec<usize> {
        let (keys, worst) = self.place(&on_a_line(samples, 255.0), self.options.max_error_steps, REST_STEPS);
        self.report.worst_step = self.report.worst_step.max(worst);
        keys
    }

    /// Notes what the format cannot hold, once.
    pub(in crate::export) fn approximated(&mut self, what: Approximation) {
        if !self.report.approximations.contains(&what) {
            self.report.approximations.push(what);
        }
    }

    pub(in crate::export) fn into_report(self) -> KeyReport {
        self.report
    }

    fn place(&mut self, samples: &[Vec<Point>], tolerance: f64, rest: f64) -> (Vec<usize>, f64) {
        let from_first = samples
            .iter()
            .map(|sample| distance(sample, &samples[0]))
            .fold(0.0, f64::max);
        if samples.len() < 2 || from_first <= rest.min(tolerance) {
            return (vec![0], from_first);
        }
        if self.options.interpolation == KeyInterpolation::Held {
            let (keys, worst) = held_keys(samples, tolerance);
            self.report.keys += keys.len();
            return (keys, worst);
        }
        let keys = place_keys(&self.times, samples, tolerance);
        let is_rest = keys.indices.len() == 2 && distance(&samples[0], &samples[samples.len() - 1]) <= rest;
        if is_rest && from_first <= tolerance {
            return (vec![0], from_first);
        }
        self.report.keys += keys.indices.len();
        (keys.indices, keys.worst)
    }
}

/// The samples that are further than `tolerance` from the key before, and the largest distance of any other.
fn held_keys(samples: &[Vec<Point>], tolerance: f64) -> (Vec<usize>, f64) {
    let (mut keys, mut last, mut worst) = (vec![0], 0, 0.0);
    for (k, sample) in samples.iter().enumerate().skip(1) {
        let away = distance(sample, &samples[last]);
        // What is not finite is a key.
        if away <= tolerance {
            worst = f64::max(worst, away);
        } else {
            last = k;
            keys.push(k);
        }
    }
    (keys, worst)
}

/// The largest distance of two points of the same place in two lists.
fn distance(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

fn on_a_line(samples: &[Vec<f64>], scale: f64) -> Vec<Vec<Point>> {
    samples
        .iter()
        .map(|sample| sample.iter().map(|value| Point::new(value * scale, 0.0)).collect())
        .collect()
}
