//! What the rings and the paths divide the polygons into: regions, each a walk around it with islands in it.
//!
//! A half-edge is a ring's edge in its direction, or a path's edge in either direction; free space lies to its left.
//! After a half-edge comes the next one clockwise about its end, in the sense that leaves nothing between. The
//! closed walks that this gives are
//! - in the component of the outer ring, the walks around the regions;
//! - in any other component one walk around it from outside, an *island*, and walks around what paths from a hole to
//!   itself shut off.
//!
//! Paths may order themselves about a vertex, and have islands on their sides, in the same way in every pose only: that
//! is checked. A polygon without paths is one region, its holes and points are islands.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::TriangulateError;
use super::features::Numbered;
use crate::math::{Point, predicate};
use crate::outline::Ring;

/// A closed walk and the closed walks within it, as vertices.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Region {
    pub(super) walk: Vec<usize>,
    pub(super) islands: Vec<Vec<usize>>,
}

/// The regions of the polygons bounded by `rings`, outer ring first.
///
/// # Errors
/// [`TriangulateError::PathSides`] if poses disagree about what lies on which side of a path.
pub(super) fn regions(
    rings: &[Vec<usize>],
    features: &Numbered,
    positions: &[Vec<Point>],
) -> Result<Vec<Region>, TriangulateError> {
    let (mut walks, mut islands): (Vec<Vec<usize>>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
    let components = components(rings, features);
    let all_walks = closed_walks(rings, features, positions)?;
    for (component, vertices) in components.iter().enumerate() {
        let mut own: Vec<Vec<usize>> = all_walks
            .iter()
            .filter(|walk| vertices.binary_search(&walk[0]).is_ok())
            .cloned()
            .collect();
        // The component of the outer ring is the first. Of another one, the walk around it from outside turns backwards
        // around everything that the others enclose.
        if component > 0
            && let Some(outside) = (0..own.len())
                .min_by(|&a, &b| signed_area(&positions[0], &own[a]).total_cmp(&signed_area(&positions[0], &own[b])))
        {
            islands.push(own.remove(outside));
        }
        walks.extend(own);
    }
    islands.extend(features.points.iter().map(|&vertex| vec![vertex]));
    let mut regions: Vec<Region> = walks
        .into_iter()
        .map(|walk| Region {
            walk,
            islands: Vec::new(),
        })
        .collect();
    for island in islands {
        let holder = |pose: usize| holder(&regions, &island, &positions[pose]);
        let first = holder(0);
        if let Some(pose) = (1..positions.len()).find(|&pose| holder(pose) != first) {
            let path = features
                .paths
                .iter()
                .position(|path| regions[first].walk.contains(&path[0]));
            return Err(TriangulateError::PathSides {
                path: path.unwrap_or(0),
                pose,
            });
        }
        regions[first].islands.push(island);
    }
    Ok(regions)
}

/// The smallest region around an island; region 0 where none is found.
fn holder(regions: &[Region], island: &[usize], positions: &[Point]) -> usize {
    let place = positions[island[0]];
    (0..regions.len())
        .filter(|&region| {
            let walk = &regions[region].walk;
            regions.len() > 1
                && !walk.contains(&island[0])
                && Ring::new(walk.iter().map(|&v| positions[v])).is_ok_and(|ring| ring.contains(place))
        })
        .min_by(|&a, &b| {
            let area = |region: usize| signed_area(positions, &regions[region].walk);
            area(a).total_cmp(&area(b))
        })
        .unwrap_or(0)
}

fn signed_area(positions: &[Point], walk: &[usize]) -> f64 {
    let origin = positions[walk[0]];
    (0..walk.len())
        .map(|k| {
            let (a, b) = (positions[walk[k]], positions[walk[(k + 1) % walk.len()]]);
            0.5 * crate::math::point::cross(a - origin, b - origin)
        })
        .sum()
}

/// The vertices of rings and paths that hang together, each list in order; the outer ring's first.
fn components(rings: &[Vec<usize>], features: &Numbered) -> Vec<Vec<usize>> {
    let mut components: Vec<Vec<usize>> = rings.to_vec();
    for path in &features.paths {
        let mut joined = path.clone();
        let (touched, apart): (Vec<_>, Vec<_>) = components
            .into_iter()
            .partition(|component| component.iter().any(|v| path.contains(v)));
        let holds_outer = touched.iter().flatten().any(|&v| v == rings[0][0]);
        joined.extend(touched.into_iter().flatten());
        components = apart;
        components.insert(if holds_outer { 0 } else { components.len() }, joined);
    }
    for component in &mut components {
        component.sort_unstable();
        component.dedup();
    }
    components
}

/// All closed walks with free space to their left.
fn closed_walks(
    rings: &[Vec<usize>],
    features: &Numbered,
    positions: &[Vec<Point>],
) -> Result<Vec<Vec<usize>>, TriangulateError> {
    let mut neighbours: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut half_edges: Vec<(usize, usize)> = Vec::new();
    for ring in rings {
        for (k, &a) in ring.iter().enumerate() {
            let b = ring[(k + 1) % ring.len()];
            half_edges.push((a, b));
            // The successor stands first.
            neighbours.entry(a).or_default().insert(0, b);
            neighbours.entry(b).or_default().push(a);
        }
    }
    let mut path_of: BTreeMap<usize, usize> = BTreeMap::new();
    for (path, vertices) in features.paths.iter().enumerate() {
        for link in vertices.windows(2) {
            half_edges.extend([(link[0], link[1]), (link[1], link[0])]);
            neighbours.entry(link[0]).or_default().push(link[1]);
            neighbours.entry(link[1]).or_default().push(link[0]);
            path_of.extend([(link[0], path), (link[1], path)]);
        }
    }
    for (&vertex, around) in neighbours.iter_mut().filter(|(_, around)| around.len() > 2) {
        let sorted = |pose: usize| turning_from_first(&positions[pose], vertex, around);
        let first = sorted(0);
        if let Some(pose) = (1..positions.len()).find(|&pose| sorted(pose) != first) {
            return Err(TriangulateError::PathSides {
                path: path_of.get(&vertex).copied().unwrap_or(0),
                pose,
            });
        }
        *around = first;
    }
    // After u -> v: from v, the neighbour before u in the positive sense.
    let after = |(u, v): (usize, usize)| {
        let around = neighbours.get(&v).map(Vec::as_slice).unwrap_or_default();
        let at = around.iter().position(|&w| w == u).unwrap_or(0);
        (v, around[(at + around.len() - 1) % around.len()])
    };
    let mut walks = Vec::new();
    let mut walked = std::collections::BTreeSet::new();
    for &start in &half_edges {
        let mut walk = Vec::new();
        let mut at = start;
        while walked.insert(at) {
            walk.push(at.0);
            at = after(at);
        }
        if !walk.is_empty() {
            walks.push(walk);
        }
    }
    Ok(walks)
}

/// The neighbours of a vertex in the positive sense, from the first of them on. Exact.
fn turning_from_first(positions: &[Point], vertex: usize, around: &[usize]) -> Vec<usize> {
    let here = positions[vertex];
    // In which half of the plane about `here` a neighbour lies: a subtraction keeps the sign.
    let is_lower = |v: usize| {
        let d = positions[v] - here;
        !(d.y > 0.0 || (d.y == 0.0 && d.x > 0.0))
    };
    let mut sorted = around.to_vec();
    sorted.sort_by(|&a, &b| {
        is_lower(a)
            .cmp(&is_lower(b))
            .then_with(|| match predicate::orientation(here, positions[a], positions[b]) {
                Ordering::Greater => Ordering::Less,
                Ordering::Less => Ordering::Greater,
                Ordering::Equal => Ordering::Equal,
            })
    });
    let first = sorted.iter().position(|&v| v == around[0]).unwrap_or(0);
    sorted.rotate_left(first);
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square_and(inner: &[[f64; 2]]) -> Vec<Point> {
        let outer = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
        outer.iter().chain(inner).copied().map(Point::from).collect()
    }

    #[test]
    fn a_free_path_is_an_island_and_an_attached_one_is_walked_along() {
        let positions = [square_and(&[[3.0, 3.0], [4.0, 3.0], [5.0, 4.0]])];
        let features = |path: &[usize]| Numbered {
            points: vec![],
            paths: vec![path.to_vec()],
            count: 7,
        };
        let rings = [vec![0, 1, 2, 3]];
        let free = regions(&rings, &features(&[4, 5, 6]), &positions).expect("regions");
        assert_eq!(free.len(), 1);
        assert_eq!(free[0].islands, vec![vec![4, 5, 6, 5]]);
        let attached = regions(&rings, &features(&[1, 4, 5, 6]), &positions).expect("regions");
        assert_eq!(attached[0].walk, vec![0, 1, 4, 5, 6, 5, 4, 1, 2, 3]);
        assert!(attached[0].islands.is_empty());
    }

    #[test]
    fn a_path_from_side_to_side_divides_and_holds_what_lies_beside_it() {
        let positions = [
            square_and(&[[4.0, 4.0], [6.0, 3.0]]),
            square_and(&[[4.0, 5.0], [6.0, 3.0]]),
            square_and(&[[5.0, 3.0], [3.0, 4.0]]),
        ];
        let features = Numbered {
            points: vec![5],
            paths: vec![vec![0, 4, 2]],
            count: 6,
        };
        let rings = [vec![0, 1, 2, 3]];
        let found = regions(&rings, &features, &positions[..2]).expect("regions");
        assert_eq!(found.len(), 2);
        let holder = found
            .iter()
            .find(|region| !region.islands.is_empty())
            .expect("one holds it");
        assert!(holder.walk.contains(&1) && holder.islands == vec![vec![5]]);
        let other_side = regions(&rings, &features, &positions);
        assert_eq!(other_side, Err(TriangulateError::PathSides { path: 0, pose: 2 }));
    }
}
