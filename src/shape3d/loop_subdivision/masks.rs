//! Loop's masks as rows of sparse matrices: refinement, limit positions, limit tangents.
//!
//! Interior: Loop 1987, sections 3 and 4. Boundary: cubic B-spline of the boundary's vertices, as in Hoppe et al. 1994,
//! "Piecewise smooth surface reconstruction"; its tangents are the left eigenvectors of these very rules, since the masks given
//! there belong to rules of their own next to boundary vertices whose valence is not regular. A vertex at which several fans
//! meet stays where it is.

use std::f64::consts::{PI, TAU};

use sprs::{CsMat, TriMat};

use super::neighbourhood::{Neighbourhood, Ring};

/// The matrix of one step (#finer vertices x #vertices): first the vertices, then one vertex an edge.
pub(super) fn refinement(mesh: &Neighbourhood) -> CsMat<f64> {
    let count = mesh.rings.len();
    let mut entries = TriMat::new((count + mesh.edges.len(), count));
    for (vertex, ring) in mesh.rings.iter().enumerate() {
        match ring {
            Ring::Closed(neighbours) => {
                let share = vertex_share(neighbours.len());
                entries.add_triplet(vertex, vertex, 1.0 - share * neighbours.len() as f64);
                for &neighbour in neighbours {
                    entries.add_triplet(vertex, neighbour, share);
                }
            }
            Ring::Open(neighbours) => {
                entries.add_triplet(vertex, vertex, 0.75);
                for neighbour in ends_of(neighbours) {
                    entries.add_triplet(vertex, neighbour, 0.125);
                }
            }
            Ring::Isolated | Ring::Pinned(_) => entries.add_triplet(vertex, vertex, 1.0),
        }
    }
    for (index, edge) in mesh.edges.iter().enumerate() {
        let row = count + index;
        let along = if edge.beyond.is_some() { 0.375 } else { 0.5 };
        for end in edge.ends {
            entries.add_triplet(row, end, along);
        }
        if let Some(beyond) = edge.beyond {
            entries.add_triplet(row, edge.across, 0.125);
            entries.add_triplet(row, beyond, 0.125);
        }
    }
    entries.to_csr()
}

/// The matrix from vertices to their places on the limit surface.
pub(super) fn limit_positions(mesh: &Neighbourhood) -> CsMat<f64> {
    let count = mesh.rings.len();
    let mut entries = TriMat::new((count, count));
    for (vertex, ring) in mesh.rings.iter().enumerate() {
        match ring {
            Ring::Closed(neighbours) => {
                let valence = neighbours.len();
                let share = 1.0 / (0.375 / vertex_share(valence) + valence as f64);
                entries.add_triplet(vertex, vertex, 1.0 - share * valence as f64);
                for &neighbour in neighbours {
                    entries.add_triplet(vertex, neighbour, share);
                }
            }
            Ring::Open(neighbours) => {
                entries.add_triplet(vertex, vertex, 2.0 / 3.0);
                for neighbour in ends_of(neighbours) {
                    entries.add_triplet(vertex, neighbour, 1.0 / 6.0);
                }
            }
            Ring::Isolated | Ring::Pinned(_) => entries.add_triplet(vertex, vertex, 1.0),
        }
    }
    entries.to_csr()
}

/// The matrices from vertices to two tangents of the limit surface, whose cross product points to the side from which the
/// triangles are positive.
pub(super) fn limit_tangents(mesh: &Neighbourhood) -> [CsMat<f64>; 2] {
    let count = mesh.rings.len();
    let mut entries = [TriMat::new((count, count)), TriMat::new((count, count))];
    for (vertex, ring) in mesh.rings.iter().enumerate() {
        let ring = match ring {
            Ring::Pinned(first) => first,
            whole => whole,
        };
        let [along, inwards] = &mut entries;
        match ring {
            Ring::Closed(neighbours) => {
                for (index, &neighbour) in neighbours.iter().enumerate() {
                    let (sin, cos) = libm::sincos(TAU * index as f64 / neighbours.len() as f64);
                    along.add_triplet(vertex, neighbour, cos);
                    inwards.add_triplet(vertex, neighbour, sin);
                }
            }
            Ring::Open(neighbours) => {
                let [first, last] = ends_of(neighbours);
                along.add_triplet(vertex, first, 1.0);
                along.add_triplet(vertex, last, -1.0);
                let shares = inward_shares(neighbours.len());
                inwards.add_triplet(vertex, vertex, shares.own);
                for neighbour in [first, last] {
                    inwards.add_triplet(vertex, neighbour, shares.boundary);
                }
                for (index, &neighbour) in neighbours.iter().enumerate() {
                    if neighbour != first && neighbour != last {
                        inwards.add_triplet(vertex, neighbour, libm::sin(shares.step_rad * index as f64));
                    }
                }
            }
            Ring::Isolated | Ring::Pinned(_) => {}
        }
    }
    entries.map(|matrix| matrix.to_csr())
}

/// What each neighbour of an interior vertex counts in a step.
pub(super) fn vertex_share(valence: usize) -> f64 {
    let valence = valence as f64;
    let inner = 0.375 + 0.25 * libm::cos(TAU / valence);
    (0.625 - inner * inner) / valence
}

/// What the tangent into the surface is made of at a boundary vertex.
struct InwardShares {
    own: f64,
    /// Of either neighbour on the boundary.
    boundary: f64,
    /// The neighbour number `i` inside has the sine of `i` times this.
    step_rad: f64,
}

/// The left eigenvector of the step around a boundary vertex with `count` neighbours that is the same from both sides, for the
/// largest eigenvalue below 1. Inside it is a sine, because an edge's vertex sees only the neighbours beside it; the eigenvalue
/// is `3/8 + cos(step) / 4`; the two other numbers follow from the columns of the boundary neighbours and of the vertex.
fn inward_shares(count: usize) -> InwardShares {
    if count <= 2 {
        // Nothing inside: the second derivative of the spline, eigenvalue 1/4.
        return InwardShares {
            own: -2.0,
            boundary: 1.0,
            step_rad: 0.0,
        };
    }
    let step_rad = PI / (count - 1) as f64;
    let eigenvalue = 0.375 + 0.25 * libm::cos(step_rad);
    let sum: f64 = (1..count - 1).map(|index| libm::sin(step_rad * index as f64)).sum();
    // (1/2 - e) boundary + own / 8 = -sin(step) / 8 and boundary + (3/4 - e) own = -3/8 sum. The determinant is 0 for the
    // eigenvalues 1/4 and 1 of the spline, and e is from 3/8 to 5/8.
    let (a, b, right) = (0.5 - eigenvalue, 0.75 - eigenvalue, -0.125 * libm::sin(step_rad));
    let determinant = a * b - 0.125;
    InwardShares {
        own: (-0.375 * sum * a - right) / determinant,
        boundary: (right * b + 0.375 * 0.125 * sum) / determinant,
        step_rad,
    }
}

/// The neighbours on the boundary.
fn ends_of(neighbours: &[usize]) -> [usize; 2] {
    match neighbours {
        [first, .., last] => [*first, *last],
        _ => [0, 0],
    }
}
