//! The reduced Clough-Tocher element: a smooth cubic patch over a triangle from values and gradients at its corners.
//!
//! Source: Clough and Tocher 1965; in Bezier form Farin 1985. The triangle is split at its centroid into three, each
//! with a cubic. Along an edge the patch depends on the data of that edge's two ends only, and its derivative across
//! the edge runs linearly, so patches over neighbouring triangles join with one tangent plane. Quadratic functions
//! are reproduced.
//!
//! Data are nine numbers: value, derivative along x, derivative along y at each of the three corners.

use crate::math::Point;
use crate::mesh::geometry;

/// The ten Bezier ordinates of a cubic on a sub-triangle, at `INDEX[exponent of corner 0][exponent of corner 1]`.
type Ordinates = [f64; 10];

/// Where the ordinate of exponents (a, b, 3 - a - b) is kept; unused places are never read.
const INDEX: [[usize; 4]; 4] = [
    [0, 1, 2, 3],
    [4, 5, 6, usize::MAX],
    [7, 8, usize::MAX, usize::MAX],
    [9, usize::MAX, usize::MAX, usize::MAX],
];

/// The six exponents of degree two, and the three of degree one.
const QUADRATIC: [[usize; 3]; 6] = [[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]];
const LINEAR: [[usize; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/// The patch over one triangle.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    corners: [Point; 3],
    /// Sub-triangle `k` has corners `k`, `k + 1` and the centroid.
    ordinates: [Ordinates; 3],
}

fn ordinate(ordinates: &Ordinates, exponents: [usize; 3]) -> f64 {
    ordinates[INDEX[exponents[0]][exponents[1]]]
}

fn raised(mut exponents: [usize; 3], corner: usize) -> [usize; 3] {
    exponents[corner] += 1;
    exponents
}

impl Patch {
    /// The patch with `data[3 k..3 k + 3]` = value and gradient at corner `k`.
    pub(super) fn new(corners: [Point; 3], data: &[f64; 9]) -> Self {
        let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
        let value = |k: usize| data[3 * (k % 3)];
        // A third of the derivative from corner k towards a point: the step from the corner's ordinate to the next.
        let towards = |k: usize, to: Point| {
            let k = k % 3;
            value(k) + Point::new(data[3 * k + 1], data[3 * k + 2]).dot(&(to - corners[k])) / 3.0
        };
        let mut ordinates = [[0.0; 10]; 3];
        let mut middle = [0.0; 3];
        for k in 0..3 {
            let (i, j) = (k, (k + 1) % 3);
            let edge = corners[j] - corners[i];
            // The centroid's foot on the edge: across the edge is from the foot to the centroid.
            let foot = (centroid - corners[i]).dot(&edge) / edge.norm_squared();
            let (near_i, near_j) = (towards(i, corners[j]), towards(j, corners[i]));
            let across_i = towards(i, centroid) - (1.0 - foot) * value(i) - foot * near_i;
            let across_j = towards(j, centroid) - (1.0 - foot) * near_j - foot * value(j);
            middle[k] = (1.0 - foot) * near_i + foot * near_j + 0.5 * (across_i + across_j);
            let own = &mut ordinates[k];
            own[INDEX[3][0]] = value(i);
            own[INDEX[0][3]] = value(j);
            own[INDEX[2][1]] = near_i;
            own[INDEX[1][2]] = near_j;
            own[INDEX[2][0]] = towards(i, centroid);
            own[INDEX[0][2]] = towards(j, centroid);
            own[INDEX[1][1]] = middle[k];
        }
        // Smooth across the inner edges: each of their inner ordinates is the mean of its three neighbours.
        let inner: [f64; 3] = std::array::from_fn(|k| (towards(k, centroid) + middle[k] + middle[(k + 2) % 3]) / 3.0);
        let apex = (inner[0] + inner[1] + inner[2]) / 3.0;
        for (k, own) in ordinates.iter_mut().enumerate() {
            own[INDEX[1][0]] = inner[k];
            own[INDEX[0][1]] = inner[(k + 1) % 3];
            own[INDEX[0][0]] = apex;
        }
        Self { corners, ordinates }
    }

    /// The value at barycentric coordinates of the whole triangle: what [`value_form`] is measured by.
    #[cfg(test)]
    fn value(&self, barycentric: [f64; 3]) -> f64 {
        let (k, inner) = sub_triangle(barycentric);
        let mut net = self.ordinates[k];
        // De Casteljau: three rounds of means.
        for degree in (0..3).rev() {
            for a in 0..=degree {
                for b in 0..=degree - a {
                    let exponents = [a, b, degree - a - b];
                    net[INDEX[a][b]] = (0..3)
                        .map(|corner| {
                            let [a, b, _] = raised(exponents, corner);
                            inner[corner] * net[INDEX[a][b]]
                        })
                        .sum();
                }
            }
        }
        net[INDEX[0][0]]
    }

    /// Corners of sub-triangle `k`.
    fn sub_corners(&self, k: usize) -> [Point; 3] {
        let centroid = (self.corners[0] + self.corners[1] + self.corners[2]) / 3.0;
        [self.corners[k], self.corners[(k + 1) % 3], centroid]
    }

    /// The second derivatives (xx, xy, yy) at the corners of sub-triangle `k`, between which they are linear.
    /// `directions` are the gradients of its barycentric coordinates.
    fn second_derivatives(&self, k: usize, directions: &[Point; 3]) -> [[f64; 3]; 3] {
        LINEAR.map(|corner| {
            let mut second = [0.0; 3];
            for (a, u) in directions.iter().enumerate() {
                for (b, v) in directions.iter().enumerate() {
                    let bend = 6.0 * ordinate(&self.ordinates[k], raised(raised(corner, a), b));
                    second[0] += bend * u.x * v.x;
                    second[1] += bend * u.x * v.y;
                    second[2] += bend * u.y * v.y;
                }
            }
            second
        })
    }

    /// The gradient over sub-triangle `k` as six Bezier ordinates of degree two, in the order of [`QUADRATIC`].
    fn gradient_ordinates(&self, k: usize, directions: &[Point; 3]) -> [Point; 6] {
        QUADRATIC.map(|exponents| {
            directions
                .iter()
                .enumerate()
                .map(|(a, direction)| direction * (3.0 * ordinate(&self.ordinates[k], raised(exponents, a))))
                .sum()
        })
    }
}

/// The value at barycentric coordinates as a linear form in the nine data: [`Patch::value`] transposed, for many patches
/// over one triangle.
pub(super) fn value_form(corners: [Point; 3], barycentric: [f64; 3]) -> [f64; 9] {
    let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    let (i, [u, v, w]) = sub_triangle(barycentric);
    let j = (i + 1) % 3;
    // What the value takes of each corner's value, of the ordinates next to it, and of the middle ones.
    let mut values = [0.0; 3];
    let mut middle = [0.0; 3];
    let mut to_centroid = [0.0; 3];
    let mut to_next = [0.0; 3];
    let mut to_previous = [0.0; 3];
    values[i] = u * u * u;
    values[j] = v * v * v;
    to_next[i] = 3.0 * u * u * v;
    to_previous[j] = 3.0 * u * v * v;
    to_centroid[i] = 3.0 * u * u * w;
    to_centroid[j] = 3.0 * v * v * w;
    middle[i] = 6.0 * u * v * w;
    let apex = w * w * w / 3.0;
    let mut inner = [apex; 3];
    inner[i] += 3.0 * u * w * w;
    inner[j] += 3.0 * v * w * w;
    for (k, share) in inner.into_iter().enumerate() {
        to_centroid[k] += share / 3.0;
        middle[k] += share / 3.0;
        middle[(k + 2) % 3] += share / 3.0;
    }
    for (k, share) in middle.into_iter().enumerate() {
        let next = (k + 1) % 3;
        let edge = corners[next] - corners[k];
        let foot = (centroid - corners[k]).dot(&edge) / edge.norm_squared();
        to_next[k] += share * (1.0 - 1.5 * foot);
        to_previous[next] += share * (1.5 * foot - 0.5);
        to_centroid[k] += 0.5 * share;
        to_centroid[next] += 0.5 * share;
        values[k] -= 0.5 * share * (1.0 - foot);
        values[next] -= 0.5 * share * foot;
    }
    let mut form = [0.0; 9];
    for (k, data) in form.chunks_exact_mut(3).enumerate() {
        data[0] = values[k] + to_next[k] + to_previous[k] + to_centroid[k];
        let along = (corners[(k + 1) % 3] - corners[k]) * to_next[k]
            + (corners[(k + 2) % 3] - corners[k]) * to_previous[k]
            + (centroid - corners[k]) * to_centroid[k];
        data[1] = along.x / 3.0;
        data[2] = along.y / 3.0;
    }
    form
}

/// Two quadratic forms in the nine data of a patch, exact: both are integrals of products of Bezier polynomials.
#[derive(Debug, Clone)]
pub(super) struct Stiffness {
    /// The integral of the squared second derivatives.
    pub(super) bend: [[f64; 9]; 9],
    /// The integral of the squared gradient.
    pub(super) slope: [[f64; 9]; 9],
}

/// The energies of the patch over a triangle.
pub(super) fn stiffness(corners: [Point; 3]) -> Stiffness {
    let basis: [Patch; 9] = std::array::from_fn(|k| {
        let mut data = [0.0; 9];
        data[k] = 1.0;
        Patch::new(corners, &data)
    });
    let mut form = Stiffness {
        bend: [[0.0; 9]; 9],
        slope: [[0.0; 9]; 9],
    };
    for k in 0..3 {
        let sub = basis[0].sub_corners(k);
        let area = geometry::signed_area(sub);
        let Some(directions) = geometry::barycentric_gradients(sub) else {
            continue;
        };
        let second = basis.each_ref().map(|patch| patch.second_derivatives(k, &directions));
        let gradient = basis.each_ref().map(|patch| patch.gradient_ordinates(k, &directions));
        let product = quadratic_products();
        for row in 0..9 {
            let (bends, slopes) = (&second[row], &gradient[row]);
            let weighted = product.map(|row| row.iter().zip(slopes).map(|(p, slope)| slope * *p).sum::<Point>());
            for column in 0..9 {
                let (other_bends, other_slopes) = (&second[column], &gradient[column]);
                // The integral of a product of linear functions from their corner values.
                let corners: f64 = bends.iter().zip(other_bends).map(|(a, b)| squared(a, b)).sum();
                let slope: f64 = weighted.iter().zip(other_slopes).map(|(a, b)| a.dot(b)).sum();
                form.bend[row][column] += area * (corners + squared(&sum(bends), &sum(other_bends))) / 12.0;
                form.slope[row][column] += area * slope;
            }
        }
    }
    form
}

fn sum(corners: &[[f64; 3]; 3]) -> [f64; 3] {
    std::array::from_fn(|part| corners[0][part] + corners[1][part] + corners[2][part])
}

/// The product of two symmetric matrices summed over their four entries.
fn squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + 2.0 * a[1] * b[1] + a[2] * b[2]
}

