//! The command does what its help says.

use crate::workshop::Workshop;

fn two() -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses(
        "[0, 0]",
        "[1, 0]",
        "[animation]\nfps = 6\nsize = [48, 36]\nbackground = \"transparent\"\n",
    );
    workshop
}

#[test]
fn any_frames_on_any_threads_are_the_same_bytes() {
    let workshop = two();
    workshop.succeeds(&["render", "scene.toml", "-o", "whole", "--threads", "3"]);
    workshop.succeeds(&[
        "render",
        "scene.toml",
        "-o",
        "part",
        "--frames",
        "11,2-3",
        "--threads",
        "1",
    ]);
    let mut names: Vec<_> = std::fs::read_dir(workshop.path("part"))
        .expect("a folder")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let stem = names[0].split('.').next().expect("a name").to_owned();
    let expected: Vec<String> = [2, 3, 11].iter().map(|k| format!("{stem}.{k:04}.png")).collect();
    assert_eq!(names, expected);
    for name in &names {
        assert_eq!(
            workshop.bytes(&format!("part/{name}")),
            workshop.bytes(&format!("whole/{name}"))
        );
    }
    assert_eq!(std::fs::read_dir(workshop.path("whole")).expect("a folder").count(), 12);
}

#[test]
fn animations_are_the_same_for_any_threads() {
    let workshop = two();
    for kind in ["gif", "apng", "webp"] {
        let [one, many] = ["1", "4"].map(|threads| {
            let name = format!("{threads}.{kind}");
            workshop.succeeds(&["render", "scene.toml", "-o", &name, "--threads", threads]);
            workshop.bytes(&name)
        });
        assert!(one == many, "{kind}");
        assert!(!one.is_empty());
    }
    // A kind that the name does not say.
    workshop.succeeds(&["render", "scene.toml", "-o", "other", "--format", "gif"]);
    assert!(workshop.bytes("other") == workshop.bytes("1.gif"));
}

#[test]
fn a_pose_is_returned_at_its_place_and_for_its_weight() {
    let workshop = two();
    workshop.succeeds(&["frame", "scene.toml", "--at", "1,0", "-o", "at.png"]);
    workshop.succeeds(&["frame", "scene.toml", "--weights", "0,1", "-o", "weights.png"]);
    let [at, weights] = ["at.png", "weights.png"].map(|n| image::open(workshop.path(n)).expect("a picture").to_rgba8());
    assert_eq!(at.dimensions(), (48, 36));
    let opaque: Vec<_> = weights.enumerate_pixels().filter(|(_, _, p)| p.0[3] == 255).collect();
    assert!(opaque.iter().all(|(_, _, p)| p.0[2] > 200 && p.0[0] < 40), "blue");
    let (left, right) = (opaque.iter().map(|p| p.0).min(), opaque.iter().map(|p| p.0).max());
    let (top, bottom) = (opaque.iter().map(|p| p.1).min(), opaque.iter().map(|p| p.1).max());
    let spread = |low: Option<u32>, high: Option<u32>| high.expect("some") - low.expect("some");
    assert!(spread(left, right) > spread(top, bottom) * 3 / 2, "wide");
    let differing = at
        .pixels()
        .zip(weights.pixels())
        .filter(|(a, b)| (0..4).any(|k| a.0[k].abs_diff(b.0[k]) > 1))
        .count();
    assert_eq!(differing, 0);
}

#[test]
fn one_pose_is_returned_everywhere() {
    let workshop = two();
    workshop.scene("[[pose]]\nname = \"tall\"\nsource = \"tall.png\"\n[animation]\nsize = [40, 40]\n");
    workshop.succeeds(&["frame", "scene.toml", "--at", "0,0", "-o", "a.png"]);
    workshop.succeeds(&["frame", "scene.toml", "--at=-3,17", "-o", "b.png"]);
    workshop.succeeds(&["frame", "scene.toml", "--weights", "1", "-o", "c.png"]);
    assert!(workshop.bytes("a.png") == workshop.bytes("b.png") && workshop.bytes("a.png") == workshop.bytes("c.png"));
    workshop.succeeds(&["map", "scene.toml", "-o", "m.json"]);
    workshop.succeeds(&["check", "m.json"]);
}

#[test]
fn a_mapping_blends_to_its_poses() {
    let workshop = two();
    workshop.succeeds(&["map", "scene.toml", "-o", "m.json"]);
    let line = workshop.succeeds(&["check", "m.json"]);
    assert!(line.contains("valid: 2 poses"), "{line}");
    let mapping: serde_json::Value = serde_json::from_slice(&workshop.bytes("m.json")).expect("JSON");
    assert!(mapping["matching"]["samples"].as_array().expect("rows").len() >= 256);
    for reference in ["canonical", "tall"] {
        let text = workshop.succeeds(&[
            "blend",
            "m.json",
            "--weights",
            "0,1",
            "--reference",
            reference,
            "-o",
            "-",
        ]);
        let frame: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(frame["flipped"], 0);
        let (found, given) = (
            frame["vertices"].as_array().expect("vertices"),
            &mapping["poses"][1]["vertices"],
        );
        for (k, vertex) in found.iter().enumerate() {
            for d in 0..2 {
                let difference = vertex[d].as_f64().expect("a number") - given[k][d].as_f64().expect("a number");
                assert!(difference.abs() < 1e-8, "vertex {k}: {difference}");
            }
        }
    }
}

