//! Layers: parts of a character that lie in front of one another, each an N-way shape of its own.

use super::settings::Scene;
use crate::blend::Reference;
use crate::math::Point;
use crate::scene::PoseSource;

/// A part of the character with drawings of its own: an arm, the body behind it.
///
/// All layers share the scene's pose space. A pose may lack some of them.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneLayer {
    /// Its name.
    pub name: String,
    /// The poses of the scene that have it, at least one, in order.
    pub poses: Vec<usize>,
    /// The layer alone: these poses with this layer's drawings, landmarks and settings. It has no layers itself.
    pub scene: Scene,
    /// What it hangs on.
    pub anchor: Option<LayerAnchor>,
}

/// A point at which a layer hangs on another one: there, both stay together.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerAnchor {
    /// The other layer. Following these leads to a layer without an anchor.
    pub to: usize,
    /// The landmark, one of the layer's own.
    pub landmark: String,
    /// The point on each of the layer's poses, in source units of both; `None` on deformed copies, where the mesh carries it.
    pub at: Vec<Option<Point>>,
}

impl Scene {
    /// A layer as a scene without layers; of a scene without any, itself.
    #[must_use]
    pub fn of_layer(&self, layer: usize) -> &Self {
        self.layers.get(layer).map_or(self, |layer| &layer.scene)
    }

    /// For each pose the one whose drawing it shows: itself, or the pose that it is a deformed copy of in the end.
    #[must_use]
    pub fn originals(&self) -> Vec<usize> {
        let original = |pose: usize| {
            let mut own = self.drawing_of(pose).map(|(original, _)| original);
            for layer in &self.layers {
                let here = layer.poses.iter().position(|&p| p == pose);
                own = own.or_else(|| here.map(|here| layer.poses[layer.scene.originals()[here]]));
            }
            own.unwrap_or(pose)
        };
        (0..self.poses.len()).map(original).collect()
    }

    /// For each pose of a scene without layers the drawing that it shows, by its place among [`Scene::drawn_poses`].
    #[must_use]
    pub fn shown_drawings(&self) -> Vec<usize> {
        let drawn = self.drawn_poses();
        let drawing = |original: usize| drawn.iter().position(|&pose| pose == original).unwrap_or(0);
        self.originals().into_iter().map(drawing).collect()
    }

    /// The layer of this name.
    #[must_use]
    pub fn layer(&self, name: &str) -> Option<&SceneLayer> {
        self.layers.iter().find(|layer| layer.name == name)
    }

    /// The scene with only the poses `kept`, by index, in this order; copies whose original is left out are copies no more, and
    /// must be left out, too.
    #[must_use]
    pub(super) fn with_poses(&self, kept: &[usize]) -> Self {
        let place = |index: usize| kept.iter().position(|&k| k == index);
        let mut scene = self.clone();
        scene.poses = kept.iter().map(|&k| self.poses[k].clone()).collect();
        for pose in &mut scene.poses {
            if let PoseSource::Deformed(copy) = &mut pose.source {
                copy.copy.of = place(copy.copy.of).unwrap_or(usize::MAX);
            }
        }
        scene.reference = self.reference.and_then(place);
        if let Reference::Pose(pose) = scene.blend.reference {
            scene.blend.reference = place(pose).map_or(Reference::Canonical, Reference::Pose);
        }
        for (landmark, whole) in scene.landmarks.iter_mut().zip(&self.landmarks) {
            landmark.at = kept.iter().map(|&k| whole.at[k]).collect();
        }
        for (path, whole) in scene.paths.iter_mut().zip(&self.paths) {
            path.at = kept.iter().map(|&k| whole.at[k].clone()).collect();
        }
        for (limb, whole) in scene.limbs.iter_mut().zip(&self.limbs) {
            limb.at = kept.iter().map(|&k| whole.at[k]).collect();
            limb.cut = kept.iter().map(|&k| whole.cut[k].clone()).collect();
        }
        scene
    }

    /// The scene with only the landmarks, lines and limbs of layer `layer`, and what of its anchors and regions names them.
    #[must_use]
    pub(super) fn with_landmarks_of(&self, layer: usize) -> Self {
        let kept: Vec<usize> = (0..self.landmarks.len())
            .filter(|&k| self.landmarks[k].layer == Some(layer))
            .collect();
        let mut scene = self.clone();
        scene.landmarks = kept.iter().map(|&k| self.landmarks[k].clone()).collect();
        scene.paths.retain(|path| path.layer == Some(layer));
        scene.limbs.retain(|limb| limb.layer == Some(layer));
        scene.blend = (self.blend).with_points_left(|index| kept.iter().position(|&k| k == index));
        scene
    }
}

/// How messages begin that are about a layer.
pub(super) fn prefix(layer: Option<&str>) -> String {
    layer.map(|layer| format!("layer '{layer}': ")).unwrap_or_default()
}
