//! Which drawings face the other way.

use std::sync::Arc;

use super::drawn::{looks_reflected, residual};
use super::spec::{CharacterSpec, DrawnPose, Facing, LayerSpec, PoseShape};
use crate::appearance::Appearance;
use crate::input::Drawing;
use crate::matching::{MatchOptions, match_rings};

impl CharacterSpec {
    /// The specification with every [`Facing::Auto`] settled: a drawing is reflected where its reflection shows clearly more of the layer's reference than it
    /// does itself. Where nothing is drawn inside, the outlines decide. A pose has one facing in all of its layers, that which its largest
    /// drawing says.
    ///
    /// The reference is the one that the layer names, or else its first pose whose facing is known; if there is none, the first, as it is drawn.
    #[must_use]
    pub fn with_facings(mut self) -> Self {
        for pose in self.space.poses.clone() {
            let area = |layer: &LayerSpec| open(layer, &pose).map_or(0.0, |drawn| drawn.drawing.outline.area());
            let has_it = self.layers.iter().filter(|layer| open(layer, &pose).is_some());
            let Some(layer) = has_it.max_by(|a, b| area(a).total_cmp(&area(b))) else {
                continue;
            };
            let facing = facing(layer, &pose);
            for shape in self.layers.iter_mut().flat_map(|layer| &mut layer.poses) {
                if let PoseShape::Drawn(drawn) = &mut shape.shape
                    && shape.name == pose
                    && drawn.facing == Facing::Auto
                {
                    drawn.facing = facing;
                }
            }
        }
        self
    }
}

/// The drawing of a pose whose facing is not settled.
fn open<'a>(layer: &'a LayerSpec, pose: &str) -> Option<&'a DrawnPose> {
    layer.poses.iter().find_map(|own| match &own.shape {
        PoseShape::Drawn(drawn) if own.name == pose && drawn.facing == Facing::Auto => Some(drawn),
        _ => None,
    })
}

/// How a pose of a layer faces beside the layer's reference.
fn facing(layer: &LayerSpec, pose: &str) -> Facing {
    let named = layer
        .reference
        .and_then(|reference| match &layer.poses[reference].shape {
            PoseShape::Drawn(drawn) => Some(drawn),
            PoseShape::Deformed(_) | PoseShape::Shrunk(_) => None,
        });
    let is_settled = |drawn: &&DrawnPose| drawn.facing != Facing::Auto;
    let reference = named.filter(is_settled).or_else(|| layer.drawn().find(is_settled));
    let (Some(reference), Some(drawn)) = (reference, open(layer, pose)) else {
        return Facing::AsDrawn;
    };
    match reference.as_used() {
        Ok(reference) if faces_away(&reference, &drawn.drawing) => Facing::Mirrored,
        // What cannot be reflected stays as it is.
        _ => Facing::AsDrawn,
    }
}

/// Whether a drawing shows more of the reference when it is reflected.
fn faces_away(reference: &Drawing, drawing: &Drawing) -> bool {
    let shown = Arc::new(Appearance::new(reference));
    let own = Arc::new(Appearance::new(drawing));
    let rings = [reference.outline.outer().clone(), drawing.outline.outer().clone()];
    if !shown.is_drawn() || !own.is_drawn() {
        let options = MatchOptions {
            reference: Some(0),
            ..MatchOptions::default()
        };
        return match_rings(&rings, &[], &options).is_ok_and(|matched| matched.report.poses[1].looks_mirrored);
    }
    residual(&rings, [&shown, &own]).is_some_and(|residual| looks_reflected(residual, drawing, &rings[0], &shown))
}
