//! The shapes of `data/shapes` are what the paper's figures show: the blob passes through itself in the corners of its space unless
//! pseudo-examples take that away, and the arm on its skeleton meets every example.

use std::path::{Path, PathBuf};

use inbetween::input::{ObjForm, open_obj};
use inbetween::math::Point3;
use inbetween::shape3d::{
    Example, Form, FormTopology, Joint, LoopSubdivision, Rig, RigScratch, Shape, Skeleton, Skin, SubdivisionOptions,
    Turn,
};
use inbetween::weights::{PseudoPose, RbfOptions, WeightProvider};

struct Scene {
    adjectives: Vec<String>,
    topology: FormTopology,
    forms: Vec<Vec<Point3>>,
    places: Vec<Vec<f64>>,
    pseudo_examples: Vec<PseudoPose>,
    table: toml::Table,
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/shapes").join(name)
}

fn open(name: &str) -> Scene {
    let text = std::fs::read_to_string(folder(name).join("scene.toml")).expect("a scene");
    let table: toml::Table = text.parse().expect("TOML");
    let adjectives: Vec<String> = table["adjectives"]
        .as_array()
        .expect("adjectives")
        .iter()
        .map(|adjective| adjective.as_str().expect("a name").to_owned())
        .collect();
    let place = |at: &toml::Value| -> Vec<f64> {
        adjectives
            .iter()
            .map(|adjective| at[adjective].as_float().expect("a number"))
            .collect()
    };
    let mut forms = Vec::new();
    let mut topology: Option<FormTopology> = None;
    let mut places = Vec::new();
    for example in table["example"].as_array().expect("examples") {
        let file = example["form"].as_str().expect("a file");
        let ObjForm { topology: own, form } = open_obj(&folder(name).join(file)).expect("a form");
        topology
            .get_or_insert_with(|| own.clone())
            .same_as(&own)
            .expect("one topology");
        forms.push(form.into_positions());
        places.push(place(&example["at"]));
    }
    let pseudo_examples = table["pseudo_example"].as_array().expect("pseudo-examples");
    Scene {
        pseudo_examples: pseudo_examples
            .iter()
            .map(|pseudo| PseudoPose {
                from: place(&pseudo["from"]),
                at: place(&pseudo["at"]),
            })
            .collect(),
        topology: topology.expect("an example"),
        forms,
        places,
        adjectives: adjectives.clone(),
        table,
    }
}

impl Scene {
    fn shape(&self, forms: &[Vec<Point3>], pseudo_poses: &[PseudoPose]) -> Shape {
        let examples = forms
            .iter()
            .zip(&self.places)
            .map(|(positions, at)| Example {
                form: Form::new(&self.topology, positions.clone()).expect("a form"),
                at: at.clone(),
            })
            .collect();
        let mut options = RbfOptions::default();
        options.pseudo_poses = pseudo_poses.to_vec();
        Shape::new(self.topology.clone(), examples, &options).expect("a shape")
    }

    fn skeleton(&self) -> Skeleton {
        let given = self.table["skeleton"]["joint"].as_array().expect("joints");
        let name_of = |joint: &toml::Value| joint["name"].as_str().expect("a name").to_owned();
        let point = |value: &toml::Value| -> Point3 {
            let numbers = value.as_array().expect("three numbers");
            Point3::from_iterator(numbers.iter().map(|number| number.as_float().expect("a number")))
        };
        let joints = given.iter().map(|joint| {
            let parent = joint.get("parent").map(|parent| {
                let is_parent = |other: &toml::Value| other["name"] == *parent;
                given.iter().position(is_parent).expect("a parent")
            });
            let mut made = Joint::new(&name_of(joint), parent, point(&joint["origin"]));
            for turn in joint
                .get("turns")
                .and_then(|turns| turns.as_array())
                .into_iter()
                .flatten()
            {
                let adjective = turn["adjective"].as_str().expect("an adjective");
                made.turns.push(Turn {
                    adjective: self
                        .adjectives
                        .iter()
                        .position(|a| a == adjective)
                        .expect("an adjective"),
                    axis: point(&turn["axis"]),
                    degrees: turn["degrees"].as_float().expect("a number"),
                    degrees_at_zero: 0.0,
                });
            }
            made
        });
        Skeleton::new(joints.collect(), self.adjectives.len()).expect("a skeleton")
    }
}

