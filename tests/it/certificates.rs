//! `blend --certify` and `render --certify` say what holds of frames, and what does not.

use serde_json::{Value, json};

use crate::workshop::Workshop;

fn value(workshop: &Workshop, arguments: &[&str]) -> Value {
    serde_json::from_str(&workshop.succeeds(arguments)).expect("JSON")
}

/// The lines of a file of certificates.
fn lines(workshop: &Workshop, name: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(workshop.path(name)).expect(name);
    assert!(text.ends_with('\n'));
    text.lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

/// Columns of the strip below.
const COLUMNS: usize = 24;

/// A strip that is bent by so many turns, as an outline: outer side first, then back along the inner one.
fn strip(turns: f64) -> Vec<[f64; 2]> {
    // At half a turn its sides have the radii 4 and 3; it keeps its length along the middle.
    let middle = 3.5 * 0.5 / turns;
    let at = |k: usize, aside: f64| {
        let turn = std::f64::consts::TAU * turns * (k as f64 / COLUMNS as f64 - 0.5);
        [(middle + aside) * turn.sin(), -(middle + aside) * turn.cos()]
    };
    let outer = (0..=COLUMNS).map(|k| at(k, 0.5));
    outer.chain((0..=COLUMNS).rev().map(|k| at(k, -0.5))).collect()
}

/// A workshop with the mapping `m.json` of a strip that is nearly straight and one that is bent by 0.6 turns.
fn strips() -> Workshop {
    let workshop = Workshop::new();
    let pose = |name: &str, turns: f64| json!({ "name": name, "outline": strip(turns), "holes": [] });
    let polygons = json!({ "poses": [pose("straight", 0.02), pose("bent", 0.6)] });
    workshop.file("p.json", polygons.to_string().as_bytes());
    workshop.succeeds(&["triangulate", "p.json", "-o", "m.json"]);
    workshop
}

#[test]
fn a_certificate_is_added_to_a_frame_and_nothing_else_changes() {
    let workshop = strips();
    let plain = workshop.succeeds(&["blend", "m.json", "--weights", "0.5,0.5", "-o", "-"]);
    let certified = workshop.succeeds(&["blend", "m.json", "--weights", "0.5,0.5", "--certify", "-o", "-"]);
    let begins = plain.strip_suffix("}\n").expect("an object");
    assert!(certified.starts_with(&format!("{begins},\"certificate\":{{\"positive\":true,")));
    let certificate = &serde_json::from_str::<Value>(&certified).expect("JSON")["certificate"];
    let keys: Vec<&String> = certificate.as_object().expect("an object").keys().collect();
    let mut expected = [
        "positive",
        "simple",
        "overlaps",
        "largest_distortion",
        "largest_area",
        "of_poses",
    ];
    expected.sort_unstable();
    assert_eq!(keys, expected);
    assert_eq!(
        (&certificate["simple"], &certificate["overlaps"]),
        (&json!(true), &json!([]))
    );
    // A pose as the reference of itself is not distorted; the other one is as the mapping has it.
    for weights in ["1,0", "0,1"] {
        let arguments = [
            "blend",
            "m.json",
            "--weights",
            weights,
            "--reference",
            "bent",
            "--certify",
            "-o",
            "-",
        ];
        let certificate = &value(&workshop, &arguments)["certificate"];
        let number = |value: &Value| value.as_f64().expect("a number");
        for (frame, of_poses) in [("largest_distortion", "distortion"), ("largest_area", "area")] {
            let (frame, of_poses) = (number(&certificate[frame]), number(&certificate["of_poses"][of_poses]));
            assert!((frame - of_poses).abs() < 1e-6 * of_poses, "{certificate}");
            assert_eq!(of_poses < 1.0 + 1e-9, weights == "0,1", "{certificate}");
        }
    }
}

#[test]
fn an_outline_that_winds_over_itself_is_not_simple_unless_limbs_do() {
    let workshop = strips();
    // The turns go on: twice 0.6 less 0.02 are more than one.
    let arguments = ["blend", "m.json", "--weights=-1,2", "--certify", "-o", "-"];
    let frame = value(&workshop, &arguments);
    assert_eq!(frame["flipped"], 0);
    assert_eq!(
        (&frame["certificate"]["positive"], &frame["certificate"]["simple"]),
        (&json!(true), &json!(false))
    );
    let told = workshop.run(&arguments);
    let told = String::from_utf8_lossy(&told.stderr).into_owned();
    assert!(told.contains("crosses itself") && told.contains("near ("), "{told}");

    // The same shape as a pose that lies over itself, with a limb at each end.
    let mut mapping: Value =
        serde_json::from_slice(&std::fs::read(workshop.path("m.json")).expect("there")).expect("JSON");
    let triangles: Vec<Vec<usize>> = serde_json::from_value(mapping["triangles"].clone()).expect("triangles");
    let column = |vertex: usize| {
        if vertex <= COLUMNS {
            vertex
        } else {
            2 * COLUMNS + 1 - vertex
        }
    };
    let limb = |triangle: &Vec<usize>| match triangle.iter().map(|v| column(*v)).sum::<usize>() {
        sum if sum < COLUMNS => 0,
        sum if sum > 2 * COLUMNS => 1,
        _ => -1,
    };
    mapping["poses"][1]["vertices"] = frame["vertices"].clone();
    mapping["limbs"] = json!(["head", "tail"]);
    mapping["triangle_limb"] = triangles.iter().map(limb).collect();
    mapping["immersed"] = json!([{ "pose": "bent", "depth": (0..triangles.len()).collect::<Vec<_>>() }]);
    workshop.file("immersed.json", mapping.to_string().as_bytes());
    let certificate = |weights: &str| {
        let weights = format!("--weights={weights}");
        value(&workshop, &["blend", "immersed.json", &weights, "--certify", "-o", "-"])["certificate"].clone()
    };
    let over = certificate("0,1");
    assert_eq!(
        (&over["simple"], &over["overlaps"]),
        (&json!(true), &json!([["head", "tail"]]))
    );
    assert_eq!(certificate("1,0")["overlaps"], json!([]));
    // Without limbs every crossing counts, in a pose too.
    mapping["limbs"] = json!([]);
    mapping["triangle_limb"] = json!([]);
    workshop.file("immersed.json", mapping.to_string().as_bytes());
    assert_eq!(certificate("0,1")["simple"], json!(false));
}

#[test]
fn a_frame_that_is_turned_over_is_not_positive_and_stays_json() {
    let workshop = Workshop::new();
    let rectangle = |name: &str, width: f64| {
        let corners = [[0.0, 0.0], [width, 0.0], [width, 8.0], [0.0, 8.0]];
        json!({ "name": name, "outline": corners, "holes": [] })
    };
    let polygons = json!({ "poses": [rectangle("square", 8.0), rectangle("wide", 16.0)] });
    workshop.file("p.json", polygons.to_string().as_bytes());
    workshop.succeeds(&["triangulate", "p.json", "-o", "m.json"]);
    for (weights, flipped) in [("--weights=1,0", 0), ("--weights=4,-3", 2)] {
        let arguments = [
            "blend",
            "m.json",
            weights,
            "--reference",
            "square",
            "--certify",
            "-o",
            "-",
        ];
        let frame = value(&workshop, &arguments);
        assert_eq!(
            (&frame["flipped"], &frame["certificate"]["positive"]),
            (&json!(flipped), &json!(flipped == 0))
        );
    }
    // Between the two there is no width left, nearly or exactly: a number or null, and never anything else.
    let arguments = [
        "blend",
        "m.json",
        "--weights=2,-1",
        "--reference",
        "square",
        "--certify",
        "-o",
        "-",
    ];
    let certificate = &value(&workshop, &arguments)["certificate"];
    let is_large = |value: &Value| value.is_null() || value.as_f64().is_some_and(|k| k > 1e9);
    assert!(
        is_large(&certificate["largest_distortion"]) && is_large(&certificate["largest_area"]),
        "{certificate}"
    );
}

fn two() -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", "[animation]\nfps = 6\nsize = [24, 24]\n");
    workshop
}

