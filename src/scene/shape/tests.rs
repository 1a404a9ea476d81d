use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::math::Point3;
use crate::scene::{SceneError, SceneProblem};
use crate::weights::Radial;

const TWO: &str = r#"version = 1
adjectives = ["bend", "thickness"]
[[example]]
name = "straight"
form = "straight.obj"
at = { bend = 0.0, thickness = 0 }
[[example]]
name = "bent"
form = "forms/bent.obj"
at = { thickness = 0.5, bend = 1.0 }
"#;

fn parsed(text: &str) -> Result<ShapeScene, SceneError> {
    ShapeScene::parse(text, Path::new("folder/scene.toml"))
}

fn with(more: &str) -> Result<ShapeScene, SceneError> {
    parsed(&format!("{TWO}{more}"))
}

#[test]
fn what_is_left_out_has_its_default() {
    let scene = parsed(TWO).expect("a scene");
    assert_eq!(scene.short_name(), "folder");
    assert_eq!((scene.dimension(), scene.radial), (2, Radial::BSpline));
    assert_eq!(scene.examples[1].at, [1.0, 0.5], "in the order of the adjectives");
    assert_eq!(scene.examples[1].texture_at, scene.examples[1].at);
    assert_eq!(
        scene.subdivision,
        SubdivisionSettings {
            steps: 0,
            points: SurfacePoints::Limit
        }
    );
    let sheet = &scene.sheet;
    assert_eq!(
        (sheet.across.adjective, sheet.across.from, sheet.across.to),
        (0, 0.0, 1.0)
    );
    let up = sheet.up.expect("a second side");
    assert_eq!((up.adjective, up.from, up.to, up.count), (1, 0.0, 0.5, 5));
    assert_eq!(up.value(4), 0.5);
    assert_eq!(sheet.fixed, [0.5, 0.25], "the mean");
    // A loop through the examples.
    assert!(scene.animation.is_loop() && scene.animation.keys().len() == 2);
}

