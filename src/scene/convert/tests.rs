use super::*;
use crate::animation::Background;
use crate::blend::{Anchor, BlendOptions, Region, SoftAnchor};
use crate::blend::{FrameGuard, Reference};
use crate::math::Point;
use crate::pipeline::{Facing, MeshOptions};
use crate::scene::settings::PoseSource;

fn parse(text: &str) -> Result<Scene, SceneError> {
    Scene::parse(text, Path::new("cat/scene.toml"))
}

const TWO: &str = "version = 1\n[[pose]]\nname = \"a\"\nsource = \"a.png\"\nat = [0, 0]\n[[pose]]\nname = \"b\"\nsource = \"b.svg\"\nat = [1.0, 0.5]\n";

fn refused(text: &str) -> (Option<usize>, String) {
    let error = parse(text).expect_err("it is refused");
    assert!(error.to_string().starts_with("cat/scene.toml"), "{error}");
    (error.line, error.to_string())
}

#[test]
fn the_smallest_scene_has_the_documented_defaults() {
    let scene = parse("version = 1\n[[pose]]\nname = \"a\"\nsource = \"a.png\"\n").expect("a scene");
    assert_eq!(scene.poses[0].at, vec![0.0, 0.0]);
    assert_eq!(scene.input, InputSettings::default());
    assert_eq!(scene.mesh, MeshOptions::default());
    assert_eq!(scene.pose_space, PoseSpaceSettings::default());
    assert_eq!(scene.blend, BlendOptions::default());
    assert_eq!(scene.texture_sharpness, 0.5);
    assert_eq!((scene.animation.fps, scene.animation.size), (24.0, [1280, 720]));
    assert_eq!(scene.animation.frame_count(), 1);
    assert_eq!(scene.short_name(), "cat");
}

#[test]
fn every_key_of_the_contract_is_known() {
    let text = r##"
version = 1
reference = "a"
[input]
figure = "lines"
gap = 0.02
paper = "clear"
holes = "fill"
overlaps = "refuse"
threshold = 0.4
[mesh]
simplify = 0.01
edge_length = 0.04
[pose_space]
provider = "rbf"
radial = "thin-plate"
epsilon = 1e-2
bounded = false
walls = []
[blend]
reference = "b"
stretch = "limited"
guard = "off"
anchor = "foot"
[texture]
sharpness = 0.9
[[pose]]
name = "a"
source = "a.png"
at = [0, 0]
mirror = true
figure = "background"
threshold = 0.3
turns = -1
[[pose]]
name = "b"
source = "b.svg"
element = "body"
at = [1.0, 0.5]
[[pseudo_pose]]
from = [0.5, 0.25]
at = [0.6, 0.25]
[[landmark]]
name = "foot"
at = { b = [12, 4.5] }
path = false
[animation]
fps = 12
loop = true
size = [64, 48]
background = "#ff000080"
keys = [ { time = 0, at = [0, 0] }, { time = 2.0, at = [1, 1] } ]
"##;
    let scene = parse(text).expect("a scene");
    assert_eq!(scene.reference, Some(0));
    assert_eq!(scene.input.holes, Holes::Fill);
    assert_eq!(scene.input.overlaps, crate::pipeline::OverlapSearch::Refuse);
    assert_eq!(scene.blend.reference, Reference::Pose(1));
    assert_eq!(scene.blend.anchor, Anchor::Point(0));
    let drawings: Vec<_> = (0..2)
        .filter_map(|pose| scene.drawing_of(pose))
        .map(|(_, drawing)| drawing)
        .collect();
    assert_eq!((drawings[0].facing, scene.poses[0].turns), (Facing::Mirrored, -1));
    // A pose says what differs from [input].
    let reading = scene.input.reading;
    assert_eq!((reading.figure, reading.paper), (FigureRule::Lines, PaperRule::Clear));
    assert_eq!((reading.gap, reading.threshold), (0.02, 0.4));
    assert_eq!(drawings[0].reading.figure, FigureRule::Background);
    assert_eq!((drawings[0].reading.gap, drawings[0].reading.threshold), (0.02, 0.3));
    assert_eq!(drawings[1].reading, reading);
    assert_eq!(drawings[1].element.as_deref(), Some("body"));
    assert_eq!(scene.landmarks[0].at, vec![None, Some(Point::new(12.0, 4.5))]);
    assert_eq!(scene.animation.background, Background::Colour([255, 0, 0, 128]));
    assert_eq!(scene.animation.frame_count(), 48);
}

