use proptest::prelude::*;

use super::*;
use crate::math::rotation;
use crate::mesh::geometry;

/// A bar of `columns` x `rows` squares of side 1, each cut in two.
fn bar(columns: usize, rows: usize) -> (Topology, Vec<Point>) {
    let width = columns + 1;
    let at = |i: usize, j: usize| j * width + i;
    let triangles = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 2 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            }
        })
        .collect();
    let positions = (0..=rows)
        .flat_map(|j| (0..width).map(move |i| Point::new(i as f64, j as f64)))
        .collect();
    (Topology::new(width * (rows + 1), triangles).expect("a mesh"), positions)
}

fn dragged(rest: (&Topology, &[Point]), from: &[Point], to: &[Point]) -> (Vec<Point>, DragReport) {
    let deformation = HandleDeformation::new(rest.0, rest.1, from).expect("handles");
    let mut positions = Vec::new();
    let report = deformation
        .drag(to, &mut deformation.scratch(), &mut positions)
        .expect("a deformation");
    (positions, report)
}

fn all_positive(topology: &Topology, positions: &[Point]) -> bool {
    let area = |&t: &[usize; 3]| geometry::signed_area(geometry::corners(positions, t));
    topology.triangles().iter().all(|t| area(t) > 0.0)
}

/// Where the place `at` of the rest pose is now.
fn carried(topology: &Topology, rest: &[Point], positions: &[Point], at: Point) -> Point {
    let found = crate::mesh::PointLocator::new(topology.triangles(), rest)
        .locate(at)
        .expect("inside");
    let corners = geometry::corners(positions, topology.triangles()[found.triangle]);
    corners.iter().zip(found.barycentric).map(|(p, b)| p * b).sum()
}

#[test]
fn one_handle_translates() {
    let (topology, rest) = bar(6, 2);
    let (positions, report) = dragged((&topology, &rest), &[Point::new(1.3, 0.7)], &[Point::new(4.3, -2.3)]);
    for (p, q) in rest.iter().zip(&positions) {
        assert!((p + Point::new(3.0, -3.0) - q).norm() < 1e-9);
    }
    assert!(report.energy < 1e-12 && report.repair == Repair::NotNeeded);
}

#[test]
fn handles_left_where_they_are_change_nothing() {
    let (topology, rest) = bar(8, 2);
    let handles = [Point::new(0.5, 0.5), Point::new(4.0, 1.0), Point::new(7.7, 1.2)];
    let (positions, report) = dragged((&topology, &rest), &handles, &handles);
    assert!(rest.iter().zip(&positions).all(|(p, q)| (p - q).norm() < 1e-9));
    assert!(report.iterations <= 8, "{}", report.iterations);
}

#[test]
fn a_stretched_triangle_by_hand() {
    // Every corner is held, so the map is known: twice as wide. The nearest rotation is none, the deviation 1.
    let topology = Topology::new(3, vec![[0, 1, 2]]).expect("a mesh");
    let rest = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point::from);
    let to = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]].map(Point::from);
    let (positions, report) = dragged((&topology, &rest), &rest, &to);
    assert!(positions.iter().zip(&to).all(|(p, q)| (p - q).norm() < 1e-12));
    assert!((report.energy - 1.0).abs() < 1e-9, "{}", report.energy);
    // A fourth handle has nothing left to hold.
    let mut four = rest.to_vec();
    four.push(Point::new(0.3, 0.3));
    let error = HandleDeformation::new(&topology, &rest, &four).expect_err("one too many");
    assert!(matches!(error, HandleError::Dependent { .. }), "{error}");
}

