//! Anchors, regions, and many characters at once.

use super::*;

fn soft(anchors: &[(usize, f64)]) -> BlendOptions {
    let anchors = anchors
        .iter()
        .map(|&(point, stiffness)| SoftAnchor { point, stiffness });
    BlendOptions {
        anchor: Anchor::Soft(anchors.collect()),
        ..BlendOptions::default()
    }
}

#[test]
fn anchors_go_where_a_frame_wants_them() {
    let (topology, poses) = bent();
    let set = pose_set(&topology, &poses);
    let weights = [0.25, 0.25, 0.5];
    let place = Point::new(7.0, -3.0);
    let plain = blend_once(&set, &BlendOptions::default(), &weights).expect("a blend");
    for (options, is_there) in [
        (BlendOptions::default(), None),
        (
            BlendOptions {
                anchor: Anchor::Point(5),
                ..BlendOptions::default()
            },
            Some(5),
        ),
    ] {
        let blend = RigidBlend::new(&set, &options).expect("a blend");
        assert_eq!(blend.anchor_count(), 1);
        let mut found = Vec::new();
        blend
            .blend_anchored(&weights, &[Some(place)], &mut blend.scratch(), &mut found)
            .expect("a blend");
        // The shape does not change.
        assert!(((found[3] - found[0]) - (plain[3] - plain[0])).norm() < 1e-12);
        if let Some(vertex) = is_there {
            assert!((found[vertex] - place).norm() < 1e-12);
        }
        let too_many = blend.blend_anchored(&weights, &[None, None], &mut blend.scratch(), &mut found);
        assert!(matches!(too_many, Err(BlendError::WrongCount { what: "anchors", .. })));
    }
}

#[test]
fn soft_anchors_pull_as_hard_as_they_are_stiff() {
    let (topology, poses) = bent();
    let set = pose_set(&topology, &poses);
    let weights = [0.25, 0.25, 0.5];
    let plain = blend_once(&set, &BlendOptions::default(), &weights).expect("a blend");
    let apart = [plain[0] + Point::new(0.0, -1.0), plain[8] + Point::new(0.5, 0.5)];
    let mut last = f64::INFINITY;
    for stiffness in [0.1, 1.0, 10.0, 1000.0] {
        let blend = RigidBlend::new(&set, &soft(&[(0, stiffness), (8, stiffness)])).expect("a blend");
        let mut found = Vec::new();
        blend
            .blend_anchored(&weights, &apart.map(Some), &mut blend.scratch(), &mut found)
            .expect("a blend");
        let missed = (found[0] - apart[0]).norm() + (found[8] - apart[1]).norm();
        assert!(missed < 0.8 * last, "{stiffness}: {missed}");
        last = missed;
    }
    assert!(last < 2e-3, "{last}");

    // A single one, or several that agree with the poses, leave the poses alone.
    let blend = RigidBlend::new(&set, &soft(&[(0, 1.0), (8, 3.0)])).expect("a blend");
    for (k, pose) in poses.iter().enumerate() {
        let mut found = Vec::new();
        blend
            .blend(&unit(3, k), &mut blend.scratch(), &mut found)
            .expect("a blend");
        assert!(largest_difference(&found, pose) < 1e-12);
    }
    assert!(matches!(
        RigidBlend::new(&set, &soft(&[(0, 0.0)])),
        Err(BlendError::BadOption { .. })
    ));
    assert!(matches!(
        RigidBlend::new(&set, &soft(&[(9, 1.0)])),
        Err(BlendError::NoSuchVertex { vertex: 9, count: 9 })
    ));
}

#[test]
fn a_stiff_region_keeps_its_shape_and_gives_its_neighbours_the_work() {
    // A bar whose middle is asked to shear by anchors: a stiff left half leaves the shear to the right half.
    let (topology, flat) = grid(13, 3);
    let set = pose_set(&topology, &[flat.clone(), flat.clone()]);
    let bend = |regions: Vec<Region>| {
        let options = BlendOptions {
            regions,
            ..soft(&[(0, 1e3), (26, 1e3), (12, 1e3), (38, 1e3)])
        };
        let blend = RigidBlend::new(&set, &options).expect("a blend");
        let places = [0, 26, 12, 38].map(|v| Some(flat[v] + Point::new(0.0, if v % 13 == 0 { 0.0 } else { 2.0 })));
        let mut found = Vec::new();
        blend
            .blend_anchored(&[0.5, 0.5], &places, &mut blend.scratch(), &mut found)
            .expect("a blend");
        // How far the row drops over the left part of the bar.
        (found[13 + 4] - found[13]).y
    };
    let region = |stiffness| Region {
        point: 13 + 2,
        radius: 0.5,
        stiffness,
        stretch_limit: f64::INFINITY,
    };
    let (even, stiff, soft) = (bend(vec![]), bend(vec![region(50.0)]), bend(vec![region(0.02)]));
    assert!(stiff < 0.5 * even && soft > 1.3 * even, "{stiff} {even} {soft}");
    let refused = |region| {
        let options = BlendOptions {
            regions: vec![region],
            ..BlendOptions::default()
        };
        RigidBlend::new(&set, &options).expect_err("refused")
    };
    assert!(matches!(
        refused(Region {
            point: 99,
            ..region(1.0)
        }),
        BlendError::NoSuchVertex { .. }
    ));
    for bad in [
        Region {
            radius: 0.0,
            ..region(1.0)
        },
        Region {
            stretch_limit: 0.5,
            ..region(1.0)
        },
        Region {
            stretch_limit: f64::NAN,
            ..region(1.0)
        },
        region(f64::NAN),
    ] {
        assert!(matches!(refused(bad), BlendError::BadOption { .. }), "{bad:?}");
    }
}

