//! Handles as linear constraints, met exactly by a Schur complement over the factor of the pose.
//!
//! Without vertex 0 the cotangent matrix `L` has an inverse `L'`. Positions that fit rotations best under `C V = h`, `C` with
//! a row of barycentric coordinates a handle, are `V = L' b + L' C^T lambda + c`, where
//!
//! ```text
//! | C L' C^T  1 | | lambda |   | h - C L' b |
//! |   1^T     0 | |   c    | = |     0      |
//! ```
//!
//! (the multipliers sum to 0, or the forces on the pinned vertex would not). `L' C^T` takes a solve a handle, the small matrix
//! is inverted once.

use super::HandleError;
use super::rest::RestShape;
use crate::math::{Point, point};
use crate::mesh::{MeshPoint, PointLocator, geometry};
use crate::solve::{DenseMatrix, SolveError, SolvedDense};

/// How far outside the mesh a handle may lie, as a fraction of the pose's diagonal: an outline point may, by the rounding of
/// merged vertices.
const OUTSIDE: f64 = 1e-9;

/// The largest error of the inverted small matrix: above it the handles depend on one another.
const DEPENDENT: f64 = 1e-6;

/// The handles of a pose.
#[derive(Debug, Clone)]
pub(super) struct Constraint {
    /// The rows of `C`.
    rows: Vec<MeshPoint>,
    /// Where the handles are at rest.
    places: Vec<Point>,
    /// `L' C^T`: #vertices x #handles.
    response: Vec<f64>,
    /// Of the small matrix: (#handles + 1) squared.
    inverse: Vec<f64>,
}

impl Constraint {
    pub(super) fn new(shape: &RestShape, handles: &[Point]) -> Result<Self, HandleError> {
        let rows = located(shape, handles)?;
        let (count, vertex_count) = (rows.len(), shape.rest().len());
        let mut response = vec![0.0; vertex_count * count];
        let (mut buffer, mut right) = (Vec::new(), Vec::new());
        for (handle, row) in rows.iter().enumerate() {
            right.clear();
            right.resize(vertex_count, [0.0; 2]);
            for (&vertex, &share) in row.vertices.iter().zip(&row.shares) {
                right[vertex][0] = share;
            }
            shape.solve(&mut right, &mut buffer)?;
            for (vertex, [value, _]) in right.iter().enumerate() {
                response[vertex * count + handle] = *value;
            }
        }
        let small = DenseMatrix::from_fn(count + 1, count + 1, |row, column| {
            match (row < count, column < count) {
                (true, true) => {
                    let at = |v: usize| response[v * count + column];
                    let of = &rows[row];
                    of.vertices.iter().zip(of.shares).map(|(&v, share)| share * at(v)).sum()
                }
                (false, false) => 0.0,
                _ => 1.0,
            }
        });
        let inverse = inverse_of(&small)?;
        Ok(Self {
            places: handles.to_vec(),
            rows,
            response,
            inverse,
        })
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn rows(&self) -> &[MeshPoint] {
        &self.rows
    }

    pub(super) fn places(&self) -> &[Point] {
        &self.places
    }

    /// Makes `positions = L' b` the best fit that has the handles at `targets`. `small` is working space.
    pub(super) fn meet(&self, targets: &[Point], positions: &mut [[f64; 2]], small: &mut Vec<Point>) {
        let count = self.rows.len();
        small.clear();
        small.extend(self.rows.iter().zip(targets).map(|(row, target)| {
            let here = row.vertices.iter().zip(row.shares);
            target - here.map(|(&v, share)| Point::from(positions[v]) * share).sum::<Point>()
        }));
        for row in 0..=count {
            let inverse = &self.inverse[row * (count + 1)..row * (count + 1) + count];
            let value = inverse
                .iter()
                .zip(&small[..count])
                .map(|(i, missing)| missing * *i)
                .sum();
            small.push(value);
        }
        let (multipliers, shift) = (&small[count..2 * count], small[2 * count]);
        for (position, response) in positions.iter_mut().zip(self.response.chunks_exact(count)) {
            let pull: Point = response.iter().zip(multipliers).map(|(r, m)| m * *r).sum();
            *position = [position[0] + pull.x + shift.x, position[1] + pull.y + shift.y];
        }
    }
}

fn located(shape: &RestShape, handles: &[Point]) -> Result<Vec<MeshPoint>, HandleError> {
    let locator = PointLocator::new(shape.triangles(), shape.rest());
    let mut rows = Vec::with_capacity(handles.len());
    for (handle, &place) in handles.iter().enumerate() {
        let bad = || HandleError::BadPlace {
            handle,
            x: place.x,
            y: place.y,
        };
        if !point::is_finite(place) {
            return Err(bad());
        }
        let row = locator.bind(place).ok_or_else(bad)?;
        let nearest = row.at(shape.rest());
        let distance = (nearest - place).norm();
        if distance > OUTSIDE * shape.size() {
            // Half way to the middle of the triangle: certainly inside.
            let middle = geometry::corners(shape.rest(), row.vertices).iter().sum::<Point>() / 3.0;
            let inside = nearest + (middle - nearest) * 0.5;
            return Err(HandleError::Outside {
                handle,
                x: place.x,
                y: place.y,
                distance,
                nearest_x: inside.x,
                nearest_y: inside.y,
            });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// The inverse, row by row.
fn inverse_of(matrix: &DenseMatrix) -> Result<Vec<f64>, HandleError> {
    let size = matrix.row_count();
    let handle = size.saturating_sub(2);
    let identity = DenseMatrix::from_fn(size, size, |row, column| f64::from(u8::from(row == column)));
    let inverse = match SolvedDense::new(matrix).and_then(|factored| factored.solve(&identity)) {
        Ok(inverse) => inverse,
        Err(SolveError::Singular { .. }) => return Err(HandleError::Dependent { handle }),
        Err(other) => return Err(other.into()),
    };
    let error = matrix.times(&inverse)?.plus(-1.0, &identity)?;
    let places = || (0..size).flat_map(|row| (0..size).map(move |column| (row, column)));
    // NaN is no proof of independence either.
    let is_exact = places().all(|(row, column)| error.at(row, column).abs() < DEPENDENT);
    if !is_exact {
        return Err(HandleError::Dependent { handle });
    }
    Ok(places().map(|(row, column)| inverse.at(row, column)).collect())
}
