//! What the reference shows around every vertex of its lattice, and how well another drawing shows it elsewhere.

use rayon::prelude::*;

use super::lattice::Lattice;
use crate::appearance::{ByteImage, Bytes, ChannelImage, STEPS_PER_UNIT};
use crate::math::{Matrix, Point, vectorised};

/// Patches are sampled in so many steps from their middle to their edge.
const STEPS_A_RADIUS: f64 = 3.5;
/// The Gaussian that patches are weighted with, in radii.
const FALL: f64 = 0.7;
/// How far along the lattice a place may be from a patch's middle, in radii, to be part of it: across a gap there is another limb.
const GEODESIC_REACH: f64 = 1.5;
/// What places outside the figure weigh beside those inside: what is behind an edge says where the edge is, but not as surely.
const OUTSIDE_WEIGHT: f32 = 0.6;
/// What places weigh that are far outside: nothing is known of them.
const FAR_WEIGHT: f32 = 0.3;
/// Trust falls by a factor e when the best place in the window differs by this share of [`MOST_DIFFERENCE`].
pub(super) const DOUBT: f32 = 0.25;
/// Differences of a place, over all channels, count no more than this: what only one drawing has is left out.
pub(super) const MOST_DIFFERENCE: f32 = 1.2;
/// Vertices a task.
const VERTICES_A_TASK: usize = 16;

/// Patches of the reference at one level of its scale space.
#[derive(Debug)]
pub(super) struct Template {
    offsets: Vec<Point>,
    /// #vertices x #offsets.
    pixels: Vec<Bytes>,
    /// Likewise, scaled so that those of a vertex sum to 1.
    weights: Vec<f32>,
}

/// Where in its search window a vertex fits: the soft minimum of its costs.
#[derive(Clone, Copy)]
pub(super) struct Fit {
    /// Mean displacement, in pixels.
    pub(super) displacement: Point,
    /// Its covariance.
    pub(super) covariance: Matrix,
    /// The least cost, in the mean over the patch.
    pub(super) residual: f32,
}

impl Fit {
    /// Where the vertex is drawn to from `place`, and the trust in it: less where the best place differs, and none along what looks alike. `floor` is what a step
    /// of the search cannot tell, `spacing` the lattice's.
    pub(super) fn target(&self, place: Point, floor: Matrix, spacing: f64) -> (Point, Matrix) {
        let confidence = f64::from(libm::expf(-self.residual / (DOUBT * MOST_DIFFERENCE)));
        let inverse = (self.covariance + floor).try_inverse().unwrap_or_else(Matrix::zeros);
        (place + self.displacement, inverse * confidence * spacing.powi(2))
    }
}

impl Template {
    /// Patches with this radius, in pixels.
    pub(super) fn new(lattice: &Lattice, image: &ChannelImage, radius: f64) -> Self {
        Self::sampled(lattice, image, radius, (STEPS_A_RADIUS, OUTSIDE_WEIGHT))
    }

    /// Patches in so many steps from their middle to their edge, whose places outside the figure weigh as is said.
    pub(super) fn sampled(
        lattice: &Lattice,
        image: &ChannelImage,
        radius: f64,
        (steps, outside_weight): (f64, f32),
    ) -> Self {
        let offsets = disc(radius, (radius / steps).max(1.0));
        let reach = GEODESIC_REACH * radius + lattice.spacing;
        let near = lattice.geodesic_neighbourhoods(reach);
        let far = (1.5 * lattice.spacing).max(0.5 * radius) as f32;
        let of_vertex = |v: usize| {
            let middle = lattice.points[v];
            let mut pixels = Vec::with_capacity(offsets.len());
            let mut weights = Vec::with_capacity(offsets.len());
            for offset in &offsets {
                let place = middle + offset;
                pixels.push(Bytes::new(&image.at(place.x as f32, place.y as f32)));
                weights.push(match lattice.cell_at(place) {
                    Some((cell, outside)) if near[v].contains_key(&cell) => {
                        let fall = offset.norm_squared() / (FALL * radius * FALL * radius);
                        let inside = if outside > 0.0 { outside_weight } else { 1.0 };
                        let known = if outside > far { FAR_WEIGHT } else { 1.0 };
                        libm::expf(-0.5 * fall as f32) * inside * known
                    }
                    _ => 0.0,
                });
            }
            let sum = weights.iter().sum::<f32>().max(1e-6);
            weights.iter_mut().for_each(|weight| *weight /= sum);
            (pixels, weights)
        };
        let patches: Vec<_> = (0..lattice.points.len()).into_par_iter().map(of_vertex).collect();
        let mut template = Self {
            offsets,
            pixels: Vec::new(),
            weights: Vec::new(),
        };
        for (pixels, weights) in patches {
            template.pixels.extend(pixels);
            template.weights.extend(weights);
        }
        template
    }

