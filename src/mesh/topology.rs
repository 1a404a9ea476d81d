//! Which triangles share which vertices and edges. Positions never appear here.

use std::collections::BTreeMap;

/// Why triangles are no mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TopologyError {
    /// A triangle names a vertex that does not exist, or one vertex twice.
    #[error("triangle {triangle} has vertices {vertices:?}, but must have three different ones below {vertex_count}")]
    BadTriangle {
        /// Which triangle.
        triangle: usize,
        /// Its vertices.
        vertices: [usize; 3],
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// Two triangles run along the same directed edge: the mesh branches, or one is wound the other way.
    #[error("triangles {first} and {second} both run from vertex {from} to vertex {to}")]
    EdgeUsedTwice {
        /// A triangle.
        first: usize,
        /// Another.
        second: usize,
        /// Start of the edge.
        from: usize,
        /// End of the edge.
        to: usize,
    },
    /// A vertex belongs to no triangle, or its triangles form more than one fan.
    #[error("the triangles at vertex {vertex} form {fans} fans, not one")]
    NotOneFan {
        /// Which vertex.
        vertex: usize,
        /// How many fans: 0 for a vertex without triangles.
        fans: usize,
    },
}

/// The triangles of a mesh and how they adjoin. Guaranteed: every index is valid, each directed edge belongs to at
/// most one triangle, and the triangles at each vertex form one fan (so the mesh is a surface, possibly with boundary).
#[derive(Debug, Clone, PartialEq)]
pub struct Topology {
    vertex_count: usize,
    triangles: Vec<[usize; 3]>,
    /// For triangle t and corner k, the triangle across the edge from corner k to corner k + 1.
    neighbours: Vec<[Option<usize>; 3]>,
}

impl Topology {
    /// A mesh of `triangles` (#triangles x 3 vertex indices) on `vertex_count` vertices.
    ///
    /// # Errors
    /// [`TopologyError`] if the triangles are not a surface.
    pub fn new(vertex_count: usize, triangles: Vec<[usize; 3]>) -> Result<Self, TopologyError> {
        let mut owner = BTreeMap::new();
        for (triangle, &vertices) in triangles.iter().enumerate() {
            let [a, b, c] = vertices;
            if a == b || b == c || c == a || vertices.iter().any(|&v| v >= vertex_count) {
                return Err(TopologyError::BadTriangle {
                    triangle,
                    vertices,
                    vertex_count,
                });
            }
            for (from, to) in directed_edges(vertices) {
                if let Some(first) = owner.insert((from, to), triangle) {
                    return Err(TopologyError::EdgeUsedTwice {
                        first,
                        second: triangle,
                        from,
                        to,
                    });
                }
            }
        }
        let neighbours: Vec<[Option<usize>; 3]> = triangles
            .iter()
            .map(|&t| directed_edges(t).map(|(from, to)| owner.get(&(to, from)).copied()))
            .collect();
        let topology = Self {
            vertex_count,
            triangles,
            neighbours,
        };
        topology.check_fans()?;
        Ok(topology)
    }

    fn check_fans(&self) -> Result<(), TopologyError> {
        // A fan of k triangles around a vertex is joined by k - 1 shared edges (boundary) or k (interior), so the
        // number of fans is the number of boundary edges that start at the vertex, or one closed fan if none does
        // and walking around it visits every triangle.
        let mut triangles_at = vec![0_usize; self.vertex_count];
        let mut some_triangle = vec![None; self.vertex_count];
        let mut boundary_starts = vec![0_usize; self.vertex_count];
        for (t, vertices) in self.triangles.iter().enumerate() {
            for (k, &v) in vertices.iter().enumerate() {
                triangles_at[v] += 1;
                let starts_boundary = self.neighbours[t][k].is_none();
                boundary_starts[v] += usize::from(starts_boundary);
                if some_triangle[v].is_none() || starts_boundary {
                    some_triangle[v] = Some(t);
                }
            }
        }
        for vertex in 0..self.vertex_count {
            let Some(start) = some_triangle[vertex] else {
                return Err(TopologyError::NotOneFan { vertex, fans: 0 });
            };
            let mut visited = 1;
            let mut current = start;
            while let Some(next) = self.across_incoming(current, vertex).filter(|&t| t != start) {
                visited += 1;
                current = next;
            }
            if visited != triangles_at[vertex] {
                return Err(TopologyError::NotOneFan {
                    vertex,
                    fans: boundary_starts[vertex].max(2),
                });
            }
        }
        Ok(())
    }

    /// The triangle across the edge of `triangle` that runs into `vertex`.
    fn across_incoming(&self, triangle: usize, vertex: usize) -> Option<usize> {
        let corner = self.triangles[triangle].iter().position(|&v| v == vertex)?;
        self.neighbours[triangle][(corner + 2) % 3]
    }

