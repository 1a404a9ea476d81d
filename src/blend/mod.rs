//! The rigid N-way blend: N poses of one mesh and N weights in, one mesh out.
//!
//! Source: Baxter, Barla, Anjyo, "N-way morphing for 2D animation", section 4.2, after Alexa, Cohen-Or, Levin 2000.
//!
//! 1. Every triangle of every pose is mapped from a reference triangle by a matrix `A`, split into a rotation and a
//!    symmetric stretch: `A = R(alpha) S` ([`crate::math::PolarSplit`]).
//! 2. The angles are made consistent over the mesh and over the poses ([`rotation`], [`branch`]).
//! 3. For weights `w` the targets are `A(w) = R(sum w_i alpha_i) S(w)` ([`stretch`]).
//! 4. Vertices minimise `sum area |J(V) - A(w)|^2`: one sparse factorisation, two triangular solves a frame for x and
//!    y together ([`RigidBlend`]).
//! 5. An anchor fixes the translation.
//!
//! Differences from the paper:
//! - Its last formula writes `R(alpha_{tau,i}(w))`; the subscript `i` is a misprint, the angle is the blended one.
//! - The sum over triangles is weighted by area, so that the result converges as the mesh is refined.
//! - By default no pose is the base: each triangle has a reference of its own, the mean of its metric over the poses
//!   ([`mod@reference`]), and the result depends neither on a base nor on the order of the poses. The references do not
//!   fit together in the plane and need not: the energy only needs each triangle's shape.
//! - Stretches can be blended through their logarithms, which stays positive for all weights.
//! - Triangles that come out inverted are counted and reported.

pub mod branch;
pub mod reference;
mod rigid;
pub mod rotation;
pub mod stretch;

#[cfg(test)]
mod tests;

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
    /// Log-Euclidean: `exp(sum w_i log S_i)`, positive for every weight.
    Log,
}

/// What moves linearly in the weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Anchor {
    /// The centroid, by the reference's triangle areas.
    #[default]
    Centroid,
    /// This vertex. Mesh components without it keep their centroids.
    Vertex(usize),
}

/// What [`RigidBlend`] can be told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BlendOptions {
    /// Default: [`Reference::Canonical`].
    pub reference: Reference,
    /// Default: [`Stretch::Linear`].
    pub stretch: Stretch,
    /// Default: [`Anchor::Centroid`].
    pub anchor: Anchor,
    /// Whole turns added to each pose's rotation; empty (the default) for none.
    pub turns: Vec<i32>,
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
    /// The anchor is no vertex.
    #[error("there is no vertex {vertex} to anchor: the mesh has {count}")]
    NoSuchVertex {
        /// The index asked for.
        vertex: usize,
        /// Vertices of the mesh.
        count: usize,
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