#[test]
fn a_landmark_with_a_path_is_a_line_on_every_pose_that_has_it() {
    let path = |at: &str| format!("{TWO}[[landmark]]\nname = \"brow\"\npath = true\nat = {{ {at} }}\n");
    let scene = parse(&path("b = [[1, 2], [1, 2], [3, 4.5], [5, 6]]")).expect("a scene");
    assert!(scene.landmarks.is_empty());
    let line = [[1.0, 2.0], [3.0, 4.5], [5.0, 6.0]].map(Point::from).to_vec();
    assert_eq!(scene.paths[0].at, vec![None, Some(line)]);
    for (at, word) in [
        ("a = [1, 2]", "point"),
        ("a = [[1, 2]]", "two different points"),
        ("a = [[1, 2], [3]]", "point 1"),
        ("c = [[1, 2], [3, 4]]", "'c'"),
    ] {
        let (line, message) = refused(&path(at));
        assert_eq!(line, Some(13), "{message}");
        assert!(message.contains("'brow'") && message.contains(word), "{message}");
    }
}

#[test]
fn parts_have_places_a_cut_and_an_order() {
    let part = |keys: &str| format!("{TWO}[[part]]\nname = \"arm\"\n{keys}\n");
    let scene = parse(&part(
        "at = { a = [1, 2], b = [3, 4.5] }\ncut = { a = [[0, 0], [2, 0]] }",
    ))
    .expect("a scene");
    let arm = &scene.limbs[0];
    assert_eq!((arm.name.as_str(), arm.line, arm.layer), ("arm", 11, None));
    assert_eq!(arm.at, vec![Some(Point::new(1.0, 2.0)), Some(Point::new(3.0, 4.5))]);
    assert_eq!(arm.cut[0], Some([[0.0, 0.0], [2.0, 0.0]].map(Point::from).to_vec()));
    for (keys, word) in [
        ("at = { c = [1, 2] }", "'c'"),
        ("at = { a = [1] }", "point"),
        ("at = { a = [1, 2] }\ncut = { a = [[1, 2]] }", "two different points"),
        ("at = { a = [1, 2] }\nlayer = \"body\"", "[[layer]]"),
    ] {
        let (_, message) = refused(&part(keys));
        assert!(message.contains("part 'arm'") && message.contains(word), "{message}");
    }
    let (line, message) = refused(&format!("{TWO}[[part]]\nname = \"trunk\"\nat = {{ a = [1, 2] }}\n"));
    assert!(line == Some(11) && message.contains("'trunk'"), "{message}");
    let ordered = |order: &str| {
        let pose = "[[pose]]\nname = \"c\"\nsource = \"c.png\"\nat = [2, 0]\n";
        format!("{TWO}{pose}order = {order}\n")
    };
    let scene = parse(&ordered("[\"arm\", \"trunk\"]")).expect("a scene");
    assert_eq!(scene.poses[2].limb_order, ["arm", "trunk"]);
    for order in ["[\"arm\"]", "[\"arm\", \"arm\"]"] {
        let (line, message) = refused(&ordered(order));
        assert!(line == Some(14) && message.contains("'c'"), "{message}");
    }
}

#[test]
fn unknown_keys_are_refused_with_their_line() {
    let (line, message) = refused("version = 1\n[mesh]\nsimplfy = 0.1\n");
    assert_eq!(line, Some(3));
    assert!(message.contains("simplfy") && message.contains("simplify"), "{message}");
    let (line, _) = refused(&format!("{TWO}colour = 3\n"));
    assert_eq!(line, Some(10));
}

#[test]
fn keys_of_later_releases_are_refused_by_name() {
    for (text, line, word) in [
        ("[pose_space]\nprovider = \"rbf\"\nbounded = true\n", 12, "bounded"),
        (
            "[pose_space]\nprovider = \"rbf\"\nwalls = [[[0.2, 0.0], [0.2, 0.6]]]\n",
            12,
            "walls",
        ),
    ] {
        let (found, message) = refused(&format!("{TWO}{text}"));
        assert_eq!(found, Some(line), "{message}");
        assert!(
            message.contains(word) && message.contains("not supported yet"),
            "{message}"
        );
    }
}

/// A pose 'c' that is a copy, from line 10; its keys from line 12.
fn copy(keys: &str) -> String {
    format!("{TWO}[[pose]]\nname = \"c\"\n{keys}at = [5, 5]\n")
}

const HANDLES: &str = "handles = [ { from = [1, 2], to = [3.5, 4] } ]\n";

