use super::super::gltf_buffer::testing::GltfRead;
use super::super::shape_keys::ShapeState;
use super::*;
use crate::shape3d::{Form, FormTopology, Joint, Skeleton, Skin, Turn};

fn doubles(file: &GltfRead, accessor: &serde_json::Value) -> Vec<f64> {
    file.floats(accessor).into_iter().map(f64::from).collect()
}

/// A bar of two quadrangles, straight, bent and fat; six joints in a row, all of which every vertex follows.
struct Bar {
    topology: FormTopology,
    examples: Vec<String>,
    forms: Vec<Form>,
    normals: Vec<Vec<Point3>>,
    rig: Rig,
    times: Vec<f64>,
    states: Vec<ShapeState>,
}

impl Bar {
    fn new() -> Self {
        let triangles = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
        // A seam between the two quadrangles.
        let places: Vec<[f64; 2]> = (0..8).map(|k| [f64::from(k) / 7.0, f64::from(k % 3) / 2.0]).collect();
        let on_texture = vec![[0, 1, 4], [0, 4, 3], [6, 2, 5], [6, 5, 7]];
        let topology = FormTopology::from_textured_triangles(6, triangles, places, on_texture).expect("a topology");
        let form = |bend: f64, high: f64| {
            let p = |x: f64, y: f64| Point3::new(x, y * high + bend * x * x, 0.1 * bend * x);
            let positions = vec![
                p(0.0, 0.0),
                p(1.0, 0.0),
                p(2.0, 0.0),
                p(0.0, 1.0),
                p(1.0, 1.0),
                p(2.0, 1.0),
            ];
            Form::new(&topology, positions).expect("a form")
        };
        let forms = vec![form(0.0, 1.0), form(0.4, 1.0), form(0.0, 1.7)];
        let joints: Vec<Joint> = (0..6)
            .map(|k: usize| {
                let mut joint = Joint::new(
                    &format!("j{k}"),
                    k.checked_sub(1),
                    Point3::new(0.4 * k as f64, 0.0, 0.0),
                );
                joint.turns.push(Turn {
                    adjective: 0,
                    axis: Point3::new(0.2, 0.0, 1.0),
                    degrees: 25.0,
                    degrees_at_zero: 3.0 * k as f64,
                });
                joint
            })
            .collect();
        let skeleton = Skeleton::new(joints, 1).expect("a skeleton");
        let influences: Vec<Vec<(usize, f64)>> = (0..6)
            .map(|v| {
                let raw: Vec<f64> = (0..6).map(|j| 1.0 + f64::from((v * 5 + j * 3) % 7)).collect();
                let sum: f64 = raw.iter().sum();
                raw.iter().enumerate().map(|(j, w)| (j, w / sum)).collect()
            })
            .collect();
        let times: Vec<f64> = (0..49).map(|k| f64::from(k) / 24.0).collect();
        let state = |time: &f64| {
            let (a, b) = (0.5 - 0.5 * (2.0 * time).cos(), 0.3 * (5.0 * time).sin());
            ShapeState {
                weights: vec![1.0 - a - b, a, b],
                joints: skeleton.local_poses(&[4.0 * a]).expect("a place"),
            }
        };
        Self {
            examples: ["straight", "bent", "fat"].map(str::to_owned).to_vec(),
            normals: vec![vec![Point3::z(); 6]; 3],
            states: times.iter().map(state).collect(),
            rig: Rig::new(skeleton.clone(), Skin::new(&influences, 6).expect("a skin")).expect("a rig"),
            topology,
            forms,
            times,
        }
    }

