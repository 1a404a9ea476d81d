//! Random outlines with corresponding vertices, for the tests of all stages.
//!
//! [`poses`] is a proptest strategy. What it draws is genuinely irregular: polygons through random points, polygons grown
//! edge by edge, both also on a coarse lattice, where many vertices are exactly in line; each pose by itself, or walked off
//! from a common one vertex by vertex. Holes are random polygons in random places. Everything follows from a seed.
//!
//! A failing case shrinks by what it consists of: poses are left out, then holes, then vertices (in all poses at once),
//! as long as every outline stays simple; a smaller random number would be another, unrelated outline.

mod polygon;
mod shrink;

pub(crate) use polygon::{grown, untangled, walked};
pub(crate) use shrink::Shrinking;

use proptest::prelude::*;

use super::{Outline, Ring};
use crate::math::{Point, point};

/// Numbers in [0, 1) that look random, from a fixed linear congruential sequence (Knuth's MMIX constants).
#[derive(Debug, Clone)]
pub(crate) struct Sequence(u64);

impl Sequence {
    pub(crate) fn new(seed: u64) -> Self {
        let mut sequence = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
        sequence.next();
        sequence
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number below `bound`.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        (self.next() * bound as f64) as usize % bound.max(1)
    }

    /// A direction, as a vector of unit length.
    pub(crate) fn direction(&mut self) -> Point {
        let angle = std::f64::consts::TAU * self.next();
        Point::new(angle.cos(), angle.sin())
    }
}

/// How the poses of a case are related.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kinship {
    /// Each drawn by itself.
    Strangers,
    /// Each walked off from a common outline, a few steps for every vertex.
    Relatives,
}

/// How a polygon is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Through random points, uncrossed.
    Untangled,
    /// Edge by edge.
    Grown,
    /// Edge by edge over the points of a lattice.
    Lattice,
}

/// What a case is drawn from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recipe {
    pub(crate) vertices: usize,
    pub(crate) poses: usize,
    pub(crate) holes: usize,
    pub(crate) kinship: Kinship,
    pub(crate) seed: u64,
}

/// Poses by the ranges of what they have: vertices of the outer ring, poses, holes.
pub(crate) fn poses(
    vertices: std::ops::Range<usize>,
    poses: std::ops::Range<usize>,
    holes: std::ops::Range<usize>,
    kinship: Kinship,
) -> Shrinking<impl Strategy<Value = Vec<Outline>>> {
    let recipes = (vertices, poses, holes, any::<u64>()).prop_map(move |(vertices, poses, holes, seed)| {
        let recipe = Recipe {
            vertices,
            poses,
            holes,
            kinship,
            seed,
        };
        outlines(&recipe)
    });
    Shrinking(recipes)
}

/// One ring alone, in one pose.
pub(crate) fn rings(vertices: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Point>> {
    poses(vertices, 1..2, 0..1, Kinship::Strangers).prop_map(|poses| poses[0].outer().points().to_vec())
}

/// The outlines of a recipe.
pub(crate) fn outlines(recipe: &Recipe) -> Vec<Outline> {
    let mut random = Sequence::new(recipe.seed);
    let holes: Vec<usize> = (0..recipe.holes).map(|_| 3 + random.below(5)).collect();
    let common = matches!(recipe.kinship, Kinship::Relatives).then(|| outer(recipe.vertices, &mut random));
    (0..recipe.poses)
        .map(|_| {
            let outer = match &common {
                None => outer(recipe.vertices, &mut random),
                Some(common) => {
                    let mut outer = common.clone();
                    walked(&mut outer, 3 * recipe.vertices, &mut random);
                    outer
                }
            };
            with_holes(outer, &holes, &mut random)
        })
        .collect()
}

fn outer(vertices: usize, random: &mut Sequence) -> Vec<Point> {
    let kinds = [Kind::Untangled, Kind::Grown, Kind::Lattice];
    // A lattice of `vertices` a side has room enough for any growth.
    let mut points = match kinds[random.below(kinds.len())] {
        Kind::Untangled => {
            let points = (0..vertices)
                .map(|_| Point::new(random.next(), random.next()))
                .collect();
            untangled(points).unwrap_or_else(|| grown(vertices, None, random))
        }
        Kind::Grown => grown(vertices, None, random),
        Kind::Lattice => grown(vertices, Some(8 + vertices), random),
    };
    points.rotate_left(random.below(vertices));
    points
}

/// The outline with holes of as many vertices as given, each in a round place that touches nothing.
fn with_holes(outer: Vec<Point>, holes: &[usize], random: &mut Sequence) -> Outline {
    /// Of so many places the roomiest is taken, so that holes do not vanish.
    const PLACES: usize = 6;
    let ring = Ring::new(outer).expect("a ring");
    let (low, high) = point::bounding_box(ring.points()).expect("points");
    let mut placed: Vec<Ring> = Vec::new();
    for &count in holes {
        let mut best: Option<(f64, Point)> = None;
        let mut found = 0;
        while found < PLACES {
            let share = Point::new(random.next(), random.next());
            let place = low + (high - low).component_mul(&share);
            let inside = std::iter::once(&ring)
                .chain(&placed)
                .filter(|ring| ring.contains(place))
                .count();
            let room = std::iter::once(&ring)
                .chain(&placed)
                .flat_map(Ring::edges)
                .map(|(a, b)| point::nearest_on_segment(place, a, b).1)
                .fold(f64::INFINITY, f64::min);
            if inside == 1 && ring.contains(place) && room > 0.0 {
                found += 1;
                if best.is_none_or(|best| room > best.0) {
                    best = Some((room, place));
                }
            }
        }
        let (room, place) = best.expect("several were found");
        // Points in the unit square, into the circle around the place.
        let shape = grown(count, None, random);
        let size = point::diagonal(&shape);
        let (low, high) = point::bounding_box(&shape).expect("points");
        let middle = (low + high) * 0.5;
        let around = shape.iter().rev().map(|p| place + (p - middle) * (1.2 * room / size));
        placed.push(Ring::new(around).expect("a ring"));
    }
    Outline::new(ring, placed).expect("simple, with holes inside")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_have_what_was_asked_for_and_follow_from_the_seed() {
        for kinship in [Kinship::Strangers, Kinship::Relatives] {
            for (vertices, poses, holes) in [(3, 2, 0), (7, 3, 2), (60, 2, 1), (200, 2, 3)] {
                let recipe = Recipe {
                    vertices,
                    poses,
                    holes,
                    kinship,
                    seed: 7,
                };
                let drawn = outlines(&recipe);
                assert_eq!(drawn.len(), poses);
                for outline in &drawn {
                    assert_eq!((outline.outer().len(), outline.holes().len()), (vertices, holes));
                    let counts = |outline: &Outline| outline.rings().iter().map(Ring::len).collect::<Vec<_>>();
                    assert_eq!(counts(outline), counts(&drawn[0]));
                }
                assert_eq!(drawn, outlines(&recipe));
                assert_ne!(drawn[0], drawn[1]);
            }
        }
    }
}
