//! The match of one pose to a model: the reference, or all other poses on common rows.
//!
//! 1. *Start*: coarse matches give a few candidate starts, to which comes the match so far, if there is one; landmarks
//!    settle the start instead.
//! 2. *Elastic*: around each candidate, the elastic match on finer samples.
//! 3. *Guided*: a stiff thin-plate spline through that match says where each point should be if the interior moved
//!    smoothly; the elastic match is made once more, drawn to those places. The candidate that is cheapest now is kept.
//! 4. *Refit*: splines of falling stiffness, each followed by moving every point to the outline's place nearest to where
//!    the spline takes it. This is what places points on featureless arcs, where turning says nothing.
//! 5. Steps are made to increase and limited, landmarks stay exactly where they are.
//!
//! Step 4 is worth a factor of three in the median error on silhouettes warped by known maps.

use rayon::prelude::*;

use super::coarse::{CoarseMatch, Form, coarse_matches_to};
use super::curve::Samples;
use super::elastic::{Band, MismatchTable, cheapest_path, cheapest_start, step_cost};
use super::frame::{CONTROL_STRIDE, Frame, Model, ModelCurve, RowSamples, STIFFNESSES};
use super::monotone::{CyclicMap, limit_steps, make_increasing};
use crate::math::{Point, angle, wrapped};

/// How many starts get a closer look.
const CANDIDATES: usize = 4;
/// Below this cost candidates differ by sampling alone: of the equal arms of a symmetric shape, one that the samples happen
/// to meet costs 0, and the others up to 0.2. Unlike shapes cost 0.5 and more.
const SAMPLING_COST: f32 = 0.25;
/// Candidates whose fine cost exceeds the best by more than this factor are not guided.
const CANDIDATE_MARGIN: f32 = 1.25;
/// Guided costs within this factor and this difference count as a tie, which the smaller rotation decides: what even
/// sampling leaves between nearly equal arms.
const TIE_MARGIN: (f32, f32) = (1.003, 0.01);
/// What a radian of rotation of the whole drawing costs, as much as an elastic difference: between drawings of a thing that was squashed from tall
/// to wide there is half of this or less, between those of an animal in two postures more than three times as much.
const TURN_COST: f64 = 0.3;
/// Below this cost drawings are alike by a match: the elastic cost of a thing and the same thing squashed.
const ALIKE_COST: f32 = 0.45;
/// A match is taken for staying upright if it turns the drawing by so much less than the cheapest, in radians.
const UPRIGHT_RAD: f64 = 0.35;
/// Rows between two samples of the elastic match.
const ELASTIC_STRIDE: usize = 2;
/// How far the fine match may leave the coarse one, in perimeters.
const COARSE_REACH: f64 = 0.06;
/// How far the fine start is tried around the coarse one, in columns.
const START_REACH: usize = 4;
/// How far the guided match may leave the fine one, in perimeters.
const GUIDED_REACH: f64 = 0.05;
/// Cost of a point's distance from where the spline expects it, in perimeters, relative to stretch.
const DISTANCE_COST: f32 = 30.0;
/// Refits with each stiffness.
const REFITS: usize = 6;
/// Rows that are moved by one task at least.
const ROWS_A_TASK: usize = 128;
/// How far a point may move in the first refit, in perimeters; in later ones less.
const REFIT_REACH: f64 = 0.01;
/// Least and largest slope of a match: beyond, the outline would collapse or tear.
const SLOPES: (f64, f64) = (1.0 / 20.0, 20.0);

/// A row that a landmark sets to a parameter of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pin {
    /// Which row; a multiple of [`CONTROL_STRIDE`].
    pub(super) row: usize,
    /// The parameter on the pose, in `[0, 1)`.
    pub(super) parameter: f64,
}

/// A pose's parameter for every row.
#[derive(Debug, Clone)]
pub(super) struct PairMatch {
    /// By row: increasing, not wrapped, less than one turn.
    pub(super) parameters: Vec<f64>,
    /// The pose there.
    pub(super) measured: RowSamples,
    /// By row: the difference in turning and stretch from the model, as a cost per unit length.
    pub(super) mismatch: Vec<f64>,
    /// The elastic cost of the whole.
    pub(super) cost: f64,
}

