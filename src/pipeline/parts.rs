//! Loose parts become layers.
//!
//! A layer whose drawings fall into several pieces -> a layer for each thing that they show ([`LayerParts`]).
//!
//! 1. Which pieces of the drawings are one thing is the business of [`parts`](crate::parts).
//! 2. Every thing is a layer with all the poses of the first one. A pose that lacks it has it shrunk to a point, from which it grows.
//! 3. Landmarks and handles go to the thing that they lie on.
//! 4. Things stand in the order in which they are painted; of bitmaps, in which nothing lies over anything, small ones in front of
//!    large ones and shadows behind all.
//!
//! The layer of the largest thing has the name, the role and the notes of the layer that was divided. A layer that hangs on another one
//! is not divided.

use std::sync::Arc;

use super::drawings::{mirror_axis, reflected};
use super::note::{LoosePartName, Note, NoteKind};
use super::spec::{
    CharacterSpec, DeformedCopy, DrawnPose, Facing, LayerRole, LayerSpec, PoseShape, PoseSpec, ShrunkCopy, SvgSource,
};
use crate::blend::Reference;
use crate::input::{Drawing, InputNote, LoosePart, PartOptions, PartRule, SvgOptions};
use crate::math::{Point, point};
use crate::outline::Outline;
use crate::parts::{PartGroups, PartShape, group, nearest_part, origin};

/// The layers that a layer falls into.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LayerParts {
    /// From back to front; one, the layer itself, if its drawings are of one piece.
    pub layers: Vec<LayerSpec>,
    /// Which of them is the largest.
    pub largest: usize,
    /// For each pose the layers from back to front.
    pub draw_orders: Vec<Vec<usize>>,
    /// For each pose the outlines of all that belongs to it, in drawing order, as they are used; empty if it is of one piece, and where
    /// the pose is no drawing.
    pub outlines: Vec<Vec<Outline>>,
    /// What the layers are, in a line, if there are several.
    pub note: Option<Note>,
}

impl CharacterSpec {
    /// The specification with loose parts of its drawings as layers of their own; a note for each layer that was divided says what they
    /// are.
    #[must_use]
    pub fn with_loose_parts(self) -> Self {
        let divided: Vec<LayerParts> = self.layers.iter().map(|layer| self.parts_of(layer)).collect();
        if divided.iter().all(|parts| parts.layers.len() == 1) {
            let layers = divided.into_iter().flat_map(|parts| parts.layers).collect();
            return Self { layers, ..self };
        }
        let firsts: Vec<usize> = divided
            .iter()
            .scan(0, |next, parts| {
                let first = *next;
                *next += parts.layers.len();
                Some(first)
            })
            .collect();
        let orders = self.draw_order_of_poses();
        let draw_orders = (orders.iter().zip(&self.space.poses))
            .map(|(order, pose)| {
                let of_layer = |&layer: &usize| {
                    let parts = &divided[layer];
                    let own = self.layers[layer].poses.iter().position(|own| own.name == *pose);
                    let order = own.and_then(|own| parts.draw_orders.get(own).cloned());
                    let order = order.unwrap_or_else(|| (0..parts.layers.len()).collect());
                    order.into_iter().map(|part| firsts[layer] + part).collect::<Vec<_>>()
                };
                order.iter().flat_map(of_layer).collect()
            })
            .collect();
        let found = divided.iter().filter_map(|parts| parts.note.clone());
        let notes = self.notes.iter().cloned().chain(found).collect();
        let largest: Vec<usize> = divided
            .iter()
            .zip(&firsts)
            .map(|(parts, first)| first + parts.largest)
            .collect();
        let mut layers: Vec<LayerSpec> = Vec::new();
        for mut layer in divided.into_iter().flat_map(|parts| parts.layers) {
            if let Some(attachment) = &mut layer.attachment {
                attachment.to = largest[attachment.to];
            }
            layers.push(layer);
        }
        Self {
            layers,
            draw_orders,
            notes,
            ..self
        }
    }

    fn parts_of(&self, layer: &LayerSpec) -> LayerParts {
        let others = self.layers.iter().filter(|other| other.name != layer.name);
        LayerParts::of(layer, &others.map(|other| other.name.as_str()).collect::<Vec<_>>())
    }
}

