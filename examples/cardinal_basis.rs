//! The cardinal basis of Shape by Example in one dimension, after its Figures 2 and 3.
//!
//! `cargo run --release --example cardinal_basis -- FOLDER` writes `cardinal-basis.png` there, two plots of the space from 0 to 1
//! with three examples, at 0.15, 0.30 and 0.75:
//!
//! - to the left what the first basis function is made of: the line that fits best through (0.15, 1), (0.30, 0), (0.75, 0), in grey, and
//!   a spline about each example, in the example's colour, scaled so that their sum makes good what the line misses;
//! - to the right the three basis functions, each 1 at its example and 0 at the others, and in black a coordinate that is
//!   0.9, 1.4 and 0.6 in the three examples.

pub(crate) mod common;

use std::error::Error;
use std::path::PathBuf;

use inbetween::export::png_bytes;
use inbetween::math::Point;
use inbetween::weights::{RbfOptions, RbfWeights, WeightProvider};
use nalgebra::{Matrix3, Vector3};
use tiny_skia::Color;

use common::{Sheet, outline_of};

/// Where the examples are.
const PLACES: [f64; 3] = [0.15, 0.30, 0.75];
/// The coordinate that is blended, in each example.
const COORDINATE: [f64; 3] = [0.9, 1.4, 0.6];
/// Columns and rows of one plot, and of the space around it, in pixels.
const PLOT: [f64; 2] = [420.0, 320.0];
const MARGIN: f64 = 24.0;
/// What is shown of the values.
const VALUES: [f64; 2] = [-0.8, 1.6];
const COLOURS: [[u8; 3]; 3] = [[38, 84, 168], [196, 72, 48], [46, 134, 84]];
const GREY: [u8; 3] = [120, 120, 120];
const LIGHT: [u8; 3] = [222, 222, 222];
const BLACK: [u8; 3] = [20, 20, 20];
/// Points of a curve.
const STEPS: usize = 420;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: cardinal_basis FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let places = PLACES.map(|x| vec![x]);
    let basis = RbfWeights::new(&places, &RbfOptions::default())?;
    let parts = Parts::of_the_first()?;
    let weights = |x: f64| basis.weights_at(&[x]);
    // The two ways to the first basis function.
    for k in 0..=20 {
        let x = f64::from(k) / 20.0;
        let sum = parts.line(x) + (0..3).map(|k| parts.spline(k, x)).sum::<f64>();
        if (sum - weights(x)?[0]).abs() > 1e-12 {
            return Err(format!("at {x} the parts sum to {sum}, not {}", weights(x)?[0]).into());
        }
    }
    let mut left = Plot::new()?;
    left.curve(|x| Ok(parts.line(x)), GREY, 2.0)?;
    for (k, colour) in COLOURS.into_iter().enumerate() {
        left.curve(|x| Ok(parts.spline(k, x)), colour, 2.0)?;
    }
    left.examples([1.0, 0.0, 0.0]);
    let mut right = Plot::new()?;
    for (k, colour) in COLOURS.into_iter().enumerate() {
        right.curve(|x| Ok(weights(x)?[k]), colour, 2.0)?;
    }
    let blended = |x: f64| Ok(weights(x)?.iter().zip(COORDINATE).map(|(w, value)| w * value).sum());
    right.curve(blended, BLACK, 2.6)?;
    right.examples(COORDINATE);
    let [columns, rows] = Plot::size();
    let mut sheet = Sheet::new([2 * columns, rows])?;
    for (plot, left) in [(left, 0), (right, columns)] {
        sheet.paste([left, 0], &plot.sheet.into_frame())?;
    }
    std::fs::write(folder.join("cardinal-basis.png"), png_bytes(&sheet.into_frame())?)?;
    Ok(())
}

/// What a basis function is the sum of, found as the paper says and apart from the library's weights.
struct Parts {
    slope: f64,
    at_zero: f64,
    radii: [f64; 3],
    coefficients: [f64; 3],
}

impl Parts {
    fn of_the_first() -> Result<Self, Box<dyn Error>> {
        let (places, wanted) = (Vector3::from(PLACES), Vector3::new(1.0, 0.0, 0.0));
        // The least squares of a line go through both means.
        let deviations = places.add_scalar(-places.mean());
        let slope = deviations.dot(&wanted) / deviations.norm_squared();
        let mut parts = Self {
            slope,
            at_zero: wanted.mean() - slope * places.mean(),
            // The distance to the nearest other example.
            radii: [0.15, 0.15, 0.45],
            coefficients: [1.0; 3],
        };
        let system = Matrix3::from_fn(|row, column| parts.spline(column, PLACES[row]));
        let left_over = wanted - places.map(|x| parts.line(x));
        let solution = system.lu().solve(&left_over).ok_or("the splines are not independent")?;
        parts.coefficients = solution.into();
        Ok(parts)
    }

    fn line(&self, x: f64) -> f64 {
        self.slope * x + self.at_zero
    }

    /// The cubic B-spline about example `k`, times its coefficient.
    fn spline(&self, k: usize, x: f64) -> f64 {
        let t = (x - PLACES[k]).abs() / self.radii[k];
        let value = match t {
            t if t < 1.0 => 2.0 / 3.0 - t * t + 0.5 * t * t * t,
            t if t < 2.0 => (2.0 - t).powi(3) / 6.0,
            _ => 0.0,
        };
        self.coefficients[k] * value
    }
}

/// Curves over the space.
struct Plot {
    sheet: Sheet,
}

impl Plot {
    /// A plot with an edge, and lines at the values 0 and 1 and at the examples.
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut plot = Self {
            sheet: Sheet::new(Self::size())?,
        };
        for x in PLACES {
            plot.line(VALUES.map(|value| [x, value]), LIGHT);
        }
        for (value, colour) in [(1.0, LIGHT), (0.0, GREY)] {
            plot.line([[0.0, value], [1.0, value]], colour);
        }
        let [low, high] = VALUES;
        let corners = [[0.0, low], [1.0, low], [1.0, high], [0.0, high]].map(point);
        plot.sheet.line(&outline_of(&corners, true), 1.0, ink(GREY));
        Ok(plot)
    }

    fn size() -> [u32; 2] {
        PLOT.map(|pixels| (pixels + 2.0 * MARGIN) as u32)
    }

    fn line(&mut self, ends: [[f64; 2]; 2], colour: [u8; 3]) {
        self.sheet.line(&outline_of(&ends.map(point), false), 1.0, ink(colour));
    }

    fn curve(
        &mut self,
        value: impl Fn(f64) -> Result<f64, Box<dyn Error>>,
        colour: [u8; 3],
        width: f32,
    ) -> Result<(), Box<dyn Error>> {
        let points = (0..=STEPS).map(|k| {
            let x = k as f64 / STEPS as f64;
            Ok(point([x, value(x)?]))
        });
        let points: Result<Vec<Point>, Box<dyn Error>> = points.collect();
        self.sheet.line(&outline_of(&points?, false), width, ink(colour));
        Ok(())
    }

    /// A dot in each example's colour.
    fn examples(&mut self, values: [f64; 3]) {
        for ((x, value), colour) in PLACES.into_iter().zip(values).zip(COLOURS) {
            self.sheet.dot(point([x, value]), 4.5, ink(colour));
        }
    }
}

/// The pixel of a place and a value.
fn point([x, value]: [f64; 2]) -> Point {
    let [low, high] = VALUES;
    let up = (value - low) / (high - low);
    Point::new(MARGIN + x * PLOT[0], MARGIN + (1.0 - up) * PLOT[1])
}

fn ink([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgba8(r, g, b, 255)
}
