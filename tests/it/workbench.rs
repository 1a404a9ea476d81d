//! A scene that is edited step by step has the shapes of one that is opened anew.

use std::path::{Path, PathBuf};

use inbetween::scene::{DrawingFiles, Scene, Workbench};

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/clown/scene.toml")
}

fn scene(text: &str) -> Scene {
    Scene::parse(text, &file()).expect("a scene")
}

#[test]
fn edits_repeat_what_they_concern_and_nothing_else() {
    let text = std::fs::read_to_string(file()).expect("readable");
    let mut text = text.replace("[texture]", "[blend]\nstretch = \"linear\"\n\n[texture]");
    let mut bench = Workbench::new(&scene(&text)).expect("a workbench");
    let hand = text
        .find("name = \"left_hand\"")
        .map(|at| at + text[at..].find("stand = [").expect("a place"));
    let hand = hand.expect("the scene has a hand");
    let moved = {
        let end = hand + text[hand..].find(']').expect("closed");
        let numbers: Vec<f64> = text[hand + 9..end]
            .split(',')
            .map(|n| n.trim().parse().expect("a number"))
            .collect();
        format!(
            "{}stand = [{}, {}{}",
            &text[..hand],
            numbers[0] + 1.5,
            numbers[1],
            &text[end..]
        )
    };
    let (mut meshes, mut pictures) = (Vec::new(), Vec::new());
    for (from, to) in [
        ("stretch = \"linear\"", "stretch = \"log\""),
        ("sharpness = 0.8", "sharpness = 0.3"),
        ("at = [1.0, 0.0]", "at = [1.25, 0.0]"),
        ("", ""),
        ("simplify = 0.012", "simplify = 0.015"),
    ] {
        text = if from.is_empty() {
            moved.replace("\"linear\"", "\"log\"")
        } else {
            text.replace(from, to)
        };
        let edited = bench
            .edited(&scene(&text), DrawingFiles::Unchanged)
            .expect("it can be mapped");
        meshes.push(edited.has_meshes_of(&bench));
        pictures.push(edited.has_pictures_of(&bench));
        bench = edited;
        let fresh = Workbench::new(&scene(&text)).expect("a workbench");
        let mut weights = Vec::new();
        for place in [[0.3, 0.4], [-0.6, 0.2]] {
            use inbetween::weights::WeightProvider as _;
            bench.weights().weights(&place, &mut weights).expect("weights");
            let posed = bench.posed(&weights, None).expect("posed");
            assert_eq!(posed, fresh.posed(&weights, None).expect("posed"), "after '{from}'");
            let mut anew = Vec::new();
            fresh.weights().weights(&place, &mut anew).expect("weights");
            assert_eq!(weights, anew, "after '{from}'");
        }
        assert_eq!(bench.notes(), fresh.notes());
        assert_eq!(bench.filmed_anew().expect("a camera").camera(), fresh.camera());
    }
    assert_eq!(meshes, [true, true, true, false, false]);
    assert_eq!(pictures, [true; 5]);
    let size = bench.scene().animation.size.map(|side| side as usize);
    let character = scene(&text).character(size, 1).expect("a character");
    let posed = character.posed_at(&[0.3, 0.4]).expect("posed");
    let mut weights = Vec::new();
    inbetween::weights::WeightProvider::weights(bench.weights().as_ref(), &[0.3, 0.4], &mut weights).expect("weights");
    assert_eq!(bench.posed(&weights, None).expect("posed"), posed);
}

#[test]
fn its_character_draws_what_a_new_one_draws() {
    for name in ["clown", "bear"] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/{name}/scene.toml"));
        let scene = Scene::open(&file).expect("a scene");
        let bench = Workbench::new(&scene).expect("a workbench");
        let own = bench.character().expect("a character");
        let size = scene.animation.size.map(|side| side as usize);
        let anew = scene.character(size, 1).expect("a character");
        let place = vec![0.3; scene.dimension()];
        assert_eq!(
            own.frame_at(&place).expect("a frame"),
            anew.frame_at(&place).expect("a frame")
        );
        assert_eq!(own.notes(), anew.notes());
        assert_eq!(bench.is_drawn_as_curves(0), name == "bear");
    }
}

#[test]
fn edits_that_change_no_art_leave_the_character() {
    let text = std::fs::read_to_string(file()).expect("readable");
    let bench = Workbench::new(&scene(&text)).expect("a workbench");
    let moved = scene(&text.replace("at = [1.0, 0.0]", "at = [1.25, 0.0]"));
    let weights = moved.weights(None).expect("weights");
    assert!(
        bench
            .reweighted(&moved, std::sync::Arc::new(weights))
            .draws_like(&bench)
    );
    let light = text.replace("[texture]", "[texture]\nblending = \"linear\"");
    let other = bench.edited(&scene(&light), DrawingFiles::Unchanged).expect("edited");
    assert!(!other.draws_like(&bench));
}