#[test]
fn a_render_has_a_certificate_a_frame_beside_it() {
    let workshop = two();
    workshop.succeeds(&["render", "scene.toml", "-o", "plain.gif"]);
    workshop.succeeds(&["render", "scene.toml", "-o", "a.gif", "--certify", "--threads", "3"]);
    let read = |name: &str| std::fs::read(workshop.path(name)).expect(name);
    assert!(read("plain.gif") == read("a.gif") && !workshop.path("plain.gif.certificates.jsonl").exists());
    let all = lines(&workshop, "a.gif.certificates.jsonl");
    assert_eq!(all.len(), 12);
    for (k, line) in all.iter().enumerate() {
        assert_eq!(
            (&line["frame"], &line["positive"], &line["simple"]),
            (&json!(k + 1), &json!(true), &json!(true))
        );
        assert_eq!(
            (
                line["weights"].as_array().map(Vec::len),
                line["at"].as_array().map(Vec::len)
            ),
            (Some(2), Some(2))
        );
        assert!(line["largest_distortion"].as_f64() >= Some(1.0) && line["of_poses"]["area"].as_f64() >= Some(1.0));
        assert!(line.get("layers").is_none() && line["overlaps"] == json!([]));
    }
    // A folder in a folder that is not there yet, some frames, one thread.
    let some = [
        "render",
        "scene.toml",
        "-o",
        "deep/take/",
        "--certify",
        "--frames",
        "11,2-3",
        "--threads",
        "1",
    ];
    workshop.succeeds(&some);
    assert_eq!(
        lines(&workshop, "deep/take.certificates.jsonl"),
        [all[1].clone(), all[2].clone(), all[10].clone()]
    );
    assert_eq!(std::fs::read_dir(workshop.path("deep")).expect("a folder").count(), 2);
    // Frames that are there already are certified again.
    std::fs::remove_file(workshop.path("deep/take.certificates.jsonl")).expect("there");
    workshop.succeeds(&[
        "render",
        "scene.toml",
        "-o",
        "deep/take",
        "--certify",
        "--frames",
        "2-3,11",
        "--resume",
    ]);
    assert_eq!(lines(&workshop, "deep/take.certificates.jsonl").len(), 3);
}

