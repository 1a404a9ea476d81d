//! Smooth functions over a triangulated part of the plane, one a pose, from values and gradients at the vertices.

use super::clough_tocher;
use super::tessellation::{REACH, Tessellation};
use crate::math::Point;
use crate::mesh::{Located, PointLocator, geometry};

/// Functions with a continuous gradient over the square of half width [`REACH`], but for walls and holes.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    mesh: Tessellation,
    locator: PointLocator,
    /// #vertices x 3 (value, derivative along x and along y) x #poses.
    jets: Vec<f64>,
    pose_count: usize,
}

impl Surface {
    /// Functions that are 1 for the first pose and 0 for the others, until they are given.
    pub(super) fn new(mesh: Tessellation) -> Self {
        let locator = PointLocator::new(&mesh.triangles, &mesh.positions);
        Self {
            jets: mesh.positions.iter().flat_map(|_| [1.0, 0.0, 0.0]).collect(),
            mesh,
            locator,
            pose_count: 1,
        }
    }

    /// Takes other functions: `jets` is #vertices x 3 x `pose_count`.
    ///
    /// The jets are first made to sum to (1, 0, 0) at each vertex, which they do but for the rounding in the solve: the
    /// difference is shared out evenly, and nothing changes at the poses.
    pub(super) fn set(&mut self, mut jets: Vec<f64>, pose_count: usize) {
        for (k, part) in jets.chunks_exact_mut(pose_count).enumerate() {
            let whole = if k % 3 == 0 { 1.0 } else { 0.0 };
            let missing = whole - part.iter().sum::<f64>();
            for entry in part {
                *entry += missing / pose_count as f64;
            }
        }
        self.jets = jets;
        self.pose_count = pose_count;
    }

    pub(super) fn mesh(&self) -> &Tessellation {
        &self.mesh
    }

    /// Where `p`, or the nearest point of the mesh, is. `None` only without triangles.
    pub(super) fn locate(&self, p: Point) -> Option<Located> {
        self.locator
            .nearest(p.map(|coordinate| coordinate.clamp(-REACH, REACH)))
    }

    /// The values at `p`, or at the nearest point of the mesh; `values` is overwritten.
    pub(super) fn values(&self, p: Point, values: &mut Vec<f64>) {
        values.clear();
        let Some(located) = self.locate(p) else {
            // A mesh without triangles does not come about.
            values.resize(self.pose_count, 1.0 / self.pose_count as f64);
            return;
        };
        values.resize(self.pose_count, 0.0);
        let vertices = self.mesh.triangles[located.triangle];
        let form = clough_tocher::value_form(geometry::corners(&self.mesh.positions, vertices), located.barycentric);
        for (vertex, factors) in vertices.into_iter().zip(form.chunks_exact(3)) {
            let jet = &self.jets[vertex * 3 * self.pose_count..(vertex + 1) * 3 * self.pose_count];
            for (part, factor) in jet.chunks_exact(self.pose_count).zip(factors) {
                for (value, entry) in values.iter_mut().zip(part) {
                    *value += factor * entry;
                }
            }
        }
    }
}
