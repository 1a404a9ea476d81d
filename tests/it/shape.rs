//! `inbetween shape` does what its help says, on a bar of quadrangles that bends and grows fat.

use std::fmt::Write as _;

use crate::workshop::Workshop;

/// Rings of the bar, each with four corners.
const RINGS: usize = 9;
const PLACES: [(&str, [f64; 2]); 3] = [("straight", [0.0, 0.0]), ("bent", [1.0, 0.0]), ("fat", [0.0, 1.0])];

type Vertex = [f64; 3];

/// The bar along x from 0 to 4, bent by a right angle about its middle as an artist would, `half` thick.
fn bar(bend: f64, half: f64) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    let (mut x, mut y) = (0.0, 0.0);
    for ring in 0..RINGS {
        let angle = bend * std::f64::consts::FRAC_PI_2 * share(ring);
        let (sin, cos) = angle.sin_cos();
        for [up, side] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            vertices.push([x - sin * up * half, y + cos * up * half, side * half]);
        }
        (x, y) = (x + 0.5 * cos, y + 0.5 * sin);
    }
    vertices
}

/// How much a ring follows the forearm.
fn share(ring: usize) -> f64 {
    ((ring as f64 - 2.0) / (RINGS as f64 - 5.0)).clamp(0.0, 1.0)
}

/// The text of an OBJ file; texture coordinates have a seam along the bar.
fn obj(vertices: &[Vertex], textured: bool) -> String {
    let mut text = String::new();
    for [x, y, z] in vertices {
        let _ = writeln!(text, "v {x:.5} {y:.5} {z:.5}");
    }
    for ring in 0..RINGS {
        for corner in 0..5 {
            let _ = writeln!(
                text,
                "vt {} {}",
                ring as f64 / (RINGS - 1) as f64,
                f64::from(corner) / 4.0
            );
        }
    }
    let corner = |ring: usize, k: usize| match textured {
        true => format!(" {}/{}", 4 * ring + k % 4 + 1, 5 * ring + k + 1),
        false => format!(" {}", 4 * ring + k % 4 + 1),
    };
    for ring in 0..RINGS - 1 {
        for k in 0..4 {
            let corners = [
                corner(ring, k),
                corner(ring, k + 1),
                corner(ring + 1, k + 1),
                corner(ring + 1, k),
            ];
            let _ = writeln!(text, "f{}", corners.concat());
        }
    }
    text
}

fn vertices_of(text: &str) -> Vec<Vertex> {
    let numbers = |line: &str| -> Vec<f64> { line.split(' ').skip(1).map(|n| n.parse().expect("a number")).collect() };
    let lines = text.lines().filter(|line| line.starts_with("v "));
    lines.map(|line| numbers(line).try_into().expect("three")).collect()
}

fn farthest(a: &[Vertex], b: &[Vertex]) -> f64 {
    assert_eq!(a.len(), b.len());
    let apart = |(a, b): (&Vertex, &Vertex)| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    a.iter().zip(b).map(apart).fold(0.0, f64::max)
}

const SKELETON: &str = "[skeleton]\nweights = \"weights.json\"\n\
    [[skeleton.joint]]\nname = \"upper\"\norigin = [0.0, 0.0, 0.0]\n\
    [[skeleton.joint]]\nname = \"forearm\"\nparent = \"upper\"\norigin = [2.0, 0.0, 0.0]\n\
    turns = [ { adjective = \"bend\", axis = [0.0, 0.0, 1.0], degrees = 90.0 } ]\n";
const ANIMATION: &str = "[animation]\nfps = 8\nkeys = [\n\
    { time = 0.0, at = { bend = 0.0, size = 0.0 } },\n\
    { time = 1.0, at = { bend = 1.0, size = 0.0 } },\n\
    { time = 2.0, at = { bend = 1.2, size = 1.0 } } ]\n";

