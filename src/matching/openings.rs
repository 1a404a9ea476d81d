//! Which holes of N outlines correspond.
//!
//! N outlines -> for every hole that all of them have, its index in each.
//!
//! A hole is known by where it lies in its outline and by how large it is: its centroid relative to that of the outline, in lengths of
//! which the square is the outline's area, and the logarithm of its share of that area. Shift and scale change neither. The outline with
//! the fewest holes is compared with each of the others; pairs are taken in the order of likeness, none less alike than
//! [`FARTHEST`] and [`LARGEST_RATIO`] allow. Holes without a counterpart in every outline are the others' business: they open and close.
//!
//! Cost O(#outlines x #holes^2 log #holes). Limits: outlines are taken as upright; a hole that turns far about the middle of its shape is
//! not recognised.

use crate::math::Point;
use crate::outline::{Outline, Ring};

/// How far apart holes that correspond may lie, in lengths of which the square is the outline's area: less than from one hip to the
/// other.
const FARTHEST: f64 = 0.3;
/// How many times larger one of two such holes may be.
const LARGEST_RATIO: f64 = 8.0;

/// For every hole that all outlines have, its index among the holes of each, in the order of the outline with the fewest.
#[must_use]
pub fn shared_holes(outlines: &[Outline]) -> Vec<Vec<usize>> {
    let Some(fewest) = (0..outlines.len()).min_by_key(|&pose| outlines[pose].holes().len()) else {
        return Vec::new();
    };
    let holes: Vec<Vec<HoleSignature>> = outlines.iter().map(signatures).collect();
    let counterparts: Vec<Vec<Option<usize>>> = holes.iter().map(|other| pairs(&holes[fewest], other)).collect();
    (0..holes[fewest].len())
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

/// For every hole of `from` its counterpart in `to`, the most alike first.
fn pairs(from: &[HoleSignature], to: &[HoleSignature]) -> Vec<Option<usize>> {
    let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
    for (a, hole) in from.iter().enumerate() {
        for (b, other) in to.iter().enumerate() {
            candidates.extend(hole.unlikeness(other).map(|cost| (cost, a, b)));
        }
    }
    surest_pairs(candidates, [from.len(), to.len()])
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
        assert_eq!(shared_holes(&[a.clone(), b.clone()]), [[0, 2], [1, 0]]);
        // Shifted and scaled outlines have the same holes.
        let far = b.outer().map(|p| p * 7.0 + Point::new(90.0, 3.0)).expect("a ring");
        let holes = b
            .holes()
            .iter()
            .map(|h| h.map(|p| p * 7.0 + Point::new(90.0, 3.0)).expect("a ring"));
        let far = Outline::new(far, holes.collect()).expect("an outline");
        assert_eq!(shared_holes(&[a, far]), [[0, 2], [1, 0]]);
    }

    #[test]
    fn holes_without_a_counterpart_everywhere_are_not_shared() {
        let left = with_holes(&[(-6.0, 0.0, 2.0)]);
        let right = with_holes(&[(6.0, 0.0, 2.0)]);
        let none = with_holes(&[]);
        let tiny = with_holes(&[(-6.0, 0.0, 0.2)]);
        for other in [&right, &none, &tiny] {
            assert!(shared_holes(&[left.clone(), other.clone()]).is_empty());
        }
        assert_eq!(shared_holes(&[left.clone(), left]), [[0, 0]]);
    }
}
