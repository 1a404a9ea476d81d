//! The divide and conquer itself: a piece is triangulated, or divided into smaller ones, until none is left.
//!
//! 1. A piece of more than [`LARGEST_PIECE`] vertices is divided along a short balanced common diagonal.
//! 2. Others are triangulated by common diagonals, or divided by those that leave the least to Steiner points.
//! 3. A *stuck* piece is one without any common diagonal. If all vertices see one point, that is its hub. Otherwise it is
//!    divided over a hub in a few ways, each carried through to the end, and the one with the fewest Steiner points is
//!    kept. Where all fail, because the parts become too narrow for double precision, or where there is no hub, it is
//!    divided over a path, or else the overlay takes over: for the piece that is stuck, not for the one it came from. A
//!    large piece is divided over a path through its middle first, which costs less than its overlay would.
//!
//! Cost: O(m^2) N for the visibility of m vertices in N poses, twice that in all while large pieces are halved.

use super::chord_overlay;
use super::halving_path;
use super::line_of_sight;
use super::link_path::{self, LinkPath};
use super::single_steiner::{self, Hub};
use super::visibility::{self, Relation, Sight};
use super::{TriangulateError, TriangulateReport};
use crate::math::{Point, point};

/// How much is tried on a stuck piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effort {
    /// Several divisions, each carried through.
    Thorough,
    /// One division, another one for every number, and no path.
    Quick(usize),
}

/// Larger pieces are divided along one good diagonal after another; in smaller ones all sets of diagonals compete, by
/// dynamic programming that is cubic in their vertices.
const LARGEST_PIECE: usize = 256;

/// Larger pieces are divided over a path before they are overlaid, which would be cubic in them. In smaller ones the paths
/// cost about as many Steiner points as they save.
const LARGEST_OVERLAY: usize = LARGEST_PIECE;

/// Divisions of a stuck piece that are carried through to the end.
const HUBS_TRIED: usize = 4;

/// In pieces whose overlay may have more crossings than this one division is carried through, not several: each of them
/// is likely to end in overlays.
const MOST_CROSSINGS: usize = 100_000;

/// The state: all vertices so far, and the triangles that are settled.
#[derive(Debug)]
pub(super) struct Division {
    pub(super) positions: Vec<Vec<Point>>,
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) report: TriangulateReport,
    effort: Effort,
    /// Vertices that may be reached in all.
    most_vertices: usize,
}

/// A state to go back to.
#[derive(Debug, Clone, Copy)]
struct Mark {
    vertices: usize,
    triangles: usize,
    report: TriangulateReport,
}

/// What was added since a mark.
#[derive(Debug)]
struct Solution {
    positions: Vec<Vec<Point>>,
    triangles: Vec<[usize; 3]>,
    report: TriangulateReport,
}

impl Division {
    pub(super) fn new(positions: Vec<Vec<Point>>) -> Self {
        Self {
            positions,
            triangles: Vec::new(),
            report: TriangulateReport::default(),
            effort: Effort::Thorough,
            most_vertices: usize::MAX,
        }
    }

    /// For a piece that is worth solving only with at most `allowance` new vertices.
    pub(super) fn within(positions: Vec<Vec<Point>>, allowance: usize, effort: Effort) -> Self {
        let most_vertices = positions.first().map_or(0, Vec::len) + allowance;
        Self {
            effort,
            most_vertices,
            ..Self::new(positions)
        }
    }

    /// Triangulates a piece and everything it falls into.
    ///
    /// # Errors
    /// [`TriangulateError::TooNarrow`], also where the allowance is used up.
    pub(super) fn solve(&mut self, piece: Vec<usize>) -> Result<(), TriangulateError> {
        let mut pieces = vec![piece];
        while let Some(piece) = pieces.pop() {
            if let [a, b, c] = piece[..] {
                self.triangles.push([a, b, c]);
                continue;
            }
            let sights = visibility::look(&self.positions, &piece).map_err(|pose| self.too_narrow(&piece, pose))?;
            let common = visibility::common_pairs(&sights);
            if piece.len() > LARGEST_PIECE {
                let diagonal = line_of_sight::balanced_diagonal(
                    piece.len(),
                    &common,
                    |i, j| relative_length(&sights, i, j),
                    |i, j| is_clear(&sights, i, j),
                );
                match diagonal {
                    Some((i, j)) => pieces.extend([chain(&piece, i, j), chain(&piece, j, i)]),
                    None => self.solve_stuck(&piece, &sights)?,
                }
                continue;
            }
            let quality = |triangle| visibility::worst_angle_rad(&sights, triangle);
            if let Some(triangles) = line_of_sight::best_triangulation(piece.len(), &common, quality) {
                self.triangles
                    .extend(triangles.into_iter().map(|t| t.map(|k| piece[k])));
                continue;
            }
            // Every stuck piece costs a Steiner point at least.
            if self.vertex_count() >= self.most_vertices {
                return Err(self.too_narrow(&piece, 0));
            }
            let diagonals = clear_partition(&sights, common);
            if diagonals.is_empty() {
                self.solve_stuck(&piece, &sights)?;
            } else {
                let faces = line_of_sight::faces(piece.len(), &diagonals);
                pieces.extend(
                    faces
                        .into_iter()
                        .map(|face| face.into_iter().map(|k| piece[k]).collect()),
                );
            }
        }
        Ok(())
    }

