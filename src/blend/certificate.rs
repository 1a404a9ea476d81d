//! What can be said for certain of a blended frame.
//!
//! Poses, what of them lies over itself, a frame's weights and vertices -> a [`Certificate`]:
//!
//! 1. Every triangle is positive, decided by the same exact predicates that count inverted triangles ([`super::BlendReport`]).
//! 2. No boundary ring of the mesh crosses itself or another one, decided exactly (`outline::ClosedCurves`). The rings are those of the topology. Where poses lie over
//!    themselves ([`Overlaps`]) the boundaries of *different* limbs may cross, for that is what such poses are: these pairs of limbs are listed. What belongs to no limb is the
//!    trunk, which is one limb more here, called [`TRUNK`]. A crossing within one limb is a fold of the outline, and so is every crossing of a mapping without limbs, or of
//!    one none of whose poses lies over itself.
//! 3. The largest distortion by form and by area against the blend's references, next to the weighted mean of the poses' own ([`Distortion`]).
//!
//! Between two frames, [`Certifier::unproven_between`] proves for triangles whose vertices move in straight lines that they are positive all the way (`between.rs`).
//!
//! Cost: linear in the triangles and poses, and O(n log n) for n boundary edges of similar length; about three quarters of what the blend itself costs. Nothing of it is computed unless it is asked for.
//!
//! Limits: predicates are exact as long as no product underflows; vertices so far out that distortions overflow are refused. A certificate is about the mesh. The edge that is painted
//! lies inside the mesh's boundary, is finer than it and may touch itself where the boundary only comes near itself.

use std::collections::BTreeSet;

use super::distortion::{Distortion, Distortions};
use super::{BlendError, BlendOptions, between};
use crate::math::{Point, predicate};
use crate::mesh::{Topology, geometry};
use crate::outline::ClosedCurves;
use crate::pose::{Mapping, Overlaps, PoseSet};

/// What a certificate calls the triangles that belong to no limb.
pub const TRUNK: &str = "trunk";

/// As many broken places of a kind are listed at most; all are counted.
const MOST_PLACES: usize = 16;

/// Coordinates beyond this, in source units, are refused: the fourth powers of lengths would overflow.
const LARGEST_COORDINATE: f64 = 1e60;

/// What can be said for certain of one frame. It [holds](Self::holds) if the frame is positive and simple.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// Whether every triangle has positive area.
    pub positive: bool,
    /// Whether no boundary crosses itself or another one but where limbs may lie over one another ([`Self::overlaps`]). Boundaries that touch do not cross.
    pub simple: bool,
    /// The pairs of limbs whose boundaries cross and may, in order.
    pub overlaps: Vec<LimbOverlap>,
    /// The largest over the triangles of the frame, each by itself.
    pub largest: Distortion,
    /// The largest over the triangles of the geometric mean of the poses' own, weighted as the frame is. A frame whose [largest](Self::largest) is no larger stays within
    /// the distortion of its poses. Negative weights count as 0, and the others are scaled to sum to 1: beyond the poses a frame is compared with those it is drawn from.
    pub of_poses: Distortion,
    /// How many triangles are not positive.
    pub inverted_count: usize,
    /// The first of them, at most 16.
    pub inverted: Vec<usize>,
    /// How often boundaries cross that may not.
    pub crossing_count: usize,
    /// The first of these crossings, at most 16.
    pub crossings: Vec<BoundaryCrossing>,
}

impl Certificate {
    /// Whether the frame is positive and simple. Its distortion is stated and not judged.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.positive && self.simple
    }
}

/// Two limbs that lie over one another in a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct LimbOverlap {
    /// Their names; the trunk first, then in the order of the mapping.
    pub limbs: [String; 2],
    /// Whether the boundaries of these two cross in one of the poses that lie over themselves, too.
    pub is_in_poses: bool,
}

/// Two boundary edges that cross and may not.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BoundaryCrossing {
    /// The vertices at the beginning and the end of both edges.
    pub edges: [[usize; 2]; 2],
    /// Their common point, up to rounding, in source units.
    pub place: Point,
}

/// A limb by its number in the mapping; `None` is the trunk.
type Limb = Option<usize>;

/// Certifies frames of one blend. Read-only after it is built: threads share one.
///
/// ```
/// use inbetween::blend::{BlendOptions, Certifier, RigidBlend};
/// use inbetween::math::Point;
/// use inbetween::mesh::Topology;
/// use inbetween::pose::{Overlaps, PoseSet};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let topology = Topology::new(3, vec![[0, 1, 2]])?;
/// let flat = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]].map(Point::from).to_vec();
/// let upright = [[0.0, 0.0], [0.0, 2.0], [-1.0, 0.0]].map(Point::from).to_vec();
/// let poses = PoseSet::new(topology, vec![("flat".into(), flat), ("upright".into(), upright)])?;
/// let options = BlendOptions::default();
/// let (blend, certifier) = (RigidBlend::new(&poses, &options)?, Certifier::new(&poses, &Overlaps::default(), &options)?);
///
/// let (weights, mut half) = ([0.5, 0.5], Vec::new());
/// blend.blend(&weights, &mut blend.scratch(), &mut half)?;
/// let certificate = certifier.certify(&weights, &half)?;
/// assert!(certificate.positive && certificate.simple);
/// // One pose is the other, turned: nothing is distorted half way either.
/// assert!((certificate.largest.distortion - 1.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Certifier {
    vertex_count: usize,
    triangles: Vec<[usize; 3]>,
    boundary: Boundary,
    distortions: Distortions,
    pose_count: usize,
    /// The names of the limbs; none where no boundaries may cross.
    limbs: Vec<String>,
    /// The pairs of limbs whose boundaries cross in poses.
    in_poses: BTreeSet<[Limb; 2]>,
}

