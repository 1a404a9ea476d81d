//! Triangles divided evenly.

use std::collections::BTreeMap;

use super::MeshPoint;

/// Every triangle divided into `parts` x `parts` of its own shape (Loop's regular pattern, without moving anything): the small triangles, wound like
/// theirs, and the place of every vertex on the given mesh. The first vertices are the given ones, `vertices` in number; small triangles of
/// neighbours share the vertices on their common edge. `parts` of 0 counts as 1.
#[must_use]
pub fn subdivided(triangles: &[[usize; 3]], vertices: usize, parts: usize) -> (Vec<[usize; 3]>, Vec<MeshPoint>) {
    let parts = parts.max(1);
    let mut places: Vec<MeshPoint> = (0..vertices)
        .map(|v| MeshPoint {
            vertices: [v; 3],
            shares: [1.0, 0.0, 0.0],
        })
        .collect();
    for triangle in triangles {
        for (corner, &v) in triangle.iter().enumerate() {
            let mut shares = [0.0; 3];
            shares[corner] = 1.0;
            places[v] = MeshPoint {
                vertices: *triangle,
                shares,
            };
        }
    }
    // By edge, the smaller vertex first, and by how many parts away from that.
    let mut on_edges: BTreeMap<([usize; 2], usize), usize> = BTreeMap::new();
    let mut small = Vec::with_capacity(triangles.len() * parts * parts);
    for triangle in triangles {
        let mut number = |steps: [usize; 3]| -> usize {
            let place = || MeshPoint {
                vertices: *triangle,
                shares: steps.map(|k| k as f64 / parts as f64),
            };
            if let Some(corner) = steps.iter().position(|k| *k == parts) {
                return triangle[corner];
            }
            let mut new = || {
                places.push(place());
                places.len() - 1
            };
            match steps.iter().position(|k| *k == 0) {
                Some(opposite) => {
                    let ends = [(opposite + 1) % 3, (opposite + 2) % 3];
                    let [first, last] = if triangle[ends[0]] < triangle[ends[1]] {
                        ends
                    } else {
                        [ends[1], ends[0]]
                    };
                    let key = ([triangle[first], triangle[last]], steps[last]);
                    *on_edges.entry(key).or_insert_with(new)
                }
                None => new(),
            }
        };
        let mut rows: Vec<Vec<usize>> = Vec::with_capacity(parts + 1);
        for down in 0..=parts {
            rows.push(
                (0..=parts - down)
                    .map(|across| number([parts - down - across, across, down]))
                    .collect(),
            );
        }
        for pair in rows.windows(2) {
            let [upper, lower] = [&pair[0], &pair[1]];
            for k in 0..lower.len() {
                small.push([upper[k], upper[k + 1], lower[k]]);
                if k + 1 < lower.len() {
                    small.push([upper[k + 1], lower[k + 1], lower[k]]);
                }
            }
        }
    }
    (small, places)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;
    use crate::mesh::geometry;

    #[test]
    fn small_triangles_fill_the_large_ones_and_share_what_is_between() {
        let positions = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [9.0, 9.0]].map(Point::from);
        let triangles = [[0, 1, 2], [0, 2, 3]];
        for parts in [0, 1, 2, 3, 4] {
            let (small, places) = subdivided(&triangles, positions.len(), parts);
            let side = parts.max(1);
            assert_eq!(small.len(), 2 * side * side);
            // A square grid of them, and the vertex that no triangle has.
            assert_eq!(places.len(), (side + 1) * (side + 1) + 1);
            let at: Vec<Point> = places.iter().map(|place| place.at(&positions)).collect();
            assert_eq!(at[..5], positions);
            let areas: Vec<f64> = small
                .iter()
                .map(|t| geometry::signed_area(geometry::corners(&at, *t)))
                .collect();
            let each = 8.0 / (side * side) as f64;
            assert!(areas.iter().all(|area| (area - each).abs() < 1e-12), "{areas:?}");
        }
    }
}
