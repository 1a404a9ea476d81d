//! Pixels, places, names and order of layered files.

use inbetween::input::InputError;
use inbetween::input::layered::{BlendMode, Clipping, Layer, LayeredError, LayeredFile};

use super::art::{Content, Node, Patch, SIZE, ellipse, poses};
use super::zip::{self, Packing};
use super::{ase, kra, ora, psd};

/// A picture of a file, pixel by pixel.
pub(crate) fn picture(bytes: &[u8], element: Option<&str>) -> Vec<[u8; 4]> {
    let file = LayeredFile::open(bytes).expect("a layered file");
    let picture = file.picture(element, 0).expect("a picture");
    assert_eq!(picture.size, SIZE.map(|side| side as usize));
    picture
        .rgba
        .chunks_exact(4)
        .map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]])
        .collect()
}

/// What a patch alone shows on the canvas.
pub(crate) fn on_canvas(patch: &Patch<[u8; 4]>) -> Vec<[u8; 4]> {
    let mut pixels = vec![[0; 4]; (SIZE[0] * SIZE[1]) as usize];
    for (k, value) in patch.values.iter().enumerate() {
        let (x, y) = (
            patch.left + (k as u32 % patch.width) as i32,
            patch.top + (k as u32 / patch.width) as i32,
        );
        if (0..SIZE[0] as i32).contains(&x) && (0..SIZE[1] as i32).contains(&y) && value[3] > 0 {
            pixels[(y as u32 * SIZE[0] + x as u32) as usize] = *value;
        }
    }
    pixels
}

/// All paths of a file, and whether each is a group.
pub(crate) fn paths(layers: &[Layer]) -> Vec<(String, bool)> {
    let mut found = Vec::new();
    for layer in layers {
        found.push((layer.path.clone(), layer.is_group()));
        found.extend(paths(layer.children()));
    }
    found
}

/// A face whose patches overlap and reach beyond the canvas: a group that is half transparent, with a layer that is multiplied, one that is clipped and a mask.
pub(crate) fn face() -> Vec<Node> {
    let head = ellipse([30.0, 20.0], [40.0, 30.0], [220, 180, 150]);
    let mut shade = Node::layer("shade", ellipse([50.0, 25.0], [30.0, 12.0], [120, 130, 200]));
    shade.is_multiplied = true;
    shade.opacity = 180;
    let mut freckles = Node::layer("freckles", ellipse([70.0, 20.0], [25.0, 9.0], [90, 40, 20]));
    freckles.is_clipped = true;
    let mut hidden = Node::layer("sketch", ellipse([20.0, 60.0], [10.0, 9.0], [0, 0, 0]));
    hidden.is_visible = false;
    let eye = Node::layer("eye", ellipse([40.0, 30.0], [5.0, 4.0], [20, 20, 20]));
    let mut eyes = Node::group("eyes", vec![eye.clone(), eye]);
    eyes.mask = Some(Patch::new([0, 0], [42, 72], |x, _| if x < 38 { 255 } else { 100 }));
    vec![
        Node::layer("paper", Patch::new([0, 0], SIZE, |_, _| [250, 250, 240, 255])),
        Node::group("face", vec![Node::layer("head", head), freckles, shade, eyes, hidden]),
    ]
}

/// Composed in floating point, by the formulas of the standard, from back to front.
pub(crate) fn composed(nodes: &[Node]) -> Vec<[f64; 4]> {
    let mut sheet = vec![[0.0; 4]; (SIZE[0] * SIZE[1]) as usize];
    compose_onto(&mut sheet, nodes);
    sheet
}

fn compose_onto(sheet: &mut [[f64; 4]], nodes: &[Node]) {
    let mut place = 0;
    while let Some(node) = nodes.get(place) {
        let count = nodes[place + 1..].iter().take_while(|other| other.is_clipped).count();
        let clipped = &nodes[place + 1..=place + count];
        place += 1 + count;
        match &node.content {
            _ if !node.is_visible => {}
            Content::Group(children) if node.passes_through => compose_onto(sheet, children),
            _ => {
                // What is clipped by a layer is one with it.
                let mut whole = alone(node);
                for other in clipped {
                    blend(&mut whole, &alone(other), other, true);
                }
                blend(sheet, &whole, node, false);
            }
        }
    }
}

