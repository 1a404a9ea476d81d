//! Compatible simplification: N full-resolution outlines become N enclosing polygons with corresponding vertices.
//!
//! Input: one outline and one correspondence per ring; output: N outlines of equal vertex counts, vertex `k`
//! corresponding to vertex `k`. Source: NWM 3.1 "Compatible simplification", after Baxter, Barla, Anjyo,
//! "Compatible embedding for 2D shape animation" (2008).
//!
//! 1. Each outline alone is simplified to a fraction of the tolerance, by the same collapse as below with one pose.
//! 2. Every vertex left on any pose becomes a tuple of corresponding vertices ([`tuples`]).
//! 3. Edges of tuples collapse, cheapest first, while every pose stays simple, keeps its outline inside, and deviates
//!    by no more than the tolerance from it ([`collapse`], [`merging`]).
//! 4. The vertices are pulled inwards until they touch the outline ([`tighten`]).
//! 5. Where the triangulation then needs Steiner points, the collapses next to one are tried in another order, as often as
//!    the caller asks ([`Simplification::vary`]).
//!
//! Differences from the paper: it takes the *minimum* error over the boundaries, which would sacrifice all drawings
//! but one; the cost here is the worst squared deviation, measured against the full-resolution outline. The paper
//! removes vertices; here each pose has its own kind of collapse for the same tuple, without which most tuples are
//! stuck (convex in one pose, reflex in another). The first step is ours: it makes several times fewer tuples; so is the
//! last, a local search over orders of equal standing: all of them enclose, within the same tolerance.
//!
//! A long thin shape may have a diagonal of a hundred of its widths; of such a shape the tolerance is taken relative to
//! 16 mean half-widths (area over perimeter) where that is less than the diagonal.
//!
//! Guarantee: each polygon is simple and contains its outline but for rounding of merged vertices (about 1e-14 of the
//! diagonal); a landmark is a vertex exactly where it is given, in every pose. Cost O(n log n) in the number of outline points n, for outlines whose edges are
//! of similar length. Limit: a corner next to a landmark is a vertex of its own, however near it is; the count of vertices follows from the tolerance, it cannot be asked for.

mod alone;
mod collapse;
mod drift;
mod edge_grid;
mod merging;
mod original;
mod tighten;
mod tuples;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use rayon::prelude::*;

use super::CompatibleMesh;
use crate::matching::Correspondence;
use crate::math::{Point, point};
use crate::outline::{Outline, OutlineError, Ring, RingError};
use alone::PoseAlone;
pub(crate) use alone::SimplifiedAlone;
use collapse::Collapser;
use drift::Drift;
use original::PoseOriginal;
use tuples::{Pin, TupleRing};

/// A point of an outline: a landmark's place on one pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingPoint {
    /// On which ring; 0 is the outer one, hole `k` is ring `k + 1`.
    pub ring: usize,
    /// Its normalised arc-length parameter there, in `[0, 1)`.
    pub parameter: f64,
}

/// What the simplification may do.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SimplifyOptions {
    /// The deviation allowed between an outline and its polygon, as a fraction of the pose's diagonal. Default 0.02.
    /// Shapes that are thin all over are held to their width instead: see the module's documentation.
    pub tolerance: f64,
    /// How far the vertices of different poses may stand from corresponding, along their outlines, as a fraction of the pose's diagonal.
    /// Default: as far as it comes, as in the paper, which is right where the correspondence itself is a guess.
    pub drift: Option<f64>,
}

impl Default for SimplifyOptions {
    fn default() -> Self {
        Self {
            tolerance: 0.02,
            drift: None,
        }
    }
}

impl SimplifyOptions {
    fn check(&self) -> Result<(), SimplifyError> {
        // Written so that NaN fails too.
        if self.tolerance > 0.0 && self.tolerance.is_finite() {
            Ok(())
        } else {
            Err(SimplifyError::BadTolerance(self.tolerance))
        }
    }
}

/// N polygons with corresponding vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplified {
    /// One outline a pose; equal numbers of rings, and of points in each ring.
    pub polygons: Vec<Outline>,
    /// What was done.
    pub report: SimplifyReport,
}

/// What a simplification did.
#[derive(Debug, Clone, PartialEq)]
pub struct SimplifyReport {
    /// Corresponding vertices before collapsing, all rings together.
    pub tuples: usize,
    /// Corresponding vertices left.
    pub vertices: usize,
    /// Per pose, the polygon's area over the outline's, minus 1.
    pub excess_area: Vec<f64>,
    /// Per pose, the largest distance of an outline point from the polygon, as a fraction of the pose's diagonal.
    pub deviation: Vec<f64>,
}

