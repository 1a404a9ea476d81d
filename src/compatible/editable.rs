//! A triangulation of N poses under local change: rings are re-triangulated, edges flipped and split, vertices moved.

use super::CompatibleMesh;
use crate::math::{Point, predicate};
use crate::mesh::{Topology, TopologyError};

/// What of a mesh has a meaning beyond its triangles, as vertex indices.
#[derive(Debug, Clone)]
pub(super) struct Curves {
    /// The boundary, outer ring first.
    pub(super) rings: Vec<Vec<usize>>,
    /// Single vertices.
    pub(super) landmarks: Vec<usize>,
    /// Chains of edges.
    pub(super) paths: Vec<Vec<usize>>,
}

/// N embeddings of one changing set of triangles.
#[derive(Debug, Clone)]
pub(super) struct EditableMesh {
    /// Per pose, per vertex.
    pub(super) positions: Vec<Vec<Point>>,
    /// Triangles; `None` where one was removed.
    triangles: Vec<Option<[usize; 3]>>,
    /// The triangles at each vertex, in no order.
    at_vertex: Vec<Vec<usize>>,
    free: Vec<usize>,
}

impl EditableMesh {
    pub(super) fn new(positions: Vec<Vec<Point>>, triangles: &[[usize; 3]]) -> Self {
        let vertex_count = positions.first().map_or(0, Vec::len);
        let mut mesh = Self {
            positions,
            triangles: Vec::new(),
            at_vertex: vec![Vec::new(); vertex_count],
            free: Vec::new(),
        };
        for &triangle in triangles {
            mesh.add(triangle);
        }
        mesh
    }

    pub(super) fn pose_count(&self) -> usize {
        self.positions.len()
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.at_vertex.len()
    }

    pub(super) fn corners(&self, pose: usize, triangle: [usize; 3]) -> [Point; 3] {
        triangle.map(|v| self.positions[pose][v])
    }

    /// Whether the triangle is positive in every pose. Exact.
    pub(super) fn is_positive(&self, triangle: [usize; 3]) -> bool {
        (0..self.pose_count()).all(|pose| {
            let [a, b, c] = self.corners(pose, triangle);
            predicate::is_positive(a, b, c)
        })
    }

    pub(super) fn triangles(&self) -> impl Iterator<Item = (usize, [usize; 3])> + '_ {
        self.triangles
            .iter()
            .enumerate()
            .filter_map(|(t, triangle)| triangle.map(|triangle| (t, triangle)))
    }

    pub(super) fn triangles_at(&self, vertex: usize) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.at_vertex[vertex].iter().filter_map(|&t| self.triangles[t])
    }

    pub(super) fn degree(&self, vertex: usize) -> usize {
        self.at_vertex[vertex].len()
    }

    /// The corner opposite the directed edge `a b` in the triangle that runs along it.
    pub(super) fn opposite(&self, a: usize, b: usize) -> Option<usize> {
        self.triangles_at(a).find_map(|triangle| {
            let corner = triangle.iter().position(|&v| v == a)?;
            (triangle[(corner + 1) % 3] == b).then(|| triangle[(corner + 2) % 3])
        })
    }

    /// The neighbours of an interior vertex in positive order; `None` if it is on the boundary.
    pub(super) fn ring(&self, vertex: usize) -> Option<Vec<usize>> {
        let first = self.triangles_at(vertex).next()?;
        let corner = first.iter().position(|&v| v == vertex)?;
        let start = first[(corner + 1) % 3];
        let mut ring = vec![start];
        let mut current = start;
        for _ in 0..self.degree(vertex) {
            current = self.opposite(vertex, current)?;
            if current == start {
                return Some(ring);
            }
            ring.push(current);
        }
        None
    }

    pub(super) fn add(&mut self, triangle: [usize; 3]) {
        let t = match self.free.pop() {
            Some(t) => {
                self.triangles[t] = Some(triangle);
                t
            }
            None => {
                self.triangles.push(Some(triangle));
                self.triangles.len() - 1
            }
        };
        for v in triangle {
            self.at_vertex[v].push(t);
        }
    }

    /// Removes all triangles at `vertex`.
    pub(super) fn remove_star(&mut self, vertex: usize) {
        for t in self.at_vertex[vertex].clone() {
            self.remove(t);
        }
    }

    /// Removes the triangle with the directed edge `a b`.
    pub(super) fn remove_at_edge(&mut self, a: usize, b: usize) {
        let found = self.at_vertex[a].iter().copied().find(|&t| {
            self.triangles[t].is_some_and(|triangle| {
                let corner = triangle.iter().position(|&v| v == a).unwrap_or(0);
                triangle[(corner + 1) % 3] == b
            })
        });
        if let Some(t) = found {
            self.remove(t);
        }
    }

    fn remove(&mut self, t: usize) {
        if let Some(triangle) = self.triangles[t].take() {
            for v in triangle {
                self.at_vertex[v].retain(|&other| other != t);
            }
            self.free.push(t);
        }
    }

    /// A new vertex with its place in every pose.
    pub(super) fn add_vertex(&mut self, places: impl IntoIterator<Item = Point>) -> usize {
        for (positions, place) in self.positions.iter_mut().zip(places) {
            positions.push(place);
        }
        self.at_vertex.push(Vec::new());
        self.at_vertex.len() - 1
    }

    /// The mesh with unused vertices dropped and the others renumbered in their order.
    pub(super) fn finish(self, curves: &Curves, steiner: usize) -> Result<CompatibleMesh, TopologyError> {
        let mut renumbered = vec![usize::MAX; self.vertex_count()];
        let mut count = 0;
        for (v, triangles) in self.at_vertex.iter().enumerate() {
            if !triangles.is_empty() {
                renumbered[v] = count;
                count += 1;
            }
        }
        let triangles = self
            .triangles
            .iter()
            .flatten()
            .map(|t| t.map(|v| renumbered[v]))
            .collect();
        let positions = self
            .positions
            .iter()
            .map(|pose| {
                pose.iter()
                    .zip(&self.at_vertex)
                    .filter(|(_, at)| !at.is_empty())
                    .map(|(p, _)| *p)
                    .collect()
            })
            .collect();
        let chain = |vertices: &Vec<usize>| vertices.iter().map(|&v| renumbered[v]).collect();
        let rings = curves.rings.iter().map(chain).collect();
        let paths = curves.paths.iter().map(chain).collect();
        let landmarks = chain(&curves.landmarks);
        Ok(CompatibleMesh {
            topology: Topology::new(count, triangles)?,
            positions,
            rings,
            landmarks,
            paths,
            steiner,
        })
    }
}
