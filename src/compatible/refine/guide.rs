//! A guide says where places of one pose are in the others; the mesh follows it as far as its triangles stay positive.

use super::super::editable::EditableMesh;
use super::distortion;
use super::star::Stars;
use crate::math::Point;

/// Sweeps of the other poses between two looks at where the reference's vertices are now.
const SWEEPS_A_ROUND: usize = 10;

/// Knows where the places of one pose, the reference, are in the others, for instance by what is drawn there.
pub trait Guide: Sync {
    /// The pose whose places it knows.
    fn reference(&self) -> usize;

    /// Where `place` of the reference is in `pose`; `None` where it does not know.
    fn carried(&self, pose: usize, place: Point) -> Option<Point>;
}

/// Least distortion with at most `sweeps` sweeps, vertices of the other poses drawn to where the guide has them.
pub(super) fn minimise(mesh: &mut EditableMesh, stars: &Stars, sweeps: usize, guide: Option<&dyn Guide>) {
    let Some(guide) = guide else {
        return distortion::minimise(mesh, stars, sweeps, &[]);
    };
    for _ in 0..sweeps.div_ceil(SWEEPS_A_ROUND) {
        let targets: Vec<Option<Vec<Option<Point>>>> = (0..mesh.pose_count())
            .map(|pose| {
                let places = &mesh.positions[guide.reference()];
                let carried = |p: &Point| guide.carried(pose, *p);
                (pose != guide.reference()).then(|| places.iter().map(carried).collect())
            })
            .collect();
        distortion::minimise(mesh, stars, SWEEPS_A_ROUND.min(sweeps), &targets);
    }
}
