//! Edits of the places that say which loose parts belong to the figure of a pose.

use toml_edit::{Array, DocumentMut, Item, TableLike, Value};

use super::PartList;
use super::written::{missing, named, numbers_value};
use crate::explorer::problem::Refusal;

impl PartList {
    /// Its key in scene files.
    fn key(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Drop => "drop",
        }
    }

    /// What its places are, for the list of steps.
    pub(super) fn participle(self) -> &'static str {
        match self {
            Self::Keep => "kept",
            Self::Drop => "dropped",
        }
    }
}

/// Adds a place behind those that the list has, which stay as they are written.
pub(super) fn mark(document: &mut DocumentMut, pose: &str, list: PartList, at: [f64; 2]) -> Result<(), Refusal> {
    if !at.iter().all(|value| value.is_finite()) {
        return Err(Refusal::bad("`at` is not finite"));
    }
    let table = named(document, "pose", pose)?;
    if !table.contains_key(list.key()) {
        table.insert(list.key(), Item::Value(Value::Array(Array::new())));
    }
    places(table, list)?.push(numbers_value(&at));
    Ok(())
}

/// Takes a place out; an empty list goes with it.
pub(super) fn unmark(document: &mut DocumentMut, pose: &str, list: PartList, index: usize) -> Result<(), Refusal> {
    let table = named(document, "pose", pose)?;
    let array = places(table, list)?;
    if index >= array.len() {
        return Err(missing(format!("place {index} in `{}` of pose '{pose}'", list.key())));
    }
    let before = prefix_of(&array.remove(index));
    if array.is_empty() {
        table.remove(list.key());
    } else if before.contains('#') {
        // A comment behind a comma belongs to what stands before it, but is written as part of what comes after.
        match array.get_mut(index) {
            Some(next) => {
                let own = prefix_of(next);
                next.decor_mut().set_prefix(before + &own);
            }
            None => {
                let rest = array.trailing().as_str().unwrap_or_default().to_owned();
                array.set_trailing(before + &rest);
            }
        }
    }
    Ok(())
}

/// What is written before a value.
fn prefix_of(value: &Value) -> String {
    let prefix = value.decor().prefix();
    prefix
        .and_then(toml_edit::RawString::as_str)
        .unwrap_or_default()
        .to_owned()
}

fn places(table: &mut dyn TableLike, list: PartList) -> Result<&mut Array, Refusal> {
    let array = table.get_mut(list.key()).and_then(Item::as_array_mut);
    array.ok_or_else(|| missing(format!("list `{}`", list.key())))
}
