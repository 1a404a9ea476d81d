//! Which holes of N outlines correspond.
//!
//! N outlines -> for every hole that all of them have, its index in each.
//!
//! A hole is known by where it lies in its outline and by how large it is: its centroid relative to that of the outline, in lengths of
//! which the square is the outline's area, and the logarithm of its share of that area. Shift and scale change neither. The outline with
//! the fewest holes is compared with each of the others; pairs are taken in the order of likeness, none less alike than
//! [`FARTHEST`] and [`LARGEST_RATIO`] allow. Holes that landmarks tie together correspond before all others, however unlike. Holes without a counterpart in every outline are the others' business: they open and close.
//!
//! Cost O(#outlines x #holes^2 log #holes). Limits: outlines are taken as upright; a hole that turns far about the middle of its shape is
//! not recognised.

use super::HoleTies;
use crate::math::Point;
use crate::outline::{Outline, Ring};

/// How far apart holes that correspond may lie, in lengths of which the square is the outline's area: less than from one hip to the
/// other.
const FARTHEST: f64 = 0.3;
/// How many times larger one of two such holes may be.
const LARGEST_RATIO: f64 = 8.0;

/// For every hole that all outlines have, its index among the holes of each, in the order of the outline with the fewest. `ties` go before likeness.
#[must_use]
pub fn shared_holes(outlines: &[Outline], ties: &HoleTies) -> Vec<Vec<usize>> {
    let Some(fewest) = (0..outlines.len()).min_by_key(|&pose| outlines[pose].holes().len()) else {
        return Vec::new();
    };
    let holes: Vec<Vec<HoleSignature>> = outlines.iter().map(signatures).collect();
    let base = &holes[fewest];
    let unlikeness = |outline: usize, a: usize, b: usize| base[a].unlikeness(holes[outline].get(b)?);
    let (tied, kept_out) = ties.settled(fewest, base.len(), holes.len(), &unlikeness);
    let counterparts: Vec<Vec<Option<usize>>> = (0..holes.len())
        .map(|outline| {
            if outline == fewest {
                return (0..base.len()).map(Some).collect();
            }
            pairs(base, &holes[outline], &tied[outline], &kept_out[outline])
        })
        .collect();
    (0..base.len())
        .filter_map(|hole| counterparts.iter().map(|of_pose| of_pose[hole]).collect())
        .collect()
}

/// By what a hole is recognised.
#[derive(Debug, Clone, Copy)]
struct HoleSignature {
    place: Point,
    log_share: f64,
}

impl HoleSignature {
    /// 0 for equal holes, up to 2 for those that barely correspond; `None` for those that do not.
    fn unlikeness(&self, other: &Self) -> Option<f64> {
        let distance = (self.place - other.place).norm() / FARTHEST;
        let ratio = (self.log_share - other.log_share).abs() / LARGEST_RATIO.ln();
        (distance <= 1.0 && ratio <= 1.0).then_some(distance + ratio)
    }
}

fn signatures(outline: &Outline) -> Vec<HoleSignature> {
    let area = outline.outer().signed_area();
    let middle = centroid(outline.outer());
    outline
        .holes()
        .iter()
        .map(|hole| HoleSignature {
            place: (centroid(hole) - middle) / area.sqrt(),
            log_share: (hole.signed_area().abs() / area).ln(),
        })
        .collect()
}

/// For every hole of `from` its counterpart in `to`: the one that is `tied` to it, of the others the most alike first; those of `kept_out` are nobody's.
fn pairs(
    from: &[HoleSignature],
    to: &[HoleSignature],
    tied: &[Option<usize>],
    kept_out: &[usize],
) -> Vec<Option<usize>> {
    let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
    for (a, hole) in from.iter().enumerate().filter(|(a, _)| tied[*a].is_none()) {
        let is_free = |b: usize| !tied.contains(&Some(b)) && !kept_out.contains(&b);
        for (b, other) in to.iter().enumerate().filter(|(b, _)| is_free(*b)) {
            candidates.extend(hole.unlikeness(other).map(|cost| (cost, a, b)));
        }
    }
    let by_likeness = surest_pairs(candidates, [from.len(), to.len()]);
    tied.iter()
        .zip(by_likeness)
        .map(|(tied, alike)| tied.or(alike))
        .collect()
}

