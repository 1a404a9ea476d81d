//! Rings of corresponding vertices: what the simplification works on.

use super::RingPoint;
use crate::matching::Correspondence;
use crate::math::{Point, point, wrapped};
use crate::outline::{ArcLength, Ring, parameter_gap};

/// A closed ring of vertex tuples: vertex `k` has one point and one boundary parameter in every pose.
#[derive(Debug, Clone, Default)]
pub(super) struct TupleRing {
    pub(super) tuples: Vec<Tuple>,
}

/// One vertex in all poses.
#[derive(Debug, Clone)]
pub(super) struct Tuple {
    /// Its place, per pose.
    pub(super) points: Vec<Point>,
    /// The arc-length parameter on the pose's full-resolution ring that it stands for, per pose.
    pub(super) parameters: Vec<f64>,
    /// The landmark that it is, if any: then it stays, and stays where it is.
    pub(super) landmark: Option<usize>,
}

/// A landmark on one of a pose's rings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pin {
    /// Which one; the same on every pose.
    pub(super) landmark: usize,
    /// Its place on this pose.
    pub(super) at: RingPoint,
}

/// Stations whose row coordinates differ by no more are at the same place: a few thousand times what rounding does to a
/// coordinate.
const SAME_COORDINATE: f64 = 1e-9;

/// A vertex of one pose, on its way into a tuple.
struct Station {
    coordinate: f64,
    pose: usize,
    /// Its tuple in the pose's single ring.
    vertex: usize,
    landmark: Option<usize>,
}

impl TupleRing {
    /// The vertices of one pose's ring, its ring `number`, as tuples of one, with those of the pose's landmarks that are on it.
    pub(super) fn single(ring: &Ring, number: usize, pins: &[Pin]) -> Self {
        let arc = ArcLength::new(ring);
        let vertices = arc.vertex_parameters().iter().map(|&t| (t, None));
        let mut stations: Vec<(f64, Option<usize>)> = vertices.collect();
        let pins = pins.iter().filter(|pin| pin.at.ring == number);
        stations.extend(pins.map(|pin| (pin.at.parameter, Some(pin.landmark))));
        // Landmarks first where parameters are equal.
        let is_vertex = |station: &(f64, Option<usize>)| station.1.is_none();
        stations.sort_by(|a, b| a.0.total_cmp(&b.0).then(is_vertex(a).cmp(&is_vertex(b))));
        stations.dedup_by(|later, earlier| later.0 == earlier.0);
        let tuples = stations
            .into_iter()
            .map(|(t, landmark)| Tuple {
                points: vec![arc.at(t)],
                parameters: vec![t],
                landmark,
            })
            .collect();
        Self { tuples }
    }

    /// Joins one simplified ring a pose into a ring of tuples. Every vertex of every pose becomes a tuple; on the other
    /// poses it lies on the edge at the corresponding parameter. Vertices of different poses that correspond to within
    /// `merge_distance` (of the parameter, on every pose) share a tuple. A landmark's tuple is made of that landmark on
    /// every pose and of nothing else.
    ///
    /// In every pose the tuples follow one another strictly, in place and in parameter; vertices no farther apart than
    /// rounding are lost to that.
    pub(super) fn joined(singles: &[TupleRing], correspondence: &Correspondence, merge_distance: f64) -> Self {
        let stations = stations(singles, correspondence, merge_distance);
        let mut joined: Vec<(Tuple, Vec<f64>)> = Vec::new();
        let mut start = 0;
        while start < stations.len() {
            let end = end_of_group(&stations, start, singles, correspondence, merge_distance);
            let group = &stations[start..end];
            let centre = group.iter().map(|s| s.coordinate).sum::<f64>() / group.len() as f64;
            let mut tuple = Tuple {
                points: Vec::new(),
                parameters: Vec::new(),
                landmark: stations[start].landmark,
            };
            let mut distances = Vec::new();
            for (pose, single) in singles.iter().enumerate() {
                let (t, point) = match group.iter().find(|s| s.pose == pose) {
                    Some(own) => {
                        let vertex = &single.tuples[own.vertex];
                        (vertex.parameters[0], vertex.points[0])
                    }
                    None => {
                        let t = correspondence.parameter(pose, centre);
                        (t, single.point_at(t))
                    }
                };
                distances.push(distance_along(correspondence, pose, centre, t));
                tuple.parameters.push(t);
                tuple.points.push(point);
            }
            joined.push((tuple, distances));
            start = end;
        }
        Self {
            tuples: in_order(joined),
        }
    }

    /// Twice the signed area of the ring in one pose.
    pub(super) fn doubled_area(&self, pose: usize) -> f64 {
        let Some(first) = self.tuples.first() else { return 0.0 };
        let from_first = |tuple: &Tuple| tuple.points[pose] - first.points[pose];
        let edges = self.tuples.iter().zip(self.tuples.iter().skip(1));
        edges.map(|(a, b)| point::cross(from_first(a), from_first(b))).sum()
    }

