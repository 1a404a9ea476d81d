//! Triangulations of the pose space, in units of the layout's diagonal with the layout's centre at the origin.
//!
//! Points are spread by a grid, points near a pose give way to it, and spade triangulates them (Delaunay). Two kinds:
//! - *even*: rows of equilateral triangles, what the paper's energy assumes;
//! - *graded*: the corners of a quadtree whose cells are small near the poses, smaller where poses crowd, and grow
//!   with the distance. Grid coordinates are dyadic, so the domain's sides are exactly straight.

use std::collections::BTreeMap;

use spade::{DelaunayTriangulation, Point2, Triangulation};

use crate::math::Point;

/// How far the plane reaches from the layout's centre to each side, in layout diagonals.
pub(super) const REACH: f64 = 4.0;

/// Cells of the graded mesh near the poses, in diagonals: a power of two.
const GRADED_CELL: f64 = 1.0 / 16.0;

/// Cells grow by this much of the distance to the poses.
const GROWTH: f64 = 0.3;

/// Cells start to grow at this distance from the nearest pose, in diagonals.
const GROWTH_START: f64 = 0.5;

/// Cells between a pose and its nearest neighbour.
const CELLS_TO_NEIGHBOUR: f64 = 8.0;

/// The deepest level of the quadtree: cells of 1/8192 diagonal. Where poses lie closer, the mesh still holds them as
/// vertices, with longer triangles.
const DEEPEST: u32 = 16;

/// Edge length of the even mesh, in diagonals.
const EVEN_EDGE: f64 = 1.0 / 12.0;

/// A grid point nearer to a pose than this fraction of its cell is left out.
const CLEARANCE: f64 = 0.45;

/// Vertices and triangles; the first vertices are the poses, in order.
#[derive(Debug, Clone)]
pub(super) struct Tessellation {
    pub(super) positions: Vec<Point>,
    pub(super) triangles: Vec<[usize; 3]>,
}

/// Rows of equilateral triangles with edges of 1/12 diagonal, and the poses.
pub(super) fn even(poses: &[Point]) -> Tessellation {
    let columns = (2.0 * REACH / EVEN_EDGE).round() as usize;
    let rows = (2.0 * REACH / (EVEN_EDGE * 0.75_f64.sqrt())).round() as usize;
    let mut points = Vec::new();
    for j in 0..=rows {
        let y = -REACH + 2.0 * REACH * j as f64 / rows as f64;
        let at = |k: f64| Point::new(-REACH + 2.0 * REACH * k / columns as f64, y);
        if j % 2 == 0 {
            points.extend((0..=columns).map(|i| at(i as f64)));
        } else {
            // Odd rows are moved by half a step, and have both ends on the domain's sides.
            points.push(at(0.0));
            points.extend((0..columns).map(|i| at(i as f64 + 0.5)));
            points.push(at(columns as f64));
        }
    }
    triangulate(poses, points.into_iter().map(|p| (p, EVEN_EDGE)))
}

/// The corners of a quadtree and the poses. `refinement` 0 is the usual mesh; each step halves every cell.
pub(super) fn graded(poses: &[Point], refinement: u32) -> Tessellation {
    let nearest: Vec<f64> = poses
        .iter()
        .enumerate()
        .map(|(k, p)| {
            let others = poses.iter().enumerate().filter(|(other, _)| *other != k);
            others.map(|(_, q)| (p - q).norm()).fold(f64::INFINITY, f64::min)
        })
        .collect();
    let cell_at = |p: Point| {
        let mut cell = f64::INFINITY;
        let mut distance = f64::INFINITY;
        for (pose, nearest) in poses.iter().zip(&nearest) {
            let away = (p - pose).norm();
            distance = distance.min(away);
            cell = cell.min((nearest / CELLS_TO_NEIGHBOUR).max(GROWTH * away));
        }
        cell.min(GRADED_CELL + GROWTH * (distance - GROWTH_START).max(0.0))
    };
    // Corners on the finest grid, each with the size of the smallest cell it belongs to.
    let mut corners: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    let mut stack = vec![(0_u32, 0_u32, 0_u32)];
    let finest = 1_u32 << (DEEPEST + refinement);
    let place = |i: u32, j: u32| {
        let step = 2.0 * REACH / f64::from(finest);
        Point::new(-REACH + f64::from(i) * step, -REACH + f64::from(j) * step)
    };
    while let Some((i, j, level)) = stack.pop() {
        let width = finest >> level;
        let cell = 2.0 * REACH / f64::from(1_u32 << level);
        let centre = place(i + width / 2, j + width / 2);
        if level < DEEPEST + refinement && cell > cell_at(centre) / f64::from(1_u32 << refinement) {
            let half = width / 2;
            stack.extend([(i, j), (i + half, j), (i, j + half), (i + half, j + half)].map(|(i, j)| (i, j, level + 1)));
        } else {
            for corner in [(i, j), (i + width, j), (i, j + width), (i + width, j + width)] {
                let smallest = corners.entry(corner).or_insert(cell);
                *smallest = smallest.min(cell);
            }
        }
    }
    triangulate(poses, corners.into_iter().map(|((i, j), cell)| (place(i, j), cell)))
}

fn triangulate(poses: &[Point], points: impl Iterator<Item = (Point, f64)>) -> Tessellation {
    let mut positions = poses.to_vec();
    for (p, cell) in points {
        if poses.iter().all(|pose| (pose - p).norm() > CLEARANCE * cell) {
            positions.push(p);
        }
    }
    // Coordinates that spade calls too small to be exact with are zero here: the unit is the diagonal.
    let vertices = positions
        .iter()
        .map(|p| Point2::new(flushed(p.x), flushed(p.y)))
        .collect();
    let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(vertices);
    let triangles = match triangulation {
        Ok(triangulation) => triangulation
            .inner_faces()
            .map(|face| face.vertices().map(|vertex| vertex.fix().index()))
            .collect(),
        // Only coordinates that are not finite, too large or too small are refused, and there are none.
        Err(_) => Vec::new(),
    };
    Tessellation { positions, triangles }
}

fn flushed(coordinate: f64) -> f64 {
    if coordinate.abs() < spade::MIN_ALLOWED_VALUE {
        0.0
    } else {
        coordinate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Topology, geometry};

    #[test]
    fn meshes_cover_the_square_and_hold_the_poses() {
        let poses = [[-0.3, 0.4], [0.3, -0.4], [0.31, -0.39], [0.0, 0.0]].map(Point::from);
        for mesh in [even(&poses), graded(&poses, 0), graded(&poses, 1)] {
            assert_eq!(mesh.positions[..4], poses);
            let area: f64 = mesh
                .triangles
                .iter()
                .map(|&t| geometry::signed_area(geometry::corners(&mesh.positions, t)))
                .sum();
            assert!((area - 4.0 * REACH * REACH).abs() < 1e-9, "{area}");
            let topology = Topology::new(mesh.positions.len(), mesh.triangles.clone()).expect("a mesh");
            assert_eq!(topology.euler_characteristic(), 1);
            let smallest = mesh
                .triangles
                .iter()
                .map(|&t| geometry::smallest_angle_rad(geometry::corners(&mesh.positions, t)))
                .fold(f64::INFINITY, f64::min);
            assert!(smallest.to_degrees() > 5.0, "{}", smallest.to_degrees());
        }
    }
}
