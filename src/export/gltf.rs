//! glTF 2.0: a mesh with morph targets, in one binary file (`.glb`).
//!
//! The blend is not linear in the poses' weights, so not the poses but the shapes at key frames are the targets: the mesh has the
//! shape of the first key, each further key is a target, and the weights' animation fades from each to the next. Between keys
//! vertices move straight, and keys lie so close that none leaves its place by more than
//! [`max_error`](PuppetMotion::max_error).
//!
//! - **Units**: [`PIXELS_A_UNIT`] pixels of the frame are one unit. x to the right, y *up*, the frame's centre in the origin.
//!   An orthographic camera shows exactly the frame.
//! - **Layers** are nodes, [`LAYER_GAP`] apart in z from back to front; where the order changes, they jump.
//! - **Textures** are embedded PNG files, shown unlit (`KHR_materials_unlit`), blended by their alpha, from both sides.
//! - Several textures of a layer: core glTF animates no opacity, so there is one node for each, with the same shapes; shown
//!   at each time is the one that weighs most, the others are scaled to nothing. A layer's opacity is treated alike: it is shown from one
//!   half on. This is the one difference from our frames, which cross-fade.
//!
//! What else there is, and why not: morph targets of vertex colours would fade, but readers may ignore them and some do, and then
//! show nothing at all; `KHR_animation_pointer` is known to few.

use serde_json::{Value, json};

use super::MotionError;
use super::gltf_buffer::{GltfBuffer, LINEAR, LINEAR_MIPMAP_LINEAR, NEAREST, container, push, without_empty_lists};
use super::puppet_motion::{LayerMotion, PuppetMotion, PuppetReport, changes, texture_png};
use crate::math::Point;
use crate::render::{PuppetLayer, PuppetTexture, Sampling};

/// Pixels of the frame that are one unit.
pub const PIXELS_A_UNIT: f64 = 100.0;
/// How far a layer lies before the one behind it, in units.
pub const LAYER_GAP: f64 = 0.01;
/// How far the camera stands before the frame, in units.
const CAMERA_DISTANCE: f64 = 10.0;

const CLAMP_TO_EDGE: u32 = 33071;

/// The bytes of a `.glb` file.
///
/// # Errors
/// [`MotionError`] if the motion does not fit together, see [`PuppetMotion::check`], or the file would be larger than 4 GB.
pub fn gltf_bytes(motion: &PuppetMotion<'_>) -> Result<(Vec<u8>, PuppetReport), MotionError> {
    motion.check()?;
    let mut file = File::default();
    let mut report = PuppetReport {
        keys: Vec::new(),
        worst: 0.0,
    };
    let mut layer_nodes = Vec::new();
    for layer in 0..motion.puppet.layers.len() {
        let shapes = motion.layer_motion(layer, motion.max_error);
        report.keys.push(shapes.keys.indices.len());
        report.worst = report.worst.max(shapes.keys.worst);
        layer_nodes.push(file.add_layer(motion, layer, &shapes)?);
    }
    let bytes = file.finish(motion, &layer_nodes, &report)?;
    Ok((bytes, report))
}

/// The parts of the file so far.
#[derive(Default)]
struct File {
    buffer: GltfBuffer,
    images: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
}

