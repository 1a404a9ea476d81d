//! Landmarks on the rims of holes: which hole is which, how they are turned, and what contradicts.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use inbetween::input::{SvgOptions, read_svg};
use inbetween::math::Point;
use inbetween::outline::ArcLength;
use inbetween::pipeline::{
    Build, CharacterSpec, LandmarkPlace, LandmarkSpec, LayerSpec, MappingReport, PipelineError, PoseSpec, map_layer,
};
use inbetween::pose::{LandmarkKind, Mapping};
use inbetween::scene::Scene;
use proptest::prelude::*;

use crate::workshop::Workshop;

/// A closed polygon around a point, by its radius at every angle in steps of a degree times `step`.
fn polygon(middle: Point, step: usize, radius: impl Fn(f64) -> f64) -> Vec<Point> {
    (0..360)
        .step_by(step)
        .map(|degrees| middle + radius((degrees as f64).to_radians()) * direction(degrees as f64))
        .collect()
}

fn direction(degrees: f64) -> Point {
    let angle = degrees.to_radians();
    Point::new(angle.cos(), angle.sin())
}

/// An SVG drawing of an even-odd path of polygons.
fn svg(polygons: &[Vec<Point>]) -> String {
    let mut path = String::new();
    for polygon in polygons {
        for (k, p) in polygon.iter().enumerate() {
            let _ = write!(path, "{} {} {} ", if k == 0 { 'M' } else { 'L' }, p.x, p.y);
        }
        path.push_str("Z ");
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"200\" viewBox=\"0 0 200 200\">\
         <path d=\"{path}\" fill=\"#456\" fill-rule=\"evenodd\"/></svg>"
    )
}

const MIDDLE: [f64; 2] = [100.0, 100.0];

/// A plate whose outline says how it is turned.
fn plate() -> Vec<Point> {
    polygon(MIDDLE.into(), 3, |angle| 80.0 + 8.0 * (3.0 * angle).sin() + 7.0 * angle.cos())
}

/// A plate with one round hole in its middle.
fn ring() -> String {
    svg(&[plate(), polygon(MIDDLE.into(), 5, |_| 35.0)])
}

/// A plate with two unlike holes, at the left and at the right.
fn two_holes(left: f64, right: f64) -> String {
    let hole = |x: f64, radius: f64| polygon(Point::new(x, 100.0), 15, |_| radius);
    svg(&[plate(), hole(70.0, left), hole(135.0, right)])
}

fn drawn(name: &str, text: &str) -> PoseSpec {
    PoseSpec::drawn(name, read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing"))
}

fn layer(poses: &[String], landmarks: &[(&str, &[Option<Point>])]) -> LayerSpec {
    let names = ["a", "b", "c"];
    let poses = names.iter().zip(poses).map(|(name, text)| drawn(name, text));
    let mut layer = LayerSpec::new("plate", poses.collect());
    layer.landmarks.extend(landmarks.iter().map(|(name, at)| LandmarkSpec {
        name: (*name).to_owned(),
        at: at.to_vec(),
    }));
    layer
}

fn mapped(layer: &LayerSpec) -> (Mapping, MappingReport) {
    let (mapping, report) = map_layer(layer).expect("a mapping");
    mapping.check().expect("valid");
    (mapping, report)
}

/// The vertex of a ring of the mesh that is at these places, one a pose.
fn vertex_at(mapping: &Mapping, ring: usize, places: &[Point]) -> Option<usize> {
    let is_there = |vertex: &usize| {
        let mut each = mapping.poses.positions().iter().zip(places);
        each.all(|(positions, place)| (positions[*vertex] - place).norm() < 1e-9)
    };
    mapping.rings[ring].iter().copied().find(is_there)
}

/// By how many degrees vertices of a ring are turned from pose 0 to pose 1 about the middle of the plate: the least and the most.
fn turns(mapping: &Mapping, ring: usize) -> (f64, f64) {
    let angle = |pose: usize, vertex: usize| {
        let from = mapping.poses.positions()[pose][vertex] - Point::from(MIDDLE);
        from.y.atan2(from.x)
    };
    let turn = |&vertex: &usize| {
        let turn = (angle(1, vertex) - angle(0, vertex)).rem_euclid(TAU);
        (if turn > 0.5 * TAU { turn - TAU } else { turn }).to_degrees()
    };
    let turns = mapping.rings[ring].iter().map(turn);
    turns.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), turn| (least.min(turn), most.max(turn)))
}

fn on_hole(degrees: f64) -> Point {
    Point::from(MIDDLE) + 35.0 * direction(degrees)
}

#[test]
fn landmarks_turn_the_rim_of_a_hole_against_the_outline() {
    let workshop = Workshop::new();
    workshop.file("a.svg", ring().as_bytes());
    workshop.file("b.svg", ring().as_bytes());
    let mut text = "[[pose]]\nname = \"a\"\nsource = \"a.svg\"\nat = [0, 0]\n[[pose]]\nname = \"b\"\nsource = \"b.svg\"\nat = [1, 0]\n".to_owned();
    let degrees = [10.0, 130.0, 250.0];
    for (k, at) in degrees.iter().enumerate() {
        let [a, b] = [on_hole(*at), on_hole(at + 40.0)];
        let _ = write!(
            text,
            "[[landmark]]\nname = \"rim{k}\"\nat = {{ a = [{}, {}], b = [{}, {}] }}\n",
            a.x, a.y, b.x, b.y
        );
    }
    workshop.scene(&text);
    workshop.succeeds(&["map", "scene.toml", "-o", "mapping.json"]);
    workshop.succeeds(&["check", "mapping.json"]);
    let written = std::fs::read_to_string(workshop.path("mapping.json")).expect("a mapping");
    let mapping = Mapping::from_json(&written).expect("a mapping");
    for at in degrees {
        assert!(vertex_at(&mapping, 1, &[on_hole(at), on_hole(at + 40.0)]).is_some(), "{at}");
    }
    // All of the rim goes with them, and nothing of the outline.
    let (least, most) = turns(&mapping, 1);
    assert!(least > 35.0 && most < 45.0, "{least} {most}");
    let (least, most) = turns(&mapping, 0);
    assert!(least > -3.0 && most < 3.0, "{least} {most}");

    let scene = Scene::open(&workshop.path("scene.toml")).expect("a scene");
    let (_, report) = mapped(&scene.layer_spec(0).expect("drawings"));
    for (landmark, at) in report.landmarks.iter().zip(degrees) {
        assert_eq!((landmark.kind, landmark.given.as_slice()), (LandmarkKind::OnRim, &[true; 2][..]));
        assert!((landmark.at[1][0] - on_hole(at + 40.0)).norm() < 1e-9);
    }
    workshop.succeeds(&["show", "scene.toml", "-o", "show.png"]);
}
