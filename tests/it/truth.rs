//! The scenes of `data/` without any landmark, against what is known of where the same points are on every drawing.

use std::io::Write as _;
use std::path::PathBuf;

use inbetween::math::Point;
use inbetween::mesh::PointLocator;
use inbetween::pipeline::{LayerParts, PoseShape, map_layer};
use inbetween::scene::Scene;

/// A point is off where it is farther than this from the truth, as a fraction of the pose's diagonal.
const OFF: f64 = 0.02;

/// The share of the known points that are off, over all poses but the reference, when the scene's landmarks are taken away.
fn off(scene: &str) -> f64 {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data").join(scene);
    let truth = std::fs::read_to_string(folder.join("truth.toml")).expect("known points");
    let truth: toml::Table = truth.parse().expect("TOML");
    let opened = Scene::open(&folder.join("scene.toml")).expect("a scene");
    // The points are those of the figure without what is loose.
    let mut parts = LayerParts::of(&opened.layer_spec(0).expect("drawings"), &[]);
    let mut layer = parts.layers.swap_remove(parts.largest);
    layer.landmarks.clear();
    layer.poses.retain(|pose| matches!(pose.shape, PoseShape::Drawn(_)));
    let (mapping, _) = map_layer(&layer).expect("a mapping");
    let reference = mapping.matching.reference;
    let (names, poses) = (mapping.poses.names(), mapping.poses.positions());
    let locator = PointLocator::new(mapping.poses.topology().triangles(), &poses[reference]);
    let place = |landmark: &toml::Value, pose: &str| -> Option<Point> {
        let at = landmark.get("at")?.get(pose)?.as_array()?;
        Some(Point::new(at[0].as_float()?, at[1].as_float()?))
    };
    let (mut known, mut missed) = (0, 0);
    for landmark in truth["landmark"].as_array().expect("points") {
        let from = place(landmark, &names[reference]).expect("a place on the reference");
        let bound = locator.bind(from).expect("a triangle");
        for pose in (0..names.len()).filter(|pose| *pose != reference) {
            if let Some(to) = place(landmark, &names[pose]) {
                known += 1;
                missed += usize::from((bound.at(&poses[pose]) - to).norm() > OFF * mapping.outlines[pose].diagonal());
            }
        }
    }
    let share = f64::from(missed as u32) / f64::from(known as u32);
    let said = writeln!(
        std::io::stderr(),
        "{scene}: {missed} of {known} points are off by more than 2 % of the diagonal: {:.1} %",
        100.0 * share
    );
    said.expect("written");
    share
}

#[test]
fn a_walker_needs_no_landmark() {
    assert!(off("walker") <= 0.02);
}

#[test]
fn a_snake_needs_no_landmark() {
    assert!(off("snake") <= 0.02);
}

#[test]
fn a_clown_needs_no_landmark() {
    assert!(off("clown") <= 0.02);
}

#[test]
fn a_head_that_turns_is_mostly_found() {
    // Hair slides over the forehead: what a mesh cannot follow is what landmarks are for.
    assert!(off("face") <= 0.2);
}

#[test]
fn a_wizard_in_ink_needs_no_landmark() {
    assert!(off("wizard") <= 0.02);
}