impl File {
    /// Adds a node with one child a texture; its index.
    fn add_layer(
        &mut self,
        motion: &PuppetMotion<'_>,
        index: usize,
        shapes: &LayerMotion,
    ) -> Result<usize, MotionError> {
        let layer = &motion.puppet.layers[index];
        let heaviest: Vec<Option<usize>> = (0..motion.frames.len())
            .map(|frame| motion.heaviest(index, frame))
            .collect();
        if heaviest.iter().all(Option::is_none) {
            return Ok(push(&mut self.nodes, json!({ "name": layer.name })));
        }
        let indices = self.add_indices(layer);
        let base = self
            .buffer
            .add_positions(&placed(&shapes.shapes[0], motion.puppet.size));
        let targets: Vec<Value> = shapes.shapes[1..]
            .iter()
            .map(|shape| json!({ "POSITION": self.buffer.add_positions(&moves(&shapes.shapes[0], shape)) }))
            .collect();
        let weights = (!targets.is_empty()).then(|| self.add_hats(motion, shapes));
        let mut children = Vec::new();
        for (k, texture) in layer.textures.iter().enumerate() {
            if !heaviest.contains(&Some(k)) {
                continue;
            }
            let places = self.add_places(texture);
            let mut primitive = json!({
                "attributes": { "POSITION": base, "TEXCOORD_0": places },
                "indices": indices,
                "material": self.add_material(&layer.name, texture)?,
            });
            let name = format!("{} {}", layer.name, texture.name);
            let mut mesh = json!({ "name": name });
            if !targets.is_empty() {
                primitive["targets"] = json!(targets);
                mesh["weights"] = json!(vec![0; targets.len()]);
            }
            mesh["primitives"] = json!([primitive]);
            self.meshes.push(mesh);
            let node = push(&mut self.nodes, json!({ "name": name, "mesh": self.meshes.len() - 1 }));
            children.push(node);
            if let Some(sampler) = weights {
                self.add_channel(sampler, node, "weights");
            }
            let shown: Vec<bool> = heaviest.iter().map(|h| *h == Some(k)).collect();
            self.add_visibility(motion, node, &shown);
        }
        let depth: Vec<usize> = (motion.frames.iter())
            .map(|frame| frame.order.iter().position(|&l| l == index).unwrap_or(0))
            .collect();
        let place = |depth: usize| [0.0, 0.0, depth as f64 * LAYER_GAP];
        let node = json!({ "name": layer.name, "translation": place(depth[0]), "children": children });
        let node = push(&mut self.nodes, node);
        let jumps = changes(&depth);
        if jumps.len() > 1 {
            let places: Vec<f32> = jumps.iter().flat_map(|&k| place(depth[k]).map(|c| c as f32)).collect();
            self.add_steps(motion, node, "translation", &jumps, &places);
        }
        Ok(node)
    }

    /// A sampler that fades from each key's target to the next one's. The first key is the mesh itself.
    fn add_hats(&mut self, motion: &PuppetMotion<'_>, shapes: &LayerMotion) -> usize {
        let keys = &shapes.keys.indices;
        let input = self.add_times(motion, keys);
        let mut weights = vec![0.0f32; keys.len() * (keys.len() - 1)];
        for key in 1..keys.len() {
            weights[key * (keys.len() - 1) + key - 1] = 1.0;
        }
        let output = self.buffer.add_scalars(&weights);
        let sampler = json!({ "input": input, "output": output, "interpolation": "LINEAR" });
        push(&mut self.samplers, sampler)
    }

    fn add_visibility(&mut self, motion: &PuppetMotion<'_>, node: usize, shown: &[bool]) {
        let jumps = changes(shown);
        let scale = |is_shown: bool| if is_shown { [1.0f32; 3] } else { [0.0; 3] };
        if !shown[0] {
            self.nodes[node]["scale"] = json!(scale(false));
        }
        if jumps.len() > 1 {
            let scales: Vec<f32> = jumps.iter().flat_map(|&k| scale(shown[k])).collect();
            self.add_steps(motion, node, "scale", &jumps, &scales);
        }
    }

    fn add_steps(&mut self, motion: &PuppetMotion<'_>, node: usize, path: &str, frames: &[usize], values: &[f32]) {
        let input = self.add_times(motion, frames);
        let output = self.buffer.add_values(values.as_chunks::<3>().0);
        let sampler = json!({ "input": input, "output": output, "interpolation": "STEP" });
        let sampler = push(&mut self.samplers, sampler);
        self.add_channel(sampler, node, path);
    }

