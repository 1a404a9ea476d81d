//! Triangulations of the pose space, in units of the layout's diagonal with the layout's centre at the origin.
//!
//! Points are spread by a grid, points near a pose give way to it, and spade triangulates them (Delaunay). Two kinds:
//! - *even*: rows of equilateral triangles, what the paper's energy assumes;
//! - *graded*: the corners of a quadtree whose cells are small near the poses, smaller where poses crowd or walls are near,
//!   and grow with the distance. Grid coordinates are dyadic, so the domain's sides are exactly straight.
//!
//! Walls are edges of the triangulation. It is then cut open along them: a vertex on a wall becomes one vertex for each
//! side, and the end of a wall stays one. A part that walls shut off and that holds no pose is left out: it is a hole.

use std::collections::BTreeMap;

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::walls::Walls;
use super::{WallProblem, WeightError};
use crate::math::{DisjointSets, Point};
use crate::mesh::Topology;

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

/// Cells at the free end of a wall, where weights bend most, in diagonals.
const TIP_CELL: f64 = 1.0 / 48.0;

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

/// Rows of equilateral triangles with edges of 1/12 diagonal, the poses and the walls.
pub(super) fn even(poses: &[Point], walls: &Walls) -> Result<Tessellation, WeightError> {
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
    triangulate(poses, walls, |_| EVEN_EDGE, points.into_iter().map(|p| (p, EVEN_EDGE)))
}

/// The corners of a quadtree, the poses and the walls. `refinement` 0 is the usual mesh; each step halves every cell.
pub(super) fn graded(poses: &[Point], walls: &Walls, refinement: u32) -> Result<Tessellation, WeightError> {
    let finer = f64::from(1_u32 << refinement);
    let sizes = Sizes::new(poses, walls);
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
        if level < DEEPEST + refinement && cell > sizes.at(centre) / finer {
            let half = width / 2;
            stack.extend([(i, j), (i + half, j), (i, j + half), (i + half, j + half)].map(|(i, j)| (i, j, level + 1)));
        } else {
            for corner in [(i, j), (i + width, j), (i, j + width), (i + width, j + width)] {
                let smallest = corners.entry(corner).or_insert(cell);
                *smallest = smallest.min(cell);
            }
        }
    }
    let grid = corners.into_iter().map(|((i, j), cell)| (place(i, j), cell));
    triangulate(poses, walls, |p| sizes.at(p) / finer, grid)
}

/// How large the cells of a graded mesh are at each place.
struct Sizes<'a> {
    poses: &'a [Point],
    /// From each pose to the nearest other, or twice as far as to the nearest wall.
    nearest: Vec<f64>,
    tips: Vec<Point>,
}

impl<'a> Sizes<'a> {
    fn new(poses: &'a [Point], walls: &Walls) -> Self {
        let nearest = |(k, p): (usize, &Point)| {
            let others = poses.iter().enumerate().filter(|(other, _)| *other != k);
            others
                .map(|(_, q)| (p - q).norm())
                .fold(2.0 * walls.distance(*p), f64::min)
        };
        Self {
            poses,
            nearest: poses.iter().enumerate().map(nearest).collect(),
            tips: walls.tips(REACH),
        }
    }

    fn at(&self, p: Point) -> f64 {
        let mut cell = f64::INFINITY;
        let mut distance = f64::INFINITY;
        for (pose, nearest) in self.poses.iter().zip(&self.nearest) {
            let away = (p - pose).norm();
            distance = distance.min(away);
            cell = cell.min((nearest / CELLS_TO_NEIGHBOUR).max(GROWTH * away));
        }
        for tip in &self.tips {
            cell = cell.min(TIP_CELL + GROWTH * (p - tip).norm());
        }
        cell.min(GRADED_CELL + GROWTH * (distance - GROWTH_START).max(0.0))
    }
}

