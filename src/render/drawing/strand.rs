//! A subpath carried by the mesh, from one drawing or from several whose curves correspond.
//!
//! A cubic inside one triangle is carried exactly by the triangle's affine map. One that crosses edges is divided at crossings,
//! until carrying the pieces' control points is as good as carrying every point of the curve:
//!
//! 1. A piece's ends are bound to the triangles they lie in, its two control points to the triangles in which it starts and ends.
//! 2. Its greatest distance from the curve carried point by point is sampled in all poses of the mesh. Above [`TOLERANCE_PX`]
//!    the piece is divided at the crossing nearest to its middle, in all drawings at the same parameter, so that they keep the same
//!    number of curves.
//! 3. The mesh's map is continuous but bends at edges, which would give a smooth line kinks. At a joint where the drawings go
//!    on (nearly) straight, the two control points beside it are turned by equal angles, so that the line turns by the blend of
//!    what the drawings turn by there. A single pose's own drawing is not changed by this.
//!
//! Points of several drawings are averaged with the blend's weights.

use kurbo::{CubicBez, ParamCurve};

use super::binding::PoseMesh;
use crate::input::Subpath;
use crate::math::{Point, point, rotation};
use crate::mesh::MeshPoint;

/// How far a carried piece may be from the curve carried point by point, in pixels of the frame. A quarter of it gives twice as
/// many curves and the same picture.
const TOLERANCE_PX: f64 = 0.2;

/// Points of a piece at which that distance is measured.
const SAMPLES: usize = 8;

/// A piece is divided at most this many times over.
const MOST_DIVISIONS: usize = 10;

/// How far into a curve its triangle is looked up: a curve may start on an edge.
const INWARDS: f64 = 1e-4;

/// Steps of bisection for where a curve leaves a triangle: to 1e-12 of the piece.
const BISECTIONS: usize = 40;

/// The crossing where a piece is divided is not nearer than this to its ends.
const LEAST_PART: f64 = 0.02;

/// The sharpest turn, in radians, at which a line counts as going on: two degrees.
const GOES_ON_RAD: f64 = 0.035;

/// A subpath of one or more drawings, bound to their meshes.
#[derive(Debug, Clone)]
pub(super) struct Strand {
    pub(super) is_closed: bool,
    /// #points x #drawings: the start, then two control points and the end of every curve.
    anchors: Vec<MeshPoint>,
    drawing_count: usize,
    /// Joints whose turn is kept.
    joints: Vec<Joint>,
}

/// A joint of two curves at which the line goes on.
#[derive(Debug, Clone)]
struct Joint {
    /// The index of its point.
    point: usize,
    /// By how much the line turns there, in each drawing.
    turns_rad: Vec<f64>,
}

/// One curve in every drawing.
type Piece = Vec<CubicBez>;

/// Where and when carried curves have to be right.
pub(super) struct Carriers<'a> {
    /// The mesh in the pose of each drawing.
    pub(super) meshes: Vec<&'a PoseMesh<'a>>,
    /// The positions of all poses of the mesh.
    pub(super) poses: &'a [Vec<Point>],
    /// Pixels to a unit.
    pub(super) scale: f64,
}

impl Strand {
    /// Binds curves that correspond: `curves[k][d]` is the k-th in drawing d, each starting where the one before ends.
    pub(super) fn new(curves: &[Piece], is_closed: bool, carriers: &Carriers) -> Self {
        let mut pieces = Vec::new();
        for curve in curves {
            divide(curve.clone(), carriers, MOST_DIVISIONS, &mut pieces);
        }
        let drawing_count = carriers.meshes.len();
        let mut anchors: Vec<MeshPoint> = Vec::with_capacity((1 + 3 * pieces.len()) * drawing_count);
        let bound_everywhere = |piece: &Piece| -> Vec<Bound> {
            let bound = piece
                .iter()
                .zip(&carriers.meshes)
                .map(|(curve, mesh)| bound(curve, mesh));
            bound.collect()
        };
        for (k, piece) in pieces.iter().enumerate() {
            let bound = bound_everywhere(piece);
            let mut append = |point: usize| anchors.extend(bound.iter().map(|bound| bound[point]));
            if k == 0 {
                append(0);
            }
            append(1);
            append(2);
            if is_closed && k + 1 == pieces.len() {
                anchors.extend_from_within(..drawing_count);
            } else {
                append(3);
            }
        }
        Self {
            is_closed,
            anchors,
            drawing_count,
            joints: joints(&pieces, is_closed),
        }
    }

