//! glTF 2.0 of a shape in space: its examples as morph targets, their weights as an animation, joints as a skin.
//!
//! The blend of a shape is linear in its weights, and these sum to 1, so glTF can hold it exactly:
//! `sum w_i X_i = X_0 + sum_(i > 0) w_i (X_i - X_0)`. The mesh is the first example; every other is a target, the difference to the
//! first, called by its name (`extras.targetNames`); the first example's weight is what the others leave of 1. Any place of the space
//! is a set of weights: `inbetween shape weights` prints them.
//!
//! - **Skeleton**: targets are the examples in the rest position (SBE 5), joints are nodes with their adjectives' turns as an
//!   animation, so that players do what equation 8 does. A vertex follows as many joints as it has weights, four to a set; players
//!   that know one set only take the heaviest four.
//! - **Animation**: at keys, so close that no vertex is further than [`ShapeMotion::max_error`] from where it belongs at
//!   any sample.
//! - **Texture**: core glTF blends no pictures; there is one, for the whole animation. Where the texture has seams, vertices are
//!   doubled.
//! - **Normals** are targets, too: blends of the examples' normals, as players do it, which on a blend are nearly but not exactly
//!   perpendicular.
//!
//! Forms are written as they are: y up is what glTF wants, too.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::MotionError;
use super::gltf_buffer::{GltfBuffer, LINEAR, LINEAR_MIPMAP_LINEAR, container, push, without_empty_lists};
use super::shape_keys::{ShapeMotion, ShapeReport};
use crate::math::Point3;
use crate::shape3d::{LocalPose, Rig};

/// The colour of a form without a texture: a warm clay, in linear light.
const CLAY: [f64; 4] = [0.66, 0.40, 0.28, 1.0];
const ROUGHNESS: f64 = 0.75;

/// The bytes of a `.glb` file.
///
/// # Errors
/// [`MotionError`] if the motion does not fit together, or the file would be larger than 4 GB.
pub fn shape_gltf_bytes(motion: &ShapeMotion<'_>) -> Result<(Vec<u8>, ShapeReport), MotionError> {
    motion.check()?;
    let keys = motion.keys();
    let report = ShapeReport {
        keys: keys.len(),
        worst: motion.worst(&keys),
    };
    let corners = Corners::new(motion);
    let mut file = File::default();
    file.add_mesh(motion, &corners);
    let mut roots = vec![push(&mut file.nodes, json!({ "name": motion.name, "mesh": 0 }))];
    if let Some(rig) = motion.rig {
        roots.push(file.add_skin(motion, rig, &keys));
    }
    if motion.forms.len() > 1 && keys.len() > 1 {
        let weights = keys.iter().flat_map(|&key| &motion.states[key].weights[1..]);
        let weights: Vec<f32> = weights.map(|&w| w as f32).collect();
        let output = file.buffer.add_scalars(&weights);
        file.add_channel(motion, &keys, output, roots[0], "weights");
    }
    Ok((file.finish(motion, &roots, &report)?, report))
}

/// The vertices of the file: a vertex of the form and a place in the texture, each pair once, in the order of the triangles.
struct Corners {
    pairs: Vec<(usize, usize)>,
    indices: Vec<usize>,
}

impl Corners {
    fn new(motion: &ShapeMotion<'_>) -> Self {
        let topology = motion.topology;
        let mut numbers: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let mut corners = Self {
            pairs: Vec::new(),
            indices: Vec::new(),
        };
        for (k, triangle) in topology.triangles().iter().enumerate() {
            let places = topology.texture_triangles().get(k).copied().unwrap_or_default();
            for pair in triangle.iter().copied().zip(places) {
                let number = *numbers.entry(pair).or_insert_with(|| {
                    corners.pairs.push(pair);
                    corners.pairs.len() - 1
                });
                corners.indices.push(number);
            }
        }
        corners
    }

    fn of_vertices<T>(&self, of: impl Fn(usize) -> T) -> Vec<T> {
        self.pairs.iter().map(|&(vertex, _)| of(vertex)).collect()
    }
}

/// The parts of the file so far.
#[derive(Default)]
struct File {
    buffer: GltfBuffer,
    images: Vec<Value>,
    meshes: Vec<Value>,
    skins: Vec<Value>,
    nodes: Vec<Value>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    /// The accessor of the keys' times.
    times: Option<usize>,
}

