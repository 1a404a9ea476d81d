//! A triangular lattice over a figure that keeps apart what the figure keeps apart.
//!
//! Every pixel of the figure belongs to the nearest point of a regular triangular lattice. The pixels of one lattice point that hang together
//! are a *cell* and become a vertex; where a point's pixels are in several pieces (two limbs side by side) it becomes several vertices. Cells
//! whose pixels touch are joined by an edge, three that touch one another by a triangle. So the lattice is connected as the figure is,
//! however thin its parts are.

use std::collections::{BTreeMap, VecDeque};

use crate::math::{DisjointSets, Matrix, Point, point};

/// Pieces of a cell smaller than this share of a whole one are united with the neighbour along most of their border.
const LEAST_CELL: f64 = 0.08;
/// A triangle's double area, in squares of the spacing, from which it carries points; a regular one has 0.87.
const LEAST_TRIANGLE: f64 = 0.2;
/// No cell.
const NONE: u32 = u32::MAX;

/// The lattice, in working pixels.
#[derive(Debug, Clone)]
pub(super) struct Lattice {
    pub(super) spacing: f64,
    pub(super) points: Vec<Point>,
    /// Pairs of vertices, the smaller first, sorted.
    pub(super) edges: Vec<[usize; 2]>,
    /// The vertices next to each.
    pub(super) neighbours: Vec<Vec<usize>>,
    /// Counter-clockwise.
    pub(super) triangles: Vec<[usize; 3]>,
    triangles_at: Vec<Vec<usize>>,
    width: usize,
    height: usize,
    /// By pixel: the cell it is in, or, outside the figure, the cell that is nearest.
    owner: Vec<u32>,
    /// By pixel: about how far it is from the figure, in pixels; 0 inside.
    distance: Vec<f32>,
}

