//! Layered files as drawings of scenes: what their layers mean, and the frames that they give.

use inbetween::scene::Scene;

use super::art::{Content, Node, Patch, SIZE, ellipse, poses};
use super::picture::png;
use super::pixels::on_canvas;
use super::{ase, psd};
use crate::workshop::Workshop;

/// The names of a scene's poses, and of its layers with the poses that have them.
fn shape(workshop: &Workshop, scene: &str) -> (Vec<String>, Vec<(String, Vec<usize>)>) {
    let scene = Scene::open(&workshop.path(scene)).expect("a scene");
    let layers = scene.layers.iter();
    let layers = layers.map(|layer| (layer.name.clone(), layer.poses.clone())).collect();
    (scene.names(), layers)
}

fn with_all(names: &[&str], poses: &[usize]) -> Vec<(String, Vec<usize>)> {
    names.iter().map(|name| ((*name).to_owned(), poses.to_vec())).collect()
}

/// A layer on the whole canvas as a PNG file.
fn canvas_png(patch: &Patch<[u8; 4]>) -> Vec<u8> {
    let pixels = on_canvas(patch);
    png(&Patch::new([0, 0], SIZE, |x, y| {
        pixels[(y as u32 * SIZE[0] + x as u32) as usize]
    }))
}

/// The pixels of some frames of a scene: the files also say of which scene they are.
fn frames(workshop: &Workshop, scene: &str) -> Vec<Vec<u8>> {
    let out = scene.replace('.', "-");
    workshop.succeeds(&["render", scene, "-o", &out, "--frames", "1,9,20", "--size", "64x48"]);
    let entries = std::fs::read_dir(workshop.path(&out)).expect("a folder");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    let pixels = files
        .iter()
        .map(|file| image::open(file).expect("a frame").into_rgba8().into_raw());
    pixels.collect()
}

/// Makes a scene of a file in every format and one of a PNG file a pose and part, and holds their frames against one another.
#[test]
fn all_formats_give_the_frames_of_single_pictures() {
    let workshop = Workshop::new();
    let art = poses();
    let files = super::in_all_formats(&art);
    let mut scenes = Vec::new();
    for (kind, bytes) in &files {
        let file = format!("hero.{kind}");
        workshop.file(&file, bytes);
        workshop.succeeds(&["new", kind, &file]);
        let found = shape(&workshop, &format!("{kind}/scene.toml"));
        assert_eq!(found.0, ["stand", "lean", "wave"], "{kind}");
        assert_eq!(found.1, with_all(&["body", "arm"], &[0, 1, 2]), "{kind}");
        let text = std::fs::read_to_string(workshop.path(&format!("{kind}/scene.toml"))).expect("text");
        // All in one folder, so that frames have the same names.
        workshop.file(&format!("{kind}.toml"), text.as_bytes());
        scenes.push((format!("{kind}.toml"), text.replace(&file, "hero")));
    }
    for pair in scenes.windows(2) {
        assert_eq!(pair[0].1, pair[1].1, "{} and {}", pair[0].0, pair[1].0);
    }
    let mut single = scenes[0].1.clone();
    for group in &art {
        let Content::Group(children) = &group.content else {
            continue;
        };
        let mut sources = Vec::new();
        for child in children {
            let Content::Pixels(patch) = &child.content else {
                continue;
            };
            let file = format!("{}-{}.png", group.name, child.name);
            workshop.file(&file, &canvas_png(patch));
            sources.push(format!("{} = \"{file}\"", child.name));
        }
        let name = &group.name;
        let element = format!("source = \"hero\"\nelement = {{ body = \"{name}/body\", arm = \"{name}/arm\" }}");
        assert!(single.contains(&element), "{single}");
        single = single.replace(&element, &format!("source = {{ {} }}", sources.join(", ")));
    }
    workshop.file("png.toml", single.as_bytes());
    let expected = frames(&workshop, "png.toml");
    assert_eq!(expected.len(), 3);
    for (scene, _) in &scenes {
        assert!(frames(&workshop, scene) == expected, "the frames of {scene} differ");
    }
}

