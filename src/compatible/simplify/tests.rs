//! Enclosure, simplicity and correspondence of whole simplifications.

use proptest::prelude::*;

use super::*;
use crate::math::predicate;
use crate::outline::ArcLength;
use crate::outline::testing::{Kinship, Recipe, outlines, poses};

/// A wavy closed curve around a point: `waves` bumps of the given height, `count` points.
fn wavy(count: usize, waves: usize, height: f64, phase: f64) -> Outline {
    let points = (0..count).map(|k| {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let radius = 100.0 * (1.0 + height * (waves as f64 * angle + phase).sin());
        Point::new(radius * angle.cos(), radius * angle.sin())
    });
    Outline::new(Ring::new(points).expect("a ring"), Vec::new()).expect("simple")
}

/// The largest distance, over the diagonal, by which a point of the outline is outside its polygon.
fn escape(outline: &Outline, polygon: &Outline) -> f64 {
    let outside = |p: &Point| {
        let on_edge = polygon.outer().edges().any(|(a, b)| predicate::on_segment(*p, a, b));
        if on_edge || polygon.contains(*p) {
            0.0
        } else {
            ArcLength::new(polygon.outer()).nearest(*p).1
        }
    };
    outline.outer().points().iter().map(outside).fold(0.0, f64::max) / outline.diagonal()
}

fn on_ring(ring: usize, parameter: f64) -> RingPoint {
    RingPoint { ring, parameter }
}

#[test]
fn a_square_with_points_along_its_sides_becomes_four_vertices() {
    let side = |k: usize| k as f64 / 10.0;
    let points = (0..40).map(|k| match k / 10 {
        0 => Point::new(side(k), 0.0),
        1 => Point::new(1.0, side(k - 10)),
        2 => Point::new(1.0 - side(k - 20), 1.0),
        _ => Point::new(0.0, 1.0 - side(k - 30)),
    });
    let square = Outline::new(Ring::new(points).expect("a ring"), Vec::new()).expect("simple");
    let outlines = vec![square.clone(), square];
    let simplified = simplify(
        &outlines,
        &[Correspondence::identity(2, 64)],
        &[],
        &SimplifyOptions::default(),
    )
    .expect("simplified");
    assert_eq!(simplified.report.vertices, 4);
    assert!(simplified.report.excess_area.iter().all(|excess| excess.abs() < 1e-12));
}

#[test]
fn a_landmark_survives_where_it_would_be_collapsed() {
    let outlines = vec![wavy(200, 3, 0.05, 0.0), wavy(160, 3, 0.05, 0.4)];
    let free = simplify(
        &outlines,
        &[Correspondence::identity(2, 64)],
        &[],
        &SimplifyOptions::default(),
    );
    let rows: Vec<Vec<RingPoint>> = (0..40).map(|k| vec![on_ring(0, f64::from(k) / 40.0); 2]).collect();
    let pinned = simplify(
        &outlines,
        &[Correspondence::identity(2, 64)],
        &rows,
        &SimplifyOptions::default(),
    );
    let (free, pinned) = (free.expect("simplified"), pinned.expect("simplified"));
    assert!(
        free.report.vertices < 40 && pinned.report.vertices >= 40,
        "{free:?} {pinned:?}"
    );
}

