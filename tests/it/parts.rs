//! Loose parts of drawings are layers: found, matched over the poses, grown where a pose lacks them, told of.

use std::path::Path;

use inbetween::export::png_bytes;
use inbetween::pipeline::{Character, LayerParts, LayerRole};
use inbetween::render::Frame;
use inbetween::scene::{DrawingFiles, Scene, Workbench};

/// A disc or box of a drawing: middle, half width, half height, colour.
type Shape = (f64, f64, f64, f64, [u8; 4]);

const INK: [u8; 4] = [30, 30, 60, 255];
const RED: [u8; 4] = [210, 40, 40, 255];
const SKIN: [u8; 4] = [240, 190, 150, 255];

/// Discs in a clear picture of 200 x 200.
fn drawn(shapes: &[Shape]) -> Frame {
    let mut frame = Frame::filled(200, 200, [0; 4]);
    for (k, pixel) in frame.pixels.iter_mut().enumerate() {
        let (x, y) = ((k % 200) as f64 + 0.5, (k / 200) as f64 + 0.5);
        for (middle_x, middle_y, half_width, half_height, colour) in shapes {
            let away = ((x - middle_x) / half_width).hypot((y - middle_y) / half_height);
            if away < 1.0 {
                *pixel = *colour;
            }
        }
    }
    frame
}

fn write(folder: &Path, poses: &[(&str, Vec<Shape>)], settings: &str) -> Scene {
    let mut text = "version = 1\n".to_owned();
    for (k, (name, shapes)) in poses.iter().enumerate() {
        let bytes = png_bytes(&drawn(shapes)).expect("a PNG");
        std::fs::write(folder.join(format!("{name}.png")), bytes).expect("written");
        text += &format!("[[pose]]\nname = \"{name}\"\nsource = \"{name}.png\"\nat = [{k}.0, 0.0]\n");
    }
    opened(folder, &(text + settings))
}

fn opened(folder: &Path, text: &str) -> Scene {
    let file = folder.join("scene.toml");
    std::fs::write(&file, text).expect("written");
    Scene::open(&file).expect("a scene")
}

fn character(scene: &Scene) -> Character {
    scene.character([200, 200], 1).expect("a character")
}

/// How many connected pieces of at least 4 pixels a frame shows.
fn pieces(frame: &Frame) -> usize {
    let (width, height) = (frame.width, frame.height);
    let mut is_seen: Vec<bool> = frame.pixels.iter().map(|pixel| pixel[3] >= 60).collect();
    let mut count = 0;
    for start in 0..is_seen.len() {
        let mut open = vec![start];
        let mut size = 0;
        while let Some(at) = open.pop() {
            if !std::mem::replace(&mut is_seen[at], false) {
                continue;
            }
            size += 1;
            let (x, y) = (at % width, at / width);
            open.extend((x > 0).then(|| at - 1));
            open.extend((x + 1 < width).then(|| at + 1));
            open.extend((y > 0).then(|| at - width));
            open.extend((y + 1 < height).then(|| at + width));
        }
        count += usize::from(size >= 4);
    }
    count
}

fn pieces_at(character: &Character, weights: &[f64]) -> usize {
    pieces(&character.frame_of(weights).expect("a frame"))
}

/// The notes that speak of something.
fn remarks(character: &Character, on: &str) -> Vec<String> {
    let told = character.notes().iter().map(ToString::to_string);
    told.filter(|note| note.contains(on)).collect()
}

/// A body with a head that floats above it.
fn floating(x: f64, head: f64) -> Vec<Shape> {
    vec![(x, 140.0, 30.0, 45.0, INK), (x + 4.0, head, 18.0, 18.0, SKIN)]
}

#[test]
fn a_floating_head_stays_with_its_body() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = write(
        folder.path(),
        &[("stand", floating(90.0, 60.0)), ("cheer", floating(110.0, 40.0))],
        "",
    );
    let character = character(&scene);
    for weights in [[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]] {
        assert_eq!(pieces_at(&character, &weights), 2, "{weights:?}");
    }
    assert_eq!(character.layers().len(), 2);
    let told = remarks(&character, "loose");
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].contains("2 loose parts") && told[0].contains("part 2'"),
        "{}",
        told[0]
    );
}

