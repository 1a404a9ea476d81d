//! Compatible triangulation: N simple polygons with corresponding vertices get one triangulation.
//!
//! Input: N outlines with equal vertex counts; output: one topology with N embeddings, whose boundary is the polygons,
//! vertex by vertex. Source: NWM 3.1 "Compatible triangulation", after Baxter, Barla, Anjyo (2008); the last resort
//! after Aronov, Seidel, Souvaine, "On compatible triangulations of simple polygons" (1993).
//!
//! What is to be met inside ([`features`]) may divide the polygons ([`regions`]); holes and all else that lies inside a
//! region are first joined to the walk around it by bridges ([`bridge`]). A piece is a list of corresponding vertices that
//! bound a simple polygon (weakly simple along bridges) in every pose. Each piece is
//! 1. triangulated with diagonals that have line of sight in all poses, or divided by as many of them as possible
//!    ([`line_of_sight`]); what has none left is
//! 2. divided by a Steiner point that several vertices see in all poses ([`single_steiner`]), or
//! 3. divided by a path of several Steiner points ([`link_path`]), or, if no such path shrinks it,
//! 4. triangulated as the overlay of the poses' own triangulations on a convex polygon ([`chord_overlay`]), which
//!    always exists.
//!
//! At the end Steiner points that are not needed are taken out again ([`decimate`]).
//!
//! Differences from the paper: stage 1 chooses its diagonals by dynamic programming instead of taking the first found;
//! stage 2 joins its point to all vertices it can see, not to two; a partition has to shrink every part, which the
//! paper does not ask for and without which it may not end; stage 4 and the decimation are not in the paper.
//!
//! Guarantee: every triangle is positive in every pose by an exact predicate. Cost: quadratic in the vertices of a
//! piece for visibility, cubic within pieces of at most 64 vertices for Steiner points.

mod bridge;
mod bridge_path;
mod chord_overlay;
mod convex;
mod decimate;
mod ear_clipping;
mod features;
mod free_space;
mod line_of_sight;
mod link_path;
mod regions;
mod single_steiner;
mod visibility;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_holes;
#[cfg(test)]
mod tests_paths;

pub use features::{Feature, FeaturePath, Features, PathEnd};

use super::CompatibleMesh;
use super::editable::{Curves, EditableMesh};
use crate::math::{Point, point};
use crate::mesh::{TopologyError, geometry};
use crate::outline::Outline;
use ear_clipping::triangulate_polygon;
use single_steiner::Hub;
use visibility::{Relation, Sight};

/// Steiner points by the stage that added them, and how many were taken out again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct TriangulateReport {
    /// Added on bridges to holes, landmarks and paths.
    pub bridge: usize,
    /// Added as hubs of a star or partition (stage 2).
    pub single: usize,
    /// Added on link paths (stage 3).
    pub link: usize,
    /// Added by chord overlays (stage 4).
    pub overlay: usize,
    /// Taken out by the decimation.
    pub decimated: usize,
}

/// Why polygons could not be triangulated compatibly.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangulateError {
    /// There is no polygon.
    #[error("compatible triangulation needs at least one polygon")]
    NoPose,
    /// Vertex counts differ.
    #[error(
        "ring {ring} of pose {pose} has {found} vertices, in pose 0 it has {expected}; corresponding rings need equal counts"
    )]
    CountsDiffer {
        /// Which pose.
        pose: usize,
        /// Which ring; 0 is the outer one.
        ring: usize,
        /// Its vertices, or 0 for a missing ring.
        found: usize,
        /// Vertices of the same ring in pose 0.
        expected: usize,
    },
    /// A feature is not inside its polygon, or has not one place a pose.
    #[error("{feature} is not inside the polygon of pose {pose}")]
    FeatureOutside {
        /// Which feature.
        feature: Feature,
        /// Which pose.
        pose: usize,
    },
    /// Two features touch, or a path touches itself.
    #[error("{first} meets {second} in pose {pose}; draw them apart")]
    FeaturesMeet {
        /// A feature.
        first: Feature,
        /// The other; the same for a path that touches itself.
        second: Feature,
        /// Which pose.
        pose: usize,
    },
    /// A path has no edge, or an end at no vertex of the polygons.
    #[error("path {path} needs two different points at least, and ends inside or on vertices of the polygons")]
    PathShort {
        /// Which path.
        path: usize,
    },
    /// A hole, landmark or path lies on different sides of a path.
    #[error(
        "pose {pose} has something on the other side of path {path} than pose 0; let the same things lie on each side"
    )]
    PathSides {
        /// Which path.
        path: usize,
        /// Which pose.
        pose: usize,
    },
    /// A corridor of a polygon is so narrow that no valid mesh was found in double precision.
    #[error(
        "the polygons are too narrow to be meshed in double precision near ({x:.6}, {y:.6}) in pose {pose}; widen the drawing there"
    )]
    TooNarrow {
        /// A pose where it shows.
        pose: usize,
        /// A vertex of the piece that failed.
        x: f64,
        /// A vertex of the piece that failed.
        y: f64,
    },
    /// The result is no surface; reported rather than handed on.
    #[error("the triangulation is no surface: {0}")]
    Topology(#[from] TopologyError),
}

