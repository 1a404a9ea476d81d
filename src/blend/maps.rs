//! Every triangle of every pose as a turned stretch of its reference: angles that fit together, and stretches.
//!
//! 1. `A_i` maps the reference triangle to pose `i`; `A_i = R(alpha_i) S_i` ([`PolarSplit`]).
//! 2. `alpha_i` is lifted through the angles from one pose to another, which are consistent over the mesh
//!    ([`rotation`]).
//! 3. Each connected piece of the mesh is turned by whole turns as a whole ([`branch`]), and as often as the artist asks.

use rayon::prelude::*;

use super::reference::pose_edges;
use super::stretch::{self, Symmetric};
use super::{BlendError, BlendOptions, Reference, Stretch, branch, rotation};
use crate::math::{Matrix, PolarSplit};
use crate::pose::PoseSet;

/// One pose against the references, by triangle.
#[derive(Debug, Clone)]
pub(super) struct PoseMaps {
    /// `alpha` in NWM 4.2, consistent over the mesh and over the poses.
    pub(super) angles_rad: Vec<f64>,
    /// `S` in NWM 4.2.
    pub(super) stretches: Vec<Symmetric>,
    /// The determinant of `S`, which for needles its entries no longer hold.
    pub(super) determinants: Vec<f64>,
}

/// All poses against the references.
#[derive(Debug, Clone)]
pub(super) struct TriangleMaps {
    pub(super) poses: Vec<PoseMaps>,
    /// Whether another whole-pose branch was equally good.
    pub(super) ambiguous_turns: bool,
}

impl TriangleMaps {
    /// The maps from `reference_edges` with areas `areas`; `components` names the piece of the mesh of each triangle.
    ///
    /// # Errors
    /// [`BlendError::NotClosed`], or [`BlendError::NotFinite`] if a reference triangle cannot be inverted.
    pub(super) fn new(
        poses: &PoseSet,
        options: &BlendOptions,
        reference_edges: &[Matrix],
        areas: &[f64],
        components: &[usize],
    ) -> Result<Self, BlendError> {
        let inverses = reference_edges
            .iter()
            .map(|edges| edges.try_inverse().ok_or(BlendError::NotFinite))
            .collect::<Result<Vec<_>, _>>()?;
        let maps = |pose: usize| -> Vec<Matrix> {
            let edges = pose_edges(poses, &poses.positions()[pose]);
            edges
                .iter()
                .zip(&inverses)
                .map(|(edges, inverse)| edges * inverse)
                .collect()
        };
        // Pose-to-pose angles are found against one pivot; which one does not matter, since they add up.
        let pivot = match options.reference {
            Reference::Pose(pose) => pose,
            Reference::Canonical => 0,
        };
        let pivot_rad: Vec<f64> = maps(pivot).iter().map(PolarSplit::angle_rad_of).collect();
        let mut pose_maps = (0..poses.len())
            .into_par_iter()
            .map(|pose| {
                let turned_rad = rotation::pose_to_pose(poses, pivot, pose)?;
                let maps = maps(pose);
                let splits: Vec<PolarSplit> = maps.iter().map(PolarSplit::of).collect();
                let near_rad = pivot_rad.iter().zip(&turned_rad).map(|(pivot, turned)| pivot + turned);
                Ok(PoseMaps {
                    angles_rad: splits
                        .iter()
                        .zip(near_rad)
                        .map(|(split, near)| rotation::lift(split, near))
                        .collect(),
                    stretches: splits.iter().map(|split| stretch::entries(&split.stretch)).collect(),
                    determinants: maps.iter().map(Matrix::determinant).collect(),
                })
            })
            .collect::<Result<Vec<_>, BlendError>>()?;

        let mut ambiguous_turns = false;
        let component_count = components.iter().max().map_or(0, |last| last + 1);
        let mut component_areas = vec![0.0; component_count];
        for (&component, area) in components.iter().zip(areas) {
            component_areas[component] += area;
        }
        for (component, component_area) in component_areas.iter().enumerate() {
            let of_component = |t: &usize| components[*t] == component;
            let mean_rad = |pose: &PoseMaps| {
                let weighted = (0..areas.len())
                    .filter(of_component)
                    .map(|t| areas[t] * pose.angles_rad[t]);
                weighted.sum::<f64>() / component_area
            };
            let means_rad: Vec<f64> = pose_maps.iter().map(mean_rad).collect();
            let chosen = match options.reference {
                Reference::Pose(_) => branch::nearest_zero(&means_rad),
                Reference::Canonical => branch::largest_gap(&means_rad),
            };
            ambiguous_turns |= chosen.ambiguous;
            for (k, pose) in pose_maps.iter_mut().enumerate() {
                let asked = options.turns.get(k).copied().unwrap_or(0);
                let turn_rad = std::f64::consts::TAU * (chosen.turns[k] + f64::from(asked));
                for t in (0..areas.len()).filter(of_component) {
                    pose.angles_rad[t] += turn_rad;
                }
            }
        }
        Ok(Self {
            poses: pose_maps,
            ambiguous_turns,
        })
    }

    /// What is blended linearly for `stretch`: the stretches, or their logarithms.
    pub(super) fn blendable(&self, pose: usize, triangle: usize, stretch: Stretch) -> Symmetric {
        let pose = &self.poses[pose];
        match stretch {
            Stretch::Linear | Stretch::Limited => pose.stretches[triangle],
            Stretch::Log => stretch::logarithm(pose.stretches[triangle], pose.determinants[triangle]),
        }
    }
}
