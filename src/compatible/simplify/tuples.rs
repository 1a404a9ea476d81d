//! Rings of corresponding vertices: what the simplification works on.

use crate::matching::Correspondence;
use crate::math::Point;
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
    /// A landmark: may be displaced, but never merged into another vertex.
    pub(super) pinned: bool,
}

impl TupleRing {
    /// The vertices of one pose's ring, as tuples of one.
    pub(super) fn single(ring: &Ring, pinned_parameters: &[f64]) -> Self {
        let arc = ArcLength::new(ring);
        let mut stations: Vec<(f64, bool)> = arc.vertex_parameters().iter().map(|&t| (t, false)).collect();
        stations.extend(pinned_parameters.iter().map(|&t| (t, true)));
        stations.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        stations.dedup_by(|later, earlier| later.0 == earlier.0);
        let tuples = stations
            .into_iter()
            .map(|(t, pinned)| Tuple {
                points: vec![arc.at(t)],
                parameters: vec![t],
                pinned,
            })
            .collect();
        Self { tuples }
    }

    /// Joins one simplified ring a pose into a ring of tuples. Every vertex of every pose becomes a tuple; on the other
    /// poses it lies on the edge at the corresponding parameter. Vertices of different poses that correspond to within
    /// `merge_distance` (of the parameter, on every pose) share a tuple.
    pub(super) fn joined(singles: &[TupleRing], correspondence: &Correspondence, merge_distance: f64) -> Self {
        struct Station {
            coordinate: f64,
            pose: usize,
            vertex: usize,
            pinned: bool,
        }
        let mut stations: Vec<Station> = Vec::new();
        for (pose, single) in singles.iter().enumerate() {
            for (vertex, tuple) in single.tuples.iter().enumerate() {
                let coordinate = correspondence.row_coordinate(pose, tuple.parameters[0]);
                stations.push(Station {
                    coordinate,
                    pose,
                    vertex,
                    pinned: tuple.pinned,
                });
            }
        }
        stations.sort_by(|a, b| a.coordinate.total_cmp(&b.coordinate).then(a.pose.cmp(&b.pose)));

        let mut tuples: Vec<Tuple> = Vec::new();
        let mut start = 0;
        while start < stations.len() {
            let place = |s: &Station, pose: usize| {
                if s.pose == pose {
                    singles[pose].tuples[s.vertex].parameters[0]
                } else {
                    correspondence.parameter(pose, s.coordinate)
                }
            };
            let near = |s: &Station| {
                (0..singles.len())
                    .all(|pose| parameter_gap(place(s, pose), place(&stations[start], pose)) <= merge_distance)
            };
            let mut end = start + 1;
            while end < stations.len() {
                let s = &stations[end];
                let repeats = stations[start..end].iter().any(|other| other.pose == s.pose);
                // A landmark's tuple is made of that landmark on every pose and of nothing else.
                let mixes = stations[start].pinned != s.pinned;
                if repeats || mixes || !near(s) {
                    break;
                }
                end += 1;
            }
            let group = &stations[start..end];
            let pinned = group.iter().any(|s| s.pinned);
            let centre = group.iter().map(|s| s.coordinate).sum::<f64>() / group.len() as f64;
            let mut tuple = Tuple {
                points: Vec::new(),
                parameters: Vec::new(),
                pinned,
            };
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
                tuple.parameters.push(t);
                tuple.points.push(point);
            }
            tuples.push(tuple);
            start = end;
        }
        let mut ring = Self { tuples };
        ring.drop_repeated(singles.len());
        ring
    }

    /// The point at parameter `t` of a ring of one pose: linear in the parameter between its vertices.
    fn point_at(&self, t: f64) -> Point {
        let count = self.tuples.len();
        let after = self.tuples.partition_point(|tuple| tuple.parameters[0] <= t);
        let (before, after) = (&self.tuples[(after + count - 1) % count], &self.tuples[after % count]);
        let (start, end) = (before.parameters[0], after.parameters[0]);
        let span = (end - start).rem_euclid(1.0);
        let along = if span > 0.0 {
            ((t - start).rem_euclid(1.0) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (a, b) = (before.points[0], after.points[0]);
        if along == 0.0 { a } else { a + (b - a) * along }
    }

    /// Drops tuples that coincide with their predecessor in some pose (two stations nearer than rounding), or whose
    /// parameter does not follow it.
    fn drop_repeated(&mut self, poses: usize) {
        let mut kept: Vec<Tuple> = Vec::with_capacity(self.tuples.len());
        for tuple in self.tuples.drain(..) {
            let follows = |earlier: &Tuple| {
                (0..poses).all(|pose| {
                    let step = (tuple.parameters[pose] - earlier.parameters[pose]).rem_euclid(1.0);
                    tuple.points[pose] != earlier.points[pose] && step > 0.0 && step < 0.5
                })
            };
            match kept.last() {
                Some(last) if !follows(last) => {
                    if tuple.pinned && !last.pinned {
                        kept.pop();
                        kept.push(tuple);
                    }
                }
                _ => kept.push(tuple),
            }
        }
        while kept.len() > 3 && (0..poses).any(|p| kept[0].points[p] == kept[kept.len() - 1].points[p]) {
            kept.pop();
        }
        self.tuples = kept;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joining_keeps_every_vertex_of_every_pose() {
        let square = Ring::new([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::from)).expect("a ring");
        let diamond = Ring::new([[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]].map(Point::from)).expect("a ring");
        let singles = [TupleRing::single(&square, &[]), TupleRing::single(&diamond, &[])];
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
}
