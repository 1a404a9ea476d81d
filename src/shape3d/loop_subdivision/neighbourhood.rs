//! Who is next to whom on a triangle mesh: edges with what lies across them, rings around vertices. Indices only.

use super::SubdivisionError;

/// An edge of one or two triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Edge {
    /// The smaller and the larger end.
    pub(super) ends: [usize; 2],
    /// The third corner of its first triangle.
    pub(super) across: usize,
    /// The third corner of its second triangle; none on the boundary.
    pub(super) beyond: Option<usize>,
}

/// What surrounds a vertex.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Ring {
    /// No triangle has it.
    Isolated,
    /// Triangles all around: the neighbours in their order, positive as the triangles are.
    Closed(Vec<usize>),
    /// Triangles from one boundary edge to another: the neighbours in their order, both boundary ones included.
    Open(Vec<usize>),
    /// Several such fans that share only the vertex: the first of them.
    Pinned(Box<Ring>),
}

/// Edges and rings of a mesh.
#[derive(Debug)]
pub(super) struct Neighbourhood {
    /// By their ends.
    pub(super) edges: Vec<Edge>,
    /// For each triangle `a b c` the edges `a b`, `b c`, `c a`.
    pub(super) sides: Vec<[usize; 3]>,
    /// For each vertex.
    pub(super) rings: Vec<Ring>,
}

impl Neighbourhood {
    pub(super) fn new(vertex_count: usize, triangles: &[[usize; 3]]) -> Result<Self, SubdivisionError> {
        // For every side of a triangle: its ends in order, whether it runs from the smaller one, and the corner across.
        let mut half_edges: Vec<([usize; 2], bool, usize, usize, usize)> = Vec::with_capacity(3 * triangles.len());
        for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
            for (side, [from, to, across]) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
                half_edges.push(([from.min(to), from.max(to)], from < to, triangle, side, across));
            }
        }
        half_edges.sort_unstable();
        let mut edges: Vec<Edge> = Vec::with_capacity(half_edges.len() / 2);
        let mut sides = vec![[0; 3]; triangles.len()];
        for same in half_edges.chunk_by(|a, b| a.0 == b.0) {
            let ends = same[0].0;
            let beyond = match same {
                [_] => None,
                [first, second] if first.1 != second.1 => Some(second.4),
                [first, second] => {
                    return Err(SubdivisionError::Turned {
                        edge: ends,
                        triangles: [first.2, second.2],
                    });
                }
                _ => {
                    let mut triangles: Vec<usize> = same.iter().map(|half_edge| half_edge.2).collect();
                    triangles.sort_unstable();
                    return Err(SubdivisionError::Branching { edge: ends, triangles });
                }
            };
            for half_edge in same {
                sides[half_edge.2][half_edge.3] = edges.len();
            }
            edges.push(Edge {
                ends,
                across: same[0].4,
                beyond,
            });
        }
        // Around each vertex, from which neighbour to which a triangle goes.
        let mut fans: Vec<Vec<[usize; 2]>> = vec![Vec::new(); vertex_count];
        for &[a, b, c] in triangles {
            fans[a].push([b, c]);
            fans[b].push([c, a]);
            fans[c].push([a, b]);
        }
        Ok(Self {
            edges,
            sides,
            rings: fans.into_iter().map(ring_of).collect(),
        })
    }
}

/// Puts the triangles around a vertex in order. No neighbour is left twice, because no edge has two triangles on one side.
fn ring_of(mut fan: Vec<[usize; 2]>) -> Ring {
    if fan.is_empty() {
        return Ring::Isolated;
    }
    fan.sort_unstable();
    let is_reached = |neighbour: usize| fan.iter().any(|step| step[1] == neighbour);
    let start = fan
        .iter()
        .map(|step| step[0])
        .find(|&from| !is_reached(from))
        .unwrap_or(fan[0][0]);
    let mut neighbours = vec![start];
    let mut last = start;
    while let Ok(step) = fan.binary_search_by_key(&last, |step| step[0]) {
        last = fan[step][1];
        if last == start {
            break;
        }
        neighbours.push(last);
    }
    let (steps, is_closed) = if last == start {
        (neighbours.len(), true)
    } else {
        (neighbours.len() - 1, false)
    };
    let ring = if is_closed {
        Ring::Closed(neighbours)
    } else {
        Ring::Open(neighbours)
    };
    if steps < fan.len() {
        Ring::Pinned(Box::new(ring))
    } else {
        ring
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_of_a_fan_and_of_two_that_touch() {
        let open = Neighbourhood::new(4, &[[0, 2, 3], [0, 1, 2]]).expect("a mesh");
        assert_eq!(open.rings[0], Ring::Open(vec![1, 2, 3]));
        assert_eq!(open.rings[1], Ring::Open(vec![2, 0]));
        assert_eq!(open.edges.len(), 5);
        assert_eq!(
            open.edges[open.sides[0][0]],
            Edge {
                ends: [0, 2],
                across: 1,
                beyond: Some(3)
            }
        );
        let closed = Neighbourhood::new(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]]).expect("a mesh");
        assert_eq!(closed.rings[0], Ring::Closed(vec![1, 2, 3]));
        let touching = Neighbourhood::new(6, &[[0, 1, 2], [0, 3, 4]]).expect("a mesh");
        assert_eq!(touching.rings[0], Ring::Pinned(Box::new(Ring::Open(vec![1, 2]))));
        assert_eq!(touching.rings[5], Ring::Isolated);
    }

    #[test]
    fn what_is_not_a_surface_is_refused() {
        assert_eq!(
            Neighbourhood::new(4, &[[0, 1, 2], [0, 1, 3]]).expect_err("an error"),
            SubdivisionError::Turned {
                edge: [0, 1],
                triangles: [0, 1]
            }
        );
        let fins = Neighbourhood::new(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]).expect_err("an error");
        assert_eq!(
            fins.to_string(),
            "the edge of vertices 0 and 1 has 3 triangles (0, 1, 2)"
        );
    }
}
