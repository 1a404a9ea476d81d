//! Deformed copies, from the scene file to the frame, and reaching with landmarks.

use crate::workshop::Workshop;
use inbetween::math::Point;
use inbetween::mesh::PointLocator;
use inbetween::pipeline::map_layer;
use inbetween::pose::{Mapping, Repair};
use inbetween::scene::Scene;

/// The corners correspond, and an eye.
const LANDMARKS: &str = "[[landmark]]\nname = \"ear\"\nat = { tall = [12, 4], wide = [4, 12] }\n\
    [[landmark]]\nname = \"tail\"\nat = { tall = [28, 36], wide = [36, 28] }\n\
    [[landmark]]\nname = \"eye\"\nat = { tall = [20, 10], wide = [12, 18] }\n\
    [animation]\nsize = [48, 36]\n";

/// A copy of `of` named `name`, with its handles.
fn copy(name: &str, of: &str, at: &str, handles: &str) -> String {
    format!("[[pose]]\nname = \"{name}\"\ndeform_of = \"{of}\"\nat = {at}\nhandles = [ {handles} ]\n")
}

/// The tall box, its top bent to the right, its foot kept.
const BENT: &str =
    "{ from = [14, 34], to = [14, 34] }, { from = [26, 34], to = [26, 34] }, { from = [20, 8], to = [29, 11] }";

fn scene_of(workshop: &Workshop) -> Scene {
    Scene::open(&workshop.path("scene.toml")).expect("a scene")
}

fn with_copies(copies: &str) -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", &format!("{copies}{LANDMARKS}"));
    workshop
}

#[test]
fn a_copy_and_its_copy_are_poses_like_any_other() {
    // The copy of the copy stands before it in the file.
    let back =
        "{ from = [14, 34], to = [14, 34] }, { from = [26, 34], to = [26, 34] }, { from = [29, 11], to = [20, 8] }";
    let workshop = with_copies(&(copy("back", "bent", "[0, 2]", back) + &copy("bent", "tall", "[0, 1]", BENT)));
    let scene = scene_of(&workshop);
    let layer = scene.layer_spec(0).expect("drawings");
    assert_eq!(layer.drawn().count(), 2);
    let (mapping, report) = map_layer(&layer).expect("a mapping");
    assert_eq!(mapping.poses.names(), ["tall", "wide", "back", "bent"]);
    mapping.check().expect("valid");
    // Handles are met: the place is carried by its triangle.
    let (tall, bent) = (&mapping.poses.positions()[0], &mapping.poses.positions()[3]);
    let carried = carry(&mapping, tall, bent, Point::new(20.0, 8.0));
    assert!((carried - Point::new(29.0, 11.0)).norm() < 1e-7, "{carried}");
    // Bent back, it is what it was but for what bending does to the shape away from the handles.
    for (p, q) in tall.iter().zip(&mapping.poses.positions()[2]) {
        assert!((p - q).norm() < 1.5, "{p} {q}");
    }
    // Landmarks and the correspondence are carried, nothing is matched.
    let eye = report.landmarks.iter().find(|l| l.name == "eye").expect("an eye");
    assert_eq!(eye.given, [true, true, false, false]);
    assert!((eye.at[3][0] - carry(&mapping, tall, bent, eye.at[0][0])).norm() < 1e-9);
    assert_eq!(report.matching.poses.len(), 4);
    assert_eq!(
        report.deformed.iter().map(|d| (d.pose, d.of)).collect::<Vec<_>>(),
        [(2, 3), (3, 0)]
    );
    assert!(
        report
            .deformed
            .iter()
            .all(|d| d.drag.repair == Repair::NotNeeded && d.drag.energy < 0.05)
    );
    let outlines = [0, 3].map(|pose| inbetween::outline::ArcLength::new(mapping.outlines[pose].outer()));
    for row in mapping.matching.outer.rows() {
        let on_tall = outlines[0].at(row[0]);
        assert!((carry(&mapping, tall, bent, on_tall) - outlines[1].at(row[3])).norm() < 1e-6);
    }
}

fn carry(mapping: &Mapping, from: &[Point], to: &[Point], place: Point) -> Point {
    let triangles = mapping.poses.topology().triangles();
    let found = PointLocator::new(triangles, from).nearest(place).expect("a mesh");
    let corners = triangles[found.triangle].iter().zip(found.barycentric);
    corners.map(|(&v, share)| to[v] * share).sum()
}

