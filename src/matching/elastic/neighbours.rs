//! The cheapest of the paths from neighbouring starts, all in one sweep over the table.
//!
//! Paths from neighbouring starts lie in one band, and a step between two nodes costs each of them the same. So the sweep
//! asks for the price of a step once and keeps a cost per start at every node; which way the cheapest path goes is left
//! to [`super::cheapest_path`], for that start alone. Costs are those of that function to the last bit.

use std::ops::RangeInclusive;

use super::table::{ColumnLengths, TURNS};
use super::{LARGEST_SLOPE, MismatchTable, STEPS, cheapest_path, step_price};

/// Starts in one sweep: three vectors of four.
pub(in super::super) const LANES: usize = 12;

/// Rows that are kept: those that a step may come from, and the one it goes to.
const KEPT: usize = LARGEST_SLOPE + 1;

/// A node's cost by start.
type Costs = [f32; LANES];

const NOWHERE: Costs = [f32::INFINITY; LANES];

/// The first of the starts whose path within `band` is cheapest; `None` if there is no path from any.
pub(in super::super) fn cheapest_start(
    table: &MismatchTable,
    starts: RangeInclusive<usize>,
    band: &[(usize, usize)],
) -> Option<usize> {
    let mut best = (f32::INFINITY, None);
    for first in starts.clone().step_by(LANES) {
        for (start, cost) in (first..=*starts.end()).zip(path_costs(table, first, band)) {
            if cost < best.0 {
                best = (cost, Some(start));
            }
        }
    }
    best.1
}

/// The costs of the cheapest paths from `first` and the starts after it, within `band`; infinite where there is none.
pub(in super::super) fn path_costs(table: &MismatchTable, first: usize, band: &[(usize, usize)]) -> [f32; LANES] {
    match &table.column_lengths {
        ColumnLengths::Even(lengths) => sweep(table, first, band, lengths),
        ColumnLengths::Uneven(_) => {
            std::array::from_fn(|lane| cheapest_path(table, first + lane, band).map_or(f32::INFINITY, |path| path.cost))
        }
    }
}

fn sweep(
    table: &MismatchTable,
    first: usize,
    band: &[(usize, usize)],
    column_lengths: &[f32; LARGEST_SLOPE + 1],
) -> Costs {
    let (rows, columns) = (table.row_count(), table.column_count());
    let largest_column = TURNS * columns - 1;
    let limits = |i: usize| (band[i].0, band[i].1.min(largest_column));
    let within = |i: usize, j: usize| limits(i).0 <= j && j <= limits(i).1;
    let leftmost = band.iter().map(|(low, _)| *low).min().unwrap_or(0);
    let rightmost = (0..=rows).map(|i| limits(i).1).max().unwrap_or(0);
    // A column has its place after a margin as wide as a step, so that each node has somewhere to come from.
    let place = |j: usize| j - leftmost + LARGEST_SLOPE;
    let width = place(rightmost.max(leftmost)) + 1;
    let outside = vec![NOWHERE; width];
    let mut kept: [Vec<Costs>; KEPT] = std::array::from_fn(|_| outside.clone());
    for lane in 0..LANES {
        if within(0, first + lane) && within(rows, first + lane + columns) {
            kept[0][place(first + lane)][lane] = 0.0;
        }
    }

    let mut prices: [Vec<f32>; STEPS.len()] = std::array::from_fn(|_| vec![0.0; width]);
    for i in 1..=rows {
        let mut costs = std::mem::take(&mut kept[i % KEPT]);
        if let Some(gone) = i.checked_sub(KEPT)
            && limits(gone).0 <= limits(gone).1
        {
            costs[place(limits(gone).0)..=place(limits(gone).1)].fill(NOWHERE);
        }
        let (low, high) = limits(i);
        if low <= high {
            let count = high + 1 - low;
            let mut fixed = [0.0; STEPS.len()];
            let mut before = [&outside[..count]; STEPS.len()];
            for (index, &(a, b)) in STEPS.iter().enumerate() {
                if i < a {
                    continue;
                }
                before[index] = &kept[(i - a) % KEPT][place(low) - b..][..count];
                let divisions = a.max(b);
                let ds1 = table.row_lengths[a][i % rows];
                let (factor, rest) = step_price(ds1, column_lengths[b], 0.5 / divisions as f32);
                fixed[index] = rest;
                // Nodes left of the first column, which nothing comes from, need no price.
                let begin = low.max(b);
                let span = |slice: usize| begin - slice..(high + 1).max(begin) - slice;
                let prices = &mut prices[index][begin.min(high + 1) - low..count];
                let at = |inner: usize| table.mismatches(i - inner * a / divisions, span(inner * b / divisions));
                match divisions {
                    1 => price(prices, factor, [at(0)]),
                    2 => price(prices, factor, [at(0), at(1)]),
                    3 => price(prices, factor, [at(0), at(1), at(2)]),
                    _ => price(prices, factor, [at(0), at(1), at(2), at(3)]),
                }
            }
            let prices = prices.each_ref().map(|prices| &prices[..count]);
            lower(&mut costs[place(low)..=place(high)], before, prices, fixed);
        }
        kept[i % KEPT] = costs;
    }
    std::array::from_fn(|lane| {
        let end = first + lane + columns;
        if within(rows, end) {
            kept[rows % KEPT][place(end)][lane]
        } else {
            f32::INFINITY
        }
    })
}

/// What one kind of step costs for the mismatches along it, by column.
fn price<const N: usize>(prices: &mut [f32], factor: f32, mismatches: [&[f32]; N]) {
    let count = prices.len();
    let mismatches = mismatches.map(|slice| &slice[..count]);
    for (k, price) in prices.iter_mut().enumerate() {
        let mismatch: f32 = mismatches.iter().map(|slice| slice[k]).sum();
        *price = mismatch * factor;
    }
}

/// The costs of a row from those each kind of step comes from. All slices run over the same columns.
fn lower(
    costs: &mut [Costs],
    before: [&[Costs]; STEPS.len()],
    prices: [&[f32]; STEPS.len()],
    fixed: [f32; STEPS.len()],
) {
    let count = costs.len();
    let (before, prices) = (before.map(|slice| &slice[..count]), prices.map(|slice| &slice[..count]));
    for (k, costs) in costs.iter_mut().enumerate() {
        let mut least = NOWHERE;
        for step in 0..STEPS.len() {
            let (from, price) = (&before[step][k], prices[step][k]);
            for lane in 0..LANES {
                let sum = from[lane] + price + fixed[step];
                least[lane] = if sum < least[lane] { sum } else { least[lane] };
            }
        }
        *costs = least;
    }
}
