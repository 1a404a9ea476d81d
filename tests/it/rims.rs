//! Landmarks on the rims of holes: which hole is which, how they are turned, and what contradicts.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use inbetween::input::{SvgOptions, read_svg};
use inbetween::math::Point;
use inbetween::outline::ArcLength;
use inbetween::pipeline::{
    Build, CharacterSpec, HandleMove, LandmarkPlace, LandmarkSpec, LayerSpec, MappingReport, PipelineError, PoseSpec,
    map_layer,
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
    polygon(MIDDLE.into(), 3, |angle| {
        80.0 + 8.0 * (3.0 * angle).sin() + 7.0 * angle.cos()
    })
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
    PoseSpec::drawn(
        name,
        read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing"),
    )
}

fn layer(poses: &[String], landmarks: &[(&str, &[Option<Point>])]) -> LayerSpec {
    let names = ["a", "b", "c"];
    let poses = names.iter().zip(poses).map(|(name, text)| drawn(name, text));
    let mut layer = LayerSpec::new("plate", poses.collect());
    layer
        .landmarks
        .extend(landmarks.iter().map(|(name, at)| LandmarkSpec::new(*name, at.to_vec())));
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

/// By how many degrees vertices of a ring that `counts` takes by its places are turned from pose 0 to pose 1 about the middle of the plate: the
/// least and the most.
fn turns(mapping: &Mapping, ring: usize, counts: impl Fn([Point; 2]) -> bool) -> (f64, f64) {
    let places = |vertex: usize| [0, 1].map(|pose| mapping.poses.positions()[pose][vertex] - Point::from(MIDDLE));
    let turn = |[from, to]: [Point; 2]| {
        let turn = (to.y.atan2(to.x) - from.y.atan2(from.x)).rem_euclid(TAU);
        (if turn > 0.5 * TAU { turn - TAU } else { turn }).to_degrees()
    };
    let counted = mapping.rings[ring]
        .iter()
        .map(|&v| places(v))
        .filter(|places| counts(*places));
    counted
        .map(turn)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), turn| {
            (least.min(turn), most.max(turn))
        })
}

/// The vertex of the drawn rim of a round hole at an angle: as the drawing has it, whose numbers are those of single precision.
fn on_rim(text: &str, hole: usize, degrees: f64) -> Point {
    let outline = read_svg(text.as_bytes(), &SvgOptions::default())
        .expect("a drawing")
        .outline;
    let rim = &outline.holes()[hole];
    let middle = rim.points().iter().sum::<Point>() / rim.len() as f64;
    let radius = (rim.point(0) - middle).norm();
    let wanted = middle + radius * direction(degrees);
    let away = |p: &&Point| (*p - wanted).norm();
    let nearest = rim.points().iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    *nearest.expect("a vertex")
}

/// The number of the hole around a place.
fn hole_at(text: &str, x: f64) -> usize {
    let outline = read_svg(text.as_bytes(), &SvgOptions::default())
        .expect("a drawing")
        .outline;
    let is_around = |hole: &inbetween::outline::Ring| hole.contains(Point::new(x, 100.0));
    outline.holes().iter().position(is_around).expect("a hole")
}

fn at(x: f64, y: f64) -> Option<Point> {
    Some(Point::new(x, y))
}