/// How many pairs of triangles without a common vertex cut one another.
fn self_intersections(positions: &[Point3], triangles: &[[usize; 3]]) -> usize {
    let corners = |triangle: &[usize; 3]| triangle.map(|vertex| positions[vertex]);
    let cuts = |from: Point3, to: Point3, [a, b, c]: [Point3; 3]| {
        let side = |p: Point3, q: Point3, r: Point3, s: Point3| (q - p).cross(&(r - p)).dot(&(s - p)) > 0.0;
        side(a, b, c, from) != side(a, b, c, to)
            && side(from, to, a, b) == side(from, to, b, c)
            && side(from, to, b, c) == side(from, to, c, a)
    };
    let mut found = 0;
    for (index, first) in triangles.iter().enumerate() {
        let one = corners(first);
        let (low, high) = (one[0].inf(&one[1]).inf(&one[2]), one[0].sup(&one[1]).sup(&one[2]));
        for second in &triangles[index + 1..] {
            let other = corners(second);
            let is_apart = (0..3).any(|axis| {
                other.iter().all(|at| at[axis] > high[axis]) || other.iter().all(|at| at[axis] < low[axis])
            });
            if is_apart || first.iter().any(|vertex| second.contains(vertex)) {
                continue;
            }
            let crosses =
                |[a, b, c]: [Point3; 3], triangle| cuts(a, b, triangle) || cuts(b, c, triangle) || cuts(c, a, triangle);
            found += usize::from(crosses(one, other) || crosses(other, one));
        }
    }
    found
}

#[test]
fn pseudo_examples_keep_the_blob_from_passing_through_itself() {
    let scene = open("bendable");
    let triangles = scene.topology.triangles();
    assert_eq!(
        (scene.topology.vertex_count(), triangles.len(), scene.forms.len()),
        (642, 1280, 5)
    );
    for form in &scene.forms {
        assert_eq!(self_intersections(form, triangles), 0);
    }
    let plain = scene.shape(&scene.forms, &[]);
    let bent = scene.shape(&scene.forms, &scene.pseudo_examples);
    for bend in [-1.0, 1.0] {
        let at = |shape: &Shape| shape.form_at(&[bend, 1.0]).expect("a form").into_positions();
        assert!(self_intersections(&at(&plain), triangles) > 20);
        assert_eq!(self_intersections(&at(&bent), triangles), 0);
    }
    // One step of subdivision has the paper's numbers.
    let smooth = LoopSubdivision::new(642, triangles, &SubdivisionOptions::default()).expect("a subdivision");
    assert_eq!((smooth.vertex_count(), smooth.triangles().len()), (2562, 5120));
}

#[test]
fn the_arm_on_its_skeleton_meets_every_example() {
    let scene = open("arm");
    assert_eq!(
        (
            scene.topology.vertex_count(),
            scene.forms.len(),
            scene.pseudo_examples.len()
        ),
        (1304, 8, 6)
    );
    let text = std::fs::read_to_string(folder("arm").join("arm.weights.json")).expect("weights");
    let given: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let weights: Vec<Vec<(usize, f64)>> = serde_json::from_value(given["weights"].clone()).expect("weights");
    let skeleton = scene.skeleton();
    let skin = Skin::new(&weights, skeleton.joints().len()).expect("a skin");
    let rig = Rig::new(skeleton, skin).expect("a rig");
    let rest: Vec<_> = scene
        .places
        .iter()
        .zip(&scene.forms)
        .map(|(place, form)| rig.untransform(place, form).expect("a rest form"))
        .collect();
    assert!(rest.iter().all(|form| form.near_singular.is_empty()));
    let positions: Vec<Vec<Point3>> = rest.iter().map(|form| form.positions.clone()).collect();
    let shape = scene.shape(&positions, &scene.pseudo_examples);
    let poser = rig.poser(&rest);
    let mut scratch = RigScratch::default();
    let mut posed = |place: &[f64]| {
        let mut weights = Vec::new();
        shape.weights().weights(place, &mut weights).expect("weights");
        let mut positions = shape.form_at(place).expect("a form").into_positions();
        poser
            .pose(place, &weights, &mut positions, &mut scratch)
            .expect("a pose");
        positions
    };
    for (place, wanted) in scene.places.iter().zip(&scene.forms) {
        for (found, wanted) in posed(place).iter().zip(wanted) {
            assert!((found - wanted).norm() < 1e-9, "{place:?}: {found} {wanted}");
        }
    }
    // The hand is carried: with the shoulder up and the elbow bent it is far from where either example has it.
    let fingertip = |form: &[Point3]| {
        form.iter()
            .fold(Point3::zeros(), |a, &b| if b.norm() > a.norm() { b } else { a })
    };
    let length = fingertip(&scene.forms[0]).norm();
    let raised = posed(&[1.0, 0.0, 0.0, 0.5]);
    assert!(
        (fingertip(&raised).norm() - length).abs() < 0.3,
        "{}",
        fingertip(&raised)
    );
}