    /// How well the patch of every vertex fits `image` at the places of `window` around `places`, under the linear maps `frames`.
    pub(super) fn fits(
        &self,
        image: &ByteImage,
        places: &[Point],
        frames: &[Matrix],
        window: &Window,
        temperature: f32,
    ) -> Vec<Fit> {
        let all: Vec<usize> = (0..places.len()).collect();
        self.fits_of(&all, image, places, frames, window, temperature)
    }

    /// How well the patches of some vertices fit, as of [`Self::fits`].
    pub(super) fn fits_of(
        &self,
        vertices: &[usize],
        image: &ByteImage,
        places: &[Point],
        frames: &[Matrix],
        window: &Window,
        temperature: f32,
    ) -> Vec<Fit> {
        let offsets: Vec<usize> = (window.candidates.iter())
            .map(|&[x, y]| image.offset([x + window.reach as i32, y + window.reach as i32]) as usize)
            .collect();
        let displacements: Vec<Point> = (window.candidates.iter())
            .map(|&[x, y]| Point::new(f64::from(x), f64::from(y)))
            .collect();
        let fit = |&v: &usize| {
            let mut costs = vec![0.0; offsets.len()];
            vectorised(
                #[inline(always)]
                || self.costs(image, v, places[v], &frames[v], (window.reach, &offsets), &mut costs),
            );
            soft_minimum(&costs, &displacements, temperature)
        };
        let tasks = vertices.par_iter().with_min_len(VERTICES_A_TASK);
        tasks.map(fit).collect()
    }

    /// The mean difference of vertex `v`'s patch at one place, under one linear map.
    pub(super) fn difference_at(&self, image: &ByteImage, v: usize, place: Point, frame: &Matrix) -> f32 {
        let mut cost = [0.0];
        self.costs(image, v, place, frame, (0, &[0]), &mut cost);
        cost[0]
    }

    /// The mean difference of vertex `v`'s patch at every candidate.
    #[inline(always)]
    fn costs(
        &self,
        image: &ByteImage,
        v: usize,
        place: Point,
        frame: &Matrix,
        (reach, offsets): (usize, &[usize]),
        costs: &mut [f32],
    ) {
        const MOST: u32 = (MOST_DIFFERENCE * STEPS_PER_UNIT) as u32;
        let count = self.offsets.len();
        let patch = &self.pixels[v * count..(v + 1) * count];
        let weights = &self.weights[v * count..(v + 1) * count];
        for ((offset, pixel), &weight) in self.offsets.iter().zip(patch).zip(weights) {
            if weight <= 0.0 {
                continue;
            }
            let sampled = place + frame * offset;
            let around = image.around(sampled.x as f32, sampled.y as f32, reach);
            let weight = weight / STEPS_PER_UNIT;
            for (cost, &offset) in costs.iter_mut().zip(offsets) {
                *cost += weight * pixel.difference(&around[offset]).min(MOST) as f32;
            }
        }
    }
}

/// Mean and covariance of the candidates, weighted by `exp(-cost / temperature)`.
fn soft_minimum(costs: &[f32], candidates: &[Point], temperature: f32) -> Fit {
    let least = costs.iter().copied().fold(f32::INFINITY, f32::min);
    let (mut sum, mut mean) = (0.0, Point::zeros());
    let mut second = Matrix::zeros();
    for (cost, candidate) in costs.iter().zip(candidates) {
        let weight = f64::from(libm::expf(-(cost - least) / temperature));
        sum += weight;
        mean += candidate * weight;
        second += candidate * candidate.transpose() * weight;
    }
    mean /= sum;
    Fit {
        displacement: mean,
        covariance: second / sum - mean * mean.transpose(),
        residual: least,
    }
}

/// The displacements that a search tries: those of a square grid within a disc, in whole pixels.
pub(super) struct Window {
    candidates: Vec<[i32; 2]>,
    pub(super) reach: usize,
    pub(super) step: f64,
}

impl Window {
    /// The covariance that a step of the search cannot tell.
    pub(super) fn floor(&self) -> Matrix {
        Matrix::identity() * (0.25 * self.step * self.step)
    }

    /// A disc of this radius in steps of at least a pixel, both in pixels and rounded.
    pub(super) fn new(radius: f64, step: f64) -> Self {
        let step = step.round().max(1.0);
        let candidates: Vec<[i32; 2]> = (disc(radius, step).iter()).map(|p| [p.x as i32, p.y as i32]).collect();
        Self {
            reach: candidates
                .iter()
                .map(|c| c[0].unsigned_abs().max(c[1].unsigned_abs()))
                .max()
                .unwrap_or(0) as usize,
            candidates,
            step,
        }
    }

    /// No search: where it is.
    pub(super) fn here() -> Self {
        Self::new(0.0, 1.0)
    }
}

/// The points of a square grid within a disc around the origin.
fn disc(radius: f64, step: f64) -> Vec<Point> {
    let reach = (radius / step) as i32;
    let line = move || (-reach..=reach).map(move |k| f64::from(k) * step);
    line()
        .flat_map(|y| line().map(move |x| Point::new(x, y)))
        .filter(|p| p.norm() <= radius + 1e-6)
        .collect()
}
