//! Where in the pose space does the hand reach the cup? Inverse kinematics inside the artist's own space.
//!
//! Named points of the shape and a target each in, the place of the pose space out whose drawing brings the points nearest to
//! the targets. Like mesh-based inverse kinematics (Sumner, Zwicker, Gotsman, Popović 2005), but what is searched is the space that
//! the poses were laid out in, not all combinations of them: whatever is found is a drawing the artist has arranged for.
//!
//! 1. The sum of squared distances is looked at in every pose's place and in places spread evenly over the box of the poses,
//!    widened on every side (Halton's sequence: the same places every time, in any dimension).
//! 2. From the best of them: damped least squares (Levenberg 1944, Marquardt 1963) with differences for derivatives, kept
//!    in the box; a coordinate that pushes against its side is left out.
//! 3. The least distance wins; among equal ones the place nearest to a pose.
//!
//! Cost: an evaluation is one blend; their number is fixed in the first step, bounded in the second, and reported.
//!
//! Limits: a search, not a proof: between the first step's places a narrow valley may be missed.

use super::blending::blend_options;
use super::spec::{CharacterSpec, LayerRole, LayerSpec, Places};
use super::{PipelineError, automatic_places, editable_weights, map_layer};
use crate::blend::{BlendScratch, RigidBlend};
use crate::math::{Point, point};
use crate::mesh::{MeshPoint, PointLocator};
use crate::pose::{LandmarkKind, PlacedLandmark, PoseSet};
use crate::solve::{DenseMatrix, SolvedDense};
use crate::weights::WeightProvider;

/// Differences are taken over this share of the box's diagonal: weights are smooth, and a blend has twelve digits.
const DIFFERENCE: f64 = 1e-6;
/// A step shorter than this share of the box's diagonal is the last.
const SHORTEST_STEP: f64 = 1e-10;
/// Distances that differ by less than this share of the shape's size are equal: a hundredth of a pixel of a drawing of a thousand.
const EQUAL: f64 = 1e-5;
/// The damping at first, relative to the curvature of each coordinate.
const DAMPING: f64 = 1e-3;
/// How many landmarks a refusal names.
const NAMED: usize = 12;
/// Damping beyond which no step is found any more.
const MOST_DAMPING: f64 = 1e12;

/// How hard to search.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ReachOptions {
    /// Places looked at besides the poses' own, for each dimension of the space. Default: 96.
    pub places: usize,
    /// How many of them the search goes on from. Default: 8.
    pub starts: usize,
    /// The most steps from each. Default: 60.
    pub steps: usize,
    /// How far beyond the box of the poses the search may go, in its diagonals: far outside, blends are wild. Default:
    /// 0.25.
    pub beyond: f64,
}

impl Default for ReachOptions {
    fn default() -> Self {
        Self {
            places: 96,
            starts: 8,
            steps: 60,
            beyond: 0.25,
        }
    }
}

/// A point of the shape, fixed to the mesh in every pose. In a blend it lies at the weighted mean of where the mesh
/// carries the poses' points, as the drawn outline does.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapePoint {
    /// One a pose.
    pub(super) anchors: Vec<MeshPoint>,
}

impl ShapePoint {
    /// The point that lies at `at` (one place a pose, on the mesh or next to it).
    ///
    /// `None` if there is not one place a pose, or the mesh has no triangle.
    #[must_use]
    pub fn new(poses: &PoseSet, at: &[Point]) -> Option<Self> {
        let triangles = poses.topology().triangles();
        let anchor = |(positions, place): (&Vec<Point>, &Point)| PointLocator::new(triangles, positions).bind(*place);
        if at.len() != poses.len() {
            return None;
        }
        let anchors = poses.positions().iter().zip(at).map(anchor).collect::<Option<_>>()?;
        Some(Self { anchors })
    }

    /// The point that one triangle carries in all of `poses` poses.
    #[must_use]
    pub fn on_mesh(point: MeshPoint, poses: usize) -> Self {
        Self {
            anchors: vec![point; poses],
        }
    }

    /// The point that is these in the poses.
    pub(super) fn from_anchors(anchors: Vec<MeshPoint>) -> Self {
        Self { anchors }
    }

