//! Proof that a mesh at given positions is embedded: nothing inverted, nothing overlapping, the boundary as stated.
//!
//! Every triangle is positive by an exact predicate, and the boundary rings are simple, disjoint and nested. Then the
//! boundary winds once around each interior point and never around an exterior one, and since positive triangles
//! cover each point as often as the boundary winds around it, each interior point is covered exactly once.

use super::{Topology, geometry};
use crate::math::{Point, predicate};
use crate::outline::{Outline, OutlineError, Ring, RingError};

/// What is wrong with a mesh at its positions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ValidityError {
    /// The number of positions is not the number of vertices.
    #[error("{positions} positions for {vertices} vertices")]
    WrongCount {
        /// Positions given.
        positions: usize,
        /// Vertices of the topology.
        vertices: usize,
    },
    /// A triangle is inverted or flat.
    #[error("triangle {triangle} {vertices:?} is not positive near ({x:.6}, {y:.6})")]
    NotPositive {
        /// Which triangle.
        triangle: usize,
        /// Its vertices.
        vertices: [usize; 3],
        /// Its first corner.
        x: f64,
        /// Its first corner.
        y: f64,
    },
    /// The triangles around an inner vertex go around it more than once.
    #[error(
        "the triangles around vertex {vertex} go around it {turns} times near ({x:.6}, {y:.6}): the mesh is folded there"
    )]
    Winds {
        /// Which vertex.
        vertex: usize,
        /// How often.
        turns: usize,
        /// Where it is.
        x: f64,
        /// Where it is.
        y: f64,
    },
    /// The boundary edges of the triangles are not the stated rings.
    #[error("the boundary of the triangles is not ring {ring}: edge {from} -> {to} is {}", if *missing { "missing" } else { "not in any ring" })]
    WrongBoundary {
        /// Which ring, or the number of rings for an edge in none.
        ring: usize,
        /// Start of the edge.
        from: usize,
        /// End of the edge.
        to: usize,
        /// Whether the ring states the edge and the mesh lacks it.
        missing: bool,
    },
    /// A boundary ring is degenerate.
    #[error("boundary ring {ring}: {source}")]
    BadRing {
        /// Which ring.
        ring: usize,
        /// Why.
        source: RingError,
    },
    /// The boundary rings cross, touch or are not nested.
    #[error("the mesh boundary is not simple: {0}")]
    BoundaryNotSimple(#[from] OutlineError),
}

/// Proves that the mesh at `positions` (#vertices) is embedded, with `rings[0]` as its outer boundary and the further
/// rings as its holes.
///
/// Cost O(n log n).
///
/// # Errors
/// The first defect found, as a [`ValidityError`].
pub fn check_embedding(topology: &Topology, positions: &[Point], rings: &[Vec<usize>]) -> Result<(), ValidityError> {
    check_immersion(topology, positions, rings)?;
    let mut curves = Vec::with_capacity(rings.len());
    for (ring, vertices) in rings.iter().enumerate() {
        let curve = Ring::new(vertices.iter().map(|&v| positions[v]))
            .map_err(|source| ValidityError::BadRing { ring, source })?;
        curves.push(curve);
    }
    let outer = curves.remove(0);
    Outline::new(outer, curves)?;
    Ok(())
}

/// Proves what can be proven of a mesh at `positions` that may lie over itself: every triangle is positive, those around an inner vertex go around it once,
/// so that the map is one to one near every point inside, and `rings` are its boundary.
///
/// # Errors
/// The first defect found, as a [`ValidityError`].
pub fn check_immersion(topology: &Topology, positions: &[Point], rings: &[Vec<usize>]) -> Result<(), ValidityError> {
    if positions.len() != topology.vertex_count() {
        return Err(ValidityError::WrongCount {
            positions: positions.len(),
            vertices: topology.vertex_count(),
        });
    }
    check_boundary(topology, rings)?;
    for (triangle, &vertices) in topology.triangles().iter().enumerate() {
        let [a, b, c] = geometry::corners(positions, vertices);
        if !predicate::is_positive(a, b, c) {
            return Err(ValidityError::NotPositive {
                triangle,
                vertices,
                x: a.x,
                y: a.y,
            });
        }
    }
    match first_winding(topology, positions) {
        Some((vertex, turns)) => Err(ValidityError::Winds {
            vertex,
            turns,
            x: positions[vertex].x,
            y: positions[vertex].y,
        }),
        None => Ok(()),
    }
}

