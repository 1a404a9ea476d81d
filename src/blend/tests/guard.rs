//! Repaired frames.

use super::*;

fn guarded(stretch: Stretch) -> BlendOptions {
    BlendOptions {
        guard: FrameGuard::Repair,
        ..options(Reference::Canonical, stretch)
    }
}

/// Weights that leave the poses in the direction of the last one, at time 0 in the middle of them.
fn outwards(count: usize, time: f64) -> Vec<f64> {
    let mut weights = vec![(1.0 - time) / count as f64; count];
    weights[count - 1] += time;
    weights
}

#[test]
fn repairing_changes_a_frame_without_a_jump() {
    let (topology, poses) = bent();
    let set = pose_set(&topology, &poses);
    let plain = RigidBlend::new(&set, &options(Reference::Canonical, Stretch::Linear)).expect("a blend");
    let blend = RigidBlend::new(&set, &guarded(Stretch::Linear)).expect("a blend");
    let (mut scratch, mut found, mut unguarded) = (blend.scratch(), Vec::new(), Vec::new());
    // From the middle out along the second weight, to where the plain blend turns triangles over.
    let mut frame = |time: f64| {
        let weights = outwards(3, time);
        let before = plain
            .blend(&weights, &mut plain.scratch(), &mut unguarded)
            .expect("a blend")
            .flipped;
        let report = blend.blend(&weights, &mut scratch, &mut found).expect("a blend");
        assert_eq!(report.flipped, 0, "at {time}");
        if !report.repaired {
            assert_eq!(before, 0);
            assert_eq!(found, unguarded);
        }
        (found.clone(), before, report.repaired)
    };
    let steps = 160;
    let frames: Vec<_> = (0..=steps)
        .map(|k| frame(-8.0 + 16.0 * f64::from(k) / f64::from(steps)))
        .collect();
    assert!(frames.iter().any(|(_, before, _)| *before > 0), "nothing to repair");
    assert!(
        frames.iter().any(|(_, _, repaired)| !repaired),
        "nothing to leave alone"
    );
    // Each step, and whether both of its frames were left alone.
    let steps: Vec<(f64, bool)> = frames
        .windows(2)
        .map(|w| (largest_difference(&w[0].0, &w[1].0), !w[0].2 && !w[1].2))
        .collect();
    let healthy = steps
        .iter()
        .filter(|(_, alone)| *alone)
        .map(|(step, _)| *step)
        .fold(0.0, f64::max);
    let all = steps.iter().map(|(step, _)| *step).fold(0.0, f64::max);
    assert!(
        all < 3.0 * healthy,
        "steps of {healthy} where nothing is repaired, of {all} at most"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_repaired_frame_has_no_inverted_triangle(
        (topology, poses) in poses_of_a_grid(),
        weights in proptest::collection::vec(-4.0..4.0f64, 3),
        anchors in proptest::collection::vec((0_usize..20, 0.1..100.0f64), 0..3),
    ) {
        let set = pose_set(&topology, &poses);
        let weights = [weights[0], weights[1], weights[2], 1.0 - weights.iter().sum::<f64>()];
        let anchor = if anchors.is_empty() {
            Anchor::Centroid
        } else {
            Anchor::Soft(anchors.iter().map(|&(point, stiffness)| SoftAnchor { point, stiffness }).collect())
        };
        for stretch in STRETCHES {
            let plain = BlendOptions { anchor: anchor.clone(), ..options(Reference::Canonical, stretch) };
            let blend = RigidBlend::new(&set, &BlendOptions { guard: FrameGuard::Repair, ..plain.clone() }).expect("a blend");
            let unguarded = RigidBlend::new(&set, &plain).expect("a blend");
            let (mut found, mut before) = (Vec::new(), Vec::new());
            let report = blend.blend(&weights, &mut blend.scratch(), &mut found).expect("a blend");
            unguarded.blend(&weights, &mut unguarded.scratch(), &mut before).expect("a blend");
            prop_assert_eq!(report.flipped, 0);
            if !report.repaired {
                prop_assert_eq!(&found, &before);
            }
            // The poses themselves are never touched.
            for (k, pose) in poses.iter().enumerate() {
                let report = blend.blend(&unit(4, k), &mut blend.scratch(), &mut found).expect("a blend");
                prop_assert!(!report.repaired && largest_difference(&found, pose) < 1e-11);
            }
        }
    }
}

#[test]
fn a_repaired_frame_is_a_least_point() {
    // Moving the inner vertex of a repaired frame a little in any direction raises fit plus barrier: seen from outside,
    // the frame does not depend on where the search started.
    let (topology, poses) = bent();
    let reversed: Vec<_> = poses.iter().rev().cloned().collect();
    let weights = [-2.0, -1.5, 4.5];
    let a = blend_once(&pose_set(&topology, &poses), &guarded(Stretch::Linear), &weights).expect("a blend");
    let b = blend_once(
        &pose_set(&topology, &reversed),
        &guarded(Stretch::Linear),
        &[4.5, -1.5, -2.0],
    )
    .expect("a blend");
    assert!(largest_difference(&a, &b) < 1e-5, "{}", largest_difference(&a, &b));
}
