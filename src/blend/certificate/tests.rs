//! Frames made by hand that break one thing each, and blends.

use super::*;
use crate::blend::{Reference, RigidBlend, Stretch};
use crate::math::rotation;
use crate::pose::OverlappingPose;
use proptest::prelude::*;

/// A strip of `columns` squares, each of two triangles: vertex `k` below is at (k, 0), vertex `columns + 1 + k` above at (k, 1).
fn strip(columns: usize) -> (Topology, Vec<Point>) {
    let above = columns + 1;
    let squares = (0..columns).flat_map(|k| [[k, k + 1, above + k + 1], [k, above + k + 1, above + k]]);
    let topology = Topology::new(2 * above, squares.collect()).expect("a mesh");
    let row = |y: f64| (0..above).map(move |k| Point::new(k as f64, y));
    (topology, row(0.0).chain(row(1.0)).collect())
}

/// The strip bent into a spiral of so many turns, wider from turn to turn or not.
fn bent(columns: usize, turns: f64, widening: f64) -> Vec<Point> {
    let at = |k: usize, radius: f64| {
        let share = k as f64 / columns as f64;
        let turn = std::f64::consts::TAU * turns * share;
        rotation(turn) * Point::new(0.0, -(radius + widening * share))
    };
    let outer = (0..=columns).map(|k| at(k, 4.0));
    outer.chain((0..=columns).map(|k| at(k, 3.0))).collect()
}

fn certifier(topology: &Topology, poses: &[Vec<Point>], overlaps: &Overlaps) -> Certifier {
    Certifier::new(&pose_set(topology, poses), overlaps, &BlendOptions::default()).expect("a certifier")
}

fn pose_set(topology: &Topology, poses: &[Vec<Point>]) -> PoseSet {
    let named = poses.iter().enumerate().map(|(k, pose)| (k.to_string(), pose.clone()));
    PoseSet::new(topology.clone(), named.collect()).expect("poses")
}

#[test]
fn a_pose_holds_and_an_inverted_triangle_is_named() {
    let (topology, straight) = strip(4);
    let certifier = certifier(&topology, std::slice::from_ref(&straight), &Overlaps::default());
    let good = certifier.certify(&[1.0], &straight).expect("a certificate");
    assert!(good.holds() && good.overlaps.is_empty() && good.inverted.is_empty() && good.crossings.is_empty());
    assert!((good.largest.distortion - 1.0).abs() < 1e-12 && (good.largest.area - 1.0).abs() < 1e-12);
    assert!((good.of_poses.distortion - 1.0).abs() < 1e-12 && (good.of_poses.area - 1.0).abs() < 1e-12);

    // The upper right corner goes below the strip: the last square is turned over.
    let mut inverted = straight.clone();
    inverted[9] = Point::new(4.0, -0.5);
    let found = certifier.certify(&[1.0], &inverted).expect("a certificate");
    assert!(!found.positive && !found.holds());
    assert_eq!((found.inverted_count, found.inverted.as_slice()), (1, [6].as_slice()));
    // Exactly flat is not positive either, and has no finite distortion.
    inverted[9] = Point::new(4.0, 0.0);
    inverted[8] = Point::new(3.0, 0.0);
    let flat = certifier.certify(&[1.0], &inverted).expect("a certificate");
    assert!(!flat.positive && flat.inverted.contains(&6));
    assert_eq!(
        (flat.largest.distortion, flat.largest.area),
        (f64::INFINITY, f64::INFINITY)
    );
}

#[test]
fn a_boundary_that_crosses_itself_is_found_with_its_place_though_every_triangle_is_positive() {
    let (topology, _) = strip(26);
    let half = bent(26, 0.5, 0.0);
    let certifier = certifier(&topology, &[half], &Overlaps::default());
    let over = certifier.certify(&[1.0], &bent(26, 1.3, 0.0)).expect("a certificate");
    assert!(over.positive && !over.simple && !over.holds() && over.overlaps.is_empty());
    assert!(over.crossing_count > 0 && over.crossings.len() <= over.crossing_count);
    for crossing in &over.crossings {
        let radius = crossing.place.norm();
        assert!(radius > 2.9 && radius < 4.1, "{crossing:?}");
        let is_edge = |[from, to]: [usize; 2]| topology.edges().contains(&(from.min(to), from.max(to)));
        assert!(crossing.edges.into_iter().all(is_edge), "{crossing:?}");
    }
    // A spiral that widens lies beside itself.
    let beside = certifier.certify(&[1.0], &bent(26, 1.3, 3.0)).expect("a certificate");
    assert!(beside.holds(), "{beside:?}");
}

