//! The blend itself: everything that does not depend on the weights is computed once.
//!
//! Built in about O(#vertices^1.5 + #poses #triangles); a frame costs O(#poses #triangles) and one pass forth and back
//! over the factor. A [`RigidBlend`] is read-only after it is built: threads share one, each with its own
//! [`BlendScratch`].

use super::reference::{pose_edges, reference_edges};
use super::stretch::{self, Symmetric};
use super::{Anchor, BlendError, BlendOptions, Reference, Stretch, branch, rotation};
use crate::math::{Point, PolarSplit, limit_weights, predicate, rotation as rotation_matrix};
use crate::mesh::{Topology, geometry};
use crate::pose::PoseSet;
use crate::solve::{SparseCholesky, Triplets};

/// How far from 1 weights may sum; they are then scaled to sum 1.
pub const WEIGHT_SUM_TOLERANCE: f64 = 1e-6;

/// An unknown that was eliminated: the pinned vertex of its component.
const PINNED: usize = usize::MAX;

/// N poses, ready to be blended with any weights.
///
/// ```
/// use inbetween::blend::{BlendOptions, RigidBlend};
/// use inbetween::math::Point;
/// use inbetween::mesh::Topology;
/// use inbetween::pose::PoseSet;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let topology = Topology::new(3, vec![[0, 1, 2]])?;
/// let flat = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]].map(Point::from).to_vec();
/// let upright = [[0.0, 0.0], [0.0, 2.0], [-1.0, 0.0]].map(Point::from).to_vec();
/// let poses = PoseSet::new(topology, vec![("flat".into(), flat), ("upright".into(), upright)])?;
///
/// let blend = RigidBlend::new(&poses, &BlendOptions::default())?;
/// let mut half = Vec::new();
/// let report = blend.blend(&[0.5, 0.5], &mut blend.scratch(), &mut half)?;
/// assert_eq!(report.flipped, 0);
/// // Half way it is turned by 45 degrees and has kept its size.
/// assert!(((half[1] - half[0]).norm() - 2.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct RigidBlend {
    topology: Topology,
    pose_count: usize,
    stretch: Stretch,
    /// #triangles x #poses rotation angles (`alpha` in NWM 4.2), consistent over mesh and poses.
    angles_rad: Vec<f64>,
    /// #triangles x #poses stretches (`S` in NWM 4.2), or their logarithms for [`Stretch::Log`].
    stretches: Vec<Symmetric>,
    /// Per triangle and corner: the gradient of the corner's barycentric coordinate on the reference, times its area.
    weighted_gradients: Vec<[Point; 3]>,
    /// The unknown of each vertex, or [`PINNED`].
    unknowns: Vec<usize>,
    factor: SparseCholesky,
    components: Components,
    ambiguous_turns: bool,
}

/// The connected components of the mesh, each with its own translation.
#[derive(Debug, Clone)]
struct Components {
    /// Component of each vertex.
    of_vertex: Vec<usize>,
    /// Weight of each vertex in the anchor of its component; they sum to 1 in each.
    anchor_weights: Vec<f64>,
    /// #components x #poses: where the anchor is in each pose.
    pose_anchors: Vec<Vec<Point>>,
}

/// Working space of one thread. See [`RigidBlend::scratch`].
#[derive(Debug, Clone, Default)]
pub struct BlendScratch {
    weights: Vec<f64>,
    stretch_weights: Vec<f64>,
    right: Vec<[f64; 2]>,
    solve: Vec<[f64; 2]>,
}

/// What there is to say about a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct BlendReport {
    /// Triangles that are not positive.
    pub flipped: usize,
}

/// One blend of `poses`, for those who need no second.
///
/// # Errors
/// As [`RigidBlend::new`] and [`RigidBlend::blend`].
pub fn blend_once(poses: &PoseSet, options: &BlendOptions, weights: &[f64]) -> Result<Vec<Point>, BlendError> {
    let blend = RigidBlend::new(poses, options)?;
    let mut positions = Vec::new();
    blend.blend(weights, &mut blend.scratch(), &mut positions)?;
    Ok(positions)
}

