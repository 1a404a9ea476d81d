use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::math::{Point, rotation};
use crate::outline::parameter_gap;

/// A figure with limbs of different sizes: no symmetry, features all around.
fn figure(points: usize, bend: f64) -> Ring {
    Ring::new((0..points).map(|k| {
        let t = TAU * k as f64 / points as f64;
        let limbs = 0.25 * (3.0 * t).cos() + 0.12 * (5.0 * t + 1.0).sin() + 0.15 * (t + 0.5).cos();
        let p = rotation(t) * Point::new(100.0 * (1.0 + limbs), 0.0);
        Point::new(p.x + bend * p.y * p.y / 100.0, p.y * (1.0 + 0.3 * bend))
    }))
    .expect("a ring")
}

/// The ring started at another vertex.
fn restarted(ring: &Ring, by: usize) -> Ring {
    let mut points = ring.points().to_vec();
    points.rotate_left(by % ring.len());
    Ring::new(points).expect("a ring")
}

fn matched(rings: &[Ring], landmarks: &[Landmark]) -> RingMatch {
    match_rings(rings, landmarks, &MatchOptions::default()).expect("a match")
}

/// The largest distance between where the vertices of pose 0 are carried on `pose` and the vertices of the same number.
fn worst_error(found: &RingMatch, rings: &[Ring], pose: usize) -> f64 {
    let vertices = |k: usize| crate::outline::ArcLength::new(&rings[k]).vertex_parameters().to_vec();
    vertices(0)
        .into_iter()
        .zip(vertices(pose))
        .map(|(from, to)| parameter_gap(found.correspondence.carry(0, pose, from), to))
        .fold(0.0, f64::max)
}

fn landmark(name: &str, at: &[Option<f64>]) -> Landmark {
    Landmark {
        name: name.to_owned(),
        at: at.to_vec(),
    }
}

#[test]
fn one_pose_corresponds_to_itself() {
    let found = matched(&[figure(200, 0.0)], &[]);
    assert_eq!(found.reference, 0);
    assert!(found.correspondence.rows().len() >= 256);
    assert_eq!(found.correspondence.carry(0, 0, 0.3), 0.3);
}

#[test]
fn bent_figures_are_matched_point_by_point() {
    let rings = [figure(400, 0.0), figure(400, 0.25), figure(400, -0.2)];
    let found = matched(&rings, &[]);
    for pose in 1..3 {
        let worst = worst_error(&found, &rings, pose);
        assert!(worst < 0.02, "pose {pose}: {worst}");
    }
}

#[test]
fn landmarks_are_met_exactly_and_beat_the_automatic_match() {
    let rings = [figure(300, 0.0), figure(300, 0.2), figure(300, -0.1)];
    // Three per cent off the automatic place, and missing on the last pose.
    let landmarks = [
        landmark("nose", &[Some(0.1), Some(0.13), None]),
        landmark("heel", &[Some(0.9), Some(0.88), Some(0.9)]),
    ];
    let found = matched(&rings, &landmarks);
    for expected in [[0.1, 0.13], [0.9, 0.88]] {
        let row = found
            .correspondence
            .rows()
            .iter()
            .find(|row| row[0] == expected[0])
            .expect("a row");
        assert_eq!(row[1], expected[1]);
    }
    assert_eq!(found.report.poses[2].landmarks, vec![1]);
    assert!(parameter_gap(found.correspondence.carry(0, 2, 0.1), 0.1) < 0.02);
}

#[test]
fn a_landmark_that_the_reference_lacks_ties_the_others() {
    let rings = [figure(300, 0.0), figure(300, 0.2), figure(300, -0.2)];
    let landmarks = [
        landmark("tail", &[None, Some(0.41), Some(0.39)]),
        landmark("own", &[None, Some(0.7), None]),
    ];
    let options = MatchOptions {
        reference: Some(0),
        ..MatchOptions::default()
    };
    let found = match_rings(&rings, &landmarks, &options).expect("a match");
    let row = found
        .correspondence
        .rows()
        .iter()
        .find(|row| row[1] == 0.41)
        .expect("a row");
    assert_eq!(row[2], 0.39);
}