impl LayerParts {
    /// The layers that `layer` falls into; their names are none of `taken`.
    #[must_use]
    pub fn of(layer: &LayerSpec, taken: &[&str]) -> Self {
        let is_of_pieces = layer.drawn().any(|pose| !pose.drawing.parts.is_empty());
        if layer.attachment.is_some() || !is_of_pieces {
            return Self::whole(layer.clone());
        }
        let pieces = Pieces::of(layer);
        match pieces.groups.things.len() {
            0 => Self::whole(layer.clone()),
            1 => Self::whole(pieces.without_dust(layer)),
            _ => pieces.layers(layer, taken),
        }
    }

    fn whole(layer: LayerSpec) -> Self {
        Self {
            draw_orders: vec![vec![0]; layer.poses.len()],
            outlines: vec![Vec::new(); layer.poses.len()],
            layers: vec![layer],
            largest: 0,
            note: None,
        }
    }
}

/// The pieces of the drawings of a layer, and what they are.
struct Pieces<'a> {
    /// The drawn poses, by their places in the layer.
    poses: Vec<usize>,
    drawn: Vec<&'a DrawnPose>,
    /// Of each drawn pose, as its file has it, in drawing order.
    outlines: Vec<Vec<&'a Outline>>,
    shapes: Vec<Vec<PartShape>>,
    groups: PartGroups,
}

impl<'a> Pieces<'a> {
    fn of(layer: &'a LayerSpec) -> Self {
        let drawn: Vec<&DrawnPose> = layer.drawn().collect();
        let poses = layer.drawn_poses();
        let outlines: Vec<Vec<&Outline>> = drawn
            .iter()
            .map(|pose| match pose.drawing.parts.as_slice() {
                [] => vec![&pose.drawing.outline],
                parts => parts.iter().map(|part| &part.outline).collect(),
            })
            .collect();
        let mut shapes: Vec<Vec<PartShape>> = drawn
            .iter()
            .map(|pose| {
                let drawing = &pose.drawing;
                let shapes: Vec<PartShape> = match drawing.parts.as_slice() {
                    [] => vec![PartShape::of(&drawing.outline, &drawing.picture)],
                    parts => (parts.iter())
                        .map(|part| PartShape {
                            area: part.area,
                            ..PartShape::of(&part.outline, part.picture.as_ref().unwrap_or(&drawing.picture))
                        })
                        .collect(),
                };
                match pose.facing {
                    Facing::AsDrawn | Facing::Auto => shapes,
                    Facing::Mirrored => shapes.into_iter().map(|shape| shape.mirrored(axis(pose))).collect(),
                }
            })
            .collect();
        for (number, places) in marks(layer).enumerate() {
            for (drawing, &pose) in poses.iter().enumerate() {
                let part = places[pose].and_then(|place| nearest_part(outlines[drawing].iter().copied(), place));
                if let Some(part) = part {
                    shapes[drawing][part].landmarks.push(number);
                }
            }
        }
        let is_kept = |drawing: usize, part: usize| {
            let parts: &[LoosePart] = &drawn[drawing].drawing.parts;
            parts.get(part).is_some_and(|part| part.is_kept)
        };
        let groups = group(&shapes, &is_kept);
        Self {
            poses,
            drawn,
            outlines,
            shapes,
            groups,
        }
    }

    /// The thing that a part of a drawing is; what is dust counts as the largest.
    fn thing_of(&self, drawing: usize, part: usize) -> usize {
        let found = self.groups.things.iter().position(|thing| thing[drawing] == Some(part));
        found.unwrap_or(0)
    }

    /// The thing that a place of a drawing, as its file has it, lies on or is nearest to.
    fn thing_at(&self, drawing: usize, place: Point) -> usize {
        let part = nearest_part(self.outlines[drawing].iter().copied(), place);
        part.map_or(0, |part| self.thing_of(drawing, part))
    }

    /// The layer as it is, with loose parts that are no things called what they are.
    fn without_dust(&self, layer: &LayerSpec) -> LayerSpec {
        let mut layer = layer.clone();
        for (drawing, &pose) in self.poses.iter().enumerate() {
            let used = self.drawn[drawing].drawing.as_ref();
            if let PoseShape::Drawn(drawn) = &mut layer.poses[pose].shape {
                let parts = Vec::new();
                let notes = self.notes(drawing);
                drawn.drawing = Arc::new(Drawing {
                    notes,
                    parts,
                    ..used.clone()
                });
            }
        }
        layer
    }