    fn motion(&self, rig: Option<&'_ Rig>, max_error: f64) -> ShapeMotion<'_> {
        // The lifetime of the rig is that of the bar.
        ShapeMotion {
            name: "bar",
            topology: &self.topology,
            examples: &self.examples,
            forms: &self.forms,
            normals: &self.normals,
            rig: rig.map(|_| &self.rig),
            texture: None,
            times: &self.times,
            states: &self.states,
            max_error,
        }
    }

    fn without_joints(mut self) -> Self {
        for state in &mut self.states {
            state.joints.clear();
        }
        self
    }
}

#[test]
fn targets_and_weights_give_the_blend() {
    let bar = Bar::new().without_joints();
    let (bytes, report) = shape_gltf_bytes(&bar.motion(None, 0.0)).expect("a file");
    assert_eq!((report.keys, report.worst), (49, 0.0));
    let file = GltfRead::new(&bytes);
    let mesh = &file.json["meshes"][0];
    assert_eq!(mesh["extras"]["targetNames"], json!(["bent", "fat"]));
    let primitive = &mesh["primitives"][0];
    let base = doubles(&file, &primitive["attributes"]["POSITION"]);
    assert_eq!(base.len(), 3 * 8, "two vertices are doubled at the seam");
    let target = |k: usize| doubles(&file, &primitive["targets"][k]["POSITION"]);
    let targets = [target(0), target(1)];
    let sampler = &file.json["animations"][0]["samplers"][0];
    let weights = doubles(&file, &sampler["output"]);
    // The vertices in the order of the triangles.
    let order = [0, 1, 4, 3, 1, 2, 5, 4];
    for (k, state) in bar.states.iter().enumerate() {
        for (corner, vertex) in order.into_iter().enumerate() {
            let blend: Point3 = (bar.forms.iter().zip(&state.weights))
                .map(|(form, w)| form.positions()[vertex] * *w)
                .sum();
            for c in 0..3 {
                let at = 3 * corner + c;
                let shown = base[at] + targets[0][at] * weights[2 * k] + targets[1][at] * weights[2 * k + 1];
                assert!((shown - blend[c]).abs() < 1e-6);
            }
        }
    }
    // Rows of a texture are counted from the top.
    let places = doubles(&file, &primitive["attributes"]["TEXCOORD_0"]);
    assert_eq!(&places[2..4], [f64::from(1.0f32 / 7.0), 0.5]);
}

#[test]
fn keys_hold_the_tolerance_and_none_is_too_many() {
    let bar = Bar::new();
    for rig in [None, Some(&bar.rig)] {
        let plain = Bar::new().without_joints();
        let motion = |max_error| match rig {
            Some(rig) => bar.motion(Some(rig), max_error),
            None => plain.motion(None, max_error),
        };
        let mut before = usize::MAX;
        for max_error in [1e-4, 1e-2, 0.1] {
            let (_, report) = shape_gltf_bytes(&motion(max_error)).expect("a file");
            assert!(report.worst <= max_error && report.keys < before, "{report:?}");
            before = report.keys;
        }
        assert!(before <= 16, "{before}");
    }
}

#[test]
fn every_influence_is_written_four_a_set() {
    let bar = Bar::new();
    let file = GltfRead::new(&shape_gltf_bytes(&bar.motion(Some(&bar.rig), 0.01)).expect("a file").0);
    let attributes = &file.json["meshes"][0]["primitives"][0]["attributes"];
    let [heavy, light] = ["WEIGHTS_0", "WEIGHTS_1"].map(|key| doubles(&file, &attributes[key]));
    for v in 0..8 {
        let sum: f64 = heavy[4 * v..4 * v + 4].iter().chain(&light[4 * v..4 * v + 4]).sum();
        assert!((sum - 1.0).abs() < 1e-6);
        assert!(heavy[4 * v + 3] >= light[4 * v], "the heaviest first");
        assert_eq!(&light[4 * v + 2..4 * v + 4], [0.0, 0.0]);
    }
    assert_eq!(file.json["skins"][0]["joints"].as_array().map(Vec::len), Some(6));
    let matrices = doubles(&file, &file.json["skins"][0]["inverseBindMatrices"]);
    assert_eq!(matrices[16 * 5 + 12], f64::from(-2.0f32));
    // A joint hangs on its parent, at its distance from it.
    let node = |name: &str| {
        let nodes = file.json["nodes"].as_array().expect("nodes");
        nodes.iter().position(|node| node["name"] == name).expect("a node")
    };
    assert_eq!(file.json["nodes"][node("j1")]["children"], json!([node("j2")]));
    let channels = file.json["animations"][0]["channels"].as_array().expect("channels");
    assert_eq!(channels.len(), 7, "six rotations and the weights");
}

#[test]
fn one_form_at_one_time_is_a_file_too() {
    let mut bar = Bar::new().without_joints();
    bar.times.truncate(1);
    bar.states.truncate(1);
    let file = GltfRead::new(&shape_gltf_bytes(&bar.motion(None, 0.0)).expect("a file").0);
    assert_eq!(file.json.get("animations"), None);
    bar.forms.truncate(1);
    bar.normals.truncate(1);
    bar.examples.truncate(1);
    bar.states[0].weights.truncate(1);
    let file = GltfRead::new(&shape_gltf_bytes(&bar.motion(None, 0.0)).expect("a file").0);
    assert_eq!(file.json["meshes"][0]["primitives"][0].get("targets"), None);
    bar.states.clear();
    assert!(shape_gltf_bytes(&bar.motion(None, 0.0)).is_err());
}
