//! What holds the blend in place: the translation of every connected piece of the mesh.
//!
//! The energy sees shapes only, so each piece can be moved as a whole. Its anchor says where it goes: the piece's
//! centroid or one of its vertices is put exactly where it is wanted, by moving the piece. Soft anchors are terms of
//! the energy itself, `stiffness |position - wanted|^2`: several pull at once, and the shape gives way between them.
//!
//! Without a word from the caller an anchor is wanted at the weighted mean of where it is in the poses.
//!
//! A stiffness has no unit: the energy `sum area |J - A|^2` of a drawing does not change with its size in the reference,
//! and grows with the square of lengths in the frame, as the anchors' terms do. At 1 an anchor counts about as much as
//! the shape of the triangles around it.

use super::{Anchor, BlendError};
use crate::math::Point;
use crate::pose::PoseSet;

/// The anchors of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Anchors {
    /// Piece of each vertex.
    piece_of_vertex: Vec<usize>,
    pieces: Vec<Piece>,
    soft: Vec<Soft>,
}

#[derive(Debug, Clone)]
struct Piece {
    hold: Hold,
    /// #poses: where the anchor is in each pose; empty for [`Hold::Soft`].
    in_poses: Vec<Point>,
}

#[derive(Debug, Clone)]
enum Hold {
    /// Weights of vertices that sum to 1: a centroid, or one vertex.
    At(Vec<(usize, f64)>),
    /// Soft anchors decide.
    Soft,
}

#[derive(Debug, Clone)]
struct Soft {
    vertex: usize,
    stiffness: f64,
    in_poses: Vec<Point>,
}

impl Anchors {
    /// The anchors of `poses` by `anchor`; `areas` are those of the reference triangles, which weigh the centroid.
    ///
    /// # Errors
    /// [`BlendError::NoSuchVertex`] or [`BlendError::BadOption`].
    pub(super) fn new(poses: &PoseSet, areas: &[f64], anchor: &Anchor) -> Result<Self, BlendError> {
        let topology = poses.topology();
        let vertex_count = topology.vertex_count();
        let existing = |vertex: usize| {
            if vertex < vertex_count {
                Ok(vertex)
            } else {
                Err(BlendError::NoSuchVertex {
                    vertex,
                    count: vertex_count,
                })
            }
        };
        let triangle_pieces = topology.components();
        let piece_count = triangle_pieces.iter().max().map_or(0, |last| last + 1);
        let mut piece_of_vertex = vec![0; vertex_count];
        let mut vertex_areas = vec![0.0; vertex_count];
        let mut piece_areas = vec![0.0; piece_count];
        for ((triangle, &piece), area) in topology.triangles().iter().zip(&triangle_pieces).zip(areas) {
            piece_areas[piece] += area;
            for &vertex in triangle {
                piece_of_vertex[vertex] = piece;
                vertex_areas[vertex] += area / 3.0;
            }
        }
        let mut holds: Vec<Hold> = (0..piece_count).map(|_| Hold::At(Vec::new())).collect();
        for (vertex, (&piece, area)) in piece_of_vertex.iter().zip(&vertex_areas).enumerate() {
            if let Hold::At(weights) = &mut holds[piece] {
                weights.push((vertex, area / piece_areas[piece]));
            }
        }
        let mut soft = Vec::new();
        match anchor {
            Anchor::Centroid => {}
            Anchor::Point(vertex) => holds[piece_of_vertex[existing(*vertex)?]] = Hold::At(vec![(*vertex, 1.0)]),
            Anchor::Soft(anchors) => {
                for of in anchors {
                    holds[piece_of_vertex[existing(of.point)?]] = Hold::Soft;
                    if !(of.stiffness > 0.0 && of.stiffness.is_finite()) {
                        return Err(BlendError::BadOption {
                            option: "the stiffness of an anchor",
                            value: of.stiffness,
                            must_be: "a positive number",
                        });
                    }
                    soft.push(Soft {
                        vertex: of.point,
                        stiffness: of.stiffness,
                        in_poses: poses.positions().iter().map(|positions| positions[of.point]).collect(),
                    });
                }
            }
        }
        let pieces = holds.into_iter().map(|hold| Piece {
            in_poses: poses
                .positions()
                .iter()
                .filter_map(|positions| hold.place(positions))
                .collect(),
            hold,
        });
        Ok(Self {
            pieces: pieces.collect(),
            piece_of_vertex,
            soft,
        })
    }

    /// How many anchors a frame may move: the soft ones if there are any, otherwise one for each piece.
    pub(super) fn count(&self) -> usize {
        if self.soft.is_empty() {
            self.pieces.len()
        } else {
            self.soft.len()
        }
    }

    /// The vertex of each piece that is no unknown, because nothing in the energy says where the piece is.
    pub(super) fn pinned_vertices(&self) -> impl Iterator<Item = usize> + '_ {
        self.pieces.iter().filter_map(|piece| match &piece.hold {
            Hold::At(weights) => weights.first().map(|(vertex, _)| *vertex),
            Hold::Soft => None,
        })
    }

    /// The soft anchors, vertex and stiffness.
    pub(super) fn stiffnesses(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.soft.iter().map(|soft| (soft.vertex, soft.stiffness))
    }

    /// What the soft anchors add to the right-hand side: vertex, and stiffness times the wanted place.
    pub(super) fn pulls<'a>(
        &'a self,
        weights: &'a [f64],
        moved: &'a [Option<Point>],
    ) -> impl Iterator<Item = (usize, Point)> + 'a {
        self.soft.iter().enumerate().map(move |(k, soft)| {
            let wanted = moved
                .get(k)
                .copied()
                .flatten()
                .unwrap_or_else(|| mean(&soft.in_poses, weights));
            (soft.vertex, wanted * soft.stiffness)
        })
    }

    /// Moves each piece that no soft anchor holds to where its anchor is wanted.
    pub(super) fn place(&self, weights: &[f64], moved: &[Option<Point>], positions: &mut [Point]) {
        let moved = if self.soft.is_empty() { moved } else { &[] };
        for (k, piece) in self.pieces.iter().enumerate() {
            let Some(here) = piece.hold.place(positions) else {
                continue;
            };
            let wanted = moved
                .get(k)
                .copied()
                .flatten()
                .unwrap_or_else(|| mean(&piece.in_poses, weights));
            let by = wanted - here;
            if self.pieces.len() == 1 {
                positions.iter_mut().for_each(|position| *position += by);
            } else {
                let own = positions
                    .iter_mut()
                    .zip(&self.piece_of_vertex)
                    .filter(|(_, of)| **of == k);
                own.for_each(|(position, _)| *position += by);
            }
        }
    }
}

impl Hold {
    /// Where what is held is.
    fn place(&self, positions: &[Point]) -> Option<Point> {
        match self {
            Self::At(weights) => Some(weights.iter().map(|&(vertex, weight)| positions[vertex] * weight).sum()),
            Self::Soft => None,
        }
    }
}

fn mean(places: &[Point], weights: &[f64]) -> Point {
    places
        .iter()
        .zip(weights)
        .fold(Point::zeros(), |sum, (place, &weight)| sum + place * weight)
}
