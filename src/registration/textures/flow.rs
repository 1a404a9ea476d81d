//! The warp of one pose.

use rayon::prelude::*;

use super::bending::limited;
use super::surface::{Covered, Grid, NONE, Surface};
use crate::appearance::{Appearance, CHANNELS, ChannelImage, Pixel};
use crate::math::{Matrix, Point};
use crate::mesh::{MeshPoint, PointLocator, geometry};

/// One level of the scale space: its blur in working pixels, how many of those are from one sample to the next, the difference over all channels from
/// which on something counts as another thing, and how many steps are taken.
struct Level {
    deviation_px: f32,
    sampled: usize,
    other: f32,
    steps: usize,
}

/// From coarse to fine.
const LEVELS: [Level; 4] = [
    Level::new(6.0, 3, 0.48, 4),
    Level::new(3.0, 2, 0.40, 4),
    Level::new(1.6, 1, 0.32, 3),
    Level::new(0.9, 1, 0.25, 2),
];

impl Level {
    const fn new(deviation_px: f32, sampled: usize, other: f32, steps: usize) -> Self {
        Self {
            deviation_px,
            sampled,
            other,
            steps,
        }
    }
}

/// What a difference of a pixel between the displacements of neighbours counts, beside the squared differences of colours over the pixels around a vertex.
const MEMBRANE: f64 = 0.015;
/// What a displacement of a pixel counts.
const REST: f64 = 1e-5;
/// Sweeps in which displacements are relaxed, a step.
const SWEEPS: usize = 40;
/// The longest displacement, in working pixels: what is further away is another thing.
const FARTHEST_PX: f64 = 18.0;
/// The share of what differed that has to be gone for the warp to be worth having.
const LEAST_GAIN: f64 = 0.02;

/// The mesh that carries a surface, on the reference.
pub(super) struct Carrier<'a> {
    /// In working pixels.
    pub(super) positions: &'a [Point],
    pub(super) locator: &'a PointLocator,
    /// Where the surface's vertices are on it.
    pub(super) places: &'a [MeshPoint],
}

/// What all poses share.
pub(super) struct Flow<'a> {
    surface: &'a Surface,
    mesh: Carrier<'a>,
    /// By level, the samples and what the reference shows there.
    shown: Vec<(Grid, Vec<Pixel>)>,
}

impl<'a> Flow<'a> {
    pub(super) fn new(surface: &'a Surface, reference: &Appearance, mesh: Carrier<'a>) -> Self {
        let shown = |level: &Level| {
            let grid = Grid::new(surface, reference.size(), level.sampled);
            let shown = seen(&grid, &reference.blurred(level.deviation_px), &surface.vertices);
            (grid, shown)
        };
        Self {
            surface,
            mesh,
            shown: LEVELS.par_iter().map(shown).collect(),
        }
    }

    /// The places of the mesh that show in `pose` what the reference shows at the vertices; `positions` are those of the mesh in the pose, in its working
    /// pixels. `None` where they are no more alike than the vertices themselves.
    pub(super) fn towards(&self, pose: &Appearance, positions: &[Point]) -> Option<Vec<MeshPoint>> {
        let mut displacements = vec![Point::zeros(); self.surface.vertices.len()];
        let mut image = None;
        for (level, (grid, shown)) in LEVELS.iter().zip(&self.shown) {
            let blurred = &*image.insert(pose.blurred(level.deviation_px));
            for _ in 0..level.steps {
                let anchors = self.anchors(&displacements);
                let places: Vec<Point> = anchors.iter().map(|anchor| anchor.at(positions)).collect();
                displacements = self.step(level, grid, [shown, &seen(grid, blurred, &places)], displacements);
            }
            displacements = limited(self.surface, displacements);
        }
        let (finest, (grid, shown), level) = (image?, self.shown.last()?, LEVELS.last()?);
        let differs = |displacements: &[Point]| {
            let anchors = self.anchors(displacements);
            let places: Vec<Point> = anchors.iter().map(|anchor| anchor.at(positions)).collect();
            let other = level.other * level.other;
            let differences = shown.iter().zip(seen(grid, &finest, &places)).map(|(a, b)| {
                let squared = squared_difference(a, &b);
                f64::from(squared * other / (squared + other))
            });
            (differences.sum::<f64>(), anchors)
        };
        let (before, _) = differs(&vec![Point::zeros(); displacements.len()]);
        let (after, anchors) = differs(&displacements);
        (after < (1.0 - LEAST_GAIN) * before).then_some(anchors)
    }