impl RigidBlend {
    /// Prepares the blend of `poses`.
    ///
    /// # Errors
    /// [`BlendError`] if a pose has a triangle that is not positive, the rotations do not close, or the options name a
    /// pose or vertex that is not there.
    pub fn new(poses: &PoseSet, options: &BlendOptions) -> Result<Self, BlendError> {
        check_options(poses, options)?;
        check_positive(poses)?;
        let reference = reference_edges(poses, options.reference)?;
        let areas: Vec<f64> = reference.iter().map(|edges| 0.5 * edges.determinant()).collect();
        let components = Components::new(poses, &areas, options.anchor);
        let triangle_components = poses.topology().components();

        let mut splits = split_maps(poses, options.reference, &reference)?;
        let mut ambiguous_turns = false;
        for component in 0..components.pose_anchors.len() {
            let of_component = |t: &usize| triangle_components[*t] == component;
            let area: f64 = (0..areas.len()).filter(of_component).map(|t| areas[t]).sum();
            let means_rad: Vec<f64> = splits
                .iter()
                .map(|pose| {
                    let weighted = (0..areas.len())
                        .filter(of_component)
                        .map(|t| areas[t] * pose[t].angle_rad);
                    weighted.sum::<f64>() / area
                })
                .collect();
            let chosen = match options.reference {
                Reference::Pose(_) => branch::nearest_zero(&means_rad),
                Reference::Canonical => branch::largest_gap(&means_rad),
            };
            ambiguous_turns |= chosen.ambiguous;
            for (pose, split) in splits.iter_mut().enumerate() {
                let asked = options.turns.get(pose).copied().unwrap_or(0);
                let turn_rad = std::f64::consts::TAU * (chosen.turns[pose] + f64::from(asked));
                for t in (0..areas.len()).filter(of_component) {
                    split[t].angle_rad += turn_rad;
                }
            }
        }

        let triangle_count = areas.len();
        let by_triangle = (0..triangle_count).flat_map(|t| splits.iter().map(move |pose| &pose[t]));
        let angles_rad = by_triangle.clone().map(|split| split.angle_rad).collect();
        let stretches = by_triangle
            .map(|split| match options.stretch {
                Stretch::Linear | Stretch::Limited => stretch::entries(&split.stretch),
                Stretch::Log => stretch::logarithm(stretch::entries(&split.stretch), split.determinant),
            })
            .collect();

        let (unknowns, unknown_count) = pin_components(&components);
        let mut weighted_gradients = Vec::with_capacity(triangle_count);
        let mut normal = Triplets::new(unknown_count, unknown_count);
        for ((triangle, edges), area) in poses.topology().triangles().iter().zip(&reference).zip(&areas) {
            let corners = [
                Point::zeros(),
                edges.column(0).into_owned(),
                edges.column(1).into_owned(),
            ];
            let gradients = geometry::barycentric_gradients(corners).ok_or(BlendError::NotFinite)?;
            for (a, &from) in triangle.iter().enumerate() {
                for (b, &to) in triangle.iter().enumerate() {
                    normal.add(unknowns[from], unknowns[to], area * gradients[a].dot(&gradients[b]));
                }
            }
            weighted_gradients.push(gradients.map(|gradient| gradient * *area));
        }

        Ok(Self {
            topology: poses.topology().clone(),
            pose_count: poses.len(),
            stretch: options.stretch,
            angles_rad,
            stretches,
            weighted_gradients,
            unknowns,
            factor: SparseCholesky::new(&normal.build())?,
            components,
            ambiguous_turns,
        })
    }

    /// How many poses, and so weights.
    #[must_use]
    pub fn pose_count(&self) -> usize {
        self.pose_count
    }

    /// Whether some pose could as well turn the other way round: then `turns` should say which way is meant.
    #[must_use]
    pub fn turns_are_ambiguous(&self) -> bool {
        self.ambiguous_turns
    }