    /// Shrinks it to a point in drawing `drawing`, in which it is not: to `place`.
    pub(super) fn shrink(&mut self, drawing: usize, place: MeshPoint) {
        for row in self.anchors.chunks_exact_mut(self.drawing_count) {
            row[drawing] = place;
        }
    }

    /// Its points in drawing `drawing`, where the mesh lies at `positions`.
    pub(super) fn points_of<'a>(&'a self, drawing: usize, positions: &'a [Point]) -> impl Iterator<Item = Point> + 'a {
        self.anchors
            .iter()
            .skip(drawing)
            .step_by(self.drawing_count.max(1))
            .map(|anchor| anchor.at(positions))
    }

    /// The subpath where the mesh lies at `positions` and the drawings count with `weights`; every point is then mapped by
    /// `to_frame`, a similarity.
    pub(super) fn at(&self, positions: &[Point], weights: &[f64], to_frame: impl Fn(Point) -> Point) -> Subpath {
        let mut points: Vec<Point> = self
            .anchors
            .chunks_exact(self.drawing_count.max(1))
            .map(|row| {
                row.iter()
                    .zip(weights)
                    .filter(|(_, weight)| **weight != 0.0)
                    .map(|(anchor, weight)| anchor.at(positions) * *weight)
                    .sum()
            })
            .collect();
        self.keep_turns(&mut points, weights);
        for p in &mut points {
            *p = to_frame(*p);
        }
        Subpath {
            start: points.first().copied().unwrap_or_default(),
            cubics: points
                .get(1..)
                .unwrap_or_default()
                .chunks_exact(3)
                .map(|c| [c[0], c[1], c[2]])
                .collect(),
            is_closed: self.is_closed,
        }
    }

    fn keep_turns(&self, points: &mut [Point], weights: &[f64]) {
        for joint in &self.joints {
            // The start of a closed strand is its end too.
            let (before, after) = (
                if joint.point == 0 {
                    points.len() - 2
                } else {
                    joint.point - 1
                },
                joint.point + 1,
            );
            let at = points[joint.point];
            let Some(turn_rad) = turn_rad(at - points[before], points[after] - at) else {
                continue;
            };
            let wanted: f64 = joint
                .turns_rad
                .iter()
                .zip(weights)
                .map(|(turn, weight)| turn * weight)
                .sum();
            let half = rotation(0.5 * (turn_rad - wanted));
            points[before] = at + half * (points[before] - at);
            points[after] = at + half.transpose() * (points[after] - at);
        }
    }
}

/// A curve's four anchors.
type Bound = [MeshPoint; 4];

fn bound(curve: &CubicBez, mesh: &PoseMesh) -> Bound {
    let (first, last) = end_triangles(curve, mesh);
    let [a, b, c, d] = control_points(curve);
    // An end may lie just before an edge that the curve then crosses: it is bound to its own triangle, not to the curve's.
    [
        mesh.bind_here(a),
        mesh.bind(b, first),
        mesh.bind(c, last),
        mesh.bind_here(d),
    ]
}

fn end_triangles(curve: &CubicBez, mesh: &PoseMesh) -> (usize, usize) {
    (
        mesh.triangle_at(to_point(curve.eval(INWARDS))),
        mesh.triangle_at(to_point(curve.eval(1.0 - INWARDS))),
    )
}

/// Divides a piece until its control points carry it, and appends what comes out.
fn divide(piece: Piece, carriers: &Carriers, divisions: usize, pieces: &mut Vec<Piece>) {
    let worst = piece
        .iter()
        .zip(&carriers.meshes)
        .map(|(curve, mesh)| Carried::of(curve, mesh, carriers))
        .max_by(|a, b| a.deviation_px.total_cmp(&b.deviation_px));
    match worst {
        Some(worst) if divisions > 0 && worst.deviation_px > TOLERANCE_PX => {
            let at = worst.division;
            let parts = |range: std::ops::Range<f64>| -> Piece {
                piece.iter().map(|curve| curve.subsegment(range.clone())).collect()
            };
            let (first, mut second) = (parts(0.0..at), parts(at..1.0));
            // The two halves meet exactly.
            for (a, b) in first.iter().zip(&mut second) {
                b.p0 = a.p3;
            }
            divide(first, carriers, divisions - 1, pieces);
            divide(second, carriers, divisions - 1, pieces);
        }
        _ => pieces.push(piece),
    }
}

