//! Matches by what is drawn: the turning of the outline together with the colours and the ink just inside.
//!
//! Two outlines with their [`Profile`]s -> the pose's parameters by row, to begin a registration with. Colours say which limb is which
//! where turning alone sees five equal ones; what is drawn inside decides the rest afterwards, so that the match is not refined further
//! here.
//!
//! 1. A dynamic program over about a hundred samples from every start (module `start`), then a finer one around the cheapest.
//!    One candidate more is the cheapest match that hardly turns the drawing: an ellipse squashed from tall to wide is the same ellipse turned,
//!    and it takes what is drawn inside, or the habit of animators, to tell.
//! 2. The cost of pairing two samples is the difference in turning over three windows, in what is drawn at three depths, and a little of the
//!    angle between the directions of the outlines: a drawing is rather upright than turned.
//!
//! *Differences from module `pair`*: longer windows and a stronger will to even stretch, since the details of an outline that is drawn
//! again are not the same; no refit, which would pull limbs that turn to where a smooth map has them.

use super::coarse::{CoarseMatch, Form};
use super::curve::around;
use super::elastic::{MismatchTable, cheapest_path};
use super::frame::Frame;
use super::pair::{Pin, band_around, best_path, pinned_columns};
use super::start::cheapest_paths;
use crate::appearance::{PROFILE_CHANNELS, Profile};
use crate::math::{Point, angle, rotation};
use crate::outline::parameter_gap;

/// Half-windows of the turning, in perimeters.
const WINDOWS: [f64; 3] = [0.008, 0.02, 0.045];
/// Costs per unit length beside that of stretch: of a radian of difference in turning at each window, of a full difference in what is drawn, of a
/// radian between the directions.
const TURNING_COST: f32 = 0.55;
const DRAWN_COST: f32 = 3.9;
const DIRECTION_COST: f32 = 0.08;
/// The last for the candidate that stays upright.
const UPRIGHT_COST: f32 = 0.5;
/// Differences in what is drawn count no more than this at any depth.
const MOST_DIFFERENCE: f32 = 0.6;
/// Rows between two samples of the first and of the second program.
const COARSE_STRIDE: usize = 4;
const FINE_STRIDE: usize = 2;
/// How far the second may leave the first, in perimeters, and its start, in columns.
const REACH: f64 = 0.04;
const START_REACH: usize = 6;
/// Starts nearer than this, in perimeters, are one.
const APART: f64 = 0.03;

/// A form with what is drawn inside it, if anything is.
#[derive(Clone, Copy)]
pub(super) struct Drawn<'a> {
    pub(super) form: &'a Form,
    pub(super) profile: Option<&'a Profile>,
}

/// A candidate: the pose's parameter by row.
#[derive(Debug, Clone)]
pub(super) struct DrawnMatch {
    pub(super) parameters: Vec<f64>,
    pub(super) cost: f32,
}

/// The upright match, then others with clearly different starts, cheapest first, at most `most` in all; with pins the one that goes through
/// them. Upright is a drawing that is turned by `expected_rad` from the reference.
pub(super) fn match_drawn(
    frame: &Frame,
    reference: Drawn,
    pose: Drawn,
    pins: &[Pin],
    most: usize,
    expected_rad: f64,
) -> Vec<DrawnMatch> {
    let task = Task {
        frame,
        reference,
        pose,
        expected_rad,
    };
    let found = match pins.first() {
        Some(first) => task.pinned(pins, first.row).into_iter().collect(),
        None => task.candidates(most),
    };
    let by_row = |matched: &CoarseMatch| DrawnMatch {
        parameters: frame.rows.iter().map(|t| matched.map.at(*t)).collect(),
        cost: matched.cost,
    };
    found.iter().map(by_row).collect()
}

/// Two forms to be matched.
struct Task<'a> {
    frame: &'a Frame,
    reference: Drawn<'a>,
    pose: Drawn<'a>,
    expected_rad: f64,
}

