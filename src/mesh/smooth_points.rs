//! Points that a mesh carries smoothly: its map without the bends at its edges.
//!
//! A mesh moves its places piecewise affinely, and a smooth curve across its edges gets a bend at each of them. Moving least squares (Lancaster and
//! Salkauskas 1981; for deformation Schaefer, McPhail and Warren 2006) takes the affine map that fits the vertices around a place best instead, the
//! nearer the more. What comes out is linear in the vertices' positions, so that every place has its shares of them once and for all:
//!
//! 1. The vertices within a radius of the place, reached along edges, so that what lies beside it across a gap does not count. The radius is that many
//!    mean lengths of the edges there.
//! 2. Weights `q = (1 - (distance / radius)^2)^2`, less for vertices that the map around the place does not take to where they are in the other poses: in an
//!    armpit the mesh bends between arm and chest, and is to bend there. The map is the mean of those of the triangle's vertices, which each fit their edges best.
//! 3. The shares of the least-squares affine map at the place.
//!
//! *Guarantee*: affine maps are reproduced, so that at the positions at which it was made every place is where it was, to rounding.
//!
//! Where too few vertices are near, or all lie along a line, the place stays with its triangle.

use super::{MeshPoint, Topology, geometry};
use crate::math::{Matrix, Point};

/// The radius, in mean lengths of the edges at the place: the least within which there are two vertices in every direction.
const RADIUS: f64 = 2.0;

/// How far a vertex may be from where the map around the place has it in another pose to count for a third, in radii: less bends from edge to edge of a curve, more
/// where limbs begin.
const BENT: f64 = 0.3;

/// The least determinant of the second moments of the weighted vertices, relative to the radius: of vertices along a line it is 0, of those within half a disc a
/// hundredth.
const LEAST_SPREAD: f64 = 1e-4;

/// Places with their shares of a mesh's vertices.
#[derive(Debug, Clone)]
pub(crate) struct SmoothPoints {
    /// Where the shares of each place begin, and where the last end.
    starts: Vec<usize>,
    vertices: Vec<u32>,
    shares: Vec<f64>,
}

impl SmoothPoints {
    /// How many places there are.
    pub(crate) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Where place `k` is when the mesh's vertices are at `positions`.
    pub(crate) fn at(&self, k: usize, positions: &[Point]) -> Point {
        let own = self.starts[k]..self.starts[k + 1];
        let shares = self.vertices[own.clone()].iter().zip(&self.shares[own]);
        shares.fold(Point::zeros(), |sum, (&vertex, &share)| {
            sum + positions[vertex as usize] * share
        })
    }
}

/// A mesh on one of its poses, where places are fixed to it.
pub(crate) struct SmoothCarrier<'a> {
    positions: &'a [Point],
    neighbours: Vec<Vec<usize>>,
    /// By vertex, the mean length of its edges.
    lengths: Vec<f64>,
    others: Vec<Other<'a>>,
}

/// Another pose.
struct Other<'a> {
    positions: &'a [Point],
    /// By vertex, the linear map of what is around it.
    maps: Vec<Matrix>,
    /// A length there beside one here.
    scale: f64,
}

/// A place of the pose, and how what is around it goes to another.
struct Expected<'a> {
    positions: &'a [Point],
    map: Matrix,
    place: Point,
    radius: f64,
}

impl<'a> SmoothCarrier<'a> {
    /// The mesh `topology` on pose `own` of those whose vertices lie at `poses`.
    pub(crate) fn new(topology: &Topology, poses: &'a [Vec<Point>], own: usize) -> Self {
        let positions = poses[own].as_slice();
        let neighbours = topology.vertex_neighbours();
        let mean = |(v, near): (usize, &Vec<usize>)| {
            let sum: f64 = near.iter().map(|&w| (positions[w] - positions[v]).norm()).sum();
            sum / near.len().max(1) as f64
        };
        let own_area = area(topology, positions);
        let other = |(_, theirs): (usize, &'a Vec<Point>)| Other {
            positions: theirs,
            maps: (neighbours.iter().enumerate())
                .map(|(v, near)| map_around(v, near, positions, theirs))
                .collect(),
            scale: (area(topology, theirs) / own_area).sqrt(),
        };
        let others = poses.iter().enumerate().filter(|(pose, _)| *pose != own);
        Self {
            positions,
            lengths: neighbours.iter().enumerate().map(mean).collect(),
            others: others.map(other).collect(),
            neighbours,
        }
    }

    /// The places of `anchors` with their shares.
    pub(crate) fn points(&self, anchors: &[MeshPoint]) -> SmoothPoints {
        let mut points = SmoothPoints {
            starts: vec![0],
            vertices: Vec::new(),
            shares: Vec::new(),
        };
        let mut near = Vec::new();
        for anchor in anchors {
            if !self.shares(anchor, &mut near) {
                near.clear();
                near.extend(anchor.vertices.iter().copied().zip(anchor.shares));
            }
            points.vertices.extend(near.iter().map(|(vertex, _)| *vertex as u32));
            points.shares.extend(near.iter().map(|(_, share)| *share));
            points.starts.push(points.vertices.len());
        }
        points
    }

