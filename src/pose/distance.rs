//! How far poses are from one another: the deformation between two embeddings of one mesh, as a number.
//!
//! Between poses `a` and `b` every triangle is mapped linearly; its map is a rotation by an angle times a stretch. The
//! distance is the root mean square, over the shape, of how these differ from one similarity of the whole:
//!
//! ```text
//! d(a, b)^2 = mean of |log stretch - mean scale|^2 + 2 (angle - mean angle)^2
//! ```
//!
//! that is, of the squared norm of the maps' logarithms. Means weigh triangles by their share of the area, averaged over
//! the two poses. Angles are those of one continuous turn: from triangle to triangle they differ by less than half a turn,
//! so that a limb which turns by 350 degrees is far from where it began.
//!
//! It is symmetric, 0 for similar poses, and does not change when a pose is moved, turned or scaled. It grows with how
//! far parts turn and how large they are; an arm that turns on counts in proportion to its angle. It converges under
//! refinement of the mesh.
//!
//! Limits: it is no metric in the strict sense (the triangle inequality can fail by the rotation of stretch axes), and needs
//! none of that where it is used, for laying poses out.
//!
//! Cost: O(#poses^2 #triangles).

use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

use super::PoseSet;
use crate::math::{Matrix, PolarSplit};
use crate::mesh::{Topology, geometry};

/// The distances between all poses (#poses x #poses), symmetric with zeros on the diagonal.
///
/// ```
/// use inbetween::{math::Point, mesh::Topology, pose::{PoseSet, deformation_distances}};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let place = |width: f64| [[0.0, 0.0], [width, 0.0], [0.0, 1.0]].map(Point::from).to_vec();
/// let topology = Topology::new(3, vec![[0, 1, 2]])?;
/// let poses = PoseSet::new(topology, vec![("a".to_owned(), place(1.0)), ("b".to_owned(), place(4.0))])?;
/// let distances = deformation_distances(&poses);
/// // Twice as wide and half as high as a similar triangle: log 2 in both directions.
/// assert!((distances[0][1] - 2f64.sqrt() * 2f64.ln()).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn deformation_distances(poses: &PoseSet) -> Vec<Vec<f64>> {
    let count = poses.len();
    let order = walk(poses.topology());
    let mut distances = vec![vec![0.0; count]; count];
    for (a, b) in (0..count).flat_map(|a| (0..a).map(move |b| (a, b))) {
        let distance = between(poses, &order, a, b);
        distances[a][b] = distance;
        distances[b][a] = distance;
    }
    distances
}

/// Every triangle with the neighbour that is visited before it, in an order that visits that one first.
fn walk(topology: &Topology) -> Vec<(usize, Option<usize>)> {
    let neighbours = topology.neighbours();
    let mut order = Vec::with_capacity(neighbours.len());
    let mut seen = vec![false; neighbours.len()];
    for start in 0..neighbours.len() {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut queue = VecDeque::from([(start, None)]);
        while let Some((triangle, before)) = queue.pop_front() {
            order.push((triangle, before));
            for &next in neighbours[triangle].iter().flatten() {
                if !seen[next] {
                    seen[next] = true;
                    queue.push_back((next, Some(triangle)));
                }
            }
        }
    }
    order
}

fn between(poses: &PoseSet, order: &[(usize, Option<usize>)], a: usize, b: usize) -> f64 {
    let triangles = poses.topology().triangles();
    let corners = |pose: usize, triangle: usize| geometry::corners(&poses.positions()[pose], triangles[triangle]);
    let whole = |pose: usize| -> f64 {
        (0..triangles.len())
            .map(|t| geometry::signed_area(corners(pose, t)))
            .sum()
    };
    let (whole_a, whole_b) = (whole(a), whole(b));
    // Share of the area, rotation, and logarithm of the stretch of each triangle.
    let mut maps = vec![(0.0, 0.0, Matrix::zeros()); triangles.len()];
    for &(t, before) in order {
        let (from, to) = (corners(a, t), corners(b, t));
        let Some(inverse) = geometry::edge_matrix(from).try_inverse() else {
            continue;
        };
        let split = PolarSplit::of(&(geometry::edge_matrix(to) * inverse));
        let angle = match before {
            // Within half a turn of its neighbour.
            Some(before) => {
                let close: f64 = maps[before].1;
                close + (split.angle_rad - close + PI).rem_euclid(TAU) - PI
            }
            None => split.angle_rad,
        };
        let share = 0.5 * (geometry::signed_area(from) / whole_a + geometry::signed_area(to) / whole_b);
        if let Some(logarithm) = logarithm(&split.stretch) {
            maps[t] = (share, angle, logarithm);
        }
    }
    let weight: f64 = maps.iter().map(|(share, ..)| share).sum();
    let mean = |of: &dyn Fn(&(f64, f64, Matrix)) -> f64| maps.iter().map(|map| map.0 * of(map)).sum::<f64>() / weight;
    let mean_angle = mean(&|(_, angle, _)| *angle);
    let mean_scale = mean(&|(_, _, stretch)| 0.5 * stretch.trace());
    let square = mean(&|(_, angle, stretch)| {
        let stretched = stretch - Matrix::identity() * mean_scale;
        stretched.norm_squared() + 2.0 * (angle - mean_angle) * (angle - mean_angle)
    });
    // NaN only without any triangle that has area: no difference can be told.
    square.max(0.0).sqrt()
}

