//! Elastic matching of two sampled closed curves by dynamic programming.
//!
//! Source: Sebastian, Klein and Kimia 2003, "On aligning curves": a match is a monotone path through the table of all
//! pairs of samples, and costs the difference in length and the difference in turning along it. Here:
//!
//! - the cost of a step is `|ds1 - ds2| + TURNING_COST * |turning1 - turning2| * (ds1 + ds2) / 2`, summed over the windows
//!   of [`super::curve::WINDOWS`], with lengths in perimeters and turning in radians;
//! - *difference from the source*: steps are taken from a fixed list of slopes between 1/4 and 4, not from all pairs of
//!   earlier samples, so that a table of n x n samples costs O(n^2) and no slope degenerates.
//!
//! The samples need not be even: with landmarks, each arc between two of them is sampled with equal counts on both
//! curves, and the path is made to pass through every landmark.

use super::curve::{Curve, Turning};
use crate::math::Point;

/// Cost of a radian of difference in turning along one perimeter, relative to a stretch by one perimeter.
const TURNING_COST: f32 = 2.5;
/// Steps `(rows, columns)` of a path. Their ratios are the slopes that a match can have locally.
const STEPS: [(usize, usize); 9] = [(1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1), (1, 4), (4, 1)];
/// The largest ratio in [`STEPS`].
const LARGEST_SLOPE: usize = 4;

/// Two sampled curves and how much their samples differ.
#[derive(Debug, Clone)]
pub(super) struct MismatchTable {
    /// Parameters of the first curve's samples: increasing, not wrapped, less than one turn.
    rows: Vec<f64>,
    /// Parameters of the second curve's samples, likewise.
    columns: Vec<f64>,
    /// Mismatch by row and column, in cost per unit length.
    values: Vec<f32>,
    /// Rows that are matched to the column of the same number.
    forced: Vec<usize>,
}

impl MismatchTable {
    /// Compares `first` at `rows` with `second` at `columns`. The rows in `forced`, increasing and without row 0, have to
    /// be matched to the column of the same number.
    pub(super) fn new(first: &Curve, rows: Vec<f64>, second: &Curve, columns: Vec<f64>, forced: Vec<usize>) -> Self {
        let row_turning: Vec<Turning> = rows.iter().map(|t| first.turning(*t)).collect();
        let column_turning: Vec<Turning> = columns.iter().map(|t| second.turning(*t)).collect();
        let mut values = Vec::with_capacity(rows.len() * columns.len());
        for a in &row_turning {
            for b in &column_turning {
                let difference: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
                values.push(TURNING_COST * difference);
            }
        }
        Self {
            rows,
            columns,
            values,
            forced,
        }
    }

    /// The table with a cost for the distance from where each row's point is expected to be on the second curve.
    pub(super) fn drawn_to(mut self, expected: &[Point], second: &Curve, cost_per_distance: f32) -> Self {
        let points: Vec<Point> = self.columns.iter().map(|t| second.at(*t)).collect();
        for (row, target) in expected.iter().enumerate() {
            let start = row * self.columns.len();
            for (value, p) in self.values[start..].iter_mut().zip(&points) {
                *value += cost_per_distance * (target - p).norm() as f32;
            }
        }
        self
    }

    /// How many rows.
    pub(super) fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// How many columns.
    pub(super) fn column_count(&self) -> usize {
        self.columns.len()
    }

    /// The parameter of a row counted cyclically; whole turns are kept.
    pub(super) fn row_parameter(&self, row: usize) -> f64 {
        self.rows[row % self.rows.len()] + (row / self.rows.len()) as f64
    }

    /// The parameter of a column counted cyclically; whole turns are kept.
    pub(super) fn column_parameter(&self, column: usize) -> f64 {
        self.columns[column % self.columns.len()] + (column / self.columns.len()) as f64
    }

    /// The columns that a path from `(0, start)` can reach in each row, slopes and forced rows considered.
    pub(super) fn reachable(&self, start: usize) -> Band {
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

    fn mismatch(&self, row: usize, column: usize) -> f32 {
        let (rows, columns) = (self.row_count(), self.column_count());
        self.values[(row % rows) * columns + column % columns]
    }
}

/// For each row from 0 to #rows, the lowest and the highest column a path may use. Columns count on past the first turn.
pub(super) type Band = Vec<(usize, usize)>;

/// A closed monotone path: nodes `(row, column)` from `(0, j)` to `(#rows, j + #columns)`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// The nodes, both coordinates increasing strictly.
    pub(super) nodes: Vec<(usize, usize)>,
    /// The cost.
    pub(super) cost: f32,
}

