//! Turns: strips that roll up through any angle, whole poses on the circle, and motion outside the poses.

use super::*;

/// A strip of 60 x 3 vertices, and the same rolled up by `degrees` from end to end.
fn strip() -> (Topology, Vec<Point>) {
    let (topology, wide) = grid(60, 3);
    (
        topology,
        wide.iter().map(|p| Point::new(p.x * 0.5, p.y * 0.15)).collect(),
    )
}

fn rolled(flat: &[Point], degrees: f64) -> Vec<Point> {
    let per_length = degrees.to_radians() / 29.5;
    flat.iter()
        .map(|p| {
            let (sine, cosine) = (per_length * p.x).sin_cos();
            Point::new(
                sine / per_length - p.y * sine,
                (1.0 - cosine) / per_length + p.y * cosine,
            )
        })
        .collect()
}

/// By how much the strip's middle row turns from its first edge to its last, in degrees.
fn turned_degrees(positions: &[Point]) -> f64 {
    let edges: Vec<Point> = positions[60..120].windows(2).map(|w| w[1] - w[0]).collect();
    edges
        .windows(2)
        .map(|e| crate::math::angle::between(e[0], e[1]).to_degrees())
        .sum()
}

#[test]
fn a_strip_unrolls_evenly_from_any_angle() {
    let (topology, flat) = strip();
    for degrees in [170.0, 190.0, 350.0, 370.0, 720.0, -400.0] {
        let coiled = rolled(&flat, degrees);
        // All edges but one take part in the sum.
        let whole = turned_degrees(&coiled);
        let set = pose_set(&topology, &[flat.clone(), coiled]);
        for reference in REFERENCES {
            for share in [0.25, 0.5, 0.75, 1.0] {
                let found =
                    blend_once(&set, &options(reference, Stretch::Linear), &[1.0 - share, share]).expect("a blend");
                let turned = turned_degrees(&found);
                assert!(
                    (turned - share * whole).abs() < 1e-3 * whole.abs(),
                    "{degrees} degrees, {reference:?}: {turned} at {share}"
                );
            }
        }
    }
}

#[test]
fn whole_poses_turn_the_short_way_unless_they_are_told() {
    let (topology, poses) = bent();
    for (degrees, turns, half_way) in [
        (170.0, 0, 85.0),
        (190.0, 0, -85.0),
        (190.0, 1, 95.0),
        (350.0, 0, -5.0),
        (350.0, 1, 175.0),
        (370.0, 0, 5.0),
        (370.0, 1, 185.0),
        (720.0, 0, 0.0),
        (720.0, 2, 360.0),
        (170.0, -1, -95.0),
    ] {
        let copy = poses[0]
            .iter()
            .map(|p| rotation_matrix(f64::to_radians(degrees)) * p)
            .collect();
        let set = pose_set(&topology, &[poses[0].clone(), copy]);
        for reference in [Reference::Canonical, Reference::Pose(0)] {
            let options = BlendOptions {
                turns: vec![0, turns],
                ..options(reference, Stretch::Linear)
            };
            let blend = RigidBlend::new(&set, &options).expect("a blend");
            assert!(!blend.turns_are_ambiguous());
            let angle = |pose| blend.angles_rad(pose).next().expect("a triangle").to_degrees();
            let turned = angle(1) - angle(0);
            assert!(
                (turned - 2.0 * half_way).abs() < 1e-9,
                "{degrees} with {turns} turns: {turned}"
            );
            let mut found = Vec::new();
            blend
                .blend(&[0.5, 0.5], &mut blend.scratch(), &mut found)
                .expect("a blend");
            let expected = rotation_matrix(f64::to_radians(half_way)) * (poses[0][8] - poses[0][0]);
            assert!(
                (found[8] - found[0] - expected).norm() < 1e-12,
                "{degrees} with {turns} turns"
            );
        }
    }
}

#[test]
fn three_poses_that_share_the_circle_meet_where_two_are_close() {
    // Between 0 and 170 is as much room as between -170 and 0: either may be the cut, and the artist is told.
    let (topology, poses) = bent();
    let angles = [0.0, 170.0, -170.0];
    let turned = |degrees: f64| -> Vec<Point> {
        poses[0]
            .iter()
            .map(|p| rotation_matrix(degrees.to_radians()) * p)
            .collect()
    };
    for order in [[0, 1, 2], [2, 1, 0], [1, 0, 2]] {
        let set = pose_set(&topology, &order.map(|k| turned(angles[k])));
        let blend = RigidBlend::new(&set, &BlendOptions::default()).expect("a blend");
        assert!(blend.turns_are_ambiguous());
        let at = |weights: [f64; 3]| {
            let mut found = Vec::new();
            let weights = order.map(|k| weights[k]);
            blend
                .blend(&weights, &mut blend.scratch(), &mut found)
                .expect("a blend");
            crate::math::angle::between(poses[0][8] - poses[0][0], found[8] - found[0]).to_degrees()
        };
        assert!(
            (at([0.0, 0.5, 0.5]).abs() - 180.0).abs() < 1e-9,
            "the two that are close meet half way"
        );
        // Whichever cut was taken, it is the same in every order.
        assert!((at([0.5, 0.5, 0.0]) - 85.0).abs() < 1e-9, "{}", at([0.5, 0.5, 0.0]));
    }
    // With one of them said, nothing is left to chance.
    let set = pose_set(&topology, &angles.map(turned));
    let told = BlendOptions {
        turns: vec![0, 0, -1],
        reference: Reference::Pose(0),
        ..BlendOptions::default()
    };
    let blend = RigidBlend::new(&set, &told).expect("a blend");
    let angle = |pose| blend.angles_rad(pose).next().expect("a triangle").to_degrees();
    assert!((angle(2) - angle(0) + 530.0).abs() < 1e-9, "{}", angle(2) - angle(0));
}

