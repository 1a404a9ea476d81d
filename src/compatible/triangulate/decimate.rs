//! Takes Steiner points out of a compatible triangulation.
//!
//! 1. The triangles around an interior vertex form a polygon in every pose. If that ring can be triangulated with common
//!    diagonals, the vertex goes; likewise for the two ends of an edge together. Passes are repeated until none helps.
//! 2. Larger patches are solved anew with fewer points ([`super::patch`]), plain ones and then widened ones.
//! 3. Patches are solved differently with as many points, and all is repeated, until a few rounds have gained nothing or
//!    the work is used up.

use super::patch::{Kept, Resolver};
use super::{line_of_sight, visibility};
use crate::compatible::editable::EditableMesh;

/// Rings with more vertices are left: re-triangulating is cubic in them, and they hardly ever close.
const LARGEST_RING: usize = 40;

/// Passes over all vertices, at most; four or five are used.
const PASSES: usize = 20;

/// Rounds without any gain before the search ends.
const IDLE_ROUNDS: usize = 8;

/// Removes what interior vertices it can, but for what is to be kept, with so much work for the search; returns how many.
pub(super) fn decimate(mesh: &mut EditableMesh, kept: &Kept, work: usize) -> usize {
    let mut removed = 0;
    let mut resolver = Resolver::new(kept, work);
    let mut idle = 0;
    while idle < IDLE_ROUNDS {
        let saved = remove_all(mesh, kept.below) + resolver.resolve(mesh);
        removed += saved;
        idle = if saved > 0 { 0 } else { idle + 1 };
        removed += resolver.shake(mesh);
        if resolver.is_exhausted() {
            break;
        }
    }
    removed
}

/// Removes vertices one by one and in pairs until none goes.
fn remove_all(mesh: &mut EditableMesh, boundary_count: usize) -> usize {
    let mut removed = 0;
    for _ in 0..PASSES {
        let before = removed;
        for vertex in boundary_count..mesh.vertex_count() {
            if mesh.degree(vertex) > 0 && remove_one(mesh, vertex) {
                removed += 1;
            }
        }
        if removed == before {
            for vertex in boundary_count..mesh.vertex_count() {
                if mesh.degree(vertex) > 0 && remove_with_neighbour(mesh, vertex, boundary_count) {
                    removed += 2;
                }
            }
        }
        if removed == before {
            break;
        }
    }
    removed
}

fn remove_one(mesh: &mut EditableMesh, vertex: usize) -> bool {
    let Some(ring) = mesh.ring(vertex) else { return false };
    let Some(triangles) = retriangulation(mesh, &ring) else {
        return false;
    };
    mesh.remove_star(vertex);
    for triangle in triangles {
        mesh.add(triangle);
    }
    true
}

/// Removes `vertex` and an adjacent interior vertex with a higher number: the first whose common ring closes without
/// either.
fn remove_with_neighbour(mesh: &mut EditableMesh, vertex: usize, boundary_count: usize) -> bool {
    let Some(ring) = mesh.ring(vertex) else { return false };
    for &other in ring.iter().filter(|&&v| v > vertex && v >= boundary_count) {
        let Some(joint) = joint_ring(mesh, vertex, other) else {
            continue;
        };
        let Some(triangles) = retriangulation(mesh, &joint) else {
            continue;
        };
        mesh.remove_star(vertex);
        mesh.remove_star(other);
        for triangle in triangles {
            mesh.add(triangle);
        }
        return true;
    }
    false
}

/// The polygon around two adjacent interior vertices; `None` if it visits a vertex twice.
fn joint_ring(mesh: &EditableMesh, a: usize, b: usize) -> Option<Vec<usize>> {
    let (ring_a, ring_b) = (mesh.ring(a)?, mesh.ring(b)?);
    let place = |ring: &[usize], v: usize| ring.iter().position(|&w| w == v);
    // Around a, from the vertex after b to the vertex before b; then around b likewise, their ends being shared.
    let at_a = place(&ring_a, b)?;
    let at_b = place(&ring_b, a)?;
    let around_a = (1..ring_a.len()).map(|k| ring_a[(at_a + k) % ring_a.len()]);
    let around_b = (2..ring_b.len() - 1).map(|k| ring_b[(at_b + k) % ring_b.len()]);
    let joint: Vec<usize> = around_a.chain(around_b).collect();
    let mut sorted = joint.clone();
    sorted.sort_unstable();
    sorted.dedup();
    (sorted.len() == joint.len()).then_some(joint)
}

/// A triangulation of the polygon `ring` by common diagonals, the one with the best worst angle; proven positive.
fn retriangulation(mesh: &EditableMesh, ring: &[usize]) -> Option<Vec<[usize; 3]>> {
    if ring.len() > LARGEST_RING {
        return None;
    }
    let sights = visibility::look(&mesh.positions, ring).ok()?;
    let common = visibility::common_pairs(&sights);
    let quality = |triangle| visibility::worst_angle_rad(&sights, triangle);
    let triangles = line_of_sight::best_triangulation(ring.len(), &common, quality)?;
    let triangles: Vec<[usize; 3]> = triangles.into_iter().map(|t| t.map(|k| ring[k])).collect();
    triangles.iter().all(|&t| mesh.is_positive(t)).then_some(triangles)
}