impl File {
    fn add_mesh(&mut self, motion: &ShapeMotion<'_>, corners: &Corners) {
        let base = motion.forms[0].positions();
        let base_normals = &motion.normals[0];
        let mut attributes = json!({
            "POSITION": self.buffer.add_positions(&corners.of_vertices(|v| single(base[v]))),
            "NORMAL": self.buffer.add_attribute(&corners.of_vertices(|v| single(unit(base_normals[v])))),
        });
        if motion.topology.has_texture() {
            let places = motion.topology.texture_coordinates();
            // From the upper left corner.
            let place = |&(_, k): &(usize, usize)| [places[k][0] as f32, (1.0 - places[k][1]) as f32];
            let places: Vec<[f32; 2]> = corners.pairs.iter().map(place).collect();
            attributes["TEXCOORD_0"] = json!(self.buffer.add_attribute(&places));
        }
        if let Some(rig) = motion.rig {
            self.add_influences(rig, corners, &mut attributes);
        }
        let mut primitive = json!({
            "attributes": attributes,
            "indices": self.buffer.add_indices(&corners.indices),
            "material": 0,
        });
        let mut mesh = json!({ "name": motion.name });
        if motion.forms.len() > 1 {
            let targets: Vec<Value> = (motion.forms.iter().zip(motion.normals))
                .skip(1)
                .map(|(form, normals)| {
                    let moves = corners.of_vertices(|v| single(form.positions()[v] - base[v]));
                    let turns = corners.of_vertices(|v| single(unit(normals[v]) - unit(base_normals[v])));
                    json!({
                        "POSITION": self.buffer.add_positions(&moves),
                        "NORMAL": self.buffer.add_attribute(&turns),
                    })
                })
                .collect();
            primitive["targets"] = json!(targets);
            mesh["weights"] = json!(motion.states[0].weights[1..]);
            mesh["extras"] = json!({ "targetNames": motion.examples[1..], "base": motion.examples[0] });
        }
        mesh["primitives"] = json!([primitive]);
        self.meshes.push(mesh);
        if let Some(png) = motion.texture {
            let view = self.buffer.add_view(png, None);
            self.images
                .push(json!({ "name": motion.name, "bufferView": view, "mimeType": "image/png" }));
        }
    }

    /// Joints and weights, four a set, the heaviest first.
    fn add_influences(&mut self, rig: &Rig, corners: &Corners, attributes: &mut Value) {
        let sorted = |vertex: usize| {
            let mut entries = rig.skin().of(vertex).to_vec();
            entries.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            entries
        };
        let entries: Vec<Vec<(usize, f64)>> = corners.of_vertices(sorted);
        let most = entries.iter().map(Vec::len).max().unwrap_or(0);
        for set in 0..most.div_ceil(4).max(1) {
            let entry = |list: &Vec<(usize, f64)>, k: usize| list.get(4 * set + k).copied().unwrap_or((0, 0.0));
            let four = |list: &Vec<(usize, f64)>| std::array::from_fn(|k| entry(list, k).0 as u16);
            let joints: Vec<[u16; 4]> = entries.iter().map(four).collect();
            let four = |list: &Vec<(usize, f64)>| std::array::from_fn(|k| entry(list, k).1 as f32);
            let weights: Vec<[f32; 4]> = entries.iter().map(four).collect();
            attributes[format!("JOINTS_{set}")] = json!(self.buffer.add_joints(&joints));
            attributes[format!("WEIGHTS_{set}")] = json!(self.buffer.add_attribute(&weights));
        }
    }

