//! The cyclic start: the cheapest closed paths over all starting columns.
//!
//! Source: Maes 1990, "On a cyclic string-to-string correction problem". The cheapest paths from two starts need not
//! cross, so that the path from a start between them is looked for between them only. (With steps longer than one
//! sample, paths may cross without sharing a node; the envelopes include what a step jumps over, which leaves room.)
//!
//! *Difference from the source*: once few enough starts are left between two, all of them are taken in one sweep, and
//! only the paths that are wanted in the end are traced.
//!
//! Cost O(n^2 log n) for n samples.

use super::elastic::{Band, LANES, MismatchTable, Path, cheapest_path, path_costs};

/// The cost from every starting column, and where the cheapest path from there runs.
struct Starts {
    /// Infinite where the band between the neighbours' paths held none.
    costs: Vec<f32>,
    /// The paths that were traced on the way.
    paths: Vec<Option<Path>>,
    /// For the others, the band that holds them: per sweep, its first start and the band.
    swept: Vec<(usize, Band)>,
}

impl Starts {
    fn new(table: &MismatchTable) -> Self {
        let columns = table.column_count();
        let mut starts = Self {
            costs: vec![f32::INFINITY; columns + 1],
            paths: vec![None; columns + 1],
            swept: Vec::new(),
        };
        starts.trace(table, 0, &table.reachable(0));
        starts.paths[columns] = starts.paths[0].as_ref().map(|path| path.moved(columns));
        starts.between(table, 0, columns);
        starts.costs.truncate(columns);
        starts
    }

    fn trace(&mut self, table: &MismatchTable, start: usize, band: &[(usize, usize)]) {
        self.paths[start] = cheapest_path(table, start, band);
        self.costs[start] = self.paths[start].as_ref().map_or(f32::INFINITY, |path| path.cost);
    }

    fn between(&mut self, table: &MismatchTable, low: usize, high: usize) {
        let (Some(below), Some(above)) = (&self.paths[low], &self.paths[high]) else {
            return;
        };
        let envelopes = below.envelope().into_iter().zip(above.envelope());
        let band: Band = envelopes.map(|(a, b)| (a.0, b.1)).collect();
        let inner = high - low - 1;
        if inner <= LANES {
            let costs = path_costs(table, low + 1, &band);
            self.costs[low + 1..high].copy_from_slice(&costs[..inner]);
            self.swept.push((low + 1, band));
            return;
        }
        let middle = low + (high - low) / 2;
        self.trace(table, middle, &band);
        self.between(table, low, middle);
        self.between(table, middle, high);
    }

    fn path(&self, table: &MismatchTable, start: usize) -> Option<Path> {
        self.paths[start].clone().or_else(|| {
            let sweep = self
                .swept
                .partition_point(|(first, _)| *first <= start)
                .checked_sub(1)?;
            cheapest_path(table, start, &self.swept[sweep].1)
        })
    }
}

/// The paths that are cheaper than those of the starts around them (within `apart` columns), cheapest first, at most
/// `most`; one at least, if there is any path.
pub(super) fn cheapest_paths(table: &MismatchTable, apart: usize, most: usize) -> Vec<Path> {
    let starts = Starts::new(table);
    let count = starts.costs.len();
    let cost = |k: usize| starts.costs[k % count];
    let by_cost = |a: &usize, b: &usize| cost(*a).total_cmp(&cost(*b));
    let mut minima: Vec<usize> = (0..count)
        .filter(|k| cost(*k).is_finite())
        .filter(|k| (1..=apart).all(|d| cost(*k) <= cost(k + d) && cost(*k) < cost(k + count - d)))
        .collect();
    minima.sort_by(by_cost);
    minima.truncate(most);
    if minima.is_empty() {
        // A plain, such as two circles: every start is as good.
        minima.extend((0..count).min_by(by_cost));
    }
    minima
        .into_iter()
        .filter_map(|start| starts.path(table, start))
        .collect()
}