#[test]
fn impossible_landmarks_are_refused_by_name() {
    let rings = [figure(100, 0.0), figure(100, 0.1)];
    let refuse =
        |landmarks: &[Landmark]| match_rings(&rings, landmarks, &MatchOptions::default()).expect_err("refused");
    let disorder = [
        landmark("a", &[Some(0.1), Some(0.1)]),
        landmark("b", &[Some(0.3), Some(0.8)]),
        landmark("c", &[Some(0.5), Some(0.5)]),
        landmark("d", &[Some(0.7), Some(0.7)]),
        landmark("e", &[Some(0.9), Some(0.9)]),
    ];
    assert!(matches!(refuse(&disorder), MatchError::LandmarkOrder { landmark, pose: 1, other: 0 } if landmark == "b"));
    let coincident = [landmark("a", &[Some(0.1), None]), landmark("b", &[Some(1.1), None])];
    assert!(matches!(
        refuse(&coincident),
        MatchError::LandmarksCoincide { pose: 0, .. }
    ));
    assert!(matches!(
        refuse(&[landmark("a", &[Some(f64::NAN), None])]),
        MatchError::LandmarkPlace { pose: 0, .. }
    ));
    assert!(matches!(
        refuse(&[landmark("a", &[None])]),
        MatchError::LandmarkEntries {
            found: 1,
            expected: 2,
            ..
        }
    ));
    let options = MatchOptions {
        reference: Some(2),
        ..MatchOptions::default()
    };
    assert!(matches!(
        match_rings(&rings, &[], &options),
        Err(MatchError::NoSuchReference { .. })
    ));
    assert_eq!(
        match_rings(&[], &[], &MatchOptions::default()).err(),
        Some(MatchError::NoPose)
    );
}

#[test]
fn a_reflected_figure_is_hinted_at() {
    let mirrored = figure(300, 0.1)
        .map(|p| Point::new(-p.x, p.y))
        .expect("a ring")
        .reversed();
    let found = matched(&[figure(300, 0.0), figure(300, 0.2), mirrored], &[]);
    let hints: Vec<bool> = found.report.poses.iter().map(|pose| pose.looks_mirrored).collect();
    assert_eq!(hints, [false, false, true]);
}

#[test]
fn landmarks_in_order_say_that_a_figure_is_not_mirrored() {
    let mirrored = figure(300, 0.1)
        .map(|p| Point::new(-p.x, p.y))
        .expect("a ring")
        .reversed();
    let landmarks =
        [("a", 0.1, 0.2), ("b", 0.4, 0.5), ("c", 0.7, 0.8)].map(|(name, s, t)| landmark(name, &[Some(s), Some(t)]));
    let rings = [figure(300, 0.0), mirrored];
    assert!(matched(&rings, &landmarks[..2]).report.poses[1].looks_mirrored);
    assert!(!matched(&rings, &landmarks).report.poses[1].looks_mirrored);
}