#[test]
fn a_boundary_that_touches_itself_is_simple() {
    // A ring of six squares that is open at one place, closed so far that its ends touch in a corner or along their sides.
    let (topology, straight) = strip(3);
    let certifier = certifier(&topology, std::slice::from_ref(&straight), &Overlaps::default());
    let c = |x: f64, y: f64| Point::new(x, y);
    // Three squares around a corner: the ends share the points (0, 0) to (0, 1), or nearly.
    let touching = |x: f64| {
        vec![
            c(x, -2.0),
            c(-2.0, 1.0),
            c(3.0, 1.0),
            c(0.0, -2.0),
            c(x, -1.0),
            c(-1.0, 0.5),
            c(1.0, 0.5),
            c(0.0, -1.0),
        ]
    };
    let touched = certifier.certify(&[1.0], &touching(0.0)).expect("a certificate");
    assert!(touched.simple, "{touched:?}");
    let apart = certifier.certify(&[1.0], &touching(-0.25)).expect("a certificate");
    assert!(apart.simple, "{apart:?}");
    let over = certifier
        .certify(&[1.0], &touching(f64::EPSILON))
        .expect("a certificate");
    assert!(!over.simple, "{over:?}");
}

#[test]
fn limbs_may_lie_over_one_another_where_poses_do() {
    let columns = 26;
    let (topology, _) = strip(columns);
    let (open, over) = (bent(columns, 0.5, 0.0), bent(columns, 1.3, 0.0));
    let triangles = topology.triangles().len();
    // The first quarter is one limb, the last another one; what is between them is the trunk.
    let triangle_limb = (0..triangles).map(|t| match 4 * t / triangles {
        0 => Some(1),
        3 => Some(0),
        _ => None,
    });
    let overlaps = Overlaps {
        poses: vec![OverlappingPose {
            pose: 1,
            depth: (0..triangles).map(|t| t as f64).collect(),
        }],
        limbs: vec!["tail".to_owned(), "head".to_owned()],
        triangle_limb: triangle_limb.collect(),
    };
    let poses = [open, over.clone()];
    let immersed = certifier(&topology, &poses, &overlaps);
    let found = immersed.certify(&[0.0, 1.0], &over).expect("a certificate");
    assert!(found.holds(), "{found:?}");
    let [overlap] = found.overlaps.as_slice() else {
        panic!("{:?}", found.overlaps);
    };
    assert_eq!(
        (overlap.limbs.clone(), overlap.is_in_poses),
        (["tail".to_owned(), "head".to_owned()], true)
    );
    // Wound further, the end lies over the trunk too, as it does in no pose; wound twice, the trunk lies over itself.
    let further = immersed
        .certify(&[0.0, 1.0], &bent(columns, 1.6, 0.0))
        .expect("a certificate");
    assert!(
        further
            .overlaps
            .iter()
            .any(|overlap| overlap.limbs == [TRUNK, "tail"] && !overlap.is_in_poses)
    );
    let twice = immersed
        .certify(&[0.0, 1.0], &bent(columns, 2.6, 0.0))
        .expect("a certificate");
    assert!(!twice.simple && twice.positive);
    // Without limbs, or where no pose lies over itself, nothing is allowed.
    for strict in [
        Overlaps {
            poses: Vec::new(),
            ..overlaps.clone()
        },
        Overlaps {
            limbs: Vec::new(),
            triangle_limb: Vec::new(),
            ..overlaps.clone()
        },
    ] {
        let found = certifier(&topology, &poses, &strict).certify(&[0.0, 1.0], &over);
        let found = found.expect("a certificate");
        assert!(!found.simple && found.overlaps.is_empty(), "{found:?}");
    }
}

