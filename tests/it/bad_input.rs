//! Bad input through the real command: exit code 1, one message that names file, pose and place and says what to do, and
//! nothing written.

use crate::workshop::{Workshop, png_that_claims};

/// Runs `map` on a scene and expects a refusal whose message has all of `words`.
fn refused(workshop: &Workshop, words: &[&str]) {
    let before = workshop.listing();
    let message = workshop.fails(&["map", "scene.toml", "-o", "mapping.json"], 1);
    for word in words {
        assert!(message.contains(word), "'{word}' is not in: {message}");
    }
    assert_eq!(message.trim_end().lines().count(), 1, "one line: {message}");
    assert_eq!(workshop.listing(), before, "something was left behind");
}

#[test]
fn a_missing_file() {
    let workshop = Workshop::new();
    workshop.scene("[[pose]]\nname = \"run\"\nsource = \"run.png\"\n");
    refused(&workshop, &["scene.toml:4", "'run'", "run.png", "correct `source`"]);
}

#[test]
fn a_missing_scene() {
    let workshop = Workshop::new();
    refused(&workshop, &["scene.toml", "inbetween new"]);
}

#[test]
fn a_file_that_is_no_image() {
    let workshop = Workshop::new();
    workshop.file("run.png", b"these are words");
    workshop.scene("[[pose]]\nname = \"run\"\nsource = \"run.png\"\n");
    refused(&workshop, &["scene.toml", "'run'", "run.png", "not a PNG", "export"]);
}

#[test]
fn an_empty_file() {
    let workshop = Workshop::new();
    workshop.file("run.png", b"");
    workshop.scene("[[pose]]\nname = \"run\"\nsource = \"run.png\"\n");
    refused(&workshop, &["'run'", "run.png", "empty"]);
}

#[test]
fn an_image_with_nothing_in_it() {
    let workshop = Workshop::new();
    workshop.picture("run.png", |_, _| [0, 0, 0, 0]);
    workshop.picture("walk.png", |_, _| [200, 200, 200, 255]);
    for (name, file) in [("run", "run.png"), ("walk", "walk.png")] {
        workshop.scene(&format!("[[pose]]\nname = \"{name}\"\nsource = \"{file}\"\n"));
        refused(&workshop, &[name, file, "no drawing"]);
    }
}

#[test]
fn a_png_that_claims_to_be_huge() {
    let workshop = Workshop::new();
    workshop.file("run.png", &png_that_claims(60_000, 60_000));
    workshop.scene("[[pose]]\nname = \"run\"\nsource = \"run.png\"\n");
    refused(&workshop, &["'run'", "run.png", "60000 x 60000", "scale it down"]);
}

#[test]
fn an_svg_without_a_closed_shape() {
    let workshop = Workshop::new();
    workshop.file(
        "run.svg",
        br#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>"#,
    );
    workshop.scene("[[pose]]\nname = \"run\"\nsource = \"run.svg\"\n");
    refused(&workshop, &["'run'", "run.svg"]);
}

#[test]
fn an_svg_with_enormous_coordinates() {
    for coordinate in ["1e9", "1e300"] {
        let workshop = Workshop::new();
        let path = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M0 0H{coordinate}V{coordinate}Z"/></svg>"#
        );
        workshop.file("run.svg", path.as_bytes());
        workshop.scene("[[pose]]\nname = \"run\"\nsource = \"run.svg\"\n");
        refused(&workshop, &["'run'", "run.svg"]);
    }
}

#[test]
fn two_poses_at_the_same_place() {
    let workshop = Workshop::new();
    workshop.two_poses("[0.5, 0.25]", "[0.5, 0.25]", "");
    refused(
        &workshop,
        &["scene.toml:7", "'tall' and 'wide'", "[0.5, 0.25]", "move one"],
    );
}

#[test]
fn a_place_that_is_not_a_number() {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[nan, 1]", "");
    refused(&workshop, &["scene.toml:9", "pose 'wide'", "NaN", "finite"]);
}

