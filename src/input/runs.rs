//! Masks of pixels as runs along their rows, and the components that the runs form.
//!
//! A mask -> [`Runs`] -> [`Components`].
//!
//! 1. The runs of every row, all rows at once on all processors.
//! 2. Runs of consecutive rows that lie over one another are united; whether two that touch
//!    at a corner are, the caller says. After He, Chao, Suzuki 2008, "A run-based two-scan labeling algorithm",
//!    doi:10.1109/TIP.2008.919369.
//!
//! Drawings have a thousand times fewer runs than pixels: what follows costs next to nothing. Cost O(#pixels), read once.

use std::ops::Range;

use rayon::prelude::*;

use crate::math::DisjointSets;

/// Consecutive pixels of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Run {
    row: u32,
    first: u32,
    end: u32,
}

impl Run {
    pub(super) fn row(self) -> usize {
        self.row as usize
    }

    /// Its columns.
    pub(super) fn columns(self) -> Range<usize> {
        self.first as usize..self.end as usize
    }

    /// The indices of its pixels in a picture of the given width.
    pub(super) fn pixels(self, width: usize) -> Range<usize> {
        let start = self.row() * width;
        start + self.first as usize..start + self.end as usize
    }

    pub(super) fn len(self) -> usize {
        (self.end - self.first) as usize
    }
}

/// The runs of a mask, row by row.
#[derive(Debug)]
pub(super) struct Runs {
    runs: Vec<Run>,
    /// Where each row's runs begin, and after the last row where they end.
    starts: Vec<usize>,
}

impl Runs {
    /// The runs of the values that are in, row by row. Sides of pictures are below 2^32 pixels.
    pub(super) fn of<T: Sync>(values: &[T], width: usize, is_in: impl Fn(&T) -> bool + Sync) -> Self {
        let rows: Vec<Vec<Run>> = values
            .par_chunks_exact(width.max(1))
            .with_min_len(16)
            .enumerate()
            .map(|(row, values)| runs_of_row(row as u32, values, &is_in))
            .collect();
        let mut starts = Vec::with_capacity(rows.len() + 1);
        let mut count = 0;
        for row in &rows {
            starts.push(count);
            count += row.len();
        }
        starts.push(count);
        Self {
            runs: rows.concat(),
            starts,
        }
    }

    /// All runs, row by row.
    pub(super) fn all(&self) -> &[Run] {
        &self.runs
    }

    /// The indices of a row's runs.
    pub(super) fn in_row(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    /// The run that a pixel belongs to.
    pub(super) fn at(&self, column: usize, row: usize) -> Option<usize> {
        let range = self.in_row(row);
        let runs = &self.runs[range.clone()];
        let after = runs.partition_point(|run| run.first as usize <= column);
        let run = after.checked_sub(1)?;
        runs[run].columns().contains(&column).then_some(range.start + run)
    }

    /// The components of runs that are joined from side to side, and at corners where `joins` says so, given the row and column of the
    /// upper left one of the four pixels around the corner.
    pub(super) fn components(&self, joins: impl Fn(usize, usize) -> bool) -> Components {
        let mut sets = DisjointSets::new(self.runs.len());
        for row in 1..self.starts.len() - 1 {
            let (mut above, mut below) = (self.starts[row - 1], self.starts[row]);
            while above < self.starts[row] && below < self.starts[row + 1] {
                let (a, b) = (self.runs[above], self.runs[below]);
                let is_joined = if a.end == b.first {
                    joins(row - 1, a.end as usize - 1)
                } else if b.end == a.first {
                    joins(row - 1, b.end as usize - 1)
                } else {
                    a.first < b.end && b.first < a.end
                };
                if is_joined {
                    sets.unite(above, below);
                }
                // Between runs of a row there is a pixel at least: what comes after the one that ends first touches no more of the other row's.
                if a.end < b.end {
                    above += 1;
                } else {
                    below += 1;
                }
            }
        }
        let mut label_of = vec![0; sets.len()];
        let mut count = 0_u32;
        for run in 0..sets.len() {
            let first = sets.root(run);
            label_of[run] = if first == run {
                count += 1;
                count - 1
            } else {
                label_of[first]
            };
        }
        Components {
            label_of,
            count: count as usize,
        }
    }
}

fn runs_of_row<T>(row: u32, values: &[T], is_in: &impl Fn(&T) -> bool) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut column = 0;
    loop {
        let Some(ahead) = values[column..].iter().position(is_in) else {
            return runs;
        };
        let first = column + ahead;
        let length = values[first..].iter().position(|value| !is_in(value));
        column = length.map_or(values.len(), |length| first + length);
        runs.push(Run {
            row,
            first: first as u32,
            end: column as u32,
        });
    }
}

/// Which component each run belongs to.
#[derive(Debug)]
pub(super) struct Components {
    /// A component's number a run, in the order of their first pixels.
    pub(super) label_of: Vec<u32>,
    /// How many there are.
    pub(super) count: usize,
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The labels of all pixels, by what can be reached step by step.
    fn flooded(mask: &[bool], width: usize, corners: bool) -> Vec<Option<u32>> {
        let mut labels = vec![None; mask.len()];
        let mut count = 0;
        for seed in 0..mask.len() {
            if !mask[seed] || labels[seed].is_some() {
                continue;
            }
            let mut open = vec![seed];
            labels[seed] = Some(count);
            while let Some(at) = open.pop() {
                let (x, y) = ((at % width) as isize, (at / width) as isize);
                for (dx, dy) in (-1..2).flat_map(|dy| (-1..2).map(move |dx| (dx, dy))) {
                    let (x, y) = (x + dx, y + dy);
                    let is_beside = corners || dx == 0 || dy == 0;
                    let height = (mask.len() / width) as isize;
                    if is_beside && (0..width as isize).contains(&x) && (0..height).contains(&y) {
                        let other = y as usize * width + x as usize;
                        if mask[other] && labels[other].is_none() {
                            labels[other] = Some(count);
                            open.push(other);
                        }
                    }
                }
            }
            count += 1;
        }
        labels
    }

    fn by_runs(mask: &[bool], width: usize, corners: bool) -> Vec<Option<u32>> {
        let runs = Runs::of(mask, width, |inside| *inside);
        let components = runs.components(|_, _| corners);
        let mut labels = vec![None; mask.len()];
        for (run, label) in runs.all().iter().zip(&components.label_of) {
            assert!((*label as usize) < components.count);
            labels[run.pixels(width)].fill(Some(*label));
        }
        for (at, label) in labels.iter().enumerate() {
            let found = runs.at(at % width, at / width).map(|run| components.label_of[run]);
            assert_eq!(found, *label);
        }
        labels
    }

    proptest! {
        #[test]
        fn components_are_what_a_flood_reaches(
            (width, mask) in (1_usize..9).prop_flat_map(|width| {
                (Just(width), (1_usize..9).prop_flat_map(move |height| prop::collection::vec(any::<bool>(), width * height)))
            }),
            corners in any::<bool>(),
        ) {
            prop_assert_eq!(by_runs(&mask, width, corners), flooded(&mask, width, corners));
        }
    }

    #[test]
    fn an_empty_picture_has_no_runs() {
        let runs = Runs::of(&[] as &[bool], 0, |inside| *inside);
        assert_eq!((runs.all().len(), runs.components(|_, _| true).count), (0, 0));
    }
}
