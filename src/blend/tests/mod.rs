//! Properties of the blend, and numbers from an independent implementation (numpy, dense and sparse).

mod guard;
mod holding;
mod turns;

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::math::{Point, rotation as rotation_matrix};
use crate::mesh::{Topology, geometry};
use crate::pose::PoseSet;
use crate::solve::DenseMatrix;

const REFERENCES: [Reference; 3] = [Reference::Canonical, Reference::Pose(0), Reference::Pose(1)];
const STRETCHES: [Stretch; 3] = [Stretch::Linear, Stretch::Limited, Stretch::Log];

/// A grid of `columns` x `rows` vertices with alternating diagonals, x and y in whole steps.
fn grid(columns: usize, rows: usize) -> (Topology, Vec<Point>) {
    let positions = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| Point::new(i as f64, j as f64)))
        .collect();
    let mut triangles = Vec::new();
    for j in 0..rows - 1 {
        for i in 0..columns - 1 {
            let a = j * columns + i;
            let (b, c, d) = (a + 1, a + columns, a + columns + 1);
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, d], [a, d, c]]);
            } else {
                triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
    }
    (Topology::new(columns * rows, triangles).expect("a mesh"), positions)
}

fn pose_set(topology: &Topology, poses: &[Vec<Point>]) -> PoseSet {
    let named = poses.iter().enumerate().map(|(k, p)| (format!("p{k}"), p.clone()));
    PoseSet::new(topology.clone(), named.collect()).expect("poses")
}

fn options(reference: Reference, stretch: Stretch) -> BlendOptions {
    BlendOptions {
        reference,
        stretch,
        ..BlendOptions::default()
    }
}

fn largest_difference(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max)
}

fn unit(count: usize, k: usize) -> Vec<f64> {
    (0..count).map(|i| if i == k { 1.0 } else { 0.0 }).collect()
}

/// Three bent 3 x 3 grids.
fn bent() -> (Topology, Vec<Vec<Point>>) {
    let (topology, flat) = grid(3, 3);
    let turned = [
        [3.0, 1.0],
        [2.484375, 2.421875],
        [2.203125, 3.9375],
        [2.21875, 0.921875],
        [1.703125, 2.328125],
        [1.421875, 3.84375],
        [1.21875, 1.28125],
        [0.703125, 2.703125],
        [0.421875, 4.21875],
    ];
    let upright = [
        [0.0, -2.0],
        [0.0, -0.75],
        [0.0, 0.5],
        [-1.0, -2.0],
        [-0.875, -0.75],
        [-0.75, 0.5],
        [-2.0, -2.0],
        [-1.75, -0.75],
        [-1.5, 0.5],
    ];
    let points = |list: [[f64; 2]; 9]| list.map(Point::from).to_vec();
    (topology, vec![flat, points(turned), points(upright)])
}

#[test]
fn agrees_with_the_independent_implementation() {
    let (topology, poses) = bent();
    let cases = [
        (
            [0.2, 0.3, 0.5],
            Stretch::Linear,
            [
                [0.841404922101856, -0.9581933890227414],
                [1.099385274762576, 0.29033563555491027],
                [1.4246710230391466, 1.5334536366695926],
                [-0.05260828270811513, -0.7034567815159487],
                [0.2598594836325526, 0.5272646768605547],
                [0.6430876251521574, 1.7558881445069792],
                [-0.9590318524857901, -0.2945532639916405],
                [-0.5882276962256348, 0.9240765002971909],
                [-0.15280644816640654, 2.1355783100594374],
            ],
        ),
        (
            [1.5, -0.25, -0.25],
            Stretch::Limited,
            [
                [-0.11693821991510567, 1.1235936893510663],
                [0.55773867301265, 0.38209804011965465],
                [1.257345592350421, -0.34684939855221497],
                [0.609378697970461, 1.7810352866948362],
                [1.299468633526001, 1.0527209664067856],
                [2.003487155098016, 0.3486478494378358],
                [1.295674210864192, 2.4795278951652744],
                [1.9906911561977545, 1.7759869196905382],
                [2.7086544503176064, 1.0849196024658656],
            ],
        ),
    ];
    for (weights, stretch, expected) in cases {
        let found = blend_once(
            &pose_set(&topology, &poses),
            &options(Reference::Pose(0), stretch),
            &weights,
        )
        .expect("a blend");
        let difference = largest_difference(&found, &expected.map(Point::from));
        assert!(difference < 1e-12, "{stretch:?}: {difference:e}");
    }
}