#[test]
fn every_verb_knows_copies() {
    let workshop = with_copies(&copy("bent", "tall", "[0, 1]", BENT));
    workshop.succeeds(&["map", "scene.toml", "-o", "m.json", "--report"]);
    assert!(workshop.succeeds(&["check", "m.json"]).contains("valid: 3 poses"));
    let weights = workshop.succeeds(&["weights", "scene.toml", "--at", "0,1"]);
    let weights: serde_json::Value = serde_json::from_str(&weights).expect("JSON");
    assert!((weights["weights"][2].as_f64().expect("a number") - 1.0).abs() < 1e-9);
    workshop.succeeds(&["show", "scene.toml", "-o", "show.png"]);
    workshop.succeeds(&["render", "scene.toml", "-o", "all.gif", "--fps", "2", "--quiet"]);
    // The copy shows the picture of the pose that it copies, and no other.
    workshop.succeeds(&["frame", "scene.toml", "--at", "0,1", "-o", "bent.png"]);
    let frame = image::open(workshop.path("bent.png")).expect("a picture").to_rgba8();
    let opaque: Vec<_> = frame.pixels().filter(|p| p.0[3] == 255).collect();
    assert!(
        opaque.len() > 200 && opaque.iter().all(|p| p.0[0] > 200 && p.0[2] < 40),
        "red"
    );
}

#[test]
fn handles_of_a_reflected_drawing_are_reflected_with_it() {
    let workshop = with_copies(&copy("moved", "tall", "[0, 1]", "{ from = [14, 20], to = [19, 17] }"));
    let text = std::fs::read_to_string(workshop.path("scene.toml")).expect("text");
    let mirrored = text.replace("source = \"tall.png\"\n", "source = \"tall.png\"\nmirror = true\n");
    for (text, x) in [(text, 5.0), (mirrored, -5.0)] {
        // Landmarks say which way round a drawing is: here they would contradict one another.
        let start = text.find("[[landmark]]").expect("landmarks");
        workshop.file("scene.toml", &text.as_bytes()[..start]);
        let scene = scene_of(&workshop);
        let layer = scene.layer_spec(0).expect("drawings");
        let (mapping, _) = map_layer(&layer).expect("a mapping");
        for (p, q) in mapping.poses.positions()[0].iter().zip(&mapping.poses.positions()[2]) {
            assert!((p + Point::new(x, -3.0) - q).norm() < 1e-9, "{x}: {p} {q}");
        }
    }
}

#[test]
fn handles_that_cannot_be_are_refused_by_name() {
    for (handles, words) in [
        ("{ from = [3, 20], to = [4, 20] }", "handle 0 at (3.0, 20.0) lies"),
        (
            "{ from = [14, 20], to = [14, 20] }, { from = [14, 20], to = [15, 20] }",
            "handles 0 and 1 hold the same point",
        ),
        (
            "{ from = [14, 8], to = [20, 20] }, { from = [14, 30], to = [20, 20] }",
            "handles 0 and 1 are dragged to the same place",
        ),
    ] {
        let workshop = with_copies(&copy("bent", "tall", "[0, 1]", handles));
        let message = workshop.fails(&["map", "scene.toml", "-o", "m.json"], 1);
        for word in ["scene.toml:14", "'bent'", "copy of 'tall'", words] {
            assert!(message.contains(word), "'{word}' is not in: {message}");
        }
        assert!(!workshop.path("m.json").exists());
    }
}

#[test]
fn a_landmark_reaches_what_a_place_shows() {
    let workshop = with_copies(&copy("bent", "tall", "[0, 1]", BENT));
    let scene = scene_of(&workshop);
    let character = scene.character([48, 36], 1).expect("a character");
    character.layers()[0].mapping().check().expect("valid");
    // Where the eye is on the copy.
    let layer = scene.layer_spec(0).expect("drawings");
    let (_, report) = map_layer(&layer).expect("a mapping");
    let eye = report.landmarks.iter().find(|l| l.name == "eye").expect("an eye").at[2][0];
    let handle = format!("eye={},{}", eye.x, eye.y);
    let text = workshop.succeeds(&["reach", "scene.toml", "--handle", &handle, "-o", "-"]);
    let found: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert!(found["error"].as_f64().expect("a number") < 1e-4, "{text}");
    assert!(
        (found["handles"]["eye"][0].as_f64().expect("a number") - eye.x).abs() < 1e-4,
        "{text}"
    );
    let at: Vec<f64> = (0..2).map(|k| found["at"][k].as_f64().expect("a number")).collect();
    assert!(
        at[0].hypot(at[1] - 1.0) < 1e-3,
        "the copy's own place is the nearest to a pose: {text}"
    );
    let sum: f64 = (0..3).map(|k| found["weights"][k].as_f64().expect("a number")).sum();
    assert!((sum - 1.0).abs() < 1e-9);
    let message = workshop.fails(&["reach", "scene.toml", "--handle", "paw=1,2"], 1);
    assert!(message.contains("'paw'") && message.contains("'eye'"), "{message}");
    workshop.fails(&["reach", "scene.toml", "--handle", "eye=1"], 2);
    workshop.fails(
        &["reach", "scene.toml", "--handle", "eye=1,2", "--handle", "eye=3,4"],
        2,
    );
}
