//! The affine map that carries an element best: what its gradients follow.

use crate::input::{Placement, Subpath};
use crate::math::{Matrix, Point};

/// Shares of the points' spread below which they lie on a line, across which nothing is known.
const THINNEST: f64 = 1e-9;

/// The points of an element in one drawing, ready to be compared with where they are in a frame.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    points: Vec<Point>,
    centroid: Point,
    /// Of the points' second moments about the centroid.
    inverse_moments: Matrix,
}

impl Fit {
    pub(super) fn new(points: Vec<Point>) -> Self {
        let centroid = points.iter().sum::<Point>() / points.len().max(1) as f64;
        let mut moments: Matrix = points.iter().map(|p| (p - centroid) * (p - centroid).transpose()).sum();
        // On a line, as if it were a thin band.
        let spread = moments.trace();
        moments += Matrix::identity() * (THINNEST * spread);
        Self {
            points,
            centroid,
            inverse_moments: moments.try_inverse().unwrap_or_else(Matrix::zeros),
        }
    }

    /// The affine map from the drawing to the frame whose distances to the points of `subpaths` are least in the sum of squares.
    pub(super) fn to(&self, subpaths: &[Subpath]) -> Placement {
        let carried = || subpaths.iter().flat_map(Subpath::points);
        let centroid = carried().sum::<Point>() / self.points.len().max(1) as f64;
        let mixed: Matrix = self
            .points
            .iter()
            .zip(carried())
            .map(|(from, to)| (to - centroid) * (from - self.centroid).transpose())
            .sum();
        let map = mixed * self.inverse_moments;
        Placement {
            along_x: map.column(0).into(),
            along_y: map.column(1).into(),
            origin: centroid - map * self.centroid,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_affine_image_is_followed_exactly() {
        let points: Vec<Point> = [[1.0, 2.0], [5.0, 3.0], [4.0, 9.0], [0.0, 7.0]]
            .map(Point::from)
            .to_vec();
        let map = Matrix::new(2.0, 0.5, -1.0, 1.5);
        let carried: Vec<Point> = points.iter().map(|p| map * p + Point::new(10.0, -4.0)).collect();
        let subpath = Subpath {
            start: carried[0],
            cubics: vec![[carried[1], carried[2], carried[3]]],
            is_closed: false,
        };
        let found = Fit::new(points).to(&[subpath]);
        let expected = map * Point::new(3.0, 3.0) + Point::new(10.0, -4.0);
        assert!((found.place(Point::new(3.0, 3.0)) - expected).norm() < 1e-6);
    }
}
