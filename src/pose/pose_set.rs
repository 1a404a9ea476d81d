//! One triangulation, N embeddings.

use crate::math::Point;
use crate::mesh::Topology;

/// Why positions are no pose set.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PoseSetError {
    /// There is no pose.
    #[error("a pose set needs at least one pose")]
    NoPose,
    /// A pose has the wrong number of vertices.
    #[error("pose '{pose}' has {found} vertices, the mesh {expected}")]
    WrongVertexCount {
        /// Its name.
        pose: String,
        /// Its vertices.
        found: usize,
        /// The mesh's vertices.
        expected: usize,
    },
    /// Two poses have the same name.
    #[error("two poses are named '{0}'")]
    SameName(String),
}

/// N poses of one mesh: a shared topology and, per pose, a name and #vertices positions.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseSet {
    topology: Topology,
    names: Vec<String>,
    positions: Vec<Vec<Point>>,
}

impl PoseSet {
    /// A pose set from `(name, positions)` pairs.
    ///
    /// # Errors
    /// [`PoseSetError`] if there is no pose, a count differs or a name repeats.
    pub fn new(topology: Topology, poses: Vec<(String, Vec<Point>)>) -> Result<Self, PoseSetError> {
        if poses.is_empty() {
            return Err(PoseSetError::NoPose);
        }
        let (names, positions): (Vec<_>, Vec<_>) = poses.into_iter().unzip();
        for (k, (name, vertices)) in names.iter().zip(&positions).enumerate() {
            if vertices.len() != topology.vertex_count() {
                return Err(PoseSetError::WrongVertexCount {
                    pose: name.clone(),
                    found: vertices.len(),
                    expected: topology.vertex_count(),
                });
            }
            if names[..k].contains(name) {
                return Err(PoseSetError::SameName(name.clone()));
            }
        }
        Ok(Self {
            topology,
            names,
            positions,
        })
    }

    /// How many poses.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a pose set is never empty")]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// The shared triangles.
    #[must_use]
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The names, in pose order.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The positions of each pose: #poses x #vertices.
    #[must_use]
    pub fn positions(&self) -> &[Vec<Point>] {
        &self.positions
    }

    /// The index of the pose named `name`.
    #[must_use]
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|n| n == name)
    }
}