/// The forms, and a scene of them with `more` at its end; `of_example` is added to each example.
fn workshop(of_example: impl Fn(&str) -> String, more: &str) -> Workshop {
    let workshop = Workshop::new();
    let forms = [bar(0.0, 0.3), bar(1.0, 0.35), bar(0.0, 0.6)];
    let mut scene = "adjectives = [\"bend\", \"size\"]\n".to_owned();
    for ((name, [bend, size]), form) in PLACES.iter().zip(&forms) {
        workshop.file(&format!("{name}.obj"), obj(form, true).as_bytes());
        let _ = write!(
            scene,
            "[[example]]\nname = \"{name}\"\nform = \"{name}.obj\"\nat = {{ bend = {bend:?}, size = {size:?} }}\n{}",
            of_example(name)
        );
    }
    let weights: Vec<String> = (0..4 * RINGS)
        .map(|v| format!("[[0, {}], [1, {}]]", 1.0 - share(v / 4), share(v / 4)))
        .collect();
    let weights = format!(
        "{{\"joints\": [\"upper\", \"forearm\"], \"weights\": [{}]}}",
        weights.join(", ")
    );
    workshop.file("weights.json", weights.as_bytes());
    workshop.scene(&format!("{scene}{more}"));
    workshop
}

fn text(workshop: &Workshop, name: &str) -> String {
    std::fs::read_to_string(workshop.path(name)).expect(name)
}

fn form_at(workshop: &Workshop, [bend, size]: [f64; 2]) -> String {
    let at = format!("{bend},{size}");
    workshop.succeeds(&["shape", "render", "scene.toml", "--at", &at, "-o", "form.obj"]);
    text(workshop, "form.obj")
}

#[test]
fn every_example_is_met_and_quadrangles_stay() {
    let grows = "shifts = [ { adjective = \"size\", by = [0.3, 0.0, 0.1] } ]\n\
        scalings = [ { adjective = \"size\", factors = [1.2, 1.5, 1.5] } ]\n";
    for more in ["".to_owned(), SKELETON.to_owned(), format!("{SKELETON}{grows}")].map(|s| s + ANIMATION) {
        let workshop = workshop(|_| String::new(), &more);
        for (name, at) in PLACES {
            let (found, wanted) = (form_at(&workshop, at), text(&workshop, &format!("{name}.obj")));
            assert!(farthest(&vertices_of(&found), &vertices_of(&wanted)) < 1e-9, "{name}");
            let faces = |text: &str| -> Vec<String> {
                let lines = text.lines().filter(|l| l.starts_with("f ") || l.starts_with("vt "));
                lines.map(str::to_owned).collect()
            };
            assert_eq!(faces(&found), faces(&wanted));
        }
    }
}

#[test]
fn a_skeleton_bends_where_a_plain_blend_shrinks() {
    // Half way: the distance between the ends of a bar that bends like an arm.
    let ends = |more: &str| {
        let form = vertices_of(&form_at(&workshop(|_| String::new(), more), [0.5, 0.0]));
        let length = |k: usize| {
            let (a, b) = (form[4 * k], form[4 * (k + 1)]);
            ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt()
        };
        length(RINGS - 2)
    };
    // The last piece does not bend: it is half a unit long in every example.
    assert!((ends(&format!("{SKELETON}{ANIMATION}")) - 0.5).abs() < 1e-4);
    assert!((ends(ANIMATION) - 0.5 * 0.5_f64.sqrt()).abs() < 1e-4);
}

#[test]
fn subdivided_examples_are_met_with_a_skeleton_and_without() {
    let subdivided = "[subdivision]\nsteps = 2\n";
    let plain = workshop(|_| String::new(), &format!("{subdivided}{ANIMATION}"));
    let carried = workshop(|_| String::new(), &format!("{SKELETON}{subdivided}{ANIMATION}"));
    for (name, at) in PLACES {
        let (a, b) = (form_at(&plain, at), form_at(&carried, at));
        assert!(farthest(&vertices_of(&a), &vertices_of(&b)) < 1e-8, "{name}");
        assert_eq!(vertices_of(&a).len(), 528, "{name}");
        assert!(a.contains("\nvn ") && a.contains("\nvt "));
    }
}

