//! Where the poses are.

use super::{WeightError, check_place};

/// Poses nearer to one another than this fraction of the layout's diagonal share one place: the weights would change
/// from 0 to 1 over a distance that nobody can point at, and the systems lose their digits.
const COINCIDENCE: f64 = 1e-6;

/// The places of the poses: at least one, all of one dimension, finite and distinct.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    places: Vec<Vec<f64>>,
    dimension: usize,
}

impl Layout {
    pub(super) fn new(places: &[Vec<f64>]) -> Result<Self, WeightError> {
        let dimension = places.first().ok_or(WeightError::NoPose)?.len();
        for place in places {
            check_place(place, dimension)?;
        }
        let layout = Self {
            places: places.to_vec(),
            dimension,
        };
        let closest = COINCIDENCE * layout.diagonal();
        for (first, place) in places.iter().enumerate() {
            let same = (first + 1..places.len()).find(|&other| distance(place, &places[other]) <= closest);
            if let Some(second) = same {
                return Err(WeightError::Coincident { first, second });
            }
        }
        Ok(layout)
    }

    pub(super) fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    pub(super) fn dimension(&self) -> usize {
        self.dimension
    }

    /// Lowest and highest corner of the bounding box.
    pub(super) fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        let fold = |start: f64, pick: fn(f64, f64) -> f64| {
            (0..self.dimension)
                .map(|k| self.places.iter().map(|place| place[k]).fold(start, pick))
                .collect()
        };
        (fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max))
    }

    /// The diagonal of the bounding box; 0 for one pose.
    pub(super) fn diagonal(&self) -> f64 {
        let (low, high) = self.bounds();
        distance(&low, &high)
    }
}

/// The Euclidean distance.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}
