//! The fit of hyperplane and radial functions, and its evaluation.

use super::Radial;
use crate::math::vectorised;
use crate::solve::{DenseMatrix, SolvedDense};
use crate::weights::WeightError;
use crate::weights::layout::{Layout, distance};

/// Singular values of the layout below this fraction of the largest are no direction: the poses are collinear.
const FLATNESS: f64 = 1e-10;

/// Systems with a larger condition number are refused: what they magnify rounding by would be seen in the weights.
const NEARLY_SINGULAR: f64 = 1e10;

/// Examples with at least this share of the largest part in a nearly singular combination are to blame for it.
const TO_BLAME: f64 = 0.3;

/// Weights that interpolate their data. Tables have one row of #poses numbers an example or dimension.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pose_count: usize,
    radial: Radial,
    /// #examples x #dimensions.
    places: Vec<f64>,
    /// What distances are divided by, for each example.
    radii: Vec<f64>,
    /// Of the radial functions (`r` in SBE 3), #examples x #poses.
    coefficients: Vec<f64>,
    mean: Vec<f64>,
    /// About the mean (`a` in SBE 3), #dimensions x #poses.
    slopes: Vec<f64>,
    at_mean: Vec<f64>,
    condition: f64,
}

impl Fitted {
    /// Interpolates `data` (#examples x #poses) at the examples.
    pub(super) fn new(layout: &Layout, data: &DenseMatrix, radial: Radial) -> Result<Self, WeightError> {
        let (count, dimension, pose_count) = (layout.len(), layout.dimension(), data.column_count());
        let places = layout.places();
        let mean: Vec<f64> = (0..dimension)
            .map(|k| places.iter().map(|place| place[k]).sum::<f64>() / count as f64)
            .collect();
        let centred = DenseMatrix::from_fn(count, dimension, |row, column| places[row][column] - mean[column]);
        let distances = distances(places);
        let radii = match radial {
            Radial::BSpline => nearest_neighbours(&distances),
            // One common unit: it changes nothing but the rounding.
            Radial::ThinPlate if count > 1 => vec![layout.diagonal(); count],
            Radial::ThinPlate => vec![1.0; count],
        };
        let kernel = kernel(radial, distances, &radii);
        let (coefficients, slopes, at_mean, condition) = match radial {
            Radial::BSpline => {
                let data_mean: Vec<f64> = (0..pose_count)
                    .map(|column| (0..count).map(|row| data.at(row, column)).sum::<f64>() / count as f64)
                    .collect();
                let about_mean = DenseMatrix::from_fn(count, pose_count, |row, column| {
                    data.at(row, column) - data_mean[column]
                });
                let slopes = centred.least_squares(&about_mean, FLATNESS)?;
                let left_over = about_mean.plus(-1.0, &centred.times(&slopes)?)?;
                let (coefficients, condition) = solved(&kernel, &left_over, count)?;
                (coefficients, slopes, data_mean, condition)
            }
            Radial::ThinPlate => {
                // Only directions in which the poses extend can have a slope.
                let directions = centred.row_space(FLATNESS)?;
                let unit = radii[0];
                let along = centred.times(&directions)?;
                let side = directions.column_count() + 1;
                let linear = |row: usize, k: usize| if k == 0 { 1.0 } else { along.at(row, k - 1) / unit };
                let system = DenseMatrix::from_fn(count + side, count + side, |row, column| {
                    match (row.checked_sub(count), column.checked_sub(count)) {
                        (None, None) => kernel.at(row, column),
                        (None, Some(k)) => linear(row, k),
                        (Some(k), None) => linear(column, k),
                        (Some(_), Some(_)) => 0.0,
                    }
                });
                let right = DenseMatrix::from_fn(count + side, pose_count, |row, column| {
                    if row < count { data.at(row, column) } else { 0.0 }
                });
                let (solution, condition) = solved(&system, &right, count)?;
                let in_directions = DenseMatrix::from_fn(side - 1, pose_count, |row, column| {
                    solution.at(count + 1 + row, column) / unit
                });
                let slopes = directions.times(&in_directions)?;
                let at_mean = (0..pose_count).map(|column| solution.at(count, column)).collect();
                (solution, slopes, at_mean, condition)
            }
        };
        let rows = |matrix: &DenseMatrix, rows: usize| {
            let mut table = Vec::with_capacity(rows * pose_count);
            (0..rows).for_each(|row| table.extend_from_slice(&matrix.row(row)[..pose_count]));
            table
        };
        Ok(Self {
            pose_count,
            radial,
            places: places.concat(),
            radii,
            coefficients: rows(&coefficients, count),
            mean,
            slopes: rows(&slopes, dimension),
            at_mean,
            condition,
        })
    }

    pub(super) fn dimension(&self) -> usize {
        self.mean.len()
    }

    pub(super) fn condition(&self) -> f64 {
        self.condition
    }