#[test]
fn one_drop_becomes_three_that_come_out_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = vec![(100.0, 100.0, 50.0, 50.0, RED)];
    let three = [40.0, 100.0, 160.0].map(|x| (x, 120.0, 25.0, 25.0, RED)).to_vec();
    let scene = write(folder.path(), &[("one", one), ("three", three)], "");
    let character = character(&scene);
    assert_eq!(pieces_at(&character, &[1.0, 0.0]), 1);
    assert_eq!(pieces_at(&character, &[0.0, 1.0]), 3);
    // At first they are inside the one that divides.
    assert_eq!(pieces_at(&character, &[0.9, 0.1]), 1);
    let whole = character.frame_of(&[1.0, 0.0]).expect("a frame");
    let nearly = character.frame_of(&[0.999, 0.001]).expect("a frame");
    let changed = whole
        .pixels
        .iter()
        .zip(&nearly.pixels)
        .filter(|(a, b)| a[3].abs_diff(b[3]) > 40)
        .count();
    assert!(changed < 40, "{changed} pixels jump");
}

#[test]
fn an_eyebrow_that_a_pose_lacks_grows_in_its_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let head = |x: f64| (x, 120.0, 50.0, 60.0, SKIN);
    let surprised = vec![head(100.0), (75.0, 40.0, 14.0, 5.0, INK), (125.0, 40.0, 14.0, 5.0, INK)];
    let scene = write(
        folder.path(),
        &[("calm", vec![head(80.0)]), ("surprised", surprised)],
        "",
    );
    let character = character(&scene);
    assert_eq!(pieces_at(&character, &[1.0, 0.0]), 1);
    assert_eq!(pieces_at(&character, &[0.5, 0.5]), 3);
    // Half as large, half-way between where it would be above the calm head and where it is.
    let posed = character.posed_of(&[0.5, 0.5]).expect("posed");
    let brow = |layer: usize| {
        let at = &posed.layers[layer].positions;
        let x = at.iter().map(|p| p.x);
        (
            x.clone().fold(f64::INFINITY, f64::min),
            x.fold(f64::NEG_INFINITY, f64::max),
        )
    };
    let brows: Vec<(f64, f64)> = (0..3)
        .filter(|k| character.layers()[*k].name().contains("part"))
        .map(brow)
        .collect();
    for (low, high) in brows {
        assert!((high - low - 14.0).abs() < 2.0, "{low} to {high}");
        let middle = (low + high) / 2.0;
        assert!((middle - 65.0).abs() < 2.0 || (middle - 115.0).abs() < 2.0, "{middle}");
    }
}

#[test]
fn a_dot_that_passes_its_stem_is_carried_as_curves() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawing = |dot: u32, stem: u32| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 200\" width=\"200\" height=\"200\">\
             <g fill=\"#224\"><circle id=\"dot\" cx=\"100\" cy=\"{dot}\" r=\"15\"/>\
             <rect id=\"stem\" x=\"85\" y=\"{stem}\" width=\"30\" height=\"100\"/></g></svg>"
        )
    };
    std::fs::write(folder.path().join("i.svg"), drawing(30, 60)).expect("written");
    std::fs::write(folder.path().join("bang.svg"), drawing(170, 30)).expect("written");
    let text = "version = 1\n[[pose]]\nname = \"i\"\nsource = \"i.svg\"\nat = [0.0, 0.0]\n\
                [[pose]]\nname = \"bang\"\nsource = \"bang.svg\"\nat = [1.0, 0.0]\n";
    let scene = opened(folder.path(), text);
    let character = character(&scene);
    let names: Vec<&str> = character.layers().iter().map(|layer| layer.name()).collect();
    assert!(names.contains(&"dot"), "{names:?}");
    // The dot is a dot everywhere, and on its way it is in the middle of its two places.
    let dot = names.iter().position(|name| *name == "dot").expect("a dot");
    let posed = character.posed_of(&[0.5, 0.5]).expect("posed");
    let at = &posed.layers[dot].positions;
    let middle = at.iter().map(|p| p.y).sum::<f64>() / at.len() as f64;
    assert!((middle - 100.0).abs() < 3.0, "{middle}");
    let svg = inbetween::export::svg_text(&character.draw(&posed)).expect("text");
    assert!(svg.contains("id=\"dot_dot\"") && svg.contains("<path"), "{svg}");
    for weights in [[1.0, 0.0], [0.0, 1.0]] {
        assert_eq!(pieces_at(&character, &weights), 2);
    }
}

