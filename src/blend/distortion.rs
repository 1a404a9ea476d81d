//! How much triangles are distorted against their references: by form and by area, in a frame and in the poses.
//!
//! Of the affine map `A` from a triangle's reference to the frame, with singular values `s1 >= s2`:
//! - the *distortion* `k` is `s1 / s2`, 1 for a similarity. With the lengths `s` and `r` of the similar and the reflected part of `A`, `s1 = (s + r) / 2` and
//!   `s2 = |s - r| / 2`, so `k = (s + r)^2 / (4 |det A|)`: the determinant is that of the triangles, which for needles the difference no longer holds;
//! - the *area* is `|det A|` or its inverse, whichever is larger, 1 where the area is kept.
//!
//! Both are at least 1, infinite for a triangle without area, and do not tell a triangle from its mirror image.
//!
//! Those of the poses are kept as logarithms, so that their weighted geometric mean is a weighted sum. 16 bytes a triangle and pose.

use super::reference::{pose_edges, reference_edges};
use super::{BlendError, Reference};
use crate::math::{Matrix, Point, point};
use crate::mesh::geometry;
use crate::pose::PoseSet;

/// How far triangles are from their references.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Distortion {
    /// The ratio of the singular values of the map from the reference to the triangle, the larger over the smaller: how much more it is stretched in one direction
    /// than across it. At least 1; infinite for a triangle without area.
    pub distortion: f64,
    /// The ratio of the areas, the larger over the smaller. At least 1; infinite for a triangle without area.
    pub area: f64,
}

impl Distortion {
    /// Of what is as its reference is.
    pub const NONE: Self = Self {
        distortion: 1.0,
        area: 1.0,
    };

    /// The larger of both, by form and by area.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self {
            distortion: self.distortion.max(other.distortion),
            area: self.area.max(other.area),
        }
    }
}

/// Triangles whose logarithms are summed at a time: what the sums take stays in the nearest cache.
const BLOCK: usize = 256;

/// The references of a blend, and how its poses are distorted against them.
#[derive(Debug, Clone)]
pub(super) struct Distortions {
    /// By triangle, the inverse of the reference's edge matrix, by rows, and its determinant.
    references: Vec<[f64; 5]>,
    /// By pose and triangle, the logarithms of distortion and area.
    poses: Vec<PoseLogarithms>,
}

#[derive(Debug, Clone)]
struct PoseLogarithms {
    distortions: Vec<f64>,
    areas: Vec<f64>,
}

impl Distortions {
    /// Against the references of a blend. Canonical references have no size of their own; here they have that whose area is the geometric mean of the poses' areas.
    ///
    /// # Errors
    /// [`BlendError`] if there is no such pose, or a reference triangle is not positive or cannot be inverted.
    pub(super) fn new(poses: &PoseSet, reference: Reference) -> Result<Self, BlendError> {
        let mut edges = reference_edges(poses, reference)?;
        if reference == Reference::Canonical {
            let area = |edges: &[Matrix]| edges.iter().map(Matrix::determinant).sum::<f64>();
            let logarithms = poses
                .positions()
                .iter()
                .map(|positions| libm::log(area(&pose_edges(poses, positions))));
            let mean = libm::exp(logarithms.sum::<f64>() / poses.len() as f64);
            let scale = (mean / area(&edges)).sqrt();
            for edge in &mut edges {
                *edge *= scale;
            }
        }
        let references = edges.iter().map(|edges| {
            let inverse = edges.try_inverse().ok_or(BlendError::NotFinite)?;
            Ok([
                inverse.m11,
                inverse.m12,
                inverse.m21,
                inverse.m22,
                inverse.determinant(),
            ])
        });
        let mut distortions = Self {
            references: references.collect::<Result<_, BlendError>>()?,
            poses: Vec::new(),
        };
        let logarithms = |positions: &Vec<Point>| {
            let triangles = poses.topology().triangles().iter().zip(&distortions.references);
            let of_triangles = triangles.map(|(triangle, reference)| {
                let map = Map::new(reference, geometry::corners(positions, *triangle));
                let found = map.distortion();
                (libm::log(found.distortion), libm::log(found.area))
            });
            let (distortions, areas) = of_triangles.unzip();
            PoseLogarithms { distortions, areas }
        };
        let of_poses = poses.positions().iter().map(logarithms).collect();
        distortions.poses = of_poses;
        Ok(distortions)
    }

