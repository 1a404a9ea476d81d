//! Frames on the drawings' own canvas: at a pose the frame is the drawing, at its place, pixel for pixel.

use std::path::Path;

use inbetween::export::png_bytes;
use inbetween::input::read_picture;
use inbetween::render::Frame;
use inbetween::scene::Scene;

/// Two sprites of 32 x 32 that are no mirror images of one another, with single pixels of other colours and one that stands out.
fn sprite(jump: bool) -> Frame {
    let mut frame = Frame::filled(32, 32, [0; 4]);
    let lift = if jump { 5 } else { 0 };
    for y in 0..32_usize {
        for x in 0..32_usize {
            let (top, bottom) = (10 - lift, 26 - lift);
            let is_body = (11..20).contains(&x) && (top..bottom).contains(&y);
            let is_arm = (6..25).contains(&x) && (top + 3..top + 5).contains(&y);
            let is_tip = x == 15 && y + 1 == top;
            frame.pixels[y * 32 + x] = match (is_tip, is_body, is_arm) {
                (true, ..) => [250, 220, 30, 255],
                (_, true, _) if (x + 2 * y + lift).is_multiple_of(7) => [20, 20, 40, 255],
                (_, true, _) => [200, 60, 40, 255],
                (.., true) => [60, 120, 220, 255],
                _ => continue,
            };
        }
    }
    frame
}

fn scene(folder: &Path, drawings: &[(&str, Frame)], settings: &str) -> Scene {
    let mut text = "version = 1\n".to_owned();
    for (k, (name, frame)) in drawings.iter().enumerate() {
        let bytes = png_bytes(frame).expect("a PNG");
        std::fs::write(folder.join(format!("{name}.png")), bytes).expect("written");
        text += &format!("[[pose]]\nname = \"{name}\"\nsource = \"{name}.png\"\nat = [{k}.0, 0.0]\n");
    }
    let file = folder.join("scene.toml");
    std::fs::write(&file, text + settings).expect("written");
    Scene::open(&file)
        .expect("a scene")
        .with_automatic_places()
        .expect("laid out")
}

/// A frame at a pose, of the scene's own size times `times`.
fn frame(scene: &Scene, pose: usize, times: usize) -> Frame {
    let size = scene.animation.size.map(|side| side as usize * times);
    let character = scene.character(size, 1).expect("a character");
    let weights: Vec<f64> = (0..scene.poses.len()).map(|k| f64::from(u8::from(k == pose))).collect();
    character.frame_of(&weights).expect("a frame")
}

#[test]
fn sprites_come_out_pixel_for_pixel_and_whole_multiples_are_squares() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawings = [("idle", sprite(false)), ("jump", sprite(true))];
    let settings = "[texture]\nsampling = \"nearest\"\n[animation]\ncamera = \"drawing\"\n";
    let scene = scene(folder.path(), &drawings, settings);
    assert_eq!(scene.animation.size, [32, 32]);
    for (pose, (name, drawn)) in drawings.iter().enumerate() {
        assert_eq!(frame(&scene, pose, 1).pixels, drawn.pixels, "{name}");
        let large = frame(&scene, pose, 3);
        for y in 0..96 {
            for x in 0..96 {
                assert_eq!(
                    large.pixels[y * 96 + x],
                    drawn.pixels[y / 3 * 32 + x / 3],
                    "{name} at ({x}, {y})"
                );
            }
        }
    }
}

#[test]
fn nearest_sampling_makes_no_colour_where_one_drawing_is_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawings = [("idle", sprite(false)), ("jump", sprite(true))];
    let settings = "[texture]\nsampling = \"nearest\"\nsharpness = 1.0\n[animation]\ncamera = \"drawing\"\n";
    let scene = scene(folder.path(), &drawings, settings);
    let character = scene.character([96, 96], 1).expect("a character");
    let between = character.frame_of(&[0.6, 0.4]).expect("a frame");
    let palette = &drawings[0].1.pixels;
    assert!(between.pixels.iter().all(|pixel| palette.contains(pixel)));
    assert!(between.pixels.iter().filter(|pixel| pixel[3] > 0).count() > 1000);
}

#[test]
fn a_smooth_frame_at_a_pose_lies_over_its_drawing_on_the_largest_canvas() {
    let folder = tempfile::tempdir().expect("a folder");
    // A disc with a soft edge in pages of two sizes.
    let disc = |width: usize, height: usize, x: f64, y: f64| {
        let mut frame = Frame::filled(width, height, [0; 4]);
        for (k, pixel) in frame.pixels.iter_mut().enumerate() {
            let away = ((k % width) as f64 + 0.5 - x).hypot((k / width) as f64 + 0.5 - y);
            let alpha = ((20.5 - away).clamp(0.0, 1.0) * 255.0).round() as u8;
            *pixel = [alpha, 0, 0, alpha];
        }
        frame
    };
    let drawings = [("small", disc(60, 50, 25.0, 24.0)), ("large", disc(90, 60, 60.0, 33.0))];
    let scene = scene(folder.path(), &drawings, "[animation]\ncamera = \"drawing\"\n");
    assert_eq!(scene.animation.size, [90, 60]);
    for (pose, (name, drawn)) in drawings.iter().enumerate() {
        let shown = frame(&scene, pose, 1);
        let [left, top] = [(90 - drawn.width) / 2, (60 - drawn.height) / 2];
        for (k, pixel) in drawn.pixels.iter().enumerate() {
            let at = (k / drawn.width + top) * 90 + k % drawn.width + left;
            let off = shown.pixels[at].iter().zip(pixel).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(off <= Some(40), "{name}: {:?} for {pixel:?} at {k}", shown.pixels[at]);
        }
    }
}

#[test]
fn curves_lie_over_their_drawing_on_its_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawing = |x: u32, fill: &str| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"100\" viewBox=\"-50 -20 100 50\">\
             <path id=\"box\" fill=\"{fill}\" d=\"M{x} -10 h20 v25 h-26 z\"/></svg>"
        )
    };
    let mut text = "version = 1\n".to_owned();
    for (k, x) in [10, 20].iter().enumerate() {
        std::fs::write(folder.path().join(format!("p{k}.svg")), drawing(*x, "#246")).expect("written");
        text += &format!("[[pose]]\nname = \"p{k}\"\nsource = \"p{k}.svg\"\nat = [{k}.0, 0.0]\n");
    }
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, text + "[animation]\ncamera = \"drawing\"\n").expect("written");
    let scene = Scene::open(&file)
        .expect("a scene")
        .with_automatic_places()
        .expect("laid out");
    assert_eq!(scene.animation.size, [200, 100]);
    let character = scene.character([200, 100], 1).expect("a character");
    let posed = character.posed_of(&[0.0, 1.0]).expect("posed");
    let svg = inbetween::export::svg_text(&character.draw(&posed)).expect("text");
    // The box's corner at (20, -10) of the user units is at (140, 20) of the page, two pixels a unit.
    let shown = read_picture(&png_bytes(&character.paint(&posed)).expect("a PNG")).expect("a picture");
    let alpha = |x: usize, y: usize| shown.pixels[y * 200 + x][3];
    assert_eq!(
        (
            alpha(141, 21),
            alpha(141, 18),
            alpha(137, 21),
            alpha(178, 21),
            alpha(181, 21)
        ),
        (255, 0, 0, 255, 0)
    );
    assert!(svg.contains("140"), "{svg}");
}
