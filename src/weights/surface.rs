//! Smooth functions over a triangulated square, one a pose, from values and gradients at the vertices.

use super::clough_tocher::Patch;
use super::tessellation::{REACH, Tessellation};
use crate::math::Point;
use crate::mesh::{PointLocator, geometry};

/// Value, derivative along x and derivative along y.
pub(super) type Jet = [f64; 3];

/// Functions with a continuous gradient over the square of half width [`REACH`].
#[derive(Debug, Clone)]
pub(super) struct Surface {
    mesh: Tessellation,
    locator: PointLocator,
    /// #vertices x #poses.
    jets: Vec<Jet>,
    pose_count: usize,
}

impl Surface {
    /// The surface through `jets` (#vertices x #poses).
    ///
    /// The jets are first made to sum to (1, 0, 0) at each vertex, which they do but for the rounding in the solve: the
    /// difference is shared out evenly, and nothing changes at the poses.
    pub(super) fn new(mesh: Tessellation, mut jets: Vec<Jet>, pose_count: usize) -> Self {
        for at_vertex in jets.chunks_exact_mut(pose_count) {
            for (k, whole) in [1.0, 0.0, 0.0].into_iter().enumerate() {
                let missing = whole - at_vertex.iter().map(|jet| jet[k]).sum::<f64>();
                for jet in at_vertex.iter_mut() {
                    jet[k] += missing / pose_count as f64;
                }
            }
        }
        let locator = PointLocator::new(&mesh.triangles, &mesh.positions);
        Self {
            mesh,
            locator,
            jets,
            pose_count,
        }
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.mesh.positions.len()
    }

    /// The values at `p`, or at the nearest point of the square; `values` is overwritten.
    pub(super) fn values(&self, p: Point, values: &mut Vec<f64>) {
        values.clear();
        let inside = p.map(|coordinate| coordinate.clamp(-REACH, REACH));
        let Some(located) = self.locator.nearest(inside) else {
            // A mesh without triangles does not come about.
            values.resize(self.pose_count, 1.0 / self.pose_count as f64);
            return;
        };
        let vertices = self.mesh.triangles[located.triangle];
        let corners = geometry::corners(&self.mesh.positions, vertices);
        for pose in 0..self.pose_count {
            let mut data = [0.0; 9];
            for (at_corner, vertex) in data.chunks_exact_mut(3).zip(vertices) {
                at_corner.copy_from_slice(&self.jets[vertex * self.pose_count + pose]);
            }
            values.push(Patch::new(corners, &data).value(located.barycentric));
        }
    }
}
