//! How much two sampled curves differ, by pairs of samples: what a path leads through.

use std::ops::Range;

use super::{Band, LARGEST_SLOPE, TURNING_COST};
use crate::matching::curve::{Curve, Samples};
use crate::math::Point;

/// Turns of columns that a path may lie in: it starts in the first or early in the second and runs for one.
pub(super) const TURNS: usize = 3;

/// Two sampled curves and how much their samples differ.
#[derive(Debug, Clone)]
pub(in super::super) struct MismatchTable {
    /// Parameters of the first curve's samples: increasing, not wrapped, less than one turn.
    rows: Vec<f64>,
    /// Parameters of the second curve's samples, likewise.
    columns: Vec<f64>,
    /// Mismatch by row and column, in cost per unit length.
    values: Vec<f32>,
    /// By row, the columns that have one.
    windows: Vec<Window>,
    /// Rows that are matched to the column of the same number.
    pub(super) forced: Vec<usize>,
    /// Entry `[a][i]`: the length of the step of `a` rows that ends at row `i`, counted cyclically.
    pub(super) row_lengths: [Vec<f32>; LARGEST_SLOPE + 1],
    pub(super) column_lengths: ColumnLengths,
}

/// The columns of a row that are compared, counted on past the first turn, and where the first one's mismatch is.
#[derive(Debug, Clone)]
struct Window {
    columns: Range<usize>,
    begin: usize,
}

impl Window {
    /// Its mismatches among those of all rows.
    fn of<'a>(&self, values: &'a [f32]) -> &'a [f32] {
        &values[self.begin..self.begin + self.columns.len()]
    }
}

/// How long steps of columns are.
#[derive(Debug, Clone)]
pub(super) enum ColumnLengths {
    /// Entry `b`: of `b` columns, wherever they are.
    Even([f32; LARGEST_SLOPE + 1]),
    /// Entry `[b][j]`: of `b` columns that end at column `j`, for [`TURNS`] turns.
    Uneven([Vec<f32>; LARGEST_SLOPE + 1]),
}

impl ColumnLengths {
    fn new(columns: &[f64]) -> Self {
        let lengths = step_lengths(columns, TURNS);
        // Equal but for rounding.
        let is_even = lengths[1]
            .iter()
            .all(|length| (length - lengths[1][0]).abs() < 1e-5 * length);
        if is_even {
            Self::Even(lengths.map(|of_step| of_step[0]))
        } else {
            Self::Uneven(lengths)
        }
    }
}

impl MismatchTable {
    /// Compares the curves of `first`, which have common rows, with `second`; the mismatch is the mean over those curves.
    /// `rows` are the parameters that stand for theirs.
    pub(in super::super) fn new(rows: Vec<f64>, first: &[Samples], second: Samples) -> Self {
        let windows = vec![0..TURNS * second.parameters.len(); rows.len()];
        let mut table = Self::empty(rows, second.parameters, Vec::new());
        table.compare(first, &second.turning, windows);
        table
    }

    /// The same for paths from `(0, 0)` alone that match the rows in `forced`, increasing and without row 0, to the column of
    /// the same number. What no such path comes near is not compared.
    pub(in super::super) fn pinned(rows: Vec<f64>, first: &[Samples], second: Samples, forced: Vec<usize>) -> Self {
        let mut table = Self::empty(rows, second.parameters, forced);
        let (band, last) = (table.reachable(0), table.row_count());
        // A step touches a row up to three before that in which it ends, and there up to three columns before.
        const BEFORE: usize = LARGEST_SLOPE - 1;
        let window = |row: usize| {
            let ends = &band[row..=(row + BEFORE).min(last)];
            let low = ends.iter().map(|end| end.0).min().unwrap_or(0);
            let high = ends.iter().map(|end| end.1).max().unwrap_or(0);
            low.saturating_sub(BEFORE)..high + 1
        };
        // Row 0 is where paths end.
        let windows = std::iter::once(last).chain(1..last).map(window).collect();
        table.compare(first, &second.turning, windows);
        table
    }

    /// The table of a mismatch given by row and column, in cost per unit length.
    pub(in super::super) fn of(
        rows: Vec<f64>,
        columns: Vec<f64>,
        forced: Vec<usize>,
        mismatch: impl Fn(usize, usize) -> f32,
    ) -> Self {
        let mut table = Self::empty(rows, columns, forced);
        let count = table.column_count();
        for row in 0..table.row_count() {
            let begin = table.values.len();
            table.values.extend((0..count).map(|column| mismatch(row, column)));
            for _ in 1..TURNS {
                table.values.extend_from_within(begin..begin + count);
            }
            table.windows.push(Window {
                columns: 0..TURNS * count,
                begin,
            });
        }
        table
    }