/// The boundary rings of a mesh as edges that are numbered through all of them.
#[derive(Debug, Clone)]
struct Boundary {
    curves: ClosedCurves,
    /// By edge, the vertices at its beginning and its end.
    edges: Vec<[usize; 2]>,
    /// By edge, the limb of its triangle.
    limbs: Vec<Limb>,
}

impl Boundary {
    fn new(topology: &Topology, triangle_limb: &[Limb]) -> Self {
        // One boundary edge begins at each boundary vertex.
        let mut limb_from = vec![None; topology.vertex_count()];
        let triangles = topology.triangles().iter().zip(topology.neighbours());
        for (t, (corners, neighbours)) in triangles.enumerate() {
            for (vertex, _) in corners.iter().zip(neighbours).filter(|(_, across)| across.is_none()) {
                limb_from[*vertex] = triangle_limb.get(t).copied().flatten();
            }
        }
        let rings = topology.boundary_loops();
        let of_ring = |ring: &Vec<usize>| -> Vec<[usize; 2]> {
            let ends = ring.iter().cycle().skip(1);
            ring.iter().zip(ends).map(|(from, to)| [*from, *to]).collect()
        };
        let edges: Vec<[usize; 2]> = rings.iter().flat_map(of_ring).collect();
        Self {
            curves: ClosedCurves::of_lengths(rings.iter().map(Vec::len)),
            limbs: edges.iter().map(|[from, _]| limb_from[*from]).collect(),
            edges,
        }
    }

    /// Calls `visit` with each crossing at `positions` (#vertices) and the limbs of its edges, the smaller first.
    fn for_each_crossing(&self, positions: &[Point], mut visit: impl FnMut([usize; 2], [Limb; 2], Point)) {
        let points: Vec<Point> = self.edges.iter().map(|[from, _]| positions[*from]).collect();
        self.curves.for_each_crossing(&points, |edges, place| {
            let mut limbs = edges.map(|edge| self.limbs[edge]);
            limbs.sort_unstable();
            visit(edges, limbs, place);
        });
    }
}

impl Certifier {
    /// For frames of `poses` that are blended with `options`, of which the reference counts; `overlaps` says where they lie over themselves.
    ///
    /// # Errors
    /// [`BlendError`] if a pose has a triangle that is not positive, the options name a pose that is not there, or limbs are not known of every triangle.
    pub fn new(poses: &PoseSet, overlaps: &Overlaps, options: &BlendOptions) -> Result<Self, BlendError> {
        let topology = poses.topology();
        let triangles = topology.triangles();
        let known = &overlaps.triangle_limb;
        if !known.is_empty() && known.len() != triangles.len() {
            return Err(BlendError::WrongCount {
                what: "triangles with limbs",
                found: known.len(),
                poses: poses.len(),
            });
        }
        let boundary = Boundary::new(topology, known);
        let limbs = if overlaps.is_empty() || known.is_empty() {
            Vec::new()
        } else {
            overlaps.limbs.clone()
        };
        let mut in_poses = BTreeSet::new();
        let overlapping = overlaps
            .poses
            .iter()
            .filter_map(|known| poses.positions().get(known.pose));
        for positions in overlapping.filter(|_| !limbs.is_empty()) {
            check_places(positions)?;
            boundary.for_each_crossing(positions, |_, limbs, _| {
                in_poses.insert(limbs);
            });
        }
        Ok(Self {
            vertex_count: topology.vertex_count(),
            triangles: triangles.to_vec(),
            boundary,
            distortions: Distortions::new(poses, options.reference)?,
            pose_count: poses.len(),
            limbs,
            in_poses,
        })
    }

