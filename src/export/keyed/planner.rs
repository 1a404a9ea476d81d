//! Which samples become keys.

use super::{Approximation, KeyOptions, KeyReport, SampleTiming};
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
        let keys = place_keys(&self.times, samples, tolerance);
        let is_rest = keys.indices.len() == 2 && distance(&samples[0], &samples[samples.len() - 1]) <= rest;
        if is_rest && from_first <= tolerance {
            return (vec![0], from_first);
        }
        self.report.keys += keys.indices.len();
        (keys.indices, keys.worst)
    }
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
