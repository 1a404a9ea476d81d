//! Which pixels have a colour, and where those without one find theirs.

use std::ops::Range;

/// A bit for each pixel of some rows.
pub(super) struct Reached {
    width: usize,
    /// Rows begin with a new word.
    words: Vec<u64>,
}

impl Reached {
    /// No pixel is reached.
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            words: vec![0; width.div_ceil(64) * height],
        }
    }

    /// Notes that some columns of a row are reached.
    pub(super) fn add(&mut self, row: usize, columns: Range<usize>) {
        let start = row * self.width.div_ceil(64);
        for (word, bits) in masks(columns) {
            self.words[start + word] |= bits;
        }
    }

    pub(super) fn is_reached(&self, row: usize, column: usize) -> bool {
        self.words[row * self.width.div_ceil(64) + column / 64] >> (column % 64) & 1 == 1
    }

    /// From the first to the last reached one of some columns of a row.
    pub(super) fn extent(&self, row: usize, columns: Range<usize>) -> Option<Range<usize>> {
        let start = row * self.width.div_ceil(64);
        let mut found: Option<Range<usize>> = None;
        for (word, bits) in masks(columns) {
            let bits = self.words[start + word] & bits;
            if bits != 0 {
                let first = word * 64 + bits.trailing_zeros() as usize;
                let end = (word + 1) * 64 - bits.leading_zeros() as usize;
                found = Some(found.map_or(first, |run| run.start)..end);
            }
        }
        found
    }

    /// Calls `each` with those of some columns of a row that are not reached.
    pub(super) fn for_each_unreached(&self, row: usize, columns: Range<usize>, mut each: impl FnMut(usize)) {
        let start = row * self.width.div_ceil(64);
        for (word, bits) in masks(columns) {
            let mut bits = !self.words[start + word] & bits;
            while bits != 0 {
                each(word * 64 + bits.trailing_zeros() as usize);
                bits &= bits - 1;
            }
        }
    }
}

/// The words that hold the bits of a range, and the bits in them.
fn masks(columns: Range<usize>) -> impl Iterator<Item = (usize, u64)> {
    let Range { start, end } = columns;
    let words = if start < end {
        start / 64..end.div_ceil(64)
    } else {
        0..0
    };
    words.map(move |word| {
        let from = start.saturating_sub(word * 64).min(63);
        let to = (end - word * 64).min(64);
        (word, (u64::MAX >> (64 - (to - from))) << from)
    })
}

/// How far a colour is fetched from, in pixels. The outline leaves the mesh by less; what a fold leaves open is larger.
const FARTHEST_PX: usize = 24;

/// For each of the `unreached` places (column and row, by rows) of a grid of `size` the nearest reached one, if there is one near.
///
/// Places next to reached ones begin; then, ring by ring, every place asks its neighbours which they have found. The
/// distance is exact but for rare ties at a fraction of a pixel.
pub(super) fn nearest_reached(
    unreached: &[[usize; 2]],
    size: [usize; 2],
    is_reached: impl Fn([usize; 2]) -> bool,
) -> Vec<Option<[usize; 2]>> {
    let mut nearest: Vec<Option<[usize; 2]>> = vec![None; unreached.len()];
    let neighbours = |[x, y]: [usize; 2]| {
        let columns = x.saturating_sub(1)..(x + 2).min(size[0]);
        (y.saturating_sub(1)..(y + 2).min(size[1])).flat_map(move |y| columns.clone().map(move |x| [x, y]))
    };
    let distance = |[x, y]: [usize; 2], [u, v]: [usize; 2]| x.abs_diff(u).pow(2) + y.abs_diff(v).pow(2);
    let index = |p: &[usize; 2]| unreached.binary_search_by_key(&(p[1], p[0]), |q| (q[1], q[0])).ok();
    let mut open: Vec<usize> = (0..unreached.len()).collect();
    for _ in 0..FARTHEST_PX {
        let found: Vec<(usize, [usize; 2])> = open
            .iter()
            .filter_map(|&k| {
                let here = unreached[k];
                let known = neighbours(here).filter_map(|p| match index(&p) {
                    Some(other) => nearest[other],
                    None => is_reached(p).then_some(p),
                });
                Some((k, known.min_by_key(|from| distance(here, *from))?))
            })
            .collect();
        if found.is_empty() {
            break;
        }
        for (k, from) in found {
            nearest[k] = Some(from);
        }
        open.retain(|k| nearest[*k].is_none());
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn open_pixels_take_the_nearest() {
        // A row of 9 with 1 and 7 reached, 4 as far from either: the first counts.
        let unreached: Vec<[usize; 2]> = [0, 2, 3, 4, 5, 6, 8].map(|x| [x, 0]).to_vec();
        let nearest = nearest_reached(&unreached, [9, 1], |[x, _]| x == 1 || x == 7);
        let columns: Vec<usize> = nearest.iter().map(|p| p.expect("reached")[0]).collect();
        assert_eq!(columns, [1, 1, 1, 1, 7, 7, 7]);
        assert_eq!(nearest_reached(&unreached, [9, 1], |_| false), vec![None; 7]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn bits_agree_with_a_list(
            runs in prop::collection::vec((0usize..200, 0usize..200), 0..5),
            asked in (0usize..200, 0usize..200),
        ) {
            let ordered = |(a, b): (usize, usize)| a.min(b)..a.max(b);
            let mut reached = Reached::new(200, 2);
            let mut list = [false; 200];
            for run in runs {
                reached.add(1, ordered(run));
                list[ordered(run)].fill(true);
            }
            let asked = ordered(asked);
            let mut open = vec![];
            reached.for_each_unreached(1, asked.clone(), |column| open.push(column));
            prop_assert_eq!(open, asked.clone().filter(|c| !list[*c]).collect::<Vec<_>>());
            let hits: Vec<usize> = asked.clone().filter(|c| list[*c]).collect();
            let extent = hits.first().map(|first| *first..hits[hits.len() - 1] + 1);
            prop_assert_eq!(reached.extent(1, asked), extent);
            prop_assert!((0..200).all(|c| reached.is_reached(1, c) == list[c] && !reached.is_reached(0, c)));
        }
    }
}