    /// The largest over `triangles` at `positions`, each by itself.
    pub(super) fn largest(&self, triangles: &[[usize; 3]], positions: &[Point]) -> Distortion {
        // Numerator and denominator of the largest distortion so far, and the smallest and the largest ratio of areas.
        let (mut longest, mut size) = (1.0, 1.0);
        let (mut smallest, mut largest) = (1.0_f64, 1.0_f64);
        let mut is_infinite = false;
        for (triangle, reference) in triangles.iter().zip(&self.references) {
            let map = Map::new(reference, geometry::corners(positions, *triangle));
            // Flat, or too large for numbers.
            let has_area = map.area > 0.0;
            is_infinite |= !has_area;
            smallest = smallest.min(map.area);
            largest = largest.max(map.area);
            // The square of the sum is at most twice the sum of the squares: most triangles need no root.
            let reached = longest * map.area;
            if 2.0 * map.squares() * size > reached && map.squared_sum() * size > reached {
                (longest, size) = (map.squared_sum(), map.area);
            }
        }
        if is_infinite {
            return Distortion {
                distortion: f64::INFINITY,
                area: f64::INFINITY,
            };
        }
        Distortion {
            distortion: finite_ratio(longest, size),
            area: largest.max(finite_ratio(1.0, smallest)),
        }
    }

    /// The largest over the triangles of the geometric mean of the poses' own, weighted by `weights`, which are not negative and sum to 1.
    pub(super) fn largest_of_poses(&self, weights: &[f64]) -> Distortion {
        let largest = |of: fn(&PoseLogarithms) -> &[f64]| {
            let mut largest = 0.0_f64;
            for start in (0..self.references.len()).step_by(BLOCK) {
                let block = start..self.references.len().min(start + BLOCK);
                let mut sums = [0.0; BLOCK];
                for (pose, &weight) in self.poses.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
                    for (sum, logarithm) in sums.iter_mut().zip(&of(pose)[block.clone()]) {
                        *sum += weight * logarithm;
                    }
                }
                largest = sums.into_iter().fold(largest, f64::max);
            }
            libm::exp(largest)
        };
        Distortion {
            distortion: largest(|pose| &pose.distortions),
            area: largest(|pose| &pose.areas),
        }
    }
}

/// A map from a reference to a triangle.
struct Map {
    /// The squares of the lengths of its similar and of its reflected part.
    similar: f64,
    reflected: f64,
    /// By which factor it enlarges areas, whichever way round.
    area: f64,
}

impl Map {
    fn new([m11, m12, m21, m22, determinant]: &[f64; 5], [a, b, c]: [Point; 3]) -> Self {
        let (along, aside) = (b - a, c - a);
        let (x, y) = (along * *m11 + aside * *m21, along * *m12 + aside * *m22);
        let square = |p: f64, q: f64| p * p + q * q;
        Self {
            similar: square(x.x + y.y, x.y - y.x),
            reflected: square(x.x - y.y, x.y + y.x),
            area: (point::cross(along, aside) * determinant).abs(),
        }
    }

    /// A quarter of the sum of the squares.
    fn squares(&self) -> f64 {
        0.25 * (self.similar + self.reflected)
    }

    /// The square of half the sum of the lengths: the distortion times the area.
    fn squared_sum(&self) -> f64 {
        self.squares() + 0.5 * (self.similar * self.reflected).sqrt()
    }

    fn distortion(&self) -> Distortion {
        Distortion {
            distortion: finite_ratio(self.squared_sum(), self.area),
            area: self.area.max(finite_ratio(1.0, self.area)),
        }
    }
}

