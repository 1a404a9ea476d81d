//! The rigid N-way blend: N poses of one mesh and N weights in, one mesh out.
//!
//! Source: Baxter, Barla, Anjyo, "N-way morphing for 2D animation", section 4.2, after Alexa, Cohen-Or, Levin 2000.
//!
//! 1. Every triangle of every pose is mapped from a reference triangle by a matrix `A`, split into a rotation and a
//!    symmetric stretch: `A = R(alpha) S` (`math::PolarSplit`).
//! 2. The angles are made consistent over the mesh and over the poses (`rotation.rs`, `branch.rs`).
//! 3. For weights `w` the targets are `A(w) = R(sum w_i alpha_i) S(w)` (`stretch.rs`).
//! 4. Vertices minimise `sum area |J(V) - A(w)|^2`: one sparse factorisation, two triangular solves a frame for x and
//!    y together ([`RigidBlend`]).
//! 5. An anchor fixes the translation; several soft ones are terms of the same energy.
//! 6. Inverted triangles are counted, or the frame is repaired ([`FrameGuard`]). Whether its outline crosses itself, and how far it is distorted, a [`Certificate`] says.
//!
//! Differences from the paper:
//! - Its last formula writes `R(alpha_{tau,i}(w))`; the subscript `i` is a misprint, the angle is the blended one.
//! - The sum over triangles is weighted by area, so that the result converges as the mesh is refined.
//! - By default no pose is the base: each triangle has a reference of its own, the mean of its metric over the poses
//!   (`reference.rs`), and the result depends neither on a base nor on the order of the poses. The references do not
//!   fit together in the plane and need not: the energy only needs each triangle's shape.
//! - Stretches can be blended through their logarithms, which stays positive for all weights.
//! - Parts can be stiffer than others, or limited in how far they stretch ([`Region`]).
//! - Triangles that come out inverted are counted and reported, or pushed back by a barrier.
//! - Many characters of one kind are blended in one call ([`RigidBlend::blend_crowd`]).
//!
//! # Pictures
//!
//! The example `blending` draws, after figures 3, 4 and 1 of the paper, this blend next to straight paths of the vertices,
//! which shrink whatever turns; every [`Stretch`] beyond the poses, where the linear one folds triangles over, the limited one
//! keeps to what the poses show and the logarithmic one stays positive but grows exponentially; and a morph next to
//! deformations by handles. `data/pictures` has them.

mod anchor;
mod between;
mod branch;
mod certificate;
mod crowd;
mod distortion;
mod guard;
mod maps;
mod reference;
mod region;
mod rigid;
mod rotation;
mod stretch;
mod system;
mod targets;

#[cfg(test)]
mod tests;

pub use certificate::{BoundaryCrossing, Certificate, Certifier, LimbOverlap, TRUNK};
pub use crowd::CrowdScratch;
pub use distortion::Distortion;
pub use rigid::{BlendReport, BlendScratch, RigidBlend, WEIGHT_SUM_TOLERANCE, blend_once};

use crate::solve::SolveError;

/// What the triangles are mapped from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reference {
    /// The mean metric of each triangle over the poses: no pose is special.
    #[default]
    Canonical,
    /// The triangles of this pose: the paper's own form.
    Pose(usize),
}

/// How stretches are blended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stretch {
    /// `sum w_i S_i`.
    #[default]
    Linear,
    /// The paper's shear limiting: `sum w'_i S_i` with the weights through a Hermite cubic; rotations keep the raw
    /// weights.
    Limited,
    /// Log-Euclidean: `exp(sum w_i log S_i)`, positive for every weight; far beyond the poses, where one shows a triangle much
    /// longer or wider than another, it grows exponentially.
    Log,
}

impl Stretch {
    /// What each is called in scene files and on the command line.
    pub const NAMED: [(&'static str, Self); 3] =
        [("linear", Self::Linear), ("limited", Self::Limited), ("log", Self::Log)];

    /// The one of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMED.into_iter().find(|(own, _)| *own == name);
        found.map(|(_, stretch)| stretch)
    }
}

/// What moves linearly in the weights, or as the caller of a frame says ([`RigidBlend::blend_anchored`]).
///
/// A point is given by its number: a vertex of the mesh, or a landmark where the mesh is not known yet
/// ([`BlendOptions::with_points`]).
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Anchor {
    /// The centroid, by the reference's triangle areas.
    #[default]
    Centroid,
    /// This point, exactly. Mesh components without it keep their centroids.
    Point(usize),
    /// Several points, each as far as the shape gives way. Mesh components without any keep their centroids.
    Soft(Vec<SoftAnchor>),
}

/// A point that is drawn towards a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftAnchor {
    /// Which point; see [`Anchor`].
    pub point: usize,
    /// How strongly, a number without unit: at 1 it counts about as much as the shape of the triangles around it, at
    /// 1000 it is met to a thousandth or so of what the shape gives way elsewhere.
    pub stiffness: f64,
}

/// What happens to a frame with triangles that are turned over, or nearly so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FrameGuard {
    /// They are counted.
    #[default]
    Off,
    /// The frame is replaced by the nearest one in which every triangle keeps a twentieth or so of its smallest area in any
    /// pose.
    Repair,
}

