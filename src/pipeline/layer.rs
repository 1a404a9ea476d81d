//! One layer of a character: a shape of its own, and where it hangs.
//!
//! A layer is mapped and blended as if it were alone, with the weights of the poses that have it ([`restricted_weights`]). One that is
//! anchored is then moved as a whole, so that its point comes to lie on the other layer's, each where its own mesh carries it.
//! Poses that lack a layer fade it out, by what their drawings count in the frame.

use super::blending::blend_options;
use super::note::{Note, NoteKind};
use super::spec::{CharacterSpec, LandmarkSpec, LayerRole, LayerSpec};
use super::{PipelineError, ShapePoint};
use crate::blend::{BlendOptions, BlendReport, RigidBlend};
use crate::math::{Point, restricted_weights};
use crate::mesh::PointLocator;
use crate::pose::Mapping;
use crate::render::Silhouette;
use crate::texture::{TextureError, shared_texture_weights};

/// A layer of a specification, with what it has of the others.
pub(super) struct Part<'a> {
    pub(super) layer: &'a LayerSpec,
    /// The poses of the space that have it.
    pub(super) poses: Vec<usize>,
    /// Its name in remarks; the only layer of a character needs none.
    named: Option<&'a str>,
}

/// The layers of a valid specification, back to front.
pub(super) fn parts(spec: &CharacterSpec) -> Vec<Part<'_>> {
    let is_one_of_several = spec.layers.len() > 1;
    let part = |layer| Part {
        layer,
        poses: spec.poses_of(layer),
        named: is_one_of_several.then_some(layer.name.as_str()),
    };
    spec.layers.iter().map(part).collect()
}

impl Part<'_> {
    /// A remark on this layer.
    pub(super) fn named(&self, note: Note) -> Note {
        Note {
            layer: self.named.map(str::to_owned),
            ..note
        }
    }

    pub(super) fn refusal(&self, error: PipelineError) -> PipelineError {
        match self.named {
            Some(name) => PipelineError::Layer {
                layer: name.to_owned(),
                source: Box::new(error),
            },
            None => error,
        }
    }

    /// The layer's shape, not yet hung on another one.
    pub(super) fn shape(&self, mapping: Mapping, notes: &mut Vec<Note>) -> Result<LayerShape, PipelineError> {
        let options = blend_options(self.layer, &mapping);
        let (blend, silhouette) = rayon::join(
            || RigidBlend::new(&mapping.poses, &options),
            || Silhouette::new(&mapping),
        );
        let blend = blend.map_err(|error| self.refusal(error.into()))?;
        self.note_turns(&blend, notes);
        Ok(LayerShape {
            name: self.layer.name.clone(),
            poses: self.poses.clone(),
            originals: self.layer.originals(),
            vanishing: self.layer.vanishing(),
            silhouette,
            mapping,
            options,
            blend,
            tie: None,
        })
    }

    /// The layer's shape, not yet hung on another one, from `before`, which has the same mapping.
    pub(super) fn shape_again(&self, before: &LayerShape, notes: &mut Vec<Note>) -> Result<LayerShape, PipelineError> {
        let mut shape = LayerShape {
            tie: None,
            ..before.clone()
        };
        let options = blend_options(self.layer, &shape.mapping);
        if options != shape.options {
            shape.blend =
                RigidBlend::new(&shape.mapping.poses, &options).map_err(|error| self.refusal(error.into()))?;
            shape.options = options;
        }
        self.note_turns(&shape.blend, notes);
        Ok(shape)
    }

    fn note_turns(&self, blend: &RigidBlend, notes: &mut Vec<Note>) {
        if blend.turns_are_ambiguous() && self.layer.role == LayerRole::Body {
            notes.push(self.named(Note::on_all(NoteKind::TurnsAmbiguous)));
        }
    }
}

