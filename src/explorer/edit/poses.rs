//! Edits of poses.

use inbetween::math::Point;
use inbetween::scene::Layout;
use serde_json::Value as Json;
use toml_edit::{Array, DocumentMut, Item, Table, TableLike, Value};

use super::written::{
    from_json, inline, missing, named, names, point_value, push, remove as remove_table, set as set_value, set_numbers,
    tables, text_of,
};
use super::{Context, HandleText};
use crate::explorer::problem::Refusal;

/// Writes the places that are shown, if the file has none.
fn place_all(document: &mut DocumentMut, context: &Context<'_>) {
    let Some(scene) = context.scene else { return };
    if tables(document, "pose").iter().any(|table| table.contains_key("at")) {
        return;
    }
    debug_assert!(scene.layout == Layout::Automatic || context.bench.is_some());
    for table in tables(document, "pose") {
        let name = text_of(table, "name").map(str::to_owned);
        let pose = scene.poses.iter().find(|pose| Some(&pose.name) == name.as_ref());
        if let Some(pose) = pose {
            set_numbers(table, "at", &pose.at);
        }
    }
}

pub(super) fn move_pose(
    document: &mut DocumentMut,
    context: &Context<'_>,
    pose: &str,
    at: &[f64],
) -> Result<(), Refusal> {
    place_all(document, context);
    set_numbers(named(document, "pose", pose)?, "at", at);
    Ok(())
}

/// A name that is not taken.
pub(super) fn free_name(taken: &[String], stem: &str) -> String {
    let candidate = |k: usize| format!("{stem}_{k}");
    (1..)
        .map(candidate)
        .find(|name| !taken.contains(name))
        .unwrap_or_default()
}

fn handles_value(context: &Context<'_>, of: &str, handles: &[HandleText]) -> Value {
    let mut array = Array::new();
    for handle in handles {
        let place = |place: [f64; 2]| point_value(context.as_written(handle.layer.as_deref(), of, Point::from(place)));
        let mut table = inline([("from", place(handle.from)), ("to", place(handle.to))]);
        // Handles of a scene without layers go to the loose part that they lie on.
        if let Some(layer) = handle
            .layer
            .as_ref()
            .filter(|_| context.scene.is_none_or(|scene| !scene.layers.is_empty()))
        {
            table.insert("layer", layer.as_str().into());
        }
        array.push(table);
    }
    Value::Array(array)
}

pub(super) fn add_copy(
    document: &mut DocumentMut,
    context: &Context<'_>,
    (name, of): (Option<&str>, &str),
    at: &[f64],
    handles: &[HandleText],
) -> Result<String, Refusal> {
    named(document, "pose", of)?;
    place_all(document, context);
    let name = name.map_or_else(|| free_name(&names(document, "pose"), of), str::to_owned);
    let mut table = Table::new();
    table.insert("name", name.as_str().into());
    table.insert("deform_of", of.into());
    table.insert("handles", Item::Value(handles_value(context, of, handles)));
    set_numbers(&mut table, "at", at);
    push(document, "pose", table)?;
    Ok(name)
}

pub(super) fn set_handles(
    document: &mut DocumentMut,
    context: &Context<'_>,
    pose: &str,
    handles: &[HandleText],
) -> Result<(), Refusal> {
    let table = named(document, "pose", pose)?;
    let of = text_of(table, "deform_of").ok_or_else(|| missing(format!("copy '{pose}' with handles")))?;
    let value = handles_value(context, of, handles);
    set_value(table, "handles", value);
    Ok(())
}

pub(super) fn remove(document: &mut DocumentMut, context: &Context<'_>, pose: &str) -> Result<(), Refusal> {
    let poses = names(document, "pose");
    let index = poses
        .iter()
        .position(|name| name == pose)
        .ok_or_else(|| missing(format!("pose '{pose}'")))?;
    // Others would be laid out anew without it.
    if context.scene.is_some_and(|scene| scene.layout == Layout::Given) {
        place_all(document, context);
    }
    remove_table(document, "pose", index)?;
    for kind in ["landmark", "part"] {
        let mut empty = Vec::new();
        for (k, mark) in tables(document, kind).into_iter().enumerate() {
            if let Some(cut) = mark.get_mut("cut").and_then(Item::as_table_like_mut) {
                cut.remove(pose);
            }
            if let Some(at) = mark.get_mut("at").and_then(Item::as_table_like_mut) {
                at.remove(pose);
                if at.is_empty() {
                    empty.push(k);
                }
            }
        }
        for k in empty.into_iter().rev() {
            remove_table(document, kind, k)?;
        }
    }
    Ok(())
}

pub(super) fn set(document: &mut DocumentMut, pose: &str, key: &str, value: &Json) -> Result<(), Refusal> {
    match (key, value) {
        ("mirror" | "turns" | "figure" | "gap" | "paper" | "threshold", Json::Null) => {
            named(document, "pose", pose)?.remove(key);
        }
        ("mirror", Json::Bool(_))
        | ("turns" | "gap" | "threshold", Json::Number(_))
        | ("figure" | "paper", Json::String(_)) => {
            set_value(named(document, "pose", pose)?, key, from_json(value)?);
        }
        ("name", Json::String(name)) => rename(document, pose, name)?,
        _ => return Err(Refusal::bad(format!("`{key}` of a pose cannot be set to {value}"))),
    }
    Ok(())
}

/// Renames a key of a table, whose keys stay in their order.
fn rename_key(table: &mut dyn TableLike, before: &str, name: &str) {
    let keys: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
    if !keys.iter().any(|key| key == before) {
        return;
    }
    for key in keys {
        if let Some(item) = table.remove(&key) {
            table.insert(if key == before { name } else { &key }, item);
        }
    }
}

/// Renames a pose wherever it is named.
fn rename(document: &mut DocumentMut, pose: &str, name: &str) -> Result<(), Refusal> {
    set_value(named(document, "pose", pose)?, "name", name.into());
    for table in tables(document, "pose") {
        if text_of(table, "deform_of") == Some(pose) {
            set_value(table, "deform_of", name.into());
        }
    }
    for (kind, key) in [("landmark", "at"), ("part", "at"), ("part", "cut")] {
        for mark in tables(document, kind) {
            if let Some(places) = mark.get_mut(key).and_then(Item::as_table_like_mut) {
                rename_key(places, pose, name);
            }
        }
    }
    if document.get("reference").and_then(Item::as_str) == Some(pose) {
        set_value(document.as_table_mut(), "reference", name.into());
    }
    if let Some(blend) = document.get_mut("blend").and_then(Item::as_table_like_mut)
        && text_of(blend, "reference") == Some(pose)
    {
        set_value(blend, "reference", name.into());
    }
    Ok(())
}
