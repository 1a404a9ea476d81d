//! Compatible splits: long edges get a vertex at their middle in every pose.

use std::collections::{BTreeMap, BTreeSet};

use super::super::editable::{Curves, EditableMesh};
use super::Guide;
use crate::math::{Point, point};
use crate::mesh::{directed_edges, undirected};

/// Power of the mean over the poses: nearly the longest counts, since a limb that is short in most poses and long in one has
/// to bend there, too.
const LENGTH_POWER: i32 = 16;

/// The least and largest share of an edge that a new vertex of the boundary may divide.
const SHARES: (f64, f64) = (0.2, 0.8);

/// Splits edges whose length over the pose's diagonal, in the power mean over the poses, exceeds `length`, longest first.
/// The new vertices of edges of rings and paths become part of these.
pub(super) fn split_long_edges(
    mesh: &mut EditableMesh,
    curves: &mut Curves,
    diagonals: &[f64],
    length: f64,
    guide: Option<&dyn Guide>,
) {
    let mut on_boundary: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let rings = &mut curves.rings;
    for (ring, vertices) in rings.iter().enumerate() {
        for (k, &v) in vertices.iter().enumerate() {
            on_boundary.insert((v, vertices[(k + 1) % vertices.len()]), ring);
        }
    }
    let mut on_path: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (path, vertices) in curves.paths.iter().enumerate() {
        on_path.extend(vertices.windows(2).map(|link| (undirected(link[0], link[1]), path)));
    }
    // A split never makes an edge longer than the one it cuts, except from the new vertex to an opposite corner: work
    // through lists, longest first, until no long edge is left.
    loop {
        let mut long: Vec<(f64, usize, usize)> = mesh
            .triangles()
            .flat_map(|(_, triangle)| directed_edges(triangle))
            .filter(|&(a, b)| a < b || on_boundary.contains_key(&(a, b)))
            .map(|(a, b)| (power_mean_length(mesh, diagonals, a, b), a, b))
            .filter(|edge| edge.0 > length)
            .collect();
        if long.is_empty() {
            break;
        }
        long.sort_by(|x, y| y.0.total_cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        let mut any = false;
        // The longest third: the rest may be cut off by these.
        let count = long.len().div_ceil(3);
        for &(_, a, b) in &long[..count] {
            let guide = guide.filter(|_| on_boundary.contains_key(&(a, b)) || on_boundary.contains_key(&(b, a)));
            if let Some(middle) = split_edge(mesh, a, b, guide) {
                any = true;
                if let Some(path) = on_path.remove(&undirected(a, b)) {
                    on_path.insert(undirected(a, middle), path);
                    on_path.insert(undirected(middle, b), path);
                    let vertices = &mut curves.paths[path];
                    let link = vertices
                        .windows(2)
                        .position(|link| undirected(link[0], link[1]) == undirected(a, b));
                    if let Some(link) = link {
                        vertices.insert(link + 1, middle);
                    }
                }
                if let Some(ring) = on_boundary.remove(&(a, b)) {
                    on_boundary.insert((a, middle), ring);
                    on_boundary.insert((middle, b), ring);
                    if let Some(place) = rings[ring].iter().position(|&v| v == a) {
                        rings[ring].insert(place + 1, middle);
                    }
                }
            }
        }
        if !any {
            break;
        }
    }
}

/// Splits edges inside that are given with their ends, most urgent first; those of paths stay whole, and of the edges of a triangle one is split.
pub(super) fn split_inner_edges(mesh: &mut EditableMesh, curves: &Curves, edges: &[(f64, usize, usize)]) {
    let links = curves.paths.iter().flat_map(|path| path.windows(2));
    let on_path: BTreeSet<(usize, usize)> = links.map(|link| undirected(link[0], link[1])).collect();
    let mut changed: BTreeSet<usize> = BTreeSet::new();
    for &(_, a, b) in edges {
        let apexes = [mesh.opposite(a, b), mesh.opposite(b, a)];
        let around = [Some(a), Some(b), apexes[0], apexes[1]];
        let is_free = around.iter().flatten().filter(|v| changed.contains(v)).count() < 2;
        if is_free && !on_path.contains(&undirected(a, b)) && split_edge(mesh, a, b, None).is_some() {
            changed.extend(around.into_iter().flatten());
        }
    }
}

fn power_mean_length(mesh: &EditableMesh, diagonals: &[f64], a: usize, b: usize) -> f64 {
    let powers = mesh
        .positions
        .iter()
        .zip(diagonals)
        .map(|(p, diagonal)| ((p[b] - p[a]).norm() / diagonal).powi(LENGTH_POWER));
    (powers.sum::<f64>() / diagonals.len() as f64).powf(1.0 / f64::from(LENGTH_POWER))
}

/// Splits the edge `a b` if all new triangles are positive in every pose; gives the new vertex. It is at the middle, with a guide at the middle
/// in the pose that the guide knows and at the corresponding places in the others.
fn split_edge(mesh: &mut EditableMesh, a: usize, b: usize, guide: Option<&dyn Guide>) -> Option<usize> {
    let sides: Vec<(usize, usize, usize)> = [(a, b), (b, a)]
        .into_iter()
        .filter_map(|(from, to)| mesh.opposite(from, to).map(|apex| (from, to, apex)))
        .collect();
    if sides.is_empty() {
        return None;
    }
    let share = |pose: usize| {
        let known = guide.filter(|guide| guide.reference() != pose).and_then(|guide| {
            let reference = &mesh.positions[guide.reference()];
            guide.carried(pose, (reference[a] + reference[b]) * 0.5)
        });
        known.map_or(0.5, |place| {
            let p = &mesh.positions[pose];
            point::nearest_on_segment(place, p[a], p[b]).0.clamp(SHARES.0, SHARES.1)
        })
    };
    let places: Vec<Point> = (mesh.positions.iter().enumerate())
        .map(|(pose, p)| p[a] + (p[b] - p[a]) * share(pose))
        .collect();
    let positive = mesh.positions.iter().zip(&places).all(|(p, &middle)| {
        sides.iter().all(|&(from, to, apex)| {
            crate::math::predicate::is_positive(p[from], middle, p[apex])
                && crate::math::predicate::is_positive(middle, p[to], p[apex])
        })
    });
    if !positive {
        return None;
    }
    let middle = mesh.add_vertex(places);
    for (from, to, apex) in sides {
        mesh.remove_at_edge(from, to);
        mesh.add([from, middle, apex]);
        mesh.add([middle, to, apex]);
    }
    Some(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_that_is_long_in_one_pose_only_is_split() {
        let square = |width: f64| {
            [[0.0, 0.0], [width, 0.0], [width, 0.04], [0.0, 0.04]]
                .map(Point::from)
                .to_vec()
        };
        let mut positions = vec![square(0.04); 7];
        positions.push(square(0.2));
        let mut mesh = EditableMesh::new(positions, &[[0, 1, 2], [0, 2, 3]]);
        let mut curves = Curves {
            rings: vec![vec![0, 1, 2, 3]],
            landmarks: Vec::new(),
            paths: Vec::new(),
        };
        split_long_edges(&mut mesh, &mut curves, &[1.0; 8], 0.08, None);
        let longest = |pose: usize| {
            let edges = mesh.triangles().flat_map(|(_, t)| directed_edges(t));
            let places = &mesh.positions[pose];
            edges.map(|(a, b)| (places[b] - places[a]).norm()).fold(0.0, f64::max)
        };
        // The mean over the poses of every edge is within the length from the start.
        assert!(longest(7) < 0.1, "{}", longest(7));
        assert!(curves.rings[0].len() > 4);
    }
}
