//! Which holes correspond because an artist says so: landmarks on their rims tie holes of N outlines together.
//!
//! For every landmark the hole whose rim it is on, by outline -> [`HoleTies`]; with a measure of likeness, the order of every
//! outline's holes.
//!
//! 1. Landmarks that share a hole on any outline are on one hole on all of them: they are united, and the holes that they name are a tie.
//! 2. A tie that would hold two holes of one outline is a contradiction, and the landmarks to blame are named.
//! 3. Ties that hold a hole of the reference settle which hole of the other outlines that is. Ties that the reference has no landmark of
//!    take the hole of it that is most alike; all other holes correspond by likeness alone, the surest pairs first.
//!
//! Cost O(#landmarks^2 x #outlines), and O(#holes^2 log #holes) an outline. Limit: step 3 takes ties without the reference one after the
//! other and does not go back; where one is left without a hole, a landmark on the reference is asked for.

use super::openings::surest_pairs;

/// Holes of N outlines that are one hole, by landmarks on their rims.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HoleTies {
    ties: Vec<Tie>,
}

/// Holes that are one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tie {
    /// By outline, the index among its holes; `None` where no landmark says it.
    pub(super) holes: Vec<Option<usize>>,
    /// A landmark on its rim, by number.
    landmark: usize,
}

/// Why landmarks on rims say nothing. Landmarks and outlines are numbered as given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HoleTieError {
    /// Two landmarks are on two holes of one outline, and on one hole of another.
    #[error(
        "landmarks {first} and {second} are on the rims of two holes of outline {outline}, but elsewhere on the rim of one; move one of them"
    )]
    Contradiction {
        /// A landmark.
        first: usize,
        /// The other.
        second: usize,
        /// The outline where they are on two holes.
        outline: usize,
        /// The outline where they are on one; `None` if that follows from several outlines and further landmarks.
        other: Option<usize>,
    },
    /// The reference has no landmark on a hole, and no hole is left that could be it.
    #[error(
        "landmark {landmark} is on the rim of a hole that no hole of outline {reference} is left for; give it a place there, too"
    )]
    NoHoleLeft {
        /// The landmark.
        landmark: usize,
        /// The outline that lacks it.
        reference: usize,
    },
}

impl HoleTies {
    /// The ties that follow from `marks`: for every landmark and outline the hole whose rim the landmark is on, if any.
    ///
    /// # Errors
    /// [`HoleTieError::Contradiction`].
    pub fn new(marks: &[Vec<Option<usize>>]) -> Result<Self, HoleTieError> {
        let outlines = marks.iter().map(Vec::len).max().unwrap_or(0);
        let hole = |landmark: usize, outline: usize| marks[landmark].get(outline).copied().flatten();
        let both = |first: usize, second: usize, outline: usize| hole(first, outline).zip(hole(second, outline));
        // By landmark, the first of those that it is united with.
        let mut united: Vec<usize> = (0..marks.len()).collect();
        for second in 0..marks.len() {
            for first in 0..second {
                let on_one = (0..outlines).find(|&k| both(first, second, k).is_some_and(|(a, b)| a == b));
                let on_two = (0..outlines).find(|&k| both(first, second, k).is_some_and(|(a, b)| a != b));
                if let (Some(other), Some(outline)) = (on_one, on_two) {
                    let other = Some(other);
                    return Err(HoleTieError::Contradiction {
                        first,
                        second,
                        outline,
                        other,
                    });
                }
                let (kept, gone) = (united[first], united[second]);
                if on_one.is_some() && kept != gone {
                    united
                        .iter_mut()
                        .filter(|own| **own == gone)
                        .for_each(|own| *own = kept);
                }
            }
        }
        let mut ties: Vec<(usize, Tie)> = Vec::new();
        for second in 0..marks.len() {
            let place = ties.iter().position(|(class, _)| *class == united[second]);
            let place = place.unwrap_or_else(|| {
                let holes = vec![None; outlines];
                ties.push((
                    united[second],
                    Tie {
                        holes,
                        landmark: second,
                    },
                ));
                ties.len() - 1
            });
            for outline in 0..outlines {
                let Some(own) = hole(second, outline) else { continue };
                match ties[place].1.holes[outline] {
                    Some(other) if other != own => {
                        let is_other =
                            |&first: &usize| united[first] == united[second] && hole(first, outline) == Some(other);
                        let first = (0..second).find(is_other).unwrap_or(ties[place].1.landmark);
                        let other = None;
                        return Err(HoleTieError::Contradiction {
                            first,
                            second,
                            outline,
                            other,
                        });
                    }
                    _ => ties[place].1.holes[outline] = Some(own),
                }
            }
        }
        Ok(Self {
            ties: ties.into_iter().map(|(_, tie)| tie).collect(),
        })
    }

