//! What is solved for on a mesh: unknowns, the energy's matrix, and how a function's values depend on the unknowns.

use super::clough_tocher;
use super::jacobian_differences::{self, GradientForm};
use super::objective::Field;
use super::tessellation::Tessellation;
use super::{Energy, WeightError, hessian};
use crate::math::Point;
use crate::mesh::{Located, geometry};
use crate::solve::Entry;

/// A linear form: unknowns and what each is multiplied with. No unknown comes twice.
pub(super) type Form = Vec<(usize, f64)>;

/// Barycentric coordinates and weights of a rule that is exact for polynomials of degree five (Radon 1948), for area 1.
const RULE: [([f64; 3], f64); 7] = {
    const A: f64 = 0.470_142_064_105_115_1;
    const B: f64 = 0.101_286_507_323_456_34;
    const WEIGHT_A: f64 = 0.132_394_152_788_506_2;
    const WEIGHT_B: f64 = 0.125_939_180_544_827_15;
    const THIRD: f64 = 1.0 / 3.0;
    [
        ([THIRD, THIRD, THIRD], 0.225),
        ([A, A, 1.0 - 2.0 * A], WEIGHT_A),
        ([A, 1.0 - 2.0 * A, A], WEIGHT_A),
        ([1.0 - 2.0 * A, A, A], WEIGHT_A),
        ([B, B, 1.0 - 2.0 * B], WEIGHT_B),
        ([B, 1.0 - 2.0 * B, B], WEIGHT_B),
        ([1.0 - 2.0 * B, B, B], WEIGHT_B),
    ]
};

/// The unknowns of an energy on a mesh.
#[derive(Debug, Clone)]
pub(super) enum Elements {
    /// Values and gradients at vertices; the size of each vertex's triangles, in which its gradient is measured.
    Smooth { sizes: Vec<f64> },
    /// Values at vertices; the gradient at each vertex as recovered from them.
    Linear { gradients: Vec<GradientForm> },
}

impl Elements {
    pub(super) fn new(mesh: &Tessellation, energy: Energy) -> Self {
        match energy {
            Energy::Hessian => Self::Smooth {
                sizes: hessian::sizes(mesh),
            },
            Energy::JacobianDifferences => Self::Linear {
                gradients: jacobian_differences::recovery(mesh),
            },
        }
    }

    pub(super) fn unknown_count(&self) -> usize {
        match self {
            Self::Smooth { sizes } => 3 * sizes.len(),
            Self::Linear { gradients } => gradients.len(),
        }
    }

    /// The unknown that is the value at a vertex.
    pub(super) fn value_at(&self, vertex: usize) -> usize {
        match self {
            Self::Smooth { .. } => 3 * vertex,
            Self::Linear { .. } => vertex,
        }
    }

    /// The lower triangle of the energy's matrix, entries at one place to be added up. Gradients weigh
    /// `epsilon + flatness` at each place, in units where a squared second derivative weighs 1.
    pub(super) fn energy(
        &self,
        mesh: &Tessellation,
        epsilon: f64,
        flatness: &[Field<'_>],
    ) -> Result<Vec<Entry>, WeightError> {
        let weight = |&triangle: &[usize; 3]| {
            let corners = geometry::corners(&mesh.positions, triangle);
            let added: f64 = RULE
                .iter()
                .map(|(at, share)| share * flatness.iter().map(|field| field(place(corners, at))).sum::<f64>())
                .sum();
            epsilon + added
        };
        let weights: Vec<f64> = mesh.triangles.iter().map(weight).collect();
        match self {
            Self::Smooth { sizes } => Ok(hessian::energy(mesh, sizes, &weights)),
            Self::Linear { .. } => jacobian_differences::energy(mesh, &weights),
        }
    }

    /// The matrix and the linear form of half the integral of `strength |f - target|^2`, for a target of 1: entries to
    /// be added to the energy's, and what the target is multiplied with on the right side.
    pub(super) fn pull(&self, mesh: &Tessellation, strength: Field<'_>) -> (Vec<Entry>, Form) {
        let mut entries = Vec::new();
        let mut right = vec![0.0; self.unknown_count()];
        for (index, &triangle) in mesh.triangles.iter().enumerate() {
            let corners = geometry::corners(&mesh.positions, triangle);
            let area = geometry::signed_area(corners);
            for (barycentric, share) in RULE {
                let weight = area * share * strength(place(corners, &barycentric));
                if weight > 0.0 {
                    let located = Located {
                        triangle: index,
                        barycentric,
                    };
                    let form = self.value_form(mesh, &located);
                    for &(row, a) in &form {
                        right[row] += weight * a;
                        let lower = form.iter().filter(|(column, _)| *column <= row);
                        entries.extend(lower.map(|&(column, b)| (row, column, weight * a * b)));
                    }
                }
            }
        }
        let right = right.into_iter().enumerate().filter(|(_, value)| *value != 0.0);
        (entries, right.collect())
    }

    /// The value of the smooth function at a place of the mesh.
    pub(super) fn value_form(&self, mesh: &Tessellation, at: &Located) -> Form {
        let triangle = mesh.triangles[at.triangle];
        let data = clough_tocher::value_form(geometry::corners(&mesh.positions, triangle), at.barycentric);
        match self {
            Self::Smooth { sizes } => (0..9)
                .map(|k| {
                    let vertex = triangle[k / 3];
                    let unit = if k % 3 == 0 { 1.0 } else { sizes[vertex] };
                    (3 * vertex + k % 3, data[k] / unit)
                })
                .collect(),
            Self::Linear { gradients } => {
                let mut form = Form::new();
                let mut add = |unknown: usize, value: f64| match form.iter_mut().find(|(known, _)| *known == unknown) {
                    Some((_, sum)) => *sum += value,
                    None => form.push((unknown, value)),
                };
                for (data, vertex) in data.chunks_exact(3).zip(triangle) {
                    add(vertex, data[0]);
                    let slope = Point::new(data[1], data[2]);
                    for (unknown, direction) in &gradients[vertex] {
                        add(*unknown, slope.dot(direction));
                    }
                }
                form
            }
        }
    }

    /// Value and gradient of several functions at every vertex, from #unknowns x `count` numbers: #vertices x 3 x `count`.
    pub(super) fn jets(&self, functions: &[f64], count: usize) -> Vec<f64> {
        match self {
            Self::Smooth { sizes } => {
                let mut jets = functions.to_vec();
                for (vertex, size) in jets.chunks_exact_mut(3 * count).zip(sizes) {
                    for slope in &mut vertex[count..] {
                        *slope /= size;
                    }
                }
                jets
            }
            Self::Linear { gradients } => {
                let mut jets = vec![0.0; 3 * functions.len()];
                for (vertex, (jet, form)) in jets.chunks_exact_mut(3 * count).zip(gradients).enumerate() {
                    let (values, slopes) = jet.split_at_mut(count);
                    let (along_x, along_y) = slopes.split_at_mut(count);
                    values.copy_from_slice(&functions[vertex * count..(vertex + 1) * count]);
                    for (unknown, direction) in form {
                        for (k, value) in functions[unknown * count..(unknown + 1) * count].iter().enumerate() {
                            along_x[k] += direction.x * value;
                            along_y[k] += direction.y * value;
                        }
                    }
                }
                jets
            }
        }
    }
}

fn place(corners: [Point; 3], barycentric: &[f64; 3]) -> Point {
    corners[0] * barycentric[0] + corners[1] * barycentric[1] + corners[2] * barycentric[2]
}
