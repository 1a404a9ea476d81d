use super::*;
use serde_json::json;

const SCENE: &str = r#"# A walker.
version = 1
reference = "stand"   # B0

[[pose]]
name = "stand"
source = "stand.png"
at = [ 0.0, 0.0 ]  # the middle

[[pose]]
name = "run"
source = "run.png"
at = [1.0, 0.0]

# Where the nose is.
[[landmark]]
name = "nose"
at = { stand = [120.5, 40.0], run = [131.0, 44.0] } # by eye

[blend]
anchor = "nose"
"#;

fn edited(text: &str, ops: serde_json::Value) -> Edited {
    let ops: Vec<Op> = serde_json::from_value(ops).expect("ops");
    let scene = Scene::parse(text, std::path::Path::new("scene.toml")).expect("a scene");
    let context = Context {
        scene: Some(&scene),
        bench: None,
    };
    let Ok(edited) = apply(text, &ops, &context) else {
        panic!("it is not refused")
    };
    Scene::parse(&edited.text, std::path::Path::new("scene.toml")).expect("still a scene");
    edited
}

/// Lines that are only in the first, and only in the second.
fn difference(a: &str, b: &str) -> (Vec<String>, Vec<String>) {
    let only = |a: &str, b: &str| {
        a.lines()
            .filter(|line| !b.lines().any(|l| l == *line))
            .map(str::to_owned)
            .collect()
    };
    (only(a, b), only(b, a))
}

#[test]
fn a_move_changes_two_numbers_and_nothing_else() {
    let moved = edited(SCENE, json!([{"op": "move_pose", "pose": "stand", "at": [0.25, -1]}]));
    assert_eq!(moved.text, SCENE.replace("[ 0.0, 0.0 ]", "[ 0.25, -1.0 ]"));
    let moved = edited(
        SCENE,
        json!([{"op": "move_landmark", "landmark": "nose", "at": {"run": [1.5, 2.5]}}]),
    );
    assert_eq!(moved.text, SCENE.replace("[131.0, 44.0]", "[1.5, 2.5]"));
}

#[test]
fn what_is_added_stands_behind_its_like() {
    let added = edited(
        SCENE,
        json!([{"op": "add_landmark", "at": {"run": [1, 2], "stand": [3, 4]}}]),
    );
    assert_eq!(added.names, ["landmark_1"]);
    let (gone, new) = difference(SCENE, &added.text);
    assert!(gone.is_empty(), "{gone:?}");
    assert_eq!(
        new,
        ["name = \"landmark_1\"", "at = { stand = [3.0, 4.0], run = [1.0, 2.0] }"]
    );
    assert!(added.text.find("landmark_1") < added.text.find("[blend]"));
    let copy =
        json!([{"op": "add_deformed_pose", "of": "stand", "at": [0, 1], "handles": [{"from": [1, 2], "to": [3, 4]}]}]);
    let copied = edited(SCENE, copy);
    assert_eq!(copied.names, ["stand_1"]);
    assert!(
        copied
            .text
            .contains("handles = [{ from = [1.0, 2.0], to = [3.0, 4.0] }]"),
        "{}",
        copied.text
    );
    let pseudo = edited(
        SCENE,
        json!([{"op": "add_pseudo_pose", "from": [0.5, 0.0], "at": [0.4, 0.1]}]),
    );
    let back = edited(&pseudo.text, json!([{"op": "remove_pseudo_pose", "index": 0}]));
    assert_eq!(back.text.trim_end(), SCENE.trim_end());
}