impl Lattice {
    /// The lattice of a figure given as a mask of `width` columns. It has no vertex if the mask is empty.
    pub(super) fn new(mask: &[bool], width: usize, spacing: f64) -> Self {
        let height = mask.len().checked_div(width).unwrap_or(0);
        let grid = Grid { spacing, width, height };
        let (sites, labels) = cells(mask, &grid);
        let mut borders: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for_each_adjacent(width, height, |a, b| {
            let (a, b) = (labels[a], labels[b]);
            if a != b && a != NONE && b != NONE {
                *borders.entry([a.min(b) as usize, a.max(b) as usize]).or_default() += 1;
            }
        });
        let edges: Vec<[usize; 2]> = borders.into_keys().collect();
        let points: Vec<Point> = sites.into_iter().map(|site| grid.place(site)).collect();
        let mut neighbours = vec![Vec::new(); points.len()];
        for &[a, b] in &edges {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        let triangles = triangles(&points, &edges, &neighbours, spacing);
        let mut triangles_at = vec![Vec::new(); points.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for &v in triangle {
                triangles_at[v].push(t);
            }
        }
        let (owner, distance) = flooded(labels, width, height);
        Self {
            spacing,
            points,
            edges,
            neighbours,
            triangles,
            triangles_at,
            width,
            height,
            owner,
            distance,
        }
    }

    /// The cell at a place, or the one nearest to it, and about how far the figure is from there; `None` in an empty lattice.
    pub(super) fn cell_at(&self, p: Point) -> Option<(usize, f32)> {
        let column = (p.x.max(0.0) as usize).min(self.width.checked_sub(1)?);
        let row = (p.y.max(0.0) as usize).min(self.height.checked_sub(1)?);
        let k = row * self.width + column;
        (self.owner[k] != NONE).then(|| (self.owner[k] as usize, self.distance[k]))
    }

    /// Where a place goes when the vertices go to `places`: by the triangle of its cell that it is in or nearest to, or by the linear
    /// map of its cell in `frames` where there is no triangle.
    pub(super) fn carried(&self, places: &[Point], frames: &[Matrix], p: Point) -> Option<Point> {
        let (cell, _) = self.cell_at(p)?;
        let best = (self.triangles_at[cell].iter())
            .map(|&t| {
                let [a, b, c] = self.triangles[t].map(|v| self.points[v]);
                let double_area = point::cross(b - a, c - a);
                let u = point::cross(p - a, c - a) / double_area;
                let v = point::cross(b - a, p - a) / double_area;
                ([1.0 - u - v, u, v], t)
            })
            .max_by(|(a, _), (b, _)| {
                let least = |w: &[f64; 3]| w.iter().copied().fold(f64::INFINITY, f64::min);
                least(a).total_cmp(&least(b))
            });
        Some(match best {
            Some((weights, t)) => (self.triangles[t].iter().zip(weights))
                .map(|(&v, w)| places[v] * w)
                .sum(),
            None => places[cell] + frames[cell] * (p - self.points[cell]),
        })
    }

    /// By vertex, how far its place furthest inside the figure is from the edge, in pixels.
    pub(super) fn depths(&self) -> Vec<f64> {
        let mut depths = vec![0.0_f64; self.points.len()];
        let inside = depth_of_pixels(&self.distance, self.width, self.height);
        for (owner, depth) in self.owner.iter().zip(inside) {
            if let Some(most) = depths.get_mut(*owner as usize) {
                *most = most.max(f64::from(depth));
            }
        }
        depths
    }

    /// By vertex, those no further than `reach` away along edges, with their distances.
    pub(super) fn geodesic_neighbourhoods(&self, reach: f64) -> Vec<BTreeMap<usize, f64>> {
        (0..self.points.len())
            .map(|from| {
                // The edges are nearly equally long, so that going around in layers and relaxing again is as good as a queue by length.
                let mut known = BTreeMap::from([(from, 0.0)]);
                let mut waiting = VecDeque::from([from]);
                while let Some(at) = waiting.pop_front() {
                    let travelled = known[&at];
                    for &next in &self.neighbours[at] {
                        let length = travelled + (self.points[next] - self.points[at]).norm();
                        if length <= reach && known.get(&next).is_none_or(|known| length < *known - 1e-9) {
                            known.insert(next, length);
                            waiting.push_back(next);
                        }
                    }
                }
                known
            })
            .collect()
    }
}

/// The points of the regular lattice, by row and column; odd rows begin half a step further.
struct Grid {
    spacing: f64,
    width: usize,
    height: usize,
}

impl Grid {
    fn row_height(&self) -> f64 {
        self.spacing * 0.75_f64.sqrt()
    }

    fn place(&self, [row, column]: [i32; 2]) -> Point {
        let aside = if row % 2 == 0 { 0.0 } else { 0.5 };
        Point::new(
            (f64::from(column) + aside) * self.spacing,
            f64::from(row) * self.row_height(),
        )
    }