/// The first inner vertex that the triangles around it, all of them positive, go around more than once, and how often.
pub(crate) fn first_winding(topology: &Topology, positions: &[Point]) -> Option<(usize, usize)> {
    let mut angles_rad = vec![0.0; positions.len()];
    for &vertices in topology.triangles() {
        let of_corners = geometry::angles_rad(geometry::corners(positions, vertices));
        for (v, angle_rad) in vertices.into_iter().zip(of_corners) {
            angles_rad[v] += angle_rad;
        }
    }
    let mut is_inner = vec![true; positions.len()];
    for v in topology.boundary_loops().into_iter().flatten() {
        is_inner[v] = false;
    }
    // The sum is a whole number of turns, but for rounding.
    (0..positions.len())
        .map(|v| (v, (angles_rad[v] / std::f64::consts::TAU).round() as usize))
        .find(|(v, turns)| is_inner[*v] && *turns > 1)
}

fn check_boundary(topology: &Topology, rings: &[Vec<usize>]) -> Result<(), ValidityError> {
    use std::collections::BTreeSet;
    let stated = |ring: &Vec<usize>| {
        let mut closed = ring.clone();
        closed.extend(ring.first());
        closed.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>()
    };
    let mut boundary: BTreeSet<(usize, usize)> = topology.boundary_loops().iter().flat_map(stated).collect();
    for (ring, vertices) in rings.iter().enumerate() {
        for (from, to) in stated(vertices) {
            if !boundary.remove(&(from, to)) {
                return Err(ValidityError::WrongBoundary {
                    ring,
                    from,
                    to,
                    missing: true,
                });
            }
        }
    }
    match boundary.first() {
        Some(&(from, to)) => Err(ValidityError::WrongBoundary {
            ring: rings.len(),
            from,
            to,
            missing: false,
        }),
        None if rings.is_empty() => Err(ValidityError::WrongBoundary {
            ring: 0,
            from: 0,
            to: 0,
            missing: true,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Topology, Vec<Point>) {
        let topology = Topology::new(5, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]).expect("a mesh");
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]]
            .map(Point::from)
            .to_vec();
        (topology, positions)
    }

    #[test]
    fn a_vertex_that_is_gone_around_twice_is_found() {
        // Eight triangles a quarter of a turn each.
        let triangles = (0..8).map(|k| [8, k, (k + 1) % 8]).collect();
        let topology = Topology::new(9, triangles).expect("a mesh");
        let rings = vec![(0..8).collect::<Vec<usize>>()];
        let around = |turn: f64| Point::new(turn.cos(), turn.sin());
        let places = |turns: f64| {
            let rim = (0..8).map(|k| around(std::f64::consts::TAU * turns * f64::from(k) / 8.0));
            rim.chain([Point::zeros()]).collect::<Vec<Point>>()
        };
        assert_eq!(check_immersion(&topology, &places(1.0), &rings), Ok(()));
        let error = check_immersion(&topology, &places(2.0), &rings).expect_err("it goes around twice");
        assert!(
            matches!(
                error,
                ValidityError::Winds {
                    vertex: 8,
                    turns: 2,
                    ..
                }
            ),
            "{error}"
        );
    }

    #[test]
    fn a_square_is_proven_and_an_inversion_is_found() {
        let (topology, mut positions) = square();
        let rings = vec![vec![0, 1, 2, 3]];
        assert_eq!(check_embedding(&topology, &positions, &rings), Ok(()));
        positions[4] = Point::new(0.5, 0.0);
        let error = check_embedding(&topology, &positions, &rings).expect_err("triangle 0 is flat");
        assert!(
            matches!(error, ValidityError::NotPositive { triangle: 0, .. }),
            "{error}"
        );
    }

    #[test]
    fn a_ring_that_is_not_the_boundary_is_found() {
        let (topology, positions) = square();
        let error = check_embedding(&topology, &positions, &[vec![0, 1, 2]]).expect_err("2 -> 0 is missing");
        assert!(
            matches!(
                error,
                ValidityError::WrongBoundary {
                    from: 2,
                    to: 0,
                    missing: true,
                    ..
                }
            ),
            "{error}"
        );
        assert!(check_embedding(&topology, &positions, &[]).is_err());
    }

    #[test]
    fn a_strip_wound_over_itself_is_found() {
        // All triangles of this spiral are positive, but it overlaps itself after more than a turn.
        let columns = 26;
        let angle = |i: usize| std::f64::consts::TAU * 1.3 * i as f64 / (columns - 1) as f64;
        let circle = |r: f64| (0..columns).map(move |i| Point::new(r * angle(i).cos(), r * angle(i).sin()));
        let positions: Vec<Point> = circle(1.0).chain(circle(2.0)).collect();
        let triangles = (0..columns - 1)
            .flat_map(|i| [[i, columns + i, columns + i + 1], [i, columns + i + 1, i + 1]])
            .collect();
        let topology = Topology::new(2 * columns, triangles).expect("a mesh");
        let rings = topology.boundary_loops();
        let error = check_embedding(&topology, &positions, &rings).expect_err("it overlaps");
        assert!(matches!(error, ValidityError::BoundaryNotSimple(_)), "{error}");
    }
}
