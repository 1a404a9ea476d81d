//! `inbetween separate`: loose parts written as a scene in layers.

use inbetween::export::png_bytes;
use inbetween::render::Frame;
use inbetween::scene::Scene;

use crate::workshop::Workshop;

/// A body, a hat that floats over it, and beside it a ball that only the second pose has; 120 x 120 on nothing.
fn juggler(workshop: &Workshop) {
    let drawn = |x: f64, hat: f64, ball: bool| {
        let mut frame = Frame::filled(120, 120, [0; 4]);
        for (k, pixel) in frame.pixels.iter_mut().enumerate() {
            let (px, py) = ((k % 120) as f64 + 0.5, (k / 120) as f64 + 0.5);
            let within =
                |middle: (f64, f64), half: (f64, f64)| ((px - middle.0) / half.0).hypot((py - middle.1) / half.1) < 1.0;
            if within((x, 80.0), (18.0, 30.0)) {
                *pixel = if py < 70.0 {
                    [240, 190, 150, 255]
                } else {
                    [30, 30, 60, 255]
                };
            } else if within((x + 3.0, hat), (14.0, 8.0)) {
                *pixel = [60, 120, 60, 255];
            } else if ball && within((100.0, 60.0), (9.0, 9.0)) {
                *pixel = [210, 40, 40, 255];
            }
        }
        png_bytes(&frame).expect("a PNG")
    };
    workshop.file("stand.png", &drawn(50.0, 34.0, false));
    workshop.file("juggle.png", &drawn(60.0, 26.0, true));
    workshop.scene(
        "# Two poses.\n[[pose]]\nname = \"stand\"\nsource = \"stand.png\"\nat = [0, 0]\n\
         [[pose]]\nname = \"juggle\"\nsource = \"juggle.png\"\nat = [1, 0]\n\
         [[landmark]]\nname = \"brim\"\nat = { stand = [53.0, 34.0], juggle = [63.0, 26.0] }\n\
         [[landmark]]\nname = \"foot\"\nat = { stand = [50.0, 110.0], juggle = [60.0, 110.0] }\n",
    );
}

fn frame(workshop: &Workshop, scene: &str, weights: [f64; 2]) -> Frame {
    let scene = Scene::open(&workshop.path(scene)).expect("a scene");
    let character = scene.character([120, 120], 1).expect("a character");
    character.frame_of(&weights).expect("a frame")
}

/// The mean difference of two frames' channels, of 255.
fn difference(a: &Frame, b: &Frame) -> f64 {
    assert_eq!(a.pixels.len(), b.pixels.len());
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / (4 * a.pixels.len()) as f64
}

#[test]
fn what_was_found_is_a_scene_in_layers_that_shows_the_same() {
    let workshop = Workshop::new();
    juggler(&workshop);
    workshop.succeeds(&["separate", "scene.toml", "-o", "apart"]);
    let text = std::fs::read_to_string(workshop.path("apart/scene.toml")).expect("a scene");
    assert!(text.contains("# Two poses."), "{text}");
    let scene = Scene::open(&workshop.path("apart/scene.toml")).expect("a scene");
    let poses: Vec<usize> = scene.layers.iter().map(|layer| layer.poses.len()).collect();
    assert_eq!(poses.len(), 3);
    assert_eq!(
        poses.iter().sum::<usize>(),
        5,
        "the ball is in one pose only: {poses:?}"
    );
    // Landmarks went with what they lie on.
    let on: Vec<Option<usize>> = scene.landmarks.iter().map(|landmark| landmark.layer).collect();
    assert!(on.iter().all(Option::is_some) && on[0] != on[1], "{on:?}");
    for weights in [[1.0, 0.0], [0.0, 1.0]] {
        let whole = frame(&workshop, "scene.toml", weights);
        let apart = frame(&workshop, "apart/scene.toml", weights);
        let mean = difference(&whole, &apart);
        assert!(mean < 0.2, "{mean} at {weights:?}");
    }
}

#[test]
fn vector_drawings_are_written_as_vector_drawings() {
    let workshop = Workshop::new();
    let drawing = |dot: u32| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-10 0 120.5 200\" width=\"120.5\" height=\"200\">\
             <circle id=\"dot\" cx=\"50\" cy=\"{dot}\" r=\"15\" fill=\"#c33\"/>\
             <rect id=\"stem\" x=\"35\" y=\"70\" width=\"30\" height=\"100\" fill=\"#224\"/></svg>"
        )
    };
    workshop.file("low.svg", drawing(45).as_bytes());
    workshop.file("high.svg", drawing(25).as_bytes());
    workshop.scene(
        "[[pose]]\nname = \"low\"\nsource = \"low.svg\"\nat = [0, 0]\n\
         [[pose]]\nname = \"high\"\nsource = \"high.svg\"\nat = [1, 0]\n",
    );
    workshop.succeeds(&["separate", "scene.toml", "-o", "apart"]);
    let dot = std::fs::read_to_string(workshop.path("apart/high-dot.svg")).expect("a drawing");
    assert!(
        dot.contains("viewBox=\"-10 0 120.5 200\"") && dot.contains("id=\"dot\"") && !dot.contains("stem"),
        "{dot}"
    );
    let whole = frame(&workshop, "scene.toml", [0.0, 1.0]);
    let apart = frame(&workshop, "apart/scene.toml", [0.0, 1.0]);
    let mean = difference(&whole, &apart);
    assert!(mean < 0.2, "{mean}");
}

#[test]
fn nothing_is_separated_twice_or_written_over() {
    let workshop = Workshop::new();
    juggler(&workshop);
    workshop.succeeds(&["separate", "scene.toml", "-o", "apart"]);
    let again = workshop.fails(&["separate", "scene.toml", "-o", "apart"], 1);
    assert!(again.contains("--force"), "{again}");
    workshop.succeeds(&["separate", "scene.toml", "-o", "apart", "--force"]);
    let layered = workshop.fails(&["separate", "apart/scene.toml", "-o", "twice"], 1);
    assert!(layered.contains("has layers already"), "{layered}");
    assert!(!workshop.path("twice").exists());
    workshop.two_poses("[0, 0]", "[1, 0]", "");
    let whole = workshop.fails(&["separate", "scene.toml", "-o", "whole"], 1);
    assert!(whole.contains("no loose parts"), "{whole}");
    assert!(!workshop.path("whole").exists());
}