    /// The rotation of each triangle of `pose` against its reference, in radians, as blended. Only differences between
    /// poses mean something.
    pub fn angles_rad(&self, pose: usize) -> impl Iterator<Item = f64> + '_ {
        self.angles_rad.iter().skip(pose).step_by(self.pose_count).copied()
    }

    /// Working space for one thread.
    #[must_use]
    pub fn scratch(&self) -> BlendScratch {
        BlendScratch::default()
    }

    /// Blends: `positions` (#vertices) is overwritten.
    ///
    /// # Errors
    /// [`BlendError`] if the weights are not #poses finite numbers that sum to 1 within [`WEIGHT_SUM_TOLERANCE`], or
    /// the result overflows.
    pub fn blend(
        &self,
        weights: &[f64],
        scratch: &mut BlendScratch,
        positions: &mut Vec<Point>,
    ) -> Result<BlendReport, BlendError> {
        self.normalise(weights, &mut scratch.weights)?;
        match self.stretch {
            Stretch::Limited => limit_weights(&scratch.weights, &mut scratch.stretch_weights),
            Stretch::Linear | Stretch::Log => scratch.stretch_weights.clone_from(&scratch.weights),
        }
        self.assemble(scratch);
        self.factor.solve(&mut scratch.right, &mut scratch.solve)?;
        positions.clear();
        positions.extend(self.unknowns.iter().map(|&unknown| match unknown {
            PINNED => Point::zeros(),
            _ => Point::from(scratch.right[unknown]),
        }));
        self.components.place(&scratch.weights, positions);
        if !positions.iter().all(|p| crate::math::point::is_finite(*p)) {
            return Err(BlendError::NotFinite);
        }
        let flipped = self
            .topology
            .triangles()
            .iter()
            .filter(|&&triangle| {
                let [a, b, c] = geometry::corners(positions, triangle);
                !predicate::is_positive(a, b, c)
            })
            .count();
        Ok(BlendReport { flipped })
    }

    fn normalise(&self, weights: &[f64], normalised: &mut Vec<f64>) -> Result<(), BlendError> {
        if weights.len() != self.pose_count {
            return Err(BlendError::WrongCount {
                what: "weights",
                found: weights.len(),
                poses: self.pose_count,
            });
        }
        let sum: f64 = weights.iter().sum();
        // NaN does not sum to 1 either.
        let sums_to_one = (sum - 1.0).abs() <= WEIGHT_SUM_TOLERANCE;
        if !sums_to_one {
            return Err(BlendError::BadWeights { sum });
        }
        normalised.clear();
        normalised.extend(weights.iter().map(|weight| weight / sum));
        Ok(())
    }

    /// The right-hand side of the normal equations: the gradients' transpose times the target maps.
    fn assemble(&self, scratch: &mut BlendScratch) {
        scratch.right.clear();
        scratch.right.resize(self.factor.size(), [0.0; 2]);
        for (t, triangle) in self.topology.triangles().iter().enumerate() {
            let of_triangle = t * self.pose_count..(t + 1) * self.pose_count;
            let angle_rad: f64 = self.angles_rad[of_triangle.clone()]
                .iter()
                .zip(&scratch.weights)
                .map(|(angle_rad, weight)| angle_rad * weight)
                .sum();
            let mut blended = stretch::combination(&scratch.stretch_weights, &self.stretches[of_triangle]);
            if self.stretch == Stretch::Log {
                blended = stretch::exponential(blended);
            }
            let target = rotation_matrix(angle_rad) * stretch::matrix(blended);
            for (&vertex, gradient) in triangle.iter().zip(&self.weighted_gradients[t]) {
                if let Some(right) = scratch.right.get_mut(self.unknowns[vertex]) {
                    let pull = target * gradient;
                    right[0] += pull.x;
                    right[1] += pull.y;
                }
            }
        }
    }
}

impl Components {
    fn new(poses: &PoseSet, areas: &[f64], anchor: Anchor) -> Self {
        let triangle_components = poses.topology().components();
        let count = triangle_components.iter().max().map_or(0, |last| last + 1);
        let mut of_vertex = vec![0; poses.topology().vertex_count()];
        let mut anchor_weights = vec![0.0; of_vertex.len()];
        let mut component_areas = vec![0.0; count];
        for ((triangle, &component), area) in poses.topology().triangles().iter().zip(&triangle_components).zip(areas) {
            component_areas[component] += area;
            for &vertex in triangle {
                of_vertex[vertex] = component;
                anchor_weights[vertex] += area / 3.0;
            }
        }
        for (weight, &component) in anchor_weights.iter_mut().zip(&of_vertex) {
            *weight /= component_areas[component];
        }
        if let Anchor::Vertex(anchor) = anchor {
            let anchored = of_vertex[anchor];
            for (weight, _) in anchor_weights
                .iter_mut()
                .zip(&of_vertex)
                .filter(|(_, c)| **c == anchored)
            {
                *weight = 0.0;
            }
            anchor_weights[anchor] = 1.0;
        }
        let mut components = Self {
            of_vertex,
            anchor_weights,
            pose_anchors: vec![Vec::new(); count],
        };
        for positions in poses.positions() {
            let anchors = components.anchors(positions);
            for (of_poses, place) in components.pose_anchors.iter_mut().zip(anchors) {
                of_poses.push(place);
            }
        }
        components
    }