#[test]
fn sparse_equals_dense() {
    // Dense least squares over explicit corner differences, x and y apart.
    let (topology, poses) = bent();
    let weights = [0.6, 0.7, -0.3];
    let set = pose_set(&topology, &poses);
    for reference in REFERENCES {
        let edges = reference::reference_edges(&set, reference).expect("positive");
        let blend = RigidBlend::new(&set, &options(reference, Stretch::Linear)).expect("a blend");
        let angles: Vec<Vec<f64>> = (0..3).map(|pose| blend.angles_rad(pose).collect()).collect();
        let rows = 2 * edges.len();
        let mut system = vec![vec![0.0; 9]; rows];
        let mut right = vec![[0.0; 2]; rows];
        for (t, (&triangle, edge)) in topology.triangles().iter().zip(&edges).enumerate() {
            let inverse = edge.try_inverse().expect("positive");
            let angle: f64 = angles.iter().zip(weights).map(|(a, w)| a[t] * w).sum();
            let mut stretch = crate::math::Matrix::zeros();
            for ((pose, angles), weight) in poses.iter().zip(&angles).zip(weights) {
                let map = geometry::edge_matrix(geometry::corners(pose, triangle)) * inverse;
                stretch += rotation_matrix(-angles[t]) * map * weight;
            }
            let target = rotation_matrix(angle) * stretch;
            let scale = (0.5 * edge.determinant()).sqrt();
            for d in 0..2 {
                let row = 2 * t + d;
                system[row][triangle[1]] += scale * inverse[(0, d)];
                system[row][triangle[2]] += scale * inverse[(1, d)];
                system[row][triangle[0]] -= scale * (inverse[(0, d)] + inverse[(1, d)]);
                right[row] = [scale * target[(0, d)], scale * target[(1, d)]];
            }
        }
        let solution = DenseMatrix::from_fn(rows, 9, |r, c| system[r][c])
            .least_squares(&DenseMatrix::from_fn(rows, 2, |r, c| right[r][c]), 1e-12)
            .expect("finite");
        let mut found = Vec::new();
        blend
            .blend(&weights, &mut blend.scratch(), &mut found)
            .expect("a blend");
        for v in 0..9 {
            let dense = Point::new(
                solution.at(v, 0) - solution.at(0, 0),
                solution.at(v, 1) - solution.at(0, 1),
            );
            assert!((found[v] - found[0] - dense).norm() < 1e-12);
        }
    }
}

#[test]
fn opposite_spirals_cancel_to_a_straight_strip() {
    let (topology, wide) = grid(200, 3);
    let flat: Vec<Point> = wide
        .iter()
        .map(|p| Point::new(p.x * 30.0 / 199.0, p.y * 0.15))
        .collect();
    let rolled = |turns: f64| -> Vec<Point> {
        let radius = 30.0 / (TAU * turns);
        let roll = |p: &Point| {
            let (sin, cos) = (TAU * turns * p.x / 30.0).sin_cos();
            Point::new(radius * sin - p.y * sin, radius - radius * cos + p.y * cos)
        };
        flat.iter().map(roll).collect()
    };
    let set = pose_set(&topology, &[flat.clone(), rolled(1.2), rolled(-1.2)]);
    for reference in [Reference::Canonical, Reference::Pose(0)] {
        let blend = RigidBlend::new(&set, &options(reference, Stretch::Linear)).expect("a blend");
        let differences: Vec<f64> = blend
            .angles_rad(1)
            .zip(blend.angles_rad(0))
            .map(|(a, b)| a - b)
            .collect();
        let span = differences.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - differences.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(span > TAU, "the triangles turn by {span}");
        let mut half = Vec::new();
        let report = blend
            .blend(&[0.0, 0.5, 0.5], &mut blend.scratch(), &mut half)
            .expect("a blend");
        assert_eq!(report.flipped, 0);
        // Straight: as long from end to end as along the edge, and as long as the strip was.
        let along: f64 = half[..200].windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        assert!(((half[199] - half[0]).norm() / along - 1.0).abs() < 1e-3);
        assert!((along / 30.0 - 1.0).abs() < 0.08);
    }
}