#[test]
fn a_guarded_frame_has_no_inverted_triangle() {
    // Four widths of the square less three of one four times as wide: less than nothing.
    let workshop = Workshop::new();
    let rectangle = |name: &str, width: f64| {
        let corners = [[0.0, 0.0], [width, 0.0], [width, 10.0], [0.0, 10.0]];
        serde_json::json!({ "name": name, "outline": corners, "holes": [] })
    };
    let polygons = serde_json::json!({ "poses": [rectangle("square", 10.0), rectangle("wide", 40.0)] });
    workshop.file("p.json", polygons.to_string().as_bytes());
    workshop.succeeds(&["triangulate", "p.json", "-o", "m.json"]);
    let flipped = |guard: &str| {
        let arguments = ["blend", "m.json", "--weights=4,-3", "--frame-guard", guard, "-o", "-"];
        let frame: serde_json::Value = serde_json::from_str(&workshop.succeeds(&arguments)).expect("JSON");
        frame["flipped"].as_u64().expect("a count")
    };
    assert_eq!(flipped("off"), 2);
    assert_eq!(flipped("repair"), 0);
}

#[test]
fn weights_need_no_drawing() {
    let workshop = two();
    std::fs::remove_file(workshop.path("tall.png")).expect("removed");
    let text = workshop.succeeds(&["weights", "scene.toml", "--at", "0,0", "--at=0.5,-0.25", "-o", "-"]);
    let lines: Vec<serde_json::Value> = text.lines().map(|l| serde_json::from_str(l).expect("JSON")).collect();
    assert_eq!(lines.len(), 2);
    assert!((lines[0]["weights"][0].as_f64().expect("a number") - 1.0).abs() < 1e-9);
    assert!((lines[1]["texture_weights"][1].as_f64().expect("a number") - 0.5).abs() < 0.01);
    let table = workshop.succeeds(&["weights", "scene.toml", "--grid", "3x2", "--provider", "rbf"]);
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!((rows.len(), rows[0]), (7, "x,y,w0,w1"));
}

#[test]
fn a_new_scene_renders() {
    let workshop = two();
    workshop.succeeds(&["new", "cat", "tall.png", "wide.png"]);
    assert!(workshop.path("cat/tall.png").is_file());
    // Two poses are as far apart as two can be.
    let text = std::fs::read_to_string(workshop.path("cat/scene.toml")).expect("a scene");
    assert!(
        text.contains("at = [-1.0, 0.0]") && text.contains("at = [1.0, 0.0]"),
        "{text}"
    );
    // A scene without places lays itself out in the same way.
    std::fs::write(workshop.path("cat/free.toml"), text.replace("\nat = ", "\n# at = ")).expect("written");
    let weights = |file: &str| workshop.succeeds(&["weights", file, "--at", "0.3,0.2"]);
    assert_eq!(weights("cat/free.toml"), weights("cat/scene.toml"));
    workshop.succeeds(&[
        "render",
        "cat/scene.toml",
        "-o",
        "cat.gif",
        "--size",
        "40x30",
        "--fps",
        "4",
        "--quiet",
    ]);
    workshop.succeeds(&["show", "cat/scene.toml", "-o", "cat.png"]);
    assert!(workshop.path("cat.gif").is_file() && workshop.path("cat.png").is_file());
    let message = workshop.fails(&["new", "cat", "tall.png"], 1);
    assert!(message.contains("scene.toml exists"), "{message}");
    workshop.fails(&["new", "dog", "tall.png", "none.png"], 1);
    assert!(!workshop.path("dog").exists());
    // Drawings in the folder are used where they are.
    std::fs::create_dir(workshop.path("bird")).expect("a folder");
    std::fs::copy(workshop.path("tall.png"), workshop.path("bird/sit.png")).expect("copied");
    workshop.succeeds(&["new", "bird", "bird/sit.png"]);
    assert_eq!(std::fs::read_dir(workshop.path("bird")).expect("a folder").count(), 2);
}

