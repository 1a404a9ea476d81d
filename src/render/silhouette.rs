//! The full-resolution outline of a blended shape.
//!
//! The mesh encloses the drawings, so its boundary is not their edge. The edge is carried along: corresponding points
//! of the N outlines are located in the N meshes once, and per frame each is mapped by its triangle and averaged with
//! the blend's weights.
//!
//! 1. The rows: every vertex of every pose's outline, through the correspondence. So each pose's outline is returned
//!    exactly when its weight is 1.
//! 2. For each row and pose the triangle and barycentric coordinates, and from them its shares of the vertices around it
//!    ([`SmoothPoints`]): carried by triangles alone, a smooth outline would bend at every edge of the mesh.
//! 3. Per frame: row k lies at the sum over poses of weight times its mapped point.
//!
//! Cost: O(#rows x #poses) a frame, with #rows at most 20,000 a ring.

use rayon::prelude::*;

use crate::matching::Correspondence;
use crate::math::{Point, point, wrapped};
use crate::mesh::{MeshPoint, PointLocator, SmoothCarrier, SmoothPoints};
use crate::outline::{ArcLength, Outline, Ring};
use crate::pose::Mapping;

/// Rows nearer than this to their predecessor on every pose are left out, as a fraction of the perimeter: a fifth of
/// a pixel on an outline of 4000.
const CLOSEST_ROWS: f64 = 5e-5;

/// The outlines of N poses in correspondence, fixed to the mesh.
#[derive(Debug, Clone)]
pub struct Silhouette {
    rings: Vec<CarriedRing>,
}

/// A ring of every pose, by pose.
#[derive(Debug, Clone)]
struct CarriedRing {
    /// #rows anchors a pose.
    anchors: Vec<Vec<MeshPoint>>,
    /// These places, carried smoothly.
    smooth: Vec<SmoothPoints>,
}

impl CarriedRing {
    fn row_count(&self) -> usize {
        self.smooth.first().map_or(0, SmoothPoints::len)
    }
}

impl Silhouette {
    /// The silhouette of a mapping. Outer rings correspond by its matching, holes by the mesh's boundary.
    #[must_use]
    pub fn new(mapping: &Mapping) -> Self {
        let topology = mapping.poses.topology();
        let triangles = topology.triangles();
        let positions = mapping.poses.positions().par_iter();
        let locators: Vec<PointLocator> = positions
            .map(|positions| PointLocator::new(triangles, positions))
            .collect();
        let carriers: Vec<SmoothCarrier> = (0..mapping.poses.len())
            .into_par_iter()
            .map(|own| SmoothCarrier::new(topology, mapping.poses.positions(), own))
            .collect();
        // Where part of the boundary is hidden, it is where the mesh carries that of the reference.
        let seen: Vec<usize> = (0..mapping.poses.len())
            .map(|pose| match mapping.overlaps.depth(pose) {
                Some(_) => mapping.matching.reference,
                None => pose,
            })
            .collect();
        let outlines: Vec<&Outline> = seen.iter().filter_map(|pose| mapping.outlines.get(*pose)).collect();
        let ring_count = outlines.iter().map(|o| o.rings().len()).min().unwrap_or(0);
        let mut rings = Vec::new();
        for ring in 0..ring_count {
            let curves: Vec<&Ring> = outlines.iter().map(|o| &o.rings()[ring]).collect();
            let by_mesh;
            let correspondence = if ring == 0 {
                &mapping.matching.outer
            } else {
                by_mesh = correspondence_by_mesh(mapping, ring, &curves, &seen);
                &by_mesh
            };
            let measured: Vec<ArcLength> = curves.iter().map(|curve| ArcLength::new(curve)).collect();
            let rows = row_coordinates(correspondence, &measured);
            let anchors: Option<Vec<Vec<MeshPoint>>> = (0..locators.len())
                .into_par_iter()
                .map(|pose| {
                    let (locator, curve) = (&locators[seen[pose]], &measured[pose]);
                    locator.bind_along(rows.iter().map(|&row| curve.at(correspondence.parameter(pose, row))))
                })
                .collect();
            let carried = |anchors: Vec<Vec<MeshPoint>>| CarriedRing {
                smooth: (carriers.par_iter().zip(&anchors))
                    .map(|(carrier, anchors)| carrier.points(anchors))
                    .collect(),
                anchors,
            };
            // None: a mesh without triangles has no silhouette.
            rings.extend(anchors.map(carried));
        }
        Self { rings }
    }

    /// How many rings it has: those that all poses have, the outer one first.
    pub(super) fn ring_count(&self) -> usize {
        self.rings.len()
    }

    /// How far the outline of `pose`, carried by the mesh, may lie from the silhouette, across it: the most at the positions `poses` have.
    pub(super) fn shortfall(&self, pose: usize, poses: &[Vec<Point>]) -> f64 {
        let of_ring = |(other, ring): (usize, &CarriedRing)| {
            let Some(anchors) = ring.anchors.get(pose) else {
                return 0.0;
            };
            let positions = &poses[other];
            let own: Vec<Point> = anchors.iter().map(|anchor| anchor.at(positions)).collect();
            let away = (0..own.len()).map(|row| {
                let aside = ring.smooth[other].at(row, positions) - own[row];
                let along = own[(row + 1) % own.len()] - own[(row + own.len() - 1) % own.len()];
                let length = along.norm();
                if length > 0.0 {
                    point::cross(along, aside).abs() / length
                } else {
                    aside.norm()
                }
            });
            away.fold(0.0, f64::max)
        };
        let others = (0..poses.len()).filter(|other| *other != pose);
        let pairs = others.flat_map(|other| self.rings.iter().map(move |ring| (other, ring)));
        pairs.map(of_ring).fold(0.0, f64::max)
    }