/// Hangs the layers on one another where the specification says so; `shapes` has one a part.
pub(super) fn tie(parts: &[Part<'_>], shapes: &mut [LayerShape]) -> Result<(), PipelineError> {
    for (k, part) in parts.iter().enumerate() {
        let Some(attachment) = part.layer.attachment else {
            continue;
        };
        let own = &shapes[k];
        let other = &shapes[attachment.to];
        let landmark = &part.layer.landmarks[attachment.landmark];
        let among: Option<Vec<usize>> = own
            .poses
            .iter()
            .map(|pose| other.poses.iter().position(|p| p == pose))
            .collect();
        let tie = among.and_then(|others| {
            Some(Tie {
                to: attachment.to,
                own: shape_point(part.layer, landmark, own, &(0..own.poses.len()).collect::<Vec<_>>())?,
                other: shape_point(part.layer, landmark, other, &others)?,
            })
        });
        let refusal = || {
            let problem = format!("it cannot be anchored at landmark '{}'", landmark.name);
            part.refusal(PipelineError::stage(&[], None, problem))
        };
        shapes[k].tie = Some(tie.ok_or_else(refusal)?);
    }
    Ok(())
}

/// The landmark as a point of `shape`, for each pose of the attached layer; `poses` are these poses in `shape`. On deformed
/// copies the mesh carries it from their original.
fn shape_point(layer: &LayerSpec, landmark: &LandmarkSpec, shape: &LayerShape, poses: &[usize]) -> Option<ShapePoint> {
    let triangles = shape.mapping.poses.topology().triangles();
    let positions = shape.mapping.poses.positions();
    let mut anchors = Vec::new();
    for pose in 0..poses.len() {
        let (original, drawn) = layer.drawing_of(pose)?;
        let place = drawn.used_place(landmark.at[original]?);
        anchors.push(PointLocator::new(triangles, &positions[poses[original]]).bind(place)?);
    }
    Some(ShapePoint::from_anchors(anchors))
}

/// The shape of one layer, with everything that is computed once.
#[derive(Debug, Clone)]
pub struct LayerShape {
    name: String,
    poses: Vec<usize>,
    /// For each of its poses, the one whose drawing it shows.
    originals: Vec<usize>,
    /// For each of its poses, whether it is nothing there but the place where it grows from.
    vanishing: Vec<bool>,
    pub(super) silhouette: Silhouette,
    mapping: Mapping,
    options: BlendOptions,
    blend: RigidBlend,
    pub(super) tie: Option<Tie>,
}

/// Where a layer hangs on another one: a point of both, in the poses of the layer that hangs.
#[derive(Debug, Clone)]
pub(super) struct Tie {
    pub(super) to: usize,
    pub(super) own: ShapePoint,
    pub(super) other: ShapePoint,
}

/// A layer in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct PosedLayer {
    /// #vertices positions, in source units.
    pub positions: Vec<Point>,
    /// The weights of its poses; sum 1.
    pub weights: Vec<f64>,
    /// How much of each pose's drawing is seen; sum 1.
    pub texture_weights: Vec<f64>,
    /// How much of the layer is seen, from 0 to 1: 1 unless poses that count lack it.
    pub opacity: f64,
    /// What there is to say about its shape.
    pub report: BlendReport,
}

impl LayerShape {
    /// The layer's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The poses of the space that have the layer.
    #[must_use]
    pub fn poses(&self) -> &[usize] {
        &self.poses
    }

    /// Its mapping; it has the layer's poses.
    #[must_use]
    pub fn mapping(&self) -> &Mapping {
        &self.mapping
    }

    /// The factorised blend of its poses.
    #[must_use]
    pub fn blend(&self) -> &RigidBlend {
        &self.blend
    }

    /// The weights of its own poses where the space's count with `weights`, which sum to 1.
    #[must_use]
    pub fn own_weights(&self, weights: &[f64]) -> Vec<f64> {
        let is_present: Vec<bool> = (0..weights.len()).map(|pose| self.poses.contains(&pose)).collect();
        let shared = restricted_weights(weights, &is_present);
        self.poses
            .iter()
            .filter_map(|&pose| shared.get(pose).copied())
            .collect()
    }

    /// How its poses are blended.
    #[must_use]
    pub fn options(&self) -> &BlendOptions {
        &self.options
    }

    /// The layer that it hangs on.
    pub(super) fn hangs_on(&self) -> Option<usize> {
        self.tie.as_ref().map(|tie| tie.to)
    }

    /// The layer where the space's poses count with `weights` and their drawings with `shown`, not yet hung on another one.
    pub(super) fn posed(&self, weights: &[f64], shown: &[f64], sharpness: f64) -> Result<PosedLayer, PipelineError> {
        let own = self.own_weights(weights);
        let mut positions = Vec::new();
        let report = self.blend.blend(&own, &mut self.blend.scratch(), &mut positions)?;
        let (texture_weights, seen) = self.seen(&own, shown, sharpness)?;
        let opacity = seen * self.grown(&own);
        Ok(PosedLayer {
            positions,
            weights: own,
            texture_weights,
            opacity,
            report,
        })
    }

    /// How much of it is seen where it grows from a point: all but at the very beginning.
    fn grown(&self, own: &[f64]) -> f64 {
        /// The size, relative to its own, from which on it is seen in full.
        const SEEN: f64 = 0.06;
        if !self.vanishing.contains(&true) {
            return 1.0;
        }
        let vanished = own.iter().zip(&self.vanishing).filter(|(_, vanishing)| **vanishing);
        let size = 1.0 - vanished.map(|(weight, _)| weight).sum::<f64>();
        (size / SEEN).clamp(0.0, 1.0)
    }

    fn seen(&self, own: &[f64], shown: &[f64], sharpness: f64) -> Result<(Vec<f64>, f64), TextureError> {
        if own.len() == shown.len() {
            return Ok((shown.to_vec(), 1.0));
        }
        let opacity: f64 = self.poses.iter().filter_map(|&pose| shown.get(pose)).sum();
        let own = shared_texture_weights(own, &self.originals, sharpness)?;
        Ok((own, opacity.clamp(0.0, 1.0)))
    }

    /// By how much the layer, posed as `own`, must be moved to hang where it belongs on `other`.
    pub(super) fn gap(&self, own: &PosedLayer, other: &PosedLayer) -> Point {
        self.tie.as_ref().map_or_else(Point::zeros, |tie| {
            tie.other.at(&other.positions, &own.weights) - tie.own.at(&own.positions, &own.weights)
        })
    }
}
