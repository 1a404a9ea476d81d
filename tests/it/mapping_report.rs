//! What a mapping tells about itself, through the library and through the command.

use crate::workshop::Workshop;
use inbetween::pipeline::{MappingReport, Stage, map_layer, map_layer_observed};
use inbetween::pose::{LandmarkKind, Mapping, MeshQuality};
use inbetween::scene::Scene;

/// The upper left corners correspond, so that the boxes are not turned into one another; an eye inside, which the wide box
/// lacks; a line inside.
const LANDMARKS: &str = "[[landmark]]\nname = \"ear\"\nat = { tall = [12, 4], wide = [4, 12] }\n\
    [[landmark]]\nname = \"tail\"\nat = { tall = [28, 36], wide = [36, 28] }\n\
    [[landmark]]\nname = \"eye\"\nat = { tall = [20, 16] }\n\
    [[landmark]]\nname = \"brow\"\npath = true\n\
    at = { tall = [[16, 9], [20, 11], [24, 9]], wide = [[11, 15], [20, 17], [29, 15]] }\n";

fn two() -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", LANDMARKS);
    workshop
}

fn mapped(workshop: &Workshop) -> (Mapping, MappingReport, Vec<Stage>) {
    let scene = Scene::open(&workshop.path("scene.toml")).expect("a scene");
    let layer = scene.layer_spec(0).expect("drawings");
    let mut stages = Vec::new();
    let observed = map_layer_observed(&layer, &mut |stage| stages.push(stage));
    let (mapping, report) = observed.expect("a mapping");
    let (plain, _) = map_layer(&layer).expect("a mapping");
    assert!(plain == mapping, "watching must change nothing");
    (mapping, report, stages)
}

#[test]
fn every_stage_begins_once_and_reports() {
    let (mapping, report, stages) = mapped(&two());
    let expected = [
        Stage::Matching,
        Stage::Simplification,
        Stage::Triangulation,
        Stage::Refinement,
    ];
    assert_eq!(stages, expected);
    // Two boxes, whose corners are cut off by half a pixel.
    let simplified = &report.simplification;
    assert!((4..=8).contains(&simplified.vertices), "{}", simplified.vertices);
    assert!(simplified.tuples > simplified.vertices);
    for (deviation, excess) in simplified.deviation.iter().zip(&simplified.excess_area) {
        assert!((0.0..0.02).contains(deviation) && (-1e-9..0.02).contains(excess));
    }
    let steiner = &report.triangulation;
    assert_eq!(
        mapping.steiner,
        steiner.bridge + steiner.single + steiner.link + steiner.overlay - steiner.decimated
    );
    let interior_and_boundary = simplified.vertices + 1 + 3 + mapping.steiner;
    let vertices = mapping.poses.topology().vertex_count();
    assert_eq!(vertices, interior_and_boundary + report.refinement.splits);
    assert_eq!(report.quality, MeshQuality::of(&mapping.poses));
    assert!((report.quality.smallest_angle_deg - report.refinement.smallest_angle_deg).abs() < 1e-12);
    // A box twice as high as wide became one twice as wide as high.
    assert!(report.quality.median_stretch > 2.0 && report.quality.median_stretch < 6.0);
}

#[test]
fn landmarks_are_reported_on_every_pose() {
    let (_, report, _) = mapped(&two());
    let found: Vec<(&str, LandmarkKind, &[bool])> = report
        .landmarks
        .iter()
        .map(|l| (l.name.as_str(), l.kind, l.given.as_slice()))
        .collect();
    let expected: [(&str, LandmarkKind, &[bool]); 4] = [
        ("ear", LandmarkKind::OnOutline, &[true, true]),
        ("tail", LandmarkKind::OnOutline, &[true, true]),
        ("eye", LandmarkKind::Inside, &[true, false]),
        ("brow", LandmarkKind::Line, &[true, true]),
    ];
    assert_eq!(found, expected);
    for matched in &report.matching.poses {
        assert_eq!(matched.landmarks, [0, 1]);
    }
    let eye = &report.landmarks[2];
    assert_eq!(eye.at[0].iter().map(|p| [p.x, p.y]).collect::<Vec<_>>(), [[20.0, 16.0]]);
    // Splits may add points to a line, its own stay.
    let brow: Vec<[f64; 2]> = report.landmarks[3].at[1].iter().map(|p| [p.x, p.y]).collect();
    assert_eq!((brow.first(), brow.last()), (Some(&[11.0, 15.0]), Some(&[29.0, 15.0])));
    assert!(brow.contains(&[20.0, 17.0]));
    assert!((report.landmarks[0].at[0][0].x - 12.0).abs() < 1.0);
}

