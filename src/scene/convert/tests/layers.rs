//! Scenes with layers.

use super::*;
use crate::input::Extent;

/// Two layers, the arm on the body, over four poses: `b` and `c` have one file for both, `c` no arm, `d` is a copy of `b`.
const LAYERED: &str = r#"
version = 1
reference = "a"
[blend]
anchor = ["foot", "elbow"]
[[layer]]
name = "body"
[[layer]]
name = "arm"
anchor = { layer = "body", at = "shoulder" }
[[pose]]
name = "a"
source = { body = "a-body.png", arm = "a-arm.png" }
at = [0, 0]
[[pose]]
name = "b"
source = "b.svg"
element = { body = "torso", arm = "left" }
at = [1, 0]
order = ["arm", "body"]
[[pose]]
name = "c"
source = { body = "c.svg" }
at = [0, 1]
[[pose]]
name = "d"
deform_of = "b"
handles = [ { from = [1, 2], to = [3, 4], layer = "arm" } ]
at = [1, 1]
[[landmark]]
name = "foot"
layer = "body"
at = { a = [9, 9], c = [8, 9] }
[[landmark]]
name = "shoulder"
layer = "arm"
at = { a = [1, 2], b = [3, 4] }
[[landmark]]
name = "elbow"
layer = "arm"
at = { a = [5, 6] }
"#;

#[test]
fn each_layer_is_a_scene_of_its_own() {
    let scene = parse(LAYERED).expect("a scene");
    assert!(scene.poses.iter().all(|pose| pose.source == PoseSource::Layered));
    let [body, arm] = scene.layers.as_slice() else {
        panic!("two layers")
    };
    assert_eq!((body.name.as_str(), body.poses.as_slice()), ("body", &[0, 1, 2, 3][..]));
    assert_eq!((arm.name.as_str(), arm.poses.as_slice()), ("arm", &[0, 1, 3][..]));
    let drawn = |layer: &Scene| -> Vec<(String, Option<String>, Extent)> {
        (layer.drawn_poses().into_iter())
            .filter_map(|pose| layer.drawing_of(pose))
            .map(|(_, drawing)| {
                let file = drawing.file.display().to_string();
                (file, drawing.element.clone(), drawing.extent)
            })
            .collect()
    };
    let whole = |file: &str| (file.to_owned(), None, Extent::Everything);
    let part = |element: &str| ("b.svg".to_owned(), Some(element.to_owned()), Extent::Element);
    assert_eq!(drawn(&body.scene), [whole("a-body.png"), part("torso"), whole("c.svg")]);
    assert_eq!(drawn(&arm.scene), [whole("a-arm.png"), part("left")]);
    // The copy is one of `b`, which has another index in the layer; the body has no handle and stays.
    let copies: Vec<(usize, usize)> = [&body.scene.poses[3], &arm.scene.poses[2]]
        .map(|pose| match &pose.source {
            PoseSource::Deformed(copy) => (copy.copy.of, copy.copy.handles.len()),
            _ => panic!("a copy"),
        })
        .to_vec();
    assert_eq!(copies, [(1, 0), (1, 1)]);
    // Landmarks, and what names them, go with their layer.
    let names = |layer: &Scene| -> Vec<String> { layer.landmarks.iter().map(|l| l.name.clone()).collect() };
    assert_eq!(names(&body.scene), ["foot"]);
    assert_eq!(names(&arm.scene), ["shoulder", "elbow"]);
    let soft = |point| Anchor::Soft(vec![SoftAnchor { point, stiffness: 10.0 }]);
    assert_eq!(
        (&body.scene.blend.anchor, &arm.scene.blend.anchor),
        (&soft(0), &soft(1))
    );
    let anchor = arm.anchor.as_ref().expect("it hangs on the body");
    assert_eq!(
        (anchor.to, anchor.at.as_slice()),
        (0, &[Some(Point::new(1.0, 2.0)), Some(Point::new(3.0, 4.0)), None][..])
    );
    let orders: Vec<&[usize]> = scene.poses.iter().map(|pose| pose.draw_order.as_slice()).collect();
    assert_eq!(orders, [[0, 1], [1, 0], [0, 1], [0, 1]]);
}

#[test]
fn what_does_not_fit_is_refused_with_its_line_and_remedy() {
    let without = |text: &str, by: &str| {
        assert!(LAYERED.contains(text), "{text}");
        LAYERED.replacen(text, by, 1)
    };
    for (text, line, word) in [
        (without("name = \"arm\"", "name = \"body\""), 9, "used twice"),
        (without("arm = \"a-arm.png\"", "leg = \"a.png\""), 13, "'leg'"),
        (
            without("element = { body = \"torso\", arm = \"left\" }\n", ""),
            17,
            "one drawing for all layers",
        ),
        (
            without("source = { body = \"c.svg\" }", "source = {}"),
            22,
            "has no layer",
        ),
        (without(", layer = \"arm\" }", " }"), 28, "names no layer"),
        (
            without("layer = \"body\"\nat = { a = [9", "at = { a = [9"),
            31,
            "which layer",
        ),
        (
            without("at = \"shoulder\"", "at = \"foot\""),
            10,
            "no such [[landmark]]",
        ),
        (without("at = \"shoulder\"", "at = \"elbow\""), 10, "pose 'b'"),
        (
            without("layer = \"body\", at", "layer = \"arm\", at"),
            8,
            "hangs on itself",
        ),
        (
            without("[\"arm\", \"body\"]", "[\"arm\"]"),
            20,
            "each layer of the pose once",
        ),
        (format!("{TWO}order = [\"arm\"]\n"), 10, "the scene has no [[layer]]"),
        (
            format!("{TWO}[[pose]]\nname = \"c\"\nsource = {{ body = \"c.svg\" }}\nat = [5, 5]\n"),
            12,
            "no [[layer]]",
        ),
    ] {
        let (found, message) = refused(&text);
        assert!(message.contains(word), "{message}");
        assert_eq!(found, Some(line), "{message}");
    }
}
