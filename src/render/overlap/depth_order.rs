//! In which order the regions of a figure that lies over itself are painted.
//!
//! What is known is which region lies in front of which, pose by pose. In a frame the poses vote: each counts as much as its drawing is seen, and what has the least
//! behind it that is still to come is painted next. So a frame at a pose has the order of that pose, and where the poses contradict one another the one that is seen
//! most decides.

/// What the weight of a shape counts beside that of its drawing.
const FAINT: f64 = 1e-6;

/// Which regions of a mesh lie in front of which, pose by pose.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DepthOrder {
    pub(super) count: usize,
    /// By pose, #regions x #regions: 1 where the first lies in front of the second, -1 behind it, 0 where they do not meet.
    pub(super) in_front: Vec<Vec<i8>>,
}

impl DepthOrder {
    /// The order of `count` regions: by pose, #regions x #regions, row by row, positive where the region of the row lies in front of that of the column, negative where it
    /// lies behind it, 0 where they do not meet. `None` if a pose has another number of entries.
    #[must_use]
    pub fn new(count: usize, in_front: Vec<Vec<i8>>) -> Option<Self> {
        let is_whole = |known: &Vec<i8>| Some(known.len()) == count.checked_mul(count);
        let in_front: Option<Vec<Vec<i8>>> = (in_front.into_iter())
            .map(|known| is_whole(&known).then(|| known.iter().map(|sign| sign.signum()).collect()))
            .collect();
        Some(Self {
            count,
            in_front: in_front?,
        })
    }

    /// How many regions there are.
    #[must_use]
    pub fn region_count(&self) -> usize {
        self.count
    }

    /// By pose, #regions x #regions, row by row: 1 where the region of the row lies in front of that of the column, -1 where it lies behind it, 0 where they do not meet.
    #[must_use]
    pub fn in_front(&self) -> &[Vec<i8>] {
        &self.in_front
    }

    /// The regions from back to front in a frame whose shape is blended with `weights`, and its drawings with `texture_weights`, one a pose.
    #[must_use]
    pub fn from_back_to_front(&self, weights: &[f64], texture_weights: &[f64]) -> Vec<usize> {
        let count = self.count;
        // Where no drawing of a pose that lies over itself is seen, its shape may count all the same.
        let counts = (texture_weights.iter().zip(weights)).map(|(seen, own)| seen + FAINT * own.max(0.0));
        let mut front = vec![0.0; count * count];
        for (known, weight) in self.in_front.iter().zip(counts).filter(|(_, weight)| *weight > 0.0) {
            for (sum, sign) in front.iter_mut().zip(known) {
                *sum += weight * f64::from(*sign);
            }
        }
        let mut left: Vec<usize> = (0..count).collect();
        let mut order = Vec::with_capacity(count);
        while !left.is_empty() {
            // What has the least behind it that is still to come; of equal ones the first.
            let behind = |region: usize| -> f64 {
                let others = left.iter().filter(|other| **other != region);
                others.map(|other| front[region * count + other].max(0.0)).sum()
            };
            let least = (0..left.len()).min_by(|a, b| behind(left[*a]).total_cmp(&behind(left[*b])));
            order.push(left.remove(least.unwrap_or(0)));
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pose_that_is_seen_most_decides_what_lies_in_front() {
        // The first region lies in front of the others in the first pose, behind the second one in the second, and the third pose knows nothing.
        let order = DepthOrder::new(
            3,
            vec![
                vec![0, 1, 1, -1, 0, 0, -1, 0, 0],
                vec![0, -9, 0, 9, 0, 0, 0, 0, 0],
                vec![0; 9],
            ],
        )
        .expect("three regions");
        assert_eq!(order.from_back_to_front(&[1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]), [1, 2, 0]);
        assert_eq!(order.from_back_to_front(&[0.0, 1.0, 0.0], &[0.0, 1.0, 0.0]), [0, 1, 2]);
        assert_eq!(order.from_back_to_front(&[0.5, 0.5, 0.0], &[0.4, 0.6, 0.0]), [2, 0, 1]);
        // Where the drawings that are seen do not tell, the shape does.
        assert_eq!(order.from_back_to_front(&[0.2, 0.0, 0.8], &[0.0, 0.0, 1.0]), [1, 2, 0]);
        assert_eq!(DepthOrder::new(2, vec![vec![0; 3]]), None);
    }
}
