//! Normals of vertices from the triangles around them.
//!
//! A vertex's normal is the sum of its triangles' normals, each counted by the angle that it has at the vertex (Thuermer and
//! Wuethrich 1998), which does not depend on how a face was divided into triangles; or by its area (Gouraud 1971), which needs no
//! angles and is what a frame of an animation can afford. Vertices without a triangle that has an area get the zero vector.

use super::loop_subdivision::normalise_planes;
use crate::math::{Point3, vectorised};

/// By what a triangle's normal counts at a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NormalWeighting {
    /// Its angle there.
    #[default]
    Angle,
    /// Its area.
    Area,
}

/// Unit normals of all vertices (#positions), on the side from which the triangles are positive. Triangles with a vertex that
/// does not exist are left out.
#[must_use]
pub fn vertex_normals(positions: &[Point3], triangles: &[[usize; 3]], weighting: NormalWeighting) -> Vec<Point3> {
    let mut normals = vec![Point3::zeros(); positions.len()];
    vertex_normals_into(positions, triangles, weighting, &mut normals);
    normals
}

/// As [`vertex_normals`], into a buffer (#positions); nothing is allocated. A buffer that is shorter gets what it has room for.
pub fn vertex_normals_into(
    positions: &[Point3],
    triangles: &[[usize; 3]],
    weighting: NormalWeighting,
    normals: &mut [Point3],
) {
    normals.fill(Point3::zeros());
    let count = positions.len().min(normals.len());
    for &[a, b, c] in triangles.iter().filter(|corners| corners.iter().all(|&v| v < count)) {
        let normal = (positions[b] - positions[a]).cross(&(positions[c] - positions[a]));
        match weighting {
            NormalWeighting::Area => {
                for vertex in [a, b, c] {
                    normals[vertex] += normal;
                }
            }
            NormalWeighting::Angle => {
                let Some(unit) = normal.try_normalize(0.0) else {
                    continue;
                };
                for [vertex, left, right] in [[a, b, c], [b, c, a], [c, a, b]] {
                    let (u, v) = (
                        positions[left] - positions[vertex],
                        positions[right] - positions[vertex],
                    );
                    normals[vertex] += unit * libm::atan2(u.cross(&v).norm(), u.dot(&v));
                }
            }
        }
    }
    for normal in normals {
        *normal = normal.try_normalize(0.0).unwrap_or_else(Point3::zeros);
    }
}

/// Normals by area in single precision, from and into planes of the x, the y and the z of all vertices; nothing is allocated.
/// Planes that are shorter than others count as the shortest.
pub fn vertex_normals_planes(positions: [&[f32]; 3], triangles: &[[usize; 3]], normals: [&mut [f32]; 3]) {
    let count = positions.iter().map(|plane| plane.len()).min().unwrap_or(0);
    let count = normals.iter().map(|plane| plane.len()).min().unwrap_or(0).min(count);
    let [xs, ys, zs] = positions.map(|plane| &plane[..count]);
    let [nx, ny, nz] = normals.map(|plane| &mut plane[..count]);
    for plane in [&mut *nx, &mut *ny, &mut *nz] {
        plane.fill(0.0);
    }
    for &[a, b, c] in triangles.iter().filter(|corners| corners.iter().all(|&v| v < count)) {
        let (ux, uy, uz) = (xs[b] - xs[a], ys[b] - ys[a], zs[b] - zs[a]);
        let (vx, vy, vz) = (xs[c] - xs[a], ys[c] - ys[a], zs[c] - zs[a]);
        let normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        for vertex in [a, b, c] {
            nx[vertex] += normal[0];
            ny[vertex] += normal[1];
            nz[vertex] += normal[2];
        }
    }
    vectorised(
        #[inline(always)]
        || normalise_planes(nx, ny, nz),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A corner of a cube whose face in the plane of x and y is divided at the corner.
    const CORNER: [[f64; 3]; 5] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
    ];
    const TRIANGLES: [[usize; 3]; 4] = [[0, 2, 4], [0, 4, 1], [0, 1, 3], [0, 3, 2]];

    #[test]
    fn the_angle_does_not_see_how_a_face_is_divided() {
        let positions = CORNER.map(Point3::from);
        let even = Point3::repeat(-1.0).normalize();
        let by_angle = vertex_normals(&positions, &TRIANGLES, NormalWeighting::Angle);
        assert!((by_angle[0] - even).norm() < 1e-15);
        // By area the divided face counts twice.
        let by_area = vertex_normals(&positions, &TRIANGLES, NormalWeighting::Area);
        assert!((by_area[0] - Point3::new(-1.0, -1.0, -2.0).normalize()).norm() < 1e-15);
        assert!((by_area[4] + Point3::z()).norm() < 1e-15);
    }

    #[test]
    fn planes_are_the_same_and_nothing_is_allocated() {
        let positions = CORNER.map(Point3::from);
        let planes: [Vec<f32>; 3] = [0, 1, 2].map(|axis| positions.iter().map(|at| at[axis] as f32).collect());
        let mut found = planes.clone();
        let mut exact = positions;
        let measured = allocation_counter::measure(|| {
            vertex_normals_into(&positions, &TRIANGLES, NormalWeighting::Area, &mut exact);
            let [x, y, z] = &mut found;
            vertex_normals_planes([&planes[0], &planes[1], &planes[2]], &TRIANGLES, [x, y, z]);
        });
        assert_eq!(measured.count_total, 0);
        for (vertex, exact) in exact.iter().enumerate() {
            for axis in 0..3 {
                assert!((f64::from(found[axis][vertex]) - exact[axis]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn what_has_no_area_has_no_normal() {
        let line = [Point3::zeros(), Point3::x(), Point3::x() * 2.0];
        for weighting in [NormalWeighting::Angle, NormalWeighting::Area] {
            assert_eq!(
                vertex_normals(&line, &[[0, 1, 2], [0, 1, 9]], weighting),
                [Point3::zeros(); 3]
            );
        }
    }
}