    /// The places of the mesh that far from the vertices. Beyond the mesh's edge they are carried by the triangle that has the vertex.
    fn anchors(&self, displacements: &[Point]) -> Vec<MeshPoint> {
        let mesh = &self.mesh;
        let moved = |((own, vertex), displacement): ((&MeshPoint, &Point), &Point)| {
            let place = vertex + displacement;
            let corners = geometry::corners(mesh.positions, own.vertices);
            let Some(shares) = geometry::barycentric(corners, place) else {
                return *own;
            };
            let beyond = MeshPoint {
                vertices: own.vertices,
                shares,
            };
            if shares.iter().all(|share| *share >= 0.0) {
                return beyond;
            }
            mesh.locator.bind_inside(place).unwrap_or(beyond)
        };
        let vertices = mesh.places.iter().zip(&self.surface.vertices);
        vertices.zip(displacements).map(moved).collect()
    }

    /// One step of Gauss and Newton: what the reference shows and what is seen of the pose, pixel by pixel.
    fn step(&self, level: &Level, grid: &Grid, pictures: [&[Pixel]; 2], displacements: Vec<Point>) -> Vec<Point> {
        let [shown, seen] = pictures;
        // As many as the samples stand for.
        let count = (grid.step * grid.step) as f32;
        let a_step = 1.0 / grid.step as f32;
        let other = level.other * level.other;
        let mut normal = vec![Matrix::zeros(); displacements.len()];
        let mut pull = vec![Point::zeros(); displacements.len()];
        for (k, pixel) in grid.pixels.iter().enumerate() {
            let squared = squared_difference(&shown[k], &seen[k]);
            let weight = count * (other / (squared + other)).powi(2);
            let [across, down] = gradient(pixel, k, pictures, a_step);
            let (mut xx, mut xy, mut yy, mut x, mut y) = (0.0f32, 0.0f32, 0.0f32, 0.0f32, 0.0f32);
            for c in 0..CHANNELS {
                let difference = seen[k][c] - shown[k][c];
                xx += across[c] * across[c];
                xy += across[c] * down[c];
                yy += down[c] * down[c];
                x += across[c] * difference;
                y += down[c] * difference;
            }
            for (v, share) in pixel.triangle.iter().zip(pixel.shares) {
                let weight = f64::from(weight * share);
                let [xx, xy, yy, x, y] = [xx, xy, yy, x, y].map(f64::from);
                normal[*v as usize] += Matrix::new(xx, xy, xy, yy) * weight;
                pull[*v as usize] -= Point::new(x, y) * weight;
            }
        }
        for (v, (pull, normal)) in pull.iter_mut().zip(&normal).enumerate() {
            *pull += normal * displacements[v];
        }
        self.relaxed(&normal, &pull, displacements)
    }

    /// The displacements for which what pulls at each vertex and its neighbours are in balance.
    fn relaxed(&self, normal: &[Matrix], pull: &[Point], mut displacements: Vec<Point>) -> Vec<Point> {
        let neighbours = &self.surface.neighbours;
        let inverse: Vec<Matrix> = (normal.iter().zip(neighbours))
            .map(|(normal, around)| {
                let whole = normal + Matrix::identity() * (REST + MEMBRANE * around.len() as f64);
                whole.try_inverse().unwrap_or_else(Matrix::zeros)
            })
            .collect();
        for _ in 0..SWEEPS {
            for v in 0..displacements.len() {
                let sum: Point = neighbours[v].iter().map(|w| displacements[*w]).sum();
                displacements[v] = (inverse[v] * (pull[v] + sum * MEMBRANE)).cap_magnitude(FARTHEST_PX);
            }
        }
        displacements
    }
}

/// What `image` shows at every pixel of a grid whose surface has its vertices at `places`.
fn seen(grid: &Grid, image: &ChannelImage, places: &[Point]) -> Vec<Pixel> {
    let places: Vec<[f32; 2]> = places.iter().map(|p| [p.x as f32, p.y as f32]).collect();
    let at = |pixel: &Covered| {
        let (mut x, mut y) = (0.0, 0.0);
        for (v, share) in pixel.triangle.iter().zip(pixel.shares) {
            x += places[*v as usize][0] * share;
            y += places[*v as usize][1] * share;
        }
        image.at(x, y)
    };
    grid.pixels.iter().map(at).collect()
}

fn squared_difference(a: &Pixel, b: &Pixel) -> f32 {
    (0..CHANNELS).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum()
}

/// The mean gradient of both pictures, along x and y: differences across a pixel, or to it where the surface ends, times `scale`.
fn gradient(pixel: &Covered, k: usize, [shown, seen]: [&[Pixel]; 2], scale: f32) -> [Pixel; 2] {
    let along = |[before, after]: [u32; 2]| {
        let of = |neighbour: u32| if neighbour == NONE { k } else { neighbour as usize };
        let steps = u32::from(before != NONE) + u32::from(after != NONE);
        let factor = if steps == 0 { 0.0 } else { 0.5 * scale / steps as f32 };
        let (a, b) = (of(before), of(after));
        std::array::from_fn(|c| (shown[b][c] - shown[a][c] + seen[b][c] - seen[a][c]) * factor)
    };
    let [left, right, above, below] = pixel.around;
    [along([left, right]), along([above, below])]
}
