//! Faces with many corners, divided into triangles.
//!
//! Corners in order -> triangles, by ear clipping in the face's mean plane (its normal by Newell's method): always the ear
//! with the shortest diagonal is cut off, the first of equals. A convex face is divided like any other; a quadrangle
//! by its shorter diagonal, or by the one inside. Whether a corner is an ear is decided by exact predicates on the projected
//! corners.
//!
//! Difference from the textbook: a face that crosses itself in that plane, or is folded to nothing, has no ears at some point;
//! then the corner with the shortest diagonal goes. The triangles still use every corner, and their number is right.
//!
//! Cost: quadratic in the corners.

use std::cmp::Ordering;

use crate::math::predicate::orientation;
use crate::math::{Point, Point3};

/// The triangles of a face with `count` corners at `at(corner)`, as triples of corners; `triangles` is overwritten.
pub(super) fn triangulate(count: usize, at: impl Fn(usize) -> Point3, triangles: &mut Vec<[usize; 3]>) {
    triangles.clear();
    if count == 3 {
        triangles.push([0, 1, 2]);
        return;
    }
    let places = projected(count, &at);
    let mut left: Vec<usize> = (0..count).collect();
    let is_ear = |left: &[usize], k: usize| {
        let [a, b, c] = around(left, k).map(|corner| places[corner]);
        let encloses = |p: Point| {
            // A corner at the place of another end of the diagonal is in nobody's way.
            p != a
                && p != c
                && [(a, b), (b, c), (c, a)]
                    .iter()
                    .all(|&(from, to)| orientation(from, to, p) != Ordering::Less)
        };
        orientation(a, b, c) == Ordering::Greater
            && !left
                .iter()
                .any(|corner| !around(left, k).contains(corner) && encloses(places[*corner]))
    };
    let mut ears: Vec<bool> = (0..count).map(|k| is_ear(&left, k)).collect();
    while left.len() > 3 {
        let diagonal = |k: usize| {
            let [a, _, c] = around(&left, k);
            (at(a) - at(c)).norm_squared()
        };
        let shortest = |best: Option<(usize, f64)>, k: usize| {
            let length = diagonal(k);
            match best {
                Some((_, least)) if least <= length || length.is_nan() => best,
                _ => Some((k, length)),
            }
        };
        let of_ears = (0..left.len()).filter(|&k| ears[k]).fold(None, shortest);
        let (cut, _) = of_ears
            .or_else(|| (0..left.len()).fold(None, shortest))
            .unwrap_or((0, 0.0));
        triangles.push(around(&left, cut));
        left.remove(cut);
        ears.remove(cut);
        let before = (cut + left.len() - 1) % left.len();
        for k in [before, cut % left.len()] {
            ears[k] = is_ear(&left, k);
        }
    }
    triangles.push([left[0], left[1], left[2]]);
}

/// Entry `k` of a cycle, between its neighbours.
fn around(cycle: &[usize], k: usize) -> [usize; 3] {
    let count = cycle.len();
    [cycle[(k + count - 1) % count], cycle[k], cycle[(k + 1) % count]]
}

/// The corners in the plane in which the face has the largest area, so that it runs in the positive sense.
fn projected(count: usize, at: &impl Fn(usize) -> Point3) -> Vec<Point> {
    let origin = at(0);
    let place = |k: usize| at(k) - origin;
    let normal = (1..count).fold(Point3::zeros(), |sum, k| sum + place(k).cross(&place((k + 1) % count)));
    // Two directions across the normal, beginning with the axis it leans on least.
    let thinnest = (0..3).fold(0, |best, k| if normal[k].abs() < normal[best].abs() { k } else { best });
    let axis = Point3::from_fn(|k, _| f64::from(u8::from(k == thinnest)));
    let across = normal.cross(&axis).try_normalize(0.0).unwrap_or_else(Point3::zeros);
    let up = normal.cross(&across).try_normalize(0.0).unwrap_or_else(Point3::zeros);
    (0..count)
        .map(|k| Point::new(across.dot(&place(k)), up.dot(&place(k))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangles(corners: &[Point3]) -> Vec<[usize; 3]> {
        let mut triangles = Vec::new();
        triangulate(corners.len(), |k| corners[k], &mut triangles);
        triangles
    }

    fn flat(corners: &[[f64; 2]]) -> Vec<Point3> {
        corners.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect()
    }

    /// Twice the areas, along `normal`.
    fn areas(corners: &[Point3], normal: Point3) -> Vec<f64> {
        let area = |[a, b, c]: [usize; 3]| (corners[b] - corners[a]).cross(&(corners[c] - corners[a])).dot(&normal);
        triangles(corners).into_iter().map(area).collect()
    }

    #[test]
    fn a_quadrangle_is_divided_by_its_shorter_diagonal_or_the_one_inside() {
        let kite = flat(&[[0.0, 0.0], [1.0, -1.0], [5.0, 0.0], [1.0, 1.0]]);
        assert_eq!(triangles(&kite), [[3, 0, 1], [1, 2, 3]]);
        // An arrowhead: the shorter diagonal, from 1 to 3, is outside.
        let arrow = flat(&[[0.0, 0.0], [-1.0, -1.0], [5.0, 0.0], [-1.0, 1.0]]);
        for triangle in triangles(&arrow) {
            assert!(triangle.contains(&0) && triangle.contains(&2), "{triangle:?}");
        }
    }

    #[test]
    fn folded_and_crossing_faces_still_give_all_their_triangles() {
        for corners in [
            flat(&[[0.0, 0.0]; 5]),
            flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]),
            flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.5, 2.0]]),
            flat(&[[0.0, f64::NAN], [1.0, 1.0], [1.0, f64::INFINITY], [0.0, 1.0]]),
        ] {
            let found = triangles(&corners);
            assert_eq!(found.len(), corners.len() - 2);
            assert!((0..corners.len()).all(|k| found.iter().any(|triangle| triangle.contains(&k))));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn star_shaped_faces_are_covered_once(
            radii in prop::collection::vec(0.2..1.0f64, 3..24),
            turn in prop::array::uniform3(-3.0..3.0f64),
        ) {
            let rotation = nalgebra::Rotation3::from_scaled_axis(Point3::from(turn));
            let corners: Vec<Point3> = radii.iter().enumerate().map(|(k, radius)| {
                let angle = k as f64 * std::f64::consts::TAU / radii.len() as f64;
                rotation * Point3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
            }).collect();
            let normal = rotation * Point3::z();
            let whole: f64 = (0..corners.len())
                .map(|k| corners[k].cross(&corners[(k + 1) % corners.len()]).dot(&normal))
                .sum();
            let areas = areas(&corners, normal);
            prop_assert_eq!(areas.len(), corners.len() - 2);
            prop_assert!(areas.iter().all(|area| *area > -1e-12), "{:?}", areas);
            prop_assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-12);
        }
    }
}
