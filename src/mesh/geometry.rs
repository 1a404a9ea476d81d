//! Measures of triangles at given positions.

use crate::math::{Matrix, Point, point};

/// The three corners of a triangle.
#[must_use]
pub fn corners(positions: &[Point], [a, b, c]: [usize; 3]) -> [Point; 3] {
    [positions[a], positions[b], positions[c]]
}

/// The signed area of the triangle `a b c`.
#[must_use]
pub fn signed_area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * point::cross(b - a, c - a)
}

/// The matrix whose columns are the edges `a b` and `a c`.
#[must_use]
pub(crate) fn edge_matrix([a, b, c]: [Point; 3]) -> Matrix {
    Matrix::from_columns(&[b - a, c - a])
}

/// The gradients of the three barycentric coordinates: row `k` of a linear function's gradient operator, so that the
/// gradient of the function with corner values `f` is the sum of `f[k] * gradients[k]`. `None` for zero area.
#[must_use]
pub(crate) fn barycentric_gradients(triangle: [Point; 3]) -> Option<[Point; 3]> {
    let double_area = 2.0 * signed_area(triangle);
    if double_area == 0.0 {
        return None;
    }
    let [a, b, c] = triangle;
    Some(
        [
            point::perpendicular(c - b),
            point::perpendicular(a - c),
            point::perpendicular(b - a),
        ]
        .map(|g| g / double_area),
    )
}

/// The interior angle at each corner, in radians, in `[0, pi]`.
#[must_use]
pub fn angles_rad([a, b, c]: [Point; 3]) -> [f64; 3] {
    [angle_rad(a, b, c), angle_rad(b, c, a), angle_rad(c, a, b)]
}

/// The angle at `p` of the triangle `p q r`.
fn angle_rad(p: Point, q: Point, r: Point) -> f64 {
    let (u, v) = (q - p, r - p);
    point::cross(u, v).abs().atan2(u.dot(&v))
}

/// The smallest interior angle, in radians: the one opposite to the shortest edge.
#[must_use]
pub(crate) fn smallest_angle_rad([a, b, c]: [Point; 3]) -> f64 {
    let (ab, bc, ca) = ((b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared());
    if bc <= ca && bc <= ab {
        angle_rad(a, b, c)
    } else if ca <= ab {
        angle_rad(b, c, a)
    } else {
        angle_rad(c, a, b)
    }
}

/// A triangle's smallest interior angle over several embeddings, in radians.
pub(crate) fn worst_angle_rad<'a>(embeddings: impl IntoIterator<Item = &'a [Point]>, triangle: [usize; 3]) -> f64 {
    let angles = embeddings
        .into_iter()
        .map(|positions| smallest_angle_rad(corners(positions, triangle)));
    angles.fold(f64::INFINITY, f64::min)
}

/// Every triangle's smallest angle over all embeddings, in degrees, in increasing order.
#[must_use]
pub(crate) fn worst_angles_deg(embeddings: &[Vec<Point>], triangles: &[[usize; 3]]) -> Vec<f64> {
    let worst = |&triangle| worst_angle_rad(embeddings.iter().map(Vec::as_slice), triangle).to_degrees();
    let mut angles: Vec<f64> = triangles.iter().map(worst).collect();
    angles.sort_by(f64::total_cmp);
    angles
}

/// How much more a triangle is stretched in one direction than across it when `from` becomes `to`: the ratio of the
/// singular values of the linear map between them, at least 1; exactly 1 up to rounding for a similarity, infinite where
/// `from` or `to` has no area.
#[must_use]
pub fn stretch(from: [Point; 3], to: [Point; 3]) -> f64 {
    let Some(inverse) = edge_matrix(from).try_inverse() else {
        return f64::INFINITY;
    };
    let map = edge_matrix(to) * inverse;
    // The singular values of a 2 x 2 matrix are the sum and the difference of the lengths of its similar and its
    // reflected part.
    let similar = (map.m11 + map.m22).hypot(map.m21 - map.m12);
    let reflected = (map.m11 - map.m22).hypot(map.m21 + map.m12);
    let least = (similar - reflected).abs();
    if least > 0.0 {
        (similar + reflected) / least
    } else {
        f64::INFINITY
    }
}

/// The barycentric coordinates of `p`; `None` for a triangle of zero area.
#[must_use]
pub fn barycentric([a, b, c]: [Point; 3], p: Point) -> Option<[f64; 3]> {
    let double_area = point::cross(b - a, c - a);
    if double_area == 0.0 {
        return None;
    }
    let at_b = point::cross(p - a, c - a) / double_area;
    let at_c = point::cross(b - a, p - a) / double_area;
    Some([1.0 - at_b - at_c, at_b, at_c])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_is_the_ratio_of_singular_values() {
        let triangle = [[0.0, 0.0], [3.0, 0.0], [1.0, 4.0]].map(Point::from);
        for map in [
            Matrix::new(1.0, 0.3, -0.2, 0.7),
            Matrix::new(0.1, -2.0, 1.5, 0.4),
            Matrix::new(5.0, 0.0, 0.0, 0.5),
        ] {
            let singular = map.svd(false, false).singular_values;
            let moved = triangle.map(|p| map * p + Point::new(3.0, -1.0));
            let ratio = stretch(triangle, moved);
            assert!((ratio - singular[0] / singular[1]).abs() < 1e-12 * ratio);
            assert!((ratio - stretch(moved, triangle)).abs() < 1e-12 * ratio);
        }
        let flat = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]].map(Point::from);
        assert_eq!(stretch(flat, triangle), f64::INFINITY);
        assert_eq!(stretch(triangle, flat), f64::INFINITY);
    }

    #[test]
    fn the_smallest_angle_is_the_least_of_all_three() {
        let base = [[0.0, 0.0], [3.0, 0.2], [0.7, 1.9]].map(Point::from);
        for turn in 0..3 {
            let mut triangle = base;
            triangle.rotate_left(turn);
            let least = angles_rad(triangle).into_iter().fold(f64::INFINITY, f64::min);
            assert_eq!(smallest_angle_rad(triangle), least);
        }
        let equilateral = [[0.0, 0.0], [2.0, 0.0], [1.0, 3.0_f64.sqrt()]].map(Point::from);
        assert!((smallest_angle_rad(equilateral) - std::f64::consts::FRAC_PI_3).abs() < 1e-15);
    }

    #[test]
    fn measures_of_a_right_triangle() {
        let triangle = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]].map(Point::from);
        assert_eq!(signed_area(triangle), 6.0);
        assert!((angles_rad(triangle).iter().sum::<f64>() - std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(barycentric(triangle, Point::new(0.0, 4.0)), Some([0.0, 0.0, 1.0]));
        // The function x has gradient (1, 0).
        let gradients = barycentric_gradients(triangle).expect("it has area");
        let gradient: Point = triangle.iter().zip(gradients).map(|(p, g)| g * p.x).sum();
        assert!((gradient - Point::new(1.0, 0.0)).norm() < 1e-15);
    }
}