/// Matches `pose` to `model`, whose rows are those of `frame`. `pins` are in order of their rows, and their parameters in
/// cyclic order.
pub(super) fn match_pose(
    frame: &Frame,
    model: &Model,
    pose: &Form,
    pins: &[Pin],
    known: Known,
    expected_rad: f64,
) -> Option<PairMatch> {
    let task = Task {
        frame,
        model,
        pose,
        pins,
        expected_rad,
    };
    let table = task.table();
    let mut candidates = if pins.is_empty() {
        task.candidates(&table, known)
    } else {
        let path = cheapest_path(&table, 0, &table.reachable(0))?;
        vec![CoarseMatch::from_path(&table, &path)]
    };
    let cheapest = candidates.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let (least, most_turned) = (cheapest.cost, task.rotation(cheapest));
    let upright = |c: &CoarseMatch| least + (TURN_COST * (most_turned - task.rotation(c)).max(0.0)) as f32;
    candidates.retain(|c| c.cost <= (CANDIDATE_MARGIN * least).max(SAMPLING_COST).max(upright(c)));
    let guided: Vec<CoarseMatch> = candidates
        .into_iter()
        .map(|candidate| task.guided(&table, candidate))
        .collect();
    let turned = guided.clone();
    let chosen = task.choose(guided)?;
    // A match that was taken for staying upright, not for its turning, does not follow the turning any further.
    let cheapest = turned.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let keeps_upright = task.rotation(cheapest) - task.rotation(&chosen) > UPRIGHT_RAD;
    let map = match known {
        Known::Upright(parameters) if keeps_upright => CyclicMap::through(model.rows.clone(), parameters.to_vec()),
        _ => chosen.map,
    };
    Some(measured(model, pose, task.refit(&map)))
}

/// A match that is known before, by the pose's parameters.
#[derive(Debug, Clone, Copy)]
pub(super) enum Known<'a> {
    Nothing,
    /// To be improved.
    Current(&'a [f64]),
    /// The one that turns the drawing least.
    Upright(&'a [f64]),
}

impl<'a> Known<'a> {
    fn parameters(self) -> Option<&'a [f64]> {
        match self {
            Self::Nothing => None,
            Self::Current(parameters) | Self::Upright(parameters) => Some(parameters),
        }
    }
}

/// One pose, what it is compared with, and the landmarks it has to go through.
struct Task<'a> {
    frame: &'a Frame,
    model: &'a Model<'a>,
    pose: &'a Form,
    pins: &'a [Pin],
    /// By how much the drawing is expected to be turned.
    expected_rad: f64,
}