/// How well the control points of a curve carry it.
struct Carried {
    /// Over all poses.
    deviation_px: f64,
    /// Where to divide it.
    division: f64,
}

impl Carried {
    fn of(curve: &CubicBez, mesh: &PoseMesh, carriers: &Carriers) -> Self {
        let at = |k: usize| k as f64 / SAMPLES as f64;
        let point_at = |t: f64| to_point(curve.eval(t));
        let (first, last) = end_triangles(curve, mesh);
        let mut triangles: Vec<usize> = (0..=SAMPLES).map(|k| mesh.triangle_at(point_at(at(k)))).collect();
        // Points on an edge may be looked up in the wrong of two triangles.
        triangles[0] = first;
        triangles[SAMPLES] = last;
        if triangles.iter().all(|triangle| *triangle == first) {
            return Self {
                deviation_px: 0.0,
                division: 0.5,
            };
        }
        let anchors: Vec<MeshPoint> = (0..=SAMPLES)
            .map(|k| mesh.bind(point_at(at(k)), triangles[k]))
            .collect();
        let ends = bound(curve, mesh);
        let mut deviation: f64 = 0.0;
        for positions in carriers.poses {
            let [a, b, c, d] = ends.map(|anchor| anchor.at(positions));
            let carried = CubicBez::new((a.x, a.y), (b.x, b.y), (c.x, c.y), (d.x, d.y));
            for (k, anchor) in anchors.iter().enumerate().take(SAMPLES).skip(1) {
                deviation = deviation.max((anchor.at(positions) - to_point(carried.eval(at(k)))).norm());
            }
        }
        let crossing = (0..SAMPLES)
            .filter(|&k| triangles[k] != triangles[k + 1])
            .min_by(|&a, &b| {
                let from_middle = |k: usize| (at(k) + 0.5 / SAMPLES as f64 - 0.5).abs();
                from_middle(a).total_cmp(&from_middle(b))
            });
        let division = crossing.map_or(0.5, |k| {
            let (mut low, mut high) = (at(k), at(k + 1));
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (low + high);
                if mesh.triangle_at(point_at(middle)) == triangles[k] {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            high
        });
        Self {
            deviation_px: deviation * carriers.scale,
            division: if (LEAST_PART..=1.0 - LEAST_PART).contains(&division) {
                division
            } else {
                0.5
            },
        }
    }
}

fn joints(pieces: &[Piece], is_closed: bool) -> Vec<Joint> {
    let count = pieces.len();
    let first = usize::from(!is_closed);
    (first..count)
        .filter_map(|k| {
            let (before, after) = (&pieces[(k + count - 1) % count], &pieces[k]);
            let turns_rad: Option<Vec<f64>> = before
                .iter()
                .zip(after)
                .map(|(a, b)| {
                    turn_rad(to_point(a.p3) - to_point(a.p2), to_point(b.p1) - to_point(b.p0))
                        .filter(|turn| turn.abs() <= GOES_ON_RAD)
                })
                .collect();
            turns_rad.map(|turns_rad| Joint {
                point: 3 * k,
                turns_rad,
            })
        })
        .collect()
}

/// The angle from `a` to `b`; `None` where either has no direction.
fn turn_rad(a: Point, b: Point) -> Option<f64> {
    const SHORTEST: f64 = 1e-9;
    (a.norm() > SHORTEST && b.norm() > SHORTEST).then(|| libm::atan2(point::cross(a, b), a.dot(&b)))
}

pub(super) fn control_points(curve: &CubicBez) -> [Point; 4] {
    [curve.p0, curve.p1, curve.p2, curve.p3].map(to_point)
}

pub(super) fn to_point(p: kurbo::Point) -> Point {
    Point::new(p.x, p.y)
}
