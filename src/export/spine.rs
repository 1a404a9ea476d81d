//! Spine JSON: meshes with a deform timeline, an atlas, and pictures beside it.
//!
//! A skeleton of one bone; a slot for each layer and texture that is seen, with a mesh attachment. Its deform timeline has keys
//! between which vertices move straight, placed as for [`glTF`](super::gltf_bytes).
//!
//! - **Units**: one unit is a pixel of the frame, x to the right from its middle, y *up* from its lower edge.
//! - **Vertices**: Spine wants the outline ("hull") first, so vertices come in another order: the outer ring, then the others.
//! - **Textures** of a layer are slots upon one another, each as opaque as needed for their mean by weight (`alpha` timelines); so is
//!   the layer's own opacity. Where all of them are opaque that is exact; along their edges, which do not coincide quite, one
//!   shows through the other.
//! - **Order** of layers: a draw order timeline.
//! - Pictures are files of their own, each a page of the atlas: pack them anew as you like.
//!
//! Source: Spine's "JSON export format", version 4.2, and what its runtimes read. Numbers are rounded to four decimals.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::keys::place_keys;
use super::puppet_motion::{LayerMotion, PuppetMotion, PuppetReport, changes, texture_png};
use super::{ExportError, MotionError, PendingFile, WriteError};
use crate::math::Point;
use crate::render::{PuppetLayer, Sampling};

/// Decimals of coordinates and times: a vertex is off by at most a few of these units.
const DECIMALS: i32 = 4;
/// How far an opacity may be from its value between keys: half a step of eight bits.
const OPACITY_TOLERANCE: f64 = 0.5 / 255.0;

/// The files of a Spine skeleton.
#[derive(Debug, Clone, PartialEq)]
pub struct SpineFiles {
    /// The skeleton.
    pub json: Vec<u8>,
    /// The atlas: which picture each attachment shows.
    pub atlas: Vec<u8>,
    /// File names and contents of the pictures.
    pub pictures: Vec<(String, Vec<u8>)>,
    /// Keys and deviation.
    pub report: PuppetReport,
}

/// Writes the files of a skeleton into a folder, which is made where needed, or beside the `.json` file that `output` names; the
/// paths of what was written, the skeleton first. All files appear, or none.
///
/// # Errors
/// [`ExportError`] if the motion does not fit, or the system refuses.
pub fn write_spine(output: &Path, motion: &PuppetMotion<'_>) -> Result<(Vec<PathBuf>, PuppetReport), ExportError> {
    let is_json = output
        .extension()
        .is_some_and(|suffix| suffix.eq_ignore_ascii_case("json"));
    let (folder, stem) = match (output.parent(), output.file_stem()) {
        (Some(folder), Some(stem)) if is_json && !output.is_dir() => (folder, stem.to_string_lossy().into_owned()),
        _ => (output, file_name(motion.name)),
    };
    let unsuitable = |error: MotionError| ExportError::Unsuitable {
        path: output.to_owned(),
        reason: error.to_string(),
    };
    let files = spine_files(motion, &stem).map_err(unsuitable)?;
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let is_new = !folder.exists();
    std::fs::create_dir_all(folder).map_err(|error| ExportError::cannot_write(folder, error))?;
    let skeleton = [
        (format!("{stem}.json"), files.json),
        (format!("{stem}.atlas"), files.atlas),
    ];
    let written = write_all(folder, skeleton.into_iter().chain(files.pictures).collect());
    if written.is_err() && is_new {
        // Fails, as it should, if there is anything in the folder.
        let _ = std::fs::remove_dir(folder);
    }
    Ok((written?, files.report))
}