impl Path {
    /// For each row, the least and the largest column that the path touches or jumps over there.
    pub(super) fn envelope(&self) -> Band {
        let rows = self.nodes.last().map_or(0, |node| node.0);
        let mut bounds = vec![(usize::MAX, 0); rows + 1];
        for pair in self.nodes.windows(2) {
            for bound in &mut bounds[pair[0].0..=pair[1].0] {
                bound.0 = bound.0.min(pair[0].1);
                bound.1 = bound.1.max(pair[1].1);
            }
        }
        bounds
    }

    /// The path moved by whole columns.
    pub(super) fn moved(&self, columns: usize) -> Self {
        Self {
            nodes: self.nodes.iter().map(|(i, j)| (*i, j + columns)).collect(),
            cost: self.cost,
        }
    }
}

/// The cheapest path from `(0, start)` to `(#rows, start + #columns)` within `band`, or `None` if there is none.
///
/// Cost O(area of the band).
pub(super) fn cheapest_path(table: &MismatchTable, start: usize, band: &[(usize, usize)]) -> Option<Path> {
    let (rows, columns) = (table.row_count(), table.column_count());
    let mut offsets = Vec::with_capacity(rows + 1);
    let mut total = 0;
    for (low, high) in band {
        offsets.push(total);
        total += (high + 1).saturating_sub(*low);
    }
    let within = |i: usize, j: usize| band[i].0 <= j && j <= band[i].1;
    if !within(0, start) || !within(rows, start + columns) {
        return None;
    }
    let mut cost = vec![f32::INFINITY; total];
    let mut step_to = vec![0_u8; total];
    cost[offsets[0] + start - band[0].0] = 0.0;
    let row_lengths = step_lengths(|k| table.row_parameter(k), rows);
    let column_lengths = step_lengths(|k| table.column_parameter(k), columns);

    let mut forced = table.forced.iter().copied().peekable();
    // A step may not jump over a row that is forced.
    let mut earliest = 0;
    for i in 1..=rows {
        let (low, high) = band[i];
        for j in low..=high {
            let here = table.mismatch(i, j);
            let mut best = (f32::INFINITY, 0);
            for (index, &(a, b)) in STEPS.iter().enumerate() {
                if i < earliest + a || j < b || !within(i - a, j - b) {
                    continue;
                }
                let before = cost[offsets[i - a] + j - b - band[i - a].0];
                if before >= best.0 {
                    continue;
                }
                // The mismatch along the step: at its end, and at the nodes nearest to its inner even divisions.
                let divisions = a.max(b);
                let mut mismatch = here;
                for inner in 1..divisions {
                    mismatch += table.mismatch(i - inner * a / divisions, j - inner * b / divisions);
                }
                let (ds1, ds2) = (row_lengths[a][i % rows], column_lengths[b][j % columns]);
                let turning = mismatch / divisions as f32 * 0.5 * (ds1 + ds2);
                let sum = before + turning + (ds1 - ds2).abs();
                if sum < best.0 {
                    best = (sum, index as u8);
                }
            }
            let at = offsets[i] + j - low;
            (cost[at], step_to[at]) = best;
        }
        if forced.peek() == Some(&i) {
            earliest = i;
            forced.next();
        }
    }
    let at = |i: usize, j: usize| offsets[i] + j - band[i].0;
    let end = (rows, start + columns);
    let path_cost = cost[at(end.0, end.1)];
    if !path_cost.is_finite() {
        return None;
    }
    let mut nodes = vec![end];
    let mut node = end;
    while node.0 > 0 {
        let (a, b) = STEPS[usize::from(step_to[at(node.0, node.1)])];
        node = (node.0 - a, node.1 - b);
        nodes.push(node);
    }
    nodes.reverse();
    Some(Path { nodes, cost: path_cost })
}

/// The cost of a step over which the weighted turning differs by `turning_rad` and the lengths are `ds1` and `ds2`.
pub(super) fn step_cost(turning_rad: f64, ds1: f64, ds2: f64) -> f64 {
    f64::from(TURNING_COST) * turning_rad * 0.5 * (ds1 + ds2) + (ds1 - ds2).abs()
}

/// Entry `[a][k]`: the length of the step of `a` samples that ends at sample `k`, counted cyclically.
fn step_lengths(parameter: impl Fn(usize) -> f64, count: usize) -> [Vec<f32>; LARGEST_SLOPE + 1] {
    std::array::from_fn(|a| {
        (0..count)
            .map(|k| (parameter(k + count) - parameter(k + count - a.min(count))) as f32)
            .collect()
    })
}
