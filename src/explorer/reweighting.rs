//! Weights that follow a pose at once, while it is dragged.

use std::sync::Arc;

use inbetween::scene::{Provider, Scene, Workbench};
use inbetween::weights::Range;

/// What changed besides places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Only {
    /// Nothing: what is shown is complete.
    Weights,
    /// Something that has to be computed.
    More,
}

/// The same shapes with the weights of `scene`, if these follow from moving poses, which takes a millisecond.
pub(super) fn reweighted(bench: &Workbench, scene: &Scene) -> Option<(Workbench, Only)> {
    let old = bench.scene();
    let is_quick = match scene.pose_space.provider {
        Provider::Rbf => true,
        Provider::Biharmonic => scene.pose_space.range == Range::Free && scene.pseudo_poses.is_empty(),
    };
    let is_alike = is_quick
        && old.pose_space == scene.pose_space
        && old.pseudo_poses == scene.pseudo_poses
        && old.names() == scene.names()
        && old.dimension() == scene.dimension();
    if !is_alike {
        return None;
    }
    let moved: Vec<usize> = (0..scene.poses.len())
        .filter(|&k| old.poses[k].at != scene.poses[k].at)
        .collect();
    if moved.is_empty() {
        return None;
    }
    let mut weights = bench.weights().as_ref().clone();
    for pose in moved {
        weights.move_pose(pose, &scene.poses[pose].at).ok()?;
    }
    let moved = with_places_of(old, scene);
    let only = if moved == *scene { Only::Weights } else { Only::More };
    Some((bench.reweighted(&moved, Arc::new(weights)), only))
}

/// A scene with the places, and what follows from them, of another with as many poses.
pub(super) fn with_places_of(scene: &Scene, other: &Scene) -> Scene {
    let mut scene = scene.clone();
    for (pose, other) in scene.poses.iter_mut().zip(&other.poses) {
        pose.at.clone_from(&other.at);
    }
    for (layer, other) in scene.layers.iter_mut().zip(&other.layers) {
        layer.scene = with_places_of(&layer.scene, &other.scene);
    }
    scene.animation = other.animation.clone();
    scene
}
