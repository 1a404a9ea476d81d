//! A figure that lies over itself as textured meshes: one a region, in the order that frames are painted in.

use inbetween::animation::Animation;
use inbetween::export::runtime::{Precision, read_runtime, runtime_bytes};
use inbetween::export::{PuppetMotion, gltf_bytes, spine_files, texture_png};
use inbetween::math::Point;
use inbetween::mesh::geometry::barycentric;
use inbetween::pipeline::{CameraRule, OverlapSearch};
use inbetween::render::puppet::{Puppet, PuppetFrame, PuppetLayer, PuppetTexture};
use inbetween::{Character, CharacterSpec};
use serde_json::Value;

use crate::overlaps::{SHIRT, SIZE, SLEEVE, across, layer, pixels, stretched};

/// The poses, in the order of weights.
const STRETCHED: [f64; 2] = [1.0, 0.0];
const ACROSS: [f64; 2] = [0.0, 1.0];

fn character(overlaps: OverlapSearch) -> Character {
    let places = vec![vec![0.0, 0.0], vec![1.0, 0.0]];
    let animation = Animation::visiting(places.iter().map(Vec::as_slice), true).expect("an animation");
    let mut layer = layer();
    layer.overlaps = overlaps;
    let mut spec = CharacterSpec::new(vec![layer]).with_places(places);
    spec.camera = CameraRule::Drawing;
    Character::new(&spec, &animation, SIZE).expect("a character")
}

fn frame(character: &Character, puppet: &Puppet, weights: [f64; 2]) -> PuppetFrame {
    character.puppet_frame(puppet, &character.posed_of(&weights).expect("weights"))
}

/// The place on a layer's textures of a point of the frame, where its mesh is at `positions`; one for each triangle that holds it.
fn held(layer: &PuppetLayer, positions: &[Point], texture: usize, p: Point) -> Vec<Point> {
    let place = |triangle: &[usize; 3]| {
        let shares = barycentric(triangle.map(|v| positions[v]), p)?;
        let is_in = shares.iter().all(|share| *share >= -1e-9);
        let places = triangle.map(|v| layer.textures[texture].places[v]);
        is_in.then(|| places[0] * shares[0] + places[1] * shares[1] + places[2] * shares[2])
    };
    layer.triangles.iter().filter_map(place).collect()
}

/// The colour at a place of a texture, colours multiplied by alpha, interpolated as engines do.
fn sampled(texture: &PuppetTexture, place: Point) -> [f64; 4] {
    let corner = place - Point::repeat(0.5);
    let texel = |x: f64, y: f64| {
        let column = x.clamp(0.0, texture.width as f64 - 1.0) as usize;
        let row = y.clamp(0.0, texture.height as f64 - 1.0) as usize;
        texture.pixels[row * texture.width + column].map(f64::from)
    };
    let (low, part) = (corner.map(f64::floor), corner.map(|c| c - c.floor()));
    let mut mean = [0.0; 4];
    for (x, y, share) in [
        (0.0, 0.0, (1.0 - part.x) * (1.0 - part.y)),
        (1.0, 0.0, part.x * (1.0 - part.y)),
        (0.0, 1.0, (1.0 - part.x) * part.y),
        (1.0, 1.0, part.x * part.y),
    ] {
        let colour = texel(low.x + x, low.y + y);
        mean.iter_mut()
            .zip(colour)
            .for_each(|(sum, channel)| *sum += share * channel);
    }
    let [r, g, b, alpha] = mean;
    [r * alpha / 255.0, g * alpha / 255.0, b * alpha / 255.0, alpha]
}

/// What an engine shows of one drawing's textures, colours multiplied by alpha.
fn composed(puppet: &Puppet, frame: &PuppetFrame, texture: usize) -> Vec<[f64; 4]> {
    let mut pixels = vec![[0.0; 4]; SIZE[0] * SIZE[1]];
    for &k in &frame.order {
        let (layer, positions) = (&puppet.layers[k], &frame.layers[k].positions);
        for (index, pixel) in pixels.iter_mut().enumerate() {
            let p = Point::new((index % SIZE[0]) as f64 + 0.5, (index / SIZE[0]) as f64 + 0.5);
            for place in held(layer, positions, texture, p).into_iter().take(1) {
                let over = sampled(&layer.textures[texture], place);
                for (below, above) in pixel.iter_mut().zip(over) {
                    *below = above + *below * (1.0 - over[3] / 255.0);
                }
            }
        }
    }
    pixels
}

/// The layer of the puppet that the lower arm is in, and those that show the chest where the arm lies over it.
fn arm_and_chest(puppet: &Puppet) -> (usize, usize) {
    let [_, elbow, hand] = across();
    let crossing = elbow + (hand - elbow) * 0.2;
    let is_near = |found: [f64; 4], wanted: [u8; 3]| {
        found[3] > 250.0 && (found.iter().zip(wanted)).all(|(a, b)| (a - f64::from(b)).abs() < 20.0)
    };
    let showing = |wanted: [u8; 3]| -> Vec<usize> {
        let shows = |k: &usize| {
            let layer = &puppet.layers[*k];
            let places = held(layer, &layer.poses[1].positions, layer.poses[1].texture, crossing);
            (places.iter()).any(|place| is_near(sampled(&layer.textures[layer.poses[1].texture], *place), wanted))
        };
        (0..puppet.layers.len()).filter(shows).collect()
    };
    let (arm, chest) = (showing(SLEEVE), showing(SHIRT));
    assert_eq!((arm.len(), chest.len()), (1, 1), "{arm:?} {chest:?}");
    (arm[0], chest[0])
}

