//! From what a scene says about blending to the options of a blend of its mesh: landmarks become vertices.

use crate::blend::BlendOptions;
use crate::pose::Mapping;
use crate::scene::Scene;

pub(super) fn blend_options(scene: &Scene, mapping: &Mapping) -> BlendOptions {
    BlendOptions {
        turns: scene.poses.iter().map(|pose| pose.turns).collect(),
        ..scene
            .blend
            .with_points(|landmark| nearest_vertex(scene, mapping, landmark))
    }
}

/// The vertex nearest to a landmark, over all poses that have it.
fn nearest_vertex(scene: &Scene, mapping: &Mapping, landmark: usize) -> usize {
    let places = &scene.landmarks[landmark].at;
    let distance = |vertex: usize| -> f64 {
        places
            .iter()
            .zip(mapping.poses.positions())
            .filter_map(|(place, positions)| place.map(|place| (positions[vertex] - place).norm()))
            .sum()
    };
    (0..mapping.poses.topology().vertex_count())
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        .unwrap_or(0)
}
