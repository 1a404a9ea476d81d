//! A guide says where places of one pose are in the others; the mesh follows it as far as its triangles stay positive.

use super::super::editable::{Curves, EditableMesh};
use super::distortion::{self, Target};
use super::star::Stars;
use super::{flip, split};
use crate::math::Point;
use crate::mesh::directed_edges;

/// Sweeps of the other poses between two looks at where the reference's vertices are now.
const SWEEPS_A_ROUND: usize = 10;

/// How far from straight the guide may take an edge, as a fraction of the pose's diagonal: two pixels of a drawing of 700.
const LARGEST_BEND: f64 = 0.003;
/// Rounds of splitting edges that are bent by more.
const BEND_ROUNDS: usize = 4;
/// Edges shorter than this share of the length that all are split to are not split further.
const SHORTEST: f64 = 0.25;
/// Between these trust counts: blank places still follow what is around them, and certain ones leave the triangles some say. With ten times as much
/// edges of hair that slides over a forehead come out kinked.
const LEAST_TRUST: f64 = 0.2;
const MOST_TRUST: f64 = 4.0;

/// Knows where the places of one pose, the reference, are in the others, for instance by what is drawn there.
pub trait Guide: Sync {
    /// The pose whose places it knows.
    fn reference(&self) -> usize;

    /// Where `place` of the reference is in `pose`; `None` where it does not know.
    fn carried(&self, pose: usize, place: Point) -> Option<Point>;

    /// How surely it knows that: 1 where it is clear, more where it is certain, 0 where it is a guess. Where hair slides over a forehead the forehead
    /// is squeezed, and has to give way.
    fn trust(&self, pose: usize, place: Point) -> f64 {
        let _ = (pose, place);
        1.0
    }
}

/// Least distortion with at most `sweeps` sweeps, vertices of the other poses drawn to where the guide has them.
pub(super) fn minimise(mesh: &mut EditableMesh, stars: &Stars, sweeps: usize, guide: Option<&dyn Guide>) {
    let Some(guide) = guide else {
        return distortion::minimise(mesh, stars, sweeps, &[]);
    };
    for _ in 0..sweeps.div_ceil(SWEEPS_A_ROUND) {
        let targets: Vec<Option<Vec<Option<Target>>>> = (0..mesh.pose_count())
            .map(|pose| {
                let places = &mesh.positions[guide.reference()];
                let carried = |p: &Point| {
                    Some(Target {
                        place: guide.carried(pose, *p)?,
                        trust: guide.trust(pose, *p).clamp(LEAST_TRUST, MOST_TRUST),
                    })
                };
                (pose != guide.reference()).then(|| places.iter().map(carried).collect())
            })
            .collect();
        distortion::minimise(mesh, stars, SWEEPS_A_ROUND.min(sweeps), &targets);
    }
}

/// Splits edges that the guide bends, and smooths after each round.
///
/// An edge is bent where the guide takes its middle farther than [`LARGEST_BEND`] from the middle of where it takes its ends: there the mesh,
/// linear in between, would be off by that much. Returns the flips.
pub(super) fn refine_where_bent(
    mesh: &mut EditableMesh,
    curves: &mut Curves,
    diagonals: &[f64],
    edge_length: f64,
    guide: &dyn Guide,
) -> usize {
    let mut flips = 0;
    let reference = guide.reference();
    for _ in 0..BEND_ROUNDS {
        let places = &mesh.positions[reference];
        let mut bent: Vec<(f64, usize, usize)> = Vec::new();
        for (_, triangle) in mesh.triangles() {
            for (a, b) in directed_edges(triangle) {
                let (from, to) = (places[a], places[b]);
                // Of the two triangles at an edge inside, one has it in this order.
                if a > b
                    || mesh.opposite(b, a).is_none()
                    || (to - from).norm() < SHORTEST * edge_length * diagonals[reference]
                {
                    continue;
                }
                let bend = (0..mesh.pose_count())
                    .filter(|pose| *pose != reference)
                    .filter_map(|pose| {
                        let middle = guide.carried(pose, (from + to) * 0.5)?;
                        let ends = (guide.carried(pose, from)? + guide.carried(pose, to)?) * 0.5;
                        Some((middle - ends).norm() / diagonals[pose])
                    });
                let bend = bend.fold(0.0, f64::max);
                if bend > LARGEST_BEND {
                    bent.push((bend, a, b));
                }
            }
        }
        if bent.is_empty() {
            break;
        }
        bent.sort_by(|x, y| y.0.total_cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        split::split_inner_edges(mesh, curves, &bent);
        flips += flip::flip(mesh, &curves.paths);
        minimise(mesh, &Stars::new(mesh, curves), SWEEPS_A_ROUND, Some(guide));
        flips += flip::flip(mesh, &curves.paths);
    }
    flips
}