    /// How many vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The triangles, three vertex indices each.
    #[must_use]
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// For each triangle and corner `k`, the triangle across the edge from corner `k` to corner `k + 1`.
    #[must_use]
    pub fn neighbours(&self) -> &[[Option<usize>; 3]] {
        &self.neighbours
    }

    /// The undirected edges `(a, b)` with `a < b`, sorted.
    #[must_use]
    pub fn edges(&self) -> Vec<(usize, usize)> {
        let mut edges: Vec<_> = self
            .triangles
            .iter()
            .flat_map(|&t| directed_edges(t).map(|(a, b)| undirected(a, b)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// By vertex, the vertices at the other ends of its edges, sorted.
    pub(crate) fn vertex_neighbours(&self) -> Vec<Vec<usize>> {
        let mut neighbours = vec![Vec::new(); self.vertex_count];
        for (a, b) in self.edges() {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        neighbours
    }

    /// The pairs `(t, u)` with `t < u` of triangles that share an edge, sorted.
    #[must_use]
    pub fn adjacent_triangles(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (t, around) in self.neighbours.iter().enumerate() {
            let mut later: Vec<_> = around.iter().flatten().copied().filter(|&u| u > t).collect();
            later.sort_unstable();
            pairs.extend(later.into_iter().map(|u| (t, u)));
        }
        pairs
    }

    /// The closed loops of boundary edges as vertex lists, each in the direction of its triangles and starting at its
    /// smallest vertex, ordered by that vertex.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<usize>> {
        let mut next = BTreeMap::new();
        for (t, &vertices) in self.triangles.iter().enumerate() {
            for (k, (from, to)) in directed_edges(vertices).into_iter().enumerate() {
                if self.neighbours[t][k].is_none() {
                    next.insert(from, to);
                }
            }
        }
        let mut loops = Vec::new();
        while let Some((start, mut current)) = next.pop_first() {
            let mut ring = vec![start];
            while current != start {
                ring.push(current);
                match next.remove(&current) {
                    Some(following) => current = following,
                    None => break,
                }
            }
            loops.push(ring);
        }
        loops
    }

    /// The triangles at each vertex, in increasing order.
    #[must_use]
    pub fn triangles_at_vertices(&self) -> Vec<Vec<usize>> {
        let mut at = vec![Vec::new(); self.vertex_count];
        for (t, vertices) in self.triangles.iter().enumerate() {
            for &v in vertices {
                at[v].push(t);
            }
        }
        at
    }

    /// The Euler characteristic V - E + F: 1 minus the number of holes for a connected plane mesh.
    #[must_use]
    pub fn euler_characteristic(&self) -> isize {
        self.vertex_count as isize - self.edges().len() as isize + self.triangles.len() as isize
    }

    /// The connected component of each triangle, numbered from 0 in the order of their first triangles.
    #[must_use]
    pub fn components(&self) -> Vec<usize> {
        let mut component = vec![usize::MAX; self.triangles.len()];
        let mut count = 0;
        for seed in 0..self.triangles.len() {
            if component[seed] != usize::MAX {
                continue;
            }
            component[seed] = count;
            let mut stack = vec![seed];
            while let Some(t) = stack.pop() {
                for u in self.neighbours[t].iter().flatten().copied() {
                    if component[u] == usize::MAX {
                        component[u] = count;
                        stack.push(u);
                    }
                }
            }
            count += 1;
        }
        component
    }
}

/// The three directed edges of a triangle; edge `k` runs from corner `k` to corner `k + 1`.
#[must_use]
pub(crate) fn directed_edges([a, b, c]: [usize; 3]) -> [(usize, usize); 3] {
    [(a, b), (b, c), (c, a)]
}

/// An edge by its ends whichever way it runs: the smaller number first.
pub(crate) fn undirected(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_make_a_square() {
        let mesh = Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
        assert_eq!(mesh.neighbours(), &[[None, None, Some(1)], [Some(0), None, None]]);
        assert_eq!(mesh.boundary_loops(), vec![vec![0, 1, 2, 3]]);
        assert_eq!(mesh.euler_characteristic(), 1);
        assert_eq!(mesh.adjacent_triangles(), vec![(0, 1)]);
    }

    #[test]
    fn defects_are_named() {
        let twice = Topology::new(4, vec![[0, 1, 2], [0, 1, 3]]);
        assert!(matches!(
            twice,
            Err(TopologyError::EdgeUsedTwice { from: 0, to: 1, .. })
        ));
        let bow_tie = Topology::new(5, vec![[0, 1, 2], [0, 3, 4]]);
        assert_eq!(bow_tie, Err(TopologyError::NotOneFan { vertex: 0, fans: 2 }));
        let unused = Topology::new(4, vec![[0, 1, 2]]);
        assert_eq!(unused, Err(TopologyError::NotOneFan { vertex: 3, fans: 0 }));
        let wrong = Topology::new(3, vec![[0, 1, 3]]);
        assert!(matches!(wrong, Err(TopologyError::BadTriangle { triangle: 0, .. })));
    }
}