    /// What is expected of the vertices around a place in every other pose.
    fn expected(&self, anchor: &MeshPoint, radius: f64) -> Vec<Expected<'a>> {
        let of_pose = |other: &Other<'a>| Expected {
            positions: other.positions,
            map: (anchor.vertices.iter().zip(anchor.shares))
                .map(|(&vertex, share)| other.maps[vertex] * share)
                .sum(),
            place: anchor.at(other.positions),
            radius: radius * other.scale,
        };
        self.others.iter().map(of_pose).collect()
    }

    /// Puts the vertices around a place and their shares into `near`; `false` where they do not say how it moves.
    fn shares(&self, anchor: &MeshPoint, near: &mut Vec<(usize, f64)>) -> bool {
        let place = anchor.at(self.positions);
        let lengths = anchor.vertices.iter().zip(anchor.shares);
        let radius = RADIUS * lengths.map(|(&v, share)| share * self.lengths[v]).sum::<f64>();
        if !(radius > 0.0 && radius.is_finite()) {
            return false;
        }
        let aside = |v: usize| (self.positions[v] - place) / radius;
        let expected = self.expected(anchor, radius);
        // How far a vertex is from where the map around the place has it, the most over the other poses, in radii.
        let bent = |v: usize| {
            let from_place = self.positions[v] - place;
            let off =
                |there: &Expected| (there.positions[v] - (there.place + there.map * from_place)).norm() / there.radius;
            expected.iter().map(off).fold(0.0, f64::max)
        };
        near.clear();
        near.extend(anchor.vertices.iter().map(|&v| (v, 0.0)));
        let mut next = 0;
        while let Some(&(v, _)) = near.get(next) {
            next += 1;
            for &w in &self.neighbours[v] {
                if aside(w).norm_squared() < 1.0 && near.iter().all(|(known, _)| *known != w) {
                    near.push((w, 0.0));
                }
            }
        }
        let mut moments = nalgebra::Matrix3::zeros();
        for (v, weight) in near.iter_mut() {
            let aside = aside(*v);
            let rest = (1.0 - aside.norm_squared()).max(0.0);
            let bent = if rest > 0.0 { bent(*v) / BENT } else { 0.0 };
            *weight = rest * rest * libm::exp(-bent * bent);
            let basis = nalgebra::Vector3::new(1.0, aside.x, aside.y);
            moments += basis * basis.transpose() * *weight;
        }
        let sum = moments[(0, 0)];
        let spread = moments.determinant() / (sum * sum * sum);
        let Some(inverse) = moments.try_inverse().filter(|_| spread > LEAST_SPREAD) else {
            return false;
        };
        let plane = inverse.column(0).into_owned();
        for (v, share) in near.iter_mut() {
            let aside = aside(*v);
            *share *= plane.x + plane.y * aside.x + plane.z * aside.y;
        }
        near.retain(|(_, share)| *share != 0.0);
        true
    }
}

/// The linear map that takes the edges at a vertex nearest to where they are in another pose.
fn map_around(v: usize, neighbours: &[usize], from: &[Point], to: &[Point]) -> Matrix {
    let (mut mixed, mut second) = (Matrix::zeros(), Matrix::zeros());
    for &w in neighbours {
        let (here, there) = (from[w] - from[v], to[w] - to[v]);
        mixed += there * here.transpose();
        second += here * here.transpose();
    }
    second
        .try_inverse()
        .map_or_else(Matrix::identity, |inverse| mixed * inverse)
}