    /// For frames of a mapping.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_mapping(mapping: &Mapping, options: &BlendOptions) -> Result<Self, BlendError> {
        Self::new(&mapping.poses, &mapping.overlaps, options)
    }

    /// Certifies the frame of `weights` (#poses) whose vertices are at `positions` (#vertices).
    ///
    /// # Errors
    /// [`BlendError::WrongCount`] or [`BlendError::WrongVertexCount`] if a number is wrong, [`BlendError::BadWeights`] if a weight is not finite or none is positive, and
    /// [`BlendError::NotFinite`] if a position is not finite or beyond 1e60.
    pub fn certify(&self, weights: &[f64], positions: &[Point]) -> Result<Certificate, BlendError> {
        let weights = self.positive_weights(weights)?;
        self.check(positions)?;
        let mut certificate = Certificate {
            positive: true,
            simple: true,
            overlaps: Vec::new(),
            largest: self.distortions.largest(&self.triangles, positions),
            of_poses: self.distortions.largest_of_poses(&weights),
            inverted_count: 0,
            inverted: Vec::new(),
            crossing_count: 0,
            crossings: Vec::new(),
        };
        self.find_inverted(positions, &mut certificate);
        self.find_crossings(positions, &mut certificate);
        Ok(certificate)
    }

    /// The triangles that are not proven to be positive all the way while every vertex moves in a straight line and evenly from `from` to `to` (#vertices each). None:
    /// whatever is shown between these two frames along such lines, nothing folds.
    ///
    /// What is proven is certain. A triangle that is listed is turned over on the way, or so nearly that rounding could decide.
    ///
    /// # Errors
    /// [`BlendError::WrongVertexCount`] or [`BlendError::NotFinite`], as [`Self::certify`].
    pub fn unproven_between(&self, from: &[Point], to: &[Point]) -> Result<Vec<usize>, BlendError> {
        self.check(from)?;
        self.check(to)?;
        let is_unproven = |t: &usize| {
            let [start, end] = [from, to].map(|positions| geometry::corners(positions, self.triangles[*t]));
            !between::is_positive_throughout(start, end)
        };
        Ok((0..self.triangles.len()).filter(is_unproven).collect())
    }

    fn check(&self, positions: &[Point]) -> Result<(), BlendError> {
        if positions.len() != self.vertex_count {
            return Err(BlendError::WrongVertexCount {
                found: positions.len(),
                expected: self.vertex_count,
            });
        }
        check_places(positions)
    }

    /// The weights without negative ones, scaled to sum to 1.
    fn positive_weights(&self, weights: &[f64]) -> Result<Vec<f64>, BlendError> {
        if weights.len() != self.pose_count {
            return Err(BlendError::WrongCount {
                what: "weights",
                found: weights.len(),
                poses: self.pose_count,
            });
        }
        let positive = || weights.iter().map(|weight| weight.max(0.0));
        let sum: f64 = positive().sum();
        let is_fit = weights.iter().all(|weight| weight.is_finite()) && sum > 0.0 && sum.is_finite();
        if !is_fit {
            return Err(BlendError::BadWeights {
                sum: weights.iter().sum(),
            });
        }
        Ok(positive().map(|weight| weight / sum).collect())
    }

    fn find_inverted(&self, positions: &[Point], certificate: &mut Certificate) {
        for (t, &triangle) in self.triangles.iter().enumerate() {
            let [a, b, c] = geometry::corners(positions, triangle);
            if predicate::surely_above(a, b, c, 0.0) || predicate::is_positive(a, b, c) {
                continue;
            }
            certificate.positive = false;
            certificate.inverted_count += 1;
            if certificate.inverted.len() < MOST_PLACES {
                certificate.inverted.push(t);
            }
        }
    }

    fn find_crossings(&self, positions: &[Point], certificate: &mut Certificate) {
        let mut overlaps = BTreeSet::new();
        let mut broken: Vec<([usize; 2], Point)> = Vec::new();
        self.boundary.for_each_crossing(positions, |edges, limbs, place| {
            if !self.limbs.is_empty() && limbs[0] != limbs[1] {
                overlaps.insert(limbs);
                return;
            }
            certificate.crossing_count += 1;
            broken.push((edges, place));
            // A frame that is all crossings needs no memory for them.
            if broken.len() >= 2 * MOST_PLACES {
                broken.sort_unstable_by_key(|(edges, _)| *edges);
                broken.truncate(MOST_PLACES);
            }
        });
        broken.sort_unstable_by_key(|(edges, _)| *edges);
        broken.truncate(MOST_PLACES);
        certificate.simple = broken.is_empty();
        let found = broken.into_iter().map(|(edges, place)| BoundaryCrossing {
            edges: edges.map(|edge| self.boundary.edges[edge]),
            place,
        });
        certificate.crossings = found.collect();
        let named = overlaps.into_iter().map(|limbs| LimbOverlap {
            limbs: limbs.map(|limb| self.name(limb)),
            is_in_poses: self.in_poses.contains(&limbs),
        });
        certificate.overlaps = named.collect();
    }

    fn name(&self, limb: Limb) -> String {
        let name = limb.and_then(|limb| self.limbs.get(limb));
        name.map_or_else(|| TRUNK.to_owned(), Clone::clone)
    }
}

fn check_places(positions: &[Point]) -> Result<(), BlendError> {
    // Written so that NaN fails too.
    let is_fit = |p: &Point| p.x.abs() <= LARGEST_COORDINATE && p.y.abs() <= LARGEST_COORDINATE;
    if positions.iter().all(is_fit) {
        Ok(())
    } else {
        Err(BlendError::NotFinite)
    }
}

#[cfg(test)]
mod tests;
