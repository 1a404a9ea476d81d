//! Matches by what is drawn: the turning of the outline together with the colours and the ink just inside.
//!
//! Two outlines with their [`Profile`]s -> the pose's parameters by row, to begin a registration with. Colours say which limb is which
//! where turning alone sees five equal ones; what is drawn inside decides the rest afterwards, so that the match is not refined further
//! here.
//!
//! 1. A dynamic program over about a hundred samples from every start (module `start`), then a finer one around the cheapest.
//! 2. The cost of pairing two samples is the difference in turning over three windows, in what is drawn at three depths, and a little of the
//!    angle between the directions of the outlines: a drawing is rather upright than turned.
//!
//! *Differences from module `pair`*: longer windows and a stronger will to even stretch, since the details of an outline that is drawn
//! again are not the same; no refit, which would pull limbs that turn to where a smooth map has them.

use super::coarse::{CoarseMatch, Form};
use super::elastic::{MismatchTable, cheapest_path};
use super::frame::Frame;
use super::monotone::CyclicMap;
use super::pair::{Pin, band_around, best_path, pinned_columns};
use super::start::cheapest_paths;
use crate::appearance::{PROFILE_CHANNELS, Profile};
use crate::math::{Point, angle};

/// Half-windows of the turning, in perimeters.
const WINDOWS: [f64; 3] = [0.008, 0.02, 0.045];
/// Costs per unit length beside that of stretch: of a radian of difference in turning at each window, of a full difference in what is drawn, of a
/// radian between the directions.
const TURNING_COST: f32 = 0.55;
const DRAWN_COST: f32 = 3.9;
const DIRECTION_COST: f32 = 0.08;
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

/// A form with what is drawn inside it.
pub(super) struct Drawn<'a> {
    pub(super) form: &'a Form,
    pub(super) profile: &'a Profile,
}

/// A candidate: the pose's parameter by row.
#[derive(Debug, Clone)]
pub(super) struct DrawnMatch {
    pub(super) parameters: Vec<f64>,
    pub(super) cost: f32,
}

/// Matches with clearly different starts, cheapest first, at most `most`; with pins the one that goes through them.
pub(super) fn match_drawn(
    frame: &Frame,
    reference: &Drawn,
    pose: &Drawn,
    pins: &[Pin],
    most: usize,
) -> Vec<DrawnMatch> {
    let by_row = |map: &CyclicMap, cost: f32| DrawnMatch {
        parameters: frame.rows.iter().map(|t| map.at(*t)).collect(),
        cost,
    };
    if !pins.is_empty() {
        let first = pins[0].row;
        let rows: Vec<f64> = around(&frame.rows, first, FINE_STRIDE);
        let columns: Vec<f64> = (pinned_columns(pins, frame.rows.len()).into_iter())
            .step_by(FINE_STRIDE)
            .collect();
        let forced = pins.iter().skip(1).map(|pin| (pin.row - first) / FINE_STRIDE).collect();
        let table = table(reference, pose, rows, columns, forced);
        let path = cheapest_path(&table, 0, &table.reachable(0));
        return path
            .map(|path| by_row(&CoarseMatch::from_path(&table, &path).map, path.cost))
            .into_iter()
            .collect();
    }
    let tables = [COARSE_STRIDE, FINE_STRIDE].map(|stride| {
        let rows = around(&frame.rows, 0, stride);
        let columns = pose.form.even_parameters(rows.len());
        table(reference, pose, rows, columns, Vec::new())
    });
    let [coarse, fine] = &tables;
    let apart = ((APART * coarse.row_count() as f64).round() as usize).max(1);
    (cheapest_paths(coarse, apart, most).iter())
        .map(|path| {
            let first = CoarseMatch::from_path(coarse, path);
            let second = best_path(fine, &band_around(fine, &first.map, REACH), START_REACH);
            let best = second.unwrap_or(first);
            by_row(&best.map, best.cost)
        })
        .collect()
}

/// Every `stride`-th of the rows from `first` on, once around.
fn around(rows: &[f64], first: usize, stride: usize) -> Vec<f64> {
    super::curve::around(rows, first, stride)
}

fn table(reference: &Drawn, pose: &Drawn, rows: Vec<f64>, columns: Vec<f64>, forced: Vec<usize>) -> MismatchTable {
    let (own, others) = (samples(reference, &rows), samples(pose, &columns));
    MismatchTable::of(rows, columns, forced, |row, column| {
        mismatch(&own[row], &others[column])
    })
}

/// What is compared at one parameter.
struct Sample {
    turning_rad: [f32; WINDOWS.len()],
    drawn: [f32; PROFILE_CHANNELS],
    direction: [f32; 2],
}

fn samples(drawn: &Drawn, parameters: &[f64]) -> Vec<Sample> {
    let curve = &drawn.form.curve;
    let sample = |&t: &f64| {
        let here = curve.at(t);
        let turning = |window: f64| angle::between(here - curve.at(t - window), curve.at(t + window) - here) as f32;
        let chord = curve.at(t + WINDOWS[0]) - curve.at(t - WINDOWS[0]);
        let direction = match chord.norm() {
            length if length > 0.0 => chord / length,
            _ => Point::zeros(),
        };
        Sample {
            turning_rad: WINDOWS.map(turning),
            drawn: drawn.profile.at(t),
            direction: [direction.x as f32, direction.y as f32],
        }
    };
    parameters.iter().map(sample).collect()
}

fn mismatch(a: &Sample, b: &Sample) -> f32 {
    let turning: f32 = (a.turning_rad.iter().zip(b.turning_rad))
        .map(|(a, b)| (a - b).abs())
        .sum();
    let [[ax, ay], [bx, by]] = [a.direction, b.direction];
    let direction = libm::atan2f(ax * by - ay * bx, ax * bx + ay * by).abs();
    TURNING_COST * turning
        + DRAWN_COST * Profile::difference(&a.drawn, &b.drawn, MOST_DIFFERENCE)
        + DIRECTION_COST * direction
}
