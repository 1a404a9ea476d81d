//! From a layer's blend options, whose points are landmarks, to those of its mesh, whose points are vertices.

use super::spec::LayerSpec;
use crate::blend::BlendOptions;
use crate::pose::Mapping;

pub(super) fn blend_options(layer: &LayerSpec, mapping: &Mapping) -> BlendOptions {
    layer
        .blend
        .with_points(|landmark| nearest_vertex(layer, mapping, landmark))
}

/// The vertex nearest to a landmark, over all poses that have it.
fn nearest_vertex(layer: &LayerSpec, mapping: &Mapping, landmark: usize) -> usize {
    let places = &layer.landmarks[landmark].at;
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