/// The pixels of a layer or group, cut by its mask, colours multiplied by alpha.
fn alone(node: &Node) -> Vec<[f64; 4]> {
    let mut own: Vec<[f64; 4]> = match &node.content {
        Content::Group(children) => composed(children),
        Content::Pixels(patch) => on_canvas(patch)
            .into_iter()
            .map(|pixel| {
                let [red, green, blue, alpha] = pixel.map(|value| f64::from(value) / 255.0);
                [red * alpha, green * alpha, blue * alpha, alpha]
            })
            .collect(),
    };
    let Some(mask) = &node.mask else { return own };
    for (k, pixel) in own.iter_mut().enumerate() {
        let (x, y) = (
            k as i32 % SIZE[0] as i32 - mask.left,
            k as i32 / SIZE[0] as i32 - mask.top,
        );
        let is_inside = (0..mask.width as i32).contains(&x) && (0..mask.height as i32).contains(&y);
        let index = (y * mask.width as i32 + x) as usize;
        let through = if is_inside {
            f64::from(mask.values[index]) / 255.0
        } else {
            0.0
        };
        *pixel = pixel.map(|part| part * through);
    }
    own
}

/// Draws pixels over others, or within them.
fn blend(sheet: &mut [[f64; 4]], own: &[[f64; 4]], node: &Node, is_within: bool) {
    for (behind, own) in sheet.iter_mut().zip(own) {
        let own = own.map(|part| part * f64::from(node.opacity) / 255.0);
        let before = *behind;
        for k in 0..3 {
            let beside = if node.is_multiplied {
                own[k] * (1.0 - before[3])
            } else {
                0.0
            };
            let on = if node.is_multiplied {
                own[k] * before[k]
            } else {
                own[k] * before[3]
            };
            let colour = match (is_within, node.is_multiplied) {
                (true, _) => on,
                (false, true) => on + beside,
                (false, false) => own[k],
            };
            behind[k] = colour + (1.0 - own[3]) * before[k];
        }
        if !is_within {
            behind[3] = own[3] + (1.0 - own[3]) * before[3];
        }
    }
}

/// Asserts that pixels are what the formulas say, up to the rounding of the numbers that are stored.
pub(crate) fn assert_composed(pixels: &[[u8; 4]], nodes: &[Node], what: &str) {
    for (k, (pixel, expected)) in pixels.iter().zip(composed(nodes)).enumerate() {
        let alpha = f64::from(pixel[3]) / 255.0;
        for part in 0..4 {
            let own = match part {
                3 => alpha,
                _ => f64::from(pixel[part]) / 255.0 * alpha,
            };
            assert!(
                (own - expected[part]).abs() < 1.1 / 255.0,
                "{what}: pixel {k}: {pixel:?} but {expected:?}"
            );
        }
    }
}

/// Asserts that a file of the three poses gives the pixels of each layer.
fn assert_single_layers(bytes: &[u8], what: &str) {
    for group in &poses() {
        let Content::Group(children) = &group.content else {
            continue;
        };
        for child in children {
            let Content::Pixels(patch) = &child.content else {
                continue;
            };
            let path = format!("{}/{}", group.name, child.name);
            assert_eq!(picture(bytes, Some(&path)), on_canvas(patch), "{path} {what}");
        }
    }
}

#[test]
fn a_psd_file_gives_the_pixels_of_every_layer() {
    for compression in 0..4 {
        for depth in [8, 16] {
            for is_large in [false, true] {
                let options = psd::Options {
                    depth,
                    compression,
                    is_large,
                };
                assert_single_layers(&psd::write(SIZE, &poses(), options), &format!("{options:?}"));
            }
        }
    }
}

#[test]
fn a_psd_file_is_a_tree_of_names_and_settings() {
    let bytes = psd::write(SIZE, &face(), psd::Options::default());
    let file = LayeredFile::open(&bytes).expect("a PSD file");
    let expected = [
        ("paper", false),
        ("face", true),
        ("face/head", false),
        ("face/freckles", false),
        ("face/shade", false),
        ("face/eyes", true),
        ("face/eyes/eye", false),
        ("face/eyes/eye#2", false),
        ("face/sketch", false),
    ];
    assert_eq!(
        paths(file.layers()),
        expected.map(|(path, group)| (path.to_owned(), group))
    );
    let within = file.layers()[1].children();
    assert_eq!(
        (within[1].clipping, within[0].clipping),
        (Clipping::Base, Clipping::None)
    );
    assert_eq!(
        (within[2].blend, within[2].opacity),
        (BlendMode::Multiply, 180.0 / 255.0)
    );
    assert!(within[3].mask.is_some() && !within[4].is_visible);
}

