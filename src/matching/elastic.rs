//! Elastic matching of two sampled closed curves by dynamic programming.
//!
//! Source: Sebastian, Klein and Kimia 2003, "On aligning curves": a match is a monotone path through the table of all
//! pairs of samples, and costs the difference in length and the difference in turning along it. Here:
//!
//! - the cost of a step is `|ds1 - ds2| * (EVEN_STRETCH + |ds1 - ds2| / (ds1 + ds2)) + TURNING_COST * |turning1 - turning2| *
//!   (ds1 + ds2) / 2`, summed over the windows
//!   of [`super::curve`], with lengths in perimeters and turning in radians;
//! - *difference from the source*: steps are taken from a fixed list of slopes between 1/4 and 4, not from all pairs of
//!   earlier samples, so that a table of n x n samples costs O(n^2) and no slope degenerates.
//!
//! The samples need not be even: with landmarks, each arc between two of them is sampled with equal counts on both
//! curves, and the path is made to pass through every landmark.

mod neighbours;
mod table;

pub(super) use neighbours::{LANES, cheapest_start, path_costs};
pub(super) use table::MismatchTable;

use table::{ColumnLengths, TURNS};

/// Cost of a radian of difference in turning along one perimeter, relative to a stretch by one perimeter.
const TURNING_COST: f32 = 2.5;
/// Share of the stretch that costs the same however it is spread. The rest grows with its square, so that a long straight
/// arc is not left as it is in one half and torn in the other.
const EVEN_STRETCH: f32 = 0.5;
/// Steps `(rows, columns)` of a path. Their ratios are the slopes that a match can have locally.
const STEPS: [(usize, usize); 9] = [(1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1), (1, 4), (4, 1)];
/// The largest ratio in [`STEPS`].
const LARGEST_SLOPE: usize = 4;

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
/// Cost O(area of the band). Each kind of step is tried for a whole row at once, which the compiler turns into vector
/// instructions.
pub(super) fn cheapest_path(table: &MismatchTable, start: usize, band: &[(usize, usize)]) -> Option<Path> {
    let (rows, columns) = (table.row_count(), table.column_count());
    let largest_column = TURNS * columns - 1;
    let within = |i: usize, j: usize| band[i].0 <= j && j <= band[i].1.min(largest_column);
    if !within(0, start) || !within(rows, start + columns) {
        return None;
    }
    let mut offsets = Vec::with_capacity(rows + 1);
    let mut total = 0;
    for (low, high) in band {
        offsets.push(total);
        total += (high.min(&largest_column) + 1).saturating_sub(*low);
    }
    offsets.push(total);
    let mut cost = vec![f32::INFINITY; total];
    let mut step_to = vec![0_u32; total];
    cost[offsets[0] + start - band[0].0] = 0.0;
    let mut forced = table.forced.iter().copied().peekable();
    // A step may not jump over a row that is forced.
    let mut earliest = 0;
    for i in 1..=rows {
        let (done, rest) = cost.split_at_mut(offsets[i]);
        let costs = &mut rest[..offsets[i + 1] - offsets[i]];
        let chosen = &mut step_to[offsets[i]..offsets[i + 1]];
        for (index, &(a, b)) in STEPS.iter().enumerate() {
            if i < earliest + a {
                continue;
            }
            // The columns of this row that the step reaches from the row it comes from.
            let (before_low, before_count) = (band[i - a].0, offsets[i - a + 1] - offsets[i - a]);
            let first = band[i].0.max(before_low + b);
            let end = (band[i].0 + costs.len()).min(before_low + before_count + b);
            if first >= end {
                continue;
            }
            let span = |slice: usize| first - slice..end - slice;
            let before = &done[offsets[i - a]..][span(before_low + b)];
            let ds1 = table.row_lengths[a][i % rows];
            let ds2 = match &table.column_lengths {
                ColumnLengths::Even(lengths) => &lengths[b..=b],
                ColumnLengths::Uneven(lengths) => &lengths[b][span(0)],
            };
            let (costs, chosen) = (&mut costs[span(band[i].0)], &mut chosen[span(band[i].0)]);
            // The mismatch along the step: at its end, and at the nodes nearest to its inner even divisions.
            let divisions = a.max(b);
            let at = |inner: usize| table.mismatches(i - inner * a / divisions, span(inner * b / divisions));
            let share = 0.5 / divisions as f32;
            let step = index as u32;
            let lengths = Lengths { ds1, ds2, share };
            match divisions {
                1 => try_step(costs, chosen, before, lengths, step, [at(0)]),
                2 => try_step(costs, chosen, before, lengths, step, [at(0), at(1)]),
                3 => try_step(costs, chosen, before, lengths, step, [at(0), at(1), at(2)]),
                _ => try_step(costs, chosen, before, lengths, step, [at(0), at(1), at(2), at(3)]),
            }
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
        let (a, b) = STEPS[step_to[at(node.0, node.1)] as usize];
        node = (node.0 - a, node.1 - b);
        nodes.push(node);
    }
    nodes.reverse();
    Some(Path { nodes, cost: path_cost })
}

/// Lengths of one kind of step in one row.
#[derive(Clone, Copy)]
struct Lengths<'a> {
    ds1: f32,
    /// By column, or one for all.
    ds2: &'a [f32],
    /// What the sum of the mismatches along the step counts, per length.
    share: f32,
}

/// Lowers `costs` where coming by one kind of step is cheaper, and notes the step there. All slices run over the same
/// columns.
fn try_step<const N: usize>(
    costs: &mut [f32],
    chosen: &mut [u32],
    before: &[f32],
    lengths: Lengths,
    step: u32,
    mismatches: [&[f32]; N],
) {
    let Lengths { ds1, ds2, share } = lengths;
    let count = costs.len();
    let (chosen, before) = (&mut chosen[..count], &before[..count]);
    let mismatches = mismatches.map(|slice| &slice[..count]);
    let price = |ds2: f32| step_price(ds1, ds2, share);
    let mut lower = |k: usize, (factor, fixed): (f32, f32)| {
        let mismatch: f32 = mismatches.iter().map(|slice| slice[k]).sum();
        let sum = before[k] + mismatch * factor + fixed;
        let better = sum < costs[k];
        costs[k] = if better { sum } else { costs[k] };
        chosen[k] = if better { step } else { chosen[k] };
    };
    // A division for every column would take longer than all the rest.
    if let [ds2] = ds2 {
        let price = price(*ds2);
        (0..count).for_each(|k| lower(k, price));
    } else {
        let ds2 = &ds2[..count];
        (0..count).for_each(|k| lower(k, price(ds2[k])));
    }
}

/// What a step with these lengths costs for each unit of the mismatches along it, and whatever they are.
fn step_price(ds1: f32, ds2: f32, share: f32) -> (f32, f32) {
    let (both, stretch) = (ds1 + ds2, (ds1 - ds2).abs());
    (share * both, stretch * (EVEN_STRETCH + stretch / both))
}

/// The cost of a step over which the weighted turning differs by `turning_rad` and the lengths are `ds1` and `ds2`.
pub(super) fn step_cost(turning_rad: f64, ds1: f64, ds2: f64) -> f64 {
    let (both, stretch) = (ds1 + ds2, (ds1 - ds2).abs());
    f64::from(TURNING_COST) * turning_rad * 0.5 * both + stretch * (f64::from(EVEN_STRETCH) + stretch / both)
}

#[cfg(test)]
mod tests;
