//! Edits of landmarks.

use std::collections::BTreeMap;

use serde_json::Value as Json;
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

use super::poses::free_name;
use super::written::{
    missing, named, names, point_value, push, remove as remove_table, set as set_value, set_numbers, tables, text_of,
};
use super::{Context, point};
use crate::explorer::problem::Refusal;

/// A place, or the places of a line, as the file has them.
fn place_value(context: &Context<'_>, layer: Option<&str>, pose: &str, at: &Json) -> Result<Value, Refusal> {
    let written = |at: &Json| -> Result<_, Refusal> { Ok(context.as_written(layer, pose, point(at)?)) };
    let is_line = at.as_array().and_then(|list| list.first()).is_some_and(Json::is_array);
    if !is_line {
        return Ok(point_value(written(at)?));
    }
    let points = at.as_array().map(Vec::as_slice).unwrap_or_default().iter();
    let points: Vec<Value> = points
        .map(|at| written(at).map(point_value))
        .collect::<Result<_, _>>()?;
    Ok(Value::Array(points.into_iter().collect()))
}

/// The poses in the scene's order, then what else is named.
fn in_order<'a>(context: &Context<'_>, at: &'a BTreeMap<String, Json>) -> Vec<(&'a String, &'a Json)> {
    let order = |name: &String| {
        let poses = context.scene.map(|scene| scene.poses.as_slice()).unwrap_or_default();
        poses.iter().position(|pose| pose.name == *name).unwrap_or(usize::MAX)
    };
    let mut places: Vec<_> = at.iter().collect();
    places.sort_by_key(|(name, _)| order(name));
    places
}

pub(super) fn add(
    document: &mut DocumentMut,
    context: &Context<'_>,
    (name, layer): (Option<&str>, Option<&str>),
    at: &BTreeMap<String, Json>,
    is_path: bool,
) -> Result<String, Refusal> {
    let name = name.map_or_else(|| free_name(&names(document, "landmark"), "landmark"), str::to_owned);
    let mut table = Table::new();
    table.insert("name", name.as_str().into());
    // A loose part that is a layer by itself has no table: landmarks go to the part that they lie on.
    if let Some(layer) = layer.filter(|_| !tables(document, "layer").is_empty()) {
        table.insert("layer", layer.into());
    }
    if is_path {
        table.insert("path", true.into());
    }
    let mut places = toml_edit::InlineTable::new();
    for (pose, at) in in_order(context, at) {
        places.insert(pose, place_value(context, layer, pose, at)?);
    }
    table.insert("at", Item::Value(Value::InlineTable(places)));
    push(document, "landmark", table)?;
    Ok(name)
}

fn places<'a>(document: &'a mut DocumentMut, landmark: &str) -> Result<&'a mut dyn TableLike, Refusal> {
    named(document, "landmark", landmark)?
        .get_mut("at")
        .and_then(Item::as_table_like_mut)
        .ok_or_else(|| missing(format!("place of landmark '{landmark}'")))
}

pub(super) fn move_to(
    document: &mut DocumentMut,
    context: &Context<'_>,
    landmark: &str,
    at: &BTreeMap<String, Json>,
) -> Result<(), Refusal> {
    let layer = text_of(named(document, "landmark", landmark)?, "layer").map(str::to_owned);
    let own = places(document, landmark)?;
    for (pose, at) in in_order(context, at) {
        let value = place_value(context, layer.as_deref(), pose, at)?;
        let numbers: Option<Vec<f64>> = match &value {
            Value::Array(array) => array.iter().map(Value::as_float).collect(),
            _ => None,
        };
        match numbers {
            Some(numbers) => set_numbers(own, pose, &numbers),
            None => set_value(own, pose, value),
        }
    }
    Ok(())
}

pub(super) fn unset(document: &mut DocumentMut, landmark: &str, pose: &str) -> Result<(), Refusal> {
    let own = places(document, landmark)?;
    own.remove(pose)
        .map(drop)
        .ok_or_else(|| missing(format!("place of landmark '{landmark}' on pose '{pose}'")))
}

pub(super) fn remove(document: &mut DocumentMut, landmark: &str) -> Result<(), Refusal> {
    let all = names(document, "landmark");
    let index = all.iter().position(|name| name == landmark);
    remove_table(
        document,
        "landmark",
        index.ok_or_else(|| missing(format!("landmark '{landmark}'")))?,
    )
}

/// Renames a landmark wherever it is named.
pub(super) fn rename(document: &mut DocumentMut, landmark: &str, name: &str) -> Result<(), Refusal> {
    set_value(named(document, "landmark", landmark)?, "name", name.into());
    for region in tables(document, "region") {
        if text_of(region, "landmark") == Some(landmark) {
            set_value(region, "landmark", name.into());
        }
    }
    for layer in tables(document, "layer") {
        if let Some(anchor) = layer.get_mut("anchor").and_then(Item::as_table_like_mut)
            && text_of(anchor, "at") == Some(landmark)
        {
            set_value(anchor, "at", name.into());
        }
    }
    let anchor = document
        .get_mut("blend")
        .and_then(Item::as_table_like_mut)
        .and_then(|blend| blend.get_mut("anchor"));
    if let Some(Item::Value(anchor)) = anchor {
        rename_in(anchor, landmark, name);
    }
    Ok(())
}

/// In a name, or a list of names and tables.
fn rename_in(value: &mut Value, landmark: &str, name: &str) {
    match value {
        Value::String(text) if text.value() == landmark => {
            let mut renamed = Value::from(name);
            *renamed.decor_mut() = value.decor().clone();
            *value = renamed;
        }
        Value::Array(values) => {
            for value in values.iter_mut() {
                rename_in(value, landmark, name);
            }
        }
        Value::InlineTable(table) => {
            if let Some(value) = table.get_mut("landmark") {
                rename_in(value, landmark, name);
            }
        }
        _ => {}
    }
}