fn write_all(folder: &Path, files: Vec<(String, Vec<u8>)>) -> Result<Vec<PathBuf>, ExportError> {
    use std::io::Write as _;
    let mut pending = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        let mut file = PendingFile::create(&path)?;
        file.write_all(&bytes)
            .map_err(|error| ExportError::cannot_write(&path, error))?;
        pending.push((path, file));
    }
    // The skeleton last: where it is, everything is.
    for (_, file) in pending.iter_mut().rev() {
        file.flush().map_err(|error| ExportError::cannot_write(folder, error))?;
    }
    let paths = pending.iter().map(|(path, _)| path.clone()).collect();
    for (_, file) in pending.into_iter().rev() {
        file.commit()?;
    }
    Ok(paths)
}

/// The files of a skeleton; the atlas and pictures are called after `stem`.
///
/// # Errors
/// [`MotionError`] if the motion does not fit together, see [`PuppetMotion::check`].
pub fn spine_files(motion: &PuppetMotion<'_>, stem: &str) -> Result<SpineFiles, MotionError> {
    motion.check()?;
    // Rounding takes its part of the error allowed: half a unit of the last decimal in x and y, in the setup pose and in the offset.
    let rounding = 2.0 * std::f64::consts::FRAC_1_SQRT_2 * 10f64.powi(-DECIMALS);
    let layers: Vec<LayerMotion> = (0..motion.puppet.layers.len())
        .map(|layer| motion.layer_motion(layer, (motion.max_error - rounding).max(0.0)))
        .collect();
    let mut names = Names::default();
    // In setup order: the first frame's layers from back to front, each with its textures.
    let mut slots: Vec<Slot> = Vec::new();
    for &layer in &motion.frames[0].order {
        for texture in 0..motion.puppet.layers[layer].textures.len() {
            let opacities: Vec<f64> = (0..motion.frames.len())
                .map(|frame| motion.opacities(layer, frame)[texture])
                .collect();
            if opacities.iter().any(|o| *o > 0.0) {
                let name = names.take(motion, layer, texture);
                slots.push(Slot {
                    layer,
                    texture,
                    name,
                    opacities,
                });
            }
        }
    }
    let mut pictures = Vec::new();
    let mut atlas = String::new();
    let filter = match motion.puppet.sampling {
        Sampling::Smooth => "Linear",
        Sampling::Nearest => "Nearest",
    };
    for slot in &slots {
        let texture = &motion.puppet.layers[slot.layer].textures[slot.texture];
        let file = format!("{stem}-{}.png", slot.name);
        let (width, height) = (texture.width, texture.height);
        atlas.push_str(&format!(
            "{file}\nsize: {width}, {height}\nfilter: {filter}, {filter}\n{}\nbounds: 0, 0, {width}, {height}\n\n",
            slot.name
        ));
        pictures.push((file, texture_png(texture)?));
    }
    let skeleton = skeleton(motion, &layers, &slots, stem);
    let worst = layers.iter().map(|motion| motion.keys.worst).fold(0.0, f64::max);
    Ok(SpineFiles {
        json: serde_json::to_vec(&skeleton).map_err(|error| WriteError::Encoding(Box::new(error)))?,
        atlas: atlas.into_bytes(),
        pictures,
        report: PuppetReport {
            keys: layers.iter().map(|motion| motion.keys.indices.len()).collect(),
            worst: worst + rounding,
        },
    })
}

/// A texture of a layer.
struct Slot {
    layer: usize,
    texture: usize,
    /// Also of its attachment.
    name: String,
    /// One a frame.
    opacities: Vec<f64>,
}