#[test]
fn certificates_need_a_place() {
    let workshop = two();
    let told = workshop.fails(&["render", "scene.toml", "-o", "-", "--certify"], 2);
    assert!(told.contains("--certify") && told.contains("folder"), "{told}");
    if cfg!(unix) {
        let told = workshop.fails(
            &[
                "render",
                "scene.toml",
                "-o",
                "/dev/null",
                "--format",
                "gif",
                "--certify",
            ],
            2,
        );
        assert!(told.contains("device"), "{told}");
    }
    std::fs::create_dir(workshop.path("a.gif.certificates.jsonl")).expect("a folder in the way");
    workshop.fails(&["render", "scene.toml", "-o", "a.gif", "--certify"], 1);
    assert!(!workshop.path("a.gif").exists());
}

#[test]
fn a_frame_that_does_not_hold_is_named_when_all_is_written() {
    // Far beyond the narrow box: four times its width less three times that of the wide one is less than nothing.
    let workshop = Workshop::new();
    for (name, columns) in [("narrow.png", 14..26), ("wide.png", 2..38)] {
        workshop.picture(name, |x, y| match columns.contains(&x) && (14..26).contains(&y) {
            true => [220, 30, 20, 255],
            false => [0; 4],
        });
    }
    let scene = |guard: &str| {
        workshop.scene(&format!(
            "[[pose]]\nname = \"narrow\"\nsource = \"narrow.png\"\nat = [0, 0]\n\
             [[pose]]\nname = \"wide\"\nsource = \"wide.png\"\nat = [1, 0]\n\
             [pose_space]\nprovider = \"rbf\"\nradial = \"thin-plate\"\n\
             [blend]\nguard = \"{guard}\"\n\
             [animation]\nfps = 6\nsize = [24, 24]\n\
             keys = [{{ time = 0, at = [0, 0] }}, {{ time = 1, at = [-3, 0] }}]\n"
        ));
    };
    scene("off");
    let told = workshop.fails(&["render", "scene.toml", "-o", "frames", "--certify"], 1);
    let line = told.lines().last().expect("a line");
    for part in [
        "frame ",
        " at (",
        "not positive",
        " near (",
        "guard = \"repair\"",
        "frames.certificates.jsonl",
        "more of 7 frames",
    ] {
        assert!(line.contains(part), "{part}: {told}");
    }
    let all = lines(&workshop, "frames.certificates.jsonl");
    let files = std::fs::read_dir(workshop.path("frames")).expect("a folder");
    assert_eq!((all.len(), files.count()), (7, 7));
    let first = all.iter().position(|line| line["positive"] == json!(false));
    let first = first.expect("one does not hold");
    assert!(line.contains(&format!("frame {} at", first + 1)), "{told}");
    assert_eq!(all[0]["positive"], json!(true));
    // Frames that hold are no failure, and neither is a scene that is repaired.
    workshop.succeeds(&["render", "scene.toml", "-o", "frames", "--certify", "--frames", "1"]);
    scene("repair");
    workshop.succeeds(&["render", "scene.toml", "-o", "frames", "--certify"]);
}

#[test]
fn layers_have_a_certificate_each_and_the_frame_the_worst_of_them() {
    let workshop = Workshop::new();
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/bear/scene.toml");
    let scene = scene.to_str().expect("text");
    let output = workshop.run(&[
        "render",
        scene,
        "-o",
        "bear",
        "--certify",
        "--frames",
        "1,9",
        "--size",
        "32x32",
    ]);
    let all = lines(&workshop, "bear.certificates.jsonl");
    assert_eq!(all.len(), 2);
    let mut holds = true;
    for line in &all {
        let layers = line["layers"].as_array().expect("layers");
        assert!(
            layers.len() > 1 && layers.iter().all(|layer| layer["layer"].is_string()),
            "{line}"
        );
        for key in ["positive", "simple"] {
            assert_eq!(
                line[key],
                json!(layers.iter().all(|layer| layer[key] == json!(true))),
                "{line}"
            );
            holds &= line[key] == json!(true);
        }
        let largest = layers
            .iter()
            .filter_map(|layer| layer["largest_distortion"].as_f64())
            .fold(0.0, f64::max);
        assert_eq!(line["largest_distortion"].as_f64(), Some(largest));
    }
    assert_eq!(output.status.code(), Some(if holds { 0 } else { 1 }));
}
