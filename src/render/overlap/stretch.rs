//! How much the triangles of a frame are stretched, which says what of a mesh that lies over itself is worth showing.
//!
//! At the joint of a limb that lies within another part's silhouette, the mesh is drawn from one to the other across what is there. What is stretched least is seen in front; what is
//! torn is not shown at all: the colours around it go on.

use crate::math::Point;
use crate::mesh::{Topology, geometry};

/// Rounds of averaging over neighbouring triangles, so that what lies in front does not change from triangle to triangle.
const ROUNDS: usize = 4;
/// A triangle that is stretched more than this, as of [`geometry::stretch`], those around it counted, is torn.
const TORN: f64 = 2.5;

/// A mesh at rest.
#[derive(Debug, Clone)]
pub(super) struct AtRest {
    topology: Topology,
    positions: Vec<Point>,
}

impl AtRest {
    pub(super) fn new(topology: &Topology, positions: &[Point]) -> Self {
        Self {
            topology: topology.clone(),
            positions: positions.to_vec(),
        }
    }

    pub(super) fn triangles(&self) -> &[[usize; 3]] {
        self.topology.triangles()
    }

    /// By triangle, how much it and those around it are stretched where the vertices are at `positions`.
    pub(super) fn stretches(&self, positions: &[Point]) -> Vec<f64> {
        let of = |triangle: &[usize; 3]| {
            let [from, to] = [&self.positions, positions].map(|at| geometry::corners(at, *triangle));
            geometry::stretch(from, to)
        };
        let mut stretches: Vec<f64> = self.triangles().iter().map(of).collect();
        let around = self.topology.neighbours();
        for _ in 0..ROUNDS {
            let mean = |t: usize| {
                let all = around[t].iter().flatten().map(|other| stretches[*other]);
                let (sum, count) = all.fold((stretches[t], 1.0), |(sum, count), other| (sum + other, count + 1.0));
                sum / count
            };
            stretches = (0..stretches.len()).map(mean).collect();
        }
        stretches
    }
}

/// Those of some triangles that are not torn, the least stretched last.
pub(super) fn in_order(triangles: &[usize], stretches: &[f64]) -> Vec<usize> {
    // A triangle without area is stretched by what is no number, or infinitely.
    let mut shown: Vec<usize> = (triangles.iter().copied()).filter(|t| stretches[*t] <= TORN).collect();
    shown.sort_by(|a, b| stretches[*b].total_cmp(&stretches[*a]));
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stretched_least_comes_last_and_what_is_torn_does_not_come() {
        // Three squares in a row, of which the middle one is drawn out.
        let row =
            |x: [f64; 4]| -> Vec<Point> { x.iter().flat_map(|x| [0.0, 1.0].map(|y| Point::new(*x, y))).collect() };
        let triangles = (0..3).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 1], [2 * k + 1, 2 * k + 2, 2 * k + 3]]);
        let topology = Topology::new(8, triangles.collect()).expect("a strip");
        let rest = AtRest::new(&topology, &row([0.0, 1.0, 2.0, 3.0]));
        let all = [0, 1, 2, 3, 4, 5];
        assert_eq!(in_order(&all, &rest.stretches(&row([0.0, 1.0, 2.0, 3.0]))).len(), 6);
        let drawn_out = rest.stretches(&row([0.0, 1.0, 3.0, 4.0]));
        let order = in_order(&all, &drawn_out);
        assert!([2, 3].contains(&order[0]) && [0, 5].contains(&order[5]), "{order:?}");
        let torn = in_order(&all, &rest.stretches(&row([0.0, 1.0, 21.0, 22.0])));
        assert!(!torn.contains(&2) && !torn.contains(&3), "{torn:?}");
    }
}
