//! Characters made in memory: what is refused, what is built, what is kept.

use super::*;
use crate::animation::Animation;
use crate::blend::{Anchor, Stretch};
use crate::input::{BitmapOptions, read_pixels};
use crate::pipeline::{Build, Character, PipelineError, map_layer};
use crate::weights::WeightProvider as _;

/// Columns and rows of the drawings.
const SIZE: [usize; 2] = [48, 40];

/// An L: `foot` columns of its foot, `colour` of red.
fn letter(foot: usize, colour: u8) -> Drawing {
    let pixels = (0..SIZE[0] * SIZE[1]).flat_map(|k| {
        let (x, y) = (k % SIZE[0], k / SIZE[0]);
        let is_inside =
            (4..36).contains(&y) && (6..16).contains(&x) || (26..36).contains(&y) && (6..16 + foot).contains(&x);
        [colour, 20, 10, if is_inside { 255 } else { 0 }]
    });
    read_pixels(SIZE, &pixels.collect::<Vec<u8>>(), &BitmapOptions::default()).expect("a drawing")
}

fn at(x: f64, y: f64) -> Option<Point> {
    Some(Point::new(x, y))
}

/// Two letters and a copy of the first, bent at the top.
fn spec() -> CharacterSpec {
    let bent = [(8.0, 34.0, 8.0, 34.0), (20.0, 30.0, 20.0, 30.0), (11.0, 6.0, 15.0, 7.0)];
    let handles = bent.map(|(x, y, to_x, to_y)| HandleMove {
        from: Point::new(x, y),
        to: Point::new(to_x, to_y),
    });
    let mut layer = LayerSpec::new(
        "letter",
        vec![
            PoseSpec::drawn("short", letter(10, 200)),
            PoseSpec::drawn("long", letter(24, 40)),
            PoseSpec::deformed("bent", 0, handles.to_vec()),
        ],
    );
    layer.landmarks.push(LandmarkSpec {
        name: "toe".to_owned(),
        at: vec![at(26.0, 26.0), at(40.0, 26.0), None],
    });
    let places = vec![vec![0.0, 0.0], vec![1.0, 0.0], vec![0.0, 1.0]];
    CharacterSpec::new(vec![layer]).with_places(places)
}

fn refused(change: impl FnOnce(&mut CharacterSpec)) -> SpecError {
    let mut spec = spec();
    change(&mut spec);
    let error = spec.check().expect_err("no character");
    let Err(PipelineError::Spec(built)) = Build::new(&spec) else {
        panic!("a build of {error}")
    };
    // A number that is none does not equal itself.
    assert_eq!(built.to_string(), error.to_string());
    error
}

