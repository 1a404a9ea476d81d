//! Compatible edge flips (NWM 3.1, Surazsky and Gotsman 2004): an edge is flipped in all poses at once if that is valid
//! in every pose and raises the worst angle of its two triangles over all poses.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::super::editable::EditableMesh;
use crate::mesh::{directed_edges, geometry, undirected};

/// A flip has to gain this much, in radians: equal configurations must not alternate.
const SMALLEST_GAIN_RAD: f64 = 1e-9;

/// Passes over all edges, at most. Each flip raises a worst angle, so the passes end by themselves; three or four do.
const PASSES: usize = 12;

/// An edge as [`undirected`] has it.
type Edge = (usize, usize);

/// Flips until no flip helps; returns how many were made. The edges of `paths` stay.
pub(super) fn flip(mesh: &mut EditableMesh, paths: &[Vec<usize>]) -> usize {
    let kept: BTreeSet<Edge> = paths
        .iter()
        .flat_map(|path| path.windows(2))
        .map(|link| undirected(link[0], link[1]))
        .collect();
    let edges: Vec<Edge> = mesh
        .triangles()
        .flat_map(|(_, triangle)| directed_edges(triangle))
        .filter(|ends| ends.0 < ends.1 && !kept.contains(ends))
        .collect();
    let gains = |&(a, b): &Edge| gaining_flip(mesh, a, b).is_some();
    let mut now: BTreeSet<Edge> = edges.into_par_iter().filter(gains).collect();
    let mut total = 0;
    for _ in 0..PASSES {
        let mut next = BTreeSet::new();
        while let Some((a, b)) = now.pop_first() {
            let Some([c, d]) = gaining_flip(mesh, a, b) else {
                continue;
            };
            flip_edge(mesh, (a, b), (c, d));
            total += 1;
            next.insert(undirected(c, d));
            // Where nothing changes, nothing more is to be gained. A pass goes up once, and leaves out what it made.
            let around = [undirected(a, c), undirected(c, b), undirected(b, d), undirected(d, a)];
            for other in around.into_iter().filter(|other| !kept.contains(other)) {
                let is_ahead = other > (a, b) && !next.contains(&other);
                if is_ahead { &mut now } else { &mut next }.insert(other);
            }
        }
        if next.is_empty() {
            break;
        }
        now = next;
    }
    total
}

/// The ends that the edge `a b` would have if it were flipped, if it exists, is interior, and gains by it.
fn gaining_flip(mesh: &EditableMesh, a: usize, b: usize) -> Option<[usize; 2]> {
    let (c, d) = (mesh.opposite(a, b)?, mesh.opposite(b, a)?);
    let new = flipped((a, b), (c, d));
    if !new.iter().all(|&triangle| mesh.is_positive(triangle)) {
        return None;
    }
    let now = worst_angle(mesh, [[a, b, c], [b, a, d]], f64::NEG_INFINITY);
    let enough = now + SMALLEST_GAIN_RAD;
    (worst_angle(mesh, new, enough) > enough).then_some([c, d])
}

/// The triangles beside the edge `c d` that replaces `a b`.
fn flipped((a, b): (usize, usize), (c, d): (usize, usize)) -> [[usize; 3]; 2] {
    [[c, d, b], [d, c, a]]
}

fn flip_edge(mesh: &mut EditableMesh, (a, b): (usize, usize), (c, d): (usize, usize)) {
    mesh.remove_at_edge(a, b);
    mesh.remove_at_edge(b, a);
    for triangle in flipped((a, b), (c, d)) {
        mesh.add(triangle);
    }
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