    /// What is said of a drawing whose things are layers: what is left over are specks.
    fn notes(&self, drawing: usize) -> Vec<InputNote> {
        let (mut count, mut area) = (0, 0.0);
        let mut notes = Vec::new();
        for note in &self.drawn[drawing].drawing.notes {
            match note {
                InputNote::PartsLeftOut {
                    count: own, area: a, ..
                }
                | InputNote::SpecksLeftOut { count: own, area: a } => {
                    (count, area) = (count + own, area + a);
                }
                other => notes.push(other.clone()),
            }
        }
        // The largest piece was not among those that were left out.
        let shapes = &self.shapes[drawing];
        let largest = shapes.iter().map(|shape| shape.area).fold(0.0, f64::max);
        let used = self.groups.things.iter().filter_map(|thing| thing[drawing]);
        let (mut things, mut used_area) = (0_usize, 0.0);
        for part in used {
            (things, used_area) = (things + 1, used_area + shapes[part].area);
        }
        let count = (count + 1).saturating_sub(things);
        if count > 0 {
            let area = (area + largest - used_area).max(0.0);
            notes.push(InputNote::SpecksLeftOut { count, area });
        }
        notes
    }

    fn layers(&self, layer: &LayerSpec, taken: &[&str]) -> LayerParts {
        let order = self.drawing_order();
        let names = self.names(layer, taken);
        let layers: Vec<LayerSpec> = order
            .iter()
            .map(|&thing| self.layer(layer, thing, &names[thing]))
            .collect();
        let outlines = (0..layer.poses.len()).map(|pose| match self.poses.iter().position(|own| *own == pose) {
            Some(drawing) => self.used_outlines(drawing),
            None => Vec::new(),
        });
        let lacking = |thing: usize| {
            let poses = self.poses.iter().zip(&self.groups.things[thing]);
            let lacking = poses.filter(|(_, part)| part.is_none());
            lacking.map(|(pose, _)| layer.poses[*pose].name.clone()).collect()
        };
        let named = |&thing: &usize| LoosePartName {
            name: names[thing].clone(),
            lacking: lacking(thing),
        };
        LayerParts {
            largest: order.iter().position(|&thing| thing == 0).unwrap_or(0),
            draw_orders: self.draw_orders(layer, &order),
            outlines: outlines.collect(),
            note: Some(Note::on_all(NoteKind::LooseParts {
                parts: order.iter().map(named).collect(),
            })),
            layers,
        }
    }

    /// Things from back to front.
    fn drawing_order(&self) -> Vec<usize> {
        let things = &self.groups.things;
        let body = |drawing: usize| Some(&self.shapes[drawing][things[0][drawing]?]);
        let is_shadow = |thing: usize| {
            let mut shapes = (things[thing].iter().enumerate())
                .filter_map(|(drawing, part)| Some(self.shapes[drawing][(*part)?].is_shadow_of(body(drawing)?)))
                .peekable();
            thing > 0 && !self.is_painted_in_order() && shapes.peek().is_some() && shapes.all(|is_shadow| is_shadow)
        };
        let rank = |thing: usize| {
            let parts: Vec<usize> = things[thing].iter().flatten().copied().collect();
            parts.iter().sum::<usize>() as f64 / parts.len().max(1) as f64
        };
        let mut order: Vec<usize> = (0..things.len()).collect();
        order.sort_by(|&a, &b| {
            let front = |thing: usize| !is_shadow(thing);
            front(a).cmp(&front(b)).then(rank(a).total_cmp(&rank(b)))
        });
        order
    }

    /// Whether the order of the pieces says what is painted over what.
    fn is_painted_in_order(&self) -> bool {
        self.drawn.iter().all(|pose| pose.drawing.art.is_some())
    }

