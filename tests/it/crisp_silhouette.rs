//! Frames between poses have edges as crisp as the poses': measured on the scenes in `data`.
//!
//! The width of the alpha ramp is the area of the pixels that are partly covered (10 to 90 %) divided by the length of the
//! silhouette, which is the total variation of alpha: two faint edges in the place of one have its length together, and
//! twice its area. An exactly covered straight edge has 0.6 to 0.8 pixels.

use inbetween::animation::Background;

use inbetween::pipeline::ArtChoice;
use inbetween::render::Frame;
use inbetween::scene::Scene;

/// Between poses at most this times the widest of the poses.
const WIDER: f64 = 1.5;

fn ramp_px(frame: &Frame) -> f64 {
    let alpha = |x: usize, y: usize| f64::from(frame.pixels[y * frame.width + x][3]) / 255.0;
    let (mut partly, mut length) = (0.0, 0.0);
    for y in 0..frame.height - 1 {
        for x in 0..frame.width - 1 {
            let here = alpha(x, y);
            partly += f64::from((0.1..=0.9).contains(&here));
            length += (alpha(x + 1, y) - here).hypot(alpha(x, y + 1) - here);
        }
    }
    partly / length
}

fn check(name: &str, art: ArtChoice) {
    let path = format!("{}/data/{name}/scene.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::open(path.as_ref())
        .expect("a scene")
        .with_automatic_places()
        .expect("places");
    scene.animation.background = Background::Transparent;
    scene.art = art;
    let character = scene.character([400, 400], 1).expect("a character");
    let count = scene.poses.len();
    let ramp = |weights: &[f64]| ramp_px(&character.frame_of(weights).expect("a frame"));
    let unit = |pose: usize| (0..count).map(|k| f64::from(u8::from(k == pose))).collect::<Vec<f64>>();
    let poses = (0..count).map(|pose| ramp(&unit(pose))).fold(0.0, f64::max);
    let mut between: f64 = ramp(&vec![1.0 / count as f64; count]);
    for first in 0..count {
        for second in 0..first {
            let weights: Vec<f64> = (0..count)
                .map(|k| 0.5 * f64::from(u8::from(k == first || k == second)))
                .collect();
            between = between.max(ramp(&weights));
        }
    }
    assert!(
        between <= WIDER * poses,
        "{name}: {between} px between poses of {poses} px"
    );
    // That the measure tells: a cross-fade of two poses as pictures fails it.
    let mut fade = character.frame_of(&unit(0)).expect("a frame");
    let other = character.frame_of(&unit(count - 1)).expect("a frame");
    for (pixel, with) in fade.pixels.iter_mut().zip(&other.pixels) {
        *pixel = std::array::from_fn(|k| ((u32::from(pixel[k]) + u32::from(with[k])) / 2) as u8);
    }
    let faded = ramp_px(&fade);
    assert!(
        faded > WIDER * poses,
        "{name}: even {faded} px would pass, poses {poses} px"
    );
    if std::env::var_os("SHOW_RAMPS").is_some() {
        use std::io::Write as _;
        let line = format!("{name}: poses {poses:.3} px, between {between:.3} px, a cross-fade {faded:.3} px\n");
        std::io::stderr().write_all(line.as_bytes()).expect("a line");
    }
}

#[test]
fn walker() {
    check("walker", ArtChoice::Pixels);
}

#[test]
fn clown() {
    check("clown", ArtChoice::Pixels);
}

#[test]
fn snake() {
    check("snake", ArtChoice::Pixels);
}

#[test]
fn face() {
    check("face", ArtChoice::Pixels);
}

#[test]
fn snake_as_curves() {
    check("snake", ArtChoice::Curves);
}

#[test]
fn face_as_curves() {
    check("face", ArtChoice::Curves);
}
