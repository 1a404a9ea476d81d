//! Where a mapping lies over itself.
//!
//! A pose *lies over itself*, or *overlaps*, where parts of its figure lie over one another; its mesh is then an immersion (`immersed` in the file), no embedding. Poses that do
//! not are *open*. Parts have whole *ranks* from back to front; the depth of a triangle is the rank of its part and a fraction that only tells triangles of one part from one
//! another.

use crate::math::{Point, predicate};
use crate::mesh::{Topology, geometry};

/// The poses in which parts of the figure lie over one another, and the parts. Most mappings have none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlaps {
    /// The poses that lie over themselves, in order.
    pub poses: Vec<OverlappingPose>,
    /// The names of the limbs that were found.
    pub limbs: Vec<String>,
    /// By triangle, its limb; `None` of the trunk. Empty without limbs.
    pub triangle_limb: Vec<Option<usize>>,
}

/// A pose whose mesh lies over itself: every triangle is positive, but a place may be in several.
#[derive(Debug, Clone, PartialEq)]
pub struct OverlappingPose {
    /// Which pose.
    pub pose: usize,
    /// By triangle, how near it is to the eye: the nearer the larger. Triangles that lie over one another differ.
    pub depth: Vec<f64>,
}

impl Overlaps {
    /// Whether nothing lies over anything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// The depths of the triangles in `pose`, if it lies over itself.
    #[must_use]
    pub fn depth(&self, pose: usize) -> Option<&[f64]> {
        let found = self.poses.iter().find(|overlapping| overlapping.pose == pose);
        found.map(|overlapping| overlapping.depth.as_slice())
    }
}

/// Two triangles without a common corner that lie over one another at `positions` and are equally near.
pub(super) fn undecided(topology: &Topology, positions: &[Point], depth: &[f64]) -> Option<[usize; 2]> {
    let triangles = topology.triangles();
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|a, b| depth[*a].total_cmp(&depth[*b]));
    let touch = |a: usize, b: usize| triangles[a].iter().any(|v| triangles[b].contains(v));
    for alike in order.chunk_by(|a, b| depth[*a] == depth[*b]) {
        for (k, &b) in alike.iter().enumerate() {
            let lies_over = |a: &&usize| {
                !touch(**a, b)
                    && lie_over_one_another(
                        geometry::corners(positions, triangles[**a]),
                        geometry::corners(positions, triangles[b]),
                    )
            };
            if let Some(&a) = alike[..k].iter().find(lies_over) {
                return Some([a, b]);
            }
        }
    }
    None
}

/// Whether the insides of two positive triangles meet: no side of either has the other beyond it. Exact.
fn lie_over_one_another(first: [Point; 3], second: [Point; 3]) -> bool {
    let has_beyond = |[a, b, c]: [Point; 3], other: [Point; 3]| {
        let mut sides = [(a, b), (b, c), (c, a)].into_iter();
        sides.any(|(from, to)| other.iter().all(|p| !predicate::is_positive(from, to, *p)))
    };
    !has_beyond(first, second) && !has_beyond(second, first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_lie_over_one_another_have_to_differ() {
        let topology = Topology::new(6, vec![[0, 1, 2], [3, 4, 5]]).expect("a mesh");
        let over = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [0.5, 0.5], [2.5, 0.5], [0.5, 2.5]].map(Point::from);
        let beside = over.map(|p| {
            if p.x + p.y > 0.9 && p.x > 0.4 && p.y > 0.4 {
                p + Point::repeat(1.0)
            } else {
                p
            }
        });
        assert_eq!(undecided(&topology, &over, &[1.0, 1.0]), Some([0, 1]));
        assert_eq!(undecided(&topology, &over, &[1.0, 2.0]), None);
        assert_eq!(undecided(&topology, &beside, &[1.0, 1.0]), None);
    }
}