#[test]
fn landmarks_turn_the_rim_of_a_hole_against_the_outline() {
    let workshop = Workshop::new();
    let drawing = ring();
    workshop.file("a.svg", drawing.as_bytes());
    workshop.file("b.svg", drawing.as_bytes());
    let mut text = "[[pose]]\nname = \"a\"\nsource = \"a.svg\"\nat = [0, 0]\n\
                    [[pose]]\nname = \"b\"\nsource = \"b.svg\"\nat = [1, 0]\n"
        .to_owned();
    let degrees = [10.0, 100.0, 190.0, 280.0];
    let marked = degrees.map(|angle| [on_rim(&drawing, 0, angle), on_rim(&drawing, 0, angle + 40.0)]);
    for (k, [a, b]) in marked.iter().enumerate() {
        let _ = write!(
            text,
            "[[landmark]]\nname = \"rim{k}\"\nat = {{ a = [{:?}, {:?}], b = [{:?}, {:?}] }}\n",
            a.x, a.y, b.x, b.y
        );
    }
    workshop.scene(&text);
    workshop.succeeds(&["map", "scene.toml", "-o", "mapping.json"]);
    workshop.succeeds(&["check", "mapping.json"]);
    let written = std::fs::read_to_string(workshop.path("mapping.json")).expect("a mapping");
    let mapping = Mapping::from_json(&written).expect("a mapping");
    for places in &marked {
        assert!(vertex_at(&mapping, 1, places).is_some(), "{places:?}");
    }
    // All of the rim goes with them, and the outline hardly.
    let is_on_rim = |places: [Point; 2]| places.iter().all(|place| place.norm() > 34.9);
    let (least, most) = turns(&mapping, 1, is_on_rim);
    assert!(least > 35.0 && most < 45.0, "{least} {most}");
    let (least, most) = turns(&mapping, 0, |_| true);
    assert!(least > -6.0 && most < 6.0, "{least} {most}");

    let scene = Scene::open(&workshop.path("scene.toml")).expect("a scene");
    let (_, report) = mapped(&scene.layer_spec(0).expect("drawings"));
    for (landmark, [_, place]) in report.landmarks.iter().zip(&marked) {
        assert_eq!(landmark.kind, LandmarkKind::OnRim);
        assert_eq!(landmark.given, [true, true]);
        assert!((landmark.at[1][0] - place).norm() < 1e-9);
    }
    workshop.succeeds(&["show", "scene.toml", "-o", "show.png"]);
}

#[test]
fn landmarks_say_which_hole_is_which() {
    let [first, second] = [two_holes(14.0, 9.0), two_holes(13.0, 10.0)];
    let left = [&first, &second].map(|text| on_rim(text, hole_at(text, 70.0), 0.0));
    let right = [&first, &second].map(|text| on_rim(text, hole_at(text, 135.0), 180.0));
    let around = |mapping: &Mapping, ring: usize, pose: usize| {
        let places = mapping.rings[ring].iter().map(|&v| mapping.poses.positions()[pose][v]);
        places.sum::<Point>().x / mapping.rings[ring].len() as f64
    };
    let sides = |mapping: &Mapping| {
        let rings = 1..mapping.rings.len();
        let mut sides: Vec<[bool; 3]> = rings
            .map(|ring| [0, 1, 2].map(|pose| around(mapping, ring, pose) > 100.0))
            .collect();
        sides.sort_unstable();
        sides
    };
    let poses = [first.clone(), second, first];
    let (plain, _) = mapped(&layer(&poses, &[]));
    assert_eq!(sides(&plain), [[false; 3], [true; 3]]);
    // The last pose has no place of it: its holes stay where they are.
    let eye = [Some(left[0]), Some(right[1]), None];
    let mouth = [Some(right[0]), Some(left[1]), None];
    let (swapped, report) = mapped(&layer(&poses, &[("eye", &eye), ("mouth", &mouth)]));
    assert_eq!(sides(&swapped), [[false, true, false], [true, false, true]]);
    let placed = report.landmarks[0].at[2][0];
    let ring = (1..3).find(|&ring| vertex_at(&swapped, ring, &[left[0], right[1], placed]).is_some());
    assert!(ring.is_some_and(|ring| around(&swapped, ring, 0) < 100.0));
    assert_eq!(report.landmarks[0].given, [true, true, false]);
}

#[test]
fn a_hole_that_looks_like_none_of_the_others_is_one_of_them_if_a_landmark_says_so() {
    let one = |x: f64, radius: f64| svg(&[plate(), polygon(Point::new(x, 100.0), 15, |_| radius)]);
    let poses = [one(65.0, 14.0), one(140.0, 13.0)];
    let build = |landmarks: &[(&str, &[Option<Point>])]| {
        let places = vec![vec![0.0, 0.0], vec![1.0, 0.0]];
        CharacterSpec::new(vec![layer(&poses, landmarks)]).with_places(places)
    };
    let rings = |build: &Build| build.layers()[0].mapping().rings.len();
    let places = [Some(on_rim(&poses[0], 0, 90.0)), Some(on_rim(&poses[1], 0, 90.0))];
    let (plain, tied) = (build(&[]), build(&[("eye", &places)]));
    // Without it they close and open, and are covered. Edits come to the same as a new build.
    let first = Build::new(&plain).expect("a build");
    let second = first.update(&tied).expect("a build");
    let third = second.update(&plain).expect("a build");
    assert_eq!([&first, &second, &third].map(rings), [1, 2, 1]);
    for (edited, spec) in [(&second, &tied), (&third, &plain)] {
        let anew = Build::new(spec).expect("a build");
        assert!(edited.layers()[0].mapping() == anew.layers()[0].mapping());
    }
    let [a, b] = places.map(Option::unwrap_or_default);
    assert!(vertex_at(second.layers()[0].mapping(), 1, &[a, b]).is_some());
    // On the rim of a hole that is covered it is a point inside.
    let lone = [places[0], at(140.0, 60.0)];
    let (_, report) = mapped(&layer(&poses, &[("eye", &lone)]));
    assert_eq!(report.landmarks[0].kind, LandmarkKind::Inside);
}