#[test]
fn a_landmark_on_an_unknown_pose() {
    let workshop = Workshop::new();
    workshop.two_poses(
        "[0, 0]",
        "[1, 0]",
        "[[landmark]]\nname = \"nose\"\nat = { fast = [1, 2] }\n",
    );
    refused(&workshop, &["scene.toml:12", "'nose'", "'fast'", "'tall', 'wide'"]);
}

#[test]
fn a_landmark_far_from_the_outline() {
    let workshop = Workshop::new();
    workshop.two_poses(
        "[0, 0]",
        "[1, 0]",
        "[[landmark]]\nname = \"nose\"\nat = { tall = [1, 2] }\n",
    );
    refused(&workshop, &["'nose'", "'tall'", "(1.0, 2.0)", "move"]);
}

#[test]
fn landmarks_in_an_impossible_order() {
    let workshop = Workshop::new();
    // Around the tall box: top left, top right, bottom right; around the wide one the last two are exchanged.
    workshop.two_poses(
        "[0, 0]",
        "[1, 0]",
        "[[landmark]]\nname = \"hat\"\nat = { tall = [12, 4], wide = [4, 12] }\n\
         [[landmark]]\nname = \"hand\"\nat = { tall = [28, 4], wide = [36, 28] }\n\
         [[landmark]]\nname = \"foot\"\nat = { tall = [28, 36], wide = [36, 12] }\n",
    );
    let message = workshop.fails(&["map", "scene.toml", "-o", "mapping.json"], 1);
    let named = ["hat", "hand", "foot"]
        .iter()
        .filter(|name| message.contains(*name))
        .count();
    assert!(named >= 1 && message.contains("scene.toml"), "{message}");
    assert!(message.contains("wide") || message.contains("tall"), "{message}");
    assert!(!workshop.path("mapping.json").exists());
}

#[test]
fn weights_that_do_not_sum_to_one() {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", "");
    for (weights, words) in [
        ("0.5,0.6", ["sum to 1.1", "must sum to 1"]),
        ("nan,1", ["'tall'", "NaN"]),
        ("1", ["1 weights", "'tall', 'wide'"]),
    ] {
        let message = workshop.fails(&["frame", "scene.toml", "--weights", weights, "-o", "a.png"], 1);
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert!(!workshop.path("a.png").exists());
    }
    let message = workshop.fails(&["frame", "scene.toml", "--at", "nan,0", "-o", "a.png"], 1);
    assert!(message.contains("NaN"), "{message}");
}

#[test]
fn an_output_that_cannot_be_written() {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", "");
    workshop.file("file", b"");
    for output in ["file/frames", "file/a.gif", "none/a.apng"] {
        let before = workshop.listing();
        let message = workshop.fails(&["render", "scene.toml", "-o", output], 1);
        assert!(
            message.contains(output) && message.contains("cannot write"),
            "{message}"
        );
        assert_eq!(workshop.listing(), before);
    }
}

#[test]
fn an_unknown_key() {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", "[blend]\nstrech = \"log\"\n");
    refused(&workshop, &["scene.toml:11", "strech", "stretch"]);
}

#[test]
fn a_source_outside_the_folder() {
    let workshop = Workshop::new();
    workshop.scene("[[pose]]\nname = \"run\"\nsource = \"../run.png\"\n");
    refused(&workshop, &["scene.toml:4", "'run'", "../run.png"]);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc/hostname", workshop.path("link.png")).expect("a link");
        workshop.scene("[[pose]]\nname = \"run\"\nsource = \"link.png\"\n");
        refused(&workshop, &["scene.toml:4", "'run'", "link.png", "link"]);
    }
}