#[test]
fn a_log_blend_never_inverts_a_triangle_on_its_own() {
    let (topology, flat) = grid(2, 2);
    let wide: Vec<Point> = flat.iter().map(|p| Point::new(p.x * 4.0, p.y)).collect();
    let set = pose_set(&topology, &[flat, wide]);
    let flipped = |stretch| {
        let blend = RigidBlend::new(&set, &options(Reference::Canonical, stretch)).expect("a blend");
        let mut positions = Vec::new();
        let report = blend
            .blend(&[2.0, -1.0], &mut blend.scratch(), &mut positions)
            .expect("a blend");
        (report.flipped, positions[1].x - positions[0].x)
    };
    assert_eq!(flipped(Stretch::Linear).0, 2);
    let (count, width) = flipped(Stretch::Log);
    assert_eq!(count, 0);
    assert!((width - 0.25).abs() < 1e-12, "1^2 / 4 = {width}");
}

#[test]
fn an_anchored_vertex_moves_linearly_and_turns_are_obeyed() {
    let (topology, poses) = bent();
    let set = pose_set(&topology, &poses);
    let anchored = BlendOptions {
        anchor: Anchor::Point(5),
        ..BlendOptions::default()
    };
    let found = blend_once(&set, &anchored, &[0.25, 0.25, 0.5]).expect("a blend");
    let expected = poses[0][5] * 0.25 + poses[1][5] * 0.25 + poses[2][5] * 0.5;
    assert!((found[5] - expected).norm() < 1e-12);

    let turning = BlendOptions {
        turns: vec![0, 1, 0],
        ..BlendOptions::default()
    };
    let blend = RigidBlend::new(&set, &turning).expect("a blend");
    let plain = RigidBlend::new(&set, &BlendOptions::default()).expect("a blend");
    let added = blend.angles_rad(1).zip(plain.angles_rad(1)).map(|(a, b)| a - b);
    assert!(added.into_iter().all(|difference| (difference - TAU).abs() < 1e-12));
}

#[test]
fn separate_pieces_move_each_by_its_own_centroid() {
    let topology = Topology::new(6, vec![[0, 1, 2], [3, 4, 5]]).expect("a mesh");
    let piece = |x: f64, angle: f64| {
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|p| rotation_matrix(angle) * Point::from(p) + Point::new(x, 0.0))
    };
    let both = |a: [Point; 3], b: [Point; 3]| [a, b].as_flattened().to_vec();
    let start = both(piece(0.0, 0.0), piece(5.0, 0.0));
    let end = both(piece(0.0, 1.0), piece(9.0, -1.0));
    let half = blend_once(
        &pose_set(&topology, &[start.clone(), end.clone()]),
        &BlendOptions::default(),
        &[0.5, 0.5],
    )
    .expect("a blend");
    for (first, angle) in [(0, 0.5), (3, -0.5)] {
        let edge = half[first + 1] - half[first];
        assert!((edge - rotation_matrix(angle) * Point::new(1.0, 0.0)).norm() < 1e-12);
        let centroid = |p: &[Point]| (p[first] + p[first + 1] + p[first + 2]) / 3.0;
        assert!((centroid(&half) - (centroid(&start) + centroid(&end)) * 0.5).norm() < 1e-12);
    }
}

#[test]
fn bad_input_is_refused() {
    let (topology, mut poses) = bent();
    let set = pose_set(&topology, &poses);
    let blend = RigidBlend::new(&set, &BlendOptions::default()).expect("a blend");
    let mut positions = Vec::new();
    let mut refused = |weights: &[f64]| {
        blend
            .blend(weights, &mut blend.scratch(), &mut positions)
            .expect_err("bad")
    };
    assert!(matches!(refused(&[0.5, 0.5]), BlendError::WrongCount { found: 2, .. }));
    assert!(matches!(refused(&[0.5, 0.5, 0.1]), BlendError::BadWeights { .. }));
    assert!(matches!(refused(&[f64::NAN, 0.5, 0.5]), BlendError::BadWeights { .. }));
    assert!(matches!(
        refused(&[f64::INFINITY, f64::NEG_INFINITY, 1.0]),
        BlendError::BadWeights { .. }
    ));
    let no_pose = RigidBlend::new(&set, &options(Reference::Pose(3), Stretch::Linear));
    assert_eq!(
        no_pose.expect_err("three poses"),
        BlendError::NoSuchPose { pose: 3, last: 2 }
    );
    let no_vertex = BlendOptions {
        anchor: Anchor::Point(9),
        ..BlendOptions::default()
    };
    assert!(RigidBlend::new(&set, &no_vertex).is_err());
    let turns = BlendOptions {
        turns: vec![1],
        ..BlendOptions::default()
    };
    assert!(RigidBlend::new(&set, &turns).is_err());
    poses[1][4] = Point::new(50.0, 0.0);
    let error = RigidBlend::new(&pose_set(&topology, &poses), &BlendOptions::default()).expect_err("inverted");
    assert!(
        matches!(&error, BlendError::NotPositive { pose, .. } if pose == "p1"),
        "{error}"
    );
}