#[test]
fn parts_can_be_left_out_kept_and_dropped() {
    let folder = tempfile::tempdir().expect("a folder");
    let poses = [("stand", floating(90.0, 60.0)), ("cheer", floating(110.0, 40.0))];
    let largest = write(folder.path(), &poses, "[input]\nparts = \"largest\"\n");
    let without = character(&largest);
    assert_eq!((without.layers().len(), pieces_at(&without, &[0.5, 0.5])), (1, 1));
    assert!(!remarks(&without, "loose part").is_empty(), "{:?}", without.notes());
    // A place on the head drops it, a place on it keeps it where all others are left out.
    let text = std::fs::read_to_string(&largest.file).expect("text");
    let with = |key: &str, text: &str| {
        let heads = [("stand", "94.0, 60.0"), ("cheer", "114.0, 40.0")];
        heads.iter().fold(text.to_owned(), |text, (name, at)| {
            text.replace(
                &format!("name = \"{name}\""),
                &format!("name = \"{name}\"\n{key} = [ [{at}] ]"),
            )
        })
    };
    let kept = character(&opened(folder.path(), &with("keep", &text)));
    assert_eq!((kept.layers().len(), pieces_at(&kept, &[0.5, 0.5])), (2, 2));
    let all = text.replace("[input]\nparts = \"largest\"\n", "");
    let dropped = character(&opened(folder.path(), &with("drop", &all)));
    assert_eq!((dropped.layers().len(), pieces_at(&dropped, &[0.5, 0.5])), (1, 1));
    assert!(remarks(&dropped, "loose part").is_empty());
    // A place beside everything is refused with what to do.
    let beside = all.replace("name = \"stand\"", "name = \"stand\"\ndrop = [ [5.0, 195.0] ]");
    let refusal = opened(folder.path(), &beside)
        .spec()
        .expect_err("nothing is there")
        .to_string();
    assert!(
        refusal.contains("stand") && refusal.contains("(5.0, 195.0)"),
        "{refusal}"
    );
}

#[test]
fn in_a_scene_with_layers_a_place_names_parts_of_the_drawings_that_have_one_there() {
    let folder = tempfile::tempdir().expect("a folder");
    // A ball floats beside the body; on the arm, which lies over the body, is a speck.
    let body = [(100.0, 110.0, 50.0, 60.0, INK), (20.0, 30.0, 12.0, 12.0, RED)];
    let arm = [(60.0, 60.0, 14.0, 12.0, SKIN), (100.0, 100.0, 4.0, 4.0, SKIN)];
    for (name, shapes) in [("body", body), ("arm", arm)] {
        for pose in ["stand", "wave"] {
            let bytes = png_bytes(&drawn(&shapes)).expect("a PNG");
            std::fs::write(folder.path().join(format!("{pose}-{name}.png")), bytes).expect("written");
        }
    }
    let text = |said: &str| {
        let pose = |pose: &str, at: &str, said: &str| {
            format!(
                "[[pose]]\nname = \"{pose}\"\nat = {at}\n{said}source = {{ body = \"{pose}-body.png\", arm = \"{pose}-arm.png\" }}\n"
            )
        };
        let layers = "[[layer]]\nname = \"body\"\n[[layer]]\nname = \"arm\"\n";
        format!(
            "version = 1\n{}{}{layers}",
            pose("stand", "[0.0, 0.0]", said),
            pose("wave", "[1.0, 0.0]", said)
        )
    };
    let layers = |said: &str| -> Vec<String> {
        let character = character(&opened(folder.path(), &text(said)));
        character.layers().iter().map(|layer| layer.name().to_owned()).collect()
    };
    let all = layers("");
    assert_eq!(all.len(), 4, "{all:?}");
    // The ball and the speck are taken out of the drawing that each is on; the body, which is under the speck, stays.
    assert_eq!(layers("drop = [ [20.0, 30.0] ]\n").len(), 3);
    assert_eq!(layers("drop = [ [20.0, 30.0], [100.0, 100.0] ]\n"), ["body", "arm"]);
    // Kept where all others are left out.
    let largest = |said: &str| {
        let text = text(said) + "[input]\nparts = \"largest\"\n";
        character(&opened(folder.path(), &text)).layers().len()
    };
    assert_eq!((largest(""), largest("keep = [ [100.0, 100.0] ]\n")), (2, 3));
    // What is on no drawing, or the whole of the only one that is there, is refused; for one layer alone, too.
    for said in ["keep = [ [190.0, 10.0] ]\n", "drop = [ [100.0, 160.0] ]\n"] {
        let scene = opened(folder.path(), &text(said));
        for refusal in [scene.spec().err(), scene.layer_spec(1).err()] {
            let refusal = refusal.expect("nothing is there").to_string();
            assert!(
                refusal.contains("scene.toml:") && refusal.contains("pose 'stand'"),
                "{refusal}"
            );
        }
    }
}