impl Task<'_> {
    /// The cheapest match through the pins, the first of which is at `first_row`.
    fn pinned(&self, pins: &[Pin], first_row: usize) -> Option<CoarseMatch> {
        let rows = around(&self.frame.rows, first_row, FINE_STRIDE);
        let columns = pinned_columns(pins, self.frame.rows.len());
        let columns = columns.into_iter().step_by(FINE_STRIDE).collect();
        let forced = pins.iter().skip(1);
        let forced = forced.map(|pin| (pin.row - first_row) / FINE_STRIDE).collect();
        let table = self.table(rows, columns, forced, DIRECTION_COST);
        let path = cheapest_path(&table, 0, &table.reachable(0))?;
        Some(CoarseMatch::from_path(&table, &path))
    }

    fn candidates(&self, most: usize) -> Vec<CoarseMatch> {
        let coarse = self.even_table(COARSE_STRIDE, UPRIGHT_COST);
        let apart = ((APART * coarse.row_count() as f64).round() as usize).max(1);
        let upright = cheapest_paths(&coarse, apart, 1);
        // Alone, the upright match is to be as upright as it can; among others it is a beginning.
        let (fine_cost, others) = if most > 1 {
            let table = self.even_table(COARSE_STRIDE, DIRECTION_COST);
            (DIRECTION_COST, cheapest_paths(&table, apart, most))
        } else {
            (UPRIGHT_COST, Vec::new())
        };
        let fine = self.even_table(FINE_STRIDE, fine_cost);
        let start = |matched: &CoarseMatch| matched.map.at(self.frame.rows[0]);
        let mut found: Vec<CoarseMatch> = Vec::new();
        for path in upright.iter().chain(&others) {
            let first = CoarseMatch::from_path(&coarse, path);
            let second = best_path(&fine, &band_around(&fine, &first.map, REACH), START_REACH);
            let best = second.unwrap_or(first);
            if (found.iter()).all(|other| parameter_gap(start(other), start(&best)) >= APART) {
                found.push(best);
            }
        }
        found.truncate(most);
        found
    }

    /// The table of every `stride`-th row with as many even samples of the pose.
    fn even_table(&self, stride: usize, direction_cost: f32) -> MismatchTable {
        let rows = around(&self.frame.rows, 0, stride);
        let columns = self.pose.form.even_parameters(rows.len());
        self.table(rows, columns, Vec::new(), direction_cost)
    }

    fn table(&self, rows: Vec<f64>, columns: Vec<f64>, forced: Vec<usize>, direction_cost: f32) -> MismatchTable {
        let own = samples(self.reference, &rows, self.expected_rad);
        let others = samples(self.pose, &columns, 0.0);
        MismatchTable::of(rows, columns, forced, |row, column| {
            mismatch(&own[row], &others[column], direction_cost)
        })
    }
}

/// What is compared at one parameter.
struct Sample {
    turning_rad: [f32; WINDOWS.len()],
    drawn: Option<[f32; PROFILE_CHANNELS]>,
    direction: [f32; 2],
}

/// The samples of a form turned by `turn_rad`.
fn samples(drawn: Drawn, parameters: &[f64], turn_rad: f64) -> Vec<Sample> {
    let curve = &drawn.form.curve;
    let turn = rotation(turn_rad);
    let sample = |&t: &f64| {
        let here = curve.at(t);
        let turning = |window: f64| angle::between(here - curve.at(t - window), curve.at(t + window) - here) as f32;
        let chord = turn * (curve.at(t + WINDOWS[0]) - curve.at(t - WINDOWS[0]));
        let direction = match chord.norm() {
            length if length > 0.0 => chord / length,
            _ => Point::zeros(),
        };
        Sample {
            turning_rad: WINDOWS.map(turning),
            drawn: drawn.profile.map(|profile| profile.at(t)),
            direction: [direction.x as f32, direction.y as f32],
        }
    };
    parameters.iter().map(sample).collect()
}

fn mismatch(a: &Sample, b: &Sample, direction_cost: f32) -> f32 {
    let turning: f32 = (a.turning_rad.iter().zip(b.turning_rad))
        .map(|(a, b)| (a - b).abs())
        .sum();
    let [[ax, ay], [bx, by]] = [a.direction, b.direction];
    let direction = libm::atan2f(ax * by - ay * bx, ax * bx + ay * by).abs();
    let drawn = match (&a.drawn, &b.drawn) {
        (Some(a), Some(b)) => Profile::difference(a, b, MOST_DIFFERENCE),
        _ => 0.0,
    };
    TURNING_COST * turning + DRAWN_COST * drawn + direction_cost * direction
}