/// Why outlines could not be simplified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimplifyError {
    /// Poses have different numbers of rings, or there is not one correspondence a ring.
    #[error("pose {pose} has {found} rings, expected {expected}; give every pose the same holes or fill them")]
    RingCount {
        /// Which pose.
        pose: usize,
        /// Its rings.
        found: usize,
        /// Rings of the first pose and of the correspondences.
        expected: usize,
    },
    /// The tolerance is not a positive number.
    #[error("the simplification tolerance must be a positive fraction of the diagonal, got {0}")]
    BadTolerance(f64),
    /// A polygon has less than three vertices farther apart than rounding, as the outline of a pose that is as thin as that.
    #[error("pose {pose}, ring {ring}: {source}; the drawing has too little detail at its size")]
    Degenerate {
        /// Which pose.
        pose: usize,
        /// Which ring; 0 is the outer one.
        ring: usize,
        /// Why.
        source: RingError,
    },
    /// Corresponding vertices already cross before anything is collapsed.
    #[error("pose {pose}: {source}")]
    NotSimple {
        /// Which pose.
        pose: usize,
        /// Where.
        source: OutlineError,
    },
}

/// Vertices of different poses share a tuple if they correspond to within this fraction of the perimeter, which is
/// well below any tolerance in use.
const MERGE_DISTANCE: f64 = 1e-3;

/// Variations multiply the cost of a collapse, a squared deviation, by up to this, or divide it.
const LARGEST_WEIGHT: f64 = 4.0;

/// Simplifies N outlines to N polygons with corresponding vertices that enclose them.
///
/// `correspondences` holds one correspondence a ring, outer ring first; `landmarks` the landmarks on the rings, as rows of points, one a
/// pose, that correspond, all on the same ring: each becomes a vertex, where it is on every pose.
///
/// # Examples
/// ```
/// use inbetween::{compatible::{SimplifyOptions, simplify}, matching::Correspondence};
/// use inbetween::{math::Point, outline::{Outline, Ring}};
/// let side = |k: usize| k as f64 / 10.0;
/// let square = Ring::new((0..40).map(|k| match k / 10 {
///     0 => Point::new(side(k), 0.0),
///     1 => Point::new(1.0, side(k - 10)),
///     2 => Point::new(1.0 - side(k - 20), 1.0),
///     _ => Point::new(0.0, 1.0 - side(k - 30)),
/// }))?;
/// let outline = Outline::new(square, vec![])?;
/// let poses = [outline.clone(), outline];
/// let simplified = simplify(&poses, &[Correspondence::identity(2, 40)], &[], &SimplifyOptions::default())?;
/// assert_eq!(simplified.polygons[0].outer().len(), 4);
/// assert_eq!((simplified.report.vertices, simplified.report.deviation[0]), (4, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SimplifyError`] if ring counts differ, the tolerance is not positive, or an outline degenerates.
pub fn simplify(
    outlines: &[Outline],
    correspondences: &[Correspondence],
    landmarks: &[Vec<RingPoint>],
    options: &SimplifyOptions,
) -> Result<Simplified, SimplifyError> {
    Simplification::new(outlines, correspondences, landmarks, options)?.polygons()
}

/// A simplification that can be made again with small variations.
///
/// Which tuples remain is decided one collapse after the other, and of the many polygons within the tolerance some need
/// fewer Steiner points than others. So where a triangulation needed some, the collapses next to one of them are tried in
/// another order ([`Self::vary`]), and that order is kept if it serves better:
///
/// ```
/// use inbetween::{compatible::{SimplifyOptions, Simplification, triangulate}, matching::Correspondence};
/// use inbetween::{math::Point, outline::{Outline, Ring}};
/// let wavy = |phase: f64| -> Result<Outline, Box<dyn std::error::Error>> {
///     let rim = (0..200).map(|k| k as f64 / 200.0 * std::f64::consts::TAU);
///     let rim = rim.map(|t| Point::new(t.cos(), t.sin()) * (1.0 + 0.4 * (5.0 * t + phase).sin()));
///     Ok(Outline::new(Ring::new(rim)?, vec![])?)
/// };
/// let outlines = [wavy(0.0)?, wavy(1.5)?, wavy(3.0)?];
/// let matching = [Correspondence::identity(3, 200)];
/// let mut simplification = Simplification::new(&outlines, &matching, &[], &SimplifyOptions::default())?;
/// let (mut mesh, _) = triangulate(&simplification.polygons()?.polygons, &[])?;
/// let first = mesh.steiner;
/// for _ in 0..Simplification::VARIATIONS {
///     let Some(varied) = simplification.vary(&mesh) else { break };
///     let (other, _) = triangulate(&varied.polygons, &[])?;
///     if other.is_sparer_than(&mesh) {
///         simplification.keep();
///         mesh = other;
///     }
/// }
/// assert!(mesh.steiner <= first);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simplification {
    poses: Vec<Arc<PoseAlone>>,
    /// Per ring, all tuples.
    joined: Vec<TupleRing>,
    tolerance: f64,
    /// The largest drift, and the correspondences that it is measured by; none without it.
    drift: Option<(f64, Vec<Correspondence>)>,
    kept: Order,
    varied: Order,
    variations: usize,
}