#[test]
fn bad_input_is_refused() {
    let outlines = vec![wavy(60, 3, 0.1, 0.0)];
    let options = SimplifyOptions {
        tolerance: f64::NAN,
        ..SimplifyOptions::default()
    };
    let refused = simplify(&outlines, &[Correspondence::identity(1, 8)], &[], &options);
    assert!(matches!(refused, Err(SimplifyError::BadTolerance(_))));
    let refused = simplify(&outlines, &[], &[], &SimplifyOptions::default());
    assert_eq!(
        refused,
        Err(SimplifyError::RingCount {
            pose: 0,
            found: 1,
            expected: 0
        })
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn every_pose_is_enclosed_closely_by_a_simple_polygon(
        shapes in prop::collection::vec((60_usize..240, 2_usize..9, 0.0..0.6f64, 0.0..6.0f64), 1..5),
        tolerance in 0.005..0.05f64,
    ) {
        let outlines: Vec<Outline> = shapes.iter().map(|&(n, waves, height, phase)| wavy(n, waves, height, phase)).collect();
        let identity = Correspondence::identity(outlines.len(), 64);
        let options = SimplifyOptions { tolerance, ..SimplifyOptions::default() };
        // `Outline::new` inside has already proven each polygon simple.
        let simplified = simplify(&outlines, &[identity], &[], &options).expect("simplified");
        let count = simplified.report.vertices;
        for (outline, polygon) in outlines.iter().zip(&simplified.polygons) {
            prop_assert_eq!(polygon.outer().len(), count);
            prop_assert!(escape(outline, polygon) < 1e-12);
            // An apex lies at most twice the tolerance off, and the polygon between vertices less.
            let farthest = polygon.outer().points().iter()
                .map(|&p| ArcLength::new(outline.outer()).nearest(p).1)
                .fold(0.0, f64::max);
            prop_assert!(farthest <= 2.0 * tolerance * outline.diagonal());
        }
    }
}

/// By how much, over the diagonal, a ring of the outline lies on the wrong side of its ring of the polygon.
fn leak(outline: &Outline, polygon: &Outline) -> f64 {
    let rings = outline.rings().iter().zip(polygon.rings()).enumerate();
    let worst = rings.flat_map(|(number, (ring, around))| {
        ring.points().iter().map(move |p| {
            let is_beyond = around.contains(*p) == (number > 0);
            if is_beyond {
                ArcLength::new(around).nearest(*p).1
            } else {
                0.0
            }
        })
    });
    worst.fold(0.0, f64::max) / outline.diagonal()
}

/// Simplifies and proves everything that is promised: equal counts, simple, enclosing, landmarks in their places.
fn prove(outlines: &[Outline], landmarks: &[f64], tolerance: f64) -> Result<(), TestCaseError> {
    let identity = |_| Correspondence::identity(outlines.len(), 64);
    let correspondences: Vec<Correspondence> = outlines[0].rings().iter().map(identity).collect();
    // On one ring after the other.
    let landmarks = landmarks.iter().enumerate();
    let landmarks: Vec<RingPoint> = landmarks.map(|(k, &t)| on_ring(k % correspondences.len(), t)).collect();
    let pinned: Vec<Vec<RingPoint>> = landmarks.iter().map(|&at| vec![at; outlines.len()]).collect();
    let options = SimplifyOptions {
        tolerance,
        ..SimplifyOptions::default()
    };
    // `Outline::new` inside has already proven each polygon simple.
    let simplified = simplify(outlines, &correspondences, &pinned, &options)
        .map_err(|error| TestCaseError::fail(error.to_string()))?;
    let counts = |polygon: &Outline| polygon.rings().iter().map(Ring::len).collect::<Vec<_>>();
    for (outline, polygon) in outlines.iter().zip(&simplified.polygons) {
        prop_assert_eq!(counts(polygon), counts(&simplified.polygons[0]));
        let leaked = leak(outline, polygon);
        prop_assert!(leaked < 1e-9, "leaks {leaked}");
    }
    for RingPoint { ring, parameter } in landmarks {
        let is_there = |k: usize| {
            let mut each = simplified.polygons.iter().zip(outlines);
            each.all(|(polygon, outline)| {
                polygon.rings()[ring].point(k) == ArcLength::new(&outline.rings()[ring]).at(parameter)
            })
        };
        let is_vertex = (0..simplified.polygons[0].rings()[ring].len()).any(is_there);
        prop_assert!(is_vertex, "the landmark at {parameter} of ring {ring} has no vertex");
    }
    Ok(())
}

#[test]
fn a_landmark_in_the_middle_of_a_side_stays_there() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point::from);
    let outline = Outline::new(Ring::new(square).expect("a ring"), Vec::new()).expect("simple");
    let simplified = simplify(
        &[outline.clone(), outline],
        &[Correspondence::identity(2, 64)],
        &[vec![on_ring(0, 0.125); 2]],
        &SimplifyOptions::default(),
    )
    .expect("simplified");
    assert_eq!(simplified.report.vertices, 5);
    for polygon in &simplified.polygons {
        assert!(polygon.outer().points().contains(&Point::new(0.5, 0.0)));
    }
}