#[test]
fn the_table_names_stages_times_and_poses() {
    let workshop = two();
    let output = workshop.run(&["map", "scene.toml", "-o", "m.json", "--report"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.is_empty());
    let text = String::from_utf8(output.stderr).expect("text");
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    let start = lines
        .iter()
        .position(|l| l.starts_with(&["stage", "ms", "result"]))
        .expect("a table");
    let mut sum = 0.0;
    let stages = [
        "input",
        "matching",
        "simplification",
        "triangulation",
        "refinement",
        "total",
    ];
    for (line, stage) in lines[start + 1..].iter().zip(stages) {
        assert_eq!(line[0], stage);
        let time: f64 = line[1].parse().expect("milliseconds");
        if stage == "total" {
            assert!((time - sum).abs() < 0.5, "{time} is not {sum}");
        }
        sum += time;
    }
    let of_pose = |name: &str| lines.iter().find(|l| l.first() == Some(&name)).expect("a pose");
    // Nothing is drawn in the boxes that could be found.
    assert_eq!(of_pose("tall")[1..], ["-", "-", "ear,", "tail"]);
    assert_eq!(of_pose("wide")[2..], ["-", "ear,", "tail"]);
    // The same mapping as without it; quiet is quiet.
    workshop.succeeds(&["map", "scene.toml", "-o", "plain.json"]);
    let bytes = |name: &str| std::fs::read(workshop.path(name)).expect("written");
    assert_eq!(bytes("m.json"), bytes("plain.json"));
    let quiet = workshop.run(&["map", "scene.toml", "-o", "m.json", "--report", "--quiet"]);
    assert!(quiet.stderr.is_empty());
    let line = workshop.succeeds(&["check", "m.json"]);
    assert!(line.contains("5th percentile") && line.lines().count() == 1, "{line}");
}

#[test]
fn show_says_where_a_landmark_would_help() {
    let workshop = Workshop::new();
    let within = |v: u32, low: u32, high: u32| (low..high).contains(&v);
    // A plain box, and one with a comb of teeth on its upper side.
    workshop.picture("plain.png", |x, y| {
        if within(x, 4, 36) && within(y, 14, 36) {
            [9, 9, 9, 255]
        } else {
            [0; 4]
        }
    });
    workshop.picture("comb.png", |x, y| {
        let tooth = within(y, 2, 14) && (x / 4) % 2 == 0;
        if within(x, 4, 36) && (within(y, 14, 36) || tooth) {
            [9, 9, 9, 255]
        } else {
            [0; 4]
        }
    });
    // The ends of that side are landmarks, so that the teeth must lie along it.
    workshop.scene(
        "[[pose]]\nname = \"plain\"\nsource = \"plain.png\"\n[[pose]]\nname = \"comb\"\nsource = \"comb.png\"\n\
         [[landmark]]\nname = \"left\"\nat = { plain = [4, 14], comb = [4, 14] }\n\
         [[landmark]]\nname = \"right\"\nat = { plain = [36, 14], comb = [36, 14] }\n",
    );
    let output = workshop.run(&["show", "scene.toml", "-o", "picture.png"]);
    let text = String::from_utf8(output.stderr).expect("text");
    assert!(
        text.contains("pose 'comb': between links ") && text.contains("a landmark there would help"),
        "{text}"
    );
    // Equal drawings need none.
    workshop.scene(
        "[[pose]]\nname = \"plain\"\nsource = \"plain.png\"\n[[pose]]\nname = \"same\"\nsource = \"plain.png\"\n",
    );
    let output = workshop.run(&["show", "scene.toml", "-o", "picture.png"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(!String::from_utf8(output.stderr).expect("text").contains("landmark"));
}