    fn empty(rows: Vec<f64>, columns: Vec<f64>, forced: Vec<usize>) -> Self {
        Self {
            values: Vec::new(),
            windows: Vec::new(),
            row_lengths: step_lengths(&rows, 1),
            column_lengths: ColumnLengths::new(&columns),
            rows,
            columns,
            forced,
        }
    }

    fn compare(&mut self, first: &[Samples], second: &[Vec<f32>], windows: Vec<Range<usize>>) {
        let count = self.column_count();
        let scale = TURNING_COST / first.len() as f32;
        // Two turns, so that one from any column on is in one piece.
        let second: Vec<Vec<f32>> = second.iter().map(|turning| turning.repeat(2)).collect();
        self.values.reserve(windows.iter().map(Range::len).sum());
        for (row, columns) in windows.into_iter().enumerate() {
            let begin = self.values.len();
            self.values.resize(begin + columns.len().min(count), 0.0);
            let values = &mut self.values[begin..];
            for curve in first {
                for (own, others) in curve.turning.iter().zip(&second) {
                    let own = own[row];
                    for (value, other) in values.iter_mut().zip(&others[columns.start % count..]) {
                        *value += (own - other).abs();
                    }
                }
            }
            for value in values {
                *value *= scale;
            }
            // The turns after the first repeat it.
            let end = begin + columns.len();
            while self.values.len() < end {
                let turn = self.values.len() - count;
                self.values.extend_from_within(turn..(turn + count).min(end - count));
            }
            self.windows.push(Window { columns, begin });
        }
    }

    /// The table with a cost for the distance from where each row's point is expected to be on the second curve.
    pub(in super::super) fn drawn_to(mut self, expected: &[Point], second: &Curve, cost_per_distance: f32) -> Self {
        let count = self.column_count();
        let points: Vec<Point> = self.columns.iter().map(|t| second.at(*t)).collect();
        let points = points.repeat(2);
        let mut pull = Vec::with_capacity(count);
        for (window, target) in self.windows.iter().zip(expected) {
            let points = &points[window.columns.start % count..][..count.min(window.columns.len())];
            pull.clear();
            pull.extend(points.iter().map(|p| cost_per_distance * (target - p).norm() as f32));
            let values = &mut self.values[window.begin..window.begin + window.columns.len()];
            for turn in values.chunks_mut(count) {
                for (value, pull) in turn.iter_mut().zip(&pull) {
                    *value += pull;
                }
            }
        }
        self
    }

    /// How many rows.
    pub(in super::super) fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// How many columns.
    pub(in super::super) fn column_count(&self) -> usize {
        self.columns.len()
    }

    /// The parameter of a row counted cyclically; whole turns are kept.
    pub(in super::super) fn row_parameter(&self, row: usize) -> f64 {
        self.rows[row % self.rows.len()] + (row / self.rows.len()) as f64
    }

    /// The parameter of a column counted cyclically; whole turns are kept.
    pub(in super::super) fn column_parameter(&self, column: usize) -> f64 {
        self.columns[column % self.columns.len()] + (column / self.columns.len()) as f64
    }

    /// The columns that a path from `(0, start)` can reach in each row, slopes and forced rows considered.
    pub(in super::super) fn reachable(&self, start: usize) -> Band {
        let (rows, columns) = (self.row_count(), self.column_count());
        let mut stations = vec![(0, 0)];
        stations.extend(self.forced.iter().map(|k| (*k, *k)));
        stations.push((rows, columns));
        let mut band = vec![(start, start)];
        for station in stations.windows(2) {
            let ((row, column), (next_row, next_column)) = (station[0], station[1]);
            for i in row + 1..=next_row {
                let (done, left) = (i - row, next_row - i);
                let low = (column + done / LARGEST_SLOPE).max(next_column.saturating_sub(LARGEST_SLOPE * left));
                let high = (column + LARGEST_SLOPE * done).min(next_column - left.min(next_column) / LARGEST_SLOPE);
                band.push((start + low.max(column), start + high.clamp(column, next_column)));
            }
        }
        band
    }

    /// The mismatches of a row, counted cyclically, with some of its columns.
    pub(super) fn mismatches(&self, row: usize, columns: Range<usize>) -> &[f32] {
        let window = &self.windows[row % self.row_count()];
        let first = window.columns.start;
        &window.of(&self.values)[columns.start - first..columns.end - first]
    }
}

/// Entry `[a][k]`: the length of the step of `a` samples that ends at sample `k`, for some turns of samples.
fn step_lengths(parameters: &[f64], turns: usize) -> [Vec<f32>; LARGEST_SLOPE + 1] {
    let count = parameters.len();
    std::array::from_fn(|a| {
        let length = |k: usize| {
            let before = k + LARGEST_SLOPE * count - a;
            let turns = LARGEST_SLOPE - before / count;
            (parameters[k] + turns as f64 - parameters[before % count]) as f32
        };
        let once: Vec<f32> = (0..count).map(length).collect();
        once.repeat(turns)
    })
}
