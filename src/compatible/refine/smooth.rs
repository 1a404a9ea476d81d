//! Angle-based smoothing (Zhou and Shimada 2000, as NWM 3.1 uses it): a vertex moves to where the angles at each of its
//! neighbours would be halved, in each pose by itself.

use rayon::prelude::*;

use super::super::editable::EditableMesh;
use super::star::{self, Stars};
use crate::math::{Point, angle, rotation};

/// Smooths every movable vertex of every pose, `sweeps` times. A move is taken if it leaves all triangles positive and
/// does not lower the smallest angle around the vertex.
pub(super) fn smooth(mesh: &mut EditableMesh, stars: &Stars, sweeps: usize) {
    mesh.positions.par_iter_mut().for_each(|positions| {
        for _ in 0..sweeps {
            for (vertex, opposite) in stars.iter() {
                let now = star::smallest_angle_rad(positions, positions[vertex], opposite);
                let target = balanced(positions, vertex, opposite);
                // The whole way, or half of it.
                for share in [1.0, 0.5] {
                    let place = positions[vertex] + (target - positions[vertex]) * share;
                    if star::smallest_angle_rad(positions, place, opposite) > now
                        && star::is_positive(positions, place, opposite)
                    {
                        positions[vertex] = place;
                        break;
                    }
                }
            }
        }
    });
}

/// The mean of the places that would halve the angle at each neighbour. Each opposite edge `(a, b)` gives one half of
/// the angle at `a` and one at `b`; turning by half the difference of a neighbour's two halves balances them.
fn balanced(positions: &[Point], vertex: usize, opposite: &[(usize, usize)]) -> Point {
    let centre = positions[vertex];
    let mut sum = Point::zeros();
    let mut count = 0.0;
    for &(a, b) in opposite {
        // The triangle before `a` around the centre ends in `a`.
        let Some(&(before, _)) = opposite.iter().find(|edge| edge.1 == a) else {
            continue;
        };
        let spoke = centre - positions[a];
        let to_next = angle::between(positions[b] - positions[a], spoke);
        let to_previous = angle::between(spoke, positions[before] - positions[a]);
        sum += positions[a] + rotation(0.5 * (to_previous - to_next)) * spoke;
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { centre }
}