prop_compose! {
    /// Grids whose vertices are moved a little, each turned and scaled as a whole.
    fn poses_of_a_grid()(
        moves in proptest::collection::vec(-0.2..0.2f64, 4 * 40),
        angles in proptest::collection::vec(-3.0..3.0f64, 4),
        sizes in proptest::collection::vec(0.5..2.0f64, 4),
    ) -> (Topology, Vec<Vec<Point>>) {
        let (topology, flat) = grid(5, 4);
        let poses = (0..4)
            .map(|k| {
                flat.iter()
                    .enumerate()
                    .map(|(v, p)| {
                        let moved = p + Point::new(moves[40 * k + 2 * v], moves[40 * k + 2 * v + 1]);
                        rotation_matrix(angles[k]) * moved * sizes[k]
                    })
                    .collect()
            })
            .collect();
        (topology, poses)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_unit_weight_returns_its_pose((topology, poses) in poses_of_a_grid()) {
        let set = pose_set(&topology, &poses);
        for reference in REFERENCES {
            for stretch in STRETCHES {
                let blend = RigidBlend::new(&set, &options(reference, stretch)).expect("a blend");
                let mut found = Vec::new();
                for (k, pose) in poses.iter().enumerate() {
                    blend.blend(&unit(4, k), &mut blend.scratch(), &mut found).expect("a blend");
                    prop_assert!(largest_difference(&found, pose) < 1e-11);
                }
            }
        }
    }

    #[test]
    fn the_order_of_the_poses_does_not_matter((topology, poses) in poses_of_a_grid()) {
        let weights = [0.4, 0.35, -0.15, 0.4];
        let order = [2, 0, 3, 1];
        let shuffled: Vec<_> = order.iter().map(|&k| poses[k].clone()).collect();
        let shuffled_weights = order.map(|k| weights[k]);
        for stretch in STRETCHES {
            let (set, other) = (pose_set(&topology, &poses), pose_set(&topology, &shuffled));
            for (reference, same) in [(Reference::Canonical, Reference::Canonical), (Reference::Pose(0), Reference::Pose(1))] {
                let a = blend_once(&set, &options(reference, stretch), &weights).expect("a blend");
                let b = blend_once(&other, &options(same, stretch), &shuffled_weights).expect("a blend");
                prop_assert!(largest_difference(&a, &b) < 1e-11);
            }
        }
    }

    #[test]
    fn turned_copies_blend_to_a_turned_copy(
        (topology, poses) in poses_of_a_grid(),
        first in -20.0..20.0f64,
        others in proptest::collection::vec(-1.4..1.4f64, 3),
        weights in proptest::collection::vec(-0.5..1.0f64, 3),
    ) {
        // All within less than half a turn of the first, so that no cut between them is larger than the one outside.
        let angles: Vec<f64> = std::iter::once(first).chain(others.iter().map(|o| first + o)).collect();
        let weights: Vec<f64> = std::iter::once(1.0 - weights.iter().sum::<f64>()).chain(weights).collect();
        let copies: Vec<Vec<Point>> = angles
            .iter()
            .map(|&a| poses[0].iter().map(|p| rotation_matrix(a) * p).collect())
            .collect();
        let blended = first + others.iter().zip(&weights[1..]).map(|(o, w)| o * w).sum::<f64>();
        let set = pose_set(&topology, &copies);
        for reference in REFERENCES {
            for stretch in STRETCHES {
                let found = blend_once(&set, &options(reference, stretch), &weights).expect("a blend");
                for (p, q) in poses[0].iter().zip(&found) {
                    let expected = rotation_matrix(blended) * (p - poses[0][0]);
                    prop_assert!((q - found[0] - expected).norm() < 1e-10);
                }
            }
        }
    }
}
