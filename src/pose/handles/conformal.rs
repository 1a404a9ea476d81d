//! The conformal map through the handles: where a first drag begins.
//!
//! Source: Igarashi et al. 2005, first step; Lévy et al. 2002 (least-squares conformal maps). It minimises the distance of
//! every triangle from a *similar* one, which is linear, so rotations of any size are found at once; sizes come out wrong where
//! the handles ask for stretching, and only the rotations are used.
//!
//! In complex numbers `V = H' C^T lambda + c + s z` with the rest positions `z`, since similarities cost nothing; a
//! dense system of `#handles + 2` complex unknowns.

use super::HandleError;
use super::constraint::Constraint;
use super::rest::RestShape;
use crate::math::{Point, point};
use crate::solve::{DenseMatrix, SolvedDense};

/// The small system of the conformal map.
#[derive(Debug, Clone)]
pub(super) struct Conformal {
    /// `H' C^T`, a column a handle; `None` for a single handle, which only translates.
    columns: Option<(Vec<Vec<Point>>, SolvedDense)>,
    places: Vec<Point>,
}

impl Conformal {
    pub(super) fn new(shape: &RestShape, constraint: &Constraint) -> Result<Self, HandleError> {
        let places = constraint.places().to_vec();
        let count = places.len();
        if count < 2 {
            return Ok(Self { columns: None, places });
        }
        let mut columns = Vec::with_capacity(count);
        for row in constraint.rows() {
            let mut right = vec![Point::zeros(); shape.rest().len()];
            for (&vertex, &share) in row.vertices.iter().zip(&row.shares) {
                right[vertex].x = share;
            }
            columns.push(shape.solve_conformal(&right)?);
        }
        let origin = places[0];
        let reached: Vec<Vec<Point>> = (constraint.rows().iter())
            .map(|row| columns.iter().map(|column| row.at(column)).collect())
            .collect();
        let one = Point::new(1.0, 0.0);
        // Complex entries: rows are the handles, then the two conditions on the multipliers.
        let entry = |row: usize, column: usize| -> Point {
            match (row, column) {
                (row, column) if row < count && column < count => reached[row][column],
                (row, column) if row < count => [one, places[row] - origin][column - count],
                (row, column) if column < count => {
                    let z = places[column] - origin;
                    [one, Point::new(z.x, -z.y)][row - count]
                }
                _ => Point::zeros(),
            }
        };
        let small = DenseMatrix::from_fn(2 * count + 4, 2 * count + 4, |row, column| {
            let value = entry(row / 2, column / 2);
            match (row % 2, column % 2) {
                (0, 0) | (1, 1) => value.x,
                (1, _) => value.y,
                _ => -value.y,
            }
        });
        let solved = SolvedDense::new(&small).map_err(|_| HandleError::Dependent { handle: count - 1 })?;
        Ok(Self {
            columns: Some((columns, solved)),
            places,
        })
    }

    /// The conformal map that takes the handles to `targets`.
    pub(super) fn map(&self, shape: &RestShape, targets: &[Point]) -> Result<Vec<Point>, HandleError> {
        let Some((columns, small)) = &self.columns else {
            return Ok(shape.rigid_motion(&self.places, targets));
        };
        let count = self.places.len();
        let right = DenseMatrix::from_fn(2 * count + 4, 1, |row, _| match targets.get(row / 2) {
            Some(target) if row % 2 == 0 => target.x,
            Some(target) => target.y,
            None => 0.0,
        });
        let solution = small.solve(&right)?;
        let unknown = |k: usize| Point::new(solution.at(2 * k, 0), solution.at(2 * k + 1, 0));
        let times = |a: Point, b: Point| a * b.x + point::perpendicular(a) * b.y;
        let (shift, similarity) = (unknown(count), unknown(count + 1));
        let origin = self.places[0];
        let mut map: Vec<Point> = (shape.rest().iter())
            .map(|p| shift + times(similarity, p - origin))
            .collect();
        for (k, column) in columns.iter().enumerate() {
            let multiplier = unknown(k);
            for (position, response) in map.iter_mut().zip(column) {
                *position += times(multiplier, *response);
            }
        }
        Ok(map)
    }
}