/// A disc on the mesh around a point in which the shape is stiffer, or may not be stretched far. Fades smoothly
/// between half its radius and its radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// The point in the middle; see [`Anchor`].
    pub point: usize,
    /// How far it reaches along the mesh, as a fraction of a pose's diagonal.
    pub radius: f64,
    /// What the energy of its triangles is multiplied by; 1 changes nothing.
    pub stiffness: f64,
    /// By which factor triangles may be stretched or squashed more than in any pose; at least 1, infinite for no limit.
    pub stretch_limit: f64,
}

/// What [`RigidBlend`] can be told.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct BlendOptions {
    /// Default: [`Reference::Canonical`].
    pub reference: Reference,
    /// Default: [`Stretch::Linear`].
    pub stretch: Stretch,
    /// Default: [`Anchor::Centroid`].
    pub anchor: Anchor,
    /// Whole turns added to each pose's rotation; empty (the default) for none.
    pub turns: Vec<i32>,
    /// Parts that are stiffer than others; empty (the default) for none.
    pub regions: Vec<Region>,
    /// Default: [`FrameGuard::Off`].
    pub guard: FrameGuard,
}

impl BlendOptions {
    /// The options with the points that `place_of` has a new number for; anchors and regions whose point has none are left out, and without
    /// any anchor left the centroid is one.
    #[must_use]
    pub(crate) fn with_points_left(&self, place_of: impl Fn(usize) -> Option<usize>) -> Self {
        let anchor = match &self.anchor {
            Anchor::Centroid => Anchor::Centroid,
            Anchor::Point(point) => place_of(*point).map_or(Anchor::Centroid, Anchor::Point),
            Anchor::Soft(anchors) => {
                let left = anchors.iter().filter_map(|anchor| {
                    let point = place_of(anchor.point)?;
                    Some(SoftAnchor { point, ..*anchor })
                });
                match left.collect::<Vec<_>>() {
                    none if none.is_empty() => Anchor::Centroid,
                    left => Anchor::Soft(left),
                }
            }
        };
        let regions = self.regions.iter().filter_map(|region| {
            let point = place_of(region.point)?;
            Some(Region { point, ..*region })
        });
        Self {
            anchor,
            regions: regions.collect(),
            ..self.clone()
        }
    }

    /// The options with every point replaced by what `number_of` makes of its number: from landmarks to vertices.
    #[must_use]
    pub fn with_points(&self, number_of: impl Fn(usize) -> usize) -> Self {
        let mut options = self.clone();
        match &mut options.anchor {
            Anchor::Centroid => {}
            Anchor::Point(point) => *point = number_of(*point),
            Anchor::Soft(anchors) => {
                for anchor in anchors {
                    anchor.point = number_of(anchor.point);
                }
            }
        }
        for region in &mut options.regions {
            region.point = number_of(region.point);
        }
        options
    }

    /// The points that the options name, the anchor's first.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        let (one, soft) = match &self.anchor {
            Anchor::Centroid => (None, [].as_slice()),
            Anchor::Point(point) => (Some(*point), [].as_slice()),
            Anchor::Soft(anchors) => (None, anchors.as_slice()),
        };
        let regions = self.regions.iter().map(|region| region.point);
        one.into_iter()
            .chain(soft.iter().map(|anchor| anchor.point))
            .chain(regions)
    }
}

/// Why there is no blend.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BlendError {
    /// A triangle of a pose is inverted or has no area.
    #[error("pose '{pose}': triangle {triangle} is not positive; blending needs a valid mapping")]
    NotPositive {
        /// The pose's name.
        pose: String,
        /// Which triangle.
        triangle: usize,
    },
    /// The rotations of neighbouring triangles do not fit around the mesh.
    #[error(
        "pose '{pose}': the rotations of triangles {first} and {second} differ by whole turns however the mesh is \
         walked; the mesh overlaps itself in some pose"
    )]
    NotClosed {
        /// The pose's name.
        pose: String,
        /// A triangle.
        first: usize,
        /// Its neighbour.
        second: usize,
    },
    /// A pose index is too large.
    #[error("there is no pose {pose}: the poses are numbered 0 to {last}")]
    NoSuchPose {
        /// The index asked for.
        pose: usize,
        /// The largest there is.
        last: usize,
    },
    /// An anchor or the middle of a region is no vertex.
    #[error("there is no vertex {vertex}: the mesh has {count}")]
    NoSuchVertex {
        /// The index asked for.
        vertex: usize,
        /// Vertices of the mesh.
        count: usize,
    },
    /// A frame has the wrong number of vertices.
    #[error("{found} vertices for a mesh of {expected}")]
    WrongVertexCount {
        /// Given.
        found: usize,
        /// The mesh's vertices.
        expected: usize,
    },
    /// One number a pose is needed.
    #[error("{found} {what} for {poses} poses")]
    WrongCount {
        /// Of what.
        what: &'static str,
        /// Given.
        found: usize,
        /// Poses.
        poses: usize,
    },
    /// An option has a value that makes no sense.
    #[error("{option} is {value}, but must be {must_be}")]
    BadOption {
        /// Which one.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        must_be: &'static str,
    },
    /// Indices of vertices take four bytes.
    #[error("{count} vertices are too many for a blend; use a coarser mesh")]
    TooLarge {
        /// Vertices of the mesh.
        count: usize,
    },
    /// The weights are not finite or do not sum to 1.
    #[error("the weights sum to {sum}; they must sum to 1")]
    BadWeights {
        /// Their sum; NaN if one is not finite.
        sum: f64,
    },
    /// The result overflowed.
    #[error("the blend overflows: these weights are too far outside the poses")]
    NotFinite,
    /// The linear system cannot be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}
