//! Correspondence by what is drawn, through the public interface: drawings in memory, no landmarks.

use std::sync::Arc;

use inbetween::appearance::Appearance;
use inbetween::input::{Drawing, SvgOptions, read_svg};
use inbetween::math::Point;
use inbetween::pipeline::{CharacterSpec, Facing, LayerSpec, NoteKind, PoseShape, PoseSpec, map_layer};
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
    let (registration, _) = register(&appearances, 0, &beginnings, &pins, None).expect("a registration");
    let spot = registration.carried(1, Point::new(170.0, 190.0)).expect("known");
    assert!((spot - Point::new(178.0, 183.0)).norm() < 1.5, "{spot}");
    let corner = registration.carried(1, Point::new(330.0, 300.0)).expect("known");
    assert!((corner - Point::new(330.0, 300.0)).norm() < 4.0, "{corner}");
    // What the artist says wins.
    let pins = vec![
        vec![],
        vec![Pin::certain(Point::new(260.0, 200.0), Point::new(266.0, 200.0))],
    ];
    let (registration, _) = register(&appearances, 0, &beginnings, &pins, None).expect("a registration");
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
    let squashed = |from: [f64; 2], to: [f64; 2]| {
        let found = carried(&mapping, Point::from(from));
        assert!((found - Point::from(to)).norm() < 3.0, "{from:?}: {found}, not {to:?}");
    };
    // Just inside the outline at the top, the bottom and the sides, and an eye.
    squashed([200.0, 200.0 - 114.0], [200.0, 230.0 - 85.5]);
    squashed([200.0, 200.0 + 114.0], [200.0, 230.0 + 85.5]);
    squashed([200.0 - 85.5, 200.0], [200.0 - 114.0, 230.0]);
    squashed([200.0 + 85.5, 200.0], [200.0 + 114.0, 230.0]);
    squashed([200.0 - 27.0, 176.0], [200.0 - 36.0, 212.0]);
}

/// A figure with an arm raised by `raised_deg`, whose body, head, eyes and lines have these colours.
fn figure(raised_deg: f64, [body, head, eyes, line]: [&str; 4]) -> Drawing {
    drawing(&format!(
        r##"<g stroke="{line}" stroke-width="5" stroke-linejoin="round"><rect x="255" y="180" width="90" height="34" rx="17" fill="{head}" transform="rotate({} 262 197)"/>
        <rect x="55" y="180" width="90" height="34" rx="17" fill="{head}"/><rect x="140" y="165" width="120" height="150" rx="26" fill="{body}"/>
        <circle cx="200" cy="110" r="62" fill="{head}"/></g><circle cx="178" cy="100" r="9" fill="{eyes}"/><circle cx="222" cy="100" r="9" fill="{eyes}"/>
        <path d="M175 135q25 16 50 0" fill="none" stroke="{eyes}" stroke-width="6"/>"##,
        -raised_deg
    ))
}

const DAY: [&str; 4] = ["#d33", "#fc9", "#124", "#311"];

/// That the figure with a raised arm, drawn with `colours`, corresponds to the one by day.
fn corresponds(colours: [&str; 4]) -> f64 {
    let poses = [figure(0.0, DAY), figure(35.0, colours)]
        .into_iter()
        .zip(["day", "other"]);
    let poses = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
    let (mapping, report) = map_layer(&LayerSpec::new("figure", poses)).expect("a mapping");
    mapping.check().expect("valid");
    let stays = [
        [178.0, 100.0],
        [222.0, 100.0],
        [200.0, 143.0],
        [200.0, 300.0],
        [100.0, 197.0],
    ];
    for place in stays.map(Point::from) {
        let found = carried(&mapping, place);
        assert!((found - place).norm() < 8.0, "{place} to {found}");
    }
    let turn = (-35.0f64).to_radians();
    let hand = Point::new(68.0 * turn.cos(), 68.0 * turn.sin()) + Point::new(262.0, 197.0);
    let found = carried(&mapping, Point::new(330.0, 197.0));
    assert!((found - hand).norm() < 10.0, "the hand is at {found}, not at {hand}");
    report
        .explained
        .iter()
        .flatten()
        .map(|explained| explained.share)
        .fold(1.0, f64::min)
}

#[test]
fn the_same_figure_corresponds_and_is_found() {
    assert!(corresponds(DAY) > 0.8);
}

#[test]
fn a_figure_by_night_corresponds_by_its_shape() {
    assert!(corresponds(["#526", "#479", "#ffc", "#012"]) < 0.8);
}

#[test]
fn a_grey_figure_corresponds_to_one_in_colours() {
    corresponds(["#777", "#ccc", "#222", "#222"]);
}

