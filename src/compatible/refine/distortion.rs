//! Least distortion between poses: interior vertices move so that every triangle is as similar as possible in all poses.
//!
//! In each pose the energy of a triangle with area a, mapped from its rest shape by the Jacobian J, is
//! `rest area * (|J|^2 + |J^-1|^2) + SHAPE_WEIGHT * sqrt(rest area * mean rest area) * (mean ratio)^4`:
//! the symmetric Dirichlet energy, which is least where the triangle has its rest shape, and a shape term, without
//! which triangles that are needles in every pose are left so. Both go to infinity as the triangle collapses.
//!
//! The rest shape is the mean of the poses: the mean of their metrics (Gram matrices of two edges), each divided by the
//! pose's area. It is updated in every sweep. A vertex takes one Newton step of its own 2 x 2 problem with the other
//! vertices held, shortened until the energy falls and all triangles are positive. A vertex around which nothing moves any
//! more is passed over: most come to rest in a few sweeps, a few take many.
//!
//! Vertices with a target (module `guide`) are drawn to it besides, by `TARGET_WEIGHT * trust * |p - target|^2` in squares of the pose's size: the
//! targets say what corresponds, and the rest of the energy keeps the triangles well shaped on the way there.

use rayon::prelude::*;

use super::super::editable::EditableMesh;
use super::star::{self, Stars};
use crate::math::{Matrix, Point, point};
use crate::mesh::geometry;

/// Weight of the mean ratio's fourth power against the symmetric Dirichlet energy. The power is what spreads a squeeze that
/// only one pose has over the triangles around it; the root of the area gives small triangles more of a say. Larger weights give rounder triangles and
/// more stretch between poses; at 0 triangles collapse.
const SHAPE_WEIGHT: f64 = 2.4;

/// A vertex is passed over while it and its neighbours move by no more than this in any pose, as a fraction of the root of
/// the mean triangle's area.
const STILL: f64 = 0.01;

/// Halvings of a step before it is given up.
const HALVINGS: usize = 6;

/// What the squared distance from a target weighs, with lengths in roots of the pose's area. Displaced by a small share `d`, a vertex costs about
/// `4 d^2` in distortion, however fine the mesh is: with this weight distortion moves it by an eightieth of what it would.
const TARGET_WEIGHT: f64 = 320.0;

/// Where a vertex should be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) place: Point,
    /// How much it weighs, beside one that is clear.
    pub(super) trust: f64,
}

/// Per pose, per vertex: where it should be. A pose without targets has none for any vertex.
pub(super) type Targets = [Option<Vec<Option<Target>>>];

/// A triangle `(vertex, a, b)` seen from its moving vertex: what the energy needs.
#[derive(Clone, Copy)]
struct Rest {
    /// Inverse of the rest edge matrix whose columns run from the moving vertex to `a` and `b`.
    inverse: Matrix,
    area: f64,
    shape_weight: f64,
}

/// Minimises the distortion of all poses, with at most `sweeps` sweeps: over all vertices, then over those around which
/// something has moved.
pub(super) fn minimise(mesh: &mut EditableMesh, stars: &Stars, sweeps: usize, targets: &Targets) {
    minimise_of(mesh, stars, sweeps, targets, |_| true);
}

