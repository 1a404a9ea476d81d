//! An outline carried by a mesh from one embedding to another.
//!
//! Every triangle maps affinely, so the carried curve is exact once the outline has a point wherever it crosses an edge of the
//! mesh: those are added first. Since both embeddings are one-to-one, a simple outline stays simple.
//!
//! Cost: O((n + m) log m) for n points and m edges, if the outline's edges are not much longer than the mesh's.

use rstar::{AABB, RTree, primitives::GeomWithData, primitives::Rectangle};

use crate::math::{Point, point, wrapped};
use crate::mesh::{PointLocator, Topology};
use crate::outline::{Outline, OutlineError, Ring, RingError};

/// Crossings nearer than this to an end of an outline's edge, as a share of the edge, are that end.
const AT_THE_END: f64 = 1e-9;

/// Why an outline cannot be carried.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum CarryError {
    /// The mesh has no triangle.
    #[error("there is no triangle to carry the outline")]
    NoTriangle,
    /// The carried ring is degenerate.
    #[error("the deformed outline: {0}")]
    Ring(#[from] RingError),
    /// The carried outline meets itself.
    #[error("the deformed outline: {0}")]
    Outline(#[from] OutlineError),
}

/// An outline on another embedding of its mesh, and which point of it was which.
#[derive(Debug, Clone)]
pub(crate) struct CarriedOutline {
    /// The carried outline.
    pub outline: Outline,
    rings: Vec<Parameters>,
}

/// The arc-length parameters of a ring's points before and after.
#[derive(Debug, Clone)]
struct Parameters {
    before: Vec<f64>,
    after: Vec<f64>,
}

impl CarriedOutline {
    /// Carries `outline`, which lies on the mesh at `from`, to the mesh at `to` (both #vertices).
    ///
    /// # Errors
    /// [`CarryError`] if `to` is no embedding of the mesh, or flattens the outline.
    pub(crate) fn new(
        topology: &Topology,
        from: &[Point],
        to: &[Point],
        outline: &Outline,
    ) -> Result<Self, CarryError> {
        let locator = PointLocator::new(topology.triangles(), from);
        let edges = mesh_edges(topology, from);
        let carry =
            |p: Point| -> Result<Point, CarryError> { Ok(locator.bind(p).ok_or(CarryError::NoTriangle)?.at(to)) };
        let (mut carried, mut rings) = (Vec::new(), Vec::new());
        for ring in outline.rings() {
            let before = subdivided(ring, &edges);
            let after: Vec<Point> = before.iter().map(|p| carry(*p)).collect::<Result<_, _>>()?;
            rings.push(Parameters {
                before: parameters(&before),
                after: parameters(&after),
            });
            carried.push(Ring::new(after)?);
        }
        let outer = carried.remove(0);
        let openings = outline.openings().iter().map(|opening| {
            let points = subdivided(opening, &edges).into_iter().map(carry);
            Ok(Ring::new(points.collect::<Result<Vec<_>, CarryError>>()?)?)
        });
        let openings = openings.collect::<Result<_, CarryError>>()?;
        Ok(Self {
            outline: Outline::new(outer, carried)?.with_openings(openings),
            rings,
        })
    }

    /// The parameter on the carried ring (0 is the outer one) of the point at parameter `t` of the ring it was.
    #[must_use]
    pub(crate) fn parameter(&self, ring: usize, t: f64) -> f64 {
        let t = wrapped(t);
        let Some(Parameters { before, after }) = self.rings.get(ring) else {
            return t;
        };
        let edge = before.partition_point(|&p| p <= t).clamp(1, before.len() - 1) - 1;
        let length = before[edge + 1] - before[edge];
        let along = if length > 0.0 {
            ((t - before[edge]) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let carried = after[edge] + along * (after[edge + 1] - after[edge]);
        if carried >= 1.0 { 0.0 } else { carried }
    }
}

type Edge = GeomWithData<Rectangle<[f64; 2]>, (Point, Point)>;

fn mesh_edges(topology: &Topology, positions: &[Point]) -> RTree<Edge> {
    let boxed = |(a, b): (usize, usize)| {
        let (a, b) = (positions[a], positions[b]);
        Edge::new(Rectangle::from_corners([a.x, a.y], [b.x, b.y]), (a, b))
    };
    RTree::bulk_load(topology.edges().into_iter().map(boxed).collect())
}

/// The points of `ring` and those where it crosses an edge of the mesh.
fn subdivided(ring: &Ring, edges: &RTree<Edge>) -> Vec<Point> {
    let mut points = Vec::with_capacity(ring.len());
    let mut crossings: Vec<f64> = Vec::new();
    for (a, b) in ring.edges() {
        points.push(a);
        let (low, high) = (a.inf(&b), a.sup(&b));
        let along = b - a;
        crossings.clear();
        for edge in edges.locate_in_envelope_intersecting(AABB::from_corners([low.x, low.y], [high.x, high.y])) {
            let (c, d) = edge.data;
            let across = d - c;
            let denominator = point::cross(along, across);
            // Parallel edges are not crossed.
            let (t, u) = (
                point::cross(c - a, across) / denominator,
                point::cross(c - a, along) / denominator,
            );
            // A vertex of the mesh may lie on the outline: its edges begin there, and rounding must not lose them.
            if t > AT_THE_END && t < 1.0 - AT_THE_END && (-AT_THE_END..=1.0 + AT_THE_END).contains(&u) {
                crossings.push(t);
            }
        }
        crossings.sort_by(f64::total_cmp);
        crossings.dedup_by(|next, kept| *next - *kept < AT_THE_END);
        points.extend(crossings.iter().map(|t| a + along * *t));
    }
    points
}

/// The arc-length parameter of each point, and a final 1.
fn parameters(points: &[Point]) -> Vec<f64> {
    let mut travelled = 0.0;
    let mut parameters = vec![0.0];
    for (k, p) in points.iter().enumerate() {
        travelled += (points[(k + 1) % points.len()] - p).norm();
        parameters.push(travelled);
    }
    for parameter in &mut parameters {
        *parameter /= travelled;
    }
    parameters
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::ArcLength;

    /// A square of side 2 in two triangles; in it a box, and what a shear and a fold at the diagonal make of it.
    #[test]
    fn edges_bend_where_the_mesh_does_and_points_correspond() {
        let topology = Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
        let from = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::from);
        let to = [[0.0, 0.0], [2.0, 0.0], [3.0, 3.0], [0.0, 2.0]].map(Point::from);
        let ring = Ring::new([[0.5, 0.5], [1.5, 0.5], [1.5, 1.0], [0.5, 1.0]].map(Point::from)).expect("a ring");
        let outline = Outline::new(ring, vec![]).expect("simple");
        let carried = CarriedOutline::new(&topology, &from, &to, &outline).expect("carried");
        // One point more, where the upper side crosses the diagonal at (1, 1), which goes to (1.5, 1.5).
        let points = carried.outline.outer().points();
        assert_eq!(points.len(), 5);
        assert!(points.iter().any(|p| (p - Point::new(1.5, 1.5)).norm() < 1e-12));
        let (before, after) = (ArcLength::new(outline.outer()), ArcLength::new(carried.outline.outer()));
        let map = |p: Point| {
            if p.x >= p.y {
                Point::new(p.x + 0.5 * p.y, 1.5 * p.y)
            } else {
                Point::new(1.5 * p.x, p.y + 0.5 * p.x)
            }
        };
        let mut last = -1.0;
        for k in 0..97 {
            let t = f64::from(k) / 97.0;
            let carried_t = carried.parameter(0, t);
            assert!(carried_t > last);
            last = carried_t;
            assert!((after.at(carried_t) - map(before.at(t))).norm() < 1e-12, "{t}");
        }
        let flat = [Point::zeros(); 4];
        let error = CarriedOutline::new(&topology, &from, &flat, &outline).expect_err("nothing is left");
        assert!(matches!(error, CarryError::Ring(_)), "{error}");
    }
}
