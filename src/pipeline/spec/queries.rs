//! What follows from a specification alone.

use std::sync::Arc;

use super::{CharacterSpec, DrawnPose, LayerSpec, PoseShape};
use crate::blend::Reference;

impl CharacterSpec {
    /// The places of a layer's poses in the pose space; poses that the space lacks are left out.
    #[must_use]
    pub fn poses_of(&self, layer: &LayerSpec) -> Vec<usize> {
        let place = |name: &String| self.space.poses.iter().position(|own| own == name);
        layer.poses.iter().filter_map(|pose| place(&pose.name)).collect()
    }

    /// For each pose of the space the one whose drawing it shows: itself, or the pose that it is a deformed copy of in the end.
    #[must_use]
    pub fn originals(&self) -> Vec<usize> {
        let poses: Vec<Vec<usize>> = self.layers.iter().map(|layer| self.poses_of(layer)).collect();
        let original = |pose: usize| {
            let in_layer = |(layer, poses): (&LayerSpec, &Vec<usize>)| {
                let here = poses.iter().position(|&p| p == pose)?;
                // What vanishes in a pose does not say whose drawing is seen there.
                if matches!(layer.poses[here].shape, PoseShape::Shrunk(_)) {
                    return None;
                }
                poses.get(layer.originals()[here]).copied()
            };
            self.layers.iter().zip(&poses).find_map(in_layer).unwrap_or(pose)
        };
        (0..self.space.poses.len()).map(original).collect()
    }

    /// For each pose of the space the layers from back to front.
    #[must_use]
    pub fn draw_order_of_poses(&self) -> Vec<Vec<usize>> {
        if self.draw_orders.is_empty() {
            return vec![(0..self.layers.len()).collect(); self.space.poses.len()];
        }
        self.draw_orders.clone()
    }
}