    /// For each pose the layers, which stand for the things of `order`, from back to front.
    fn draw_orders(&self, layer: &LayerSpec, order: &[usize]) -> Vec<Vec<usize>> {
        let usual: Vec<usize> = (0..order.len()).collect();
        let mut orders = vec![usual; layer.poses.len()];
        if !self.is_painted_in_order() {
            return orders;
        }
        for (drawing, &pose) in self.poses.iter().enumerate() {
            let part = |place: &usize| self.groups.things[order[*place]][drawing];
            let places: Vec<usize> = (0..order.len()).filter(|place| part(place).is_some()).collect();
            let mut own = places.clone();
            own.sort_by_key(|place| part(place));
            for (place, layer) in places.into_iter().zip(own) {
                orders[pose][place] = layer;
            }
        }
        orders
    }

    /// What the things are called: the first and largest as the layer is, the others as their elements are, or by their numbers.
    fn names(&self, layer: &LayerSpec, taken: &[&str]) -> Vec<String> {
        let mut names = vec![layer.name.clone()];
        for (number, thing) in self.groups.things.iter().enumerate().skip(1) {
            let parts = (thing.iter().zip(&self.drawn)).filter_map(|(part, pose)| pose.drawing.parts.get((*part)?));
            let ids = parts.filter_map(|part| {
                let elements = &part.art.as_ref()?.elements;
                elements.iter().find_map(|element| element.id.clone())
            });
            let is_free = |name: &String| !names.contains(name) && !taken.contains(&name.as_str());
            let numbered = std::iter::successors(Some(number + 1), |next| Some(next + 1)).map(|number| {
                if taken.is_empty() {
                    format!("part {number}")
                } else {
                    format!("{} part {number}", layer.name)
                }
            });
            // There are more numbers than names.
            let name = ids.chain(numbered).find(is_free).unwrap_or_default();
            names.push(name);
        }
        names
    }

    /// The outlines of all things of a drawing, in drawing order, reflected where the drawing is.
    fn used_outlines(&self, drawing: usize) -> Vec<Outline> {
        let pose = self.drawn[drawing];
        let mut parts: Vec<usize> = self.groups.things.iter().filter_map(|thing| thing[drawing]).collect();
        parts.sort_unstable();
        let outlines = parts.into_iter().map(|part| self.outlines[drawing][part]);
        match pose.facing {
            Facing::AsDrawn | Facing::Auto => outlines.cloned().collect(),
            // Rounding may leave no outline.
            Facing::Mirrored => outlines
                .filter_map(|outline| outline.map(|p| reflected(p, axis(pose))).ok())
                .collect(),
        }
    }

    /// The layer of one thing.
    fn layer(&self, layer: &LayerSpec, thing: usize, name: &str) -> LayerSpec {
        let mut own = layer.clone();
        name.clone_into(&mut own.name);
        own.role = if thing == 0 { layer.role } else { LayerRole::LoosePart };
        for (pose, spec) in own.poses.iter_mut().enumerate() {
            *spec = PoseSpec {
                name: spec.name.clone(),
                shape: self.shape(layer, thing, pose),
            };
        }
        let is_drawn = |pose: usize| matches!(own.poses[pose].shape, PoseShape::Drawn(_));
        own.reference = layer.reference.filter(|&pose| is_drawn(pose));
        if let Reference::Pose(pose) = own.blend.reference
            && matches!(own.poses[pose].shape, PoseShape::Shrunk(_))
        {
            own.blend.reference = Reference::Canonical;
        }
        let drawn: Vec<bool> = (0..own.poses.len()).map(is_drawn).collect();
        let marks: Vec<usize> = marks(layer).map(|places| self.thing_of_mark(&places)).collect();
        let (of_landmarks, of_paths) = marks.split_at(layer.landmarks.len());
        let of_thing = |things: &[usize]| (0..things.len()).filter(|&k| things[k] == thing).collect::<Vec<_>>();
        let mut own = own.with_landmarks(&of_thing(of_landmarks), &of_thing(of_paths));
        for landmark in &mut own.landmarks {
            for (at, _) in landmark.at.iter_mut().zip(&drawn).filter(|(_, is_drawn)| !**is_drawn) {
                *at = None;
            }
        }
        for path in &mut own.paths {
            for (at, _) in path.at.iter_mut().zip(&drawn).filter(|(_, is_drawn)| !**is_drawn) {
                *at = None;
            }
        }
        own.limbs.retain(|limb| self.thing_of_mark(&limb.at) == thing);
        for limb in &mut own.limbs {
            for (pose, _) in drawn.iter().enumerate().filter(|(_, is_drawn)| !**is_drawn) {
                (limb.at[pose], limb.cut[pose]) = (None, None);
            }
        }
        if thing > 0 {
            own.limb_orders = Vec::new();
        }
        own
    }