#[test]
fn a_figure_in_ink_corresponds_to_a_painted_one() {
    corresponds(["#fff", "#fff", "#000", "#000"]);
}

#[test]
fn another_character_is_said_to_be_one() {
    let stranger = drawing(
        r##"<path d="M60 320L120 120L200 60L290 130L340 320Z" fill="#2a5" stroke="#031" stroke-width="5"/><circle cx="200" cy="220" r="50" fill="#ff3"/><path d="M100 290h190" stroke="#fff" stroke-width="14"/>"##,
    );
    let poses = [figure(0.0, DAY), figure(35.0, DAY), stranger]
        .into_iter()
        .zip(["stand", "wave", "tent"]);
    let poses = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
    let mut layer = LayerSpec::new("figure", poses);
    layer.reference = Some(0);
    let (mapping, report) = map_layer(&layer).expect("a mapping");
    mapping.check().expect("valid");
    let strangers: Vec<Option<&str>> = (report.notes.iter())
        .filter(|note| matches!(note.kind, NoteKind::Unlike { .. }))
        .map(|note| note.pose.as_deref())
        .collect();
    assert_eq!(strangers, [Some("tent")], "{:?}", report.notes);
}

/// A figure that looks to one side: where its eye is, and how far its tail reaches to the other.
fn looking(x: f64, tail: f64) -> Drawing {
    drawing(&format!(
        r##"<path d="M140 90h120v210h-120z" fill="#b64"/><path d="M{0} 280l{tail} -60v30z" fill="#642"/><circle cx="{x}" cy="130" r="12" fill="#fff"/>"##,
        if tail > 0.0 { 255.0 } else { 145.0 }
    ))
}

#[test]
fn only_a_figure_whose_reflection_shows_more_looks_reflected() {
    let hinted = |second: Drawing| {
        let poses = [looking(170.0, 70.0), second].into_iter().zip(["first", "second"]);
        let poses = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
        let (_, report) = map_layer(&LayerSpec::new("figure", poses)).expect("a mapping");
        report.notes.iter().any(|note| note.kind == NoteKind::LooksReflected)
    };
    assert!(hinted(looking(230.0, -70.0)));
    assert!(!hinted(looking(180.0, 80.0)));
}

#[test]
fn a_figure_that_faces_the_other_way_is_reflected_if_the_specification_leaves_it_open() {
    let layer = |seconds: [Drawing; 2]| {
        let poses = [looking(170.0, 70.0)]
            .into_iter()
            .chain(seconds)
            .zip(["first", "second", "third"]);
        let mut poses: Vec<PoseSpec> = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
        for pose in &mut poses[1..] {
            if let PoseShape::Drawn(drawn) = &mut pose.shape {
                drawn.facing = Facing::Auto;
            }
        }
        LayerSpec::new("figure", poses)
    };
    let away = layer([looking(230.0, -70.0), looking(180.0, 80.0)]);
    assert!(map_layer(&away).is_err(), "nothing is mapped before it is settled");
    let settled = CharacterSpec::new(vec![away]).with_facings();
    let facings: Vec<Facing> = settled.layers[0].drawn().map(|drawn| drawn.facing).collect();
    assert_eq!(facings, [Facing::AsDrawn, Facing::Mirrored, Facing::AsDrawn]);
    let (mapping, report) = map_layer(&settled.layers[0]).expect("a mapping");
    assert!(mapping.check().is_ok() && !report.notes.iter().any(|note| note.kind == NoteKind::LooksReflected));
}

#[test]
fn a_silhouette_that_faces_the_other_way_is_reflected_by_its_outline() {
    let boot = |facing: f64| {
        let x = |along: f64| 200.0 + facing * along;
        drawing(&format!(
            r##"<path d="M{} 60L{} 60L{} 200L{} 230L{} 300L{} 300z" fill="#333"/>"##,
            x(-60.0),
            x(10.0),
            x(20.0),
            x(120.0),
            x(130.0),
            x(-60.0)
        ))
    };
    let poses = [boot(1.0), boot(-1.0)].into_iter().zip(["first", "second"]);
    let mut poses: Vec<PoseSpec> = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
    if let PoseShape::Drawn(drawn) = &mut poses[1].shape {
        drawn.facing = Facing::Auto;
    }
    let settled = CharacterSpec::new(vec![LayerSpec::new("boot", poses)]).with_facings();
    let facings: Vec<Facing> = settled.layers[0].drawn().map(|drawn| drawn.facing).collect();
    assert_eq!(facings, [Facing::AsDrawn, Facing::Mirrored]);
}