#[test]
fn settings_and_keys_are_set_and_removed() {
    let set = edited(
        SCENE,
        json!([
            {"op": "set", "table": "texture", "key": "sharpness", "value": 0.7},
            {"op": "set", "table": "blend", "key": "stretch", "value": "log"},
            {"op": "set_keys", "keys": [{"time": 0, "at": [0, 0]}, {"time": 1.5, "at": [1, 0]}, {"time": 2, "at": [0, 1], "hold": 2, "spacing": [0.25, 1]}], "loop": true, "fps": 12},
        ]),
    );
    for line in [
        "sharpness = 0.7",
        "stretch = \"log\"",
        "loop = true",
        "fps = 12.0",
        "  { time = 1.5, at = [1.0, 0.0] },",
        "  { time = 2.0, at = [0.0, 1.0], hold = 2, spacing = [0.25, 1.0] },",
    ] {
        assert!(set.text.lines().any(|l| l == line), "{line} in {}", set.text);
    }
    let unset = edited(
        &set.text,
        json!([{"op": "set", "table": "blend", "key": "stretch", "value": null}]),
    );
    assert!(!unset.text.contains("stretch"));
}

#[test]
fn names_are_followed() {
    let renamed = edited(
        SCENE,
        json!([
            {"op": "rename_landmark", "landmark": "nose", "name": "beak"},
            {"op": "set_pose", "pose": "stand", "key": "name", "value": "rest"},
        ]),
    );
    assert_eq!(
        renamed.text,
        SCENE
            .replace("nose\"", "beak\"")
            .replace("\"stand\"", "\"rest\"")
            .replace("{ stand", "{ rest")
    );
    let removed = edited(SCENE, json!([{"op": "remove_pose", "pose": "run"}]));
    assert!(!removed.text.contains("run"));
}

#[test]
fn what_is_not_there_is_refused() {
    let context = Context {
        scene: None,
        bench: None,
    };
    for ops in [
        json!([{"op": "move_pose", "pose": "fly", "at": [0, 0]}]),
        json!([{"op": "remove_landmark", "landmark": "ear"}]),
        json!([{"op": "remove_pseudo_pose", "index": 0}]),
        json!([{"op": "set", "table": "pose", "key": "name", "value": "x"}]),
        json!([{"op": "set", "table": "blend", "key": "guard", "value": {}}]),
        json!([{"op": "add_landmark", "at": {"run": [1]}}]),
    ] {
        let ops: Vec<Op> = serde_json::from_value(ops).expect("ops");
        assert!(apply(SCENE, &ops, &context).is_err(), "{ops:?}");
    }
    assert!(serde_json::from_value::<Op>(json!({"op": "explode"})).is_err());
    assert!(serde_json::from_value::<Op>(json!({"op": "remove_pose", "pose": "a", "b": 1})).is_err());
}

#[test]
fn how_a_drawing_is_read_is_said_in_its_pose() {
    let ops = json!([
        {"op": "set_pose", "pose": "stand", "key": "figure", "value": "lines"},
        {"op": "set_pose", "pose": "stand", "key": "gap", "value": 0.02},
        {"op": "mark_part", "pose": "run", "list": "drop", "at": [12.5, 3]},
        {"op": "mark_part", "pose": "run", "list": "drop", "at": [14, 5]},
    ]);
    let read = edited(SCENE, ops);
    let (gone, new) = difference(SCENE, &read.text);
    assert!(gone.is_empty(), "{gone:?}");
    assert_eq!(
        new,
        ["figure = \"lines\"", "gap = 0.02", "drop = [[12.5, 3.0], [14.0, 5.0]]"]
    );
    let back = json!([
        {"op": "set_pose", "pose": "stand", "key": "figure", "value": null},
        {"op": "set_pose", "pose": "stand", "key": "gap", "value": null},
        {"op": "unmark_part", "pose": "run", "list": "drop", "index": 1},
        {"op": "unmark_part", "pose": "run", "list": "drop", "index": 0},
    ]);
    assert_eq!(edited(&read.text, back).text, SCENE);
}

#[test]
fn what_is_written_between_places_of_parts_stays() {
    let text = SCENE.replace(
        "source = \"run.png\"\n",
        "source = \"run.png\"\nkeep = [\n  [1.0, 2.0], # a spark\n  [3.0, 4.0], # another\n]\n",
    );
    let ops = json!([{"op": "unmark_part", "pose": "run", "list": "keep", "index": 1}]);
    assert!(edited(&text, ops).text.contains("[1.0, 2.0], # a spark"));
}
