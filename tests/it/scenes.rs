//! Every scene in `data` is mapped and shows each of its poses.

use std::path::{Path, PathBuf};

use inbetween::scene::Scene;

fn scene_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join(name)
        .join("scene.toml")
}

/// The scene's character, its mapping proven, every pose seen at its place.
fn shown(name: &str) {
    let scene = Scene::open(&scene_file(name)).expect("a scene");
    let character = scene.character([192, 216], 1).expect("a character");
    for layer in character.layers() {
        layer.mapping().check().expect("a valid mapping");
        assert_eq!(layer.mapping().poses.len(), layer.poses().len());
    }
    for pose in &scene.poses {
        let frame = character.frame_at(&pose.at).expect("a frame");
        // Every scene stands before a colour: the character is what differs from the corner.
        let differing = frame.pixels.iter().filter(|p| **p != frame.pixels[0]).count();
        assert!(differing > 1500, "{name}, {}: {differing} pixels", pose.name);
    }
}

#[test]
fn the_walker() {
    shown("walker");
}

#[test]
fn the_snake() {
    shown("snake");
}

#[test]
fn the_face() {
    shown("face");
}

#[test]
fn the_clown() {
    shown("clown");
}

#[test]
fn the_bear() {
    shown("bear");
}

#[test]
fn the_wizard() {
    shown("wizard");
}

#[test]
fn the_wizards_loose_parts_are_a_hat_three_sparks_and_a_drop() {
    let scene = Scene::open(&scene_file("wizard")).expect("a scene");
    let character = scene.character([192, 216], 1).expect("a character");
    assert_eq!(character.layers().len(), 6);
    let told = character
        .notes()
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n");
    // The drop alone is in one drawing only, and the shadow at the sheet's edge is no part.
    assert_eq!(told.matches("(not in 2 poses)").count(), 1, "{told}");
    assert_eq!(told.matches("along a whole border").count(), 3, "{told}");
}

#[test]
fn no_scene_is_forgotten() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let folders = std::fs::read_dir(data).expect("a folder");
    let mut names: Vec<String> = folders
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| scene_file(name).is_file())
        .collect();
    names.sort();
    assert_eq!(names, ["bear", "clown", "face", "snake", "walker", "wizard"]);
}
