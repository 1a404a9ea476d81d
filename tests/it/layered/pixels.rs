//! Pixels, places, names and order of layered files.

use inbetween::input::InputError;
use inbetween::input::layered::{BlendMode, Clipping, Layer, LayeredError, LayeredFile};

use super::art::{Content, Node, Patch, SIZE, ellipse, poses};
use super::psd;

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

#[test]
fn a_psd_file_gives_the_pixels_of_every_layer() {
    let art = poses();
    for compression in 0..4 {
        for depth in [8, 16] {
            for is_large in [false, true] {
                let options = psd::Options {
                    depth,
                    compression,
                    is_large,
                };
                let bytes = psd::write(SIZE, &art, options);
                for group in &art {
                    let Content::Group(children) = &group.content else {
                        continue;
                    };
                    for child in children {
                        let Content::Pixels(patch) = &child.content else {
                            continue;
                        };
                        let path = format!("{}/{}", group.name, child.name);
                        assert_eq!(picture(&bytes, Some(&path)), on_canvas(patch), "{path} {options:?}");
                    }
                }
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