    /// The point at parameter `t` of a ring of one pose: linear in the parameter between its vertices.
    fn point_at(&self, t: f64) -> Point {
        let count = self.tuples.len();
        let after = self.tuples.partition_point(|tuple| tuple.parameters[0] <= t);
        let (before, after) = (&self.tuples[(after + count - 1) % count], &self.tuples[after % count]);
        let (start, end) = (before.parameters[0], after.parameters[0]);
        let span = wrapped(end - start);
        let along = if span > 0.0 {
            (wrapped(t - start) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (a, b) = (before.points[0], after.points[0]);
        if along == 0.0 { a } else { a + (b - a) * along }
    }
}

/// The vertices of all poses in the order of the correspondence; those of one landmark have one coordinate.
fn stations(singles: &[TupleRing], correspondence: &Correspondence, merge_distance: f64) -> Vec<Station> {
    let mut stations: Vec<Station> = Vec::new();
    for (pose, single) in singles.iter().enumerate() {
        for (vertex, tuple) in single.tuples.iter().enumerate() {
            let t = tuple.parameters[0];
            let mut coordinate = correspondence.row_coordinate(pose, t);
            if tuple.landmark.is_some()
                && let Some(first) = stations.iter().find(|s| s.landmark == tuple.landmark)
                && parameter_gap(t, correspondence.parameter(pose, first.coordinate)) <= merge_distance
            {
                coordinate = first.coordinate;
            }
            stations.push(Station {
                coordinate,
                pose,
                vertex,
                landmark: tuple.landmark,
            });
        }
    }
    stations.sort_by(|a, b| {
        let same_place = || a.landmark.cmp(&b.landmark).then(a.pose.cmp(&b.pose));
        a.coordinate.total_cmp(&b.coordinate).then_with(same_place)
    });
    stations
}

/// One past the last station that shares a tuple with the one at `start`.
fn end_of_group(
    stations: &[Station],
    start: usize,
    singles: &[TupleRing],
    correspondence: &Correspondence,
    merge_distance: f64,
) -> usize {
    let first = &stations[start];
    let place = |s: &Station, pose: usize| {
        if s.pose == pose {
            singles[pose].tuples[s.vertex].parameters[0]
        } else {
            correspondence.parameter(pose, s.coordinate)
        }
    };
    let near = |s: &Station| {
        (0..singles.len()).all(|pose| parameter_gap(place(s, pose), place(first, pose)) <= merge_distance)
    };
    let mut end = start + 1;
    while let Some(s) = stations.get(end) {
        let repeats = stations[start..end].iter().any(|other| other.pose == s.pose);
        if repeats || s.landmark != first.landmark || !near(s) {
            break;
        }
        end += 1;
    }
    // A group may not end among stations at one place: the next one's tuple would be where this one's is.
    let is_apart = |end: usize| {
        let next = stations.get(end);
        next.is_none_or(|next| next.coordinate - stations[end - 1].coordinate > SAME_COORDINATE)
    };
    match first.landmark {
        Some(_) => end,
        None => (start + 1..=end).rev().find(|&end| is_apart(end)).unwrap_or(end),
    }
}

/// How far along a pose, counted from the first row's place, a vertex at parameter `t` lies that stands at `coordinate`, or
/// next to it. Not taken modulo 1: it increases once around.
fn distance_along(correspondence: &Correspondence, pose: usize, coordinate: f64, t: f64) -> f64 {
    let rows = correspondence.rows();
    let row = (coordinate.floor() as usize).min(rows.len() - 1);
    let (from, to) = (rows[row][pose], rows[(row + 1) % rows.len()][pose]);
    let step = wrapped(to - from) * (coordinate - row as f64);
    let off = wrapped(t - (from + step));
    let signed = if off > 0.5 { off - 1.0 } else { off };
    wrapped(from - rows[0][pose]) + step + signed
}

/// The tuples without those that do not follow their predecessor in some pose, in place or in distance along it; of two,
/// a landmark stays.
fn in_order(joined: Vec<(Tuple, Vec<f64>)>) -> Vec<Tuple> {
    let follows = |(earlier, before): &(Tuple, Vec<f64>), (later, after): &(Tuple, Vec<f64>), lap: f64| {
        let moves = earlier.points.iter().zip(&later.points).all(|(a, b)| a != b);
        moves && before.iter().zip(after).all(|(a, b)| *a < *b + lap)
    };
    let mut kept: Vec<(Tuple, Vec<f64>)> = Vec::with_capacity(joined.len());
    for tuple in joined {
        while let Some(last) = kept.last()
            && !follows(last, &tuple, 0.0)
            && last.0.landmark.is_none()
            && tuple.0.landmark.is_some()
        {
            kept.pop();
        }
        if kept.last().is_none_or(|last| follows(last, &tuple, 0.0)) {
            kept.push(tuple);
        }
    }
    while kept.len() > 3 && !follows(&kept[kept.len() - 1], &kept[0], 1.0) {
        if kept[0].0.landmark.is_none() && kept[kept.len() - 1].0.landmark.is_some() {
            kept.remove(0);
        } else {
            kept.pop();
        }
    }
    kept.into_iter().map(|(tuple, _)| tuple).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joining_keeps_every_vertex_of_every_pose() {
        let square = Ring::new([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::from)).expect("a ring");
        let diamond = Ring::new([[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]].map(Point::from)).expect("a ring");
        let singles = [TupleRing::single(&square, 0, &[]), TupleRing::single(&diamond, 0, &[])];
        let shifted =
            Correspondence::new(vec![vec![0.0, 0.125], vec![0.5, 0.625], vec![0.75, 0.875]]).expect("monotone");
        let joined = TupleRing::joined(&singles, &shifted, 0.0);
        assert_eq!(joined.tuples.len(), 8);
        for (pose, ring) in [square, diamond].iter().enumerate() {
            for p in ring.points() {
                assert!(joined.tuples.iter().any(|t| t.points[pose] == *p));
            }
        }
        let merged = TupleRing::joined(&singles, &shifted, 0.2);
        assert_eq!(merged.tuples.len(), 4);
    }

    fn vertex(t: f64, place: [f64; 2], landmark: Option<usize>) -> Tuple {
        Tuple {
            points: vec![place.into()],
            parameters: vec![t],
            landmark,
        }
    }

    fn ring(tuples: &[Tuple]) -> TupleRing {
        TupleRing {
            tuples: tuples.to_vec(),
        }
    }

    #[test]
    fn a_vertex_may_stand_for_more_than_half_of_a_ring() {
        // As a long thin outline of which three vertices are left: each follows the one before, by however much.
        let thin = ring(&[
            vertex(0.1, [0.0, 0.0], None),
            vertex(0.2, [1.0, 0.0], None),
            vertex(0.8, [1.0, 1.0], None),
        ]);
        let joined = TupleRing::joined(&[thin], &Correspondence::identity(1, 8), 1e-3);
        let parameters: Vec<f64> = joined.tuples.iter().map(|tuple| tuple.parameters[0]).collect();
        assert_eq!(parameters, [0.1, 0.2, 0.8]);
    }

    #[test]
    fn a_landmark_keeps_its_place_beside_vertices_it_could_share_a_tuple_with() {
        let with_landmark = |at: f64, beside: f64| {
            ring(&[
                vertex(at, [at, 0.0], Some(4)),
                vertex(beside, [beside, 0.0], None),
                vertex(0.5, [0.5, 1.0], None),
                vertex(0.9, [0.9, 1.0], None),
            ])
        };
        // Off the correspondence by rounding, so that a vertex comes between the two halves of the landmark.
        let singles = [with_landmark(0.2, 0.2 + 2e-12), with_landmark(0.2 + 1e-12, 0.2 + 5e-4)];
        let joined = TupleRing::joined(&singles, &Correspondence::identity(2, 8), 1e-3);
        let marked: Vec<&Tuple> = joined.tuples.iter().filter(|tuple| tuple.landmark == Some(4)).collect();
        assert_eq!(marked.len(), 1);
        for (pose, single) in singles.iter().enumerate() {
            assert_eq!(marked[0].points[pose], single.tuples[0].points[0]);
            assert_eq!(marked[0].parameters[pose], single.tuples[0].parameters[0]);
        }
    }

    #[test]
    fn no_corner_is_lost_among_vertices_at_one_place() {
        // The first pose's two vertices and one of the second's at 0.2: none of them is dropped for following another.
        let first = [
            vertex(0.2 - 5e-4, [0.0, 0.0], None),
            vertex(0.2, [1.0, 0.0], None),
            vertex(0.6, [1.0, 1.0], None),
        ];
        let second = [
            vertex(0.2, [2.0, 0.0], None),
            vertex(0.5, [2.0, 2.0], None),
            vertex(0.9, [0.0, 2.0], None),
        ];
        for singles in [[ring(&first), ring(&second)], [ring(&second), ring(&first)]] {
            let joined = TupleRing::joined(&singles, &Correspondence::identity(2, 8), 1e-3);
            for (pose, single) in singles.iter().enumerate() {
                for tuple in &single.tuples {
                    let place = tuple.points[0];
                    assert!(
                        joined.tuples.iter().any(|t| t.points[pose] == place),
                        "{place} of {pose}"
                    );
                }
            }
        }
    }
}