#[test]
fn what_is_no_character_is_refused_by_name() {
    spec().check().expect("a character");
    assert_eq!(refused(|spec| spec.layers.clear()), SpecError::NoLayer);
    assert_eq!(refused(|spec| spec.space.poses.clear()), SpecError::NoPose);
    type Change = fn(&mut CharacterSpec);
    let cases: [(Change, &str); 17] = [
        (|s| s.space.poses[1] = "short".to_owned(), "'short' is used twice"),
        (
            |s| s.space.poses[1] = "wide".to_owned(),
            "'long', which the pose space lacks",
        ),
        (|s| s.layers[0].poses.truncate(1), "landmark 'toe': 3 entries, but 1"),
        (|s| s.layers[0].poses[0].name = String::new(), "is empty"),
        (
            |s| s.layers[0].poses[2] = PoseSpec::deformed("bent", 2, vec![]),
            "itself",
        ),
        (
            |s| s.layers[0].poses[2] = PoseSpec::deformed("bent", 9, vec![]),
            "does not exist",
        ),
        (|s| s.layers[0].reference = Some(2), "pose 2 cannot be the reference"),
        (
            |s| s.layers[0].landmarks[0].at[2] = at(1.0, 2.0),
            "on pose 'bent', a deformed copy",
        ),
        (
            |s| s.layers[0].landmarks[0].at[0] = at(f64::NAN, 2.0),
            "landmark 'toe' on pose 'short' is NaN",
        ),
        (
            |s| s.layers[0].blend.anchor = Anchor::Point(1),
            "landmark 1, but there are 1",
        ),
        (|s| s.layers[0].mesh.refine.edge_length = 1e-9, "length of edges"),
        (
            |s| s.layers[0].mesh.simplify.tolerance = f64::INFINITY,
            "tolerance of the boundary",
        ),
        (
            |s| s.layers[0].attachment = Some(Attachment { to: 0, landmark: 0 }),
            "hangs on itself",
        ),
        (
            |s| s.draw_orders = vec![vec![0], vec![0], vec![1]],
            "drawing order of pose 'bent'",
        ),
        (|s| s.texture.sharpness = -0.1, "sharpness of textures is -0.1"),
        (
            |s| s.space.places = Places::Given(vec![vec![0.0]; 3]),
            "'short' and 'long' lie at the same place",
        ),
        (
            |s| s.space.places = Places::Given(vec![vec![0.0], vec![1.0, 2.0], vec![3.0]]),
            "'long' has 2 coordinates",
        ),
    ];
    for (change, words) in cases {
        let message = refused(change).to_string();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn an_update_runs_what_differs_and_has_the_shapes_of_a_new_build() {
    let mut spec = spec();
    let mut build = Build::new(&spec).expect("a build");
    type Change = fn(&mut CharacterSpec);
    let changes: [(Change, bool, bool); 5] = [
        (|s| s.layers[0].blend.stretch = Stretch::Log, true, true),
        (|s| s.texture.sharpness = 0.9, true, true),
        // Equal drawings are the same, whoever made them.
        (
            |s| s.layers[0].poses[1] = PoseSpec::drawn("long", letter(24, 40)),
            true,
            true,
        ),
        (|s| s.layers[0].landmarks[0].at[1] = at(40.0, 36.0), false, true),
        (
            |s| s.layers[0].poses[1] = PoseSpec::drawn("long", letter(24, 90)),
            false,
            false,
        ),
    ];
    for (number, (change, keeps_mesh, keeps_pictures)) in changes.into_iter().enumerate() {
        change(&mut spec);
        let updated = build.update(&spec).expect("an update");
        assert_eq!(updated.has_meshes_of(&build), keeps_mesh, "change {number}");
        assert_eq!(updated.has_pictures_of(&build), keeps_pictures, "change {number}");
        let anew = Build::new(&spec).expect("a build");
        for place in [[0.3, 0.3], [0.8, 0.1]] {
            let weights = updated.weights().weights_at(&place).expect("weights");
            assert_eq!(weights, anew.weights().weights_at(&place).expect("weights"));
            let posed = |build: &Build| build.posed(&weights, None).expect("posed");
            assert_eq!(posed(&updated), posed(&anew), "change {number}");
        }
        build = updated;
    }
}

#[test]
fn a_pose_shows_its_drawing_and_places_follow_the_drawings() {
    let mut spec = spec();
    spec.space.places = Places::Automatic;
    let animation = Animation::visiting([[0.0, 0.0].as_slice(), &[1.0, 0.0]], true).expect("an animation");
    let character = Character::new(&spec, &animation, SIZE).expect("a character");
    assert_eq!(character.places().len(), 3);
    assert_eq!(character.animation().at(1.0), character.places()[1]);
    let red = |weights: &[f64]| {
        let frame = character.frame_of(weights).expect("a frame");
        let solid = frame.pixels.iter().filter(|pixel| pixel[3] == 255);
        solid.map(|pixel| pixel[0]).max().expect("something drawn")
    };
    assert_eq!([red(&[1.0, 0.0, 0.0]), red(&[0.0, 1.0, 0.0])], [200, 40]);
}

#[test]
fn landmarks_are_given_on_the_drawing_that_is_reflected() {
    let mut spec = spec();
    let layer = &mut spec.layers[0];
    layer.poses.truncate(2);
    layer.landmarks[0].at.truncate(2);
    let (plain, _) = map_layer(layer).expect("a mapping");
    for pose in &mut layer.poses {
        if let PoseShape::Drawn(drawn) = &mut pose.shape {
            drawn.facing = Facing::Mirrored;
        }
    }
    // The toe is on the right as it is drawn, on the left as it is used.
    let (mirrored, report) = map_layer(layer).expect("a mapping");
    let middle = |pose: usize| {
        let points = plain.outlines[pose].outer().points();
        points.iter().map(|p| p.x).fold(f64::INFINITY, f64::min) + points.iter().map(|p| p.x).fold(0.0, f64::max)
    };
    let toe = &report.landmarks[0];
    assert!((toe.at[0][0].x - (middle(0) - 26.0)).abs() < 1.0, "{:?}", toe.at);
    assert!((mirrored.outlines[1].area() - plain.outlines[1].area()).abs() < 1e-9);
}

#[test]
fn poses_are_known_by_their_names_whatever_their_order() {
    let spec = spec();
    let mut turned = spec.clone();
    turned.space.poses = ["bent", "long", "short"].map(str::to_owned).to_vec();
    let Places::Given(places) = &mut turned.space.places else {
        panic!("they are given")
    };
    places.reverse();
    let [one, other] = [&spec, &turned].map(|spec| Build::new(spec).expect("a build"));
    assert_eq!(turned.originals(), [2, 1, 2]);
    let posed = |build: &Build, weights: &[f64]| build.posed(weights, None).expect("posed").layers[0].positions.clone();
    assert_eq!(posed(&one, &[0.5, 0.2, 0.3]), posed(&other, &[0.3, 0.2, 0.5]));
}