#[test]
fn a_new_scene_says_what_was_taken_and_refuses_what_cannot_be() {
    let workshop = two();
    // A ring has a hole, the others have none; a speck is left out.
    workshop.picture("ring.png", |x, y| {
        let away = (i64::from(x) - 20).abs().max((i64::from(y) - 20).abs());
        [
            0,
            0,
            0,
            if (6..15).contains(&away) || (x, y) == (1, 1) {
                255
            } else {
                0
            },
        ]
    });
    let output = workshop.run(&["new", "cat", "tall.png", "wide.png", "ring.png"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && message.contains("pose 'ring': 1 speck"),
        "{message}"
    );
    assert!(!message.contains("circle"), "{message}");

    workshop.picture("blank.png", |_, _| [0; 4]);
    let message = workshop.fails(&["new", "dog", "tall.png", "blank.png"], 1);
    assert!(
        message.contains("'blank'") && message.contains("no drawing"),
        "{message}"
    );
    assert!(!workshop.path("dog").exists());

    // Again, with other drawings.
    workshop.succeeds(&["new", "cat", "wide.png", "--force"]);
    let text = std::fs::read_to_string(workshop.path("cat/scene.toml")).expect("a scene");
    assert_eq!(text.matches("[[pose]]").count(), 1, "{text}");
}

#[test]
fn walls_and_bounds_of_a_scene_are_kept() {
    let workshop = Workshop::new();
    let walled = "[pose_space]\nbounded = true\nwalls = [[[0.5, -9.0], [0.5, 0.5]]]\n";
    workshop.two_poses("[0, 0]", "[1, 0]", walled);
    let text = workshop.succeeds(&["weights", "scene.toml", "--at", "0.49,-0.5", "--at", "0.51,-0.5"]);
    let first: Vec<f64> = text
        .lines()
        .map(|line| {
            let line: serde_json::Value = serde_json::from_str(line).expect("JSON");
            line["weights"][0].as_f64().expect("a number")
        })
        .collect();
    assert!(
        first[0] > 0.7 && first[0] <= 1.0 && first[1] < 0.3 && first[1] >= 0.0,
        "{first:?}"
    );
    workshop.two_poses("[0, 0]", "[0.5, 0]", walled);
    let message = workshop.fails(&["weights", "scene.toml", "--at", "0,0"], 1);
    assert!(
        message.contains("wall 0 touches pose 'wide'") && message.contains("move the wall"),
        "{message}"
    );
}

#[test]
fn progress_is_told_as_asked() {
    let workshop = two();
    let told = |more: &[&str]| {
        let output = workshop.run(&[&["render", "scene.toml", "-o", "frames"], more].concat());
        assert!(output.status.success() && output.stdout.is_empty());
        String::from_utf8(output.stderr).expect("text")
    };
    assert!(told(&[]).contains("12 of 12 frames (100 %)"));
    let lines: Vec<serde_json::Value> = told(&["--progress", "json"])
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let (first, last) = (&lines[0], &lines[lines.len() - 1]);
    assert!(first["done"] == 0 && first["total"] == 12 && first["left"].is_null());
    assert!(last["done"] == 12 && last["left"] == 0.0 && last["seconds"].as_f64().is_some());
    assert_eq!(told(&["--progress", "none"]), "");
    assert_eq!(told(&["--quiet"]), "");
}

#[test]
fn a_sprite_sheet_is_two_files_or_none() {
    let workshop = two();
    let before = workshop.listing();
    std::fs::create_dir(workshop.path("a.json")).expect("in the way");
    let message = workshop.fails(&["render", "scene.toml", "-o", "a.png", "--format", "sprites"], 1);
    assert!(message.contains("a.json"), "{message}");
    std::fs::remove_dir(workshop.path("a.json")).expect("removed");
    assert_eq!(workshop.listing(), before);
    workshop.succeeds(&["render", "scene.toml", "-o", "a.png", "--format", "sprites"]);
    let table: serde_json::Value = serde_json::from_slice(&workshop.bytes("a.json")).expect("JSON");
    assert_eq!(table["frames"].as_array().expect("an array").len(), 12);
    assert_eq!(table["meta"]["image"], "a.png");
    assert!(workshop.path("a.png").is_file());
}

#[test]
fn the_background_is_any_colour() {
    let workshop = two();
    let corner = |colour: &str| {
        workshop.succeeds(&[
            "frame",
            "scene.toml",
            "--at",
            "0,0",
            "-o",
            "a.png",
            "--background",
            colour,
        ]);
        workshop.succeeds(&[
            "render",
            "scene.toml",
            "-o",
            "f",
            "--frames",
            "1",
            "--background",
            colour,
        ]);
        let frames = std::fs::read_dir(workshop.path("f")).expect("a folder");
        let frame = frames
            .map(|entry| entry.expect("an entry").path())
            .next()
            .expect("a frame");
        let [one, other] = [workshop.path("a.png"), frame].map(|p| image::open(p).expect("a picture").to_rgba8());
        assert_eq!(one.get_pixel(0, 0), other.get_pixel(0, 0));
        one.get_pixel(0, 0).0
    };
    assert_eq!(corner("#0a141e"), [10, 20, 30, 255]);
    assert_eq!(corner("transparent"), [0; 4]);
    let message = workshop.fails(&["render", "scene.toml", "-o", "f", "--background", "red"], 2);
    assert!(message.contains("#rrggbb"), "{message}");
}