/// Parts as groups of which one drawing is shown, a paper behind them, and a layer beside them.
fn part_groups() -> Vec<Node> {
    let part = |name: &str, centre: [f64; 2], step: [f64; 2], colour: [u8; 3]| {
        let drawings = ["stand", "reach"].iter().enumerate().map(|(k, pose)| {
            let shift = k as f64;
            let drawing = ellipse(
                [centre[0] + shift * step[0], centre[1] + shift * step[1]],
                [18.0, 9.0],
                colour,
            );
            let mut layer = Node::layer(pose, drawing);
            layer.is_visible = k == 0;
            layer
        });
        Node::group(name, drawings.collect())
    };
    vec![
        Node::layer("paper", Patch::new([0, 0], SIZE, |_, _| [255; 4])),
        part("body", [40.0, 50.0], [4.0, 0.0], [200, 40, 40]),
        part("arm", [50.0, 30.0], [6.0, -8.0], [40, 90, 200]),
        Node::layer("sketch", ellipse([20.0, 20.0], [9.0, 9.0], [0, 0, 0])),
    ]
}

#[test]
fn what_layers_mean_is_found_and_can_be_said() {
    let workshop = Workshop::new();
    workshop.file("parts.psd", &psd::write(SIZE, &part_groups(), psd::Options::default()));
    let told = |arguments: &[&str]| {
        let output = workshop.run(arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{message}");
        message
    };
    let message = told(&["new", "found", "parts.psd"]);
    let expected = (
        vec!["stand".to_owned(), "reach".to_owned()],
        with_all(&["body", "arm"], &[0, 1]),
    );
    assert_eq!(shape(&workshop, "found/scene.toml"), expected);
    for word in [
        "'paper' is bare paper",
        "sketch is in no group",
        "stand, reach",
        "body, arm",
        "--layers",
    ] {
        assert!(message.contains(word), "{word}: {message}");
    }
    told(&["new", "said", "parts.psd", "--layers", "pose-groups"]);
    // Hidden parts do not count, and one part is the whole drawing.
    assert_eq!(
        shape(&workshop, "said/scene.toml"),
        (vec!["body".to_owned(), "arm".to_owned()], Vec::new())
    );
    let text = std::fs::read_to_string(workshop.path("said/scene.toml")).expect("text");
    assert!(text.contains("element = \"body/stand\""), "{text}");
    told(&["new", "flat", "parts.psd", "--layers", "pose-layers"]);
    assert_eq!(shape(&workshop, "flat/scene.toml").0, ["body", "arm", "sketch"]);
}

#[test]
fn files_are_poses_whose_layers_correspond_by_name() {
    let workshop = Workshop::new();
    let pose = |shift: f64, hat: bool| {
        let mut nodes = vec![
            Node::layer("body", ellipse([40.0 + shift, 45.0], [20.0, 18.0], [200, 40, 40])),
            Node::layer(
                "head",
                ellipse([42.0 + 2.0 * shift, 22.0], [12.0, 11.0], [230, 190, 160]),
            ),
        ];
        if hat {
            nodes.push(Node::layer(
                "hat",
                ellipse([44.0 + 2.0 * shift, 12.0], [13.0, 6.0], [40, 40, 40]),
            ));
        } else {
            // In front of the head as it is elsewhere.
            nodes.swap(0, 1);
        }
        psd::write(SIZE, &nodes, psd::Options::default())
    };
    workshop.file("walk10.psd", &pose(6.0, false));
    workshop.file("walk2.psd", &pose(0.0, true));
    workshop.succeeds(&["new", "walk", "walk10.psd", "walk2.psd"]);
    let (names, layers) = shape(&workshop, "walk/scene.toml");
    assert_eq!(names, ["walk2", "walk10"]);
    let expected = [("body", vec![0, 1]), ("head", vec![0, 1]), ("hat", vec![0])];
    assert_eq!(layers, expected.map(|(name, poses)| (name.to_owned(), poses)));
    let scene = Scene::open(&workshop.path("walk/scene.toml")).expect("a scene");
    assert_eq!(scene.poses[1].draw_order, [1, 0, 2]);
}

#[test]
fn flat_layers_are_poses_and_a_pose_may_be_a_group() {
    let workshop = Workshop::new();
    let nodes = [
        Node::layer("one", ellipse([40.0, 40.0], [20.0, 10.0], [200, 40, 40])),
        Node::layer("two", ellipse([45.0, 40.0], [10.0, 20.0], [200, 40, 40])),
    ];
    workshop.file("flat.psd", &psd::write(SIZE, &nodes, psd::Options::default()));
    workshop.succeeds(&["new", "flat", "flat.psd"]);
    assert_eq!(
        shape(&workshop, "flat/scene.toml"),
        (vec!["one".to_owned(), "two".to_owned()], Vec::new())
    );
    // A group as the drawing of a pose is what its picture is.
    workshop.file("hero.psd", &psd::write(SIZE, &poses(), psd::Options::default()));
    workshop.scene(
        "[[pose]]\nname = \"a\"\nsource = \"hero.psd\"\nelement = \"stand\"\nat = [0, 0]\n[[pose]]\nname = \"b\"\nsource = \"hero.psd\"\n\
         element = \"wave\"\nat = [1, 0]\n",
    );
    workshop.succeeds(&["map", "scene.toml", "-o", "map.json"]);
    workshop.scene("[[pose]]\nname = \"a\"\nsource = \"hero.psd\"\nelement = \"stand/leg\"\n");
    let refusal = workshop.fails(&["map", "scene.toml", "-o", "-"], 1);
    for word in [
        "scene.toml:4",
        "hero.psd",
        "no layer or group 'stand/leg'",
        "stand/body",
    ] {
        assert!(refusal.contains(word), "{word}: {refusal}");
    }
    workshop.picture("one.png", |x, y| if x + y < 40 { [9, 9, 9, 255] } else { [0; 4] });
    workshop.scene("[[pose]]\nname = \"a\"\nsource = \"one.png\"\nelement = \"stand\"\n");
    let refusal = workshop.fails(&["map", "scene.toml", "-o", "-"], 1);
    assert!(refusal.contains("no layers"), "{refusal}");
    let refusal = workshop.fails(&["new", "mixed", "one.png", "hero.psd", "--layers", "pose-groups"], 1);
    assert!(refusal.contains("not all drawings"), "{refusal}");
}

#[test]
fn frames_are_poses_and_layers_their_parts() {
    let drawn = |shift: f64| {
        let body = ellipse([40.0 + shift, 45.0], [20.0, 18.0 - shift], [200, 40, 40]);
        let arm = ellipse([50.0 + shift, 30.0 - shift], [18.0, 8.0], [40, 90, 200]);
        vec![ase::Drawn::Patch(body), ase::Drawn::Patch(arm)]
    };
    let frames = vec![
        drawn(0.0),
        drawn(6.0),
        vec![ase::Drawn::Linked(0), ase::Drawn::Linked(0)],
        vec![ase::Drawn::Nothing, ase::Drawn::Nothing],
        drawn(3.0),
    ];
    let workshop = Workshop::new();
    let tags = [("wait", 0, 0), ("go", 1, 4)];
    workshop.file(
        "hero.aseprite",
        &ase::write_frames(SIZE, &["body", "arm"], &frames, &tags),
    );
    let output = workshop.run(&["new", "hero", "hero.aseprite"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(
        message.contains("3 of 5 frames are poses; 1 are empty, 1 repeat"),
        "{message}"
    );
    let (names, layers) = shape(&workshop, "hero/scene.toml");
    assert_eq!(names, ["wait", "go-1", "go-4"]);
    assert_eq!(layers, with_all(&["body", "arm"], &[0, 1, 2]));
    let text = std::fs::read_to_string(workshop.path("hero/scene.toml")).expect("text");
    assert!(
        text.contains("frame = 4\nelement = { body = \"body\", arm = \"arm\" }"),
        "{text}"
    );
    workshop.succeeds(&["frame", "hero/scene.toml", "--weights", "0,0,1", "-o", "frame.png"]);
}