/// In which order edges collapse, and what is left then.
#[derive(Debug, Clone)]
struct Order {
    /// Per tuple of all rings, what the cost of the edge that starts there is multiplied by.
    weights: Vec<f64>,
    /// The tuples that remain.
    survivors: Vec<usize>,
}

impl Simplification {
    /// How many variations are worth their time: the first few gain most.
    pub const VARIATIONS: usize = 12;

    /// Simplifies each outline alone and joins their vertices; arguments and errors are those of [`simplify`].
    ///
    /// # Errors
    /// As [`simplify`].
    pub fn new(
        outlines: &[Outline],
        correspondences: &[Correspondence],
        landmarks: &[Vec<RingPoint>],
        options: &SimplifyOptions,
    ) -> Result<Self, SimplifyError> {
        Self::with(
            outlines,
            correspondences,
            landmarks,
            options,
            &SimplifiedAlone::default(),
        )
    }

    /// The same, with what has been simplified alone before; `alone` may be of other outlines, landmarks or tolerances, and is
    /// taken where it is not. The result is that of [`Self::new`].
    ///
    /// # Errors
    /// As [`simplify`].
    pub(crate) fn with(
        outlines: &[Outline],
        correspondences: &[Correspondence],
        landmarks: &[Vec<RingPoint>],
        options: &SimplifyOptions,
        alone: &SimplifiedAlone,
    ) -> Result<Self, SimplifyError> {
        options.check()?;
        for (pose, outline) in outlines.iter().enumerate() {
            if outline.rings().len() != correspondences.len() {
                let (found, expected) = (outline.rings().len(), correspondences.len());
                return Err(SimplifyError::RingCount { pose, found, expected });
            }
        }
        let given = |pose: usize| alone::pins(landmarks.iter().map(move |row| row.get(pose).copied())).flatten();
        let pins: Vec<Option<Vec<Pin>>> = (0..outlines.len()).map(|pose| Some(given(pose).collect())).collect();
        let alone = alone.for_pins(outlines, &pins, options.tolerance);
        let poses: Vec<Arc<PoseAlone>> = alone.poses.into_iter().flatten().collect();
        let joined: Vec<TupleRing> = correspondences
            .iter()
            .enumerate()
            .map(|(ring, correspondence)| {
                let rings: Vec<TupleRing> = poses.iter().map(|pose| pose.rings[ring].clone()).collect();
                TupleRing::joined(&rings, correspondence, MERGE_DISTANCE)
            })
            .collect();
        let order = Order {
            weights: vec![1.0; joined.iter().map(|ring| ring.tuples.len()).sum()],
            survivors: Vec::new(),
        };
        Ok(Self {
            poses,
            joined,
            tolerance: options.tolerance,
            drift: options.drift.map(|largest| (largest, correspondences.to_vec())),
            kept: order.clone(),
            varied: order,
            variations: 0,
        })
    }

    /// Its outlines, simplified alone.
    #[must_use]
    pub(crate) fn alone(&self) -> SimplifiedAlone {
        SimplifiedAlone {
            poses: self.poses.iter().cloned().map(Some).collect(),
            tolerance: self.tolerance,
        }
    }

    /// The polygons by the order that is kept: at first, the cheapest collapse first.
    ///
    /// # Errors
    /// As [`simplify`].
    pub fn polygons(&mut self) -> Result<Simplified, SimplifyError> {
        let (simplified, survivors) = self.collapsed(&self.kept.weights)?;
        self.kept.survivors = survivors;
        Ok(simplified)
    }

