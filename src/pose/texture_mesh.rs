//! A finer mesh whose vertices are places of the drawings.

use crate::math::Point;
use crate::mesh::{MeshPoint, Topology};

/// A mesh for the drawings' pictures, carried by the mesh of a mapping: each of its vertices is a place of every drawing, the same drawn thing in
/// all, which need not be the same place of the mesh.
///
/// At a pose it lies on the pose's drawing as the mesh does, so a frame there is the drawing; between them lines that are in two drawings become
/// one line.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureMesh {
    topology: Topology,
    anchors: Vec<Vec<MeshPoint>>,
}

impl TextureMesh {
    /// A mesh whose vertices are, in every pose of a mapping, where `anchors` says on that mapping's mesh. `None` if a pose has more or fewer of them
    /// than the mesh has vertices.
    #[must_use]
    pub fn new(topology: Topology, anchors: Vec<Vec<MeshPoint>>) -> Option<Self> {
        let fits = |of_pose: &Vec<MeshPoint>| of_pose.len() == topology.vertex_count();
        anchors.iter().all(fits).then_some(Self { topology, anchors })
    }

    /// Which vertices form triangles.
    #[must_use]
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Where the vertices are on the mapping's mesh, one list a pose.
    #[must_use]
    pub fn anchors(&self) -> &[Vec<MeshPoint>] {
        &self.anchors
    }

    /// Where the vertices are on the drawing of a pose whose mesh is at `positions`.
    #[must_use]
    pub fn on_drawing(&self, pose: usize, positions: &[Point]) -> Vec<Point> {
        self.anchors[pose].iter().map(|anchor| anchor.at(positions)).collect()
    }

    /// Where the vertices are in the shape whose mesh is at `positions`, blended with `weights`, one a pose, that sum to 1.
    #[must_use]
    pub fn at(&self, positions: &[Point], weights: &[f64]) -> Vec<Point> {
        let mut places = vec![Point::zeros(); self.topology.vertex_count()];
        for (anchors, weight) in self.anchors.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            for (place, anchor) in places.iter_mut().zip(anchors) {
                *place += anchor.at(positions) * *weight;
            }
        }
        places
    }
}
