//! The cyclic start: the cheapest closed paths over all starting columns.
//!
//! Source: Maes 1990, "On a cyclic string-to-string correction problem". The cheapest paths from two starts need not
//! cross, so that the path from a start between them is looked for between them only. (With steps longer than one
//! sample, paths may cross without sharing a node; the envelopes include what a step jumps over, which leaves room.)
//!
//! Cost O(n^2 log n) for n samples. Every second start is enough: the finer match tries its neighbours again.

use super::elastic::{MismatchTable, Path, cheapest_path};

/// How many columns apart the starts are that are tried.
const SPACING: usize = 2;

/// The cheapest path from every second start, by starting column; `None` in between, and where the band between the
/// neighbours' paths held none.
pub(super) fn path_from_each_start(table: &MismatchTable) -> Vec<Option<Path>> {
    let columns = table.column_count();
    let mut paths = vec![None; columns + 1];
    paths[0] = cheapest_path(table, 0, &table.reachable(0));
    paths[columns] = paths[0].as_ref().map(|path| path.moved(columns));
    between(table, 0, columns, &mut paths);
    paths.truncate(columns);
    paths
}

fn between(table: &MismatchTable, low: usize, high: usize, paths: &mut [Option<Path>]) {
    if high - low <= SPACING {
        return;
    }
    let middle = low + (high - low) / 2;
    let (Some(below), Some(above)) = (&paths[low], &paths[high]) else {
        return;
    };
    let band: Vec<_> = below
        .envelope()
        .iter()
        .zip(above.envelope())
        .map(|(a, b)| (a.0, b.1))
        .collect();
    paths[middle] = cheapest_path(table, middle, &band);
    if paths[middle].is_some() {
        between(table, low, middle, paths);
        between(table, middle, high, paths);
    }
}

/// The paths that are cheaper than those of the starts around them (within `apart` columns), cheapest first, at most
/// `most`.
pub(super) fn distinct_minima(paths: &[Option<Path>], apart: usize, most: usize) -> Vec<Path> {
    let count = paths.len();
    let cost = |k: usize| paths[k % count].as_ref().map_or(f32::INFINITY, |path| path.cost);
    let mut minima: Vec<&Path> = (0..count)
        .filter(|k| (1..=apart).all(|d| cost(*k) <= cost(k + d) && cost(*k) < cost(k + count - d)))
        .filter_map(|k| paths[k].as_ref())
        .collect();
    minima.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    minima.truncate(most);
    if minima.is_empty() {
        // A plain, such as two circles: every start is as good.
        minima.extend(paths.iter().flatten().min_by(|a, b| a.cost.total_cmp(&b.cost)));
    }
    minima.into_iter().cloned().collect()
}