#[test]
fn what_contradicts_is_named() {
    let (drawing, round) = (two_holes(14.0, 9.0), ring());
    let rim = |x: f64, degrees: f64| Some(on_rim(&drawing, hole_at(&drawing, x), degrees));
    let two = [drawing.clone(), drawing.clone()];
    let refusal = |poses: &[String], landmarks: &[(&str, &[Option<Point>])]| {
        map_layer(&layer(poses, landmarks)).expect_err("no mapping")
    };
    // One hole in a pose, two in the other.
    let landmarks: [(&str, &[Option<Point>]); 2] = [
        ("brow", &[rim(70.0, 0.0), rim(70.0, 0.0)]),
        ("lid", &[rim(70.0, 90.0), rim(135.0, 90.0)]),
    ];
    let error = refusal(&two, &landmarks);
    assert!(
        matches!(&error, PipelineError::LandmarkHoles { first, second, pose, other: Some(other) }
            if (first.as_str(), second.as_str(), pose.as_str(), other.as_str()) == ("brow", "lid", "b", "a")),
        "{error}"
    );
    // On a rim here, on the outline or inside there.
    let outer = at(20.0, 100.0);
    for (place, kind) in [
        (outer, LandmarkPlace::Outline),
        (at(100.0, 150.0), LandmarkPlace::Inside),
    ] {
        let error = refusal(&two, &[("lid", &[rim(70.0, 90.0), place])]);
        assert!(
            matches!(&error, PipelineError::LandmarkPlaces { landmark, pose, place, other, other_place, .. }
                if (landmark.as_str(), pose.as_str(), *place) == ("lid", "b", kind)
                    && (other.as_str(), *other_place) == ("a", LandmarkPlace::Rim)),
            "{error}"
        );
    }
    // In the middle of a hole it is nowhere.
    let error = refusal(
        &[round.clone(), round.clone()],
        &[("lid", &[Some(MIDDLE.into()), Some(MIDDLE.into())])],
    );
    assert!(matches!(error, PipelineError::LandmarkOffOutline { .. }), "{error}");
    // Around a rim in another order.
    let order = |degrees: [f64; 2]| degrees.map(|angle| Some(on_rim(&round, 0, angle)));
    let (first, second, third) = (order([0.0, 0.0]), order([120.0, 240.0]), order([240.0, 120.0]));
    let landmarks: [(&str, &[Option<Point>]); 3] = [("one", &first), ("two", &second), ("three", &third)];
    let error = refusal(&[round.clone(), round], &landmarks);
    assert!(matches!(error, PipelineError::LandmarkOrder { .. }), "{error}");
}