fn skeleton(motion: &PuppetMotion<'_>, layers: &[LayerMotion], slots: &[Slot], stem: &str) -> Value {
    let [width, height] = motion.puppet.size;
    let (mut attachments, mut deforms, mut colours) = (Map::new(), Map::new(), Map::new());
    for slot in slots {
        let layer = &motion.puppet.layers[slot.layer];
        let shapes = &layers[slot.layer];
        let order = hull_first(layer);
        let setup = placed(motion, &shapes.shapes[0], &order);
        attachments.insert(
            slot.name.clone(),
            json!({ &slot.name: mesh(layer, slot.texture, &setup, &order) }),
        );
        if shapes.shapes.len() > 1 {
            let keys: Vec<Value> = shapes
                .keys
                .indices
                .iter()
                .zip(&shapes.shapes)
                .map(|(&key, shape)| {
                    let offsets: Vec<f64> = placed(motion, shape, &order)
                        .iter()
                        .zip(&setup)
                        .map(|(to, from)| rounded(to - from))
                        .collect();
                    json!({ "time": seconds(motion.times[key]), "vertices": offsets })
                })
                .collect();
            deforms.insert(slot.name.clone(), json!({ &slot.name: { "deform": keys } }));
        }
        if let Some(keys) = opacity_keys(motion, &slot.opacities) {
            colours.insert(slot.name.clone(), json!({ "alpha": keys }));
        }
    }
    let mut animation = Map::new();
    if !colours.is_empty() {
        animation.insert("slots".to_owned(), Value::Object(colours));
    }
    if !deforms.is_empty() {
        animation.insert("attachments".to_owned(), json!({ "default": deforms }));
    }
    if let Some(keys) = draw_order(motion, slots) {
        animation.insert("drawOrder".to_owned(), keys);
    }
    let slot_list: Vec<Value> = slots
        .iter()
        .map(|slot| {
            let mut data = json!({ "name": slot.name, "bone": "root", "attachment": slot.name });
            let alpha = (slot.opacities[0] * 255.0).round() as u8;
            if alpha < 255 {
                data["color"] = json!(format!("ffffff{alpha:02x}"));
            }
            data
        })
        .collect();
    json!({
        "skeleton": {
            "spine": "4.2.00",
            "x": -(width as f64) / 2.0,
            "y": 0,
            "width": width,
            "height": height,
            "images": "./",
            "name": stem,
        },
        "bones": [{ "name": "root" }],
        "slots": slot_list,
        "skins": [{ "name": "default", "attachments": attachments }],
        "animations": { motion.name: animation },
    })
}

/// The vertices in Spine's order: the outer ring, then the others.
fn hull_first(layer: &PuppetLayer) -> Vec<usize> {
    let count = layer.textures.first().map_or(0, |texture| texture.places.len());
    let hull = hull(layer);
    let is_hull: BTreeSet<usize> = hull.iter().copied().collect();
    hull.iter()
        .copied()
        .chain((0..count).filter(|vertex| !is_hull.contains(vertex)))
        .collect()
}

/// The outer ring. One that meets a vertex twice is no hull.
fn hull(layer: &PuppetLayer) -> &[usize] {
    let ring = layer.rings.first().map_or(&[][..], Vec::as_slice);
    let different: BTreeSet<&usize> = ring.iter().collect();
    if different.len() == ring.len() { ring } else { &[] }
}

fn mesh(layer: &PuppetLayer, texture: usize, setup: &[f64], order: &[usize]) -> Value {
    let texture = &layer.textures[texture];
    let mut new_index = vec![0; order.len()];
    for (k, &vertex) in order.iter().enumerate() {
        new_index[vertex] = k;
    }
    let (width, height) = (texture.width as f64, texture.height as f64);
    let places: Vec<f64> = order
        .iter()
        .flat_map(|&v| [texture.places[v].x / width, texture.places[v].y / height])
        .map(|part| (part * 1e7).round() / 1e7)
        .collect();
    // With y up a triangle runs the other way round.
    let triangles: Vec<usize> = layer
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [a, c, b].map(|v| new_index[v]))
        .collect();
    json!({
        "type": "mesh",
        "uvs": places,
        "triangles": triangles,
        "vertices": setup,
        "hull": hull(layer).len(),
        "width": texture.width,
        "height": texture.height,
    })
}

fn placed(motion: &PuppetMotion<'_>, shape: &[Point], order: &[usize]) -> Vec<f64> {
    let [width, height] = motion.puppet.size.map(|side| side as f64);
    order
        .iter()
        .flat_map(|&v| [rounded(shape[v].x - width / 2.0), rounded(height - shape[v].y)])
        .collect()
}

