//! Edits of settings, pseudo-poses and the animation.

use serde_json::Value as Json;
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

use super::KeyText;
use super::written::{
    from_json, inline, lines, missing, numbers_value, push, remove, set as set_value, set_numbers, tables,
};
use crate::explorer::problem::Refusal;

/// Tables whose keys can be set one by one.
const TABLES: [&str; 6] = ["pose_space", "blend", "texture", "mesh", "input", "animation"];

fn table<'a>(document: &'a mut DocumentMut, name: &str) -> Result<&'a mut dyn TableLike, Refusal> {
    document
        .entry(name)
        .or_insert(Item::Table(Table::new()))
        .as_table_like_mut()
        .ok_or_else(|| missing(format!("table [{name}]")))
}

pub(super) fn set(document: &mut DocumentMut, name: &str, key: &str, value: &Json) -> Result<(), Refusal> {
    if !TABLES.contains(&name) {
        return Err(Refusal::bad(format!(
            "table [{name}] cannot be set; those that can are {}",
            TABLES.join(", ")
        )));
    }
    if value.is_null() {
        if let Some(table) = document.get_mut(name).and_then(Item::as_table_like_mut) {
            table.remove(key);
        }
        return Ok(());
    }
    set_value(table(document, name)?, key, from_json(value)?);
    Ok(())
}

pub(super) fn set_keys(
    document: &mut DocumentMut,
    keys: &[KeyText],
    looped: Option<bool>,
    fps: Option<f64>,
) -> Result<(), Refusal> {
    let animation = table(document, "animation")?;
    let key = |key: &KeyText| -> Value {
        let mut table = inline([("time", key.time.into()), ("at", numbers_value(&key.at))]);
        if let Some(hold) = key.hold {
            table.insert("hold", hold.into());
        }
        if !key.spacing.is_empty() {
            table.insert("spacing", numbers_value(&key.spacing));
        }
        table.into()
    };
    if let Some(fps) = fps {
        set_value(animation, "fps", fps.into());
    }
    if let Some(looped) = looped {
        set_value(animation, "loop", looped.into());
    }
    if keys.is_empty() {
        animation.remove("keys");
    } else {
        set_value(animation, "keys", Value::Array(lines(keys.iter().map(key))));
    }
    Ok(())
}

pub(super) fn add_pseudo_pose(document: &mut DocumentMut, from: &[f64], at: &[f64]) -> Result<(), Refusal> {
    let mut table = Table::new();
    set_numbers(&mut table, "from", from);
    set_numbers(&mut table, "at", at);
    push(document, "pseudo_pose", table)
}

pub(super) fn move_pseudo_pose(
    document: &mut DocumentMut,
    index: usize,
    from: Option<&[f64]>,
    at: Option<&[f64]>,
) -> Result<(), Refusal> {
    let mut all = tables(document, "pseudo_pose");
    let own = all
        .get_mut(index)
        .ok_or_else(|| missing(format!("pseudo-pose {index}")))?;
    for (key, place) in [("from", from), ("at", at)] {
        if let Some(place) = place {
            set_numbers(*own, key, place);
        }
    }
    Ok(())
}

pub(super) fn remove_pseudo_pose(document: &mut DocumentMut, index: usize) -> Result<(), Refusal> {
    remove(document, "pseudo_pose", index)
}