    /// Where the anchor of each component is.
    fn anchors(&self, positions: &[Point]) -> Vec<Point> {
        let mut anchors = vec![Point::zeros(); self.pose_anchors.len()];
        for ((position, &weight), &component) in positions.iter().zip(&self.anchor_weights).zip(&self.of_vertex) {
            anchors[component] += position * weight;
        }
        anchors
    }

    /// Moves each component so that its anchor is the weighted mean of where it is in the poses.
    fn place(&self, weights: &[f64], positions: &mut [Point]) {
        let moves: Vec<Point> = self
            .anchors(positions)
            .into_iter()
            .zip(&self.pose_anchors)
            .map(|(here, poses)| {
                let wanted: Point = poses.iter().zip(weights).map(|(place, &weight)| place * weight).sum();
                wanted - here
            })
            .collect();
        for (position, &component) in positions.iter_mut().zip(&self.of_vertex) {
            *position += moves[component];
        }
    }
}

/// The map of one triangle from its reference to one pose.
#[derive(Debug, Clone)]
struct Split {
    angle_rad: f64,
    stretch: crate::math::Matrix,
    determinant: f64,
}

/// The split maps, #poses x #triangles, angles consistent over the mesh and over the poses.
fn split_maps(
    poses: &PoseSet,
    reference: Reference,
    reference_edges: &[crate::math::Matrix],
) -> Result<Vec<Vec<Split>>, BlendError> {
    // Pose-to-pose angles are found against one pivot; which one does not matter, since they add up.
    let pivot = match reference {
        Reference::Pose(pose) => pose,
        Reference::Canonical => 0,
    };
    let maps = |pose: usize| {
        let edges = pose_edges(poses, &poses.positions()[pose]);
        edges
            .into_iter()
            .zip(reference_edges)
            .map(|(edges, reference)| match reference.try_inverse() {
                Some(inverse) => Ok(edges * inverse),
                None => Err(BlendError::NotFinite),
            })
            .collect::<Result<Vec<_>, _>>()
    };
    let pivot_rad: Vec<f64> = maps(pivot)?.iter().map(|map| PolarSplit::of(map).angle_rad).collect();
    (0..poses.len())
        .map(|pose| {
            let turned_rad = rotation::pose_to_pose(poses, pivot, pose)?;
            let splits = maps(pose)?
                .iter()
                .zip(pivot_rad.iter().zip(&turned_rad))
                .map(|(map, (&pivot_rad, &turned_rad))| Split {
                    angle_rad: rotation::lift(map, pivot_rad, turned_rad),
                    stretch: PolarSplit::of(map).stretch,
                    determinant: map.determinant(),
                })
                .collect();
            Ok(splits)
        })
        .collect()
}

/// Numbers the unknowns: all vertices but the first of each component, whose place the anchor decides.
fn pin_components(components: &Components) -> (Vec<usize>, usize) {
    let mut seen = vec![false; components.pose_anchors.len()];
    let mut next = 0;
    let unknowns = components
        .of_vertex
        .iter()
        .map(|&component| {
            if std::mem::replace(&mut seen[component], true) {
                next += 1;
                next - 1
            } else {
                PINNED
            }
        })
        .collect();
    (unknowns, next)
}

fn check_options(poses: &PoseSet, options: &BlendOptions) -> Result<(), BlendError> {
    if !options.turns.is_empty() && options.turns.len() != poses.len() {
        return Err(BlendError::WrongCount {
            what: "turns",
            found: options.turns.len(),
            poses: poses.len(),
        });
    }
    match options.anchor {
        Anchor::Vertex(vertex) if vertex >= poses.topology().vertex_count() => Err(BlendError::NoSuchVertex {
            vertex,
            count: poses.topology().vertex_count(),
        }),
        _ => Ok(()),
    }
}

fn check_positive(poses: &PoseSet) -> Result<(), BlendError> {
    for (name, positions) in poses.names().iter().zip(poses.positions()) {
        let inverted = poses.topology().triangles().iter().position(|&triangle| {
            let corners = geometry::corners(positions, triangle);
            // An area that is positive exactly but not in floating point cannot be inverted either.
            let [a, b, c] = corners;
            !(geometry::signed_area(corners) > 0.0 && predicate::is_positive(a, b, c))
        });
        if let Some(triangle) = inverted {
            return Err(BlendError::NotPositive {
                pose: name.clone(),
                triangle,
            });
        }
    }
    Ok(())
}