    /// The lattice point nearest to `p`.
    fn nearest(&self, p: Point) -> [i32; 2] {
        let row = (p.y / self.row_height()).floor() as i32;
        let mut best = ([row, 0], f64::INFINITY);
        for row in row..=row + 1 {
            let aside = if row % 2 == 0 { 0.0 } else { 0.5 };
            let site = [row, (p.x / self.spacing - aside).round() as i32];
            let distance = (self.place(site) - p).norm_squared();
            if distance < best.1 {
                best = (site, distance);
            }
        }
        best.0
    }
}

/// Calls `visit` with every two pixels side by side or one above the other.
fn for_each_adjacent(width: usize, height: usize, mut visit: impl FnMut(usize, usize)) {
    for k in 0..width * height {
        if (k + 1) % width != 0 {
            visit(k, k + 1);
        }
        if k + width < width * height {
            visit(k, k + width);
        }
    }
}

/// The lattice point of every cell, and the cell of every pixel.
fn cells(mask: &[bool], grid: &Grid) -> (Vec<[i32; 2]>, Vec<u32>) {
    let (width, height) = (grid.width, grid.height);
    let site = |k: usize| grid.nearest(Point::new((k % width) as f64 + 0.5, (k / width) as f64 + 0.5));
    let sites: Vec<[i32; 2]> = (0..mask.len())
        .map(|k| if mask[k] { site(k) } else { [i32::MIN; 2] })
        .collect();
    let mut pieces = DisjointSets::new(mask.len());
    for_each_adjacent(width, height, |a, b| {
        if mask[a] && mask[b] && sites[a] == sites[b] {
            pieces.unite(a, b);
        }
    });
    unite_small(&mut pieces, mask, grid);
    // Numbered in the order of their first pixels.
    let mut numbers: BTreeMap<usize, u32> = BTreeMap::new();
    let mut members: Vec<BTreeMap<[i32; 2], usize>> = Vec::new();
    let mut labels = vec![NONE; mask.len()];
    for k in (0..mask.len()).filter(|k| mask[*k]) {
        let number = *numbers.entry(pieces.root(k)).or_insert_with(|| {
            members.push(BTreeMap::new());
            (members.len() - 1) as u32
        });
        labels[k] = number;
        *members[number as usize].entry(sites[k]).or_default() += 1;
    }
    // A cell that small pieces were united with stays where most of it is.
    let main = |sites: &BTreeMap<[i32; 2], usize>| {
        let most = sites.iter().max_by_key(|(_, count)| **count);
        most.map_or([0; 2], |(site, _)| *site)
    };
    (members.iter().map(main).collect(), labels)
}

/// Unites every small piece with the neighbour along most of its border.
fn unite_small(pieces: &mut DisjointSets, mask: &[bool], grid: &Grid) {
    let whole = grid.spacing * grid.row_height();
    let mut sizes: BTreeMap<usize, usize> = BTreeMap::new();
    for k in (0..mask.len()).filter(|k| mask[*k]) {
        *sizes.entry(pieces.root(k)).or_default() += 1;
    }
    let is_small = |piece: usize| (sizes[&piece] as f64) < LEAST_CELL * whole;
    let mut borders: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for_each_adjacent(grid.width, grid.height, |a, b| {
        if mask[a] && mask[b] {
            let (a, b) = (pieces.root(a), pieces.root(b));
            for (small, other) in [(a, b), (b, a)] {
                if small != other && is_small(small) && !is_small(other) {
                    *borders.entry((small, other)).or_default() += 1;
                }
            }
        }
    });
    let mut longest: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for ((small, other), length) in borders {
        let best = longest.entry(small).or_insert((length, other));
        if length > best.0 {
            *best = (length, other);
        }
    }
    for (small, (_, other)) in longest {
        pieces.unite(small, other);
    }
}

fn triangles(points: &[Point], edges: &[[usize; 2]], neighbours: &[Vec<usize>], spacing: f64) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    for &[a, b] in edges {
        for &c in neighbours[a].iter().filter(|&&c| c > b && neighbours[b].contains(&c)) {
            let double_area = point::cross(points[b] - points[a], points[c] - points[a]);
            if double_area.abs() >= LEAST_TRIANGLE * spacing * spacing {
                triangles.push(if double_area > 0.0 { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    triangles
}

/// The labels spread to all pixels from the nearest labelled one, going from pixel to pixel, and how long the way is.
fn flooded(mut labels: Vec<u32>, width: usize, height: usize) -> (Vec<u32>, Vec<f32>) {
    let mut distance = vec![0.0; labels.len()];
    let mut waiting: VecDeque<(usize, usize)> = VecDeque::new();
    let origin_of = |k: usize| Point::new((k % width) as f64, (k / width) as f64);
    for k in (0..labels.len()).filter(|k| labels[*k] != NONE) {
        waiting.push_back((k, k));
    }
    while let Some((k, origin)) = waiting.pop_front() {
        let (column, row) = (k % width, k / width);
        let around = [
            (column > 0).then(|| k - 1),
            (column + 1 < width).then(|| k + 1),
            (row > 0).then(|| k - width),
            (row + 1 < height).then(|| k + width),
        ];
        for next in around.into_iter().flatten() {
            if labels[next] == NONE {
                labels[next] = labels[k];
                distance[next] = (origin_of(next) - origin_of(origin)).norm() as f32;
                waiting.push_back((next, origin));
            }
        }
    }
    (labels, distance)
}

/// How far every pixel inside is from the nearest one outside, in pixels, by steps to neighbours along rows, columns and diagonals; 0 outside.
fn depth_of_pixels(outside: &[f32], width: usize, height: usize) -> Vec<f32> {
    const DIAGONAL: f32 = std::f32::consts::SQRT_2;
    let far = (width + height) as f32;
    let mut depth: Vec<f32> = outside.iter().map(|d| if *d > 0.0 { 0.0 } else { far }).collect();
    let mut relax = |k: usize, sense: isize| {
        let (column, row) = ((k % width) as isize, (k / width) as isize);
        for (across, down, step) in [(-1, 0, 1.0), (0, -1, 1.0), (-1, -1, DIAGONAL), (1, -1, DIAGONAL)] {
            let (x, y) = (column + sense * across, row + sense * down);
            let is_there = (0..width as isize).contains(&x) && (0..height as isize).contains(&y);
            let other = if is_there {
                depth[y as usize * width + x as usize]
            } else {
                0.0
            };
            depth[k] = depth[k].min(other + step);
        }
    };
    (0..width * height).for_each(|k| relax(k, 1));
    (0..width * height).rev().for_each(|k| relax(k, -1));
    depth
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Matrix;

    #[test]
    fn two_strips_a_pixel_apart_are_two_components() {
        let (width, height) = (80, 31);
        let mask: Vec<bool> = (0..width * height).map(|k| k / width != 15).collect();
        let lattice = Lattice::new(&mask, width, 12.0);
        let mut reached = vec![false; lattice.points.len()];
        let (above, _) = lattice.cell_at(Point::new(40.0, 14.5)).expect("a cell");
        let (below, _) = lattice.cell_at(Point::new(40.0, 16.5)).expect("a cell");
        for vertex in lattice.geodesic_neighbourhoods(1e9)[above].keys() {
            reached[*vertex] = true;
        }
        assert!(!reached[below]);
        assert!(reached.iter().filter(|r| **r).count() > lattice.points.len() / 3);
    }

    #[test]
    fn a_line_thinner_than_the_spacing_is_one_component() {
        let (width, height) = (200, 120);
        let mask: Vec<bool> = (0..width * height)
            .map(|k| ((k % width) as f64 * 0.5 - (k / width) as f64).abs() < 1.5)
            .collect();
        let lattice = Lattice::new(&mask, width, 12.0);
        assert_eq!(lattice.geodesic_neighbourhoods(1e9)[0].len(), lattice.points.len());
        assert!(lattice.points.len() > 12);
    }

    #[test]
    fn an_affine_map_of_the_vertices_carries_points_exactly() {
        let (width, height) = (90, 70);
        let mask = vec![true; width * height];
        let lattice = Lattice::new(&mask, width, 11.0);
        let map = |p: Point| Matrix::new(1.2, 0.3, -0.1, 0.8) * p + Point::new(3.0, 5.0);
        let places: Vec<Point> = lattice.points.iter().map(|p| map(*p)).collect();
        let frames = vec![Matrix::identity(); places.len()];
        for p in [Point::new(40.2, 33.1), Point::new(88.0, 2.0), Point::new(-3.0, 71.0)] {
            let carried = lattice.carried(&places, &frames, p).expect("a cell");
            assert!((carried - map(p)).norm() < 1e-9, "{carried}");
        }
    }
}