/// The logarithm of a symmetric matrix; `None` unless it is positive definite.
fn logarithm(stretch: &Matrix) -> Option<Matrix> {
    let (mean, half) = (0.5 * stretch.trace(), 0.5 * (stretch.m11 - stretch.m22));
    let radius = half.hypot(stretch.m12);
    let (high, low) = (mean + radius, mean - radius);
    if !(low > 0.0 && high.is_finite()) {
        return None;
    }
    let (middle, spread) = (0.5 * (high * low).ln(), 0.5 * (high / low).ln());
    let unit = if radius > 0.0 { spread / radius } else { 0.0 };
    Some(Matrix::identity() * middle + (stretch - Matrix::identity() * mean) * unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Point, matrix};

    /// A strip of `2 n` triangles along x, bent by `bend(x)`: the angle that the strip has turned by at x.
    fn strip(cells: usize, bend: impl Fn(f64) -> f64) -> Vec<Point> {
        let mut middle = Point::zeros();
        let step = 8.0 / cells as f64;
        let mut points = Vec::new();
        for k in 0..=cells {
            let x = k as f64 * step;
            let across = matrix::rotation(bend(x)) * Point::new(0.0, 0.1);
            points.extend([middle - across, middle + across]);
            middle += matrix::rotation(bend(x + 0.5 * step)) * Point::new(step, 0.0);
        }
        points
    }

    fn strips(cells: usize, bends: &[&dyn Fn(f64) -> f64]) -> PoseSet {
        let triangles = (0..cells).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]]);
        let topology = Topology::new(2 * cells + 2, triangles.collect()).expect("a mesh");
        let poses = bends
            .iter()
            .enumerate()
            .map(|(k, bend)| (format!("p{k}"), strip(cells, bend)));
        PoseSet::new(topology, poses.collect()).expect("poses")
    }

    #[test]
    fn similar_poses_are_no_distance_apart() {
        let set = strips(10, &[&|x| 0.2 * x, &|_| 0.0]);
        let moved = |pose: usize, scale: f64, angle: f64| {
            let map = |p: &Point| matrix::rotation(angle) * p * scale + Point::new(3.0, -7.0);
            set.positions()[pose].iter().map(map).collect::<Vec<_>>()
        };
        let poses = vec![
            ("bent".to_owned(), set.positions()[0].clone()),
            ("turned".to_owned(), moved(0, 3.0, 2.5)),
            ("straight".to_owned(), set.positions()[1].clone()),
            ("small".to_owned(), moved(1, 0.1, -1.0)),
        ];
        let distances = deformation_distances(&PoseSet::new(set.topology().clone(), poses).expect("poses"));
        assert!(distances[0][1] < 1e-12 && distances[2][3] < 1e-12);
        for (a, b) in [(0, 3), (1, 2), (1, 3)] {
            assert!((distances[a][b] - distances[0][2]).abs() < 1e-12);
            assert_eq!(distances[a][b], distances[b][a]);
        }
    }

    #[test]
    fn a_part_that_turns_on_is_ever_further_away_beyond_a_whole_turn() {
        // The second half turns against the first by the given angle, spread over a quarter of the length.
        let turned = |angle: f64| move |x: f64| angle * ((x - 3.0) / 2.0).clamp(0.0, 1.0);
        let bends: Vec<_> = [0.0, 1.0, 2.0, 4.0, 6.5].map(turned).into_iter().collect();
        let bends: Vec<&dyn Fn(f64) -> f64> = bends.iter().map(|bend| bend as &dyn Fn(f64) -> f64).collect();
        let distances = deformation_distances(&strips(160, &bends));
        let unit = distances[0][1];
        for (pose, angle) in [(2, 2.0), (3, 4.0), (4, 6.5)] {
            let ratio = distances[0][pose] / unit;
            assert!((ratio / angle - 1.0).abs() < 0.05, "{ratio} for {angle}");
        }
        // The mesh hardly matters.
        let coarse = deformation_distances(&strips(80, &bends));
        assert!((coarse[0][3] / distances[0][3] - 1.0).abs() < 0.02);
    }
}