/// The ratio, at least 1; infinite where it is no number.
fn finite_ratio(above: f64, below: f64) -> f64 {
    let ratio = above / below;
    if ratio.is_nan() { f64::INFINITY } else { ratio.max(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation;
    use crate::mesh::Topology;
    use proptest::prelude::*;

    const TRIANGLES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn square() -> Vec<Point> {
        [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]]
            .map(Point::from)
            .to_vec()
    }

    fn moved(map: Matrix) -> Vec<Point> {
        square().iter().map(|p| map * p + Point::new(5.0, -2.0)).collect()
    }

    fn distortions(maps: &[Matrix], reference: Reference) -> Distortions {
        let topology = Topology::new(4, TRIANGLES.to_vec()).expect("a mesh");
        let poses = maps.iter().enumerate().map(|(k, map)| (k.to_string(), moved(*map)));
        Distortions::new(&PoseSet::new(topology, poses.collect()).expect("poses"), reference).expect("references")
    }

    #[test]
    fn of_a_known_map_it_is_known() {
        let of_itself = distortions(&[Matrix::identity()], Reference::Pose(0));
        for (map, distortion, area) in [
            (Matrix::new(2.0, 0.0, 0.0, 0.5), 4.0, 1.0),
            (Matrix::new(3.0, 0.0, 0.0, 1.0), 3.0, 3.0),
            (Matrix::new(0.25, 0.0, 0.0, 0.125), 2.0, 32.0),
            // A shear by 1 has the golden ratio's square.
            (Matrix::new(1.0, 1.0, 0.0, 1.0), (3.0 + 5.0_f64.sqrt()) / 2.0, 1.0),
            // A mirror image is as its image.
            (Matrix::new(-2.0, 0.0, 0.0, 1.0), 2.0, 2.0),
        ] {
            let found = of_itself.largest(&TRIANGLES, &moved(rotation(0.7) * map * rotation(0.3)));
            assert!((found.distortion - distortion).abs() < 1e-12, "{map}: {found:?}");
            assert!((found.area - area).abs() < 1e-12 * area, "{map}: {found:?}");
        }
        let flat = of_itself.largest(&TRIANGLES, &moved(Matrix::new(1.0, 0.0, 0.0, 0.0)));
        assert_eq!((flat.distortion, flat.area), (f64::INFINITY, f64::INFINITY));
        let far = of_itself.largest(&TRIANGLES, &moved(Matrix::new(1e200, 0.0, 0.0, 1.0)));
        assert!(far.distortion > 1e100 && far.area > 1e100, "{far:?}");
    }

    #[test]
    fn that_of_the_poses_is_their_geometric_mean() {
        let stretches = [Matrix::new(4.0, 0.0, 0.0, 1.0), Matrix::new(1.0, 0.0, 0.0, 9.0)];
        let maps = [Matrix::identity(), stretches[0], stretches[1]];
        let distortions = distortions(&maps, Reference::Pose(0));
        let found = distortions.largest_of_poses(&[0.0, 0.5, 0.5]);
        assert!(
            (found.distortion - 6.0).abs() < 1e-12 && (found.area - 6.0).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(distortions.largest_of_poses(&[1.0, 0.0, 0.0]), Distortion::NONE);
    }

    #[test]
    fn canonical_references_have_the_size_of_the_poses() {
        let distortions = distortions(&[rotation(0.4) * 2.0, rotation(1.0) * 0.5], Reference::Canonical);
        let found = distortions.largest(&TRIANGLES, &square());
        assert!(
            (found.distortion - 1.0).abs() < 1e-12 && (found.area - 1.0).abs() < 1e-12,
            "{found:?}"
        );
        let of_poses = distortions.largest_of_poses(&[0.5, 0.5]);
        assert!((of_poses.area - 4.0).abs() < 1e-12, "{of_poses:?}");
    }

    proptest! {
        #[test]
        fn a_similarity_distorts_nothing(turn in -4.0..4.0f64, scale in 0.01..100.0f64) {
            let of_itself = distortions(&[Matrix::new(1.0, 0.4, 0.0, 0.8)], Reference::Pose(0));
            let similar = moved(rotation(turn) * Matrix::new(1.0, 0.4, 0.0, 0.8) * scale);
            let found = of_itself.largest(&TRIANGLES, &similar);
            prop_assert!((found.distortion - 1.0).abs() < 1e-9, "{:?}", found);
            let area = (scale * scale).max(1.0 / (scale * scale));
            prop_assert!((found.area - area).abs() < 1e-9 * area, "{:?}", found);
        }

        #[test]
        fn it_is_the_ratio_of_singular_values(a in -5.0..5.0f64, b in -5.0..5.0f64, c in -5.0..5.0f64, d in -5.0..5.0f64) {
            let map = Matrix::new(a, b, c, d);
            prop_assume!(map.determinant().abs() > 1e-3);
            let of_itself = distortions(&[Matrix::identity()], Reference::Pose(0));
            let singular = map.svd(false, false).singular_values;
            let ratio = singular[0] / singular[1];
            let found = of_itself.largest(&TRIANGLES, &moved(map));
            prop_assert!((found.distortion - ratio).abs() < 1e-9 * ratio, "{:?} {}", found, ratio);
        }
    }
}
