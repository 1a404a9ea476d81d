//! Tables and values of a TOML document, whichever way they are written.

use inbetween::math::Point;
use serde_json::Value as Json;
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use crate::explorer::problem::{Problem, Refusal};
use crate::tables::push_table;
pub(super) use crate::tables::tables;

/// What the text does not have.
pub(super) fn missing(what: impl std::fmt::Display) -> Refusal {
    Refusal::conflict(Problem::new(format!("the scene has no {what}")))
}

/// The table of `[[kind]]` with this name.
pub(super) fn named<'a>(
    document: &'a mut DocumentMut,
    kind: &str,
    name: &str,
) -> Result<&'a mut dyn TableLike, Refusal> {
    tables(document, kind)
        .into_iter()
        .find(|table| text_of(*table, "name") == Some(name))
        .ok_or_else(|| missing(format!("{kind} '{name}'")))
}

/// The names of all tables of `[[kind]]`.
pub(super) fn names(document: &mut DocumentMut, kind: &str) -> Vec<String> {
    let tables = tables(document, kind).into_iter();
    tables
        .filter_map(|table| text_of(table, "name").map(str::to_owned))
        .collect()
}

/// Adds a table to `[[name]]`.
pub(super) fn push(document: &mut DocumentMut, name: &str, table: Table) -> Result<(), Refusal> {
    if push_table(document, name, table) {
        Ok(())
    } else {
        Err(missing(format!("list of [[{name}]]")))
    }
}

/// Removes the table of `[[name]]` at a place.
pub(super) fn remove(document: &mut DocumentMut, name: &str, index: usize) -> Result<(), Refusal> {
    let is_empty = match document.get_mut(name) {
        Some(Item::ArrayOfTables(tables)) if index < tables.len() => {
            tables.remove(index);
            tables.is_empty()
        }
        Some(Item::Value(Value::Array(values))) if index < values.len() => {
            values.remove(index);
            values.is_empty()
        }
        _ => return Err(missing(format!("[[{name}]] number {index}"))),
    };
    if is_empty {
        document.remove(name);
    }
    Ok(())
}

pub(super) fn text_of<'a>(table: &'a dyn TableLike, key: &str) -> Option<&'a str> {
    table.get(key).and_then(Item::as_str)
}

/// Sets a value; what stands around it stays.
pub(super) fn set(table: &mut dyn TableLike, key: &str, mut value: Value) {
    if let Some(Item::Value(old)) = table.get_mut(key) {
        *value.decor_mut() = old.decor().clone();
        *old = value;
    } else {
        table.insert(key, Item::Value(value));
    }
}

/// Sets a list of numbers; what is written between those that it replaces stays.
pub(super) fn set_numbers(table: &mut dyn TableLike, key: &str, numbers: &[f64]) {
    if let Some(Item::Value(Value::Array(old))) = table.get_mut(key)
        && old.len() == numbers.len()
    {
        for (k, number) in numbers.iter().enumerate() {
            old.replace(k, *number);
        }
        return;
    }
    set(table, key, numbers_value(numbers));
}

pub(super) fn numbers_value(numbers: &[f64]) -> Value {
    Value::Array(numbers.iter().copied().collect())
}

/// A point, rounded to what a drawing's pixels are worth if it was computed.
pub(super) fn point_value(point: Point) -> Value {
    numbers_value(&[point.x, point.y])
}

/// The inline table of some values.
pub(super) fn inline<'a>(pairs: impl IntoIterator<Item = (&'a str, Value)>) -> InlineTable {
    let mut table = InlineTable::new();
    for (key, value) in pairs {
        table.insert(key, value);
    }
    table
}

/// A list with each element on a line of its own.
pub(super) fn lines(values: impl IntoIterator<Item = Value>) -> Array {
    let mut array = Array::new();
    for mut value in values {
        value.decor_mut().set_prefix("\n  ");
        array.push_formatted(value);
    }
    if !array.is_empty() {
        array.set_trailing("\n");
        array.set_trailing_comma(true);
    }
    array
}

/// A JSON value as TOML has it; there is no null.
pub(super) fn from_json(value: &Json) -> Result<Value, Refusal> {
    Ok(match value {
        Json::Null | Json::Object(_) => return Err(Refusal::bad(format!("{value} cannot be written into a scene"))),
        Json::Bool(value) => (*value).into(),
        Json::String(value) => value.as_str().into(),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => whole.into(),
            (None, Some(number)) => number.into(),
            (None, None) => return Err(Refusal::bad(format!("{number} is too large"))),
        },
        Json::Array(values) => Value::Array(values.iter().map(from_json).collect::<Result<_, _>>()?),
    })
}