#[test]
fn dust_is_no_part_and_is_told_of_in_a_line_a_pose() {
    let folder = tempfile::tempdir().expect("a folder");
    let dusty = |x: f64, seed: usize| {
        let specks = (0..40).map(move |k| {
            let (column, row) = ((k * 37 + seed * 11) % 13, k % 3);
            (6.0 + 15.0 * column as f64, 6.0 + 9.0 * row as f64, 1.9, 1.9, INK)
        });
        std::iter::once((x, 120.0, 60.0, 70.0, INK))
            .chain(specks)
            .collect::<Vec<Shape>>()
    };
    let scene = write(folder.path(), &[("a", dusty(90.0, 1)), ("b", dusty(105.0, 2))], "");
    let character = character(&scene);
    assert_eq!((character.layers().len(), pieces_at(&character, &[0.5, 0.5])), (1, 1));
    let told = remarks(&character, "speck");
    assert_eq!(told.len(), 2, "{:?}", character.notes());
    assert!(remarks(&character, "loose").is_empty(), "{:?}", character.notes());
}

#[test]
fn landmarks_go_to_the_part_that_they_lie_on_and_settle_which_is_which() {
    let folder = tempfile::tempdir().expect("a folder");
    // Two balls of one kind beside a body; by place alone each would stay on its side.
    let pose = |body: f64| {
        vec![
            (body, 140.0, 50.0, 40.0, INK),
            (50.0, 50.0, 20.0, 20.0, RED),
            (150.0, 50.0, 20.0, 20.0, RED),
        ]
    };
    let landmark = "[[landmark]]\nname = \"ball\"\nat = { a = [50.0, 50.0], b = [150.0, 50.0] }\n";
    let scene = write(folder.path(), &[("a", pose(100.0)), ("b", pose(105.0))], landmark);
    let character = character(&scene);
    let ball = character.layers().iter().position(|layer| {
        let first = &layer.mapping().outlines[0];
        first.contains(inbetween::math::Point::new(50.0, 50.0))
    });
    let posed = character.posed_of(&[0.0, 1.0]).expect("posed");
    let at = &posed.layers[ball.expect("a ball")].positions;
    let middle = at.iter().map(|p| p.x).sum::<f64>() / at.len() as f64;
    assert!((middle - 150.0).abs() < 3.0, "{middle}");
}

#[test]
fn a_shadow_on_the_ground_lies_behind_and_copies_have_their_parts() {
    let folder = tempfile::tempdir().expect("a folder");
    let shadow = [20, 20, 20, 90];
    let pose = |height: f64| vec![(100.0, height, 30.0, 45.0, RED), (100.0, 185.0, 50.0, 8.0, shadow)];
    let copy = "[[pose]]\nname = \"lean\"\ndeform_of = \"low\"\nat = [0.0, 1.0]\n\
                handles = [ { from = [100.0, 90.0], to = [110.0, 90.0] }, { from = [100.0, 150.0], to = [100.0, 150.0] } ]\n\
                [input]\nthreshold = 0.2\n";
    let scene = write(folder.path(), &[("low", pose(120.0)), ("high", pose(80.0))], copy);
    let spec = scene.spec().expect("a specification");
    let roles: Vec<LayerRole> = spec.layers.iter().map(|layer| layer.role).collect();
    assert_eq!(roles, [LayerRole::LoosePart, LayerRole::Body]);
    let character = character(&scene);
    assert_eq!(pieces_at(&character, &[0.0, 0.0, 1.0]), 2);
    // The shadow has no handle and stays.
    let low = character.posed_of(&[1.0, 0.0, 0.0]).expect("posed");
    let lean = character.posed_of(&[0.0, 0.0, 1.0]).expect("posed");
    let moved = |layer: usize| {
        let pairs = low.layers[layer].positions.iter().zip(&lean.layers[layer].positions);
        pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    };
    assert!(moved(0) < 1e-6 && moved(1) > 3.0, "{} {}", moved(0), moved(1));
}