#[test]
fn weights_are_cardinal_and_textures_have_their_own_place() {
    let workshop = workshop(
        |name| match name {
            "straight" => "texture = \"a.png\"\n".to_owned(),
            "bent" => "texture = \"b.png\"\ntexture_at = { bend = 2.0, size = 0.0 }\n".to_owned(),
            _ => String::new(),
        },
        ANIMATION,
    );
    workshop.picture("a.png", |_, _| [200, 10, 30, 255]);
    workshop.picture("b.png", |_, _| [20, 110, 230, 255]);
    let printed = workshop.succeeds(&[
        "shape",
        "weights",
        "scene.toml",
        "--at",
        "1,0",
        "--texture-at",
        "2,0",
        "--at=0.5,-3",
        "--texture-at=1,0",
    ]);
    let lines: Vec<serde_json::Value> = printed
        .lines()
        .map(|l| serde_json::from_str(l).expect("JSON"))
        .collect();
    let list = |line: usize, key: &str| -> Vec<f64> {
        let list = lines[line][key].as_array().expect("a list");
        list.iter().map(|n| n.as_f64().expect("a number")).collect()
    };
    let near = |found: Vec<f64>, wanted: [f64; 3]| {
        assert!(
            found.len() == 3 && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12),
            "{found:?}"
        );
    };
    near(list(0, "weights"), [0.0, 1.0, 0.0]);
    near(list(0, "texture_weights"), [0.0, 1.0, 0.0]);
    near(list(1, "texture_weights"), [0.5, 0.5, 0.0]);
    assert!((list(1, "weights").iter().sum::<f64>() - 1.0).abs() < 1e-12);

    // Geometry of one example with the texture of another.
    let arguments = [
        "shape",
        "render",
        "scene.toml",
        "--at",
        "0,0",
        "--texture-at",
        "2,0",
        "-o",
        "form.obj",
    ];
    workshop.succeeds(&arguments);
    let texture = image::open(workshop.path("form.png")).expect("a picture").to_rgba8();
    assert_eq!(
        (texture.dimensions(), texture.get_pixel(3, 4).0),
        ((40, 40), [20, 110, 230, 255])
    );
    assert!(text(&workshop, "form.mtl").contains("map_Kd form.png"));
    assert!(text(&workshop, "form.obj").contains("mtllib form.mtl"));
    // The textures change over the animation: each frame has its own.
    workshop.succeeds(&["shape", "render", "scene.toml", "-o", "forms", "--frames", "1-2"]);
    for suffix in ["obj", "mtl", "png"] {
        assert!(
            workshop.path(&format!("forms/scene.0002.{suffix}")).is_file(),
            "{suffix}"
        );
    }
}

#[test]
fn a_texture_that_stays_is_written_once() {
    let workshop = workshop(
        |name| {
            if name == "fat" {
                "texture = \"a.png\"\n".to_owned()
            } else {
                String::new()
            }
        },
        &ANIMATION
            .replace("fps = 8", "fps = 1")
            .replace(
                "size = 0.0 } }",
                "size = 0.0 }, texture_at = { bend = 0.0, size = 0.0 } }",
            )
            .replace(
                "size = 1.0 } }",
                "size = 1.0 }, texture_at = { bend = 0.0, size = 0.0 } }",
            ),
    );
    workshop.picture("a.png", |_, _| [200, 10, 30, 255]);
    workshop.succeeds(&["shape", "render", "scene.toml", "-o", "forms"]);
    let names = std::fs::read_dir(workshop.path("forms")).expect("a folder");
    let names: Vec<String> = names
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    let count = |suffix: &str| names.iter().filter(|name| name.ends_with(suffix)).count();
    assert_eq!((count(".obj"), count(".mtl"), count(".png")), (3, 1, 1), "{names:?}");
}

