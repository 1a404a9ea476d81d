//! A pose of its own brought onto a mesh that is there already.
//!
//! A mesh, one embedding of it, a beginning and where every vertex should be -> an embedding near to that. Boundary and inside move alike; no triangle is
//! inverted on the way, but parts may come to lie over one another.

use super::super::editable::EditableMesh;
use super::distortion::{self, Target};
use super::star::Stars;
use crate::math::Point;
use crate::mesh::Topology;

/// Sweeps at most: vertices begin near to where they should be.
const SWEEPS: usize = 120;
/// Between these, trust counts.
const LEAST_TRUST: f64 = 0.02;
const MOST_TRUST: f64 = 4.0;

/// The vertices of a mesh, which is at `reference` in another pose, moved from `beginning`, where every triangle is positive, towards `wanted`: a place and how
/// sure it is, 1 where it is clear. All are #vertices.
#[must_use]
pub(crate) fn follow(
    topology: &Topology,
    reference: &[Point],
    beginning: Vec<Point>,
    wanted: &[(Point, f64)],
) -> Vec<Point> {
    let mut mesh = EditableMesh::new(vec![reference.to_vec(), beginning], topology.triangles());
    let stars = Stars::of_all(&mesh);
    let target = |&(place, trust): &(Point, f64)| {
        Some(Target {
            place,
            trust: trust.clamp(LEAST_TRUST, MOST_TRUST),
        })
    };
    let targets = [None, Some(wanted.iter().map(target).collect())];
    distortion::minimise_of(&mut mesh, &stars, SWEEPS, &targets, |pose| pose == 1);
    mesh.positions.pop().unwrap_or_default()
}