    /// The joints as nodes, and the skin; the index of the node above them.
    fn add_skin(&mut self, motion: &ShapeMotion<'_>, rig: &Rig, keys: &[usize]) -> usize {
        let joints = rig.skeleton().joints();
        let first = self.nodes.len();
        let children = |parent: Option<usize>| -> Vec<usize> {
            let own = joints.iter().enumerate().filter(|(_, joint)| joint.parent == parent);
            own.map(|(index, _)| first + index).collect()
        };
        for (index, (joint, pose)) in joints.iter().zip(&motion.states[0].joints).enumerate() {
            let mut node = json!({
                "name": joint.name,
                "translation": single(pose.translation),
                "rotation": pose.rotation.map(|x| x as f32),
                "scale": single(pose.scale),
            });
            let children = children(Some(index));
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            self.nodes.push(node);
        }
        let root = json!({ "name": format!("{} skeleton", motion.name), "children": children(None) });
        let root = push(&mut self.nodes, root);
        let to_origin = |joint: &crate::shape3d::Joint| {
            let [x, y, z] = single(-joint.origin);
            let mut matrix = [0.0f32; 16];
            for k in [0, 5, 10, 15] {
                matrix[k] = 1.0;
            }
            matrix[12..15].copy_from_slice(&[x, y, z]);
            matrix
        };
        let matrices: Vec<[f32; 16]> = joints.iter().map(to_origin).collect();
        let matrices = self.buffer.add_values(&matrices);
        let list: Vec<usize> = (first..first + joints.len()).collect();
        self.skins
            .push(json!({ "joints": list, "skeleton": root, "inverseBindMatrices": matrices }));
        self.nodes[0]["skin"] = json!(0);
        for joint in 0..joints.len() {
            self.add_joint_motion(motion, keys, joint, first + joint);
        }
        root
    }

    fn add_joint_motion(&mut self, motion: &ShapeMotion<'_>, keys: &[usize], joint: usize, node: usize) {
        let poses = || keys.iter().map(|&key| &motion.states[key].joints[joint]);
        let moves = |of: fn(&LocalPose) -> &[f64]| poses().any(|pose| of(pose) != of(&motion.states[0].joints[joint]));
        if moves(|pose| &pose.rotation) {
            // Of the two quaternions of a rotation the one on the side of its predecessor's.
            let mut rotations: Vec<[f32; 4]> = Vec::new();
            for pose in poses() {
                let own = pose.rotation.map(|x| x as f32);
                let dot: f32 = rotations
                    .last()
                    .map_or(1.0, |before| before.iter().zip(own).map(|(a, b)| a * b).sum());
                rotations.push(if dot < 0.0 { own.map(|x| -x) } else { own });
            }
            let output = self.buffer.add_values(&rotations);
            self.add_channel(motion, keys, output, node, "rotation");
        }
        if moves(|pose| pose.translation.as_slice()) {
            let places: Vec<[f32; 3]> = poses().map(|pose| single(pose.translation)).collect();
            let output = self.buffer.add_values(&places);
            self.add_channel(motion, keys, output, node, "translation");
        }
        if moves(|pose| pose.scale.as_slice()) {
            let scales: Vec<[f32; 3]> = poses().map(|pose| single(pose.scale)).collect();
            let output = self.buffer.add_values(&scales);
            self.add_channel(motion, keys, output, node, "scale");
        }
    }

    fn add_channel(&mut self, motion: &ShapeMotion<'_>, keys: &[usize], output: usize, node: usize, path: &str) {
        let times: Vec<f32> = keys.iter().map(|&key| motion.times[key] as f32).collect();
        let buffer = &mut self.buffer;
        let input = *self.times.get_or_insert_with(|| buffer.add_times(&times));
        let sampler = json!({ "input": input, "output": output, "interpolation": "LINEAR" });
        let sampler = push(&mut self.samplers, sampler);
        self.channels
            .push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    fn finish(self, motion: &ShapeMotion<'_>, roots: &[usize], report: &ShapeReport) -> Result<Vec<u8>, MotionError> {
        let mut surface = json!({ "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS });
        if self.images.is_empty() {
            surface["baseColorFactor"] = json!(CLAY);
        } else {
            surface["baseColorTexture"] = json!({ "index": 0 });
        }
        let textures: Vec<Value> = self
            .images
            .iter()
            .map(|_| json!({ "sampler": 0, "source": 0 }))
            .collect();
        let filters: Vec<Value> = (self.images.iter())
            .map(|_| json!({ "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR }))
            .collect();
        let mut document = json!({
            "asset": {
                "version": "2.0",
                "generator": concat!("inbetween ", env!("CARGO_PKG_VERSION")),
                "extras": { "worst_deviation": report.worst },
            },
            "scene": 0,
            "scenes": [{ "nodes": roots }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "skins": self.skins,
            "materials": [{ "name": motion.name, "doubleSided": true, "pbrMetallicRoughness": surface }],
            "textures": textures,
            "images": self.images,
            "samplers": filters,
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

fn single(p: Point3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

/// A normal of length 1, also where the form has none.
fn unit(normal: Point3) -> Point3 {
    normal.try_normalize(f64::MIN_POSITIVE).unwrap_or(Point3::z())
}

#[cfg(test)]
mod tests;