    /// For every outline the order of its holes in which they correspond to those of `reference` in theirs. `counts` says how many holes each
    /// has, as many as the reference; `away(k, a, b)` how unlike hole `b` of outline `k` is to hole `a` of the reference. Without ties the surest
    /// pairs come first, and the reference keeps its order always.
    ///
    /// # Errors
    /// [`HoleTieError::NoHoleLeft`].
    pub fn orders(
        &self,
        reference: usize,
        counts: &[usize],
        away: &dyn Fn(usize, usize, usize) -> f64,
    ) -> Result<Vec<Vec<usize>>, HoleTieError> {
        let count = counts.get(reference).copied().unwrap_or(0);
        let mut settled = Settled::new(self, reference, count);
        let left = settled.place(&|outline, a, b| Some(away(outline, a, b)));
        if let Some(&tie) = left.first() {
            let landmark = self.ties[tie].landmark;
            return Err(HoleTieError::NoHoleLeft { landmark, reference });
        }
        let order = |(outline, &own): (usize, &usize)| -> Vec<usize> {
            if outline == reference {
                return (0..own).collect();
            }
            let mut found = settled.of_outline(outline);
            let mut free = Vec::new();
            for a in (0..count).filter(|a| found[*a].is_none()) {
                let is_free = |b: &usize| !found.contains(&Some(*b));
                free.extend((0..own).filter(is_free).map(|b| (away(outline, a, b), a, b)));
            }
            for (a, b) in surest_pairs(free, [count, own]).into_iter().enumerate() {
                found[a] = found[a].or(b);
            }
            found.into_iter().flatten().collect()
        };
        Ok(counts.iter().enumerate().map(order).collect())
    }

    /// Which holes of the other outlines the ties make of those of `reference`, which has `count`; `unlikeness(k, a, b)` is that of hole `b` of outline
    /// `k` to hole `a` of the reference, `None` where they cannot be one. First for every outline and hole of the reference the hole that is tied
    /// to it, then for every outline the holes that a tie keeps from being any of the reference's.
    pub(super) fn settled(
        &self,
        reference: usize,
        count: usize,
        outlines: usize,
        unlikeness: &dyn Fn(usize, usize, usize) -> Option<f64>,
    ) -> (Vec<Vec<Option<usize>>>, Vec<Vec<usize>>) {
        let mut settled = Settled::new(self, reference, count);
        let left = settled.place(unlikeness);
        let kept_out = |outline: usize| -> Vec<usize> {
            let holes = left
                .iter()
                .filter_map(|&tie| self.ties[tie].holes.get(outline).copied().flatten());
            holes.collect()
        };
        (
            (0..outlines).map(|outline| settled.of_outline(outline)).collect(),
            (0..outlines).map(kept_out).collect(),
        )
    }

    /// The tie that holds a hole of an outline.
    fn of(&self, outline: usize, hole: usize) -> Option<&Tie> {
        (self.ties.iter()).find(|tie| tie.holes.get(outline).copied().flatten() == Some(hole))
    }

    /// The hole of `to` that is hole `hole` of outline `from`, if a tie says so.
    #[must_use]
    pub fn counterpart(&self, from: usize, hole: usize, to: usize) -> Option<usize> {
        self.of(from, hole)?.holes.get(to).copied().flatten()
    }
}

/// Ties with the holes of the reference that they are.
struct Settled<'a> {
    ties: &'a [Tie],
    reference: usize,
    count: usize,
    /// By tie, the hole of the reference.
    hole: Vec<Option<usize>>,
}

impl<'a> Settled<'a> {
    /// Those that the reference has a landmark of.
    fn new(ties: &'a HoleTies, reference: usize, count: usize) -> Self {
        let hole = |tie: &Tie| tie.holes.get(reference).copied().flatten();
        Self {
            ties: &ties.ties,
            reference,
            count,
            hole: ties.ties.iter().map(hole).collect(),
        }
    }