#[test]
fn a_bar_bends_half_round_and_keeps_its_width() {
    let (topology, rest) = bar(24, 2);
    // Both ends are held by two handles each; the right end is turned by 180 degrees and put above the left one.
    let ends = [[0.0, 0.0], [0.0, 2.0], [24.0, 0.0], [24.0, 2.0]].map(Point::from);
    let to = [[0.0, 0.0], [0.0, 2.0], [0.0, 16.0], [0.0, 14.0]].map(Point::from);
    let (positions, report) = dragged((&topology, &rest), &ends, &to);
    assert!(all_positive(&topology, &positions));
    let middle = carried(&topology, &rest, &positions, Point::new(12.0, 1.0));
    assert!(middle.x > 5.0 && (middle.y - 8.0).abs() < 0.5, "{middle}");
    for i in [6, 12, 18] {
        let width = (positions[i] - positions[50 + i]).norm();
        assert!((width - 2.0).abs() < 0.2, "column {i}: {width}");
    }
    assert!(report.energy < 0.05, "{}", report.energy);
}

#[test]
fn a_drag_goes_on_from_the_last_and_the_first_forgets_nothing() {
    let (topology, rest) = bar(16, 2);
    let handles = [[0.5, 1.0], [8.0, 1.0], [15.5, 1.0]].map(Point::from);
    let deformation = HandleDeformation::new(&topology, &rest, &handles).expect("handles");
    let (mut scratch, mut positions) = (deformation.scratch(), Vec::new());
    // Once around the middle, step by step: the end that follows has wound up by a whole turn.
    let mut slow = DragReport {
        iterations: 0,
        last_motion: 0.0,
        energy: 0.0,
        repair: Repair::NotNeeded,
    };
    for step in 0..=24 {
        let turn = rotation(std::f64::consts::PI * f64::from(step) / 48.0);
        let to = [handles[0], handles[1], handles[1] + turn * (handles[2] - handles[1])];
        slow = deformation
            .drag(&to, &mut scratch, &mut positions)
            .expect("a deformation");
        assert!(all_positive(&topology, &positions), "step {step}");
    }
    let mut fresh = Vec::new();
    let to = [handles[0], handles[1], Point::new(8.0, 8.5)];
    let report = deformation
        .drag(&to, &mut deformation.scratch(), &mut fresh)
        .expect("a deformation");
    assert!(
        (report.energy - slow.energy).abs() < 1e-3,
        "{} {}",
        report.energy,
        slow.energy
    );
    // In a frame's time it does not arrive, but the next frames go on.
    let hasty = HandleDeformation::new(&topology, &rest, &handles).expect("handles");
    let hasty = hasty.with_options(DragOptions {
        most_iterations: 8,
        ..DragOptions::default()
    });
    let (mut hasty_scratch, mut arrived) = (hasty.scratch(), Vec::new());
    for _ in 0..40 {
        let report = hasty
            .drag(&to, &mut hasty_scratch, &mut arrived)
            .expect("a deformation");
        assert!(report.iterations <= 16 && (arrived[17 + 8] - to[1]).norm() < 1e-9);
    }
    let gap = arrived
        .iter()
        .zip(&fresh)
        .map(|(p, q)| (p - q).norm())
        .fold(0.0, f64::max);
    assert!(gap < 0.05, "{gap}");
    // The same again is there already, and other handles share the factor.
    let again = deformation
        .drag(&to, &mut scratch, &mut positions)
        .expect("a deformation");
    assert!(again.iterations < 20, "{}", again.iterations);
    let other = deformation.with_handles(&handles[..2]).expect("handles");
    assert_eq!(other.handle_count(), 2);
    assert!(Arc::ptr_eq(&other.shape, &deformation.shape));
}

#[test]
fn a_handle_pushed_far_into_the_shape_inverts_nothing() {
    let (topology, rest) = bar(12, 4);
    let handles = [[0.0, 0.0], [0.0, 4.0], [12.0, 0.0], [12.0, 4.0], [6.0, 3.0], [6.0, 1.0]].map(Point::from);
    let mut to = handles;
    to[5] = Point::new(6.0, 2.95);
    let (positions, report) = dragged((&topology, &rest), &handles, &to);
    assert!(all_positive(&topology, &positions));
    assert!((positions[19] - to[5]).norm() < 1e-8);
    assert!(matches!(report.repair, Repair::Done { .. }), "{report:?}");
}