    /// The thing that a landmark lies on in all poses that have it; the largest if that differs.
    fn thing_of_mark(&self, places: &[Option<Point>]) -> usize {
        let mut things =
            (self.poses.iter().enumerate()).filter_map(|(drawing, &pose)| Some(self.thing_at(drawing, places[pose]?)));
        match things.next() {
            Some(first) if things.all(|thing| thing == first) => first,
            _ => 0,
        }
    }

    /// A thing in a pose of the layer.
    fn shape(&self, layer: &LayerSpec, thing: usize, pose: usize) -> PoseShape {
        let root = layer.drawing_of(pose).map(|(root, _)| root);
        let drawing = root.and_then(|root| self.poses.iter().position(|own| *own == root));
        let Some(drawing) = drawing else {
            // No valid layer has such a pose, and checking says so.
            return layer.poses[pose].shape.clone();
        };
        let Some(part) = self.groups.things[thing][drawing] else {
            let grows = origin(&self.groups, &self.shapes, thing, drawing);
            return grows.map_or(layer.poses[pose].shape.clone(), |origin| {
                PoseShape::Shrunk(ShrunkCopy {
                    of: self.poses[origin.of],
                    to: origin.place,
                })
            });
        };
        match &layer.poses[pose].shape {
            PoseShape::Deformed(copy) => {
                let is_own = |from: Point| self.thing_at(drawing, from) == thing;
                let own = copy.handles.iter().filter(|handle| is_own(handle.from));
                PoseShape::Deformed(DeformedCopy {
                    of: copy.of,
                    handles: own.cloned().collect(),
                })
            }
            PoseShape::Shrunk(copy) => PoseShape::Shrunk(*copy),
            PoseShape::Drawn(_) => PoseShape::Drawn(self.drawn_part(thing, drawing, part)),
        }
    }

    /// A part of a drawing as a drawing.
    fn drawn_part(&self, thing: usize, drawing: usize, part: usize) -> DrawnPose {
        let pose = self.drawn[drawing];
        let whole = &pose.drawing;
        let notes = if thing == 0 { self.notes(drawing) } else { Vec::new() };
        let Some(own) = whole.parts.get(part) else {
            // A drawing of one piece.
            return pose.clone();
        };
        let bounds = point::bounding_box(own.outline.outer().points());
        let svg = pose.svg.as_ref().map(|svg| {
            Arc::new(SvgSource {
                bytes: Arc::clone(&svg.bytes),
                options: SvgOptions {
                    around: bounds.map(|(low, high)| [low, high]),
                    parts: PartOptions {
                        rule: PartRule::Largest,
                        ..PartOptions::default()
                    },
                    ..svg.options.clone()
                },
            })
        });
        let drawing = Drawing {
            outline: own.outline.clone(),
            picture: own.picture.clone().unwrap_or_else(|| whole.picture.clone()),
            art: own.art.clone(),
            notes,
            unit_px: whole.unit_px,
            canvas: whole.canvas,
            parts: Vec::new(),
        };
        DrawnPose {
            drawing: Arc::new(drawing),
            svg,
            axis: (pose.facing == Facing::Mirrored).then(|| axis(pose)),
            ..pose.clone()
        }
    }
}

/// Where each landmark, and then each line by its first point, lies on each pose of the layer.
fn marks(layer: &LayerSpec) -> impl Iterator<Item = Vec<Option<Point>>> + '_ {
    let points = layer.landmarks.iter().map(|landmark| landmark.at.clone());
    let first = |line: &Option<Vec<Point>>| line.as_ref().and_then(|line| line.first().copied());
    points.chain(layer.paths.iter().map(move |path| path.at.iter().map(first).collect()))
}

/// Twice the x of the line about which a whole drawing is reflected.
fn axis(pose: &DrawnPose) -> f64 {
    pose.axis.unwrap_or_else(|| mirror_axis(&pose.drawing.outline))
}