impl LayerSpec {
    /// The names of its poses, in order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.poses.iter().map(|pose| pose.name.clone()).collect()
    }

    /// The poses that have a drawing of their own, in order.
    #[must_use]
    pub fn drawn_poses(&self) -> Vec<usize> {
        let is_drawn = |pose: &usize| matches!(self.poses[*pose].shape, PoseShape::Drawn(_));
        (0..self.poses.len()).filter(is_drawn).collect()
    }

    /// The drawn poses themselves, in order.
    pub fn drawn(&self) -> impl Iterator<Item = &DrawnPose> {
        self.poses.iter().filter_map(|pose| match &pose.shape {
            PoseShape::Drawn(drawn) => Some(drawn),
            PoseShape::Deformed(_) | PoseShape::Shrunk(_) => None,
        })
    }

    /// The pose whose drawing pose `index` shows, and that drawing: itself, or the one that it is a copy of in the end.
    ///
    /// `None` for a pose that does not exist or is a copy of itself, which no valid specification has.
    #[must_use]
    pub fn drawing_of(&self, index: usize) -> Option<(usize, &DrawnPose)> {
        let mut at = index;
        for _ in 0..=self.poses.len() {
            match &self.poses.get(at)?.shape {
                PoseShape::Drawn(drawing) => return Some((at, drawing)),
                PoseShape::Deformed(copy) => at = copy.of,
                PoseShape::Shrunk(copy) => at = copy.of,
            }
        }
        None
    }

    /// For each pose the one whose drawing it shows.
    #[must_use]
    pub fn originals(&self) -> Vec<usize> {
        let original = |pose: usize| self.drawing_of(pose).map_or(pose, |(original, _)| original);
        (0..self.poses.len()).map(original).collect()
    }

    /// For each pose the drawing that it shows, by its place among [`Self::drawn_poses`].
    #[must_use]
    pub fn shown_drawings(&self) -> Vec<usize> {
        let drawn = self.drawn_poses();
        let drawing = |original: usize| drawn.iter().position(|&pose| pose == original).unwrap_or(0);
        self.originals().into_iter().map(drawing).collect()
    }

    /// The layer without its deformed copies: what is matched. Drawings are shared, not copied.
    #[must_use]
    pub(in crate::pipeline) fn only_drawn(&self) -> Self {
        self.only(&self.drawn_poses())
    }

    /// The layer with the drawn poses `kept` alone. Drawings are shared, not copied.
    #[must_use]
    pub(in crate::pipeline) fn only(&self, kept: &[usize]) -> Self {
        let place = |index: usize| kept.iter().position(|&k| k == index);
        let mut layer = self.clone();
        layer.poses = kept.iter().map(|&k| self.poses[k].clone()).collect();
        layer.reference = self.reference.and_then(place);
        if let Reference::Pose(pose) = layer.blend.reference {
            layer.blend.reference = place(pose).map_or(Reference::Canonical, Reference::Pose);
        }
        for (landmark, whole) in layer.landmarks.iter_mut().zip(&self.landmarks) {
            landmark.at = kept.iter().map(|&k| whole.at[k]).collect();
        }
        for (path, whole) in layer.paths.iter_mut().zip(&self.paths) {
            path.at = kept.iter().map(|&k| whole.at[k].clone()).collect();
        }
        for (limb, whole) in layer.limbs.iter_mut().zip(&self.limbs) {
            limb.at = kept.iter().map(|&k| whole.at[k]).collect();
            limb.cut = kept.iter().map(|&k| whole.cut[k].clone()).collect();
        }
        let order = |&k: &usize| self.limb_orders.get(k).cloned();
        layer.limb_orders = kept.iter().filter_map(order).collect();
        layer
    }

    /// The layer with what is marked in the drawn poses `kept` alone, in all poses; what is marked in none of these is gone.
    #[must_use]
    pub(in crate::pipeline) fn marked_only_in(&self, kept: &[usize]) -> Self {
        let mut layer = self.clone();
        for pose in (0..self.poses.len()).filter(|pose| !kept.contains(pose)) {
            for landmark in &mut layer.landmarks {
                landmark.at[pose] = None;
            }
            for path in &mut layer.paths {
                path.at[pose] = None;
            }
        }
        layer.without_empty_marks()
    }

    /// The layer without anything said of its limbs.
    #[must_use]
    pub(in crate::pipeline) fn without_limbs(mut self) -> Self {
        self.limbs = Vec::new();
        self.limb_orders = Vec::new();
        self
    }

    /// Whether something is said of limbs.
    #[must_use]
    pub(in crate::pipeline) fn has_limbs(&self) -> bool {
        !self.limbs.is_empty() || self.limb_orders.iter().any(|order| !order.is_empty())
    }

    /// The layer without landmarks and lines that no pose has.
    #[must_use]
    pub(in crate::pipeline) fn without_empty_marks(self) -> Self {
        let landmarks: Vec<usize> = (0..self.landmarks.len())
            .filter(|k| self.landmarks[*k].at.iter().any(Option::is_some))
            .collect();
        let paths: Vec<usize> = (0..self.paths.len())
            .filter(|k| self.paths[*k].at.iter().any(Option::is_some))
            .collect();
        self.with_landmarks(&landmarks, &paths)
    }

    /// For each pose whether it lacks the layer, which is shrunk to a point there.
    #[must_use]
    pub fn vanishing(&self) -> Vec<bool> {
        let shapes = self.poses.iter().map(|pose| &pose.shape);
        shapes.map(|shape| matches!(shape, PoseShape::Shrunk(_))).collect()
    }

    /// The layer with only the landmarks `kept`, by index, in this order, and the lines `paths`; anchors and regions that are left
    /// without their landmark go with it.
    #[must_use]
    pub(in crate::pipeline) fn with_landmarks(mut self, kept: &[usize], paths: &[usize]) -> Self {
        self.landmarks = kept.iter().map(|&k| self.landmarks[k].clone()).collect();
        self.paths = paths.iter().map(|&k| self.paths[k].clone()).collect();
        self.blend = (self.blend).with_points_left(|index| kept.iter().position(|&k| k == index));
        self
    }

    /// Whether both have the same drawings, used in the same way.
    #[must_use]
    pub(in crate::pipeline) fn has_drawings_of(&self, other: &Self) -> bool {
        self.drawn().eq(other.drawn())
    }
}

impl From<DrawnPose> for PoseShape {
    fn from(drawn: DrawnPose) -> Self {
        Self::Drawn(drawn)
    }
}

impl From<crate::input::Drawing> for DrawnPose {
    fn from(drawing: crate::input::Drawing) -> Self {
        Self::new(Arc::new(drawing))
    }
}
