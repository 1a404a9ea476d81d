//! The scene file of separated parts: the old one's text, put into layers.

use anyhow::{Context as _, bail};
use inbetween::math::Point;
use inbetween::scene::{Scene, Separated, SeparatedLandmark, SeparatedLayer};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value};

use crate::tables::{name_of, number_of, push_table, tables, tables_of};

/// What of a pose says how its drawing is read, and in which order its limbs lie; of the pictures that are written nothing is left to be said.
const OF_DRAWING: [&str; 11] = [
    "element",
    "figure",
    "gap",
    "paper",
    "threshold",
    "keep",
    "drop",
    "frame",
    "cell",
    "source",
    "order",
];

/// Puts the scene into layers, whose drawings are in the `sources` of its poses.
pub(super) fn edit(
    document: &mut DocumentMut,
    scene: &Scene,
    separated: &Separated,
    sources: Vec<InlineTable>,
) -> anyhow::Result<()> {
    let mut layers = ArrayOfTables::new();
    for layer in &separated.layers {
        let mut table = Table::new();
        table.insert("name", layer.name.as_str().into());
        if let Some(anchor) = &layer.anchor {
            let mut to = InlineTable::new();
            to.insert("layer", separated.layers[anchor.to].name.as_str().into());
            to.insert("at", anchor.landmark.as_str().into());
            table.insert("anchor", Item::Value(Value::InlineTable(to)));
        }
        layers.push(table);
    }
    document.insert("layer", Item::ArrayOfTables(layers));
    // The limbs that they name are layers.
    document.remove("part");
    edit_input(document, separated)?;
    keep_frames(document, scene, separated);
    let grids = Grids { scene, separated };
    let poses = tables(document, "pose");
    if poses.len() != sources.len() {
        bail!("the scene has no list of [[pose]] tables");
    }
    for (index, (pose, source)) in poses.into_iter().zip(sources).enumerate() {
        for key in OF_DRAWING {
            pose.remove(key);
        }
        if !pose.contains_key("deform_of") {
            pose.insert("source", Item::Value(Value::InlineTable(source)));
        }
        let place: Array = scene.poses[index].at.iter().copied().collect();
        pose.insert("at", Item::Value(Value::Array(place)));
        let order = &separated.draw_orders[index];
        if !order.is_sorted() {
            let names = order.iter().map(|&layer| &separated.layers[layer]);
            let own = names.filter(|layer| layer.drawings[index].is_some());
            let names: Array = own.map(|layer| layer.name.as_str()).collect();
            pose.insert("order", Item::Value(Value::Array(names)));
        }
        if let Some(handles) = pose.get_mut("handles") {
            name_handles(handles, index, separated);
            for handle in tables_of(handles) {
                for key in ["from", "to"] {
                    handle
                        .get_mut(key)
                        .into_iter()
                        .for_each(|place| grids.count_in_pixels(index, place));
                }
            }
        }
    }
    if let Some(landmarks) = document.get_mut("landmark") {
        leave_out(landmarks, &separated.divided_lines);
    }
    for landmark in tables(document, "landmark") {
        let name = name_of(landmark).unwrap_or_default();
        let Some(layer) = separated
            .layers
            .iter()
            .find(|layer| layer.landmarks.iter().any(|own| own == name))
        else {
            continue;
        };
        landmark.insert("layer", layer.name.as_str().into());
        let Some(places) = landmark.get_mut("at").and_then(Item::as_table_like_mut) else {
            continue;
        };
        for (pose, drawing) in scene.poses.iter().zip(&layer.drawings) {
            if drawing.is_none() {
                places.remove(&pose.name);
            }
        }
        for (index, pose) in scene.poses.iter().enumerate() {
            (places.get_mut(&pose.name).into_iter()).for_each(|place| grids.count_in_pixels(index, place));
        }
    }
    for layer in &separated.layers {
        for landmark in &layer.added {
            add_landmark(document, layer, landmark, &grids)?;
        }
    }
    Ok(())
}

/// Takes the lines out that lie on no layer.
fn leave_out(landmarks: &mut Item, names: &[String]) {
    let is_left_out = |name: Option<&str>| name.is_some_and(|name| names.iter().any(|line| line == name));
    match landmarks {
        Item::ArrayOfTables(tables) => tables.retain(|table| !is_left_out(name_of(table))),
        Item::Value(Value::Array(values)) => values.retain(|value| {
            let table = value.as_inline_table();
            !is_left_out(table.and_then(|table| table.get("name")).and_then(Value::as_str))
        }),
        _ => (),
    }
}

