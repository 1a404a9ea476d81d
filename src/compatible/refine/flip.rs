//! Compatible edge flips (NWM 3.1, Surazsky and Gotsman 2004): an edge is flipped in all poses at once if that is valid
//! in every pose and raises the worst angle of its two triangles over all poses.

use std::collections::BTreeSet;

use super::super::editable::EditableMesh;
use crate::mesh::geometry;

/// A flip has to gain this much, in radians: equal configurations must not alternate.
const SMALLEST_GAIN_RAD: f64 = 1e-9;

/// Passes over all edges, at most. Each flip raises a worst angle, so the passes end by themselves; three or four do.
const PASSES: usize = 12;

/// Flips until no flip helps; returns how many were made. The edges of `paths` stay.
pub(super) fn flip(mesh: &mut EditableMesh, paths: &[Vec<usize>]) -> usize {
    let kept: BTreeSet<(usize, usize)> = paths
        .iter()
        .flat_map(|path| path.windows(2))
        .map(|link| (link[0].min(link[1]), link[0].max(link[1])))
        .collect();
    let mut total = 0;
    for _ in 0..PASSES {
        let mut edges: Vec<(usize, usize)> = mesh
            .triangles()
            .flat_map(|(_, triangle)| crate::mesh::directed_edges(triangle))
            .filter(|(a, b)| a < b && !kept.contains(&(*a, *b)))
            .collect();
        edges.sort_unstable();
        let flipped = edges.into_iter().filter(|&(a, b)| flip_edge(mesh, a, b)).count();
        total += flipped;
        if flipped == 0 {
            break;
        }
    }
    total
}

/// Flips the edge `a b` if it exists, is interior, and gains.
fn flip_edge(mesh: &mut EditableMesh, a: usize, b: usize) -> bool {
    let (Some(c), Some(d)) = (mesh.opposite(a, b), mesh.opposite(b, a)) else {
        return false;
    };
    let new = [[c, d, b], [d, c, a]];
    let now = worst_angle(mesh, [[a, b, c], [b, a, d]], f64::NEG_INFINITY);
    if worst_angle(mesh, new, now + SMALLEST_GAIN_RAD) <= now + SMALLEST_GAIN_RAD {
        return false;
    }
    if !new.iter().all(|&triangle| mesh.is_positive(triangle)) {
        return false;
    }
    mesh.remove_at_edge(a, b);
    mesh.remove_at_edge(b, a);
    for triangle in new {
        mesh.add(triangle);
    }
    true
}

/// The smallest angle of two triangles over all poses, negative if one is inverted; stops below `enough`.
fn worst_angle(mesh: &EditableMesh, triangles: [[usize; 3]; 2], enough: f64) -> f64 {
    let mut worst = f64::INFINITY;
    for pose in 0..mesh.pose_count() {
        for triangle in triangles {
            let corners = mesh.corners(pose, triangle);
            let angle = geometry::smallest_angle_rad(corners);
            worst = worst.min(if geometry::signed_area(corners) > 0.0 {
                angle
            } else {
                -1.0
            });
        }
        if worst < enough {
            return worst;
        }
    }
    worst
}
