//! The least-squares problem of NWM 4.2: vertices whose triangles come as near as they can to what they want.
//!
//! The energy is `sum w |J(V) - A|^2` with `w` the area of the reference triangle times its stiffness, plus the terms of
//! soft anchors. `J` is linear in the vertices, so the normal equations have one matrix for all frames, and only the
//! right-hand side changes: for each triangle and corner, `w A` times the gradient of the corner's barycentric coordinate.
//!
//! Unknowns are kept in the order in which the factorisation eliminates them, so that a frame goes from the triangles
//! to the vertices without a copy in between.

use super::BlendError;
use super::anchor::Anchors;
use super::targets::{BlockMaps, Blocks, Targets};
use crate::math::sine::{LANES, Lanes};
use crate::math::{Matrix, Point, vectorised};
use crate::mesh::{Topology, geometry};
use crate::solve::{SparseCholesky, Triplets};

/// The factored matrix, and how right-hand sides are put together.
#[derive(Debug, Clone)]
pub(super) struct System {
    factor: SparseCholesky,
    /// Where each vertex's unknown is; the pinned ones have the place after the last, which is never solved for.
    slots: Vec<u32>,
    stencils: Vec<Stencil>,
}

/// A block of triangles. Lanes past the last triangle have no gradient, and the pinned slot.
#[derive(Debug, Clone)]
struct Stencil {
    slots: [[u32; LANES]; 3],
    /// `w` times the gradients of the second and the third corner, x and y; that of the first is minus their sum.
    gradients: [Lanes; 4],
}

impl System {
    /// The system for triangles that come from `reference_edges`, each weighted by `areas` times `stiffness`.
    ///
    /// # Errors
    /// [`BlendError::NotFinite`] or [`BlendError::Solve`].
    pub(super) fn new(
        topology: &Topology,
        reference_edges: &[Matrix],
        areas: &[f64],
        stiffness: &[f64],
        anchors: &Anchors,
    ) -> Result<Self, BlendError> {
        let vertex_count = topology.vertex_count();
        let mut is_pinned = vec![false; vertex_count];
        for vertex in anchors.pinned_vertices() {
            is_pinned[vertex] = true;
        }
        let unknown_count = is_pinned.iter().filter(|pinned| !**pinned).count();
        let mut next = 0;
        let unknowns: Vec<usize> = is_pinned
            .iter()
            .map(|&pinned| {
                next += usize::from(!pinned);
                if pinned { unknown_count } else { next - 1 }
            })
            .collect();

        let mut normal = Triplets::new(unknown_count, unknown_count);
        let mut gradients = Vec::with_capacity(areas.len());
        for (t, (triangle, edges)) in topology.triangles().iter().zip(reference_edges).enumerate() {
            let corners = [
                Point::zeros(),
                edges.column(0).into_owned(),
                edges.column(1).into_owned(),
            ];
            let of_corners = geometry::barycentric_gradients(corners).ok_or(BlendError::NotFinite)?;
            let weight = areas[t] * stiffness[t];
            for (a, &from) in triangle.iter().enumerate() {
                // The factorisation reads the lower triangle only.
                let below = triangle
                    .iter()
                    .enumerate()
                    .filter(|(_, to)| unknowns[**to] <= unknowns[from]);
                for (b, &to) in below {
                    normal.add(unknowns[from], unknowns[to], weight * of_corners[a].dot(&of_corners[b]));
                }
            }
            gradients.push([of_corners[1] * weight, of_corners[2] * weight]);
        }
        for (vertex, stiffness) in anchors.stiffnesses() {
            normal.add(unknowns[vertex], unknowns[vertex], stiffness);
        }
        let factor = SparseCholesky::new(&normal.build())?;

        let mut slot_of_unknown = vec![0; unknown_count + 1];
        for (slot, &unknown) in factor.order().iter().enumerate() {
            slot_of_unknown[unknown] = slot;
        }
        slot_of_unknown[unknown_count] = unknown_count;
        let narrow = |slot: usize| u32::try_from(slot).map_err(|_| BlendError::TooLarge { count: vertex_count });
        let slots = unknowns
            .iter()
            .map(|&unknown| narrow(slot_of_unknown[unknown]))
            .collect::<Result<Vec<_>, _>>()?;
        let pinned_slot = narrow(unknown_count)?;
        let blocks = Blocks::of(topology.triangles().len());
        let empty = Stencil {
            slots: [[pinned_slot; LANES]; 3],
            gradients: [[0.0; LANES]; 4],
        };
        let mut stencils = vec![empty; blocks.count()];
        for (t, (triangle, [second, third])) in topology.triangles().iter().zip(gradients).enumerate() {
            let (block, lane) = blocks.place(t);
            let stencil = &mut stencils[block];
            for (corner, &vertex) in triangle.iter().enumerate() {
                stencil.slots[corner][lane] = slots[vertex];
            }
            for (of_gradient, entry) in stencil.gradients.iter_mut().zip([second.x, second.y, third.x, third.y]) {
                of_gradient[lane] = entry;
            }
        }
        Ok(Self {
            factor,
            slots,
            stencils,
        })
    }

