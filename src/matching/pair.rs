//! The match of one pose to the reference.
//!
//! 1. *Start*: coarse matches give a few candidate starts; landmarks shared by both settle the start instead.
//! 2. *Elastic*: around each candidate, the elastic match on finer samples.
//! 3. *Guided*: a stiff thin-plate spline through that match says where each point should be if the interior moved
//!    smoothly; the elastic match is made once more, drawn to those places. The candidate that is cheapest now is kept.
//! 4. *Refit*: splines of falling stiffness, each followed by moving every point to the outline's place nearest to where
//!    the spline takes it. This is what places points on featureless arcs, where turning says nothing.
//! 5. Steps are made to increase and limited, landmarks stay exactly where they are.
//!
//! Step 4 is worth a factor of three in the median error on silhouettes warped by known maps.

use super::coarse::{CoarseMatch, Form, coarse_matches};
use super::elastic::{Band, MismatchTable, cheapest_path, step_cost};
use super::monotone::{CyclicMap, limit_steps, make_increasing};
use super::thin_plate::ThinPlate;
use crate::math::{Point, angle};

/// Samples of the coarse match.
const COARSE_SAMPLES: usize = 96;
/// How many starts get a closer look.
const CANDIDATES: usize = 4;
/// Candidates whose fine cost exceeds the best by more than this factor are not guided.
const CANDIDATE_MARGIN: f32 = 1.25;
/// Guided costs within this factor and this difference count as a tie, which the smaller rotation decides: what even
/// sampling leaves between equal arms of a symmetric shape. Unlike shapes cost 0.5 and more.
const TIE_MARGIN: (f32, f32) = (1.003, 0.01);
/// Rows of a match; the elastic match uses every second, the splines every fourth.
const ROWS: usize = 512;
/// Rows between two samples of the elastic match.
const ELASTIC_STRIDE: usize = 2;
/// Rows between two control points of a spline.
pub(super) const CONTROL_STRIDE: usize = 4;
/// How far the fine match may leave the coarse one, in perimeters.
const COARSE_REACH: f64 = 0.06;
/// How far the fine start is tried around the coarse one, in columns.
const START_REACH: usize = 4;
/// How far the guided match may leave the fine one, in perimeters.
const GUIDED_REACH: f64 = 0.05;
/// Cost of a point's distance from where the spline expects it, in perimeters, relative to stretch.
const DISTANCE_COST: f32 = 30.0;
/// Stiffness of the splines, with lengths in perimeters; the first guides, the others refit.
const STIFFNESSES: [f64; 5] = [1e-3, 1e-3, 3e-4, 1e-4, 1e-5];
/// Refits with each stiffness.
const REFITS: usize = 6;
/// How far a point may move in the first refit, in perimeters; in later ones less.
const REFIT_REACH: f64 = 0.02;
/// Least and largest slope of a match: beyond, the outline would collapse or tear.
const SLOPES: (f64, f64) = (1.0 / 20.0, 20.0);

/// The reference curve with everything that does not depend on the other pose.
#[derive(Debug)]
pub(super) struct Reference<'a> {
    form: &'a Form,
    /// Parameters of the rows: increasing, not wrapped.
    pub(super) rows: Vec<f64>,
    plate: ThinPlate,
}

/// A row of the reference that a landmark sets to a parameter of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pin {
    /// Which row; a multiple of [`CONTROL_STRIDE`].
    pub(super) row: usize,
    /// The parameter on the pose, in `[0, 1)`.
    pub(super) parameter: f64,
}

/// A pose's parameter for every row of the reference.
#[derive(Debug, Clone)]
pub(super) struct PairMatch {
    /// By row: increasing, not wrapped, less than one turn.
    pub(super) parameters: Vec<f64>,
    /// By row: the difference in turning and stretch, as a cost per unit length.
    pub(super) mismatch: Vec<f64>,
    /// The elastic cost of the whole.
    pub(super) cost: f64,
}