    /// The rings of the shape whose mesh is at `positions` and whose poses count with `weights`: outer ring first.
    #[must_use]
    pub fn at(&self, positions: &[Point], weights: &[f64]) -> Vec<Vec<Point>> {
        let row = |ring: &CarriedRing, row: usize| -> Point {
            let poses = ring.smooth.iter().zip(weights);
            let counted = poses.filter(|(_, weight)| **weight != 0.0);
            counted
                .map(|(smooth, weight)| smooth.at(row, positions) * *weight)
                .sum()
        };
        let rings = self.rings.iter();
        rings
            .map(|ring| (0..ring.row_count()).map(|k| row(ring, k)).collect())
            .collect()
    }
}

/// The row coordinates of every row and of every vertex of every curve, sorted, near ones left out.
fn row_coordinates(correspondence: &Correspondence, curves: &[ArcLength]) -> Vec<f64> {
    let mut rows: Vec<f64> = (0..correspondence.rows().len()).map(|k| k as f64).collect();
    let of_pose = |(pose, curve): (usize, &ArcLength)| -> Vec<f64> {
        let vertices = curve.vertex_parameters().iter();
        vertices.map(|t| correspondence.row_coordinate(pose, *t)).collect()
    };
    let of_poses: Vec<Vec<f64>> = curves.par_iter().enumerate().map(of_pose).collect();
    rows.extend(of_poses.iter().flatten());
    rows.sort_by(f64::total_cmp);
    let mut kept: Vec<f64> = Vec::with_capacity(rows.len());
    for row in rows {
        let is_apart = kept.last().is_none_or(|last| {
            (0..curves.len()).any(|pose| {
                let gap = correspondence.parameter(pose, row) - correspondence.parameter(pose, *last);
                wrapped(gap).min(wrapped(-gap)) > CLOSEST_ROWS
            })
        });
        if is_apart {
            kept.push(row);
        }
    }
    kept
}

/// The correspondence of hole `ring` that the vertices of the mesh's boundary state: each at the nearest point of each
/// pose's curve, as long as the order is kept.
fn correspondence_by_mesh(mapping: &Mapping, ring: usize, curves: &[&Ring], seen: &[usize]) -> Correspondence {
    let measured: Vec<ArcLength> = curves.iter().map(|curve| ArcLength::new(curve)).collect();
    let vertices = mapping.rings.get(ring).map(Vec::as_slice).unwrap_or_default();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for &vertex in vertices {
        let row: Vec<f64> = measured
            .iter()
            .zip(seen)
            .map(|(curve, pose)| curve.nearest(mapping.poses.positions()[*pose][vertex]).0)
            .collect();
        // After the row before, and not beyond the first: less than a turn from it, on every pose.
        let ahead =
            |from: &[f64], to: &[f64]| -> Vec<f64> { from.iter().zip(to).map(|(a, b)| wrapped(b - a)).collect() };
        let fits = match (rows.first(), rows.last()) {
            (Some(first), Some(last)) => {
                let (travelled, next) = (ahead(first, last), ahead(last, &row));
                travelled.iter().zip(&next).all(|(t, n)| *n > 0.0 && t + n < 1.0)
            }
            _ => true,
        };
        if fits {
            rows.push(row);
        }
    }
    Correspondence::new(rows).unwrap_or_else(|_| Correspondence::identity(curves.len(), 256))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;
    use crate::pose::{Matching, PoseSet};

    fn ring(points: &[[f64; 2]]) -> Ring {
        Ring::new(points.iter().copied().map(Point::from)).expect("a ring")
    }

    /// Two squares of side 2 as meshes; in them a diamond and a square of side 1.
    fn mapping() -> Mapping {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]
            .map(Point::from)
            .to_vec();
        let topology = Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
        let diamond = ring(&[[1.0, 0.5], [1.5, 1.0], [1.0, 1.5], [0.5, 1.0]]);
        let square = ring(&[[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]);
        Mapping {
            poses: PoseSet::new(
                topology,
                vec![("a".to_owned(), corners.clone()), ("b".to_owned(), corners)],
            )
            .expect("poses"),
            outlines: vec![
                Outline::new(diamond, vec![]).expect("simple"),
                Outline::new(square, vec![]).expect("simple"),
            ],
            rings: vec![vec![0, 1, 2, 3]],
            steiner: 0,
            matching: Matching {
                reference: 0,
                outer: Correspondence::identity(2, 8),
            },
            overlaps: crate::pose::Overlaps::default(),
        }
    }

    #[test]
    fn a_weight_of_one_returns_that_outline() {
        let mapping = mapping();
        let silhouette = Silhouette::new(&mapping);
        for (pose, weights) in [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            let rings = silhouette.at(&mapping.poses.positions()[pose], &weights);
            let found = Ring::new(rings[0].clone()).expect("a ring");
            let given = mapping.outlines[pose].outer();
            assert!((found.signed_area() - given.signed_area()).abs() < 1e-12);
            for p in given.points() {
                assert!(found.points().iter().any(|q| (p - q).norm() < 1e-12));
            }
        }
    }

    #[test]
    fn halfway_lies_between_and_follows_the_mesh() {
        let mapping = mapping();
        let silhouette = Silhouette::new(&mapping);
        let moved: Vec<Point> = mapping.poses.positions()[0]
            .iter()
            .map(|p| p * 3.0 + Point::new(7.0, 0.0))
            .collect();
        let rings = silhouette.at(&moved, &[0.5, 0.5]);
        // Row 0: halfway from (1, 0.5) to (0.5, 0.5), times 3, shifted.
        assert!((rings[0][0] - Point::new(0.75 * 3.0 + 7.0, 1.5)).norm() < 1e-12);
    }
}