#[test]
fn any_frames_on_any_threads_are_the_same_bytes() {
    let workshop = workshop(|_| String::new(), &format!("{SKELETON}{ANIMATION}"));
    let render = |output: &str, more: &[&str]| {
        let arguments = [&["shape", "render", "scene.toml", "-o", output], more].concat();
        workshop.succeeds(&arguments);
    };
    render("whole", &["--threads", "3"]);
    render("part", &["--threads", "1", "--frames", "2,17"]);
    let names = std::fs::read_dir(workshop.path("part")).expect("a folder");
    let names: Vec<String> = names
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    assert_eq!(names.len(), 2);
    for name in names {
        assert_eq!(
            workshop.bytes(&format!("part/{name}")),
            workshop.bytes(&format!("whole/{name}"))
        );
    }
    assert_eq!(std::fs::read_dir(workshop.path("whole")).expect("a folder").count(), 17);
    for kind in ["glb", "png"] {
        let [one, many] = ["1", "4"].map(|threads| {
            let name = format!("{threads}.{kind}");
            render(&name, &["--threads", threads]);
            workshop.bytes(&name)
        });
        assert!(one == many, "{kind}");
    }
    render("small.png", &["--size", "900x1100"]);
    assert_eq!(
        image::image_dimensions(workshop.path("small.png")).expect("a picture"),
        (900, 1100)
    );
    // One form as a picture: all of it, on an even ground.
    render("one.png", &["--at", "0.5,0.5", "--size", "120x90"]);
    let one = image::open(workshop.path("one.png")).expect("a picture").to_rgba8();
    assert_eq!(one.dimensions(), (120, 90));
    let ground = *one.get_pixel(0, 0);
    let edge = |x: u32, y: u32| x == 0 || y == 0 || x == 119 || y == 89;
    assert!(one.enumerate_pixels().all(|(x, y, p)| !edge(x, y) || *p == ground));
    assert!(one.pixels().filter(|p| **p != ground).count() > 500);
    render("pictures", &["--format", "png", "--size", "40x30", "--frames", "1,9"]);
    assert_eq!(
        std::fs::read_dir(workshop.path("pictures")).expect("a folder").count(),
        2
    );
}

#[test]
fn what_is_wrong_is_told_and_leaves_nothing_behind() {
    let workshop = workshop(|_| String::new(), ANIMATION);
    let listing = workshop.listing();
    let render = |output: &str| ["shape", "render", "scene.toml", "-o", output].map(str::to_owned);
    let message = workshop.fails(&render("one.obj").each_ref().map(String::as_str), 2);
    assert!(message.contains("--at"), "{message}");
    let message = workshop.fails(&["shape", "render", "scene.toml", "--at", "1", "-o", "one.obj"], 1);
    assert!(
        message.contains("the adjectives of scene.toml are bend, size"),
        "{message}"
    );
    let message = workshop.fails(&["shape", "weights", "scene.toml", "--at", "1,nan"], 1);
    assert!(message.contains("finite"), "{message}");
    let message = workshop.fails(
        &[
            "shape",
            "weights",
            "scene.toml",
            "--at",
            "1,0",
            "--at",
            "0,0",
            "--texture-at",
            "0,0",
        ],
        2,
    );
    assert!(message.contains("1 --texture-at for 2 --at"), "{message}");
    workshop.fails(&["shape", "render", "scene.toml", "-o", "a.fbx"], 2);

    let good = text(&workshop, "bent.obj");
    let cases = [
        (good.replacen("f 1", "f 3", 1), "face 0"),
        (format!("{good}v 9 9 9\n"), "37 vertices"),
        ("nonsense".to_owned(), "form of example 'bent'"),
        (String::new(), "form of example 'bent'"),
    ];
    for (wrong, words) in cases {
        workshop.file("bent.obj", wrong.as_bytes());
        let message = workshop.fails(&["shape", "render", "scene.toml", "-o", "forms"], 1);
        assert!(message.contains("scene.toml:9") && message.contains(words), "{message}");
    }
    std::fs::remove_file(workshop.path("bent.obj")).expect("there");
    let message = workshop.fails(&["shape", "render", "scene.toml", "-o", "sheet.png"], 1);
    assert!(
        message.contains("scene.toml:9") && message.contains("bent.obj"),
        "{message}"
    );
    workshop.file("bent.obj", good.as_bytes());
    assert_eq!(workshop.listing(), listing);
}

#[test]
fn a_skin_that_does_not_fit_is_refused() {
    let workshop = workshop(|_| String::new(), &format!("{SKELETON}{ANIMATION}"));
    let good = text(&workshop, "weights.json");
    for (wrong, words) in [
        (good.replacen("[[0, 1], [1, 0]], ", "", 1), "35 vertices"),
        (good.replacen("[[0, 1]", "[[0, 2]", 1), "sum to 2"),
        (good.replacen("upper", "thigh", 1), "'thigh'"),
    ] {
        workshop.file("weights.json", wrong.as_bytes());
        let message = workshop.fails(&["shape", "render", "scene.toml", "-o", "a.glb"], 1);
        assert!(
            message.contains("scene.toml:16") && message.contains(words),
            "{message}"
        );
    }
}