#[test]
fn what_cannot_be_is_refused_by_handle() {
    let (topology, rest) = bar(6, 2);
    let new = |handles: &[Point]| HandleDeformation::new(&topology, &rest, handles);
    assert_eq!(new(&[]).expect_err("none"), HandleError::NoHandle);
    let outside = new(&[Point::new(1.0, 1.0), Point::new(3.0, -1.0)]).expect_err("outside");
    assert!(
        matches!(outside, HandleError::Outside { handle: 1, distance, .. } if (distance - 1.0).abs() < 1e-12),
        "{outside}"
    );
    let twice = new(&[Point::new(1.0, 1.0), Point::new(2.0, 1.0), Point::new(1.0, 1.0)]).expect_err("twice");
    assert_eq!(twice, HandleError::Coincident { first: 0, second: 2 });
    let handles = [Point::new(1.0, 1.0), Point::new(5.0, 1.0)];
    let deformation = new(&handles).expect("handles");
    let mut positions = Vec::new();
    let mut drag = |to: &[Point]| deformation.drag(to, &mut deformation.scratch(), &mut positions);
    assert!(matches!(drag(&handles[..1]), Err(HandleError::WrongCount { .. })));
    assert!(matches!(
        drag(&[handles[0]; 2]),
        Err(HandleError::TargetsCoincide { .. })
    ));
    let nowhere = drag(&[handles[0], Point::new(f64::NAN, 0.0)]);
    assert!(matches!(nowhere, Err(HandleError::BadPlace { handle: 1, .. })));
    // The three corners of a triangle, reflected: nothing but an inverted triangle fits.
    let corners = [rest[0], rest[1], rest[8]];
    let deformation = new(&corners).expect("handles");
    let reflected = corners.map(|p| Point::new(-p.x, p.y));
    let error = deformation
        .drag(&reflected, &mut deformation.scratch(), &mut positions)
        .expect_err("inside out");
    assert!(matches!(error, HandleError::Inverts { .. }), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn handles_moved_rigidly_move_the_shape_rigidly(
        angle_rad in -3.1..3.1f64,
        (x, y) in (-9.0..9.0f64, -9.0..9.0f64),
        places in proptest::collection::vec((0.0..7.0f64, 0.0..2.0f64), 2..6),
    ) {
        let (topology, rest) = bar(7, 2);
        let handles: Vec<Point> = places.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let apart = handles.iter().enumerate().all(|(k, a)| handles[..k].iter().all(|b| (a - b).norm() > 0.5));
        prop_assume!(apart);
        let turn = rotation(angle_rad);
        let motion = |p: &Point| turn * p + Point::new(x, y);
        let to: Vec<Point> = handles.iter().map(motion).collect();
        let (positions, report) = dragged((&topology, &rest), &handles, &to);
        prop_assert!(report.energy < 1e-9);
        for (p, q) in rest.iter().zip(&positions) {
            prop_assert!((motion(p) - q).norm() < 1e-5, "{} {}", motion(p), q);
        }
    }

    #[test]
    fn handles_are_met_and_nothing_inverts(
        pulls in proptest::collection::vec((-1.5..1.5f64, -1.5..1.5f64), 4),
        mirror_free in 0.1..0.9f64,
    ) {
        let (topology, rest) = bar(9, 3);
        let handles = [[0.4, mirror_free], [3.3, 2.2], [6.1, 0.7], [8.8, 2.9]].map(Point::from);
        let to: Vec<Point> = handles.iter().zip(&pulls).map(|(p, &(x, y))| p + Point::new(x, y)).collect();
        let (positions, _) = dragged((&topology, &rest), &handles, &to);
        prop_assert!(all_positive(&topology, &positions));
        for (p, q) in handles.iter().zip(&to) {
            prop_assert!((carried(&topology, &rest, &positions, *p) - q).norm() < 1e-8);
        }
    }
}