    fn add_channel(&mut self, sampler: usize, node: usize, path: &str) {
        self.channels
            .push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    fn add_times(&mut self, motion: &PuppetMotion<'_>, frames: &[usize]) -> usize {
        let times: Vec<f32> = frames.iter().map(|&k| motion.times[k] as f32).collect();
        self.buffer.add_times(&times)
    }

    fn add_places(&mut self, texture: &PuppetTexture) -> usize {
        let (width, height) = (texture.width as f64, texture.height as f64);
        let places: Vec<[f32; 2]> = texture
            .places
            .iter()
            .map(|p| [(p.x / width) as f32, (p.y / height) as f32])
            .collect();
        self.buffer.add_attribute(&places)
    }

    fn add_indices(&mut self, layer: &PuppetLayer) -> usize {
        // With y up a triangle runs the other way round.
        let indices: Vec<usize> = layer.triangles.iter().flat_map(|&[a, b, c]| [a, c, b]).collect();
        self.buffer.add_indices(&indices)
    }

    fn add_material(&mut self, layer: &str, texture: &PuppetTexture) -> Result<usize, MotionError> {
        let png = texture_png(texture)?;
        let view = self.buffer.add_view(&png, None);
        let name = format!("{layer} {}", texture.name);
        self.images
            .push(json!({ "name": name, "bufferView": view, "mimeType": "image/png" }));
        let material = json!({
            "name": name,
            "alphaMode": "BLEND",
            "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": self.images.len() - 1 },
                "metallicFactor": 0.0,
                "roughnessFactor": 1.0,
            },
            "extensions": { "KHR_materials_unlit": {} },
        });
        Ok(push(&mut self.materials, material))
    }

    fn finish(
        mut self,
        motion: &PuppetMotion<'_>,
        layer_nodes: &[usize],
        report: &PuppetReport,
    ) -> Result<Vec<u8>, MotionError> {
        let root = push(&mut self.nodes, json!({ "name": motion.name, "children": layer_nodes }));
        let place = [0.0, 0.0, CAMERA_DISTANCE];
        let camera = push(
            &mut self.nodes,
            json!({ "name": "camera", "camera": 0, "translation": place }),
        );
        let [width, height] = motion.puppet.size.map(|side| side as f64 / PIXELS_A_UNIT);
        let textures: Vec<Value> = (0..self.images.len())
            .map(|image| json!({ "sampler": 0, "source": image }))
            .collect();
        let (magnified, minified) = match motion.puppet.sampling {
            Sampling::Smooth => (LINEAR, LINEAR_MIPMAP_LINEAR),
            Sampling::Nearest => (NEAREST, NEAREST),
        };
        let mut document = json!({
            "asset": {
                "version": "2.0",
                "generator": concat!("inbetween ", env!("CARGO_PKG_VERSION")),
                "extras": {
                    "pixels_per_unit": PIXELS_A_UNIT,
                    "frame": motion.puppet.size,
                    "worst_deviation_px": report.worst,
                },
            },
            "extensionsUsed": ["KHR_materials_unlit"],
            "scene": 0,
            "scenes": [{ "nodes": [root, camera] }],
            "nodes": self.nodes,
            "cameras": [{
                "type": "orthographic",
                "orthographic": {
                    "xmag": width / 2.0,
                    "ymag": height / 2.0,
                    "znear": CAMERA_DISTANCE / 100.0,
                    "zfar": CAMERA_DISTANCE * 2.0,
                },
            }],
            "meshes": self.meshes,
            "materials": self.materials,
            "textures": textures,
            "images": self.images,
            "samplers": [{
                "magFilter": magnified,
                "minFilter": minified,
                "wrapS": CLAMP_TO_EDGE,
                "wrapT": CLAMP_TO_EDGE,
            }],
            "accessors": self.buffer.accessors,
            "bufferViews": self.buffer.views,
            "buffers": [{ "byteLength": self.buffer.bytes.len() }],
        });
        if !self.channels.is_empty() {
            document["animations"] =
                json!([{ "name": motion.name, "channels": self.channels, "samplers": self.samplers }]);
        }
        without_empty_lists(&mut document);
        container(&document, self.buffer.bytes)
    }
}

fn placed(positions: &[Point], size: [usize; 2]) -> Vec<[f32; 3]> {
    let centre = Point::new(size[0] as f64, size[1] as f64) * 0.5;
    positions.iter().map(|p| in_units(p - centre)).collect()
}

fn moves(from: &[Point], to: &[Point]) -> Vec<[f32; 3]> {
    from.iter().zip(to).map(|(a, b)| in_units(b - a)).collect()
}

fn in_units(p: Point) -> [f32; 3] {
    [(p.x / PIXELS_A_UNIT) as f32, (-p.y / PIXELS_A_UNIT) as f32, 0.0]
}

#[cfg(test)]
mod tests {
    use super::super::gltf_buffer::testing::GltfRead;
    use super::super::puppet_motion::testing::turning;
    use super::*;

    impl GltfRead {
        /// The sampler of a node's channel: its times and values.
        fn channel(&self, node: &str, path: &str) -> Option<(Vec<f32>, Vec<f32>)> {
            let animation = &self.json["animations"][0];
            let channel = animation["channels"]
                .as_array()
                .expect("channels")
                .iter()
                .find(|channel| {
                    let target = &channel["target"];
                    let at = target["node"].as_u64().expect("a node") as usize;
                    self.json["nodes"][at]["name"] == node && target["path"] == path
                })?;
            let sampler = &animation["samplers"][channel["sampler"].as_u64().expect("an index") as usize];
            Some((self.floats(&sampler["input"]), self.floats(&sampler["output"])))
        }