/// For each of `count[0]` things its counterpart among `count[1]` others, the cheapest of the `candidates` (cost, thing, other) first; of equal
/// ones the first in order.
pub(crate) fn surest_pairs(mut candidates: Vec<(f64, usize, usize)>, count: [usize; 2]) -> Vec<Option<usize>> {
    candidates.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut found = vec![None; count[0]];
    let mut taken = vec![false; count[1]];
    for (_, a, b) in candidates {
        if found[a].is_none() && !taken[b] {
            (found[a], taken[b]) = (Some(b), true);
        }
    }
    found
}

/// The centroid of what a ring encloses.
fn centroid(ring: &Ring) -> Point {
    let origin = ring.point(0);
    let (mut twice_area, mut moment) = (0.0, Point::zeros());
    for (a, b) in ring.edges() {
        let (a, b) = (a - origin, b - origin);
        let cross = a.x * b.y - a.y * b.x;
        twice_area += cross;
        moment += (a + b) * (cross / 3.0);
    }
    origin + moment / twice_area
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, half: f64) -> Ring {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        Ring::new(corners.map(|[u, v]| Point::new(x + u * half, y + v * half))).expect("a ring")
    }

    fn with_holes(holes: &[(f64, f64, f64)]) -> Outline {
        let holes = holes.iter().map(|&(x, y, half)| square(x, y, half)).collect();
        Outline::new(square(0.0, 0.0, 10.0), holes).expect("an outline")
    }

    #[test]
    fn holes_correspond_by_place_and_size_whatever_their_order() {
        let a = with_holes(&[(-5.0, -5.0, 2.0), (5.0, 5.0, 1.0)]);
        let b = with_holes(&[(5.5, 5.0, 1.2), (0.0, -7.0, 1.0), (-5.0, -4.0, 2.5)]);
        assert_eq!(
            shared_holes(&[a.clone(), b.clone()], &HoleTies::default()),
            [[0, 2], [1, 0]]
        );
        // Shifted and scaled outlines have the same holes.
        let far = b.outer().map(|p| p * 7.0 + Point::new(90.0, 3.0)).expect("a ring");
        let holes = b
            .holes()
            .iter()
            .map(|h| h.map(|p| p * 7.0 + Point::new(90.0, 3.0)).expect("a ring"));
        let far = Outline::new(far, holes.collect()).expect("an outline");
        assert_eq!(shared_holes(&[a, far], &HoleTies::default()), [[0, 2], [1, 0]]);
    }

    #[test]
    fn holes_without_a_counterpart_everywhere_are_not_shared() {
        let left = with_holes(&[(-6.0, 0.0, 2.0)]);
        let right = with_holes(&[(6.0, 0.0, 2.0)]);
        let none = with_holes(&[]);
        let tiny = with_holes(&[(-6.0, 0.0, 0.2)]);
        for other in [&right, &none, &tiny] {
            assert!(shared_holes(&[left.clone(), other.clone()], &HoleTies::default()).is_empty());
        }
        assert_eq!(shared_holes(&[left.clone(), left], &HoleTies::default()), [[0, 0]]);
    }

    #[test]
    fn holes_that_are_tied_are_shared_however_unlike() {
        let left = with_holes(&[(-6.0, 0.0, 2.0), (6.0, 0.0, 1.0)]);
        let right = with_holes(&[(-6.0, 0.0, 2.0), (6.0, 0.0, 1.0), (0.0, 7.0, 0.1)]);
        let outlines = [left, right];
        let tied = |marks: &[Vec<Option<usize>>]| shared_holes(&outlines, &HoleTies::new(marks).expect("ties"));
        assert_eq!(tied(&[vec![Some(0), Some(1)]]), [[0, 1]]);
        assert_eq!(
            tied(&[vec![Some(0), Some(1)], vec![Some(1), Some(0)]]),
            [[0, 1], [1, 0]]
        );
        assert_eq!(tied(&[vec![Some(0), Some(2)]]), [[0, 2], [1, 1]]);
    }

    #[test]
    fn a_tie_keeps_its_holes_together_or_from_being_shared() {
        let none_alike = with_holes(&[(6.0, 0.0, 2.0)]);
        let left = with_holes(&[(-6.0, 0.0, 2.0), (6.0, 0.0, 2.0)]);
        // The first outline says nothing; of the others the left hole of one is the right one of the other.
        let ties = HoleTies::new(&[vec![None, Some(0), Some(1)]]).expect("ties");
        assert!(shared_holes(&[none_alike, left.clone(), left], &ties).is_empty());
    }
}