#[test]
fn a_psd_file_is_composed_with_masks_opacity_multiply_and_clipping() {
    let art = face();
    let bytes = psd::write(SIZE, &art, psd::Options::default());
    assert_composed(&picture(&bytes, None), &art, "the whole");
    let Content::Group(children) = &art[1].content else {
        panic!("a group")
    };
    assert_composed(&picture(&bytes, Some("face")), children, "the face");
    // Those that are clipped by a layer are drawn with it, and a hidden one when it is named.
    assert_composed(&picture(&bytes, Some("face/head")), &children[..2], "the head");
    let mut sketch = children[4].clone();
    sketch.is_visible = true;
    assert_composed(&picture(&bytes, Some("face/sketch")), &[sketch], "the sketch");
    assert_composed(&picture(&bytes, Some("face/eyes")), &children[3..4], "the eyes");
    // A clipped one alone is cut by what it is clipped by.
    let freckles = picture(&bytes, Some("face/freckles"));
    let head = picture(&bytes, Some("face/head"));
    assert!(freckles.iter().zip(&head).all(|(own, by)| own[3] <= by[3]));
    let Content::Pixels(whole) = &children[1].content else {
        panic!("a layer")
    };
    assert!(
        on_canvas(whole)
            .iter()
            .zip(&freckles)
            .any(|(whole, cut)| whole[3] > cut[3] && cut[3] > 0)
    );
}

#[test]
fn what_is_in_a_group_that_passes_through_lies_on_what_is_behind_it() {
    let mut art = face();
    let isolated = picture(&psd::write(SIZE, &art, psd::Options::default()), None);
    art[1].passes_through = true;
    let bytes = psd::write(SIZE, &art, psd::Options::default());
    let passed = picture(&bytes, None);
    assert_composed(&passed, &art, "the whole");
    // What is multiplied reaches the paper.
    assert_ne!(passed, isolated);
}

#[test]
fn a_psd_file_without_layers_is_one_layer() {
    for compression in 0..2 {
        let bytes = psd::write_flat(SIZE, [1, 2, 3], compression);
        let file = LayeredFile::open(&bytes).expect("a PSD file");
        assert_eq!(paths(file.layers()), [("Background".to_owned(), false)]);
        assert!(picture(&bytes, None).iter().all(|pixel| *pixel == [1, 2, 3, 255]));
    }
}

#[test]
fn an_element_that_is_not_there_is_refused_with_those_that_are() {
    let bytes = psd::write(SIZE, &poses(), psd::Options::default());
    let file = LayeredFile::open(&bytes).expect("a PSD file");
    let refusal = file.picture(Some("stand/leg"), 0);
    let Err(InputError::Layered(LayeredError::NoSuchLayer { path, known, more })) = refusal else {
        panic!("{refusal:?}");
    };
    assert_eq!((path.as_str(), known.len(), more), ("stand/leg", 9, 0));
    let message = file.picture(Some("stand/leg"), 0).expect_err("refused").to_string();
    assert!(message.contains("stand/body"), "{message}");
}

/// The face with all of its eyes.
fn face_without_mask() -> Vec<Node> {
    let mut art = face();
    if let Content::Group(children) = &mut art[1].content {
        children[3].mask = None;
    }
    art
}

/// The face in a group that lies directly on the paper, with nothing clipped: that would be so by the paper.
fn passing_through(mut art: Vec<Node>) -> Vec<Node> {
    art[1].passes_through = true;
    if let Content::Group(children) = &mut art[1].content {
        children[1].is_clipped = false;
    }
    art
}