fn rounded(number: f64) -> f64 {
    let scale = 10f64.powi(DECIMALS);
    // Adding zero makes a negative zero a plain one.
    (number * scale).round() / scale + 0.0
}

fn seconds(time: f64) -> f64 {
    (time * 1e6).round() / 1e6 + 0.0
}

/// The keys of an opacity over time; `None` if the setup pose says it all.
fn opacity_keys(motion: &PuppetMotion<'_>, opacities: &[f64]) -> Option<Vec<Value>> {
    if opacities.iter().all(|o| *o == 1.0) {
        return None;
    }
    let samples: Vec<Vec<Point>> = opacities.iter().map(|o| vec![Point::new(*o, 0.0)]).collect();
    let keys = place_keys(motion.times, &samples, OPACITY_TOLERANCE).indices;
    let key = |&k: &usize| json!({ "time": seconds(motion.times[k]), "value": rounded(opacities[k]) });
    Some(keys.iter().map(key).collect())
}

/// The draw order over time; `None` if it stays that of the slots.
fn draw_order(motion: &PuppetMotion<'_>, slots: &[Slot]) -> Option<Value> {
    let orders: Vec<&Vec<usize>> = motion.frames.iter().map(|frame| &frame.order).collect();
    let jumps = changes(&orders);
    if jumps.len() < 2 {
        return None;
    }
    let key = |&frame: &usize| {
        let depth = |slot: &Slot| orders[frame].iter().position(|layer| *layer == slot.layer);
        let mut drawn: Vec<usize> = (0..slots.len()).collect();
        drawn.sort_by_key(|&slot| (depth(&slots[slot]), slot));
        let mut offsets = Vec::new();
        for (slot, data) in slots.iter().enumerate() {
            let place = drawn.iter().position(|&other| other == slot).unwrap_or(slot);
            if place != slot {
                offsets.push(json!({ "slot": data.name, "offset": place as i64 - slot as i64 }));
            }
        }
        let mut key = json!({ "time": seconds(motion.times[frame]) });
        if !offsets.is_empty() {
            key["offsets"] = json!(offsets);
        }
        key
    };
    Some(jumps.iter().map(key).collect())
}

/// Names of slots, attachments and files: letters, digits and dashes, each once.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    fn take(&mut self, motion: &PuppetMotion<'_>, layer: usize, texture: usize) -> String {
        let layer = &motion.puppet.layers[layer];
        let plain = file_name(&format!("{}-{}", layer.name, layer.textures[texture].name));
        let mut name = plain.clone();
        let mut copies = 1;
        while !self.0.insert(name.to_lowercase()) {
            copies += 1;
            name = format!("{plain}-{copies}");
        }
        name
    }
}

/// What a name becomes as a file's.
fn file_name(name: &str) -> String {
    let kept: String = name
        .chars()
        .map(|c| if c.is_alphanumeric() || c == '_' { c } else { '-' })
        .collect();
    if kept.is_empty() { "unnamed".to_owned() } else { kept }
}

#[cfg(test)]
mod tests {
    use super::super::puppet_motion::testing::turning;
    use super::*;

    fn numbers(list: &Value) -> Vec<f64> {
        let list = list.as_array().expect("a list");
        list.iter().map(|number| number.as_f64().expect("a number")).collect()
    }