#[test]
fn negative_weights_count_as_none_and_what_does_not_fit_is_refused() {
    let (topology, straight) = strip(3);
    let longer: Vec<Point> = straight.iter().map(|p| Point::new(3.0 * p.x, p.y)).collect();
    let options = BlendOptions {
        reference: Reference::Pose(0),
        ..BlendOptions::default()
    };
    let poses = pose_set(&topology, &[straight.clone(), longer]);
    let certifier = Certifier::new(&poses, &Overlaps::default(), &options).expect("a certifier");
    let beyond = certifier.certify(&[-0.5, 1.5], &straight).expect("a certificate");
    assert!((beyond.of_poses.distortion - 3.0).abs() < 1e-12 && (beyond.of_poses.area - 3.0).abs() < 1e-12);
    assert!(matches!(
        certifier.certify(&[1.0], &straight),
        Err(BlendError::WrongCount { .. })
    ));
    assert!(matches!(
        certifier.certify(&[f64::NAN, 1.0], &straight),
        Err(BlendError::BadWeights { .. })
    ));
    assert!(matches!(
        certifier.certify(&[-1.0, 0.0], &straight),
        Err(BlendError::BadWeights { .. })
    ));
    assert!(matches!(
        certifier.certify(&[0.0, 1.0], &straight[1..]),
        Err(BlendError::WrongVertexCount { found: 7, expected: 8 })
    ));
    for bad in [f64::NAN, f64::INFINITY, 1e61] {
        let mut positions = straight.clone();
        positions[3].x = bad;
        assert_eq!(certifier.certify(&[0.0, 1.0], &positions), Err(BlendError::NotFinite));
    }
}

#[test]
fn between_two_frames_a_fold_is_not_overlooked() {
    let (topology, straight) = strip(4);
    let certifier = certifier(&topology, std::slice::from_ref(&straight), &Overlaps::default());
    let turned = |turn: f64| straight.iter().map(|p| rotation(turn) * p).collect::<Vec<_>>();
    assert_eq!(certifier.unproven_between(&straight, &turned(1.0)), Ok(vec![]));
    // Both ends are as good as can be; half way along straight lines nothing is left.
    let all: Vec<usize> = (0..8).collect();
    assert_eq!(
        certifier.unproven_between(&straight, &turned(std::f64::consts::PI)),
        Ok(all)
    );
    assert!(certifier.unproven_between(&straight, &straight[1..]).is_err());
}

proptest! {
    /// Frames within and far outside the poses: `positive` says what the blend's own count says.
    #[test]
    fn positive_is_what_the_blend_counts(
        turns in 0.1..1.4f64,
        widening in 0.0..4.0f64,
        weight in -3.0..4.0f64,
        stretch in 0..3usize,
    ) {
        let (topology, straight) = strip(12);
        let poses = pose_set(&topology, &[straight, bent(12, turns, widening)]);
        let options = BlendOptions {
            stretch: [Stretch::Linear, Stretch::Limited, Stretch::Log][stretch],
            ..BlendOptions::default()
        };
        let blend = RigidBlend::new(&poses, &options).expect("a blend");
        let certifier = Certifier::new(&poses, &Overlaps::default(), &options).expect("a certifier");
        let (weights, mut positions) = ([weight, 1.0 - weight], Vec::new());
        let report = blend.blend(&weights, &mut blend.scratch(), &mut positions).expect("a frame");
        let certificate = certifier.certify(&weights, &positions).expect("a certificate");
        prop_assert_eq!(certificate.positive, report.flipped == 0);
        prop_assert_eq!(certificate.inverted_count, report.flipped);
    }

    /// At a pose the frame is as distorted as that pose.
    #[test]
    fn at_a_pose_the_frame_is_distorted_as_the_pose_is(turns in 0.1..0.9f64, pose in 0..2usize) {
        let (topology, straight) = strip(12);
        let poses = [straight, bent(12, turns, 1.0)];
        let mut weights = [0.0, 0.0];
        weights[pose] = 1.0;
        let found = certifier(&topology, &poses, &Overlaps::default()).certify(&weights, &poses[pose]).expect("a certificate");
        for (frame, of_pose) in [
            (found.largest.distortion, found.of_poses.distortion),
            (found.largest.area, found.of_poses.area),
        ] {
            prop_assert!((frame - of_pose).abs() < 1e-9 * of_pose, "{:?}", found);
        }
    }
}