    /// Triangulates a piece without any common diagonal: over a hub or a path, and where the parts that leaves are too
    /// narrow, or there is neither, by the overlay.
    fn solve_stuck(&mut self, piece: &[usize], sights: &[Sight]) -> Result<(), TriangulateError> {
        if let Some(hub) = single_steiner::star(sights) {
            return self.solve_over_hub(piece, &hub);
        }
        let mark = self.mark();
        let allowed = self.most_vertices;
        let mut best: Option<Solution> = None;
        let (effort, tried) = match self.effort {
            Effort::Thorough if self.most_crossings(piece) > MOST_CROSSINGS => (single_steiner::Search::Wide, 1),
            Effort::Thorough => (single_steiner::Search::Wide, HUBS_TRIED),
            Effort::Quick(variant) => (single_steiner::Search::Narrow(variant), 1),
        };
        for hub in single_steiner::hubs(sights, effort, tried) {
            let outer = self.effort;
            if tried > 1 {
                self.effort = Effort::Quick(0);
            }
            if self.solve_over_hub(piece, &hub).is_ok() {
                self.most_vertices = self.vertex_count() - 1;
                best = Some(self.take_since(mark));
            } else {
                self.back_to(mark);
            }
            self.effort = outer;
        }
        self.most_vertices = allowed;
        if let Some(best) = best {
            self.put(best);
            return Ok(());
        }
        let path = match self.effort {
            _ if piece.len() > LARGEST_OVERLAY => halving_path::halving_path(&self.positions, piece),
            Effort::Thorough => link_path::shortest_path(sights),
            Effort::Quick(_) => None,
        };
        if let Some(path) = path {
            if self.solve_over_path(piece, &path).is_ok() {
                return Ok(());
            }
            self.back_to(mark);
        }
        self.solve_by_overlay(piece, sights)
    }

    fn solve_over_hub(&mut self, piece: &[usize], hub: &Hub) -> Result<(), TriangulateError> {
        let vertex = self.add_vertices(std::slice::from_ref(&hub.points), piece)?;
        self.report.single += 1;
        for (s, &from) in hub.spokes.iter().enumerate() {
            let to = hub.spokes[(s + 1) % hub.spokes.len()];
            let mut part = chain(piece, from, to);
            part.push(vertex);
            self.solve(part)?;
        }
        Ok(())
    }

    fn solve_over_path(&mut self, piece: &[usize], path: &LinkPath) -> Result<(), TriangulateError> {
        let length = path.interior[0].len();
        let places: Vec<Vec<Point>> = (0..length)
            .map(|k| path.interior.iter().map(|points| points[k]).collect())
            .collect();
        let start = self.add_vertices(&places, piece)?;
        self.report.link += length;
        let mut first = chain(piece, path.from, path.to);
        first.extend((start..start + length).rev());
        let mut second = chain(piece, path.to, path.from);
        second.extend(start..start + length);
        self.solve(first)?;
        self.solve(second)
    }

    fn solve_by_overlay(&mut self, piece: &[usize], sights: &[Sight]) -> Result<(), TriangulateError> {
        // An overlay hardly ever has fewer points than its polygon.
        if self.most_vertices - self.vertex_count() < piece.len() {
            return Err(self.too_narrow(piece, 0));
        }
        let overlay = chord_overlay::overlay(sights).ok_or_else(|| self.too_narrow(piece, 0))?;
        let count = overlay.steiner_count();
        if self.vertex_count() + count > self.most_vertices {
            return Err(self.too_narrow(piece, 0));
        }
        let start = self.vertex_count();
        self.report.overlay += count;
        for (positions, added) in self.positions.iter_mut().zip(&overlay.points) {
            positions.extend_from_slice(added);
        }
        let global = |k: usize| {
            if k < piece.len() {
                piece[k]
            } else {
                start + k - piece.len()
            }
        };
        self.triangles.extend(overlay.triangles.iter().map(|t| t.map(global)));
        Ok(())
    }