#[test]
fn the_mapping_of_the_largest_part_lists_them_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let poses = [("stand", floating(90.0, 60.0)), ("cheer", floating(110.0, 40.0))];
    let scene = write(folder.path(), &poses, "");
    let parts = LayerParts::of(&scene.layer_spec(0).expect("a layer"), &[]);
    assert_eq!(
        (parts.layers.len(), parts.layers[parts.largest].role),
        (2, LayerRole::Body)
    );
    let areas: Vec<Vec<f64>> = (parts.outlines.iter())
        .map(|outlines| outlines.iter().map(|outline| outline.area()).collect())
        .collect();
    for of_pose in areas {
        let [body, head] = of_pose[..] else {
            panic!("{of_pose:?}")
        };
        assert!(
            (body / (std::f64::consts::PI * 30.0 * 45.0) - 1.0).abs() < 0.02,
            "{body}"
        );
        assert!(
            (head / (std::f64::consts::PI * 18.0 * 18.0) - 1.0).abs() < 0.02,
            "{head}"
        );
    }
}

#[test]
fn an_edit_of_a_scene_with_parts_gives_what_a_new_one_gives() {
    let folder = tempfile::tempdir().expect("a folder");
    let poses = [("stand", floating(90.0, 60.0)), ("cheer", floating(110.0, 40.0))];
    let scene = write(folder.path(), &poses, "");
    let bench = Workbench::new(&scene).expect("a workbench");
    let mut edited = scene.clone();
    edited.mesh.simplify.tolerance = 0.01;
    let after = bench.edited(&edited, DrawingFiles::Unchanged).expect("an edit");
    let new = Workbench::new(&edited).expect("a workbench");
    let posed = |bench: &Workbench| bench.posed(&[0.5, 0.5], None).expect("posed");
    assert_eq!(posed(&after), posed(&new));
    assert_eq!(after.layers().len(), 2);
}

#[test]
fn single_pixels_of_sprites_are_parts() {
    let folder = tempfile::tempdir().expect("a folder");
    let sprite = |name: &str, lift: usize, sparks: &[[usize; 2]]| {
        let mut frame = Frame::filled(32, 32, [0; 4]);
        for y in 12 - lift..26 - lift {
            frame.pixels[y * 32 + 11..y * 32 + 20].fill([200, 60, 40, 255]);
        }
        for [x, y] in sparks {
            frame.pixels[y * 32 + x] = [255, 240, 60, 255];
        }
        std::fs::write(folder.path().join(name), png_bytes(&frame).expect("a PNG")).expect("written");
        frame
    };
    let drawn = [
        sprite("rest.png", 0, &[]),
        sprite("burst.png", 4, &[[5, 4], [27, 6], [3, 15]]),
    ];
    let text = "version = 1\n[[pose]]\nname = \"rest\"\nsource = \"rest.png\"\nat = [0.0, 0.0]\n\
                [[pose]]\nname = \"burst\"\nsource = \"burst.png\"\nat = [1.0, 0.0]\n\
                [texture]\nsampling = \"nearest\"\n[animation]\ncamera = \"drawing\"\n";
    let scene = opened(folder.path(), text);
    let character = scene.character([32, 32], 1).expect("a character");
    assert_eq!(character.layers().len(), 4);
    for (weights, drawn) in [[1.0, 0.0], [0.0, 1.0]].iter().zip(&drawn) {
        assert_eq!(
            character.frame_of(weights).expect("a frame").pixels,
            drawn.pixels,
            "{weights:?}"
        );
    }
}

#[test]
fn a_reflected_pose_reflects_its_parts_with_its_body() {
    let folder = tempfile::tempdir().expect("a folder");
    let mirrored = "[animation]\ncamera = \"drawing\"\n";
    let scene = write(
        folder.path(),
        &[("a", floating(90.0, 60.0)), ("b", floating(90.0, 60.0))],
        mirrored,
    );
    let text = std::fs::read_to_string(&scene.file).expect("text");
    let scene = opened(
        folder.path(),
        &text.replace("name = \"b\"", "name = \"b\"\nmirror = true"),
    );
    let frame = character(&scene).frame_of(&[0.0, 1.0]).expect("a frame");
    // The body's middle is at 90; the head, 4 to its right, comes to be 4 to its left.
    let columns = (0..200).filter(|x| frame.pixels[60 * 200 + x][3] >= 128);
    let (sum, count) = columns.fold((0.0, 0.0), |(sum, count), x| (sum + x as f64 + 0.5, count + 1.0));
    assert!((sum / count - 86.0_f64).abs() < 0.5, "{}", sum / count);
}
