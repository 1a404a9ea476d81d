//! How good the triangles of a mapping are.

use super::PoseSet;
use crate::mesh::geometry;

/// Angles and stretches of one triangulation over all its poses.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MeshQuality {
    /// The smallest angle of any triangle in any pose, in degrees.
    pub smallest_angle_deg: f64,
    /// The 5th percentile over the triangles of each one's smallest angle in any pose, in degrees.
    pub low_angle_deg: f64,
    /// The median [stretch](geometry::stretch) over all triangles and all pairs of poses; 1 for a single pose.
    pub median_stretch: f64,
    /// The largest of those stretches.
    pub largest_stretch: f64,
}

impl MeshQuality {
    /// Measures a pose set. Cost O(#triangles x #poses^2).
    ///
    /// # Examples
    /// ```
    /// use inbetween::{math::Point, mesh::Topology, pose::{MeshQuality, PoseSet}};
    /// let place = |width: f64| [[0.0, 0.0], [width, 0.0], [0.0, 1.0]].map(Point::from).to_vec();
    /// let topology = Topology::new(3, vec![[0, 1, 2]])?;
    /// let poses = PoseSet::new(topology, vec![("a".to_owned(), place(1.0)), ("b".to_owned(), place(3.0))])?;
    /// let quality = MeshQuality::of(&poses);
    /// assert!((quality.largest_stretch - 3.0).abs() < 1e-12);
    /// assert!((quality.smallest_angle_deg - (1.0f64 / 3.0).atan().to_degrees()).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn of(poses: &PoseSet) -> Self {
        let triangles = poses.topology().triangles();
        let corners = |pose: usize, triangle: &[usize; 3]| geometry::corners(&poses.positions()[pose], *triangle);
        let angles = geometry::worst_angles_deg(poses.positions(), triangles);
        let mut stretches: Vec<f64> = (0..poses.len())
            .flat_map(|to| (0..to).map(move |from| (from, to)))
            .flat_map(|(from, to)| {
                let between = move |triangle| geometry::stretch(corners(from, triangle), corners(to, triangle));
                triangles.iter().map(between)
            })
            .collect();
        let largest = stretches.iter().copied().reduce(f64::max);
        let middle = stretches.len() / 2;
        let median = (!stretches.is_empty()).then(|| *stretches.select_nth_unstable_by(middle, f64::total_cmp).1);
        Self {
            smallest_angle_deg: angles.first().copied().unwrap_or(0.0),
            low_angle_deg: angles.get(angles.len() / 20).copied().unwrap_or(0.0),
            median_stretch: median.unwrap_or(1.0),
            largest_stretch: largest.unwrap_or(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Matrix, Point, matrix};
    use crate::mesh::Topology;

    /// A square of two triangles in three poses: itself, turned and doubled, and twice as wide.
    fn squares() -> PoseSet {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point::from);
        let moved = |map: Matrix| square.iter().map(|p| map * p).collect::<Vec<_>>();
        PoseSet::new(
            Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh"),
            vec![
                ("itself".to_owned(), moved(Matrix::identity())),
                ("turned".to_owned(), moved(matrix::rotation(0.7) * 2.0)),
                ("wide".to_owned(), moved(Matrix::new(2.0, 0.0, 0.0, 1.0))),
            ],
        )
        .expect("poses")
    }

    #[test]
    fn turning_and_growing_is_no_stretch_and_twice_the_width_is_two() {
        let quality = MeshQuality::of(&squares());
        // Of the three pairs of poses one is similar (1), two differ by the width (2).
        assert!((quality.median_stretch - 2.0).abs() < 1e-12);
        assert!((quality.largest_stretch - 2.0).abs() < 1e-12);
        let least = 0.5f64.atan().to_degrees();
        assert!((quality.smallest_angle_deg - least).abs() < 1e-12);
        assert!((quality.low_angle_deg - least).abs() < 1e-12);
    }

    #[test]
    fn one_pose_is_not_stretched() {
        let one = squares();
        let alone = PoseSet::new(
            one.topology().clone(),
            vec![("alone".to_owned(), one.positions()[0].clone())],
        );
        let quality = MeshQuality::of(&alone.expect("a pose"));
        assert_eq!((quality.median_stretch, quality.largest_stretch), (1.0, 1.0));
        assert!((quality.smallest_angle_deg - 45.0).abs() < 1e-12);
    }
}
