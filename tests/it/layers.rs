//! The scene with layers: an arm that crosses the chest, and a flower that is not always there.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::workshop::Workshop;
use inbetween::math::Point;
use inbetween::pipeline::{Character, Posed, ShapePoint};
use inbetween::render::{Camera, Frame};
use inbetween::scene::Scene;
use resvg::tiny_skia::{Pixmap, Transform};

const SIZE: [usize; 2] = [240, 270];
/// From how much a difference of a pixel counts, in 255ths.
const VISIBLE: u8 = 32;
/// How many of the drawn pixels may differ visibly from the drawing.
const UNLIKE_SHARE: f64 = 0.01;

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/bear/scene.toml")
}

/// Mapped once for all tests.
static BEAR: LazyLock<(Scene, Character)> = LazyLock::new(|| {
    let scene = Scene::open(&file()).expect("a scene");
    let character = scene.character(SIZE, 1).expect("a character");
    (scene, character)
});

fn index_of(scene: &Scene, name: &str) -> usize {
    let found = scene.layers.iter().position(|layer| layer.name == name);
    found.expect("a layer")
}

fn posed_like(scene: &Scene, character: &Character, name: &str) -> Posed {
    let pose = scene.poses.iter().find(|pose| pose.name == name).expect("a pose");
    character.posed_at(&pose.at).expect("a place")
}

/// The layers' names from back to front.
fn order(scene: &Scene, posed: &Posed) -> Vec<String> {
    posed.order.iter().map(|&k| scene.layers[k].name.clone()).collect()
}

/// A pose's whole drawing in one go, by the renderer itself, before white.
fn drawn_whole(file: &Path, camera: &Camera) -> Frame {
    let text = std::fs::read_to_string(file).expect("a drawing");
    let tree = resvg::usvg::Tree::from_str(&text, &resvg::usvg::Options::default()).expect("an SVG");
    let [columns, rows] = camera.size();
    let mut pixmap = Pixmap::new(columns as u32, rows as u32).expect("a size");
    let origin = camera.to_pixels(Point::new(0.0, 0.0));
    let scale = camera.scale() as f32;
    let transform = Transform::from_row(scale, 0.0, 0.0, scale, origin.x as f32, origin.y as f32);
    resvg::render(&tree, transform, &mut pixmap.as_mut());
    let mut frame = Frame::filled(columns, rows, [0; 4]);
    for (to, from) in frame.pixels.iter_mut().zip(pixmap.pixels()) {
        // Premultiplied colour before white.
        let over = |c: u8| c + (255 - from.alpha());
        *to = [over(from.red()), over(from.green()), over(from.blue()), 255];
    }
    frame
}

#[test]
fn each_layer_is_mapped_and_hangs_where_the_scene_says() {
    let (scene, character) = &*BEAR;
    let names: Vec<&str> = character.layers().iter().map(|layer| layer.name()).collect();
    assert_eq!(names, ["far_arm", "flower", "body", "arm"]);
    for (k, shape) in character.layers().iter().enumerate() {
        shape.mapping().check().expect("a valid mapping");
        assert_eq!(shape.poses(), scene.layers[k].poses);
    }
    let all: Vec<usize> = (0..scene.poses.len()).collect();
    assert_eq!(scene.layers[index_of(scene, "arm")].poses, all);
    let with_flower: Vec<&str> = (scene.layers[index_of(scene, "flower")].poses.iter())
        .map(|&pose| scene.poses[pose].name.as_str())
        .collect();
    assert_eq!(with_flower, ["behind", "wave", "offer"]);
    assert!(character.notes().is_empty(), "{:?}", character.notes());
}

#[test]
fn every_pose_looks_as_it_was_drawn() {
    let (scene, character) = &*BEAR;
    for pose in &scene.poses {
        let frame = character.frame_at(&pose.at).expect("a frame");
        let svg = file().with_file_name(format!("{}.svg", pose.name));
        let whole = drawn_whole(&svg, character.camera());
        let (mut unlike, mut drawn) = (0, 0);
        for (own, other) in frame.pixels.iter().zip(&whole.pixels) {
            let difference = own.iter().zip(other).map(|(a, b)| a.abs_diff(*b)).max();
            unlike += usize::from(difference > Some(VISIBLE));
            drawn += usize::from(*other != [255; 4]);
        }
        assert!(drawn > 10_000, "{}: {drawn}", pose.name);
        let share = unlike as f64 / drawn as f64;
        assert!(share < UNLIKE_SHARE, "{}: {unlike} of {drawn} pixels differ", pose.name);
    }
}