    /// Entries of a right-hand side: one an unknown, and the one of all pinned vertices.
    pub(super) fn right_len(&self) -> usize {
        self.factor.size() + 1
    }

    /// Entries of the factor.
    pub(super) fn factor_entry_count(&self) -> usize {
        self.factor.factor_entry_count()
    }

    /// Puts the right-hand side of a frame together: what `targets` want at these weights, and what soft anchors pull. It is
    /// added to the columns `2 frame` and `2 frame + 1` of `right`.
    pub(super) fn assemble<const K: usize>(
        &self,
        targets: &Targets,
        weights: &[f64],
        stretch_weights: &[f64],
        pulls: impl Iterator<Item = (usize, Point)>,
        right: &mut [[f64; K]],
        frame: usize,
    ) {
        vectorised(
            #[inline(always)]
            || {
                let mut maps: BlockMaps = [[0.0; LANES]; 4];
                for (block, stencil) in self.stencils.iter().enumerate() {
                    targets.block(block, weights, stretch_weights, &mut maps);
                    stencil.add(&maps, right, frame);
                }
            },
        );
        for (vertex, pull) in pulls {
            let entry = columns_of(right, self.slots[vertex] as usize, frame);
            entry[0] += pull.x;
            entry[1] += pull.y;
        }
    }

    /// Puts one value a vertex, in order, into a right-hand side.
    pub(super) fn set<const K: usize>(&self, values: impl Iterator<Item = [f64; K]>, right: &mut [[f64; K]]) {
        for (&slot, value) in self.slots.iter().zip(values) {
            right[slot as usize] = value;
        }
    }

    /// Solves for `K / 2` frames in place, their x and y side by side; pinned vertices come out at the origin.
    ///
    /// # Errors
    /// [`BlendError::Solve`] if there are not [`Self::right_len`] entries.
    pub(super) fn solve<const K: usize>(&self, right: &mut [[f64; K]]) -> Result<(), BlendError> {
        let unknown_count = self.factor.size();
        if let Some(pinned) = right.get_mut(unknown_count) {
            *pinned = [0.0; K];
        }
        self.factor
            .solve_in_order(right.get_mut(..unknown_count).unwrap_or_default())?;
        Ok(())
    }

    /// The solved place of every vertex, in order.
    pub(super) fn solved<'a, const K: usize>(
        &'a self,
        right: &'a [[f64; K]],
    ) -> impl Iterator<Item = &'a [f64; K]> + 'a {
        self.slots.iter().map(|&slot| &right[slot as usize])
    }
}

impl Stencil {
    /// Adds what the triangles of the block pull at their corners.
    #[inline(always)]
    fn add<const K: usize>(&self, [m11, m12, m21, m22]: &BlockMaps, right: &mut [[f64; K]], frame: usize) {
        let [x1, y1, x2, y2] = &self.gradients;
        let mut pulls = [[0.0; 4]; LANES];
        for (lane, pull) in pulls.iter_mut().enumerate() {
            *pull = [
                m11[lane] * x1[lane] + m12[lane] * y1[lane],
                m21[lane] * x1[lane] + m22[lane] * y1[lane],
                m11[lane] * x2[lane] + m12[lane] * y2[lane],
                m21[lane] * x2[lane] + m22[lane] * y2[lane],
            ];
        }
        for (lane, &[px, py, qx, qy]) in pulls.iter().enumerate() {
            let [first, second, third] = [0, 1, 2].map(|corner| self.slots[corner][lane] as usize);
            let entry = columns_of(right, first, frame);
            *entry = [entry[0] - (px + qx), entry[1] - (py + qy)];
            let entry = columns_of(right, second, frame);
            *entry = [entry[0] + px, entry[1] + py];
            let entry = columns_of(right, third, frame);
            *entry = [entry[0] + qx, entry[1] + qy];
        }
    }
}

/// The x and y of a frame at an unknown.
#[inline(always)]
fn columns_of<const K: usize>(right: &mut [[f64; K]], slot: usize, frame: usize) -> &mut [f64; 2] {
    &mut right[slot].as_chunks_mut().0[frame]
}