    /// Where it is on the mesh at `positions`, blended with `weights`.
    #[must_use]
    pub fn at(&self, positions: &[Point], weights: &[f64]) -> Point {
        self.anchors
            .iter()
            .zip(weights)
            .map(|(anchor, weight)| anchor.at(positions) * *weight)
            .sum()
    }
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Reach {
    /// The place of the pose space.
    pub at: Vec<f64>,
    /// The weights there, one a pose.
    pub weights: Vec<f64>,
    /// Where the points come to lie, in source units.
    pub reached: Vec<Point>,
    /// The root of the mean squared distance from the targets, in source units; of one point, its distance.
    pub error: f64,
    /// Blends that were tried.
    pub evaluations: usize,
}

/// The place of a pose space where `points` come nearest to `targets` (one a point, in source units); `places` are those
/// of the poses.
///
/// # Errors
/// [`PipelineError`] if the numbers of points and targets differ or are 0, a target is not finite, or nothing can be
/// blended.
pub fn reach(
    weights: &dyn WeightProvider,
    blend: &RigidBlend,
    places: &[Vec<f64>],
    points: &[ShapePoint],
    targets: &[Point],
    options: &ReachOptions,
) -> Result<Reach, PipelineError> {
    let mut search = Search::new(weights, blend, places, points, targets, options)?;
    let mut looked_at: Vec<(f64, Vec<f64>)> = Vec::new();
    let count = if search.size > 0.0 {
        options.places * weights.dimension()
    } else {
        0
    };
    let spread: Vec<Vec<f64>> = (1..=count).map(|k| search.spread(k)).collect();
    let mut equal = 0.0;
    for (k, place) in places.iter().cloned().chain(spread).enumerate() {
        let squared = search.residuals(&place)?.iter().map(|r| r * r).sum();
        looked_at.push((squared, place));
        if k == 0 {
            equal = EQUAL * point::diagonal(&search.positions);
        }
    }
    looked_at.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f64, f64, Vec<f64>)> = None;
    for (_, start) in looked_at.into_iter().take(options.starts.max(1)) {
        let (error, at) = search.refined(start, options.steps)?;
        let from_poses = places
            .iter()
            .map(|place| distance(place, &at))
            .fold(f64::INFINITY, f64::min);
        let is_better = best.as_ref().is_none_or(|(least, nearest, _)| {
            error < least - equal || (error <= least + equal && from_poses < *nearest)
        });
        if is_better {
            best = Some((error, from_poses, at));
        }
    }
    let (_, _, at) = best.ok_or_else(|| PipelineError::stage(&[], None, "there is no pose"))?;
    search.found(at)
}

/// As [`reach`], but only downhill from `start`: for a hand that drags, to whom the drawing must not jump. `options.steps` bounds the
/// work.
///
/// # Errors
/// As [`reach`].
pub fn reach_near(
    weights: &dyn WeightProvider,
    blend: &RigidBlend,
    places: &[Vec<f64>],
    points: &[ShapePoint],
    targets: &[Point],
    options: &ReachOptions,
    start: &[f64],
) -> Result<Reach, PipelineError> {
    let mut search = Search::new(weights, blend, places, points, targets, options)?;
    // Where it is, the search may stay, however far outside that is.
    for (d, at) in start.iter().enumerate().take(search.low.len()) {
        search.low[d] = search.low[d].min(*at);
        search.high[d] = search.high[d].max(*at);
    }
    let (_, at) = search.refined(start.to_vec(), options.steps)?;
    search.found(at)
}

/// As [`reach`], for a character of one layer, loose parts of it apart, and the names of its landmarks: those on the outline and points inside.
///
/// # Errors
/// [`PipelineError`] from any stage before the textures, or if a landmark does not exist or is a line.
pub fn reach_landmarks(
    spec: &CharacterSpec,
    targets: &[(String, Point)],
    options: &ReachOptions,
) -> Result<Reach, PipelineError> {
    spec.check()?;
    // Loose parts are layers, too: that with the landmarks is meant.
    let bodies: Vec<&LayerSpec> = (spec.layers.iter())
        .filter(|layer| layer.role == LayerRole::Body)
        .collect();
    let has_all = |layer: &&LayerSpec| {
        let has = |name: &String| layer.landmarks.iter().any(|landmark| landmark.name == *name);
        targets.iter().all(|(name, _)| has(name))
    };
    let [body] = bodies.as_slice() else {
        return Err(PipelineError::Layered {
            layers: spec.layers.iter().map(|layer| format!("'{}'", layer.name)).collect(),
        });
    };
    let layer = spec.layers.iter().find(has_all).unwrap_or(body);
    let (mapping, report) = map_layer(layer)?;
    // The layer may have the poses in another order than the space: here, the layer's counts.
    let order = spec.poses_of(layer);
    let places: Vec<Vec<f64>> = match &spec.space.places {
        Places::Given(places) => order.iter().map(|&pose| places[pose].clone()).collect(),
        Places::Automatic => automatic_places(&mapping),
    };
    let weights = editable_weights(&layer.names(), &places, &spec.space.weights)?;
    let blend = RigidBlend::new(&mapping.poses, &blend_options(layer, &mapping))?;
    let is_point = |landmark: &&PlacedLandmark| landmark.kind != LandmarkKind::Line;
    let shape_point = |(name, _): &(String, Point)| {
        let found = report
            .landmarks
            .iter()
            .filter(is_point)
            .find(|landmark| &landmark.name == name);
        found
            .and_then(|landmark| {
                let places: Vec<Point> = landmark.at.iter().flatten().copied().collect();
                ShapePoint::new(&mapping.poses, &places)
            })
            .ok_or_else(|| {
                let mut known: Vec<String> = (report.landmarks.iter().filter(is_point))
                    .map(|landmark| format!("'{}'", landmark.name))
                    .collect();
                let more = known.len().saturating_sub(NAMED);
                known.truncate(NAMED);
                let mut known = known.join(", ");
                if more > 0 {
                    known.push_str(&format!(" and {more} more"));
                }
                PipelineError::UnknownLandmark {
                    name: name.clone(),
                    known,
                }
            })
    };
    let points: Vec<ShapePoint> = targets.iter().map(shape_point).collect::<Result<_, _>>()?;
    let targets: Vec<Point> = targets.iter().map(|(_, target)| *target).collect();
    let mut found = reach(&weights, &blend, &places, &points, &targets, options)?;
    let of_layer = found.weights.clone();
    for (&pose, weight) in order.iter().zip(of_layer) {
        found.weights[pose] = weight;
    }
    Ok(found)
}