/// As [`minimise`], but poses that `moves` does not say stay as they are.
pub(super) fn minimise_of(
    mesh: &mut EditableMesh,
    stars: &Stars,
    sweeps: usize,
    targets: &Targets,
    moves: impl Fn(usize) -> bool + Sync,
) {
    let areas: Vec<f64> = mesh
        .positions
        .iter()
        .map(|positions| total_area(mesh, positions))
        .collect();
    // The rest shapes have an area of about 1 together.
    let mean_area = 1.0 / mesh.triangles().count().max(1) as f64;
    let mut is_moved = vec![true; mesh.vertex_count()];
    for _ in 0..sweeps {
        let (mut awake, mut rests) = (Vec::new(), Vec::new());
        for (vertex, opposite) in stars.iter() {
            if is_moved[vertex] || opposite.iter().any(|&(a, _)| is_moved[a]) {
                let start = rests.len();
                let rest = |&(a, b): &(usize, usize)| rest_shape(&mesh.positions, &areas, mean_area, [vertex, a, b]);
                rests.extend(opposite.iter().map(rest));
                awake.push((vertex, opposite, start..rests.len()));
            }
        }
        if awake.is_empty() {
            break;
        }
        let moved: Vec<Vec<usize>> = mesh
            .positions
            .par_iter_mut()
            .enumerate()
            .zip(&areas)
            .map(|((pose, positions), &area)| {
                if !moves(pose) {
                    return Vec::new();
                }
                let targets = targets.get(pose).and_then(Option::as_deref);
                let scale = area.sqrt();
                let still = STILL * (area * mean_area).sqrt();
                let mut moved = Vec::new();
                for (vertex, opposite, range) in &awake {
                    let star = Star {
                        opposite,
                        rests: &rests[range.clone()],
                        target: targets.and_then(|targets| targets[*vertex]),
                        scale,
                    };
                    if let Some(place) = improved(positions, *vertex, &star) {
                        if (place - positions[*vertex]).norm() > still {
                            moved.push(*vertex);
                        }
                        positions[*vertex] = place;
                    }
                }
                moved
            })
            .collect();
        is_moved.fill(false);
        for vertex in moved.into_iter().flatten() {
            is_moved[vertex] = true;
        }
    }
}

fn total_area(mesh: &EditableMesh, positions: &[Point]) -> f64 {
    mesh.triangles()
        .map(|(_, t)| geometry::signed_area(geometry::corners(positions, t)))
        .sum()
}

/// The rest shape of a triangle, at total area 1.
fn rest_shape(poses: &[Vec<Point>], areas: &[f64], mean_area: f64, [vertex, a, b]: [usize; 3]) -> Rest {
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    for (positions, area) in poses.iter().zip(areas) {
        let (u, v) = (positions[a] - positions[vertex], positions[b] - positions[vertex]);
        aa += u.norm_squared() / area;
        ab += u.dot(&v) / area;
        bb += v.norm_squared() / area;
    }
    let count = areas.len() as f64;
    let (aa, ab, bb) = (aa / count, ab / count, bb / count);
    // Edges with these lengths and this angle: u along x. A mean of metrics is a metric.
    let base = aa.sqrt();
    let along = ab / base;
    let height = (bb - along * along).max(f64::MIN_POSITIVE).sqrt();
    let double_area = base * height;
    Rest {
        inverse: Matrix::new(height, -along, 0.0, base) / double_area,
        area: 0.5 * double_area,
        shape_weight: SHAPE_WEIGHT * (0.5 * double_area * mean_area).sqrt(),
    }
}

/// The triangles around a moving vertex, and where it should be.
struct Star<'a> {
    opposite: &'a [(usize, usize)],
    rests: &'a [Rest],
    target: Option<Target>,
    /// The root of the pose's area.
    scale: f64,
}

/// A better place for the vertex, if its Newton step leads to one.
fn improved(positions: &[Point], vertex: usize, star: &Star) -> Option<Point> {
    let start = positions[vertex];
    let (energy, gradient, hessian) = derivatives(positions, start, star)?;
    let step = newton_step(gradient, hessian)?;
    let mut share = 1.0;
    for _ in 0..=HALVINGS {
        let place = start + step * share;
        let lower = energy_at(positions, place, star).is_some_and(|value| value < energy);
        if lower && star::is_positive(positions, place, star.opposite) {
            return Some(place);
        }
        share *= 0.5;
    }
    None
}

/// Minus the Hessian's inverse times the gradient, the Hessian made positive definite first.
fn newton_step(gradient: Point, hessian: Matrix) -> Option<Point> {
    let mean = 0.5 * hessian.trace();
    let radius = (0.25 * (hessian.m11 - hessian.m22).powi(2) + hessian.m12 * hessian.m12).sqrt();
    let smallest = mean - radius;
    let floor = 1e-3 * (mean.abs() + radius);
    let shift = if smallest < floor { floor - smallest } else { 0.0 };
    let shifted = hessian + Matrix::identity() * shift;
    let step = -(shifted.try_inverse()? * gradient);
    point::is_finite(step).then_some(step)
}