#[test]
fn symmetric_shapes_are_not_turned() {
    let star = |points: usize| {
        Ring::new((0..points).map(|k| {
            let t = TAU * k as f64 / points as f64;
            rotation(t + 0.2) * Point::new(1.0 + 0.3 * (5.0 * t).cos(), 0.0)
        }))
        .expect("a ring")
    };
    let rings = [star(250), restarted(&star(250), 77)];
    let found = matched(&rings, &[]);
    assert!(parameter_gap(found.correspondence.carry(0, 1, 77.0 / 250.0), 0.0) < 0.01);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn place_size_rotation_start_and_order_do_not_matter(
        angle in 0.0..TAU, size in 0.01..50.0f64, x in -500.0..500.0f64, start in 0..240_usize, bend in -0.2..0.2f64,
    ) {
        let rings = [figure(240, 0.0), figure(240, bend), figure(240, 0.5 * bend)];
        let options = MatchOptions { reference: Some(0), ..MatchOptions::default() };
        let plain = match_rings(&rings, &[], &options).expect("a match");
        let moved = rings[1].map(|p| rotation(angle) * p * size + Point::new(x, -x)).expect("a ring");
        let moved = restarted(&moved, start);
        let offset = crate::outline::ArcLength::new(&rings[1]).vertex_parameters()[start];
        let other = match_rings(&[rings[0].clone(), rings[2].clone(), moved], &[], &options).expect("a match");
        for k in 0..50 {
            let t = k as f64 / 50.0;
            let expected = plain.correspondence.carry(0, 1, t);
            let found = other.correspondence.carry(0, 2, t) + offset;
            prop_assert!(parameter_gap(expected, found) < 1e-3, "{} at {}", parameter_gap(expected, found), t);
            // Every pose has a say in the match of every other, and so has the rounding of its place.
            prop_assert!(parameter_gap(plain.correspondence.carry(0, 2, t), other.correspondence.carry(0, 1, t)) < 1e-3);
        }
        let [first, second, third] = rings;
        let swapped = match_rings(&[first, third, second], &[], &options).expect("a match");
        for (row, swapped) in plain.correspondence.rows().iter().zip(swapped.correspondence.rows()) {
            prop_assert_eq!([row[0], row[1], row[2]], [swapped[0], swapped[2], swapped[1]]);
        }
    }

    #[test]
    fn any_rings_give_a_correspondence_with_bounded_slopes(
        radii in proptest::collection::vec(0.05..1.0f64, 36), cut in 3..33_usize,
        places in proptest::collection::vec(0.0..1.0f64, 2..5),
    ) {
        let ring = |radii: &[f64]| {
            let turn = TAU / radii.len() as f64;
            Ring::new(radii.iter().enumerate().map(|(k, r)| rotation(k as f64 * turn) * Point::new(*r, 0.0)))
        };
        let rings = [ring(&radii[..cut]).expect("a ring"), ring(&radii[cut..]).expect("a ring")];
        let landmarks: Vec<Landmark> = places
            .iter()
            .map(|t| landmark("l", &[Some(*t), Some((t * t * 0.5 + 0.5 * t).rem_euclid(1.0))]))
            .collect();
        for landmarks in [&[][..], &landmarks[..1], &landmarks[..]] {
            match match_rings(&rings, landmarks, &MatchOptions::default()) {
                Ok(found) => {
                    let rows = found.correspondence.rows();
                    prop_assert!(rows.len() >= 256);
                    if landmarks.is_empty() {
                        for pair in rows.windows(2) {
                            let slope = (pair[1][1] - pair[0][1]).rem_euclid(1.0) / (pair[1][0] - pair[0][0]).rem_euclid(1.0);
                            prop_assert!(slope > 0.04 && slope < 21.0, "{slope}");
                        }
                    }
                }
                Err(error) => prop_assert!(matches!(error, MatchError::LandmarksCoincide { .. }), "{error}"),
            }
        }
    }
}

#[test]
fn poses_learn_from_one_another_what_the_reference_does_not_show() {
    // A circle with an arm at some angle; the reference has none, so that nothing ties the arms to it.
    let with_arm = |angle: f64, length: f64| {
        Ring::new((0..360).map(|k| {
            let t = TAU * f64::from(k) / 360.0;
            let offset = (t - angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            rotation(t) * Point::new(1.0 + length * (-(offset / 0.12).powi(2)).exp(), 0.0)
        }))
        .expect("a ring")
    };
    let rings = [with_arm(0.0, 0.0), with_arm(0.4, 0.8), with_arm(1.6, 0.8)];
    let options = MatchOptions {
        reference: Some(0),
        ..MatchOptions::default()
    };
    let matched = match_rings(&rings, &[], &options).expect("a match");
    let tip = |ring: &Ring, angle: f64| {
        let arc = crate::outline::ArcLength::new(ring);
        arc.nearest(rotation(angle) * Point::new(1.8, 0.0)).0
    };
    let carried = matched.correspondence.carry(1, 2, tip(&rings[1], 0.4));
    let off = carried - tip(&rings[2], 1.6);
    assert!((off - off.round()).abs() < 0.01, "{off}");
}