    /// The weights at `L` places side by side: #dimensions coordinates in, #poses weights out. Every lane is computed as it
    /// would be alone.
    #[inline(always)]
    pub(super) fn weights<const L: usize>(&self, at: &[[f64; L]], weights: &mut [[f64; L]]) {
        for (weight, at_mean) in weights.iter_mut().zip(&self.at_mean) {
            *weight = [*at_mean; L];
        }
        let add = |weights: &mut [[f64; L]], factors: &[f64], table_row: &[f64]| {
            for (weight, entry) in weights.iter_mut().zip(table_row) {
                for (lane, factor) in weight.iter_mut().zip(factors) {
                    *lane += factor * entry;
                }
            }
        };
        let slopes = self.slopes.chunks_exact(self.pose_count);
        for ((along, mean), slopes) in at.iter().zip(&self.mean).zip(slopes) {
            add(weights, &along.map(|coordinate| coordinate - mean), slopes);
        }
        let examples = self.places.chunks_exact(self.mean.len().max(1)).zip(&self.radii);
        for ((place, radius), coefficients) in examples.zip(self.coefficients.chunks_exact(self.pose_count)) {
            let mut squares = [0.0; L];
            for (along, coordinate) in at.iter().zip(place) {
                for (square, x) in squares.iter_mut().zip(along) {
                    *square += (x - coordinate) * (x - coordinate);
                }
            }
            let values = squares.map(|square| self.radial.at(square.sqrt() / radius));
            // Splines are local: most reach few places.
            if values.iter().any(|value| *value != 0.0) {
                add(weights, &values, coefficients);
            }
        }
    }
}

/// Between all examples, #examples x #examples.
fn distances(places: &[Vec<f64>]) -> DenseMatrix {
    let count = places.len();
    let mut table = DenseMatrix::from_fn(
        count,
        count,
        |a, b| if b < a { distance(&places[a], &places[b]) } else { 0.0 },
    );
    for a in 0..count {
        for b in 0..a {
            table.set(b, a, table.at(a, b));
        }
    }
    table
}

/// The distance from each example to its nearest neighbour; 1 for one that is alone.
fn nearest_neighbours(distances: &DenseMatrix) -> Vec<f64> {
    let count = distances.row_count();
    if count == 1 {
        return vec![1.0];
    }
    let nearest = |k: usize| {
        let row = distances.row(k);
        let others = row[..k].iter().chain(&row[k + 1..]);
        others.fold(f64::INFINITY, |least, distance| least.min(*distance))
    };
    (0..count).map(nearest).collect()
}

/// The radial function of each example (columns) at all of them (rows); `table` holds the distances.
fn kernel(radial: Radial, mut table: DenseMatrix, radii: &[f64]) -> DenseMatrix {
    match radial {
        Radial::BSpline => vectorised(
            #[inline(always)]
            || {
                for row in 0..table.row_count() {
                    for (value, radius) in table.row_mut(row).iter_mut().zip(radii) {
                        *value = radial.at(*value / radius);
                    }
                }
            },
        ),
        // All radii are the same, so the table is symmetric; logarithms are dear.
        Radial::ThinPlate => {
            for (row, radius) in radii.iter().enumerate() {
                for column in 0..=row {
                    let value = radial.at(table.at(row, column) / radius);
                    table.set(row, column, value);
                    table.set(column, row, value);
                }
            }
        }
    }
    table
}

/// The solution of a system whose first `examples` unknowns belong to examples, and its condition number.
fn solved(system: &DenseMatrix, right: &DenseMatrix, examples: usize) -> Result<(DenseMatrix, f64), WeightError> {
    let (size, columns) = (right.row_count(), right.column_count());
    // The inverse, for its norm, beside the solution: where data are those of poses alone, the inverse is the solution. These
    // systems are small.
    let is_unit = |row: usize| {
        let entries = right.row(row).iter().enumerate();
        entries
            .into_iter()
            .all(|(column, entry)| *entry == f64::from(u8::from(row == column)))
    };
    let columns = if (0..size).all(is_unit) { 0 } else { columns };
    let both = DenseMatrix::from_fn(size, columns + size, |row, column| match column.checked_sub(columns) {
        None => right.at(row, column),
        Some(k) => f64::from(u8::from(row == k)),
    });
    let blame = |part: &dyn Fn(usize) -> f64, condition: f64| {
        let largest = (0..examples).map(|row| part(row).abs()).fold(0.0, f64::max);
        WeightError::NearlySingular {
            poses: (0..examples)
                .filter(|&row| part(row).abs() >= TO_BLAME * largest)
                .collect(),
            condition,
        }
    };
    let Ok(both) = SolvedDense::new(system).and_then(|factored| factored.solve(&both)) else {
        return Err(blame(&|_| 1.0, f64::INFINITY));
    };
    let largest = |matrix: &DenseMatrix, from: usize| {
        let mut norms = vec![0.0; size];
        for row in 0..size {
            for (norm, entry) in norms.iter_mut().zip(&matrix.row(row)[from..]) {
                *norm += entry.abs();
            }
        }
        let norms = norms
            .into_iter()
            .enumerate()
            .map(|(column, norm)| (from + column, norm));
        norms.fold((from, 0.0), |best, next| if next.1 > best.1 { next } else { best })
    };
    let (worst, inverse_norm) = largest(&both, columns);
    let condition = inverse_norm * largest(system, 0).1;
    if condition <= NEARLY_SINGULAR {
        Ok((both, condition))
    } else {
        Err(blame(&|row| both.at(row, worst), condition))
    }
}

impl Radial {
    /// The radial function at `t`, the distance over the radius.
    #[inline(always)]
    fn at(self, t: f64) -> f64 {
        match self {
            // The cubic B-spline of SBE 3.3 as a sum of truncated powers: one formula for its three pieces.
            Self::BSpline => {
                let (outer, inner) = ((2.0 - t).max(0.0), (1.0 - t).max(0.0));
                (outer * outer * outer - 4.0 * inner * inner * inner) / 6.0
            }
            Self::ThinPlate if t > 0.0 => t * t * t.ln(),
            Self::ThinPlate => 0.0,
        }
    }
}