#[test]
fn everything_that_can_be_said_is_read() {
    let text = r#"version = 1
adjectives = ["elbow", "gender", "age"]
radial = "thin-plate"
[[example]]
name = "a"
form = "a.obj"
at = { elbow = 0.0, gender = 0.0, age = 0.0 }
texture = "a.png"
texture_at = { elbow = 2.0, gender = 0.0, age = 0.0 }
[[example]]
name = "b"
form = "b.obj"
at = { elbow = 1.0, gender = 0.0, age = 1.0 }
[[pseudo_example]]
from = { elbow = 0.5, gender = 0.0, age = 0.0 }
at = { elbow = 0.4, gender = 0.0, age = 0.0 }
of = "both"
[skeleton]
weights = "arm.weights.json"
[[skeleton.joint]]
name = "upper"
origin = [0.0, 0.0, 0.0]
[[skeleton.joint]]
name = "forearm"
parent = "upper"
origin = [1.0, 0.0, 0.0]
turns = [ { adjective = "elbow", axis = [0.0, 3.0, 4.0], degrees = 90.0, offset = 5.0 } ]
shifts = [ { adjective = "age", by = [0.0, -1.0, 0.5] } ]
scalings = [ { adjective = "gender", factors = [1.0, 1.5, 2.0] } ]
[subdivision]
steps = 2
limit = false
[sheet]
across = { adjective = "age", from = -1.0, to = 2.0, columns = 7 }
fixed = { gender = 0.25 }
view = { yaw = -30.0, pitch = 5.0 }
[animation]
fps = 10
loop = true
keys = [
  { time = 0.0, at = { elbow = 0.0, gender = 0.0, age = 0.0 } },
  { time = 1.0, at = { elbow = 1.0, gender = 0.0, age = 0.0 } },
  { time = 2.0, at = { elbow = 0.0, gender = 0.0, age = 0.0 }, texture_at = { elbow = 0.0, gender = 1.0, age = 0.0 } },
]
"#;
    let scene = parsed(text).expect("a scene");
    assert_eq!(scene.radial, Radial::ThinPlate);
    assert!(scene.is_textured() && scene.pseudo_examples[0].of.is_texture());
    let skeleton = scene.skeleton.as_ref().expect("joints");
    assert_eq!((skeleton.joints[0].parent, skeleton.joints[1].parent), (None, Some(0)));
    let turn = skeleton.joints[1].turns[0];
    assert_eq!((turn.adjective, turn.degrees, turn.offset_degrees), (0, 90.0, 5.0));
    assert!((turn.axis - Point3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
    assert_eq!(
        (scene.subdivision.steps, scene.subdivision.points),
        (2, SurfacePoints::Refined)
    );
    assert_eq!(
        (scene.sheet.across.adjective, scene.sheet.up.map(|up| up.adjective)),
        (2, Some(0))
    );
    assert_eq!(scene.sheet.fixed, [0.5, 0.25, 0.5]);
    // The geometry's path repeats its first key, the textures' does not: both take as long.
    assert_eq!(scene.animation.frame_count(), scene.texture_animation.frame_count());
    assert_eq!(scene.animation.at(2.0), [0.0, 0.0, 0.0]);
    assert_eq!(scene.texture_animation.at(2.0), [0.0, 1.0, 0.0]);
    assert_eq!(scene.texture_animation.at(3.0), scene.texture_animation.at(0.0));
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let cases = [
        ("colour = 3\n", 11, "unknown field"),
        (
            "[sheet]\nacross = { adjective = \"age\" }\n",
            12,
            "'age', but the adjectives are 'bend', 'thickness'",
        ),
        (
            "[sheet]\nacross = { adjective = \"bend\" }\nup = { adjective = \"bend\" }\n",
            13,
            "'bend' twice",
        ),
        ("[sheet]\nfixed = { bend = 0.0 }\n", 12, "'bend' twice"),
        (
            "[sheet]\nacross = { adjective = \"bend\", columns = 0 }\n",
            12,
            "columns is 0",
        ),
        (
            "[sheet]\nacross = { adjective = \"bend\", from = 1.0, to = 1.0 }\n",
            12,
            "two different values",
        ),
        ("[subdivision]\nsteps = 9\n", 12, "from 0 to 5"),
        (
            "[[pseudo_example]]\nfrom = { bend = 0.0 }\nat = { bend = 0.0, thickness = 0.0 }\n",
            12,
            "nothing of 'thickness'",
        ),
        (
            "[[pseudo_example]]\nfrom = { bend = 0.0, thickness = 0.0 }\nat = { bend = inf, thickness = 0.0 }\n",
            13,
            "'bend' in `at` of a [[pseudo_example]] is inf",
        ),
        (
            "[[pseudo_example]]\nfrom = { bend = 0.0, thickness = 0.0 }\nat = { bend = 2.0, thickness = 0.0 }\nof = \"texture\"\n",
            14,
            "no example has one",
        ),
        (
            "[[example]]\nname = \"third\"\nform = \"c.obj\"\nat = { bend = 1.0, thickness = 0.5 }\n",
            12,
            "'bent' and 'third' have their forms at the same place",
        ),
        (
            "[[example]]\nname = \"bent\"\nform = \"c.obj\"\nat = { bend = 2.0, thickness = 0.5 }\n",
            12,
            "used twice",
        ),
        (
            "[[example]]\nname = \"c\"\nform = \"../c.obj\"\nat = { bend = 2.0, thickness = 0.5 }\n",
            13,
            "goes up",
        ),
        ("[skeleton]\nweights = \"w.json\"\n", 12, "no joint"),
        (
            "[skeleton]\nweights = \"w.json\"\n[[skeleton.joint]]\nname = \"a\"\nparent = \"b\"\norigin = [0.0, 0.0, 0.0]\n",
            15,
            "no joint above it",
        ),
        (
            "[skeleton]\nweights = \"w.json\"\n[[skeleton.joint]]\nname = \"a\"\norigin = [0.0, 0.0]\n",
            15,
            "three finite",
        ),
        (
            "[skeleton]\nweights = \"w.json\"\n[[skeleton.joint]]\nname = \"a\"\norigin = [0.0, 0.0, 0.0]\nturns = [ { adjective = \"bend\", axis = [0.0, 0.0, 0.0], degrees = 1.0 } ]\n",
            16,
            "not all 0",
        ),
        (
            "[skeleton]\nweights = \"w.json\"\n[[skeleton.joint]]\nname = \"a\"\norigin = [0.0, 0.0, 0.0]\nscalings = [ { adjective = \"bend\", factors = [1.0, 0.0, 1.0] } ]\n",
            16,
            "above 0",
        ),
        (
            "[animation]\nkeys = [ { time = 0.0, at = { bend = 0.0, thickness = 0.0 } },\n{ time = 0.0, at = { bend = 0.0, thickness = 0.0 } } ]\n",
            13,
            "sort the keys",
        ),
        ("[animation]\nfps = 0\n", 12, "above 0"),
    ];
    for (more, line, words) in cases {
        let error = with(more).expect_err(more);
        assert_eq!(error.line, Some(line), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    }
    let error = parsed("version = 1\nadjectives = []\n").expect_err("none");
    assert_eq!(error.problem, SceneProblem::Shape(ShapeProblem::NoAdjective));
    let error = parsed("version = 1\nadjectives = [\"a\"]\n").expect_err("none");
    assert_eq!(error.problem, SceneProblem::Shape(ShapeProblem::NoExample));
    let error = parsed("version = 2\nadjectives = [\"a\"]\n").expect_err("another version");
    assert_eq!(error.problem, SceneProblem::Version { found: 2 });
}

#[test]
fn weights_of_vertices_name_the_joints_of_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let joint = |name: &str| format!("[[skeleton.joint]]\nname = \"{name}\"\norigin = [0.0, 0.0, 0.0]\n");
    let text = format!("{TWO}[skeleton]\nweights = \"w.json\"\n{}{}", joint("a"), joint("b"));
    let scene = ShapeScene::parse(&text, &folder.path().join("scene.toml")).expect("a scene");
    let write = |text: &str| std::fs::write(folder.path().join("w.json"), text).expect("written");
    let missing = scene.skin_weights().expect_err("no file");
    assert_eq!(missing.line, Some(12), "{missing}");
    write(r#"{"joints": ["b", "a"], "weights": [[[0, 1.0]], [[1, 0.25], [0, 0.75]], []]}"#);
    let weights = scene.skin_weights().expect("weights").expect("a skeleton");
    assert_eq!(weights, [vec![(1, 1.0)], vec![(0, 0.25), (1, 0.75)], vec![]]);
    for (wrong, words) in [
        (r#"{"joints": ["c"], "weights": []}"#, "'c' is no"),
        (
            r#"{"joints": ["a"], "weights": [[[1, 1.0]]]}"#,
            "vertex 0 follows joint 1",
        ),
        (r#"{"joints": ["a"]}"#, "missing field `weights`"),
        ("[", "EOF"),
    ] {
        write(wrong);
        let error = scene.skin_weights().expect_err(wrong);
        assert!(error.to_string().contains(words), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn no_text_makes_it_panic(cut in 0..TWO.len(), insert in "[\\[\\]{}=\".,a-z0-9\n ]{0,12}") {
        let mut text = TWO.to_owned();
        text.insert_str(cut, &insert);
        let _ = parsed(&text);
        let _ = parsed(&TWO[..cut]);
    }
}