    #[test]
    fn vertices_are_where_the_frames_have_them() {
        let turning = turning();
        for max_error in [0.0, 0.5] {
            let files = spine_files(&turning.motion(max_error), "turn").expect("files");
            let json: Value = serde_json::from_slice(&files.json).expect("JSON");
            let mesh = &json["skins"][0]["attachments"]["wheel-red"]["wheel-red"];
            let setup = numbers(&mesh["vertices"]);
            assert_eq!((&mesh["hull"], setup.len()), (&json!(4), 10));
            let deform = &json["animations"]["turn"]["attachments"]["default"]["wheel-red"]["wheel-red"]["deform"];
            let keys: Vec<(f64, Vec<f64>)> = deform
                .as_array()
                .expect("keys")
                .iter()
                .map(|key| (key["time"].as_f64().expect("a time"), numbers(&key["vertices"])))
                .collect();
            assert_eq!(files.report.keys, [keys.len(), 1]);
            let mut worst: f64 = 0.0;
            for (time, frame) in turning.times.iter().zip(&turning.frames) {
                let next = keys.partition_point(|key| key.0 <= *time).clamp(1, keys.len() - 1);
                let (a, b) = (&keys[next - 1], &keys[next]);
                let part = ((time - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
                // The ring, and then the middle, which is vertex 0 with us.
                for (k, v) in [1, 2, 3, 4, 0].into_iter().enumerate() {
                    let at = |c: usize| setup[2 * k + c] + a.1[2 * k + c] * (1.0 - part) + b.1[2 * k + c] * part;
                    let place = Point::new(at(0) + 100.0, 100.0 - at(1));
                    worst = worst.max((place - frame.layers[0].positions[v]).norm());
                }
            }
            // Times are rounded, too: a vertex moves by 126 pixels a second.
            assert!(worst <= files.report.worst + 126.0 * 0.5e-6, "{worst}");
            assert!(
                max_error == 0.0 || (worst <= max_error + 0.01 && keys.len() <= 25),
                "{worst}"
            );
        }
    }

    #[test]
    fn textures_fade_and_layers_change_places() {
        let turning = turning();
        let files = spine_files(&turning.motion(0.5), "turn").expect("files");
        let json: Value = serde_json::from_slice(&files.json).expect("JSON");
        let slots: Vec<&str> = (json["slots"].as_array().expect("slots").iter())
            .map(|slot| slot["name"].as_str().expect("a name"))
            .collect();
        assert_eq!(slots, ["box-green", "wheel-red", "wheel-blue"]);
        let animation = &json["animations"]["turn"];
        let blue = animation["slots"]["wheel-blue"]["alpha"].as_array().expect("keys");
        assert_eq!(
            (&blue[0]["value"], &blue[blue.len() - 1]["value"]),
            (&json!(0.0), &json!(1.0))
        );
        assert_eq!(blue.len(), 2, "a weight that grows evenly");
        assert_eq!(
            animation["drawOrder"],
            json!([
                { "time": 0.0 },
                { "time": 1.0, "offsets": [
                    { "slot": "box-green", "offset": 2 },
                    { "slot": "wheel-red", "offset": -1 },
                    { "slot": "wheel-blue", "offset": -1 },
                ] },
            ])
        );
        let atlas = String::from_utf8(files.atlas).expect("text");
        assert!(atlas.contains("turn-wheel-red.png\nsize: 8, 4\n"), "{atlas}");
        assert_eq!(files.pictures.len(), 3);
    }

    #[test]
    fn files_are_written_to_a_folder_or_beside_the_skeleton() {
        let turning = turning();
        let folder = tempfile::tempdir().expect("a folder");
        for output in [folder.path().join("a"), folder.path().join("b/my.json")] {
            let (paths, _) = write_spine(&output, &turning.motion(0.5)).expect("written");
            assert_eq!(paths.len(), 5);
            assert!(paths.iter().all(|path| path.is_file()));
        }
        assert!(folder.path().join("a/turn.json").is_file() && folder.path().join("b/my-box-green.png").is_file());
        std::fs::write(folder.path().join("c"), b"").expect("written");
        assert!(write_spine(&folder.path().join("c/d"), &turning.motion(0.5)).is_err());
    }

    #[test]
    fn names_are_fit_for_files_and_different() {
        let mut turning = turning();
        turning.puppet.layers[0].textures[0].name = "a/b".to_owned();
        turning.puppet.layers[0].textures[1].name = "A b".to_owned();
        let files = spine_files(&turning.motion(0.5), "turn").expect("files");
        let names: Vec<&str> = files.pictures.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            ["turn-box-green.png", "turn-wheel-a-b.png", "turn-wheel-A-b-2.png"]
        );
    }
}