fn triangulate(
    poses: &[Point],
    walls: &Walls,
    cell_at: impl Fn(Point) -> f64,
    grid: impl Iterator<Item = (Point, f64)>,
) -> Result<Tessellation, WeightError> {
    let mut positions = poses.to_vec();
    let (on_walls, wall_edges) = divided(walls, cell_at, poses.len());
    positions.extend(&on_walls);
    // The points of the walls by the cells of a coarse grid would be faster to search; there are few.
    let is_corner = |p: &Point| p.x.abs() == REACH && p.y.abs() == REACH;
    for (p, cell) in grid {
        let clear = CLEARANCE * cell;
        let at_wall = !walls.is_empty()
            && if is_corner(&p) {
                on_walls.contains(&p)
            } else {
                walls.distance(p) <= clear
            };
        if !at_wall && poses.iter().all(|pose| (pose - p).norm() > clear) {
            positions.push(p);
        }
    }
    // Coordinates that spade calls too small to be exact with are zero here: the unit is the diagonal.
    let vertices: Vec<Point2<f64>> = positions
        .iter()
        .map(|p| Point2::new(flushed(p.x), flushed(p.y)))
        .collect();
    let tangled = || WeightError::Wall {
        wall: 0,
        problem: WallProblem::Tangled,
    };
    // Without edges the order of the vertices is all that it depends on. Only coordinates that are not finite, too large or
    // too small are refused, and there are none.
    let mut mesh =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::bulk_load_cdt(vertices, Vec::new()).map_err(|_| tangled())?;
    // Equal points would have been merged, and all later ones would have other numbers.
    if mesh.num_vertices() != positions.len() {
        return Err(tangled());
    }
    for [a, b] in wall_edges {
        let handle = spade::handles::FixedVertexHandle::from_index;
        // Rounding can bend a wall across another only where walls are closer than the snapping allows.
        if mesh.try_add_constraint(handle(a), handle(b)).is_empty() {
            return Err(tangled());
        }
    }
    let triangles: Vec<[usize; 3]> = mesh
        .inner_faces()
        .map(|face| face.vertices().map(|vertex| vertex.fix().index()))
        .collect();
    if walls.is_empty() {
        return Ok(Tessellation { positions, triangles });
    }
    let is_wall = |a: usize, b: usize| {
        let handle = spade::handles::FixedVertexHandle::from_index;
        mesh.exists_constraint(handle(a), handle(b))
    };
    cut_open(&positions, &triangles, poses.len(), is_wall).ok_or_else(tangled)
}

/// The walls' points and edges no longer than the cells there; points are numbered from `first`.
fn divided(walls: &Walls, cell_at: impl Fn(Point) -> f64, first: usize) -> (Vec<Point>, Vec<[usize; 2]>) {
    let mut points = walls.points.clone();
    let mut edges = Vec::new();
    let mut stack: Vec<[usize; 2]> = walls.segments.iter().rev().copied().collect();
    while let Some([a, b]) = stack.pop() {
        let middle = (points[a] + points[b]) * 0.5;
        if (points[b] - points[a]).norm() > 1.2 * cell_at(middle) {
            points.push(middle);
            let middle = points.len() - 1;
            stack.extend([[middle, b], [a, middle]]);
        } else {
            edges.push([first + a, first + b]);
        }
    }
    (points, edges)
}

/// Gives every side of a wall its own vertices, and leaves out the parts without a pose. `None` if the triangles are no
/// mesh.
fn cut_open(
    positions: &[Point],
    triangles: &[[usize; 3]],
    pose_count: usize,
    is_wall: impl Fn(usize, usize) -> bool,
) -> Option<Tessellation> {
    let topology = Topology::new(positions.len(), triangles.to_vec()).ok()?;
    // Corner 3 t + k of triangle t; corners joined around a vertex without crossing a wall are one vertex.
    let mut corners = DisjointSets::new(3 * triangles.len());
    let mut parts = DisjointSets::new(triangles.len());
    let corner = |t: usize, vertex: usize| triangles[t].iter().position(|&v| v == vertex).map(|k| 3 * t + k);
    for (t, neighbours) in topology.neighbours().iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangles[t][k], triangles[t][(k + 1) % 3]);
            let Some(other) = neighbours[k].filter(|&other| other < t && !is_wall(a, b)) else {
                continue;
            };
            parts.unite(t, other);
            for vertex in [a, b] {
                corners.unite(corner(t, vertex)?, corner(other, vertex)?);
            }
        }
    }
    let mut inhabited = vec![false; triangles.len()];
    for (t, triangle) in triangles.iter().enumerate() {
        if triangle.iter().any(|&v| v < pose_count) {
            inhabited[parts.root(t)] = true;
        }
    }
    let mut cut = Tessellation {
        positions: positions[..pose_count].to_vec(),
        triangles: Vec::new(),
    };
    let mut number = vec![usize::MAX; corners.len()];
    for (t, triangle) in triangles.iter().enumerate() {
        if !inhabited[parts.root(t)] {
            continue;
        }
        let mut vertices = [0; 3];
        for (k, &vertex) in triangle.iter().enumerate() {
            let class = corners.root(3 * t + k);
            if number[class] == usize::MAX {
                // A pose lies on no wall, so that it is one class and keeps its number.
                number[class] = if vertex < pose_count {
                    vertex
                } else {
                    cut.positions.push(positions[vertex]);
                    cut.positions.len() - 1
                };
            }
            vertices[k] = number[class];
        }
        cut.triangles.push(vertices);
    }
    Some(cut)
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
        let none = Walls::default();
        for mesh in [even(&poses, &none), graded(&poses, &none, 0), graded(&poses, &none, 1)] {
            let mesh = mesh.expect("no walls");
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
