//! What biharmonic weights can do besides: walls, edits, bounds, objectives, and how they converge.

use super::*;
use crate::math::Point;
use crate::mesh::geometry;

/// Six poses, none on a line with two others.
const SIX: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.1], [0.9, 0.8], [0.1, 0.9], [0.5, 0.45], [0.3, 0.6]];

fn with(points: &[[f64; 2]], options: &BiharmonicOptions) -> BiharmonicWeights {
    BiharmonicWeights::new(&places(points), options).expect("a layout")
}

fn assert_cardinal(provider: &BiharmonicWeights, tolerance: f64) {
    for (k, place) in provider.places().iter().enumerate() {
        let mut weights = Vec::new();
        provider.weights(place, &mut weights).expect("a place");
        for (pose, weight) in weights.iter().enumerate() {
            let expected = if pose == k { 1.0 } else { 0.0 };
            assert!((weight - expected).abs() < tolerance, "{weight} at pose {k}");
        }
    }
}

/// The largest difference of two providers' weights over a box around [`SIX`], which must not be large itself.
fn difference(a: &dyn WeightProvider, b: &dyn WeightProvider) -> f64 {
    let mut worst = 0.0_f64;
    for k in 0..400 {
        let place = [-0.5 + f64::from(k % 20) * 0.1, -0.5 + f64::from(k / 20) * 0.1];
        for (x, y) in at(a, place).into_iter().zip(at(b, place)) {
            worst = worst.max((x - y).abs());
        }
    }
    worst
}

/// The mesh with its inner vertices moved by up to a fifth of their shortest edge, differently for every seed.
fn jittered(mesh: &tessellation::Tessellation, fixed: usize, seed: f64) -> tessellation::Tessellation {
    let mut shortest = vec![f64::INFINITY; mesh.positions.len()];
    for triangle in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            let length = (mesh.positions[a] - mesh.positions[b]).norm();
            shortest[a] = shortest[a].min(length);
            shortest[b] = shortest[b].min(length);
        }
    }
    let mut moved = mesh.clone();
    for (k, p) in moved.positions.iter_mut().enumerate().skip(fixed) {
        if p.amax() < tessellation::REACH {
            let noise = |salt: f64| (12.9898 * (k as f64 + salt + seed)).sin();
            *p += Point::new(noise(0.1), noise(0.7)) * (0.2 * shortest[k]);
        }
    }
    let positive = |t: &[usize; 3]| geometry::signed_area(geometry::corners(&moved.positions, *t)) > 0.0;
    assert!(moved.triangles.iter().all(positive));
    moved
}

