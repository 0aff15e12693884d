//! The tables of a deck and their keys, as the schema has them.

use super::{Deck, aliases};
use serde_json::Value;
use std::sync::OnceLock;

/// The label of the table that holds all others.
pub const TOP: &str = "the top of the deck";

/// A table of the deck and its keys.
pub struct DeckTable {
    /// How a deck writes it: "[environment]", "[[beams]]", "[materials.NAME]", "[analysis.stop]".
    pub label: String,
    /// Its keys.
    pub keys: Vec<String>,
}

/// Tables with a key, where it stands in no more than a few; "`gravity` is a key of [environment]".
pub fn place_of(key: &str) -> Option<String> {
    /// A message with more tables does not help.
    const FEW: usize = 3;
    let tables = tables();
    let having: Vec<&str> =
        tables.iter().filter(|table| table.keys.iter().any(|k| k == key)).map(|table| table.label.as_str()).collect();
    (1..=FEW).contains(&having.len()).then(|| format!("`{key}` is a key of {}", base::names::joined(&having)))
}

/// All tables of the deck, its top first.
pub fn tables() -> &'static [DeckTable] {
    // A deck may have thousands of wrong keys.
    static TABLES: OnceLock<Vec<DeckTable>> = OnceLock::new();
    TABLES.get_or_init(|| {
        let mut schema = schemars::schema_for!(Deck).to_value();
        aliases::describe(&mut schema);
        let mut tables = Vec::new();
        walk(&schema, &schema, &Path::default(), &mut tables);
        tables
    })
}

/// True for the label of the table to which these keys lead; NAME in it stands for any key.
pub fn is_label_of(label: &str, path: &[String]) -> bool {
    let parts = || label.trim_matches(['[', ']']).split('.');
    match label {
        TOP => path.is_empty(),
        _ => parts().count() == path.len() && parts().zip(path).all(|(part, key)| part == "NAME" || part == key),
    }
}

/// Where a value of the schema stands.
#[derive(Default, Clone)]
struct Path {
    keys: Vec<String>,
    is_list: bool,
}

impl Path {
    fn label(&self) -> String {
        match (self.is_list, &self.keys[..]) {
            (_, []) => TOP.to_owned(),
            (true, keys) => format!("[[{}]]", keys.join(".")),
            (false, keys) => format!("[{}]", keys.join(".")),
        }
    }

    fn with(&self, key: &str) -> Path {
        let keys = self.keys.iter().cloned().chain([key.to_owned()]).collect();
        Path { keys, is_list: false }
    }
}

/// Adds the tables of a schema value: its reference, alternatives, items and keys.
fn walk(schema: &Value, value: &Value, path: &Path, tables: &mut Vec<DeckTable>) {
    if let Some(name) = value["$ref"].as_str().and_then(|name| name.rsplit('/').next()) {
        walk(schema, &schema["$defs"][name], path, tables);
    }
    for alternative in ["anyOf", "oneOf", "allOf"].iter().filter_map(|key| value[key].as_array()).flatten() {
        walk(schema, alternative, path, tables);
    }
    if value["items"].is_object() {
        walk(schema, &value["items"], &Path { is_list: true, ..path.clone() }, tables);
    }
    if value["additionalProperties"].is_object() {
        walk(schema, &value["additionalProperties"], &path.with("NAME"), tables);
    }
    let Some(properties) = value["properties"].as_object() else { return };
    let (label, keys) = (path.label(), properties.keys().cloned());
    match tables.iter_mut().find(|table| table.label == label) {
        Some(table) => table.keys.extend(keys),
        None => tables.push(DeckTable { label, keys: keys.collect() }),
    }
    for (key, property) in properties {
        walk(schema, property, &path.with(key), tables);
    }
}