#[test]
fn copies_know_their_drawing() {
    let text = copy(&format!("deform_of = \"b\"\n{HANDLES}turns = 1\n"))
        + "[[pose]]\nname = \"d\"\ndeform_of = \"c\"\nat = [6, 6]\n"
        + HANDLES
        + "[[landmark]]\nname = \"nose\"\nat = { b = [1, 2] }\n";
    let scene = parse(&text).expect("a scene");
    let PoseSource::Deformed(made) = &scene.poses[2].source else {
        panic!("a copy")
    };
    assert_eq!(
        (made.copy.of, made.copy.handles[0].to, scene.poses[2].turns),
        (1, Point::new(3.5, 4.0), 1)
    );
    assert_eq!(scene.drawn_poses(), [0, 1]);
    let roots: Vec<usize> = (0..4)
        .filter_map(|pose| scene.drawing_of(pose))
        .map(|(root, _)| root)
        .collect();
    assert_eq!(roots, [0, 1, 1, 1]);
}

#[test]
fn copies_that_make_no_sense_are_refused() {
    let of = |name: &str| format!("deform_of = \"{name}\"\n");
    for (keys, line, words) in [
        (of("a"), 12, "no handles"),
        (of("a") + "handles = []\n", 12, "no handles"),
        (of("z") + HANDLES, 12, "'z', but the poses are 'a', 'b', 'c'"),
        (of("c") + HANDLES, 12, "copy of itself"),
        (of("a") + "source = \"c.png\"\n" + HANDLES, 13, "remove `source`"),
        (of("a") + "mirror = true\n" + HANDLES, 12, "remove `mirror`"),
        ("source = \"c.png\"\n".to_owned() + HANDLES, 13, "no `deform_of`"),
        (
            of("a") + "handles = [ { from = [1], to = [3, 4] } ]\n",
            13,
            "`from` of handle 0 of pose 'c'",
        ),
        (
            of("a") + "handles = [ { from = [1, 2], to = [3, inf] } ]\n",
            13,
            "`to` of handle 0 of pose 'c'",
        ),
    ] {
        let (found, message) = refused(&copy(&keys));
        assert_eq!(found, Some(line), "{message}");
        assert!(message.contains(words) && message.contains("'c'"), "{message}");
    }
    let circle = copy(&(of("d") + HANDLES)) + "[[pose]]\nname = \"d\"\nat = [6, 6]\n" + &of("c") + HANDLES;
    assert!(refused(&circle).1.contains("copy of itself"));
    let good = copy(&(of("a") + HANDLES));
    let (line, message) = refused(&format!("reference = \"c\"\n{good}"));
    assert!(
        line == Some(1) && message.contains("'c', a deformed copy"),
        "{line:?} {message}"
    );
    let (line, message) = refused(&format!("{good}[[landmark]]\nname = \"nose\"\nat = {{ c = [1, 2] }}\n"));
    assert!(
        line == Some(17) && message.contains("'nose' names pose 'c'"),
        "{line:?} {message}"
    );
}

