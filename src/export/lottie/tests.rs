use super::*;
use crate::export::Repetition;
use crate::export::keyed::tests::{animation, bar, frame_of, shape, timing};

fn lottie(keyed: &KeyedVector) -> (Value, KeyReport) {
    let (text, report) = keyed.to_lottie("test", &KeyOptions::default()).expect("complete");
    (serde_json::from_str(&text).expect("JSON"), report)
}

#[test]
fn tangents_are_relative_and_the_last_vertex_is_the_first() {
    let points = [
        [0.0, 0.0],
        [1.0, 0.0],
        [4.0, 2.0],
        [5.0, 2.0],
        [5.0, 3.0],
        [1.0, 1.0],
        [0.0, 0.0],
    ]
    .map(|[x, y]| Point::new(x, y));
    let piece = |is_closed| Piece { cubics: 2, is_closed };
    assert_eq!(
        bezier(piece(true), &points, true),
        json!({"c": true, "v": [[0, 0], [5, 2]], "i": [[1, 1], [-1, 0]], "o": [[1, 0], [0, 1]]})
    );
    assert_eq!(
        bezier(piece(false), &points, true),
        json!({"c": false, "v": [[0, 0], [5, 2], [0, 0]], "i": [[0, 0], [-1, 0], [1, 1]], "o": [[1, 0], [0, 1], [0, 0]]})
    );
}

#[test]
fn keys_are_in_frames_and_within_the_error() {
    let once = timing(Repetition::Once);
    let turn_rad = |sample: usize| 0.1 * once.frame_of(sample);
    let frames = (0..once.sample_count()).map(|k| frame_of(vec![shape(bar("arm", turn_rad(k)))]));
    let keyed = KeyedVector::new(once, frames).expect("alike");
    let (animation, report) = lottie(&keyed);
    let path = &animation["layers"][0]["shapes"][0]["it"][0]["ks"];
    assert_eq!(path["a"], 1);
    let keys = path["k"].as_array().expect("keys");
    assert_eq!(report.keys, keys.len());
    assert!(report.worst_px <= 0.25);
    let time = |key: &Value| key["t"].as_f64().expect("a time");
    assert_eq!((time(&keys[0]), time(&keys[keys.len() - 1])), (0.0, 8.0));
    for key in keys {
        // The tip of the bar's first straight edge, turned about (20, 20).
        let (sin, cos) = (0.1 * time(key)).sin_cos();
        let vertex = &key["s"][0]["v"][1];
        let [x, y] = [0, 1].map(|k| vertex[k].as_f64().expect("a coordinate"));
        assert!((x - (20.0 + 15.0 * cos + 3.0 * sin)).abs() < 0.006, "{key}");
        assert!((y - (20.0 + 15.0 * sin - 3.0 * cos)).abs() < 0.006, "{key}");
    }
}

#[test]
fn layers_are_front_first_and_references_lead_somewhere() {
    let (animation, report) = lottie(&animation(Repetition::Forever));
    assert_eq!((&animation["ip"], &animation["op"]), (&json!(0), &json!(9)));
    let layers = animation["layers"].as_array().expect("layers");
    let names: Vec<&str> = layers.iter().filter_map(|layer| layer["nm"].as_str()).collect();
    assert_eq!((names[0], names[names.len() - 1]), ("line", "background"));
    assert_eq!(names[1..3], ["arms", "disc"]);
    assert_eq!(layers[1]["masksProperties"].as_array().map(Vec::len), Some(2));
    assert_eq!(layers[1]["masksProperties"][1]["mode"], "s");
    let assets = animation["assets"].as_array().expect("assets");
    let known: Vec<&str> = assets.iter().filter_map(|asset| asset["id"].as_str()).collect();
    let inner = assets.iter().filter_map(|asset| asset["layers"].as_array()).flatten();
    let wanted: Vec<&str> = layers
        .iter()
        .chain(inner)
        .filter_map(|layer| layer["refId"].as_str())
        .collect();
    assert!(wanted.len() > 8);
    assert!(wanted.iter().all(|id| known.contains(id)));
    assert!(report.approximations.is_empty(), "{report:?}");
}

#[test]
fn an_order_is_shown_from_when_it_starts_to_when_it_ends() {
    let (animation, _) = lottie(&animation(Repetition::Once));
    let arms = animation["assets"]
        .as_array()
        .and_then(|assets| assets.iter().find(|asset| asset["nm"] == "arms"))
        .expect("the group");
    let shown: Vec<(&str, f64, f64)> = arms["layers"]
        .as_array()
        .expect("layers")
        .iter()
        .map(|layer| {
            let name = layer["nm"].as_str().expect("a name");
            let at = |name: &str| layer[name].as_f64().expect("a time");
            (name, at("ip"), at("op"))
        })
        .collect();
    assert_eq!(shown.len(), 6);
    assert_eq!((shown[0].0, shown[1].0, shown[2].0), ("arm 2", "arm & 1", "arm & 1"));
    assert_eq!((shown[0].1, shown[4].2), (0.0, 9.0));
    assert_eq!((shown[0].2, shown[2].2), (shown[2].1, shown[4].1));
}
