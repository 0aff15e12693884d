//! Second words for keys, where the field writes a symbol: `E` is `youngs_modulus`.
//!
//! Before the deck is read every key gets its first word, so that nothing after this knows of the second. Words of kinds
//! (`"ball"` for `"spherical"`) are aliases of the kinds themselves, see [`base::words::kinds::Kind`].

use serde_json::{Value as Json, json};
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use base::diagnostic::Diagnostic;

/// Another word for a key.
struct Alias {
    /// The table that has the key.
    table: &'static str,
    /// The table is one of tables named by the user, as in `[materials.steel]`.
    named: bool,
    /// Name of the table in the schema.
    definition: &'static str,
    word: &'static str,
    key: &'static str,
}

const fn material(word: &'static str, key: &'static str) -> Alias {
    Alias { table: "materials", named: true, definition: "Material", word, key }
}

const fn damping(word: &'static str, key: &'static str) -> Alias {
    Alias { table: "damping", named: false, definition: "Damping", word, key }
}

const ALIASES: [Alias; 5] = [
    material("E", "youngs_modulus"),
    material("nu", "poisson_ratio"),
    material("rho", "density"),
    damping("alpha", "mass_factor"),
    damping("beta", "stiffness_factor"),
];

/// Gives every key its first word. A key written with both spellings is an error; the value of the first spelling stays.
pub fn unify(root: &mut DeTable) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for alias in &ALIASES {
        let Some(DeValue::Table(table)) = root.get_mut(alias.table).map(Spanned::get_mut) else { continue };
        if !alias.named {
            rename(table, alias, &mut problems);
            continue;
        }
        for (_, entry) in table.iter_mut() {
            if let DeValue::Table(table) = entry.get_mut() {
                rename(table, alias, &mut problems);
            }
        }
    }
    problems
}

fn rename(table: &mut DeTable, alias: &Alias, problems: &mut Vec<Diagnostic>) {
    let Some(place) = table.keys().find(|key| key.get_ref() == alias.word).map(Spanned::span) else { return };
    let Some(value) = table.remove(alias.word) else { return };
    if table.contains_key(alias.key) {
        let message = format!("`{}` and `{}` are two words for the same key", alias.word, alias.key);
        problems.push(Diagnostic::error(message).at(&place).hint("give one of them"));
        return;
    }
    table.insert(Spanned::new(place, Cow::Borrowed(alias.key)), value);
}

/// Adds the second words to the schema of the deck.
pub fn describe(schema: &mut Json) {
    for alias in &ALIASES {
        let definition = &mut schema["$defs"][alias.definition];
        let mut entry = definition["properties"][alias.key].clone();
        entry["description"] = format!("Another word for `{}`.", alias.key).into();
        definition["properties"][alias.word] = entry;
        let Some(required) = definition.get_mut("required").and_then(Json::as_array_mut) else { continue };
        if let Some(at) = required.iter().position(|key| key == alias.key) {
            required.remove(at);
            definition["anyOf"] = json!([{ "required": [alias.key] }, { "required": [alias.word] }]);
        }
    }
}
