//! Correspondence by what is drawn, through the public interface: drawings in memory, no landmarks.

use std::sync::Arc;

use inbetween::appearance::Appearance;
use inbetween::input::{Drawing, SvgOptions, read_svg};
use inbetween::math::Point;
use inbetween::pipeline::{LayerSpec, PoseSpec, map_layer};
use inbetween::pose::Mapping;
use inbetween::registration::{Pin, RingPairs, register};

fn drawing(inside: &str) -> Drawing {
    let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">{inside}</svg>"#);
    read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing")
}

fn mapped(drawings: [Drawing; 2]) -> Mapping {
    let poses = drawings.into_iter().zip(["first", "second"]);
    let poses = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
    let (mapping, _) = map_layer(&LayerSpec::new("figure", poses)).expect("a mapping");
    mapping.check().expect("valid");
    mapping
}

/// Where a place of the first pose is in the second, by the mesh.
fn carried(mapping: &Mapping, place: Point) -> Point {
    let poses = mapping.poses.positions();
    let triangles = mapping.poses.topology().triangles();
    let found = triangles.iter().find_map(|&triangle| {
        let weights = inbetween::mesh::geometry::barycentric(triangle.map(|v| poses[0][v]), place)?;
        let is_inside = weights.iter().all(|w| *w >= -1e-9);
        is_inside.then(|| (triangle.iter().zip(weights)).map(|(&v, w)| poses[1][v] * w).sum())
    });
    found.expect("a place inside")
}

#[test]
fn a_spot_is_found_where_it_moved_to_inside_an_outline_that_stays() {
    let with_spot = |x: f64, y: f64| {
        drawing(&format!(
            r##"<rect x="50" y="80" width="300" height="240" rx="60" fill="#ca8"/><circle cx="{x}" cy="{y}" r="18" fill="#213"/>"##
        ))
    };
    let (first, second) = (with_spot(170.0, 190.0), with_spot(178.0, 183.0));
    let points = first.outline.outer().points().to_vec();
    let beginnings: Vec<Vec<RingPairs>> = vec![vec![], vec![vec![(points.clone(), points)]]];
    let appearances = [&first, &second].map(|drawing| Arc::new(Appearance::new(drawing)));
    let pins: Vec<Vec<Pin>> = vec![vec![], vec![]];
    let (registration, _) = register(&appearances, 0, &beginnings, &pins).expect("a registration");
    let spot = registration.carried(1, Point::new(170.0, 190.0)).expect("known");
    assert!((spot - Point::new(178.0, 183.0)).norm() < 1.5, "{spot}");
    let corner = registration.carried(1, Point::new(330.0, 300.0)).expect("known");
    assert!((corner - Point::new(330.0, 300.0)).norm() < 4.0, "{corner}");
    // What the artist says wins.
    let pins = vec![
        vec![],
        vec![Pin::certain(Point::new(260.0, 200.0), Point::new(266.0, 200.0))],
    ];
    let (registration, _) = register(&appearances, 0, &beginnings, &pins).expect("a registration");
    let pinned = registration.carried(1, Point::new(260.0, 200.0)).expect("known");
    assert!((pinned - Point::new(266.0, 200.0)).norm() < 1.0, "{pinned}");
}

#[test]
fn two_equal_rings_correspond_point_by_point() {
    let ring = || {
        drawing(
            r##"<path fill="#457" fill-rule="evenodd" d="M200 40a160 160 0 1 0 0.01 0zM200 90a110 110 0 1 1 -0.01 0z"/>"##,
        )
    };
    let mapping = mapped([ring(), ring()]);
    let poses = mapping.poses.positions();
    assert_eq!(mapping.rings.len(), 2);
    for (a, b) in poses[0].iter().zip(&poses[1]) {
        assert!((a - b).norm() < 4.0, "{a} {b}");
    }
}

#[test]
fn names_of_elements_say_what_corresponds() {
    // Twice the same spots, which only their names tell apart.
    let with_spots = |left: &str, right: &str| {
        drawing(&format!(
            r##"<rect id="body" x="50" y="80" width="300" height="240" rx="60" fill="#ca8"/><circle id="{left}" cx="150" cy="200" r="14" fill="#213"/><circle id="{right}" cx="190" cy="200" r="14" fill="#213"/>"##
        ))
    };
    let mapping = mapped([with_spots("a", "b"), with_spots("c", "a")]);
    let spot = carried(&mapping, Point::new(150.0, 200.0));
    assert!((spot - Point::new(190.0, 200.0)).norm() < 10.0, "{spot}");
}

#[test]
fn a_ball_that_is_squashed_keeps_its_top_and_its_eyes() {
    let ball = |rx: f64, ry: f64, y: f64| {
        drawing(&format!(
            r##"<ellipse cx="200" cy="{y}" rx="{rx}" ry="{ry}" fill="#e33"/><circle cx="{}" cy="{}" r="9" fill="#fff"/><circle cx="{}" cy="{}" r="9" fill="#fff"/>"##,
            200.0 - 0.3 * rx,
            y - 0.2 * ry,
            200.0 + 0.3 * rx,
            y - 0.2 * ry
        ))
    };
    let mapping = mapped([ball(90.0, 120.0, 200.0), ball(120.0, 90.0, 230.0)]);
    let top = carried(&mapping, Point::new(200.0, 90.0));
    assert!(top.y < 230.0 - 50.0 && (top.x - 200.0).abs() < 25.0, "{top}");
    let eye = carried(&mapping, Point::new(200.0 - 27.0, 176.0));
    assert!((eye - Point::new(200.0 - 36.0, 212.0)).norm() < 9.0, "{eye}");
}