impl From<bridge::Narrow> for TriangulateError {
    fn from(narrow: bridge::Narrow) -> Self {
        Self::TooNarrow {
            pose: narrow.pose,
            x: narrow.place.x,
            y: narrow.place.y,
        }
    }
}

/// Triangulates N polygons compatibly, with a vertex at each interior landmark.
///
/// `landmarks` are points inside the polygons: #landmarks x #poses; see [`triangulate_features`].
///
/// # Errors
/// As [`triangulate_features`].
pub fn triangulate(
    polygons: &[Outline],
    landmarks: &[Vec<Point>],
) -> Result<(CompatibleMesh, TriangulateReport), TriangulateError> {
    let features = Features {
        points: landmarks.to_vec(),
        paths: Vec::new(),
    };
    triangulate_features(polygons, &features)
}

/// Triangulates N polygons compatibly, with a vertex at each point and a chain of edges along each path of `features`.
///
/// Vertex `k` of ring `r` is vertex `k` of the mesh plus the lengths of the rings before; then follow the points, the
/// points of the paths, and Steiner points.
///
/// # Errors
/// [`TriangulateError`] if the polygons do not correspond, a feature is outside or meets another, poses disagree about
/// what lies beside a path, or a corridor is too narrow for double precision.
pub fn triangulate_features(
    polygons: &[Outline],
    features: &Features,
) -> Result<(CompatibleMesh, TriangulateReport), TriangulateError> {
    let first = polygons.first().ok_or(TriangulateError::NoPose)?;
    for (pose, polygon) in polygons.iter().enumerate() {
        for ring in 0..first.rings().len().max(polygon.rings().len()) {
            let count = |outline: &Outline| outline.rings().get(ring).map_or(0, |r| r.len());
            let (found, expected) = (count(polygon), count(first));
            if found != expected {
                return Err(TriangulateError::CountsDiffer {
                    pose,
                    ring,
                    found,
                    expected,
                });
            }
        }
    }
    let mut rings: Vec<Vec<usize>> = Vec::new();
    let mut count = 0;
    for ring in first.rings() {
        rings.push((count..count + ring.len()).collect());
        count += ring.len();
    }
    let mut positions: Vec<Vec<Point>> = polygons
        .iter()
        .map(|polygon| polygon.rings().iter().flat_map(|ring| ring.points()).copied().collect())
        .collect();
    let numbered = features::number(features, &rings, &mut positions)?;
    features::check(polygons, &rings, &numbered, &positions)?;
    let mut division = Division {
        positions,
        triangles: Vec::new(),
        report: TriangulateReport::default(),
    };
    for region in regions::regions(&rings, &numbered, &division.positions)? {
        let joined = bridge::join_islands(&mut division.positions, region.walk, region.islands)?;
        division.report.bridge += joined.steiner;
        division.solve(joined.walk)?;
    }

    let mut mesh = EditableMesh::new(division.positions, &division.triangles);
    let mut report = division.report;
    report.decimated = decimate::decimate(&mut mesh, numbered.count);
    let steiner = report.bridge + report.single + report.link + report.overlay - report.decimated;
    let curves = Curves {
        rings,
        landmarks: numbered.points,
        paths: numbered.paths,
    };
    Ok((mesh.finish(&curves, steiner)?, report))
}

/// The divide-and-conquer state: all vertices so far, and the triangles that are settled.
struct Division {
    positions: Vec<Vec<Point>>,
    triangles: Vec<[usize; 3]>,
    report: TriangulateReport,
}

