//! The tables of a list in the text of a scene, whichever way they are written.

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

/// The tables of `[[name]]`, or of `name = [{...}]`.
pub(crate) fn tables<'a>(document: &'a mut DocumentMut, name: &str) -> Vec<&'a mut dyn TableLike> {
    document.get_mut(name).map(tables_of).unwrap_or_default()
}

/// The tables of a list.
pub(crate) fn tables_of(list: &mut Item) -> Vec<&mut dyn TableLike> {
    match list {
        Item::ArrayOfTables(tables) => tables.iter_mut().map(|table| table as &mut dyn TableLike).collect(),
        Item::Value(Value::Array(values)) => values
            .iter_mut()
            .filter_map(|value| value.as_inline_table_mut().map(|table| table as &mut dyn TableLike))
            .collect(),
        _ => Vec::new(),
    }
}

/// Adds a table to `[[name]]`, whichever way it is written; `false` if that is no list.
pub(crate) fn push_table(document: &mut DocumentMut, name: &str, table: Table) -> bool {
    match (document.entry(name)).or_insert(Item::ArrayOfTables(ArrayOfTables::new())) {
        Item::ArrayOfTables(tables) => tables.push(table),
        Item::Value(Value::Array(values)) => values.push(table.into_inline_table()),
        _ => return false,
    }
    true
}

/// A number, whole or not.
pub(crate) fn number_of(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|number| number as f64))
}

/// The name that a table gives itself.
pub(crate) fn name_of(table: &dyn TableLike) -> Option<&str> {
    table.get("name").and_then(Item::as_str)
}