#[test]
fn the_command_names_pose_landmark_and_line() {
    let workshop = Workshop::new();
    let drawing = ring();
    workshop.file("a.svg", drawing.as_bytes());
    let place = on_rim(&drawing, 0, 45.0);
    workshop.scene(&format!(
        "[[pose]]\nname = \"a\"\nsource = \"a.svg\"\n[[pose]]\nname = \"b\"\nsource = \"a.svg\"\n\
         [[landmark]]\nname = \"lid\"\nat = {{ a = [{}, {}], b = [187, 100] }}\n",
        place.x, place.y
    ));
    let message = workshop.fails(&["map", "scene.toml", "-o", "mapping.json"], 1);
    for part in [
        "scene.toml:9",
        "'lid'",
        "pose 'b'",
        "on the outer outline",
        "on the rim of a hole",
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_deformed_copy_carries_what_is_on_a_rim() {
    let drawing = ring();
    let poses = [drawing.clone(), drawing.clone()];
    let place = on_rim(&drawing, 0, 0.0);
    let mut spec = layer(&poses, &[("lid", &[Some(place); 2])]);
    let moved = |from: [f64; 2], to: [f64; 2]| HandleMove {
        from: from.into(),
        to: to.into(),
    };
    let handles = vec![
        moved([40.0, 100.0], [40.0, 100.0]),
        moved([160.0, 100.0], [170.0, 100.0]),
    ];
    spec.poses.push(PoseSpec::deformed("wide", 0, handles));
    spec.landmarks[0].at.push(None);
    let (mapping, report) = mapped(&spec);
    let landmark = &report.landmarks[0];
    assert_eq!(
        (landmark.kind, landmark.given.as_slice()),
        (LandmarkKind::OnRim, &[true, true, false][..])
    );
    let carried = landmark.at[2][0];
    assert!(vertex_at(&mapping, 1, &[place, place, carried]).is_some());
    assert!(carried.x > place.x + 1.0);
    let on_rim = ArcLength::new(&mapping.outlines[2].holes()[0]).nearest(carried).1;
    assert!(on_rim < 1e-6, "{on_rim}");
}

/// A gear around a point: how many teeth, how deep, at which angle the first.
#[derive(Debug, Clone, Copy)]
struct Gear {
    radius: f64,
    teeth: u32,
    depth: f64,
    phase: f64,
}

impl Gear {
    fn polygon(&self, middle: Point, step: usize) -> Vec<Point> {
        polygon(middle, step, |angle| {
            self.radius * (1.0 + self.depth * (f64::from(self.teeth) * angle + self.phase).sin())
        })
    }
}

fn gear(radius: std::ops::Range<f64>, depth: f64) -> impl Strategy<Value = Gear> {
    (radius, 2_u32..9, 0.0..depth, 0.0..TAU).prop_map(|(radius, teeth, depth, phase)| Gear {
        radius,
        teeth,
        depth,
        phase,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn landmarks_on_rims_of_gears_are_met_exactly(
        outer in prop::collection::vec(gear(80.0..90.0, 0.1), 2..4),
        holes in prop::collection::vec((gear(10.0..18.0, 0.2), gear(10.0..18.0, 0.2)), 3),
        marks in prop::collection::vec((0_usize..2, prop::collection::vec(0.0..360.0f64, 3), 0_u8..8), 1..3),
    ) {
        let poses: Vec<String> = outer.iter().zip(&holes).map(|(outer, (left, right))| {
            let middle = |x: f64| Point::new(x, 100.0);
            svg(&[outer.polygon(middle(100.0), 3), left.polygon(middle(65.0), 10), right.polygon(middle(135.0), 10)])
        }).collect();
        let count = poses.len();
        // One landmark a hole at most, so that they come in order; a pose but the first may lack it.
        let mut landmarks: Vec<(String, Vec<Option<Point>>)> = Vec::new();
        for (side, degrees, lacking) in &marks {
            if landmarks.iter().any(|(name, _)| *name == side.to_string()) {
                continue;
            }
            let x = [65.0, 135.0][*side];
            let place = |pose: usize| {
                let text = &poses[pose];
                let hole = hole_at(text, x);
                let outline = read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing").outline;
                let is_given = pose == 0 || lacking & (1 << pose) == 0;
                is_given.then(|| {
                    let rim = &outline.holes()[hole];
                    ArcLength::new(rim).at(degrees[pose] / 360.0)
                })
            };
            landmarks.push((side.to_string(), (0..count).map(place).collect()));
        }
        let borrowed: Vec<(&str, &[Option<Point>])> =
            landmarks.iter().map(|(name, at)| (name.as_str(), at.as_slice())).collect();
        let (mapping, report) = mapped(&layer(&poses, &borrowed));
        prop_assert_eq!(mapping.rings.len(), 3);
        for (landmark, (name, at)) in report.landmarks.iter().zip(&landmarks) {
            prop_assert_eq!((&landmark.name, landmark.kind), (name, LandmarkKind::OnRim));
            let places: Vec<Point> = (0..count).map(|pose| landmark.at[pose][0]).collect();
            // As given, but for the nearest vertex of the drawing within a fraction of a pixel.
            for (given, place) in at.iter().zip(&places) {
                prop_assert!(given.is_none_or(|given| (given - place).norm() < 0.1));
            }
            let is_met = [1, 2].iter().any(|ring| vertex_at(&mapping, *ring, &places).is_some());
            prop_assert!(is_met, "{name}: {places:?}");
        }
    }
}