    /// What an overlay of the piece is bounded by: pairs of poses times pairs of diagonals.
    fn most_crossings(&self, piece: &[usize]) -> usize {
        let poses = self.positions.len();
        poses * poses.saturating_sub(1) / 2 * piece.len().pow(2)
    }

    fn vertex_count(&self) -> usize {
        self.positions[0].len()
    }

    /// Adds vertices given by their places per pose; returns the first one's number.
    fn add_vertices(&mut self, places: &[Vec<Point>], piece: &[usize]) -> Result<usize, TriangulateError> {
        let start = self.vertex_count();
        if start + places.len() > self.most_vertices {
            return Err(self.too_narrow(piece, 0));
        }
        for place in places {
            for (positions, &point) in self.positions.iter_mut().zip(place) {
                positions.push(point);
            }
        }
        Ok(start)
    }

    fn mark(&self) -> Mark {
        Mark {
            vertices: self.vertex_count(),
            triangles: self.triangles.len(),
            report: self.report,
        }
    }

    fn back_to(&mut self, mark: Mark) {
        for positions in &mut self.positions {
            positions.truncate(mark.vertices);
        }
        self.triangles.truncate(mark.triangles);
        self.report = mark.report;
    }

    fn take_since(&mut self, mark: Mark) -> Solution {
        let solution = Solution {
            positions: self
                .positions
                .iter()
                .map(|positions| positions[mark.vertices..].to_vec())
                .collect(),
            triangles: self.triangles[mark.triangles..].to_vec(),
            report: self.report,
        };
        self.back_to(mark);
        solution
    }

    fn put(&mut self, solution: Solution) {
        for (positions, added) in self.positions.iter_mut().zip(solution.positions) {
            positions.extend(added);
        }
        self.triangles.extend(solution.triangles);
        self.report = solution.report;
    }

    fn too_narrow(&self, piece: &[usize], pose: usize) -> TriangulateError {
        let place = self.positions[pose][piece[0]];
        TriangulateError::TooNarrow {
            pose,
            x: place.x,
            y: place.y,
        }
    }
}

/// A diagonal is clear if no other vertex is nearer to it than this fraction of its length. A diagonal along a straight
/// side, whose vertices are collinear up to rounding, may have line of sight; the face it cuts off has no area.
const CLEAR: f64 = 1e-9;

/// Partitions are chosen this often, each time without the diagonals that turned out not to be clear, before all
/// diagonals are examined.
const PARTITION_ATTEMPTS: usize = 4;

/// The clear diagonals, without crossings, that leave the least to Steiner points.
fn clear_partition(sights: &[Sight], mut common: Relation) -> Vec<(usize, usize)> {
    let count = sights[0].points.len();
    let cost = |i: usize, j: usize| relative_length(sights, i, j);
    for _ in 0..PARTITION_ATTEMPTS {
        let diagonals = line_of_sight::cheapest_partition(count, &common, cost);
        let unclear: Vec<_> = diagonals
            .iter()
            .copied()
            .filter(|&(i, j)| !is_clear(sights, i, j))
            .collect();
        if unclear.is_empty() {
            return diagonals;
        }
        for (i, j) in unclear {
            common.clear(i, j);
        }
    }
    for i in 0..count {
        for j in i + 2..count {
            if (i, j) != (0, count - 1) && common.get(i, j) && !is_clear(sights, i, j) {
                common.clear(i, j);
            }
        }
    }
    line_of_sight::cheapest_partition(count, &common, cost)
}

/// Whether the diagonal stays clear of all other vertices in every pose.
fn is_clear(sights: &[Sight], i: usize, j: usize) -> bool {
    sights.iter().all(|sight| {
        let points = &sight.points;
        let (from, to) = (points[i], points[j]);
        let least = CLEAR * (to - from).norm();
        points
            .iter()
            .all(|&p| p == from || p == to || point::nearest_on_segment(p, from, to).1 > least)
    })
}

/// The length of a diagonal as a fraction of the piece's size, in the pose where that is most.
fn relative_length(sights: &[Sight], i: usize, j: usize) -> f64 {
    let relative = |sight: &Sight| (sight.points[j] - sight.points[i]).norm() / sight.diagonal;
    sights.iter().map(relative).fold(0.0, f64::max)
}

/// The vertices of a cyclic list from position `from` to position `to`, both included.
fn chain(piece: &[usize], from: usize, to: usize) -> Vec<usize> {
    let count = piece.len();
    (0..=(to + count - from) % count)
        .map(|k| piece[(from + k) % count])
        .collect()
}
