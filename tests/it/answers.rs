//! With `--json` a run ends with one object that a program can read.

use serde_json::Value;

use crate::workshop::Workshop;

/// The last line of what a run printed to standard error, with its exit code.
fn answer(workshop: &Workshop, arguments: &[&str]) -> (Option<i32>, Value) {
    let output = workshop.run(&[arguments, &["--json"]].concat());
    let text = String::from_utf8(output.stderr).expect("text");
    let last = text.lines().last().expect("a line");
    (output.status.code(), serde_json::from_str(last).expect(last))
}

fn two(landmark: &str) -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", landmark);
    workshop
}

#[test]
fn what_was_made_and_noted_is_said() {
    let workshop = two("");
    let (code, done) = answer(&workshop, &["map", "scene.toml", "-o", "m.json", "--quiet"]);
    assert_eq!(
        (code, &done["done"], &done["verb"]),
        (Some(0), &true.into(), &"map".into())
    );
    assert_eq!(done["made"], serde_json::json!(["m.json"]));
    assert!(done["said"][0].as_str().expect("a line").contains("2 poses"), "{done}");
    assert!(done["error"].is_null());
    // The drawings are one in red and one in blue.
    for note in done["notes"].as_array().expect("notes") {
        assert!(note["text"].is_string() && note["kind"].is_string(), "{note}");
    }
    let (_, piped) = answer(&workshop, &["weights", "scene.toml", "--at", "0,0", "-o", "-"]);
    assert_eq!((&piped["done"], &piped["made"]), (&true.into(), &serde_json::json!([])));
}

#[test]
fn an_error_has_its_kind_line_pose_place_and_remedy() {
    let workshop = two("[[landmark]]\nname = \"nose\"\nat = { tall = [2, 2], wide = [4, 20] }\n");
    let (code, failed) = answer(&workshop, &["map", "scene.toml", "-o", "m.json"]);
    let error = &failed["error"];
    assert_eq!((code, &failed["done"]), (Some(1), &false.into()));
    assert_eq!(error["kind"], "landmark-off-outline", "{failed}");
    assert_eq!((&error["pose"], &error["landmark"]), (&"tall".into(), &"nose".into()));
    assert_eq!(error["place"], serde_json::json!([2.0, 2.0]));
    assert_eq!((&error["file"], &error["line"]), (&"scene.toml".into(), &11.into()));
    assert!(
        error["remedy"].as_str().expect("a remedy").starts_with("move"),
        "{failed}"
    );
    assert_eq!(failed["made"], serde_json::json!([]));

    workshop.scene("[mesh]\nsimplfy = 1\n");
    let (code, failed) = answer(&workshop, &["render", "scene.toml", "-o", "a.gif"]);
    assert_eq!((code, &failed["error"]["kind"]), (Some(1), &"format".into()));
    assert_eq!(failed["error"]["line"], 3);
}

#[test]
fn wrong_usage_is_an_answer_too() {
    let workshop = two("");
    let (code, refused) = answer(&workshop, &["render", "scene.toml"]);
    assert_eq!((code, &refused["error"]["kind"]), (Some(2), &"usage".into()));
    let (code, refused) = answer(&workshop, &["render", "scene.toml", "-o", "a.bmp"]);
    assert_eq!((code, &refused["error"]["kind"]), (Some(2), &"usage".into()));
    // Help is no error.
    let output = workshop.run(&["render", "--help", "--json"]);
    assert!(
        String::from_utf8_lossy(&output.stderr)
            .lines()
            .all(|line| !line.starts_with('{'))
    );
}
