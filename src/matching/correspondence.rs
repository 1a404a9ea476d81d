//! The result of matching: N closed curves on one parameter.

use crate::math::wrapped;

/// Why rows of parameters are no correspondence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CorrespondenceError {
    /// Fewer than three rows, or rows of different lengths.
    #[error("a correspondence needs at least 3 rows of one parameter a pose; row {row} has {found} of {expected}")]
    BadRow {
        /// Which row.
        row: usize,
        /// How many parameters it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// The parameters of a pose do not run once around, forwards.
    #[error("on pose {pose} the parameters do not run once around: row {row} is not after its predecessor")]
    NotMonotone {
        /// Which pose.
        pose: usize,
        /// Which row.
        row: usize,
    },
}

/// Corresponding points on N closed curves (NWM 3.1, the mappings `f_i`): row `k` holds, for each pose, the normalised
/// arc-length parameter of the `k`-th corresponding point, in `[0, 1)`.
///
/// Guaranteed: on every pose the parameters increase strictly from row to row, cyclically, and run around exactly once.
/// Between rows the correspondence is linear in the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Correspondence {
    rows: Vec<Vec<f64>>,
}

impl Correspondence {
    /// A correspondence from its rows (#rows x #poses). Parameters are taken modulo 1.
    ///
    /// # Errors
    /// [`CorrespondenceError`] if a row is too short or a pose's parameters do not increase cyclically.
    pub fn new(mut rows: Vec<Vec<f64>>) -> Result<Self, CorrespondenceError> {
        let poses = rows.first().map_or(0, Vec::len);
        for (row, parameters) in rows.iter_mut().enumerate() {
            if parameters.len() != poses || poses == 0 {
                return Err(CorrespondenceError::BadRow {
                    row,
                    found: parameters.len(),
                    expected: poses,
                });
            }
            for t in parameters {
                // A tiny negative number is rounded to 1.
                *t = wrapped(*t);
                if *t >= 1.0 {
                    *t = 0.0;
                }
            }
        }
        if rows.len() < 3 {
            return Err(CorrespondenceError::BadRow {
                row: rows.len(),
                found: 0,
                expected: poses,
            });
        }
        for pose in 0..poses {
            let mut wraps = 0;
            for row in 0..rows.len() {
                let next = (row + 1) % rows.len();
                let (a, b) = (rows[row][pose], rows[next][pose]);
                wraps += usize::from(b < a);
                // Written so that NaN fails too.
                if !(a != b && a.is_finite() && b.is_finite()) || wraps > 1 {
                    return Err(CorrespondenceError::NotMonotone { pose, row: next });
                }
            }
        }
        Ok(Self { rows })
    }

    /// The correspondence of `poses` copies of one curve with itself, in `rows` even steps.
    #[must_use]
    pub fn identity(poses: usize, rows: usize) -> Self {
        let count = rows.max(3);
        Self {
            rows: (0..count)
                .map(|k| vec![k as f64 / count as f64; poses.max(1)])
                .collect(),
        }
    }

    /// The rows: #rows x #poses.
    #[must_use]
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    /// How many poses.
    #[must_use]
    pub fn pose_count(&self) -> usize {
        self.rows[0].len()
    }

    /// The row coordinate, in `[0, #rows)`, of parameter `t` on `pose`: its integer part is the row before `t`, its
    /// fraction how far `t` is towards the next row. Cost O(log #rows).
    #[must_use]
    pub fn row_coordinate(&self, pose: usize, t: f64) -> f64 {
        let t = wrapped(t);
        let count = self.rows.len();
        // The row where the parameters of this pose start over.
        let first = self.first_row(pose);
        let at = |k: usize| self.rows[(first + k) % count][pose];
        let (mut low, mut high) = (0, count);
        while low < high {
            let middle = (low + high) / 2;
            if at(middle) <= t {
                low = middle + 1
            } else {
                high = middle
            }
        }
        let before = (low + count - 1) % count;
        let (a, b) = (at(before), at((before + 1) % count));
        let along = wrapped(t - a) / wrapped(b - a);
        (((first + before) % count) as f64 + along.clamp(0.0, 1.0)).rem_euclid(count as f64)
    }

    /// The parameter on `pose` at a row coordinate (see [`Self::row_coordinate`]), in `[0, 1)`.
    #[must_use]
    pub fn parameter(&self, pose: usize, row_coordinate: f64) -> f64 {
        let count = self.rows.len();
        let coordinate = row_coordinate.rem_euclid(count as f64);
        let row = (coordinate.floor() as usize).min(count - 1);
        let (a, b) = (self.rows[row][pose], self.rows[(row + 1) % count][pose]);
        let t = wrapped(a + (coordinate - row as f64) * wrapped(b - a));
        if t >= 1.0 { 0.0 } else { t }
    }

    /// The parameter on pose `to` that corresponds to parameter `t` on pose `from`. Cost O(log #rows).
    #[must_use]
    pub fn carry(&self, from: usize, to: usize, t: f64) -> f64 {
        if from == to {
            return wrapped(t);
        }
        self.parameter(to, self.row_coordinate(from, t))
    }

    fn first_row(&self, pose: usize) -> usize {
        // The parameters increase cyclically with one wrap, so the smallest is found by bisection.
        let count = self.rows.len();
        let (mut low, mut high) = (0, count - 1);
        while low < high {
            let middle = (low + high) / 2;
            if self.rows[middle][pose] > self.rows[high][pose] {
                low = middle + 1
            } else {
                high = middle
            }
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shifted() -> Correspondence {
        Correspondence::new(vec![vec![0.0, 0.5], vec![0.3, 0.9], vec![0.6, 0.1], vec![0.9, 0.4]]).expect("monotone")
    }

    #[test]
    fn carry_is_exact_at_the_rows_and_linear_between() {
        let c = shifted();
        for row in c.rows() {
            assert!((c.carry(0, 1, row[0]) - row[1]).abs() < 1e-15);
            assert!((c.carry(1, 0, row[1]) - row[0]).abs() < 1e-15);
        }
        assert!((c.carry(0, 1, 0.15) - 0.7).abs() < 1e-15);
        assert!((c.carry(0, 1, 0.45) - 0.0).abs() < 1e-15);
        assert!((c.carry(0, 1, 0.95) - 0.45).abs() < 1e-15);
    }

    #[test]
    fn backward_and_double_turns_are_refused() {
        let backward = Correspondence::new(vec![vec![0.0], vec![0.6], vec![0.3]]);
        assert!(matches!(
            backward,
            Err(CorrespondenceError::NotMonotone { pose: 0, .. })
        ));
        let twice = Correspondence::new(vec![vec![0.0], vec![0.5], vec![0.0], vec![0.5]]);
        assert!(matches!(twice, Err(CorrespondenceError::NotMonotone { pose: 0, .. })));
    }

    proptest! {
        #[test]
        fn carrying_there_and_back_is_the_identity(t in 0.0..1.0f64) {
            let c = shifted();
            let back = c.carry(1, 0, c.carry(0, 1, t));
            let gap = (back - t).rem_euclid(1.0);
            prop_assert!(gap.min(1.0 - gap) < 1e-12);
        }
    }
}