    /// Finds a hole for the others, the most alike first; says which ties are left without one. A tie of one outline alone ties nothing.
    fn place(&mut self, unlikeness: &dyn Fn(usize, usize, usize) -> Option<f64>) -> Vec<usize> {
        let ties = self.ties;
        let members = |tie: usize| {
            let holes = ties[tie].holes.iter().enumerate();
            holes.filter_map(|(outline, hole)| Some((outline, (*hole)?)))
        };
        let is_open = |tie: &usize| self.hole[*tie].is_none() && members(*tie).count() > 1;
        let mut open: Vec<usize> = (0..ties.len()).filter(is_open).collect();
        let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
        for &tie in &open {
            for a in 0..self.count {
                let sum: Option<f64> = members(tie).map(|(outline, b)| unlikeness(outline, a, b)).sum();
                candidates.extend(sum.map(|sum| (sum, tie, a)));
            }
        }
        candidates.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        for (_, tie, a) in candidates {
            let is_free = members(tie).all(|(outline, _)| self.of_outline(outline)[a].is_none());
            if self.hole[tie].is_none() && is_free {
                self.hole[tie] = Some(a);
            }
        }
        open.retain(|&tie| self.hole[tie].is_none());
        open
    }

    /// By hole of the reference, the hole of an outline that is tied to it.
    fn of_outline(&self, outline: usize) -> Vec<Option<usize>> {
        let mut found = vec![None; self.count];
        if outline == self.reference {
            return found;
        }
        for (tie, hole) in self.ties.iter().zip(&self.hole) {
            if let (Some(a), Some(b)) = (*hole, tie.holes.get(outline).copied().flatten())
                && let Some(slot) = found.get_mut(a)
            {
                *slot = Some(b);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Holes in the order of their numbers are alike.
    fn by_number(_: usize, a: usize, b: usize) -> f64 {
        a.abs_diff(b) as f64
    }

    #[test]
    fn landmarks_swap_holes_and_the_others_go_by_likeness() {
        let ties = HoleTies::new(&[vec![Some(0), Some(1), None]]).expect("ties");
        let orders = ties.orders(0, &[3, 3, 3], &by_number).expect("orders");
        assert_eq!(orders, [vec![0, 1, 2], vec![1, 0, 2], vec![0, 1, 2]]);
        assert_eq!(ties.counterpart(1, 1, 0), Some(0));
        assert_eq!(ties.counterpart(1, 0, 0), None);
    }

    #[test]
    fn landmarks_on_one_hole_tie_what_either_says() {
        // The first is on no hole of the reference, the second on none of the last.
        let ties = HoleTies::new(&[vec![None, Some(2), Some(0)], vec![Some(1), Some(2), None]]).expect("ties");
        let orders = ties.orders(0, &[3, 3, 3], &by_number).expect("orders");
        assert_eq!(orders[1][1], 2);
        assert_eq!(orders[2][1], 0);
    }

    #[test]
    fn a_tie_that_the_reference_lacks_goes_to_the_most_alike_hole_of_it() {
        let ties = HoleTies::new(&[vec![None, Some(1), Some(1)], vec![None, Some(0), Some(2)]]).expect("ties");
        let orders = ties.orders(0, &[3, 3, 3], &by_number).expect("orders");
        assert_eq!(orders, [[0, 1, 2], [0, 1, 2], [2, 1, 0]]);
    }

    #[test]
    fn contradictions_are_named() {
        let direct = HoleTies::new(&[vec![Some(0), Some(0)], vec![Some(0), Some(1)]]);
        let named = |outline, other| HoleTieError::Contradiction {
            first: 0,
            second: 1,
            outline,
            other,
        };
        assert_eq!(direct, Err(named(1, Some(0))));
        // By way of a third landmark: 0 and 2 are one on the first outline, 2 and 1 on the second.
        let by_way = HoleTies::new(&[
            vec![Some(0), None, Some(0)],
            vec![None, Some(0), Some(1)],
            vec![Some(0), Some(0), None],
        ]);
        assert_eq!(by_way, Err(named(2, None)));
        // The reference has two holes, each of which is taken by one of the outlines already.
        let taken = HoleTies::new(&[
            vec![Some(0), Some(0), None],
            vec![Some(1), None, Some(1)],
            vec![None, Some(1), Some(0)],
        ]);
        let left = taken.expect("ties").orders(0, &[2, 2, 2], &by_number);
        assert_eq!(
            left,
            Err(HoleTieError::NoHoleLeft {
                landmark: 2,
                reference: 0
            })
        );
    }
}