#[test]
fn what_hangs_on_a_layer_stays_there() {
    let (scene, character) = &*BEAR;
    let mut ties = Vec::new();
    for (own, layer) in scene.layers.iter().enumerate() {
        let Some(anchor) = &layer.anchor else { continue };
        let places: Vec<Point> = anchor.at.iter().map(|at| at.expect("a drawing's")).collect();
        let poses = &character.layers()[own].mapping().poses;
        let on_own = ShapePoint::new(poses, &places).expect("a mesh");
        // On the other layer, which has every pose here.
        let other = &character.layers()[anchor.to];
        let everywhere: Vec<Point> = (other.poses().iter())
            .map(|pose| match layer.poses.iter().position(|p| p == pose) {
                Some(k) => places[k],
                None => places[0],
            })
            .collect();
        let on_other = ShapePoint::new(&other.mapping().poses, &everywhere).expect("a mesh");
        ties.push((own, anchor.to, on_own, on_other));
    }
    assert_eq!(ties.len(), 3);
    let mut seen_turning = 0.0_f64;
    for index in 0..scene.animation.frame_count() {
        let posed = character.posed(&scene.animation, index).expect("a frame");
        for (own, to, on_own, on_other) in &ties {
            let (layer, other) = (&posed.layers[*own], &posed.layers[*to]);
            // The poses that the layer lacks do not count.
            let mut weights = vec![0.0; other.weights.len()];
            for (k, &pose) in scene.layers[*own].poses.iter().enumerate() {
                weights[pose] = layer.weights[k];
            }
            let gap = on_own.at(&layer.positions, &layer.weights) - on_other.at(&other.positions, &weights);
            assert!(gap.norm() < 1e-9, "frame {index}, layer {own}: {}", gap.norm());
        }
        let arm = &posed.layers[index_of(scene, "arm")].positions;
        let rest = &character.layers()[index_of(scene, "arm")].mapping().poses.positions()[0];
        let moved = arm.iter().zip(rest).map(|(p, q)| (p - q).norm());
        seen_turning = moved.fold(seen_turning, f64::max);
        assert_eq!(posed.flipped(), 0, "frame {index}");
    }
    // It is the whole arm that swings, by more than its own length.
    assert!(seen_turning > 250.0, "{seen_turning}");
}

#[test]
fn a_layer_fades_where_poses_lack_it_and_never_jumps() {
    let (scene, character) = &*BEAR;
    let flower = index_of(scene, "flower");
    let opacity = |place: &[f64]| character.posed_at(place).expect("a place").layers[flower].opacity;
    for (name, expected) in [
        ("rest", 0.0),
        ("heart", 0.0),
        ("bow", 0.0),
        ("behind", 1.0),
        ("wave", 1.0),
        ("offer", 1.0),
    ] {
        let found = posed_like(scene, character, name).layers[flower].opacity;
        assert!((found - expected).abs() < 1e-9, "{name}: {found}");
    }
    let steps = 400;
    let path: Vec<f64> = (0..=steps)
        .map(|k| opacity(&[-f64::from(k) / f64::from(steps), 0.0]))
        .collect();
    let largest = path
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .fold(0.0, f64::max);
    assert!(largest < 0.03, "{largest}");
    assert!(path.iter().any(|o| (0.3..0.7).contains(o)), "it fades");
    // All other layers are in every pose.
    let posed = posed_like(scene, character, "bow");
    for (k, layer) in posed.layers.iter().enumerate() {
        assert_eq!(layer.opacity == 1.0, k != flower);
    }
}