#[test]
fn every_region_is_a_mesh_with_pictures_that_are_whole_where_others_hide_it() {
    let character = character(OverlapSearch::Auto);
    let puppet = character.puppet();
    let (arm, chest) = arm_and_chest(&puppet);
    assert_eq!(puppet.layers[chest].name, "figure/trunk");
    assert!(
        puppet.layers[arm].name.starts_with("figure/limb "),
        "{}",
        puppet.layers[arm].name
    );
    // The regions' textures give each drawing back.
    for (pose, (weights, arm)) in [(STRETCHED, stretched()), (ACROSS, across())].into_iter().enumerate() {
        let frame = frame(&character, &puppet, weights);
        let found = composed(&puppet, &frame, puppet.layers[0].poses[pose].texture);
        let drawn = pixels(arm);
        let differences: Vec<f64> = (found.iter().zip(drawn.chunks_exact(4)))
            .map(|(found, drawn)| {
                let channels = found.iter().zip(drawn);
                channels.map(|(a, b)| (a - f64::from(*b)).abs()).fold(0.0, f64::max)
            })
            .collect();
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        let far = differences.iter().filter(|difference| **difference > 80.0).count();
        assert!(
            mean < 1.5 && far < SIZE[0] * SIZE[1] / 100,
            "{mean} {far} in pose {pose}"
        );
    }
}

#[test]
fn a_skeleton_has_a_slot_a_region_and_draws_the_arm_in_front() {
    let character = character(OverlapSearch::Auto);
    let puppet = character.puppet();
    let (arm, chest) = arm_and_chest(&puppet);
    let frames = [ACROSS, STRETCHED].map(|weights| frame(&character, &puppet, weights));
    let motion = PuppetMotion {
        name: "figure",
        puppet: &puppet,
        times: &[0.0, 1.0],
        frames: &frames,
        max_error: 0.5,
    };
    let files = spine_files(&motion, "figure").expect("files");
    let skeleton: Value = serde_json::from_slice(&files.json).expect("JSON");
    let slots: Vec<&str> = (skeleton["slots"].as_array().expect("slots").iter())
        .filter_map(|slot| slot["name"].as_str())
        .collect();
    // Both drawings of each region are seen.
    assert_eq!(slots.len(), 2 * puppet.layers.len());
    // Slots come as the first frame is painted.
    let place = |layer: usize| {
        let texture = &puppet.layers[layer].textures[1];
        let shown = (files.pictures.iter()).find(|(_, png)| *png == texture_png(texture).expect("a PNG"));
        let (file, _) = shown.expect("a picture");
        let slot = |slot: &&str| *file == format!("figure-{slot}.png");
        slots.iter().position(slot).expect("a slot")
    };
    assert!(place(arm) > place(chest), "{slots:?}");

    let (bytes, _) = gltf_bytes(&motion).expect("a file");
    let length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
    let document: Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON");
    let nearness = |layer: usize| {
        let nodes = document["nodes"].as_array().expect("nodes");
        let node = nodes
            .iter()
            .find(|node| node["name"] == puppet.layers[layer].name.as_str());
        node.expect("a node")["translation"][2].as_f64().expect("a number")
    };
    assert!(nearness(arm) > nearness(chest));
}

#[test]
fn a_runtime_file_has_one_mesh_and_says_in_which_order_its_regions_are_drawn() {
    let character = character(OverlapSearch::Auto);
    let puppet = character.puppet();
    let file = character
        .runtime_file(character.animation(), texture_png)
        .expect("a file");
    let (bytes, _) = runtime_bytes(&file, Precision::Quantised).expect("bytes");
    let read = read_runtime(&bytes).expect("a file");
    let [layer] = &read.layers[..] else { panic!("one layer") };
    assert!(layer.textures.is_empty());
    let regions = layer.regions.as_ref().expect("regions");
    assert_eq!(regions.regions.len(), puppet.layers.len());
    for weights in [STRETCHED, ACROSS, [0.6, 0.4], [0.3, 0.7]] {
        let posed = character.posed_of(&weights).expect("weights");
        let order = (regions.order).from_back_to_front(&posed.layers[0].weights, &posed.layers[0].texture_weights);
        assert_eq!(order, frame(&character, &puppet, weights).order);
    }
    for (region, layer) in regions.regions.iter().zip(&puppet.layers) {
        assert_eq!(format!("figure/{}", region.name), layer.name);
        assert_eq!(region.triangles, layer.triangles);
        for (v, place) in region.vertices.iter().zip(&layer.poses[1].positions) {
            assert!((read.layers[0].mesh.positions()[1][*v] - place).norm() < 0.02);
        }
    }
}

#[test]
fn a_figure_that_does_not_lie_over_itself_stays_one_mesh() {
    let character = character(OverlapSearch::Refuse);
    let puppet = character.puppet();
    assert_eq!(puppet.layers.len(), 1);
    assert_eq!(puppet.layers[0].name, "figure");
    let file = character
        .runtime_file(character.animation(), texture_png)
        .expect("a file");
    let (bytes, _) = runtime_bytes(&file, Precision::Quantised).expect("bytes");
    assert_eq!(bytes[4..6], [1, 0], "the version before there were regions");
}