        fn value_at(times: &[f32], values: &[f32], time: f32) -> Vec<f32> {
            let width = values.len() / times.len();
            let next = times.partition_point(|t| *t <= time).clamp(1, times.len() - 1);
            let part = ((time - times[next - 1]) / (times[next] - times[next - 1])).clamp(0.0, 1.0);
            (0..width)
                .map(|c| {
                    let (a, b) = (values[(next - 1) * width + c], values[next * width + c]);
                    a + part * (b - a)
                })
                .collect()
        }
    }

    #[test]
    fn vertices_are_where_the_frames_have_them() {
        let turning = turning();
        for max_error in [0.0, 0.5, 3.0] {
            let (bytes, report) = gltf_bytes(&turning.motion(max_error)).expect("a file");
            let file = GltfRead::new(&bytes);
            let primitive = &file.json["meshes"][0]["primitives"][0];
            let base = file.floats(&primitive["attributes"]["POSITION"]);
            let targets: Vec<Vec<f32>> = primitive["targets"]
                .as_array()
                .expect("targets")
                .iter()
                .map(|target| file.floats(&target["POSITION"]))
                .collect();
            let (times, weights) = file.channel("wheel red", "weights").expect("an animation");
            let mut worst: f64 = 0.0;
            for (time, frame) in turning.times.iter().zip(&turning.frames) {
                let weights = GltfRead::value_at(&times, &weights, *time as f32);
                for (v, p) in frame.layers[0].positions.iter().enumerate() {
                    let place = |c: usize| {
                        let moved: f32 = targets.iter().zip(&weights).map(|(t, w)| t[3 * v + c] * w).sum();
                        f64::from(base[3 * v + c] + moved) * 100.0
                    };
                    worst = worst.max((Point::new(place(0) + 100.0, 50.0 - place(1)) - p).norm());
                }
            }
            assert!(
                worst <= max_error + 1e-3 && (worst - report.worst).abs() < 1e-3,
                "{worst} {report:?}"
            );
            assert_eq!(report.keys, [targets.len() + 1, 1]);
            assert_eq!(file.channel("box green", "weights"), None);
            assert!(max_error == 0.0 || targets.len() < 26);
        }
    }

    #[test]
    fn one_texture_a_layer_is_shown_and_layers_change_places() {
        let turning = turning();
        let file = GltfRead::new(&gltf_bytes(&turning.motion(1.0)).expect("a file").0);
        let (times, scales) = file.channel("wheel blue", "scale").expect("an animation");
        assert_eq!(scales, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        assert!(times[0] == 0.0 && (1.0..1.1).contains(&times[1]), "{times:?}");
        let (_, scales) = file.channel("box green", "scale").expect("an animation");
        assert_eq!(scales, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0], "hidden at the end");
        let (times, places) = file.channel("wheel", "translation").expect("an animation");
        assert_eq!((times, places), (vec![0.0, 1.0], vec![0.0, 0.0, 0.01, 0.0, 0.0, 0.0]));
        // Seen with y up, triangles turn to the left.
        let primitive = &file.json["meshes"][0]["primitives"][0];
        let base = file.floats(&primitive["attributes"]["POSITION"]);
        let view = &file.json["bufferViews"][primitive["indices"].as_u64().expect("an index") as usize];
        let start = view["byteOffset"].as_u64().expect("a place") as usize;
        let corner = |k: usize| {
            let v = usize::from(file.binary[start + 2 * k]);
            Point::new(f64::from(base[3 * v]), f64::from(base[3 * v + 1]))
        };
        assert!(crate::math::point::cross(corner(1) - corner(0), corner(2) - corner(0)) > 0.0);
    }

    #[test]
    fn nothing_seen_is_still_a_file() {
        let mut turning = turning();
        for frame in &mut turning.frames {
            for layer in &mut frame.layers {
                layer.opacity = 0.0;
            }
        }
        let file = GltfRead::new(&gltf_bytes(&turning.motion(1.0)).expect("a file").0);
        assert_eq!(file.json.get("meshes"), None);
    }
}
