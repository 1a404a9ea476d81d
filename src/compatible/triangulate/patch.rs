//! Re-solves small patches of a compatible triangulation with fewer Steiner points.
//!
//! A patch is the union of the triangles around a few adjacent Steiner points. Its boundary is a polygon in every pose;
//! where divide and conquer gets by with fewer points than the patch has, its solution takes the patch's place.

use super::division::{Division, Effort};
use crate::compatible::editable::EditableMesh;
use crate::math::{Point, predicate};

/// Steiner points of a patch, at most.
const LARGEST_CLUSTER: usize = 6;

/// Patches bounded by more vertices are left as they are.
const LARGEST_RING: usize = 36;

/// Passes over all Steiner points, at most.
const PASSES: usize = 12;

/// Solves patches anew, around each interior vertex numbered `boundary_count` and up; returns how many vertices that
/// saved.
pub(super) fn resolve(mesh: &mut EditableMesh, boundary_count: usize) -> usize {
    let mut saved = 0;
    for pass in 0..PASSES {
        let before = saved;
        let mut vertex = boundary_count;
        while vertex < mesh.vertex_count() {
            for size in 2..=LARGEST_CLUSTER {
                if mesh.degree(vertex) == 0 {
                    break;
                }
                let cluster = grow(mesh, vertex, size, boundary_count, pass);
                if cluster.len() < size {
                    break;
                }
                if let Some(gain) = resolve_patch(mesh, &cluster) {
                    saved += gain;
                }
            }
            vertex += 1;
        }
        if saved == before {
            break;
        }
    }
    saved
}

/// `vertex` and further interior vertices next to it, up to `size`.
fn grow(mesh: &EditableMesh, vertex: usize, size: usize, boundary_count: usize, pass: usize) -> Vec<usize> {
    let mut cluster = vec![vertex];
    while cluster.len() < size {
        let mut candidates: Vec<(usize, usize)> = Vec::new();
        for &member in &cluster {
            for triangle in mesh.triangles_at(member) {
                for v in triangle {
                    if v >= boundary_count && !cluster.contains(&v) {
                        match candidates.iter_mut().find(|c| c.1 == v) {
                            Some(candidate) => candidate.0 += 1,
                            None => candidates.push((1, v)),
                        }
                    }
                }
            }
        }
        // Most triangles shared with the cluster first; later passes take other choices.
        candidates.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let Some(&(_, chosen)) = candidates.get(pass % candidates.len().max(1)) else {
            break;
        };
        cluster.push(chosen);
    }
    cluster
}

/// Solves the patch around `cluster` with fewer vertices, if that succeeds; returns how many fewer.
fn resolve_patch(mesh: &mut EditableMesh, cluster: &[usize]) -> Option<usize> {
    let ring = patch_ring(mesh, cluster)?;
    if ring.len() > LARGEST_RING {
        return None;
    }
    let positions = mesh
        .positions
        .iter()
        .map(|positions| ring.iter().map(|&v| positions[v]).collect())
        .collect();
    let mut division = Division::within(positions, cluster.len() - 1, Effort::Quick);
    division.solve((0..ring.len()).collect()).ok()?;
    let positive = |&[a, b, c]: &[usize; 3]| {
        let corners = |positions: &Vec<Point>| predicate::is_positive(positions[a], positions[b], positions[c]);
        division.positions.iter().all(corners)
    };
    if !division.triangles.iter().all(positive) {
        return None;
    }
    let start = ring.len();
    let added = division.positions[0].len() - start;
    let mut numbers = ring;
    for k in start..start + added {
        numbers.push(mesh.add_vertex(division.positions.iter().map(|positions| positions[k])));
    }
    for &v in cluster {
        mesh.remove_star(v);
    }
    for triangle in division.triangles {
        mesh.add(triangle.map(|k| numbers[k]));
    }
    Some(cluster.len() - added)
}

/// The polygon around the triangles at the vertices of `cluster`; `None` if it is not one cycle through distinct
/// vertices.
fn patch_ring(mesh: &EditableMesh, cluster: &[usize]) -> Option<Vec<usize>> {
    let mut triangles: Vec<[usize; 3]> = cluster.iter().flat_map(|&v| mesh.triangles_at(v)).collect();
    triangles.sort_unstable();
    triangles.dedup();
    let mut edges: Vec<(usize, usize)> = triangles.iter().flat_map(|&t| crate::mesh::directed_edges(t)).collect();
    edges.sort_unstable();
    let boundary: Vec<(usize, usize)> = edges
        .iter()
        .copied()
        .filter(|&(a, b)| edges.binary_search(&(b, a)).is_err())
        .collect();
    let start = boundary.first()?.0;
    let mut ring = vec![start];
    loop {
        let at = ring[ring.len() - 1];
        let first = boundary.partition_point(|&(a, _)| a < at);
        let &(from, next) = boundary.get(first)?;
        if from != at || boundary.get(first + 1).is_some_and(|edge| edge.0 == at) {
            return None;
        }
        if next == start {
            break;
        }
        ring.push(next);
    }
    let inner = cluster.iter().any(|v| ring.contains(v));
    (!inner && ring.len() == boundary.len()).then_some(ring)
}