#[test]
fn motion_is_continuous_far_outside_the_poses() {
    let (topology, poses) = bent();
    let set = pose_set(&topology, &poses);
    for stretch in STRETCHES {
        let blend = RigidBlend::new(&set, &options(Reference::Canonical, stretch)).expect("a blend");
        let (mut scratch, mut found) = (blend.scratch(), Vec::new());
        let mut frame = |t: f64| {
            // Through the middle of the poses and out on the other side.
            let weights = [1.0 / 3.0 - 2.0 * t, 1.0 / 3.0 + 3.0 * t, 1.0 / 3.0 - t];
            blend.blend(&weights, &mut scratch, &mut found).expect("a blend");
            found.clone()
        };
        let largest_step = |steps: i32, frame: &mut dyn FnMut(f64) -> Vec<Point>| {
            let mut frames = (-steps..=steps).map(|k| frame(f64::from(k) / f64::from(steps)));
            let mut last = frames.next().expect("a frame");
            let mut largest = 0.0_f64;
            for next in frames {
                largest = largest.max(largest_difference(&last, &next));
                last = next;
            }
            largest
        };
        // Steps half as long move half as far: a jump would not get smaller.
        let (coarse, fine) = (largest_step(200, &mut frame), largest_step(400, &mut frame));
        assert!(fine < 0.55 * coarse, "{stretch:?}: {coarse} and {fine}");
    }
}

#[test]
fn the_canonical_blend_converges_under_refinement() {
    // One smooth pair of poses on finer and finer grids: the vertices of the coarsest settle, four times nearer each time.
    let frame = |cells: usize| {
        let (topology, unit) = grid(cells + 1, cells + 1);
        let at = |p: &Point| p / cells as f64;
        let bent = |p: &Point| {
            let p = at(p);
            let (sine, cosine) = (1.2 * p.x).sin_cos();
            Point::new((2.0 - p.y) * sine, 0.3 * p.x * p.x - (2.0 - p.y) * cosine)
        };
        let set = pose_set(
            &topology,
            &[unit.iter().map(at).collect(), unit.iter().map(bent).collect()],
        );
        let found = blend_once(&set, &BlendOptions::default(), &[0.5, 0.5]).expect("a blend");
        let step = cells / 4;
        (0..25)
            .map(|k| found[(k / 5) * step * (cells + 1) + (k % 5) * step])
            .collect::<Vec<_>>()
    };
    let frames = [4, 8, 16, 32].map(frame);
    let changes: Vec<f64> = frames.windows(2).map(|w| largest_difference(&w[0], &w[1])).collect();
    assert!(
        changes[1] < 0.4 * changes[0] && changes[2] < 0.4 * changes[1],
        "{changes:?}"
    );
}

#[test]
fn angles_are_consistent_around_a_hole() {
    // A ring of 48 x 49 vertices whose rim is wound by a turn and a quarter against its hole: every way around the hole
    // leads to the same angles, and half of the winding comes out between two windings.
    let (around, rows) = (48, 49);
    let triangles = (1..rows).flat_map(|row| {
        (0..around).flat_map(move |i| {
            let j = (i + 1) % around;
            let [a, b, c, d] = [
                (row - 1) * around + i,
                (row - 1) * around + j,
                row * around + j,
                row * around + i,
            ];
            [[a, c, b], [a, d, c]]
        })
    });
    let topology = Topology::new(around * rows, triangles.collect()).expect("a ring");
    let wound = |degrees: f64| -> Vec<Point> {
        let place = |v: usize| {
            let (row, i) = ((v / around) as f64, (v % around) as f64);
            let share = row / (rows - 1) as f64;
            let angle = TAU * i / around as f64 + degrees.to_radians() * share;
            Point::new(angle.cos(), angle.sin()) * 8.0_f64.powf(share)
        };
        (0..around * rows).map(place).collect()
    };
    let set = pose_set(&topology, &[wound(0.0), wound(450.0)]);
    for reference in REFERENCES {
        let blend = RigidBlend::new(&set, &options(reference, Stretch::Linear)).expect("a blend");
        let mut found = Vec::new();
        let mut winding = |weights: [f64; 2]| {
            blend
                .blend(&weights, &mut blend.scratch(), &mut found)
                .expect("a blend");
            let centre: Point = found[..around].iter().sum::<Point>() / around as f64;
            let spoke = (0..rows).map(|row| found[row * around] - centre).collect::<Vec<_>>();
            let turns = spoke
                .windows(2)
                .map(|w| crate::math::angle::between(w[0], w[1]).to_degrees());
            turns.sum::<f64>()
        };
        assert!((winding([0.0, 1.0]) - 450.0).abs() < 1e-6, "{reference:?}");
        let half = winding([0.5, 0.5]);
        // A pose as reference takes its own share of the shear; a lost turn would be 180 degrees off.
        assert!((half - 225.0).abs() < 45.0, "{reference:?}: {half}");
    }
}