impl<'a> Reference<'a> {
    /// Prepares `form`, with a row at each of `landmarks` (parameters in increasing order, distinct).
    pub(super) fn new(form: &'a Form, landmarks: &[f64]) -> Self {
        let rows = if landmarks.is_empty() {
            form.even_parameters(ROWS)
        } else {
            rows_through(landmarks)
        };
        let places: Vec<Point> = rows.iter().map(|t| form.curve.at(*t)).collect();
        let controls: Vec<Point> = places.iter().copied().step_by(CONTROL_STRIDE).collect();
        let plate = ThinPlate::new(&controls, &places, &STIFFNESSES);
        Self { form, rows, plate }
    }

    /// The row of the landmark at parameter `t`, which was given to [`Self::new`].
    pub(super) fn row_of(&self, t: f64) -> Option<usize> {
        self.rows
            .iter()
            .step_by(CONTROL_STRIDE)
            .position(|row| *row == t)
            .map(|index| index * CONTROL_STRIDE)
    }

    /// Matches `pose`. `pins` are in order of their rows, and their parameters in cyclic order.
    pub(super) fn match_pose(&self, pose: &Form, pins: &[Pin]) -> Option<PairMatch> {
        let mut candidates = if pins.is_empty() {
            self.candidates(pose)
        } else {
            vec![self.through_pins(pose, pins)?]
        };
        let least = candidates.iter().map(|c| c.cost).fold(f32::INFINITY, f32::min);
        candidates.retain(|c| c.cost <= CANDIDATE_MARGIN * least);
        let guided: Vec<CoarseMatch> = candidates
            .into_iter()
            .map(|candidate| self.guided(pose, pins, candidate))
            .collect();
        let chosen = self.choose(pose, guided)?;
        let parameters = self.refit(pose, pins, &chosen.map);
        Some(self.measured(pose, parameters))
    }

    /// Fine matches around the best coarse ones.
    fn candidates(&self, pose: &Form) -> Vec<CoarseMatch> {
        let coarse = coarse_matches(self.form, pose, COARSE_SAMPLES, CANDIDATES);
        let rows: Vec<f64> = self.rows.iter().copied().step_by(ELASTIC_STRIDE).collect();
        let columns = pose.even_parameters(rows.len());
        let table = MismatchTable::new(&self.form.curve, rows, &pose.curve, columns, Vec::new());
        coarse
            .into_iter()
            .map(|candidate| {
                let band = band_around(&table, &candidate.map, COARSE_REACH);
                let start = (band[0].0 + band[0].1) / 2;
                (start.saturating_sub(START_REACH)..=start + START_REACH)
                    .filter_map(|start| cheapest_path(&table, start, &band))
                    .reduce(|a, b| if b.cost < a.cost { b } else { a })
                    .map_or(candidate, |path| CoarseMatch::from_path(&table, &path))
            })
            .collect()
    }

    /// The match through all pins: each arc between two pins is sampled with equal counts on both curves.
    fn through_pins(&self, pose: &Form, pins: &[Pin]) -> Option<CoarseMatch> {
        let table = self.pinned_table(pose, pins);
        let path = cheapest_path(&table, 0, &table.reachable(0))?;
        Some(CoarseMatch::from_path(&table, &path))
    }

