//! The edge of a region: where the figure ends it is the blended outline, where the region goes on in others it is edges of the mesh.
//!
//! A region reaches a little way into its neighbours, so that no seam shows between them: both show the same there.

use std::collections::{BTreeMap, BTreeSet};

use crate::math::Point;
use crate::mesh::directed_edges;

/// A closed polygon, of rows of the silhouette and vertices of the mesh.
#[derive(Debug, Clone, Default)]
pub(super) struct Rim {
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    /// Ring and row of the silhouette.
    Row(usize, usize),
    Vertex(usize),
}

impl Rim {
    /// Where it is when the silhouette's rings and the vertices are there.
    pub(super) fn at(&self, rings: &[Vec<Point>], positions: &[Point]) -> Vec<Point> {
        let place = |node: &Node| match *node {
            Node::Row(ring, row) => rings.get(ring).and_then(|ring| ring.get(row)).copied(),
            Node::Vertex(v) => positions.get(v).copied(),
        };
        self.nodes.iter().filter_map(place).collect()
    }
}

/// Where the boundary of a mesh is beside the rows of its silhouette: by vertex of the boundary its ring and the row nearest to it.
#[derive(Debug)]
pub(super) struct Boundary {
    row_of: BTreeMap<usize, (usize, usize)>,
    rows: Vec<usize>,
    /// Edges without a triangle on the other side.
    edges: BTreeMap<usize, usize>,
}

impl Boundary {
    /// `rings` are the mesh's; `silhouette` the rings of the outline and `positions` the vertices in one pose that does not lie over itself.
    pub(super) fn new(rings: &[Vec<usize>], silhouette: &[Vec<Point>], positions: &[Point]) -> Self {
        let mut row_of = BTreeMap::new();
        let mut edges = BTreeMap::new();
        for (ring, (vertices, rows)) in rings.iter().zip(silhouette).enumerate() {
            for (k, v) in vertices.iter().enumerate() {
                edges.insert(*v, vertices[(k + 1) % vertices.len()]);
            }
            for (v, row) in vertices.iter().zip(rows_along(vertices, rows, positions)) {
                row_of.insert(*v, (ring, row));
            }
        }
        Self {
            row_of,
            rows: silhouette.iter().map(Vec::len).collect(),
            edges,
        }
    }

    /// The rims of a set of triangles.
    pub(super) fn rims(&self, triangles: &[[usize; 3]]) -> Vec<Rim> {
        boundary_loops(triangles).iter().map(|edges| self.rim(edges)).collect()
    }

    fn rim(&self, edges: &[(usize, usize)]) -> Rim {
        let mut nodes = Vec::new();
        // An edge of the mesh's boundary stands for the rows beside it, one inside for its end.
        for (k, (a, b)) in edges.iter().enumerate() {
            let on_boundary = self.edges.get(a) == Some(b);
            // A rim inside may touch the boundary in a vertex alone.
            let (next, after) = edges[(k + 1) % edges.len()];
            let goes_on_inside = self.edges.get(&next) != Some(&after);
            match (on_boundary, self.row_of.get(a), self.row_of.get(b)) {
                (true, Some(&(ring, from)), Some(&(_, to))) => {
                    let count = self.rows[ring];
                    let steps = (to + count - from) % count;
                    nodes.extend((0..=steps).map(|k| Node::Row(ring, (from + k) % count)));
                }
                (false, _, None) => nodes.push(Node::Vertex(*b)),
                (false, _, Some(_)) if goes_on_inside => nodes.push(Node::Vertex(*b)),
                (true, _, _) => nodes.push(Node::Vertex(*b)),
                _ => (),
            }
        }
        Rim { nodes }
    }
}

/// The edges of a set of triangles that have none on the other side, loop by loop; a loop may meet a vertex twice.
pub(super) fn boundary_loops(triangles: &[[usize; 3]]) -> Vec<Vec<(usize, usize)>> {
    let mut next: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let directed: BTreeSet<(usize, usize)> = triangles.iter().flat_map(|t| directed_edges(*t)).collect();
    for &(a, b) in directed.iter().filter(|(a, b)| !directed.contains(&(*b, *a))) {
        next.entry(a).or_default().push(b);
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.iter().find(|(_, ends)| !ends.is_empty()) {
        let (mut loop_, mut at) = (Vec::new(), start);
        while let Some(end) = next.get_mut(&at).and_then(Vec::pop) {
            loop_.push((at, end));
            at = end;
        }
        loops.push(loop_);
    }
    loops
}

/// By vertex of a ring of the mesh, the row of the silhouette beside it, in order around the ring.
fn rows_along(vertices: &[usize], rows: &[Point], positions: &[Point]) -> Vec<usize> {
    let count = rows.len();
    if count == 0 || vertices.is_empty() {
        return Vec::new();
    }
    let place = |v: usize| positions[vertices[v % vertices.len()]];
    let distance = |row: usize, p: Point| (rows[row % count] - p).norm_squared();
    // The vertex that has the silhouette nearest to it is surely beside that.
    let nearest_of = |v: usize| {
        let best = (0..count).min_by(|a, b| distance(*a, place(v)).total_cmp(&distance(*b, place(v))));
        best.unwrap_or(0)
    };
    let first = (0..vertices.len()).min_by(|a, b| {
        let of = |v: usize| distance(nearest_of(v), place(v));
        of(*a).total_cmp(&of(*b))
    });
    let first = first.unwrap_or(0);
    let mut along = vec![0; vertices.len()];
    let start = nearest_of(first);
    along[first] = start;
    let mut row = start;
    for k in 1..vertices.len() {
        let v = first + k;
        // As far along the silhouette as along the mesh, and half of that more or less.
        let edge = (place(v) - place(v - 1)).norm();
        let (mut travelled, mut best) = (0.0, (row, distance(row, place(v))));
        let mut at = row;
        // Never past where it began.
        while at + 1 < start + count && travelled <= 2.0 * edge {
            at += 1;
            travelled += (rows[at % count] - rows[(at - 1) % count]).norm();
            let here = distance(at, place(v));
            if here < best.1 {
                best = (at, here);
            }
        }
        row = best.0;
        along[v % vertices.len()] = row % count;
    }
    along
}