impl Division {
    /// Triangulates a piece and everything it falls into.
    fn solve(&mut self, piece: Vec<usize>) -> Result<(), TriangulateError> {
        let mut pieces = vec![piece];
        while let Some(piece) = pieces.pop() {
            if let [a, b, c] = piece[..] {
                self.triangles.push([a, b, c]);
                continue;
            }
            let sights = self.look(&piece)?;
            let common = common_pairs(&sights);
            let quality = |triangle: [usize; 3]| {
                sights
                    .iter()
                    .map(|sight| geometry::smallest_angle_rad(geometry::corners(&sight.points, triangle)))
                    .fold(f64::INFINITY, f64::min)
            };
            if let Some(triangles) = line_of_sight::best_triangulation(piece.len(), &common, quality) {
                self.triangles
                    .extend(triangles.into_iter().map(|t| t.map(|k| piece[k])));
                continue;
            }
            let diagonals = line_of_sight::largest_partition(piece.len(), &clear_pairs(&sights, common));
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
        let (vertices, triangles, report) = (self.positions[0].len(), self.triangles.len(), self.report);
        if self.solve_divided(piece, sights) {
            return Ok(());
        }
        for positions in &mut self.positions {
            positions.truncate(vertices);
        }
        self.triangles.truncate(triangles);
        self.report = report;

        let overlay = chord_overlay::overlay(sights).ok_or_else(|| self.too_narrow(piece))?;
        self.report.overlay += overlay.steiner_count();
        for (positions, added) in self.positions.iter_mut().zip(&overlay.points) {
            positions.extend_from_slice(added);
        }
        let global = |k: usize| {
            if k < piece.len() {
                piece[k]
            } else {
                vertices + k - piece.len()
            }
        };
        self.triangles.extend(overlay.triangles.iter().map(|t| t.map(global)));
        Ok(())
    }

    /// Divides a stuck piece and triangulates the parts; false if there is no division, or a part cannot be done.
    fn solve_divided(&mut self, piece: &[usize], sights: &[Sight]) -> bool {
        let mut parts = Vec::new();
        if let Some(hub) = single_steiner::star(sights).or_else(|| single_steiner::best_hub(sights)) {
            self.report.single += 1;
            self.join_hub(piece, &hub, &mut parts);
        } else if let Some(path) = link_path::shortest_path(sights) {
            self.report.link += path.interior[0].len();
            self.join_path(piece, &path, &mut parts);
        } else {
            return false;
        }
        parts.into_iter().all(|part| self.solve(part).is_ok())
    }

    fn join_hub(&mut self, piece: &[usize], hub: &Hub, pieces: &mut Vec<Vec<usize>>) {
        let vertex = self.add_vertex(hub.points.iter().copied());
        for (s, &from) in hub.spokes.iter().enumerate() {
            let to = hub.spokes[(s + 1) % hub.spokes.len()];
            let mut part = chain(piece, from, to);
            part.push(vertex);
            pieces.push(part);
        }
    }

    fn join_path(&mut self, piece: &[usize], path: &link_path::LinkPath, pieces: &mut Vec<Vec<usize>>) {
        let length = path.interior[0].len();
        let vertices: Vec<usize> = (0..length)
            .map(|k| self.add_vertex(path.interior.iter().map(|points| points[k])))
            .collect();
        let mut first = chain(piece, path.from, path.to);
        first.extend(vertices.iter().rev());
        let mut second = chain(piece, path.to, path.from);
        second.extend(&vertices);
        pieces.push(first);
        pieces.push(second);
    }

    fn add_vertex(&mut self, places: impl IntoIterator<Item = Point>) -> usize {
        for (positions, place) in self.positions.iter_mut().zip(places) {
            positions.push(place);
        }
        self.positions[0].len() - 1
    }

    fn look(&self, piece: &[usize]) -> Result<Vec<Sight>, TriangulateError> {
        self.positions
            .iter()
            .map(|positions| {
                let points: Vec<Point> = piece.iter().map(|&v| positions[v]).collect();
                let triangles = triangulate_polygon(&points).ok_or_else(|| self.too_narrow(piece))?;
                Ok(Sight::new(points, triangles))
            })
            .collect()
    }

    fn too_narrow(&self, piece: &[usize]) -> TriangulateError {
        let place = self.positions[0][piece[0]];
        TriangulateError::TooNarrow {
            pose: 0,
            x: place.x,
            y: place.y,
        }
    }
}

/// The pairs of vertices with line of sight in every pose.
fn common_pairs(sights: &[Sight]) -> Relation {
    let mut common = Relation::full(sights[0].points.len());
    for sight in sights {
        common.intersect(&sight.visible_pairs());
    }
    common
}

/// A diagonal is clear if no other vertex is nearer to it than this fraction of its length. A diagonal along a straight
/// side, whose vertices are collinear up to rounding, may have line of sight; the face it cuts off has no area.
const CLEAR: f64 = 1e-9;

/// The pairs that stay clear of all other vertices, polygon edges included.
fn clear_pairs(sights: &[Sight], mut common: Relation) -> Relation {
    let count = sights[0].points.len();
    for i in 0..count {
        for j in i + 2..count {
            let is_clear = |points: &[Point]| {
                (0..count).filter(|&k| k != i && k != j).all(|k| {
                    let distance = point::nearest_on_segment(points[k], points[i], points[j]).1;
                    distance > CLEAR * (points[j] - points[i]).norm()
                        || points[k] == points[i]
                        || points[k] == points[j]
                })
            };
            if (i, j) != (0, count - 1) && common.get(i, j) && !sights.iter().all(|sight| is_clear(&sight.points)) {
                common.clear(i, j);
            }
        }
    }
    common
}

/// The vertices of a cyclic list from position `from` to position `to`, both included.
fn chain(piece: &[usize], from: usize, to: usize) -> Vec<usize> {
    let count = piece.len();
    (0..=(to + count - from) % count)
        .map(|k| piece[(from + k) % count])
        .collect()
}