    fn pinned_table(&self, pose: &Form, pins: &[Pin]) -> MismatchTable {
        let first_row = pins[0].row;
        let count = self.rows.len();
        let row_at = |k: usize| self.rows[(first_row + k) % count] + ((first_row + k) / count) as f64;
        let mut columns = vec![0.0; count];
        for (index, pin) in pins.iter().enumerate() {
            let begin = pin.row - first_row;
            let (end, closing) = match pins.get(index + 1) {
                Some(next) => (next.row - first_row, next.parameter),
                None => (count, pins[0].parameter),
            };
            // One pin alone spans the whole turn.
            let gap = (closing - pin.parameter).rem_euclid(1.0);
            let gap = if gap == 0.0 { 1.0 } else { gap };
            let base = pins[0].parameter + (pin.parameter - pins[0].parameter).rem_euclid(1.0);
            for (k, column) in columns.iter_mut().enumerate().take(end).skip(begin) {
                *column = base + gap * (k - begin) as f64 / (end - begin) as f64;
            }
        }
        let every_second = |values: Vec<f64>| values.into_iter().step_by(ELASTIC_STRIDE).collect::<Vec<f64>>();
        let rows = every_second((0..count).map(row_at).collect());
        let forced = pins[1..]
            .iter()
            .map(|pin| (pin.row - first_row) / ELASTIC_STRIDE)
            .collect();
        MismatchTable::new(&self.form.curve, rows, &pose.curve, every_second(columns), forced)
    }

    /// The elastic match again, drawn to where a stiff spline through `candidate` takes the reference.
    fn guided(&self, pose: &Form, pins: &[Pin], candidate: CoarseMatch) -> CoarseMatch {
        let current: Vec<f64> = self.rows.iter().map(|t| candidate.map.at(*t)).collect();
        let Some(expected) = self.carried(pose, 0, &current) else {
            return candidate;
        };
        let first_row = pins.first().map_or(0, |pin| pin.row);
        let expected: Vec<Point> = (0..self.rows.len())
            .step_by(ELASTIC_STRIDE)
            .map(|k| expected[(first_row + k) % self.rows.len()])
            .collect();
        let (table, starts) = if pins.is_empty() {
            let rows: Vec<f64> = self.rows.iter().copied().step_by(ELASTIC_STRIDE).collect();
            let columns = pose.even_parameters(rows.len());
            let table = MismatchTable::new(&self.form.curve, rows, &pose.curve, columns, Vec::new());
            (table, START_REACH)
        } else {
            (self.pinned_table(pose, pins), 0)
        };
        let table = table.drawn_to(&expected, &pose.curve, DISTANCE_COST);
        let band = if pins.is_empty() {
            band_around(&table, &candidate.map, GUIDED_REACH)
        } else {
            table.reachable(0)
        };
        let middle = if pins.is_empty() {
            (band[0].0 + band[0].1) / 2
        } else {
            0
        };
        (middle.saturating_sub(starts)..=middle + starts)
            .filter_map(|start| cheapest_path(&table, start, &band))
            .reduce(|a, b| if b.cost < a.cost { b } else { a })
            .map_or(candidate, |path| CoarseMatch::from_path(&table, &path))
    }

    /// The cheapest match; among those that cost nearly the same, the one that turns the drawing least.
    ///
    /// Only a shape with rotational symmetry has such ties, so that turning a drawing changes nothing for any other.
    fn choose(&self, pose: &Form, candidates: Vec<CoarseMatch>) -> Option<CoarseMatch> {
        let least = candidates.iter().map(|c| c.cost).fold(f32::INFINITY, f32::min);
        candidates
            .into_iter()
            .filter(|c| c.cost <= TIE_MARGIN.0 * least + TIE_MARGIN.1)
            .min_by(|a, b| self.rotation(pose, a).total_cmp(&self.rotation(pose, b)))
    }

    /// The absolute angle of the best-fitting rotation of the match, in radians.
    fn rotation(&self, pose: &Form, candidate: &CoarseMatch) -> f64 {
        let mut sum = Point::zeros();
        for t in self.rows.iter().step_by(CONTROL_STRIDE) {
            let (a, b) = (self.form.curve.at(*t), pose.curve.at(candidate.map.at(*t)));
            sum += Point::new(a.dot(&b), crate::math::point::cross(a, b));
        }
        angle::between(Point::new(1.0, 0.0), sum).abs()
    }