#[test]
fn the_default_energy_converges_on_jittered_meshes_and_the_paper_s_does_not() {
    let poses = [[-0.4, -0.3], [0.4, -0.3], [0.4, 0.3], [-0.1, 0.15]].map(Point::from);
    let weights = |energy: Energy, refinement: u32, seed: f64| -> Vec<Vec<f64>> {
        let mesh = tessellation::graded(&poses, &walls::Walls::default(), refinement).expect("no walls");
        let surface = solved(jittered(&mesh, poses.len(), seed), &poses, energy);
        let at = |k: u32| {
            let mut weights = Vec::new();
            let (x, y) = ((f64::from(k) * 0.37).sin(), (f64::from(k) * 0.71).cos());
            surface.values(Point::new(0.7 * x, 0.7 * y), &mut weights);
            weights
        };
        (0..200).map(at).collect()
    };
    let apart = |a: &[Vec<f64>], b: &[Vec<f64>]| {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    let coarse = weights(Energy::Hessian, 0, 0.0);
    let fine = weights(Energy::Hessian, 1, 0.0);
    // How much another jitter changes falls with the size of the triangles, and so does what a finer mesh changes.
    let by_jitter = [
        apart(&coarse, &weights(Energy::Hessian, 0, 0.4)),
        apart(&fine, &weights(Energy::Hessian, 1, 0.4)),
    ];
    assert!(
        by_jitter[1] < 0.5 * by_jitter[0] && by_jitter[1] < 1e-3,
        "{by_jitter:?}"
    );
    assert!(apart(&coarse, &fine) < 5e-3, "{}", apart(&coarse, &fine));
    // In the paper's sum gradients gain weight with every refinement.
    let paper = apart(
        &weights(Energy::JacobianDifferences, 0, 0.0),
        &weights(Energy::JacobianDifferences, 1, 0.0),
    );
    assert!(paper > 0.05, "{paper}");
}

#[test]
fn the_velocity_of_a_moving_point_does_not_jump_at_mesh_edges() {
    let poses = [[-0.4, -0.3], [0.4, -0.3], [0.4, 0.3], [-0.1, 0.15]].map(Point::from);
    for energy in [Energy::Hessian, Energy::JacobianDifferences] {
        let mesh = tessellation::graded(&poses, &walls::Walls::default(), 0).expect("no walls");
        let surface = solved(mesh.clone(), &poses, energy);
        let value = |p: Point| {
            let mut weights = Vec::new();
            surface.values(p, &mut weights);
            weights[0]
        };
        let (mut jump, mut speed) = (0.0_f64, 0.0_f64);
        for triangle in mesh.triangles.iter().step_by(3) {
            let [a, b, _] = geometry::corners(&mesh.positions, *triangle);
            let (middle, across) = (a + (b - a) * 0.4, crate::math::point::perpendicular(b - a).normalize());
            if middle.amax() > 0.9 {
                continue;
            }
            // One-sided velocities of second order.
            let step = 1e-5;
            let ahead = |s: f64| {
                (4.0 * value(middle + across * s) - 3.0 * value(middle) - value(middle + across * (2.0 * s)))
                    / (2.0 * s)
            };
            jump = jump.max((ahead(step) - ahead(-step)).abs());
            speed = speed.max(ahead(step).abs());
        }
        assert!(speed > 0.5 && jump < 1e-4 * speed, "{jump} at {speed}");
    }
}

#[test]
fn influence_does_not_cross_a_wall_and_goes_around_its_end() {
    // A wall between two poses, from far below to a little above them.
    for energy in [Energy::Hessian, Energy::JacobianDifferences] {
        let options = BiharmonicOptions {
            energy,
            walls: vec![vec![[0.5, -9.0], [0.5, 0.3]]],
            ..BiharmonicOptions::default()
        };
        let poses = [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]];
        let walled = with(&poses, &options);
        assert_cardinal(&walled, 1e-9);
        let (left, right) = (at(&walled, [0.499, -0.5]), at(&walled, [0.501, -0.5]));
        assert!(left[0] > 0.8 && right[0] < 0.35, "{left:?} {right:?}");
        // Above its end the weights are smooth again.
        let (left, right) = (at(&walled, [0.499, 0.8]), at(&walled, [0.501, 0.8]));
        for (a, b) in left.iter().zip(&right) {
            assert!((a - b).abs() < 0.02, "{left:?} {right:?}");
        }
        for k in 0..200 {
            let sum: f64 = at(&walled, [f64::from(k).sin() * 2.0, f64::from(k).cos()]).iter().sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn a_closed_wall_shuts_off_what_is_inside() {
    let ring = |x: f64, y: f64, r: f64| {
        vec![
            [x - r, y - r],
            [x + r, y - r],
            [x + r, y + r],
            [x - r, y + r],
            [x - r, y - r],
        ]
    };
    let options = BiharmonicOptions {
        walls: vec![ring(0.0, 0.0, 0.2), ring(0.5, 0.5, 0.1)],
        ..BiharmonicOptions::default()
    };
    let walled = with(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &options);
    assert_cardinal(&walled, 1e-9);
    // The first pose is alone inside, and nowhere else.
    for (inside, outside) in [([0.19, 0.19], [0.21, 0.21]), ([-0.1, 0.15], [-0.3, 0.15])] {
        assert!((at(&walled, inside)[0] - 1.0).abs() < 1e-9);
        assert!(at(&walled, outside)[0].abs() < 1e-9);
    }
    // Nobody is in the second ring: the nearest place outside counts.
    let (inside, outside) = (at(&walled, [0.45, 0.5]), at(&walled, [0.4, 0.5]));
    for (a, b) in inside.iter().zip(&outside) {
        assert!((a - b).abs() < 1e-6, "{inside:?} {outside:?}");
    }
}

#[test]
fn walls_may_cross_and_bad_ones_are_refused_by_number() {
    let walls = |walls: &[&[[f64; 2]]]| BiharmonicOptions {
        walls: walls.iter().map(|wall| wall.to_vec()).collect(),
        ..BiharmonicOptions::default()
    };
    let crossed = with(
        &SIX,
        &walls(&[
            &[[0.6, -0.2], [0.6, 1.2], [0.7, 1.2]],
            &[[0.4, 0.2], [0.95, 0.3]],
            &[[0.4, 0.2], [0.95, 0.3]],
            &[[0.2, 0.2], [0.3, 0.3], [0.2, 0.3], [0.3, 0.2]],
        ]),
    );
    assert_cardinal(&crossed, 1e-9);
    let refused = |options| BiharmonicWeights::new(&places(&SIX), &options).expect_err("a bad wall");
    let through = refused(walls(&[&[[2.0, 0.0], [2.0, 1.0]], &[[0.4, 0.45], [0.6, 0.45]]]));
    let problem = WallProblem::TouchesPose { pose: 4 };
    assert_eq!(through, WeightError::Wall { wall: 1, problem });
    let dot = refused(walls(&[&[[2.0, 0.0], [2.0, 0.0]]]));
    assert!(dot.to_string().contains("wall 0 has no length"), "{dot}");
    assert!(matches!(
        refused(walls(&[&[[f64::NAN, 0.0], [2.0, 0.0]]])),
        WeightError::NotFinite { .. }
    ));
}

#[test]
fn edits_agree_with_a_new_build_and_leave_no_trace() {
    // The paper's energy depends on the mesh, whatever is done about it.
    for (energy, tolerance) in [(Energy::Hessian, 0.015), (Energy::JacobianDifferences, 0.2)] {
        let options = BiharmonicOptions {
            energy,
            extent: Some([[0.0, 0.0], [1.0, 0.9]]),
            ..BiharmonicOptions::default()
        };
        let first = with(&SIX, &options);
        let mut edited = first.clone();
        let mut layout = SIX.to_vec();
        layout[4] = [0.62, 0.3];
        assert_eq!(edited.move_pose(4, &layout[4]), Ok(Edit::Solved));
        assert_cardinal(&edited, 1e-9);
        let fresh = difference(&edited, &with(&layout, &options));
        assert!(fresh < tolerance, "{fresh}");
        layout.push([0.75, 0.55]);
        assert_eq!(edited.insert_pose(&layout[6]), Ok(Edit::Solved));
        assert_cardinal(&edited, 1e-9);
        let fresh = difference(&edited, &with(&layout, &options));
        assert!(fresh < tolerance, "{fresh}");
        layout.remove(1);
        assert_eq!(edited.remove_pose(1), Ok(Edit::Solved));
        assert_cardinal(&edited, 1e-9);
        let fresh = difference(&edited, &with(&layout, &options));
        assert!(fresh < tolerance, "{fresh}");
        // Back to where it began, pose by pose; the removed one comes back last.
        edited.remove_pose(5).expect("a pose");
        edited.move_pose(3, &SIX[4]).expect("a place");
        edited.insert_pose(&SIX[1]).expect("a place");
        let order = [0, 5, 1, 2, 3, 4];
        for place in [[0.2, 0.3], [1.4, -0.6], [0.9, 0.3]] {
            let (now, before) = (at(&edited, place), at(&first, place));
            for (pose, weight) in before.iter().enumerate() {
                assert!((now[order[pose]] - weight).abs() < 1e-10);
            }
        }
    }
}

#[test]
fn edits_that_the_mesh_does_not_suit_build_anew_and_bad_ones_change_nothing() {
    let options = BiharmonicOptions::default();
    let mut edited = with(&SIX, &options);
    assert_eq!(edited.move_pose(2, &[9.0, 9.0]), Ok(Edit::Rebuilt));
    let mut layout = SIX;
    layout[2] = [9.0, 9.0];
    assert_eq!(difference(&edited, &with(&layout, &options)), 0.0);
    let before = edited.clone();
    assert!(edited.move_pose(1, &layout[0]).is_err() && edited.move_pose(6, &[0.0, 0.0]).is_err());
    assert!(edited.insert_pose(&[f64::NAN, 0.0]).is_err() && edited.remove_pose(6).is_err());
    assert_eq!(difference(&edited, &before), 0.0);
    for _ in 0..5 {
        edited.remove_pose(0).expect("a pose");
    }
    assert_eq!(at(&edited, [0.3, 0.3]), vec![1.0]);
    assert_eq!(edited.remove_pose(0), Err(WeightError::NoPose));
    edited.insert_pose(&[0.0, 1.0]).expect("a place");
    assert_cardinal(&edited, 1e-9);
}

#[test]
fn a_pose_that_leaves_a_closed_part_empties_it() {
    let ring = vec![[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2]];
    let options = BiharmonicOptions {
        walls: vec![ring],
        ..BiharmonicOptions::default()
    };
    let mut walled = with(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &options);
    walled.move_pose(0, &[0.5, 0.5]).expect("a place");
    assert_cardinal(&walled, 1e-9);
    assert!(at(&walled, [0.0, 0.0]).iter().all(|w| w.is_finite() && w.abs() < 2.0));
    walled.move_pose(0, &[0.05, 0.05]).expect("a place");
    assert!((at(&walled, [0.15, 0.0])[0] - 1.0).abs() < 1e-9);
}

#[test]
fn bounded_weights_are_within_bounds_cardinal_and_smooth() {
    let options = BiharmonicOptions {
        range: Range::Unit,
        ..BiharmonicOptions::default()
    };
    for layout in [LAYOUTS[2], &SIX] {
        let bounded = with(layout, &options);
        let report = bounded.bounded_report().expect("it was searched for");
        assert!(report.converged, "{report:?}");
        assert_cardinal(&bounded, 1e-12);
        let free = with(layout, &BiharmonicOptions::default());
        let mut lowest = 0.0_f64;
        for k in 0..900 {
            let place = [-1.0 + f64::from(k % 30) * 0.1, -1.0 + f64::from(k / 30) * 0.1];
            let weights = at(&bounded, place);
            assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{weights:?}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            lowest = at(&free, place).into_iter().fold(lowest, f64::min);
        }
        // Without bounds they leave them by far.
        assert!(lowest < -0.02, "{lowest}");
        // Along a line the largest second difference falls by about 16 when the step is quartered.
        let bends = |steps: i32| {
            let sample = |k: i32| at(&bounded, [-0.3 + 1.6 * f64::from(k) / f64::from(steps), 0.37]);
            let samples: Vec<Vec<f64>> = (0..=steps).map(sample).collect();
            let second = |w: &[Vec<f64>], p: usize| (w[0][p] - 2.0 * w[1][p] + w[2][p]).abs();
            let all = samples
                .windows(3)
                .flat_map(|w| (0..layout.len()).map(move |p| second(w, p)));
            all.fold(0.0, f64::max)
        };
        let ratio = bends(800) / bends(3200);
        assert!(ratio > 8.0, "{ratio}");
    }
}

#[test]
fn bounded_weights_are_edited_as_they_are_built() {
    let options = BiharmonicOptions {
        range: Range::Unit,
        extent: Some([[0.0, 0.0], [1.0, 0.9]]),
        ..BiharmonicOptions::default()
    };
    let mut edited = with(&SIX, &options);
    let mut layout = SIX;
    layout[4] = [0.62, 0.3];
    assert_eq!(edited.move_pose(4, &layout[4]), Ok(Edit::Solved));
    assert_cardinal(&edited, 1e-9);
    let fresh = difference(&edited, &with(&layout, &options));
    assert!(fresh < 0.03, "{fresh}");
}

#[test]
fn pseudo_poses_and_pulls_are_met() {
    let found = at(&with(&SIX, &BiharmonicOptions::default()), [0.2, 0.3]);
    let close = |weights: &[f64], tolerance: f64| {
        let worst = weights
            .iter()
            .zip(&found)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(worst < tolerance, "{weights:?} instead of {found:?}");
    };
    let exact = BiharmonicOptions {
        pseudo_poses: vec![PseudoPose {
            from: vec![0.2, 0.3],
            at: vec![0.7, 0.3],
        }],
        ..BiharmonicOptions::default()
    };
    let mut moved = with(&SIX, &exact);
    assert_cardinal(&moved, 1e-9);
    close(&at(&moved, [0.7, 0.3]), 1e-9);
    moved.move_pose(0, &[0.05, 0.0]).expect("a place");
    assert_cardinal(&moved, 1e-9);
    // A soft one comes nearer the stronger it is.
    let soft = |strength: f64| {
        let wish = Objective::PullAt {
            at: [0.7, 0.3],
            target: Target::FoundAt([0.2, 0.3]),
            strength,
        };
        let options = BiharmonicOptions {
            objectives: vec![wish],
            ..BiharmonicOptions::default()
        };
        at(&with(&SIX, &options), [0.7, 0.3])
    };
    let miss = |weights: &[f64]| {
        weights
            .iter()
            .zip(&found)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    let misses = [0.0001, 100.0, 1e5].map(|strength| miss(&soft(strength)));
    assert!(
        misses[0] > 0.2 && misses[1] < 0.9 * misses[0] && misses[2] < 0.01,
        "{misses:?}"
    );
    // In a region: towards given weights.
    let target = vec![0.0, 0.5, 0.5, 0.0, 0.0, 0.0];
    let pull = Objective::Pull {
        region: Region::disc([-0.4, 0.2], 0.4),
        target: Target::Weights(target.clone()),
        strength: 1e6,
    };
    let options = BiharmonicOptions {
        objectives: vec![pull],
        ..BiharmonicOptions::default()
    };
    let mut pulled = with(&SIX, &options);
    assert_cardinal(&pulled, 1e-9);
    for (a, b) in at(&pulled, [-0.4, 0.2]).iter().zip(&target) {
        assert!((a - b).abs() < 0.02, "{a} {b}");
    }
    assert_eq!(pulled.move_pose(4, &[0.62, 0.3]), Ok(Edit::Solved));
    assert_cardinal(&pulled, 1e-9);
    assert!((at(&pulled, [-0.4, 0.2])[1] - 0.5).abs() < 0.02);
    let sum: f64 = at(&pulled, [-0.3, 0.1]).iter().sum();
    assert!((sum - 1.0).abs() < 1e-12);
    assert_eq!(pulled.remove_pose(1), Ok(Edit::Solved));
    assert!((at(&pulled, [-0.4, 0.2])[1] - 1.0).abs() < 0.02);
}

#[test]
fn a_flattened_region_is_flat() {
    let flat = BiharmonicOptions {
        objectives: vec![Objective::Flatten {
            region: Region::disc([0.7, 0.35], 0.3),
            strength: 10.0,
        }],
        ..BiharmonicOptions::default()
    };
    let slope = |provider: &BiharmonicWeights| {
        let (a, b) = (at(provider, [0.62, 0.35]), at(provider, [0.78, 0.35]));
        a.iter().zip(&b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    let (without, with_it) = (
        slope(&with(&SIX, &BiharmonicOptions::default())),
        slope(&with(&SIX, &flat)),
    );
    assert!(with_it < 0.35 * without, "{with_it} {without}");
    let bad = BiharmonicOptions {
        objectives: vec![Objective::Flatten {
            region: Region::disc([0.7, 0.35], 0.3),
            strength: -1.0,
        }],
        ..BiharmonicOptions::default()
    };
    assert!(BiharmonicWeights::new(&places(&SIX), &bad).is_err());
}
