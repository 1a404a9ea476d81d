//! The triangle that each triangle of the mesh is mapped from.
//!
//! A reference triangle is given by its edge matrix, the columns being the edges from its first corner. Turning it
//! changes nothing in a blend: all its angles shift by one constant, and the weights sum to 1.
//!
//! Canonical reference: with `E_i` the edge matrix in pose `i` and `s_i` the square root of the pose's area, the
//! metric is `sum_i E_i^T E_i / s_i^2`, a mean in which a large drawing counts no more than a small one. Its factor
//! `L` with `L^T L` = metric is the triangular factor of the QR decomposition of the stacked `E_i / s_i`, found by
//! Gram-Schmidt: forming the metric first would square the condition of needle triangles.

use super::{BlendError, Reference};
use crate::math::{Matrix, Point};
use crate::mesh::geometry;
use crate::pose::PoseSet;

/// The edge matrix (positive determinant) of each triangle's reference.
///
/// # Errors
/// [`BlendError::NotPositive`] or [`BlendError::NoSuchPose`].
pub(super) fn reference_edges(poses: &PoseSet, reference: Reference) -> Result<Vec<Matrix>, BlendError> {
    let edges = match reference {
        Reference::Pose(pose) => {
            let positions = poses.positions().get(pose).ok_or(BlendError::NoSuchPose {
                pose,
                last: poses.len() - 1,
            })?;
            pose_edges(poses, positions)
        }
        Reference::Canonical => canonical_edges(poses),
    };
    let named = match reference {
        Reference::Pose(pose) => pose,
        Reference::Canonical => 0,
    };
    // NaN is not positive either.
    let is_positive = |edge: &Matrix| edge.determinant() > 0.0;
    match edges.iter().position(|edge| !is_positive(edge)) {
        Some(triangle) => Err(BlendError::NotPositive {
            pose: poses.names()[named].clone(),
            triangle,
        }),
        None => Ok(edges),
    }
}

/// The edge matrix of every triangle at `positions`.
pub(super) fn pose_edges(poses: &PoseSet, positions: &[Point]) -> Vec<Matrix> {
    poses
        .topology()
        .triangles()
        .iter()
        .map(|&triangle| geometry::edge_matrix(geometry::corners(positions, triangle)))
        .collect()
}

fn canonical_edges(poses: &PoseSet) -> Vec<Matrix> {
    let scales: Vec<f64> = poses
        .positions()
        .iter()
        .map(|positions| {
            let area: f64 = pose_edges(poses, positions).iter().map(Matrix::determinant).sum();
            area.sqrt().recip()
        })
        .collect();
    poses
        .topology()
        .triangles()
        .iter()
        .map(|&triangle| {
            let stacked: Vec<Matrix> = poses
                .positions()
                .iter()
                .zip(&scales)
                .map(|(positions, &scale)| geometry::edge_matrix(geometry::corners(positions, triangle)) * scale)
                .collect();
            let base = norm(stacked.iter().map(|edge| edge.column(0).into_owned()));
            let along: f64 = stacked
                .iter()
                .map(|edge| edge.column(0).dot(&edge.column(1)) / base)
                .sum();
            let height = norm(
                stacked
                    .iter()
                    .map(|edge| edge.column(1) - edge.column(0) * (along / base)),
            );
            Matrix::new(base, along, 0.0, height)
        })
        .collect()
}

/// The length of the vector that the points are the parts of.
fn norm(parts: impl Iterator<Item = Point>) -> f64 {
    parts.map(|part| part.norm_squared()).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;

    #[test]
    fn scaled_and_turned_copies_have_one_metric() {
        let topology = Topology::new(3, vec![[0, 1, 2]]).expect("a mesh");
        let triangle = [[0.0, 0.0], [2.0, 0.0], [0.5, 1.0]].map(Point::from).to_vec();
        let copy = triangle
            .iter()
            .map(|p| crate::math::rotation(1.0) * p * 7.0)
            .collect::<Vec<_>>();
        let poses = PoseSet::new(topology, vec![("a".into(), triangle), ("b".into(), copy)]).expect("poses");
        let edges = reference_edges(&poses, Reference::Canonical).expect("positive");
        // Twice a metric whose area determinant is 1.
        let expected = Matrix::new(2.0, 0.5, 0.0, 1.0) * (2.0_f64 / 2.0).sqrt();
        assert!((edges[0] - expected).norm() < 1e-14, "{}", edges[0]);
        assert!(reference_edges(&poses, Reference::Pose(2)).is_err());
    }
}