    /// Where the spline number `level` through the current match takes each row's point.
    fn carried(&self, pose: &Form, level: usize, parameters: &[f64]) -> Option<Vec<Point>> {
        let targets: Vec<Point> = parameters
            .iter()
            .step_by(CONTROL_STRIDE)
            .map(|t| pose.curve.at(*t))
            .collect();
        self.plate.carry(level, &targets)
    }

    fn refit(&self, pose: &Form, pins: &[Pin], map: &CyclicMap) -> Vec<f64> {
        let count = self.rows.len();
        let mut parameters: Vec<f64> = self.rows.iter().map(|t| map.at(*t)).collect();
        let least_step = SLOPES.0 / count as f64;
        for level in 1..STIFFNESSES.len() {
            for _ in 0..REFITS {
                let Some(expected) = self.carried(pose, level, &parameters) else {
                    break;
                };
                for (t, p) in parameters.iter_mut().zip(expected) {
                    *t = pose.curve.nearest_within(p, *t, REFIT_REACH / level as f64);
                }
                settle(&mut parameters, pins, |values, pinned| {
                    make_increasing(values, pinned, least_step)
                });
            }
        }
        settle(&mut parameters, pins, |values, pinned| {
            limit_steps(values, pinned, SLOPES.1 / count as f64);
        });
        parameters
    }

    fn measured(&self, pose: &Form, parameters: Vec<f64>) -> PairMatch {
        let count = self.rows.len();
        let table = |k: usize| (self.form.curve.turning(self.rows[k]), pose.curve.turning(parameters[k]));
        let mut cost = 0.0;
        let mut mismatch = Vec::with_capacity(count);
        for k in 0..count {
            let (next, turn) = if k + 1 == count { (0, 1.0) } else { (k + 1, 0.0) };
            let ds1 = self.rows[next] + turn - self.rows[k];
            let ds2 = parameters[next] + turn - parameters[k];
            let (a, b) = table(k);
            let turning: f64 = a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum();
            let own = step_cost(turning, ds1, ds2);
            mismatch.push(own / (0.5 * (ds1 + ds2)));
            cost += own;
        }
        PairMatch {
            parameters,
            mismatch,
            cost,
        }
    }
}

/// Runs `change` on the parameters cut open at a pinned row, or, without pins, where they increase most freely.
fn settle(parameters: &mut [f64], pins: &[Pin], change: impl Fn(&mut [f64], &[usize])) {
    let count = parameters.len();
    let step = |k: usize| {
        let next = if k + 1 == count {
            parameters[0] + 1.0
        } else {
            parameters[k + 1]
        };
        next - parameters[k]
    };
    let cut = match pins.first() {
        Some(pin) => pin.row,
        None => (0..count)
            .max_by(|a, b| {
                let freedom = |k: usize| step(k).min(step((k + count - 1) % count));
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
            parameters[row] = parameters[0] + (pin.parameter - first.parameter).rem_euclid(1.0);
            pinned.push(row);
        }
    }
    change(parameters, &pinned);
    for t in &mut parameters[count - cut..] {
        *t -= 1.0;
    }
    parameters.rotate_right(cut);
}

/// At least [`ROWS`] parameters with one at each landmark, every arc between two holding a multiple of
/// [`CONTROL_STRIDE`].
fn rows_through(landmarks: &[f64]) -> Vec<f64> {
    let mut rows = Vec::with_capacity(ROWS + CONTROL_STRIDE * landmarks.len());
    for (index, &begin) in landmarks.iter().enumerate() {
        let end = match landmarks.get(index + 1) {
            Some(next) => *next,
            None => landmarks[0] + 1.0,
        };
        let share = (ROWS / CONTROL_STRIDE) as f64 * (end - begin);
        let count = CONTROL_STRIDE * (share.ceil() as usize).max(1);
        rows.extend((0..count).map(|k| begin + (end - begin) * k as f64 / count as f64));
    }
    rows
}

/// The columns within `reach` perimeters of `map`, moved ahead by whole turns until none is negative.
fn band_around(table: &MismatchTable, map: &CyclicMap, reach: f64) -> Band {
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