#[test]
fn a_stretch_limit_holds_outside_the_poses_and_changes_nothing_inside() {
    let (topology, flat) = grid(5, 3);
    let wide: Vec<Point> = flat.iter().map(|p| Point::new(2.0 * p.x, p.y)).collect();
    let set = pose_set(&topology, &[flat.clone(), wide.clone()]);
    for stretch in STRETCHES {
        let limited = |stretch_limit| BlendOptions {
            regions: vec![Region {
                point: 7,
                radius: 10.0,
                stiffness: 1.0,
                stretch_limit,
            }],
            ..options(Reference::Canonical, stretch)
        };
        let width = |stretch_limit: f64, weight: f64| {
            let found = blend_once(&set, &limited(stretch_limit), &[1.0 - weight, weight]).expect("a blend");
            found[4].x - found[0].x
        };
        let free = blend_once(&set, &options(Reference::Canonical, stretch), &[0.5, 0.5]).expect("a blend");
        assert!((width(1.0, 0.5) - (free[4].x - free[0].x)).abs() < 1e-12, "{stretch:?}");
        assert!((width(1.0, 3.0) - 8.0).abs() < 1e-9, "{stretch:?}: {}", width(1.0, 3.0));
        assert!((width(1.0, -3.0) - 4.0).abs() < 1e-9, "{stretch:?}");
        if stretch != Stretch::Limited {
            assert!(
                (width(1.25, 3.0) - 10.0).abs() < 1e-9,
                "{stretch:?}: {}",
                width(1.25, 3.0)
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_crowd_gets_the_bytes_of_single_frames(
        (topology, poses) in poses_of_a_grid(),
        weights in proptest::collection::vec(-0.5..1.0f64, 3 * 11),
        count in 0_usize..12,
        threads in 1_usize..4,
    ) {
        let set = pose_set(&topology, &poses);
        for guard in [FrameGuard::Off, FrameGuard::Repair] {
            let blend = RigidBlend::new(&set, &BlendOptions { guard, ..BlendOptions::default() }).expect("a blend");
            let crowd: Vec<f64> = weights
                .chunks(3)
                .take(count)
                .flat_map(|w| [w[0], w[1], w[2], 1.0 - w[0] - w[1] - w[2]])
                .collect();
            let characters = crowd.len() / 4;
            let mut together = vec![Point::zeros(); characters * 20];
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let report = pool
                .install(|| blend.blend_crowd(&crowd, &mut blend.crowd_scratch(), &mut together))
                .expect("a crowd");
            let (mut scratch, mut single, mut flipped) = (blend.scratch(), Vec::new(), 0);
            for (weights, found) in crowd.chunks(4).zip(together.chunks(20)) {
                flipped += blend.blend(weights, &mut scratch, &mut single).expect("a blend").flipped;
                prop_assert_eq!(found, &single[..]);
            }
            prop_assert_eq!(report.flipped, flipped);
        }
    }
}

#[test]
fn a_crowd_whose_lists_do_not_fit_is_refused() {
    let (topology, poses) = bent();
    let blend = RigidBlend::new(&pose_set(&topology, &poses), &BlendOptions::default()).expect("a blend");
    let mut positions = vec![Point::zeros(); 18];
    let mut crowd = |weights: &[f64]| blend.blend_crowd(weights, &mut blend.crowd_scratch(), &mut positions);
    assert!(matches!(crowd(&[0.5, 0.5, 0.0]), Err(BlendError::WrongCount { .. })));
    assert!(matches!(
        crowd(&[0.5, 0.5, 0.0, 1.0]),
        Err(BlendError::WrongCount { .. })
    ));
    assert!(matches!(
        crowd(&[0.5, 0.5, 0.0, 1.0, 1.0, 1.0]),
        Err(BlendError::BadWeights { .. })
    ));
}