    /// The polygons by an order that differs from the kept one around a Steiner point of `mesh`, the triangulation of the
    /// kept polygons; another one at every call. `None` if there is no such point, or nothing changes.
    pub fn vary(&mut self, mesh: &CompatibleMesh) -> Option<Simplified> {
        let variation = self.variations;
        self.variations += 1;
        let count = mesh.topology.vertex_count();
        // Steiner points have the last numbers, the vertices of the polygons the first.
        let steiner = count - (1 + variation % mesh.steiner.max(1)).min(mesh.steiner);
        let corners = mesh
            .topology
            .triangles()
            .iter()
            .filter(|t| t.contains(&steiner))
            .flatten();
        let survivors = &self.kept.survivors;
        let mut weights = self.kept.weights.clone();
        let mut random = Random(variation as u64);
        for &vertex in corners.filter(|&&v| v < survivors.len()) {
            // Up to the vertices beside it.
            let (first, last) = (vertex.saturating_sub(1), (vertex + 1).min(survivors.len() - 1));
            for weight in &mut weights[survivors[first]..=survivors[last]] {
                *weight = LARGEST_WEIGHT.powf(2.0 * random.next() - 1.0);
            }
        }
        let (simplified, survivors) = self.collapsed(&weights).ok()?;
        let is_new = survivors != self.kept.survivors;
        self.varied = Order { weights, survivors };
        is_new.then_some(simplified)
    }

    /// Keeps the order of the last variation.
    pub fn keep(&mut self) {
        self.kept = self.varied.clone();
    }

    fn collapsed(&self, weights: &[f64]) -> Result<(Simplified, Vec<usize>), SimplifyError> {
        let originals: Vec<&PoseOriginal> = self.poses.iter().map(|pose| &pose.original).collect();
        let collapser = Collapser::new(self.joined.clone(), &originals, self.tolerance);
        let drift = self.drift.as_ref().map(|(largest, correspondences)| Drift {
            correspondences,
            perimeters: (originals.iter())
                .map(|original| {
                    original
                        .rings
                        .iter()
                        .map(|ring| ring.perimeter() / original.size)
                        .collect()
                })
                .collect(),
            largest: *largest,
        });
        let (rings, survivors) = collapser.weighted(weights).held(drift.as_ref()).survivors();
        let polygon = |(pose, original): (usize, &&PoseOriginal)| -> Result<(Outline, f64), SimplifyError> {
            let mut points: Vec<Vec<Point>> = rings
                .iter()
                .map(|ring| ring.tuples.iter().map(|tuple| tuple.points[pose]).collect())
                .collect();
            let stays = |ring: usize, vertex: usize| rings[ring].tuples[vertex].landmark.is_some();
            tighten::tighten(&mut points, &original.rings, stays);
            let mut rings = Vec::with_capacity(points.len());
            for (ring, points) in points.into_iter().enumerate() {
                rings.push(Ring::new(points).map_err(|source| SimplifyError::Degenerate { pose, ring, source })?);
            }
            let outer = rings.remove(0);
            let polygon = Outline::new(outer, rings).map_err(|source| SimplifyError::NotSimple { pose, source })?;
            let deviation = deviation(&polygon, &self.poses[pose].outline);
            Ok((polygon, deviation))
        };
        let polygons: Vec<Result<_, SimplifyError>> = originals.par_iter().enumerate().map(polygon).collect();
        let polygons: Vec<(Outline, f64)> = polygons.into_iter().collect::<Result<_, _>>()?;
        let (polygons, deviation): (Vec<Outline>, Vec<f64>) = polygons.into_iter().unzip();
        let outlines = self.poses.iter().map(|pose| &pose.outline);
        let report = SimplifyReport {
            tuples: weights.len(),
            vertices: rings.iter().map(|ring| ring.tuples.len()).sum(),
            excess_area: (polygons.iter().zip(outlines))
                .map(|(polygon, outline)| polygon.area() / outline.area() - 1.0)
                .collect(),
            deviation,
        };
        Ok((Simplified { polygons, report }, survivors))
    }
}

/// Numbers that look random: a linear congruential sequence (Knuth's MMIX constants) from a fixed seed.
#[derive(Debug)]
struct Random(u64);

impl Random {
    /// In `[0, 1)`.
    fn next(&mut self) -> f64 {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1 << 24) as f64
    }
}

/// The largest distance of a point of the outline from its polygon, as a fraction of the outline's diagonal.
fn deviation(polygon: &Outline, outline: &Outline) -> f64 {
    let mut farthest = 0.0f64;
    for (polygon, ring) in polygon.rings().iter().zip(outline.rings()) {
        let mut nearest_edge = 0;
        for p in ring.points() {
            let mut nearest = f64::INFINITY;
            // From the last point's edge on, until the point cannot be the farthest: one edge for most points.
            for edge in (nearest_edge..polygon.len()).chain(0..nearest_edge) {
                let (_, distance) = point::nearest_on_segment(*p, polygon.point(edge), polygon.point(edge + 1));
                if distance < nearest {
                    (nearest, nearest_edge) = (distance, edge);
                }
                if nearest <= farthest {
                    break;
                }
            }
            farthest = farthest.max(nearest);
        }
    }
    farthest / outline.diagonal()
}
