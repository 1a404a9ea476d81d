//! Lines and points inside the drawings, through the real command.

use crate::workshop::Workshop;
use serde_json::Value;

/// Lines in the tall and the wide box of [`Workshop::two_poses`].
const BROW: &str = "[[landmark]]\nname = \"brow\"\npath = true\n\
    at = { tall = [[15, 10], [20, 12], [25, 10]], wide = [[10, 17], [20, 15], [30, 17]] }\n";

fn map(workshop: &Workshop, more: &str) -> (Value, String) {
    workshop.two_poses("[0, 0]", "[1, 0]", more);
    let output = workshop.run(&["map", "scene.toml", "-o", "mapping.json"]);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    workshop.succeeds(&["check", "mapping.json"]);
    let text = std::fs::read_to_string(workshop.path("mapping.json")).expect("written");
    (serde_json::from_str(&text).expect("JSON"), notes)
}

/// The vertex of a pose that lies exactly at a place.
fn vertex_at(mapping: &Value, pose: usize, place: [f64; 2]) -> usize {
    let vertices = mapping["poses"][pose]["vertices"].as_array().expect("vertices");
    let is_there = |v: &Value| {
        let coordinate = |k: usize| v[k].as_f64().expect("a number");
        (coordinate(0) - place[0]).hypot(coordinate(1) - place[1]) < 1e-9
    };
    vertices
        .iter()
        .position(is_there)
        .unwrap_or_else(|| panic!("no vertex at {place:?}"))
}

#[test]
fn a_line_is_met_point_by_point_in_every_pose() {
    let workshop = Workshop::new();
    let (mapping, _) = map(&workshop, BROW);
    for (tall, wide) in [
        ([15.0, 10.0], [10.0, 17.0]),
        ([20.0, 12.0], [20.0, 15.0]),
        ([25.0, 10.0], [30.0, 17.0]),
    ] {
        assert_eq!(vertex_at(&mapping, 0, tall), vertex_at(&mapping, 1, wide));
    }
}

#[test]
fn a_line_from_the_outline_guides_the_matching() {
    let workshop = Workshop::new();
    let line = "[[landmark]]\nname = \"gill\"\npath = true\n\
        at = { tall = [[12, 20], [20, 20]], wide = [[20, 12], [20, 20]] }\n";
    let (mapping, _) = map(&workshop, line);
    assert_eq!(
        vertex_at(&mapping, 0, [20.0, 20.0]),
        vertex_at(&mapping, 1, [20.0, 20.0])
    );
    // The left side's middle corresponds to the top's: the mesh turned by a quarter.
    let ring = mapping["rings"][0].as_array().expect("a ring");
    let places = |pose: usize| -> Vec<[f64; 2]> {
        let place = |v: &Value| &mapping["poses"][pose]["vertices"][v.as_u64().expect("an index") as usize];
        let number = |v: &Value| v.as_f64().expect("a number");
        ring.iter()
            .map(|v| [number(&place(v)[0]), number(&place(v)[1])])
            .collect()
    };
    let nearest = |pose: usize, at: [f64; 2]| {
        let distance = |p: &[f64; 2]| (p[0] - at[0]).hypot(p[1] - at[1]);
        let places = places(pose);
        (0..places.len())
            .min_by(|a, b| distance(&places[*a]).total_cmp(&distance(&places[*b])))
            .expect("a ring")
    };
    assert_eq!(nearest(0, [12.0, 20.0]), nearest(1, [20.0, 12.0]));
}

#[test]
fn a_point_inside_that_a_pose_lacks_is_put_there_and_reported() {
    let workshop = Workshop::new();
    let (mapping, notes) = map(&workshop, "[[landmark]]\nname = \"eye\"\nat = { tall = [20, 20] }\n");
    assert!(
        notes.contains("'eye'") && notes.contains("'wide'") && notes.contains("was put at"),
        "{notes}"
    );
    let vertex = vertex_at(&mapping, 0, [20.0, 20.0]);
    let place = &mapping["poses"][1]["vertices"][vertex];
    let (x, y) = (place[0].as_f64().expect("x"), place[1].as_f64().expect("y"));
    assert!(
        (x - 20.0).abs() < 3.0 && (y - 20.0).abs() < 3.0,
        "the middle stays in the middle: {x} {y}"
    );
}

/// The line bulges far down in the wide box, past the place that a point just below it would have there.
#[test]
fn a_point_that_a_pose_lacks_stays_on_its_side_of_a_dividing_line() {
    let line = "[[landmark]]\nname = \"belt\"\npath = true\n\
        at = { tall = [[12, 20], [20, 20], [28, 20]], wide = [[4, 20], [20, 26], [36, 20]] }\n";
    for (name, y, is_below) in [("navel", 22, true), ("heart", 18, false)] {
        let workshop = Workshop::new();
        let point = format!("[[landmark]]\nname = \"{name}\"\nat = {{ tall = [20, {y}] }}\n");
        let (mapping, notes) = map(&workshop, &format!("{line}{point}"));
        assert!(notes.contains(name) && notes.contains("was put at"), "{notes}");
        let vertex = vertex_at(&mapping, 0, [20.0, f64::from(y)]);
        let place = &mapping["poses"][1]["vertices"][vertex];
        let (x, y) = (place[0].as_f64().expect("x"), place[1].as_f64().expect("y"));
        let line_y = 26.0 - (x - 20.0).abs() * 6.0 / 16.0;
        assert_eq!(y > line_y, is_below, "{name} at {x} {y}");
    }
}

#[test]
fn a_line_back_to_where_it_began_is_refused_by_name_and_pose() {
    let workshop = Workshop::new();
    let line = "[[landmark]]\nname = \"loop\"\npath = true\n\
        at = { tall = [[12, 20], [20, 16], [20, 24], [12, 20]], wide = [[4, 20], [20, 16], [20, 24], [4, 20]] }\n";
    workshop.two_poses("[0, 0]", "[1, 0]", line);
    let message = workshop.fails(&["map", "scene.toml", "-o", "mapping.json"], 1);
    for word in ["'loop'", "scene.toml:11", "'tall'", "same place"] {
        assert!(message.contains(word), "'{word}' is not in: {message}");
    }
}

#[test]
fn lines_that_cannot_be_are_refused_with_their_names_and_lines() {
    let line = |name: &str, tall: &str| {
        format!(
            "[[landmark]]\nname = \"{name}\"\npath = true\n\
             at = {{ tall = {tall}, wide = [[10, 17], [20, 15], [30, 17]] }}\n"
        )
    };
    for (more, words) in [
        (
            line("knot", "[[15, 10], [25, 10], [25, 15], [18, 8]]"),
            ["'knot'", "scene.toml:11", "'tall'", "crosses itself"],
        ),
        (
            line("arm", "[[15, 10], [38, 10], [25, 15]]"),
            ["'arm'", "scene.toml:11", "'tall'", "leaves it"],
        ),
        (
            format!(
                "{BROW}{}",
                line("cross", "[[20, 8], [20, 30]]")
                    .replace("15]", "25]")
                    .replace("17]", "27]")
            ),
            ["'cross'", "'brow'", "'tall'", "apart"],
        ),
    ] {
        let workshop = Workshop::new();
        workshop.two_poses("[0, 0]", "[1, 0]", &more);
        let message = workshop.fails(&["map", "scene.toml", "-o", "mapping.json"], 1);
        for word in words {
            assert!(message.contains(word), "'{word}' is not in: {message}");
        }
        assert!(!workshop.path("mapping.json").exists());
    }
}