#[test]
fn an_openraster_file_is_read_and_composed() {
    for packing in [Packing::Stored, Packing::Deflated] {
        assert_single_layers(&ora::write(SIZE, &poses(), packing), &format!("{packing:?}"));
    }
    // The format has no masks; what is clipped is so by all that is behind it.
    let art = face_without_mask();
    let bytes = ora::write(SIZE, &art, Packing::Deflated);
    assert_composed(&picture(&bytes, None), &art, "the whole");
    let Content::Group(children) = &art[1].content else {
        panic!("a group")
    };
    assert_composed(&picture(&bytes, Some("face/head")), &children[..1], "the head");
    let file = LayeredFile::open(&bytes).expect("an OpenRaster file");
    assert_eq!(file.layers()[1].children()[1].clipping, Clipping::Behind);
    assert_eq!(file.layers()[1].children()[2].blend, BlendMode::Multiply);
    let bytes = ora::write(SIZE, &passing_through(art), Packing::Deflated);
    assert_composed(
        &picture(&bytes, None),
        &passing_through(face_without_mask()),
        "passing through",
    );
}

#[test]
fn a_krita_file_is_read_and_composed() {
    for depth in [8, 16] {
        for is_compressed in [false, true] {
            let options = kra::Options { depth, is_compressed };
            assert_single_layers(&kra::write(SIZE, &poses(), options), &format!("{options:?}"));
        }
    }
    let mut art = face();
    // A mask of a layer, too.
    let Content::Group(children) = &mut art[1].content else {
        panic!("a group")
    };
    children[2].mask = Some(Patch::new([30, 10], [50, 40], |x, y| (x * 3 + y) as u8));
    let bytes = kra::write(SIZE, &art, kra::Options::default());
    assert_composed(&picture(&bytes, None), &art, "the whole");
    let Content::Group(children) = &art[1].content else {
        panic!("a group")
    };
    assert_composed(&picture(&bytes, Some("face/eyes")), &children[3..4], "the eyes");
    let file = LayeredFile::open(&bytes).expect("a Krita file");
    let paths = paths(file.layers());
    assert_eq!(paths.last(), Some(&("face/sketch".to_owned(), false)));
    let art = passing_through(art);
    let bytes = kra::write(SIZE, &art, kra::Options::default());
    assert_composed(&picture(&bytes, None), &art, "passing through");
}

#[test]
fn an_aseprite_file_is_read_and_composed() {
    for is_deflated in [false, true] {
        let options = ase::Options { bits: 32, is_deflated };
        assert_single_layers(&ase::write(SIZE, &poses(), options), &format!("{options:?}"));
    }
    // The format has no masks and no clipping, and a group is composed by itself where it is translucent.
    let mut art = face();
    art[1].opacity = 200;
    let Content::Group(children) = &mut art[1].content else {
        panic!("a group")
    };
    (children[1].is_clipped, children[3].mask) = (false, None);
    for eyes in [false, true] {
        let Content::Group(children) = &mut art[1].content else {
            panic!("a group")
        };
        children[3].passes_through = eyes;
        let bytes = ase::write(SIZE, &art, ase::Options::default());
        assert_composed(&picture(&bytes, None), &art, "the whole");
    }
}

#[test]
fn aseprite_pixels_may_be_greys_or_indices() {
    let grey = Patch::new([-3, 60], [40, 20], |x, y| {
        let value = (x * 5 + y).rem_euclid(255) as u8 + 1;
        if (x + y) % 3 == 0 {
            [0; 4]
        } else {
            [value, value, value, 255]
        }
    });
    for bits in [16, 8] {
        for is_deflated in [false, true] {
            let nodes = [Node::layer("grey", grey.clone())];
            let bytes = ase::write(SIZE, &nodes, ase::Options { bits, is_deflated });
            assert_eq!(picture(&bytes, Some("grey")), on_canvas(&grey), "{bits}");
        }
    }
}