struct Search<'a> {
    weights: &'a dyn WeightProvider,
    blend: &'a RigidBlend,
    points: &'a [ShapePoint],
    targets: &'a [Point],
    low: Vec<f64>,
    high: Vec<f64>,
    /// The diagonal of the box; 0 if there is one place only.
    size: f64,
    at_place: Vec<f64>,
    positions: Vec<Point>,
    scratch: BlendScratch,
    evaluations: usize,
}

impl<'a> Search<'a> {
    fn new(
        weights: &'a dyn WeightProvider,
        blend: &'a RigidBlend,
        places: &[Vec<f64>],
        points: &'a [ShapePoint],
        targets: &'a [Point],
        options: &ReachOptions,
    ) -> Result<Self, PipelineError> {
        if points.is_empty() || points.len() != targets.len() || !targets.iter().all(|t| point::is_finite(*t)) {
            let problem = format!("{} finite targets are needed, one a point, at least one", points.len());
            return Err(PipelineError::stage(&[], None, problem));
        }
        let mut search = Self {
            weights,
            blend,
            points,
            targets,
            low: Vec::new(),
            high: Vec::new(),
            size: 0.0,
            at_place: Vec::new(),
            positions: Vec::new(),
            scratch: blend.scratch(),
            evaluations: 0,
        };
        search.set_box(places, weights.dimension(), options.beyond);
        Ok(search)
    }

    /// What is reached at a place.
    fn found(mut self, at: Vec<f64>) -> Result<Reach, PipelineError> {
        let residuals = self.residuals(&at)?;
        let reached = (residuals.chunks_exact(2).zip(self.targets))
            .map(|(r, target)| target + Point::new(r[0], r[1]))
            .collect();
        Ok(Reach {
            at,
            error: root_mean(&residuals),
            reached,
            weights: self.at_place,
            evaluations: self.evaluations,
        })
    }