impl Task<'_> {
    /// The table of the fine match. With pins it begins at the first, and each arc between two of them is sampled with
    /// equal counts on the model and the pose.
    fn table(&self) -> MismatchTable {
        let first_row = self.pins.first().map_or(0, |pin| pin.row);
        let (rows, curves) = self.model.samples(first_row, ELASTIC_STRIDE);
        if self.pins.is_empty() {
            let columns = self.pose.even_parameters(rows.len());
            return MismatchTable::new(rows, &curves, Samples::fine(&self.pose.curve, columns));
        }
        let columns = pinned_columns(self.pins, self.frame.rows.len());
        let columns = columns.into_iter().step_by(ELASTIC_STRIDE).collect();
        let forced = self.pins.iter().skip(1);
        let forced = forced.map(|pin| (pin.row - first_row) / ELASTIC_STRIDE).collect();
        MismatchTable::pinned(rows, &curves, Samples::fine(&self.pose.curve, columns), forced)
    }

    /// Fine matches around the best coarse ones and around the current one.
    fn candidates(&self, table: &MismatchTable, known: Known) -> Vec<CoarseMatch> {
        let (rows, curves) = self.model.coarse_samples();
        let columns = self.pose.even_samples(rows.len());
        let mut coarse = coarse_matches_to(rows, &curves, &columns, CANDIDATES);
        coarse.extend(known.parameters().map(|parameters| CoarseMatch {
            map: CyclicMap::through(self.model.rows.clone(), parameters.to_vec()),
            cost: f32::INFINITY,
        }));
        coarse
            .into_iter()
            .map(|candidate| {
                let band = band_around(table, &candidate.map, COARSE_REACH);
                best_path(table, &band, START_REACH).unwrap_or(candidate)
            })
            .collect()
    }

    /// The elastic match again, drawn to where a stiff spline through `candidate` takes the reference.
    fn guided(&self, table: &MismatchTable, candidate: CoarseMatch) -> CoarseMatch {
        let current: Vec<f64> = self.model.rows.iter().map(|t| candidate.map.at(*t)).collect();
        let Some(expected) = self.carried(0, &current) else {
            return candidate;
        };
        let (count, first_row) = (expected.len(), self.pins.first().map_or(0, |pin| pin.row));
        let expected: Vec<Point> = (0..count)
            .step_by(ELASTIC_STRIDE)
            .map(|k| expected[(first_row + k) % count])
            .collect();
        let table = table.clone().drawn_to(&expected, &self.pose.curve, DISTANCE_COST);
        let path = if self.pins.is_empty() {
            best_path(&table, &band_around(&table, &candidate.map, GUIDED_REACH), START_REACH)
        } else {
            let path = cheapest_path(&table, 0, &table.reachable(0));
            path.map(|path| CoarseMatch::from_path(&table, &path))
        };
        path.unwrap_or(candidate)
    }

    /// The cheapest match; among those that cost nearly the same, the one that turns the drawing least from what is expected. One that costs
    /// more is taken instead if the drawings are alike by it, too, and it turns them so much less that this is worth more.
    ///
    /// Only a shape that is nearly symmetric under a rotation has such ties, so that turning a drawing changes nothing for any other.
    fn choose(&self, candidates: Vec<CoarseMatch>) -> Option<CoarseMatch> {
        let least = candidates.iter().map(|c| c.cost).fold(f32::INFINITY, f32::min);
        let ties = (TIE_MARGIN.0 * least + TIE_MARGIN.1).max(SAMPLING_COST);
        let total = |candidate: &CoarseMatch| {
            let cost = if candidate.cost <= ties { least } else { candidate.cost };
            f64::from(cost) + TURN_COST * self.rotation(candidate)
        };
        candidates
            .into_iter()
            .filter(|candidate| candidate.cost <= ties.max(ALIKE_COST))
            .min_by(|a, b| total(a).total_cmp(&total(b)))
    }

    /// The absolute angle, in radians, between the best-fitting rotation of the match from the model's first curve and what is expected.
    fn rotation(&self, candidate: &CoarseMatch) -> f64 {
        let Some(ModelCurve { form, parameters, .. }) = self.model.curves.first() else {
            return 0.0;
        };
        let own: Vec<f64> = self.model.rows.iter().map(|row| candidate.map.at(*row)).collect();
        angle::wrap(turn_rad(form, parameters, self.pose, &own) - self.expected_rad).abs()
    }

    /// Where the spline number `level` through the current match takes each row's point.
    fn carried(&self, level: usize, parameters: &[f64]) -> Option<Vec<Point>> {
        let targets: Vec<Point> = parameters
            .iter()
            .step_by(CONTROL_STRIDE)
            .map(|t| self.pose.curve.at(*t))
            .collect();
        self.frame.plate.carry(level, &targets)
    }

    fn refit(&self, map: &CyclicMap) -> Vec<f64> {
        let mut parameters: Vec<f64> = self.model.rows.iter().map(|t| map.at(*t)).collect();
        for level in 1..STIFFNESSES.len() {
            for _ in 0..REFITS {
                let Some(expected) = self.carried(level, &parameters) else {
                    break;
                };
                let reach = REFIT_REACH / level as f64;
                let moved = parameters.par_iter_mut().with_min_len(ROWS_A_TASK).zip(expected);
                moved.for_each(|(t, p)| *t = self.pose.curve.nearest_within(p, *t, reach));
                increasing(&mut parameters, self.pins);
            }
        }
        limited(&mut parameters, self.pins);
        parameters
    }
}

/// The angle of the best-fitting rotation from one form to another, in radians, by corresponding parameters.
pub(super) fn turn_rad(reference: &Form, rows: &[f64], pose: &Form, parameters: &[f64]) -> f64 {
    let pairs = rows.iter().zip(parameters).step_by(CONTROL_STRIDE);
    let sum: Point = pairs
        .map(|(t, own)| {
            let (a, b) = (reference.curve.at(*t), pose.curve.at(*own));
            Point::new(a.dot(&b), crate::math::point::cross(a, b))
        })
        .sum();
    angle::between(Point::new(1.0, 0.0), sum)
}

/// A match with its costs and mismatches.
pub(super) fn measured(model: &Model, pose: &Form, parameters: Vec<f64>) -> PairMatch {
    let count = parameters.len();
    let measured = RowSamples::new(pose, parameters.clone());
    let own = &measured.fine;
    let curves = model.curves.iter().map(|curve| &curve.measured.fine);
    let mut cost = 0.0;
    let mut mismatch = vec![0.0; count];
    for curve in curves.clone() {
        for (k, density) in mismatch.iter_mut().enumerate() {
            let (ds1, ds2) = (step_after(&curve.parameters, k), step_after(&own.parameters, k));
            let windows = curve.turning.iter().zip(&own.turning);
            let turning: f64 = windows.map(|(a, b)| f64::from((a[k] - b[k]).abs())).sum();
            let part = step_cost(turning, ds1, ds2) / curves.len() as f64;
            *density += part / (0.5 * (ds1 + ds2));
            cost += part;
        }
    }
    PairMatch {
        parameters,
        measured,
        mismatch,
        cost,
    }
}