/// One triangle's quantities: the squared norm of J and its determinant, the sum of squared edges and the double area,
/// all as functions of the moving vertex p.
struct Local {
    norm_squared: f64,
    determinant: f64,
    norm_gradient: Point,
    determinant_gradient: Point,
    norm_hessian: f64,
    edges: f64,
    double_area: f64,
    edges_gradient: Point,
    area_gradient: Point,
}

fn local(p: Point, a: Point, b: Point, rest: &Rest, scale: f64) -> Local {
    let (u, v) = ((a - p) / scale, (b - p) / scale);
    let inverse = rest.inverse;
    let jacobian = Matrix::from_columns(&[u, v]) * inverse;
    let double_area = point::cross(u, v);
    // dJ/dp = -(1, 1)-row combination: J = E * inverse, and E's columns both lose p.
    let row = Point::new(inverse.m11 + inverse.m21, inverse.m12 + inverse.m22) / scale;
    let area_gradient = point::perpendicular(b - a) / (scale * scale);
    let rest_double_area = 2.0 * rest.area;
    Local {
        norm_squared: jacobian.norm_squared(),
        determinant: double_area / rest_double_area,
        norm_gradient: -2.0 * (jacobian * row),
        determinant_gradient: area_gradient / rest_double_area,
        norm_hessian: 2.0 * row.norm_squared(),
        edges: u.norm_squared() + v.norm_squared() + (u - v).norm_squared(),
        double_area,
        edges_gradient: -2.0 * (u + v) / scale,
        area_gradient,
    }
}

/// 2 sqrt(3): a triangle's squared edges over its double area are at least this, for the equilateral one.
const EQUILATERAL: f64 = 3.464_101_615_137_754_4;

fn energy_at(positions: &[Point], p: Point, star: &Star) -> Option<f64> {
    let mut energy = 0.0;
    if let Some(target) = star.target {
        energy += TARGET_WEIGHT * target.trust * (p - target.place).norm_squared() / (star.scale * star.scale);
    }
    for (&(a, b), rest) in star.opposite.iter().zip(star.rests) {
        let l = local(p, positions[a], positions[b], rest, star.scale);
        if l.double_area <= 0.0 {
            return None;
        }
        let ratio = l.edges / (EQUILATERAL * l.double_area);
        energy += rest.area * l.norm_squared * (1.0 + l.determinant.powi(-2)) + rest.shape_weight * ratio.powi(4);
    }
    energy.is_finite().then_some(energy)
}

fn derivatives(positions: &[Point], p: Point, star: &Star) -> Option<(f64, Point, Matrix)> {
    let (mut energy, mut gradient, mut hessian) = (0.0, Point::zeros(), Matrix::zeros());
    let scale = star.scale;
    if let Some(target) = star.target {
        let (aside, weight) = (p - target.place, TARGET_WEIGHT * target.trust / (scale * scale));
        energy += weight * aside.norm_squared();
        gradient += aside * (2.0 * weight);
        hessian += Matrix::identity() * (2.0 * weight);
    }
    let outer = |x: Point, y: Point| x * y.transpose();
    for (&(a, b), rest) in star.opposite.iter().zip(star.rests) {
        let l = local(p, positions[a], positions[b], rest, scale);
        if l.double_area <= 0.0 {
            return None;
        }
        // Symmetric Dirichlet: q (1 + 1 / d^2), with q quadratic and d linear in p.
        let (q, d) = (l.norm_squared, l.determinant);
        let (dq, dd) = (l.norm_gradient, l.determinant_gradient);
        let inverse_square = d.powi(-2);
        energy += rest.area * q * (1.0 + inverse_square);
        gradient += (dq * (1.0 + inverse_square) - dd * (2.0 * q * inverse_square / d)) * rest.area;
        let mixed = (outer(dq, dd) + outer(dd, dq)) * (-2.0 * inverse_square / d);
        let curved = outer(dd, dd) * (6.0 * q * inverse_square * inverse_square);
        hessian += (Matrix::identity() * (l.norm_hessian * (1.0 + inverse_square)) + mixed + curved) * rest.area;
        // Shape: r^4 with r = e / (c a), e quadratic and a linear in p.
        let r = l.edges / (EQUILATERAL * l.double_area);
        let dr = l.edges_gradient / (EQUILATERAL * l.double_area) - l.area_gradient * (r / l.double_area);
        let edges_hessian = Matrix::identity() * (4.0 / (scale * scale));
        let ddr = edges_hessian / (EQUILATERAL * l.double_area)
            - (outer(l.edges_gradient, l.area_gradient) + outer(l.area_gradient, l.edges_gradient))
                / (EQUILATERAL * l.double_area * l.double_area)
            + outer(l.area_gradient, l.area_gradient) * (2.0 * r / (l.double_area * l.double_area));
        energy += rest.shape_weight * r.powi(4);
        gradient += dr * (4.0 * r.powi(3) * rest.shape_weight);
        hessian += (outer(dr, dr) * 3.0 + ddr * r) * (4.0 * r * r * rest.shape_weight);
    }
    energy.is_finite().then_some((energy, gradient, hessian))
}