#[test]
fn the_strongest_drawing_says_what_is_in_front() {
    let (scene, character) = &*BEAR;
    let of = |name: &str| order(scene, &posed_like(scene, character, name));
    assert_eq!(of("rest"), ["far_arm", "flower", "body", "arm"]);
    assert_eq!(of("heart"), ["far_arm", "flower", "body", "arm"]);
    assert_eq!(of("behind"), ["far_arm", "flower", "arm", "body"]);
    assert_eq!(of("offer"), ["far_arm", "body", "flower", "arm"]);
    // On the way behind the back the arm changes sides once, where that drawing becomes the strongest.
    let behind = scene
        .poses
        .iter()
        .position(|pose| pose.name == "behind")
        .expect("a pose");
    let body = index_of(scene, "body");
    let mut changes = 0;
    let mut before = false;
    for k in 0..=100 {
        let posed = character.posed_at(&[-0.01 * f64::from(k), 0.0]).expect("a place");
        let is_behind = order(scene, &posed).ends_with(&["body".to_owned()]);
        let seen = &posed.layers[body].texture_weights;
        let strongest = (0..seen.len()).all(|pose| seen[pose] <= seen[behind]);
        assert_eq!(is_behind, strongest, "{k}");
        changes += usize::from(is_behind != before);
        before = is_behind;
    }
    assert_eq!(changes, 1);
}

#[test]
fn the_command_maps_one_layer_and_asks_which() {
    let workshop = Workshop::new();
    let scene = file().display().to_string();
    workshop.succeeds(&["map", &scene, "--layer", "arm", "-o", "arm.json"]);
    let report = workshop.succeeds(&["check", "arm.json"]);
    assert!(!report.is_empty());
    for (arguments, words) in [
        (
            vec!["map", &scene, "-o", "x.json"],
            ["--layer", "'far_arm', 'flower', 'body', 'arm'"],
        ),
        (
            vec!["map", &scene, "--layer", "leg", "-o", "x.json"],
            ["no layer 'leg'", "'arm'"],
        ),
    ] {
        let output = workshop.run(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{message}");
        for word in words {
            assert!(message.contains(word), "{message}");
        }
        assert!(!workshop.path("x.json").exists());
    }
}

#[test]
fn frames_are_the_same_for_any_number_of_threads() {
    let workshop = Workshop::new();
    let scene = file().display().to_string();
    for threads in ["1", "3"] {
        workshop.succeeds(&[
            "render",
            &scene,
            "-o",
            threads,
            "--frames",
            "12,70-71",
            "--size",
            "96x108",
            "--threads",
            threads,
        ]);
    }
    let mut names: Vec<_> = std::fs::read_dir(workshop.path("1"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name())
        .filter(|name| Path::new(name).extension().is_some_and(|kind| kind == "png"))
        .collect();
    names.sort();
    assert_eq!(names.len(), 3);
    for name in names {
        let bytes = |folder: &str| std::fs::read(workshop.path(folder).join(&name)).expect("a frame");
        assert!(bytes("1") == bytes("3"), "{}", name.display());
    }
}

#[test]
fn a_reflected_pose_reflects_its_layers_together() {
    let workshop = Workshop::new();
    let boxed = |name: &str, columns: std::ops::Range<u32>, rows: std::ops::Range<u32>, colour: [u8; 4]| {
        workshop.picture(name, |x, y| {
            if columns.contains(&x) && rows.contains(&y) {
                colour
            } else {
                [0; 4]
            }
        });
    };
    boxed("body.png", 10..20, 8..32, [200, 40, 40, 255]);
    boxed("arm.png", 22..34, 14..20, [40, 40, 200, 255]);
    let pose = |name: &str, at: u32, more: &str| {
        format!(
            "[[pose]]\nname = \"{name}\"\nsource = {{ body = \"body.png\", arm = \"arm.png\" }}\nat = [{at}, 0]\n{more}"
        )
    };
    let layers = "[[layer]]\nname = \"body\"\n[[layer]]\nname = \"arm\"\n[animation]\ncamera = \"drawing\"\n";
    workshop.scene(&format!(
        "{}{}{layers}",
        pose("a", 0, ""),
        pose("b", 1, "mirror = true\n")
    ));
    let scene = Scene::open(&workshop.path("scene.toml")).expect("a scene");
    let character = scene.character([40, 40], 1).expect("a character");
    let [drawn, reflected] = [[1.0, 0.0], [0.0, 1.0]].map(|weights| character.frame_of(&weights).expect("a frame"));
    // The figure reaches from column 10 to 34, and stays there.
    for (k, pixel) in drawn.pixels.iter().enumerate() {
        let (x, y) = (k % 40, k / 40);
        let other = if (4..44).contains(&x) {
            reflected.pixels[y * 40 + 43 - x]
        } else {
            [0; 4]
        };
        let off = pixel.iter().zip(other).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off <= Some(40), "{pixel:?} and {other:?} at ({x}, {y})");
    }
}