#[test]
fn anchors_regions_and_guard_are_read() {
    let marks =
        "[[landmark]]\nname = \"foot\"\nat = { a = [1, 2] }\n[[landmark]]\nname = \"hand\"\nat = { b = [1, 2] }\n";
    let scene = parse(&format!(
        "{TWO}{marks}[blend]\nguard = \"repair\"\nanchor = [\"hand\", {{ landmark = \"foot\", stiffness = 2 }}]\n\
         [[region]]\nlandmark = \"hand\"\nradius = 0.2\nstretch_limit = 1.5\n"
    ))
    .expect("a scene");
    assert_eq!(scene.blend.guard, FrameGuard::Repair);
    let soft = [(1, 10.0), (0, 2.0)].map(|(point, stiffness)| SoftAnchor { point, stiffness });
    assert_eq!(scene.blend.anchor, Anchor::Soft(soft.to_vec()));
    assert_eq!(
        scene.blend.regions,
        [Region {
            point: 1,
            radius: 0.2,
            stiffness: 1.0,
            stretch_limit: 1.5
        }]
    );
    for (text, line, word) in [
        ("[blend]\nanchor = [\"hand\", \"nose\"]\n", 17, "'nose'"),
        ("[blend]\nanchor = []\n", 17, "anchor must be"),
        (
            "[blend]\nanchor = [{ landmark = \"hand\", weight = 1 }]\n",
            17,
            "anchor must be",
        ),
        (
            "[blend]\nanchor = [{ landmark = \"hand\", stiffness = -1.0 }]\n",
            17,
            "stiffness",
        ),
        ("[[region]]\nlandmark = \"nose\"\nradius = 1.0\n", 16, "'nose'"),
        ("[[region]]\nlandmark = \"hand\"\nradius = 0.0\n", 16, "radius"),
        (
            "[[region]]\nlandmark = \"hand\"\nradius = 0.1\nstretch_limit = 0.5\n",
            16,
            "stretch_limit",
        ),
    ] {
        let (found, message) = refused(&format!("{TWO}{marks}{text}"));
        assert_eq!(found, Some(line), "{message}");
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn facing_and_registration_are_read_or_refused_with_their_words() {
    let read = |keys: &str| {
        format!("version = 1\n[texture]\nregister = \"off\"\n[[pose]]\nname = \"a\"\nsource = \"a.png\"\n{keys}\n")
    };
    for (keys, facing) in [
        ("", Facing::AsDrawn),
        ("mirror = false", Facing::AsDrawn),
        ("mirror = true", Facing::Mirrored),
        ("mirror = \"auto\"", Facing::Auto),
    ] {
        let scene = parse(&read(keys)).expect("a scene");
        let drawing = scene.drawing_of(0).expect("a drawing").1;
        assert_eq!(
            (drawing.facing, scene.register),
            (facing, crate::pipeline::Register::Off)
        );
    }
    for wrong in ["\"maybe\"", "1"] {
        let (line, message) = refused(&read(&format!("mirror = {wrong}")));
        assert_eq!(line, Some(7), "{message}");
        assert!(
            message.contains(&format!("mirror is '{}'", wrong.trim_matches('"'))),
            "{message}"
        );
    }
    let (line, message) = refused(&read("").replace("off", "on"));
    assert_eq!(line, Some(3), "{message}");
    assert!(message.contains("'auto' or 'off'"), "{message}");
}

#[test]
fn walls_and_bounds_are_read() {
    let scene = parse(&format!(
        "{TWO}[pose_space]\nbounded = true\nwalls = [[[0.2, 0.0], [0.2, 0.6]], [[1, 2], [3, 4], [5, 6]]]\n"
    ))
    .expect("a scene");
    assert_eq!(scene.pose_space.range, crate::weights::Range::Unit);
    assert_eq!(scene.pose_space.walls[0], vec![[0.2, 0.0], [0.2, 0.6]]);
    assert_eq!(scene.pose_space.walls[1].len(), 3);
    for (walls, word) in [
        ("[[[0.2, 0.0]]]", "wall 0 has 1 points"),
        ("[[[0, 0], [1, 0]], [[0.2, 0.0, 1.0], [1, 1]]]", "point 0 of wall 1"),
        ("[[[0, 0], [nan, 0]]]", "point 1 of wall 0"),
    ] {
        let (line, message) = refused(&format!("{TWO}[pose_space]\nwalls = {walls}\n"));
        assert_eq!(line, Some(11), "{message}");
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn a_scene_without_places_takes_them_later() {
    let text = TWO.replace("at = [0, 0]\n", "").replace("at = [1.0, 0.5]\n", "");
    let scene = parse(&format!("{text}[animation]\nfps = 12\nloop = false\n")).expect("a scene");
    assert_eq!(
        (scene.layout, parse(TWO).expect("a scene").layout),
        (Layout::Automatic, Layout::Given)
    );
    let placed = scene.laid_out(&[vec![-3.0, 0.0], vec![5.0, 1.0]]);
    assert_eq!((placed.layout, &placed.poses[1].at), (Layout::Given, &vec![5.0, 1.0]));
    assert_eq!(
        (placed.animation.at(0.0), placed.animation.at(1.0)),
        (vec![-3.0, 0.0], vec![5.0, 1.0])
    );
    assert_eq!((placed.animation.fps, placed.animation.is_loop()), (12.0, false));
    let keyed = parse(&format!(
        "{text}[animation]\nkeys = [ {{ time = 0, at = [0.5, 0] }} ]\n"
    ))
    .expect("a scene");
    assert_eq!(
        keyed.laid_out(&[vec![-3.0, 0.0], vec![5.0, 1.0]]).animation,
        keyed.animation
    );
}

#[test]
fn places_are_checked() {
    let (line, message) = refused(&TWO.replace("[1.0, 0.5]", "[0.0, 0.0]"));
    assert_eq!(line, Some(7));
    assert!(
        message.contains("'a' and 'b'") && message.contains("[0.0, 0.0]"),
        "{message}"
    );
    assert!(refused(&TWO.replace("[1.0, 0.5]", "[nan, 0.0]")).1.contains("NaN"));
    assert!(
        refused(&TWO.replace("[1.0, 0.5]", "[1e300, 0.0]"))
            .1
            .contains("pose 'b'")
    );
    assert!(refused(&TWO.replace("[1.0, 0.5]", "[1.0]")).1.contains("1 coordinates"));
    assert!(
        refused(&TWO.replace("at = [1.0, 0.5]", ""))
            .1
            .contains("pose 'b' has no `at`")
    );
}

#[test]
fn names_are_checked() {
    assert!(refused(&TWO.replace("\"b\"", "\"a\"")).1.contains("used twice"));
    assert!(refused(&TWO.replace("\"b\"", "\"\"")).1.contains("empty"));
    let (line, message) = refused(&format!("{TWO}[[landmark]]\nname = \"nose\"\nat = {{ c = [1, 2] }}\n"));
    assert_eq!(line, Some(12));
    assert!(
        message.contains("'nose'") && message.contains("'c'") && message.contains("'a', 'b'"),
        "{message}"
    );
    assert!(refused(&format!("reference = \"z\"\n{TWO}")).1.contains("'z'"));
}

#[test]
fn sources_stay_in_the_folder() {
    let (line, message) = refused(&TWO.replace("b.svg", "../b.svg"));
    assert_eq!(line, Some(8));
    assert!(message.contains("'b'") && message.contains(".."), "{message}");
}

#[test]
fn keys_must_be_sorted_and_versions_match() {
    let keys = "[animation]\nkeys = [\n{ time = 1, at = [0, 0] },\n{ time = 1, at = [1, 0] } ]\n";
    assert_eq!(refused(&format!("{TWO}{keys}")).0, Some(13));
    assert!(refused("version = 2\n").1.contains("version 2"));
    assert!(refused("").1.contains("version"));
}

#[test]
fn without_keys_every_pose_is_visited_for_the_same_time() {
    let scene = parse(TWO).expect("a scene");
    assert_eq!(scene.animation.duration(), 2.0);
    assert_eq!(scene.animation.at(0.0), vec![0.0, 0.0]);
    assert_eq!(scene.animation.at(1.0), vec![1.0, 0.5]);
    assert_eq!(scene.animation.at(2.0), vec![0.0, 0.0]);
}

#[test]
fn a_new_scene_reads_back() {
    let poses =
        [("a", "a.png"), ("say \"hi\"", "b c.png"), ("c", "c.svg")].map(|(name, source)| super::super::NewPose {
            name: name.to_owned(),
            source: source.to_owned(),
            picture: crate::input::PictureChoice::Only,
            element: super::super::NewElement::Whole,
            at: None,
        });
    let text = super::super::scene_text(&[], &poses);
    let scene = parse(&text).expect("a scene");
    assert_eq!(scene.names(), ["a", "say \"hi\"", "c"]);
    assert_eq!(scene.layout, Layout::Automatic);
    let placed = poses.clone().map(|pose| super::super::NewPose {
        at: Some([0.25, -f64::from(pose.source.as_bytes()[0])]),
        ..pose
    });
    let scene = parse(&super::super::scene_text(&[], &placed)).expect("a scene");
    assert_eq!((scene.layout, &scene.poses[1].at), (Layout::Given, &vec![0.25, -98.0]));
    // The commented landmark is valid once the comment signs go.
    let open = text
        .replace("# [[landmark]]\n# name", "[[landmark]]\nname")
        .replace("# at = {", "at = {");
    assert_eq!(parse(&open).expect("a scene").landmarks.len(), 1);
}

#[test]
fn a_new_scene_with_layers_reads_back() {
    use super::super::{NewElement, NewPose};
    let layers = ["body".to_owned(), "left arm".to_owned()];
    let pose = |name: &str, layers: &[&str], order: Option<[&str; 2]>| NewPose {
        name: name.to_owned(),
        source: "hero.psd".to_owned(),
        picture: crate::input::PictureChoice::Frame(1),
        element: NewElement::Layers {
            elements: layers
                .iter()
                .map(|layer| ((*layer).to_owned(), format!("{name}/{layer}")))
                .collect(),
            order: order.map(|order| order.map(str::to_owned).to_vec()),
        },
        at: None,
    };
    let poses = [
        pose("stand", &["body", "left arm"], Some(["left arm", "body"])),
        pose("run", &["left arm"], None),
    ];
    let scene = parse(&super::super::scene_text(&layers, &poses)).expect("a scene");
    assert_eq!(
        (&scene.layers[0].poses, &scene.layers[1].poses),
        (&vec![0], &vec![0, 1])
    );
    let (_, drawing) = scene.layers[1].scene.drawing_of(1).expect("a drawing");
    assert_eq!(drawing.element.as_deref(), Some("run/left arm"));
    assert_eq!(scene.poses[0].draw_order, [1, 0]);
}

mod layers;