    fn set_box(&mut self, places: &[Vec<f64>], dimension: usize, beyond: f64) {
        let fold = |start: f64, pick: fn(f64, f64) -> f64| -> Vec<f64> {
            (0..dimension)
                .map(|d| {
                    places
                        .iter()
                        .filter_map(|place| place.get(d).copied())
                        .fold(start, pick)
                })
                .collect()
        };
        (self.low, self.high) = (fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max));
        let reach = beyond.max(0.0) * distance(&self.low, &self.high);
        for (low, high) in self.low.iter_mut().zip(&mut self.high) {
            (*low, *high) = (*low - reach, *high + reach);
        }
        let size = distance(&self.low, &self.high);
        self.size = if size.is_finite() { size } else { 0.0 };
    }

    /// Place `k` of Halton's sequence in the box.
    fn spread(&self, k: usize) -> Vec<f64> {
        (self.low.iter().zip(&self.high).enumerate())
            .map(|(d, (low, high))| low + (high - low) * radical_inverse(k, prime(d)))
            .collect()
    }

    /// How far the points are from their targets, x and y of each.
    fn residuals(&mut self, place: &[f64]) -> Result<Vec<f64>, PipelineError> {
        self.evaluations += 1;
        self.weights
            .weights(place, &mut self.at_place)
            .map_err(PipelineError::Weights)?;
        self.blend
            .blend(&self.at_place, &mut self.scratch, &mut self.positions)?;
        let missed = self.points.iter().zip(self.targets);
        Ok(missed
            .flat_map(|(shape_point, target)| {
                let missed = shape_point.at(&self.positions, &self.at_place) - target;
                [missed.x, missed.y]
            })
            .collect())
    }

    /// Goes downhill from `place`; the error and the place reached.
    fn refined(&mut self, mut place: Vec<f64>, steps: usize) -> Result<(f64, Vec<f64>), PipelineError> {
        let mut residuals = self.residuals(&place)?;
        let mut damping = DAMPING;
        for _ in 0..steps {
            if self.size == 0.0 {
                break;
            }
            let slopes = self.slopes(&place)?;
            let free = self.free(&place, &slopes, &residuals);
            let mut moved = None;
            while damping <= MOST_DAMPING && !free.is_empty() {
                let Some(next) = self.step(&place, &slopes, &residuals, &free, damping) else {
                    break;
                };
                let reached = self.residuals(&next)?;
                if norm(&reached) < norm(&residuals) {
                    damping *= 0.2;
                    moved = Some((next, reached));
                    break;
                }
                damping *= 5.0;
            }
            let Some((next, reached)) = moved else { break };
            let is_still = distance(&place, &next) <= SHORTEST_STEP * self.size;
            (place, residuals) = (next, reached);
            damping = damping.max(f64::EPSILON);
            if is_still {
                break;
            }
        }
        Ok((root_mean(&residuals), place))
    }

    /// The derivative of the residuals by each coordinate, from central differences.
    fn slopes(&mut self, place: &[f64]) -> Result<Vec<Vec<f64>>, PipelineError> {
        let width = DIFFERENCE * self.size;
        let mut slopes = Vec::with_capacity(place.len());
        for d in 0..place.len() {
            let mut aside = place.to_vec();
            aside[d] = place[d] + width;
            let ahead = self.residuals(&aside)?;
            aside[d] = place[d] - width;
            let behind = self.residuals(&aside)?;
            slopes.push(
                ahead
                    .iter()
                    .zip(&behind)
                    .map(|(a, b)| (a - b) / (2.0 * width))
                    .collect(),
            );
        }
        Ok(slopes)
    }

    /// The coordinates that do not push against their side of the box.
    fn free(&self, place: &[f64], slopes: &[Vec<f64>], residuals: &[f64]) -> Vec<usize> {
        (0..place.len())
            .filter(|&d| {
                let uphill = dot(&slopes[d], residuals);
                !(place[d] <= self.low[d] && uphill > 0.0 || place[d] >= self.high[d] && uphill < 0.0)
            })
            .collect()
    }

    /// A damped step, cut off at the sides of the box; `None` where nothing changes.
    fn step(
        &self,
        place: &[f64],
        slopes: &[Vec<f64>],
        residuals: &[f64],
        free: &[usize],
        damping: f64,
    ) -> Option<Vec<f64>> {
        let largest = free.iter().map(|&d| dot(&slopes[d], &slopes[d])).fold(0.0, f64::max);
        let system = DenseMatrix::from_fn(free.len(), free.len(), |row, column| {
            let product = dot(&slopes[free[row]], &slopes[free[column]]);
            if row == column {
                product + damping * (product + 1e-9 * largest)
            } else {
                product
            }
        });
        let right = DenseMatrix::from_fn(free.len(), 1, |row, _| -dot(&slopes[free[row]], residuals));
        let solution = SolvedDense::new(&system).and_then(|solved| solved.solve(&right)).ok()?;
        let mut next = place.to_vec();
        for (k, &d) in free.iter().enumerate() {
            next[d] = (place[d] + solution.at(k, 0)).clamp(self.low[d], self.high[d]);
        }
        Some(next)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Of residuals, two a point.
fn root_mean(residuals: &[f64]) -> f64 {
    (2.0 * dot(residuals, residuals) / residuals.len().max(1) as f64).sqrt()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// The digits of `k` in base `base`, mirrored at the point.
fn radical_inverse(mut k: usize, base: usize) -> f64 {
    let (mut value, mut place) = (0.0, 1.0);
    while k > 0 {
        place /= base as f64;
        value += place * (k % base) as f64;
        k /= base;
    }
    value
}

/// Prime `index`, from 2.
fn prime(index: usize) -> usize {
    let is_prime = |n: &usize| (2..*n).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
    (2..).filter(is_prime).nth(index).unwrap_or(2)
}

#[cfg(test)]
mod tests;
