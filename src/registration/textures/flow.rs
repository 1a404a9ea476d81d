//! The warp of one pose.

use super::bending::limited;
use super::surface::{Covered, NONE, Surface};
use crate::appearance::{Appearance, CHANNELS, ChannelImage, Pixel};
use crate::math::{Matrix, Point};
use crate::mesh::{MeshPoint, PointLocator};

/// One level of the scale space: its blur in working pixels, the difference over all channels from which on something counts as another thing, and
/// how many steps are taken.
struct Level {
    deviation_px: f32,
    other: f32,
    steps: usize,
}

/// From coarse to fine.
const LEVELS: [Level; 5] = [
    Level::new(7.0, 0.50, 4),
    Level::new(4.0, 0.44, 4),
    Level::new(2.4, 0.38, 4),
    Level::new(1.4, 0.32, 3),
    Level::new(0.9, 0.25, 3),
];

impl Level {
    const fn new(deviation_px: f32, other: f32, steps: usize) -> Self {
        Self {
            deviation_px,
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

/// What all poses share.
pub(super) struct Flow<'a> {
    surface: &'a Surface,
    locator: &'a PointLocator,
    /// By level and pixel, what the reference shows.
    shown: Vec<Vec<Pixel>>,
}

impl<'a> Flow<'a> {
    pub(super) fn new(surface: &'a Surface, reference: &Appearance, locator: &'a PointLocator) -> Self {
        let shown = |level: &Level| seen(surface, &reference.blurred(level.deviation_px), &surface.vertices);
        Self {
            surface,
            locator,
            shown: LEVELS.iter().map(shown).collect(),
        }
    }

    /// The places of the mesh that show in `pose` what the reference shows at the vertices; `positions` are those of the mesh in the pose, in its working
    /// pixels. `None` where they are no more alike than the vertices themselves.
    pub(super) fn towards(&self, pose: &Appearance, positions: &[Point]) -> Option<Vec<MeshPoint>> {
        let mut displacements = vec![Point::zeros(); self.surface.vertices.len()];
        let mut image = None;
        for (level, shown) in LEVELS.iter().zip(&self.shown) {
            let blurred = &*image.insert(pose.blurred(level.deviation_px));
            for _ in 0..level.steps {
                let anchors = self.anchors(&displacements)?;
                let places: Vec<Point> = anchors.iter().map(|anchor| anchor.at(positions)).collect();
                displacements = self.step(level, shown, &seen(self.surface, blurred, &places), displacements);
            }
            displacements = limited(self.surface, displacements);
        }
        let (finest, shown, level) = (image?, self.shown.last()?, LEVELS.last()?);
        let differs = |displacements: &[Point]| {
            let anchors = self.anchors(displacements)?;
            let places: Vec<Point> = anchors.iter().map(|anchor| anchor.at(positions)).collect();
            let other = level.other * level.other;
            let differences = shown.iter().zip(seen(self.surface, &finest, &places)).map(|(a, b)| {
                let squared = squared_difference(a, &b);
                f64::from(squared * other / (squared + other))
            });
            Some((differences.sum::<f64>(), anchors))
        };
        let (before, _) = differs(&vec![Point::zeros(); displacements.len()])?;
        let (after, anchors) = differs(&displacements)?;
        (after < (1.0 - LEAST_GAIN) * before).then_some(anchors)
    }

    /// The places of the mesh that far from the vertices.
    fn anchors(&self, displacements: &[Point]) -> Option<Vec<MeshPoint>> {
        let places = self.surface.vertices.iter().zip(displacements).map(|(v, d)| v + d);
        self.locator.bind_beyond(places)
    }

    /// One step of Gauss and Newton: what the reference shows and what is seen of the pose, pixel by pixel.
    fn step(&self, level: &Level, shown: &[Pixel], seen: &[Pixel], displacements: Vec<Point>) -> Vec<Point> {
        let surface = self.surface;
        let other = level.other * level.other;
        let mut normal = vec![Matrix::zeros(); displacements.len()];
        let mut pull = vec![Point::zeros(); displacements.len()];
        for (k, pixel) in surface.pixels.iter().enumerate() {
            let squared = squared_difference(&shown[k], &seen[k]);
            let weight = (other / (squared + other)).powi(2);
            let [across, down] = gradient(pixel, k, shown, seen);
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

/// What `image` shows at every pixel of a surface whose vertices lie at `places`.
fn seen(surface: &Surface, image: &ChannelImage, places: &[Point]) -> Vec<Pixel> {
    let places: Vec<[f32; 2]> = places.iter().map(|p| [p.x as f32, p.y as f32]).collect();
    let at = |pixel: &Covered| {
        let (mut x, mut y) = (0.0, 0.0);
        for (v, share) in pixel.triangle.iter().zip(pixel.shares) {
            x += places[*v as usize][0] * share;
            y += places[*v as usize][1] * share;
        }
        image.at(x, y)
    };
    surface.pixels.iter().map(at).collect()
}

fn squared_difference(a: &Pixel, b: &Pixel) -> f32 {
    (0..CHANNELS).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum()
}

/// The mean gradient of both pictures, along x and y: differences across a pixel, or to it where the surface ends.
fn gradient(pixel: &Covered, k: usize, shown: &[Pixel], seen: &[Pixel]) -> [Pixel; 2] {
    let along = |[before, after]: [u32; 2]| {
        let of = |neighbour: u32| if neighbour == NONE { k } else { neighbour as usize };
        let steps = u32::from(before != NONE) + u32::from(after != NONE);
        let factor = if steps == 0 { 0.0 } else { 0.5 / steps as f32 };
        let (a, b) = (of(before), of(after));
        std::array::from_fn(|c| (shown[b][c] - shown[a][c] + seen[b][c] - seen[a][c]) * factor)
    };
    let [left, right, above, below] = pixel.around;
    [along([left, right]), along([above, below])]
}