fn area(topology: &Topology, positions: &[Point]) -> f64 {
    let of_triangle = |&triangle: &[usize; 3]| geometry::signed_area(geometry::corners(positions, triangle));
    topology.triangles().iter().map(of_triangle).sum::<f64>().abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::PointLocator;

    /// A strip of squares, each divided in two.
    fn strip(columns: usize) -> (Topology, Vec<Point>) {
        let positions: Vec<Point> = (0..3 * (columns + 1))
            .map(|k| Point::new((k / 3) as f64, (k % 3) as f64))
            .collect();
        let squares = (0..columns).flat_map(|column| (0..2).map(move |row| 3 * column + row));
        let triangles = squares.flat_map(|k| [[k, k + 3, k + 4], [k, k + 4, k + 1]]).collect();
        (Topology::new(positions.len(), triangles).expect("a mesh"), positions)
    }

    fn along(topology: &Topology, positions: &[Point], y: f64) -> (Vec<MeshPoint>, SmoothPoints) {
        let locator = PointLocator::new(topology.triangles(), positions);
        let places = (0..=80).map(|k| Point::new(0.1 * f64::from(k), y));
        let anchors = locator.bind_along(places).expect("in the mesh");
        let smooth = SmoothCarrier::new(topology, &[positions.to_vec()], 0).points(&anchors);
        (anchors, smooth)
    }

    #[test]
    fn affine_maps_are_reproduced() {
        let (topology, positions) = strip(8);
        let (anchors, smooth) = along(&topology, &positions, 0.3);
        let map = |p: &Point| Point::new(2.0 * p.x - 0.7 * p.y + 3.0, 0.4 * p.x + 1.1 * p.y);
        let moved: Vec<Point> = positions.iter().map(map).collect();
        assert_eq!(smooth.len(), anchors.len());
        for (k, anchor) in anchors.iter().enumerate() {
            assert!((smooth.at(k, &positions) - anchor.at(&positions)).norm() < 1e-12);
            assert!((smooth.at(k, &moved) - anchor.at(&moved)).norm() < 1e-11);
        }
    }

    #[test]
    fn a_line_bends_less_where_the_mesh_has_edges() {
        let (topology, positions) = strip(8);
        let (anchors, smooth) = along(&topology, &positions, 0.3);
        // An arc: the mesh turns at every column.
        let bent: Vec<Point> = (positions.iter())
            .map(|p| Point::new((10.0 - p.y) * (0.2 * p.x).sin(), (10.0 - p.y) * (0.2 * p.x).cos()))
            .collect();
        let sharpest = |at: &dyn Fn(usize) -> Point| {
            let turn = |k: usize| {
                let (a, b) = (at(k) - at(k - 1), at(k + 1) - at(k));
                (a.x * b.y - a.y * b.x).atan2(a.dot(&b)).abs()
            };
            (20..60).map(turn).fold(0.0, f64::max)
        };
        let (plain, smoothed) = (sharpest(&|k| anchors[k].at(&bent)), sharpest(&|k| smooth.at(k, &bent)));
        // The arc itself turns by 0.02 from place to place.
        assert!(smoothed < 0.05 && plain > 4.0 * smoothed, "{plain} {smoothed}");
    }

    #[test]
    fn where_another_pose_bends_sharply_so_does_the_line() {
        let (topology, positions) = strip(8);
        // The right half is turned up by a right angle at its lower corner.
        let folded: Vec<Point> = (positions.iter())
            .map(|p| {
                if p.x > 4.0 {
                    Point::new(4.0 + p.y, p.y.min(0.0) - (p.x - 4.0))
                } else {
                    *p
                }
            })
            .collect();
        let locator = PointLocator::new(topology.triangles(), &positions);
        let places = (0..=80).map(|k| Point::new(0.1 * f64::from(k), 0.3));
        let anchors = locator.bind_along(places).expect("in the mesh");
        let unaware = SmoothCarrier::new(&topology, std::slice::from_ref(&positions), 0).points(&anchors);
        let aware = SmoothCarrier::new(&topology, &[positions, folded.clone()], 0).points(&anchors);
        let away = |smooth: &SmoothPoints| {
            let distances = anchors.iter().enumerate();
            let distances = distances.map(|(k, anchor)| (smooth.at(k, &folded) - anchor.at(&folded)).norm());
            distances.fold(0.0, f64::max)
        };
        assert!(
            away(&aware) < 0.6 * away(&unaware),
            "{} {}",
            away(&aware),
            away(&unaware)
        );
    }

    #[test]
    fn what_lies_beside_across_a_gap_does_not_count_and_a_single_triangle_carries() {
        let (topology, positions) = strip(8);
        // The strip once more, right beside it.
        let count = positions.len();
        let both: Vec<Point> = positions
            .iter()
            .copied()
            .chain(positions.iter().map(|p| p + Point::new(0.0, 2.1)))
            .collect();
        let shifted = topology.triangles().iter().map(|t| t.map(|v| v + count));
        let triangles: Vec<[usize; 3]> = topology.triangles().iter().copied().chain(shifted).collect();
        let double = Topology::new(2 * count, triangles).expect("two meshes");
        let (anchors, smooth) = along(&double, &both, 1.9);
        let mut moved = both.clone();
        for p in &mut moved[count..] {
            p.y += 50.0;
        }
        for (k, anchor) in anchors.iter().enumerate() {
            assert!((smooth.at(k, &moved) - anchor.at(&both)).norm() < 1e-12);
        }
        let corner = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point::from);
        let single = Topology::new(3, vec![[0, 1, 2]]).expect("a triangle");
        let anchor = MeshPoint {
            vertices: [0, 1, 2],
            shares: [0.2, 0.3, 0.5],
        };
        let smooth = SmoothCarrier::new(&single, &[corner.to_vec()], 0).points(&[anchor]);
        let moved = corner.map(|p| p * 3.0);
        assert!((smooth.at(0, &moved) - anchor.at(&moved)).norm() < 1e-12);
    }
}