#[test]
fn a_hole_that_is_smaller_than_the_tolerance_keeps_an_area() {
    let drawn = |seed: u64, vertices: usize, poses: usize, holes: usize, kinship: Kinship| {
        outlines(&Recipe {
            vertices,
            poses,
            holes,
            kinship,
            seed,
        })
    };
    for (outlines, tolerance) in [
        (drawn(57449, 7, 5, 1, Kinship::Strangers), 0.016_602_732_686_085_18),
        (drawn(66822, 4, 7, 1, Kinship::Relatives), 0.029_898_273_173_047_343),
    ] {
        prove(&outlines, &[], tolerance).expect("proven");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_outlines_are_enclosed_by_simple_polygons_that_correspond(
        outlines in poses(3..201, 1..9, 0..3, Kinship::Strangers),
        tolerance in 0.005..0.05f64,
        landmarks in prop::collection::vec(0.0..1.0f64, 0..4),
    ) {
        prove(&outlines, &landmarks, tolerance)?;
    }
}

#[test]
fn the_reported_deviation_is_that_of_the_farthest_point() {
    let outlines = [wavy(200, 5, 0.2, 0.0), wavy(160, 7, 0.1, 1.0)];
    let correspondence = Correspondence::identity(2, 64);
    let options = SimplifyOptions {
        tolerance: 0.03,
        ..SimplifyOptions::default()
    };
    let simplified = simplify(&outlines, &[correspondence], &[], &options).expect("simplified");
    for ((polygon, outline), reported) in simplified
        .polygons
        .iter()
        .zip(&outlines)
        .zip(&simplified.report.deviation)
    {
        let measured = ArcLength::new(polygon.outer());
        let distances = outline.outer().points().iter().map(|p| measured.nearest(*p).1);
        let farthest = distances.fold(0.0, f64::max) / outline.diagonal();
        assert!((farthest - reported).abs() < 1e-12 && farthest > 0.0);
    }
}

#[test]
fn a_variation_that_is_kept_is_what_comes_next() {
    let outlines = [0.0, 1.5, 3.0].map(|phase| wavy(200, 5, 0.4, phase));
    let matching = [Correspondence::identity(3, 200)];
    let options = SimplifyOptions::default();
    let mut simplification = Simplification::new(&outlines, &matching, &[], &options).expect("simplified");
    let first = simplification.polygons().expect("simplified");
    assert_eq!(
        first,
        simplify(&outlines, &matching, &[], &options).expect("simplified")
    );
    let (mesh, _) = crate::compatible::triangulate(&first.polygons, &[]).expect("triangulated");
    assert!(mesh.steiner > 0);
    let varied: Vec<Simplified> = (0..6).filter_map(|_| simplification.vary(&mesh)).collect();
    let last = varied.last().expect("an order that makes a difference");
    for simplified in &varied {
        assert_ne!(simplified.polygons, first.polygons);
        for (polygon, outline) in simplified.polygons.iter().zip(&outlines) {
            assert!(escape(outline, polygon) < 1e-12);
        }
        assert!(
            simplified
                .report
                .deviation
                .iter()
                .all(|d| *d <= options.tolerance + 1e-12)
        );
    }
    // Not kept: nothing has happened.
    assert_eq!(simplification.polygons().expect("simplified"), first);
    let mut again = Simplification::new(&outlines, &matching, &[], &options).expect("simplified");
    again.polygons().expect("simplified");
    let mut kept = None;
    for _ in 0..6 {
        kept = again.vary(&mesh).or(kept);
        if kept.as_ref() == Some(last) {
            again.keep();
            break;
        }
    }
    assert_eq!(&again.polygons().expect("simplified"), last);
}

#[test]
fn what_has_not_changed_is_taken_over_and_what_has_is_not() {
    let outlines = [0.0, 1.5, 3.0].map(|phase| wavy(200, 5, 0.4, phase));
    let matching = [Correspondence::identity(3, 200)];
    let options = SimplifyOptions::default();
    let first = vec![on_ring(0, 0.1); 3];
    let landmarks = |second: f64| vec![first.clone(), [0.5, second, 0.5].map(|t| on_ring(0, t)).to_vec()];
    let before = Simplification::new(&outlines, &matching, &landmarks(0.5), &options).expect("simplified");
    let mut others = outlines.clone();
    others[2] = wavy(200, 5, 0.3, 2.0);
    for (outlines, second, tolerance) in [(&outlines, 0.53, 0.02), (&others, 0.5, 0.02), (&outlines, 0.5, 0.01)] {
        let options = SimplifyOptions {
            tolerance,
            ..SimplifyOptions::default()
        };
        let anew = simplify(outlines, &matching, &landmarks(second), &options).expect("simplified");
        // Where one pose's landmark is not known yet, that pose is left for later.
        let known = [
            vec![Some(on_ring(0, 0.1)); 3],
            vec![Some(on_ring(0, 0.5)), Some(on_ring(0, second)), None],
        ];
        let ahead = SimplifiedAlone::new(outlines, &known, &options, &before.alone()).expect("simplified");
        for alone in [before.alone(), ahead] {
            let again = Simplification::with(outlines, &matching, &landmarks(second), &options, &alone);
            assert_eq!(again.expect("simplified").polygons().expect("simplified"), anew);
        }
    }
}