#[test]
fn an_aseprite_file_has_frames_tags_and_linked_drawings() {
    let [one, two] = [[30.0, 30.0], [60.0, 40.0]].map(|centre| ellipse(centre, [14.0, 9.0], [200, 90, 30]));
    let frames = vec![
        vec![ase::Drawn::Patch(one.clone()), ase::Drawn::Nothing],
        vec![ase::Drawn::Linked(0), ase::Drawn::Patch(two.clone())],
        vec![ase::Drawn::Linked(1), ase::Drawn::Nothing],
    ];
    let bytes = ase::write_frames(SIZE, &["body", "arm"], &frames, &[("wait", 0, 0), ("go", 1, 9)]);
    let file = LayeredFile::open(&bytes).expect("an Aseprite file");
    assert_eq!(file.frame_count(), 3);
    let tags: Vec<(&str, usize, usize)> = file
        .tags()
        .iter()
        .map(|tag| (tag.name.as_str(), tag.first, tag.last))
        .collect();
    assert_eq!(tags, [("wait", 0, 0), ("go", 1, 2)]);
    let shown = |element: &str, frame: usize| {
        let picture = file.picture(Some(element), frame).map(|picture| picture.rgba);
        picture.map(|rgba| {
            rgba.chunks_exact(4)
                .map(|p| [p[0], p[1], p[2], p[3]])
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(shown("body", 0).expect("drawn"), on_canvas(&one));
    assert_eq!(shown("body", 1).expect("drawn"), on_canvas(&one));
    assert_eq!(shown("arm", 1).expect("drawn"), on_canvas(&two));
    let empty = LayeredError::EmptyLayer {
        layer: "arm".to_owned(),
        frame: Some(0),
    };
    assert!(matches!(shown("arm", 0), Err(InputError::Layered(error)) if error == empty));
    // A link to a link, which the program does not write, and a frame that is not there.
    assert!(matches!(
        shown("body", 2),
        Err(InputError::Layered(LayeredError::DamagedLayer { .. }))
    ));
    assert!(matches!(
        shown("body", 3),
        Err(InputError::NoSuchFrame { frame: 3, count: 3 })
    ));
}

/// The bytes with every occurrence of some replaced by as many others.
fn replaced(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let places: Vec<usize> = (0..bytes.len()).filter(|&k| bytes[k..].starts_with(from)).collect();
    assert!(!places.is_empty() && from.len() == to.len());
    for place in places {
        bytes[place..place + to.len()].copy_from_slice(to);
    }
    bytes
}

#[test]
fn what_is_not_kept_is_told_with_the_path_of_its_layer() {
    let told = |bytes: &[u8]| {
        let file = LayeredFile::open(bytes).expect("a layered file");
        let picture = file.picture(None, 0).expect("a picture");
        let notes = picture.notes.into_iter();
        (
            picture.rgba,
            notes
                .map(|(layer, note)| format!("{layer}: {note}"))
                .collect::<Vec<String>>(),
        )
    };
    let mut plain = face();
    let Content::Group(children) = &mut plain[1].content else {
        panic!("a group")
    };
    children[2].is_multiplied = false;
    let options = psd::Options::default();
    let whole = psd::write(SIZE, &face(), options);
    assert!(told(&whole).1.is_empty());
    let (pixels, notes) = told(&replaced(&whole, b"8BIMmul ", b"8BIMover"));
    assert!(
        notes.len() == 1 && notes[0].starts_with("face/shade: its blend mode 'over'"),
        "{notes:?}"
    );
    assert_eq!(pixels, told(&psd::write(SIZE, &plain, options)).0);
    let stored = ora::write(SIZE, &face(), Packing::Stored);
    let mut files = ora::files(SIZE, &face());
    files[1].1 = replaced(&files[1].1, b"svg:multiply", b"svg:dst-out ");
    files[1].1 = String::from_utf8_lossy(&files[1].1)
        .replace("svg:dst-out \"", "svg:dst-out\"")
        .into_bytes();
    let (pixels, notes) = told(&zip::write(&files, Packing::Stored));
    assert!(
        notes.len() == 1 && notes[0].starts_with("face/shade: it cuts out"),
        "{notes:?}"
    );
    assert_ne!(pixels, told(&stored).0);
    let mut files = kra::files(SIZE, &face(), kra::Options::default());
    let text = String::from_utf8_lossy(&files[1].1).replace(
        "nodetype=\"paintlayer\" name=\"shade\"",
        "nodetype=\"shapelayer\" name=\"shade\"",
    );
    files[1].1 = text.into_bytes();
    let (_, notes) = told(&zip::write(&files, Packing::Deflated));
    assert!(
        notes.len() == 1 && notes[0].starts_with("face/shade: it is a vector layer"),
        "{notes:?}"
    );
}