#[test]
fn different_numbers_of_holes() {
    let workshop = Workshop::new();
    let inside = |x: u32, y: u32, low: u32, high: u32| (low..high).contains(&x) && (low..high).contains(&y);
    let ink = |drawn: bool| if drawn { [0, 0, 0, 255] } else { [0; 4] };
    workshop.picture("disc.png", move |x, y| ink(inside(x, y, 4, 36)));
    workshop.picture(
        "ring.png",
        move |x, y| ink(inside(x, y, 4, 36) && !inside(x, y, 14, 26)),
    );
    workshop
        .scene("[input]\nholes = \"keep\"\n[[pose]]\nname = \"disc\"\nsource = \"disc.png\"\n[[pose]]\nname = \"ring\"\nsource = \"ring.png\"\n");
    refused(
        &workshop,
        &["scene.toml", "'ring'", "1 hole", "'disc'", "holes = \"fill\""],
    );
}

#[test]
fn polygons_that_cross_or_differ() {
    let workshop = Workshop::new();
    for (polygons, words) in [
        (
            r#"{"poses":[{"name":"a","outline":[[0,0],[3,2],[3,0],[0,1]]}]}"#,
            ["'a'", "edge 0"],
        ),
        (
            r#"{"poses":[{"name":"a","outline":[[0,0],[0,3],[3,3]]}]}"#,
            ["'a'", "wrong way"],
        ),
        (
            r#"{"poses":[{"name":"a","outline":[[0,0],[3,0],[3,3]]},{"name":"b","outline":[[0,0],[3,0],[3,3],[0,3]]}]}"#,
            ["'b'", "correspond"],
        ),
        (
            r#"{"poses":[{"name":"a","outline":[[0,0],[1e300,0],[3,3]]}]}"#,
            ["'a'", "1e7"],
        ),
        (r#"{"poses":[{"name":"a","#, ["polygons.json", "line 1"]),
    ] {
        workshop.file("polygons.json", polygons.as_bytes());
        let before = workshop.listing();
        let message = workshop.fails(&["triangulate", "polygons.json", "-o", "mapping.json"], 1);
        assert!(message.contains("polygons.json"), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert_eq!(workshop.listing(), before);
    }
}

#[test]
fn a_broken_mapping() {
    let workshop = Workshop::new();
    workshop.file(
        "polygons.json",
        br#"{"poses":[{"name":"a","outline":[[0,0],[3,0],[3,3],[0,3]]},{"name":"b","outline":[[0,0],[2,0],[2,1],[0,1]]}]}"#,
    );
    workshop.succeeds(&["triangulate", "polygons.json", "-o", "m.json"]);
    workshop.succeeds(&["check", "m.json"]);
    let good = std::fs::read_to_string(workshop.path("m.json")).expect("there");
    let broken = good.replacen("\"vertices\":[[0.0,0.0]", "\"vertices\":[[2.5,2.9]", 1);
    assert_ne!(good, broken);
    workshop.file("m.json", broken.as_bytes());
    let message = workshop.fails(&["check", "m.json"], 1);
    assert!(message.contains("m.json") && message.contains("'a'"), "{message}");
    let message = workshop.fails(&["blend", "m.json", "--weights", "0.5,0.5", "-o", "f.json"], 1);
    assert!(message.contains("m.json") && message.contains("'a'"), "{message}");
    assert!(!workshop.path("f.json").exists());
}

#[test]
fn wrong_usage_is_exit_code_2() {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", "");
    for arguments in [
        &["render", "scene.toml", "-o", "a.tiff"][..],
        &["render", "scene.toml", "-o", "a", "--format", "tiff"],
        &["render", "scene.toml", "-o", "a", "--threads", "0"],
        &["render", "scene.toml", "-o", "a.gif", "--resume"],
        &["render", "scene.toml", "-o", "a", "--frames", "1-9999"],
        &["frame", "scene.toml", "-o", "a.png"],
        &["frame", "scene.toml", "--at", "0,x", "-o", "a.png"],
        &["weights", "scene.toml", "--grid", "0x4"],
        &["draw"],
    ] {
        let before = workshop.listing();
        workshop.fails(arguments, 2);
        assert_eq!(workshop.listing(), before);
    }
}