/// The integrals, over a triangle of area 1, of the products of the Bernstein polynomials of degree two.
fn quadratic_products() -> [[f64; 6]; 6] {
    // Binomial (m + n over m) for exponents up to two.
    const CHOOSE: [[f64; 3]; 3] = [[1.0, 1.0, 1.0], [1.0, 2.0, 3.0], [1.0, 3.0, 6.0]];
    QUADRATIC.map(|m| QUADRATIC.map(|n| (0..3).map(|corner| CHOOSE[m[corner]][n[corner]]).product::<f64>() / 90.0))
}

/// Which third of the triangle a point is in, and its barycentric coordinates there.
fn sub_triangle([a, b, c]: [f64; 3]) -> (usize, [f64; 3]) {
    // The centroid counts as a third of each corner: take out the smallest coordinate, three times.
    if c <= a && c <= b {
        (0, [a - c, b - c, 3.0 * c])
    } else if a <= b && a <= c {
        (1, [b - a, c - a, 3.0 * a])
    } else {
        (2, [c - b, a - b, 3.0 * b])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::point;
    use proptest::prelude::*;

    fn locate(corners: [Point; 3], p: Point) -> [f64; 3] {
        geometry::barycentric(corners, p).expect("it has area")
    }

    fn triangle() -> [Point; 3] {
        [[0.1, -0.2], [1.3, 0.2], [0.4, 1.1]].map(Point::from)
    }

    fn data_of(corners: [Point; 3], f: impl Fn(Point) -> (f64, Point)) -> [f64; 9] {
        let mut data = [0.0; 9];
        for (k, corner) in corners.into_iter().enumerate() {
            let (value, gradient) = f(corner);
            data[3 * k..3 * k + 3].copy_from_slice(&[value, gradient.x, gradient.y]);
        }
        data
    }

    fn quadratic(p: Point) -> (f64, Point) {
        (
            1.0 + p.x - 2.0 * p.y + p.x * p.x - 3.0 * p.x * p.y + 0.5 * p.y * p.y,
            Point::new(1.0 + 2.0 * p.x - 3.0 * p.y, -2.0 - 3.0 * p.x + p.y),
        )
    }

    #[test]
    fn quadratics_are_reproduced_and_their_energy_is_exact() {
        let corners = triangle();
        let data = data_of(corners, quadratic);
        let patch = Patch::new(corners, &data);
        for barycentric in [[0.2, 0.3, 0.5], [0.6, 0.3, 0.1], [0.1, 0.8, 0.1], [1.0, 0.0, 0.0]] {
            let p = (0..3).map(|k| corners[k] * barycentric[k]).sum();
            assert!((patch.value(barycentric) - quadratic(p).0).abs() < 1e-13);
        }
        let form = stiffness(corners).bend;
        let energy: f64 = (0..81).map(|k| data[k / 9] * form[k / 9][k % 9] * data[k % 9]).sum();
        // Second derivatives 2, -3, -3, 1 everywhere.
        assert!(
            (energy - 23.0 * geometry::signed_area(corners)).abs() < 1e-10,
            "{energy}"
        );
    }

    #[test]
    fn a_linear_function_has_only_its_gradient_energy() {
        let corners = triangle();
        let data = data_of(corners, |p| (p.x * 3.0 + p.y * 4.0, Point::new(3.0, 4.0)));
        let Stiffness { bend, slope } = stiffness(corners);
        let form = |k: usize| bend[k / 9][k % 9] + 2.0 * slope[k / 9][k % 9];
        let energy: f64 = (0..81).map(|k| data[k / 9] * form(k) * data[k % 9]).sum();
        assert!(
            (energy - 50.0 * geometry::signed_area(corners)).abs() < 1e-10,
            "{energy}"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn the_form_of_a_value_is_the_patch_transposed(
            data in proptest::array::uniform9(-1.0..1.0f64),
            (a, b) in (0.0..1.0f64, 0.0..1.0f64),
        ) {
            let barycentric = [a * (1.0 - b), (1.0 - a) * (1.0 - b), b];
            let patch = Patch::new(triangle(), &data).value(barycentric);
            let form = value_form(triangle(), barycentric);
            let value: f64 = form.iter().zip(&data).map(|(f, d)| f * d).sum();
            prop_assert!((value - patch).abs() < 1e-14, "{value} instead of {patch}");
        }

        #[test]
        fn neighbours_join_with_one_tangent_plane(
            data in proptest::collection::vec(-1.0..1.0f64, 12),
            along in 0.02..0.98f64,
        ) {
            let [a, b, c] = triangle();
            let d = Point::new(1.4, 1.5);
            let at = |k: usize| [data[3 * k], data[3 * k + 1], data[3 * k + 2]];
            let joined = |x: [f64; 3], y: [f64; 3], z: [f64; 3]| {
                let mut all = [0.0; 9];
                all[..3].copy_from_slice(&x);
                all[3..6].copy_from_slice(&y);
                all[6..].copy_from_slice(&z);
                all
            };
            let (left, right) = ([a, b, c], [b, d, c]);
            let left_patch = Patch::new(left, &joined(at(0), at(1), at(2)));
            let right_patch = Patch::new(right, &joined(at(1), at(3), at(2)));
            let p = b + (c - b) * along;
            let across = point::perpendicular(c - b);
            let step = 1e-5;
            let on_left = |s: f64| left_patch.value(locate(left, p + across * s));
            let on_right = |s: f64| right_patch.value(locate(right, p - across * s));
            prop_assert!((on_left(0.0) - on_right(0.0)).abs() < 1e-12);
            // One-sided differences of second order.
            let slope = |f: &dyn Fn(f64) -> f64| (4.0 * f(step) - 3.0 * f(0.0) - f(2.0 * step)) / (2.0 * step);
            prop_assert!((slope(&on_left) + slope(&on_right)).abs() < 1e-6);
        }
    }
}
