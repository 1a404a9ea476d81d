//! From what a scene says about blending to the blend's own options.

use crate::blend::{self, BlendOptions};
use crate::pose::Mapping;
use crate::scene::{Anchor, Scene};

pub(super) fn blend_options(scene: &Scene, mapping: &Mapping) -> BlendOptions {
    let vertex = |landmark| nearest_vertex(scene, mapping, landmark);
    let settings = &scene.blend;
    BlendOptions {
        reference: settings.reference,
        stretch: settings.stretch,
        anchor: match &settings.anchor {
            Anchor::Centroid => blend::Anchor::Centroid,
            Anchor::Landmark(landmark) => blend::Anchor::Vertex(vertex(*landmark)),
            Anchor::Soft(anchors) => {
                let soft = anchors.iter().map(|anchor| blend::SoftAnchor {
                    vertex: vertex(anchor.landmark),
                    stiffness: anchor.stiffness,
                });
                blend::Anchor::Soft(soft.collect())
            }
        },
        turns: scene.poses.iter().map(|pose| pose.turns).collect(),
        regions: settings
            .regions
            .iter()
            .map(|region| blend::Region {
                vertex: vertex(region.landmark),
                radius: region.radius,
                stiffness: region.stiffness,
                stretch_limit: region.stretch_limit,
            })
            .collect(),
        guard: settings.guard,
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