#[cfg(test)]
mod tests {
    use super::super::super::editable::Curves;
    use super::*;

    fn star_of_four() -> (Vec<Point>, Vec<(usize, usize)>, Vec<Rest>) {
        let positions = [[0.1, 0.2], [1.0, 0.0], [0.3, 1.2], [-1.1, 0.1], [0.0, -0.8]]
            .map(Point::from)
            .to_vec();
        let opposite = vec![(1, 2), (2, 3), (3, 4), (4, 1)];
        let rest = Rest {
            inverse: Matrix::new(0.9, 0.1, -0.2, 1.1),
            area: 0.5 / (0.9 * 1.1 + 0.02),
            shape_weight: 0.2,
        };
        (positions, opposite, vec![rest; 4])
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let (positions, opposite, rests) = star_of_four();
        let p = positions[0];
        let star = Star {
            opposite: &opposite,
            rests: &rests,
            target: Some(Target {
                place: Point::new(0.3, -0.1),
                trust: 1.5,
            }),
            scale: 1.3,
        };
        let (energy, gradient, hessian) = derivatives(&positions, p, &star).expect("positive");
        let at = |q: Point| energy_at(&positions, q, &star).expect("positive");
        assert!((at(p) - energy).abs() < 1e-12 * energy);
        let h = 1e-5;
        for (axis, e) in [Point::new(h, 0.0), Point::new(0.0, h)].into_iter().enumerate() {
            let slope = (at(p + e) - at(p - e)) / (2.0 * h);
            assert!(
                (slope - gradient[axis]).abs() < 1e-5 * gradient.norm().max(1.0),
                "{slope} {gradient}"
            );
            let turn = |q: Point| derivatives(&positions, q, &star).expect("positive").1;
            let column = (turn(p + e) - turn(p - e)) / (2.0 * h);
            assert!(
                (column - hessian.column(axis)).norm() < 1e-4 * hessian.norm(),
                "{column} {hessian}"
            );
        }
    }

    #[test]
    fn the_energy_falls_to_the_rest_shape() {
        // One pose is its own mean: with the shape term the best place for the hub of a regular hexagon is its centre.
        let mut places: Vec<Point> = (0..6)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / 6.0;
                Point::new(angle.cos(), angle.sin())
            })
            .collect();
        places.push(Point::new(0.5, 0.3));
        let triangles: Vec<[usize; 3]> = (0..6).map(|k| [6, k, (k + 1) % 6]).collect();
        let mut mesh = EditableMesh::new(vec![places], &triangles);
        let curves = Curves {
            rings: vec![(0..6).collect()],
            landmarks: vec![],
            paths: vec![],
        };
        let stars = Stars::new(&mesh, &curves);
        minimise(&mut mesh, &stars, 30, &[]);
        assert!(mesh.positions[0][6].norm() < 0.05, "{}", mesh.positions[0][6]);
    }
}