/// Frames on the canvas of drawings whose pixels were counted anew stay as large as they were.
fn keep_frames(document: &mut DocumentMut, scene: &Scene, separated: &Separated) {
    if separated.grids.iter().all(Option::is_none) {
        return;
    }
    let animation = document.entry("animation").or_insert(Item::Table(Table::new()));
    if let Some(animation) = animation
        .as_table_like_mut()
        .filter(|table| !table.contains_key("size"))
    {
        let size: Array = scene.animation.size.iter().map(|side| i64::from(*side)).collect();
        animation.insert("size", Item::Value(Value::Array(size)));
    }
}

/// The pixels that vector drawings are written in.
struct Grids<'a> {
    scene: &'a Scene,
    separated: &'a Separated,
}

impl Grids<'_> {
    /// A place of a pose in the coordinates of what is written for it.
    fn place(&self, pose: usize, place: Point) -> Point {
        // A copy's places are those of the drawing that it shows.
        let shown = self.scene.drawing_of(pose).map_or(pose, |(root, _)| root);
        self.separated.grids[shown].map_or(place, |grid| grid.to_pixels(place))
    }

    /// Writes a place, or a line of them, in these coordinates.
    fn count_in_pixels(&self, pose: usize, at: &mut Item) {
        if self.separated.grids.iter().all(Option::is_none) {
            return;
        }
        if let Some(array) = at.as_array_mut() {
            self.count_array(pose, array);
        }
    }

    fn count_array(&self, pose: usize, array: &mut Array) {
        let numbers: Option<Vec<f64>> = array.iter().map(number_of).collect();
        match numbers.as_deref() {
            Some(&[x, y]) => *array = written_place(self.place(pose, Point::new(x, y))),
            _ => (array.iter_mut().filter_map(Value::as_array_mut)).for_each(|place| self.count_array(pose, place)),
        }
    }
}

/// A place to a thousandth of a pixel.
fn written_place(place: Point) -> Array {
    place.iter().map(|c| (c * 1e3).round() / 1e3 + 0.0).collect()
}

/// Adds a landmark that a layer has from how it was found.
fn add_landmark(
    document: &mut DocumentMut,
    layer: &SeparatedLayer,
    landmark: &SeparatedLandmark,
    grids: &Grids<'_>,
) -> anyhow::Result<()> {
    let mut at = InlineTable::new();
    for (index, (pose, place)) in grids.scene.poses.iter().zip(&landmark.at).enumerate() {
        if let Some(place) = place {
            at.insert(&pose.name, Value::Array(written_place(grids.place(index, *place))));
        }
    }
    let mut table = Table::new();
    table.insert("name", landmark.name.as_str().into());
    table.insert("layer", layer.name.as_str().into());
    table.insert("at", Item::Value(Value::InlineTable(at)));
    if !push_table(document, "landmark", table) {
        bail!("`landmark` is no list of tables");
    }
    Ok(())
}

/// The pictures that are written are cut out, and of one piece.
fn edit_input(document: &mut DocumentMut, separated: &Separated) -> anyhow::Result<()> {
    let input = document.entry("input").or_insert(Item::Table(Table::new()));
    let input = input.as_table_like_mut().context("`input` is no table")?;
    for key in ["gap", "paper", "cells"] {
        input.remove(key);
    }
    input.insert("figure", "alpha".into());
    input.insert("parts", "largest".into());
    if separated.has_overlaps {
        input.insert("overlaps", "refuse".into());
    }
    Ok(())
}

/// Says for each handle of a copy which layer it takes hold of.
fn name_handles(handles: &mut Item, pose: usize, separated: &Separated) {
    // Each layer has its handles in the order of the file.
    let mut left: Vec<_> = separated
        .layers
        .iter()
        .map(|layer| layer.handles[pose].iter().peekable())
        .collect();
    for handle in tables_of(handles) {
        let from = handle.get("from").and_then(Item::as_array);
        let from: Option<Vec<f64>> = from.map(|from| from.iter().filter_map(number_of).collect());
        let is_next = |own: &mut std::iter::Peekable<std::slice::Iter<'_, inbetween::pipeline::HandleMove>>| {
            own.peek()
                .is_some_and(|next| from.as_deref() == Some(&[next.from.x, next.from.y]))
        };
        let found = left.iter_mut().position(is_next);
        if let Some(layer) = found {
            left[layer].next();
            handle.insert("layer", separated.layers[layer].name.as_str().into());
        }
    }
}