/// By row from the first pin's on, the parameter of the pose in even steps between pins; there is one at least.
pub(super) fn pinned_columns(pins: &[Pin], count: usize) -> Vec<f64> {
    let mut columns = vec![0.0; count];
    for (index, pin) in pins.iter().enumerate() {
        let begin = pin.row - pins[0].row;
        let (end, closing) = match pins.get(index + 1) {
            Some(next) => (next.row - pins[0].row, next.parameter),
            None => (count, pins[0].parameter),
        };
        // One pin alone spans the whole turn.
        let gap = wrapped(closing - pin.parameter);
        let gap = if gap == 0.0 { 1.0 } else { gap };
        let base = pins[0].parameter + wrapped(pin.parameter - pins[0].parameter);
        for (k, column) in columns.iter_mut().enumerate().take(end).skip(begin) {
            *column = base + gap * (k - begin) as f64 / (end - begin) as f64;
        }
    }
    columns
}

/// The cheapest match within a band, starting within `reach` columns of the middle of its first row.
pub(super) fn best_path(table: &MismatchTable, band: &[(usize, usize)], reach: usize) -> Option<CoarseMatch> {
    let middle = (band[0].0 + band[0].1) / 2;
    let start = cheapest_start(table, middle.saturating_sub(reach)..=middle + reach, band)?;
    cheapest_path(table, start, band).map(|path| CoarseMatch::from_path(table, &path))
}

/// From parameter `k` of a closed curve to the next, the first following the last.
fn step_after(parameters: &[f64], k: usize) -> f64 {
    let next = match parameters.get(k + 1) {
        Some(next) => *next,
        None => parameters[0] + 1.0,
    };
    next - parameters[k]
}

/// Makes the parameters increase from row to row, by at least a twentieth of an even step.
pub(super) fn increasing(parameters: &mut [f64], pins: &[Pin]) {
    let least_step = SLOPES.0 / parameters.len() as f64;
    settle(parameters, pins, |values, pinned| {
        make_increasing(values, pinned, least_step)
    });
}

/// Spreads steps of more than twenty even ones.
pub(super) fn limited(parameters: &mut [f64], pins: &[Pin]) {
    let largest_step = SLOPES.1 / parameters.len() as f64;
    settle(parameters, pins, |values, pinned| {
        limit_steps(values, pinned, largest_step)
    });
}

/// Runs `change` on the parameters cut open at a pinned row, or, without pins, where they increase most freely.
fn settle(parameters: &mut [f64], pins: &[Pin], change: impl Fn(&mut [f64], &[usize])) {
    let count = parameters.len();
    let cut = match pins.first() {
        Some(pin) => pin.row,
        None => (0..count)
            .max_by(|a, b| {
                let freedom = |k: usize| step_after(parameters, k).min(step_after(parameters, (k + count - 1) % count));
                freedom(*a).total_cmp(&freedom(*b))
            })
            .unwrap_or(0),
    };
    parameters.rotate_left(cut);
    for t in &mut parameters[count - cut..] {
        *t += 1.0;
    }
    let mut pinned = vec![0];
    if let Some((first, others)) = pins.split_first() {
        parameters[0] = first.parameter + (parameters[0] - first.parameter).round();
        for pin in others {
            let row = pin.row - cut;
            parameters[row] = parameters[0] + wrapped(pin.parameter - first.parameter);
            pinned.push(row);
        }
    }
    change(parameters, &pinned);
    for t in &mut parameters[count - cut..] {
        *t -= 1.0;
    }
    parameters.rotate_right(cut);
}

/// The columns within `reach` perimeters of `map`, moved ahead by whole turns until none is negative.
pub(super) fn band_around(table: &MismatchTable, map: &CyclicMap, reach: f64) -> Band {
    let columns = table.column_count() as f64;
    let origin = table.column_parameter(0);
    let position = |row: usize| (map.at(table.row_parameter(row)) - origin) * columns;
    let ahead = ((reach - position(0) / columns).ceil() + 1e-9).floor() * columns;
    (0..=table.row_count())
        .map(|row| {
            let centre = position(row) + ahead;
            let reach = reach * columns;
            ((centre - reach).max(0.0) as usize, (centre + reach).ceil() as usize)
        })
        .collect()
}
