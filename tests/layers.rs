//! The scene with layers: an arm that crosses the chest, and a flower that is not always there.

mod workshop;

use std::path::{Path, PathBuf};

use inbetween::math::Point;
use inbetween::mesh::PointLocator;
use inbetween::pipeline::{Character, Posed, ShapePoint};
use inbetween::render::{Camera, Frame};
use inbetween::scene::{Scene, SceneLayer};
use resvg::tiny_skia::{Pixmap, Transform};
use workshop::Workshop;

const SIZE: [usize; 2] = [240, 270];

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/bear/scene.toml")
}

fn bear() -> (Scene, Character) {
    let scene = Scene::open(&file()).expect("a scene");
    let character = Character::new(&scene, SIZE).expect("a character");
    (scene, character)
}

fn layer<'a>(scene: &'a Scene, name: &str) -> (usize, &'a SceneLayer) {
    let index = scene.layers.iter().position(|layer| layer.name == name);
    let index = index.expect("a layer");
    (index, &scene.layers[index])
}

/// A pose's whole drawing in one go, by the renderer itself, before white.
fn drawn_whole(file: &Path, camera: &Camera) -> Frame {
    let text = std::fs::read_to_string(file).expect("a drawing");
    let tree = resvg::usvg::Tree::from_str(&text, &resvg::usvg::Options::default()).expect("an SVG");
    let [columns, rows] = camera.size();
    let mut pixmap = Pixmap::new(columns as u32, rows as u32).expect("a size");
    let origin = camera.to_frame(Point::new(0.0, 0.0));
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
