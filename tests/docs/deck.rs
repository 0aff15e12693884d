//! docs/deck.md: every table and key, from the JSON Schema of the deck.

use super::{anchor, cell, keep, rdsolve};
use serde_json::Value;
use std::fmt::Write;

/// The tables of the deck in the order in which a reader meets them; the schema has them by the alphabet.
const ORDER: [&str; 29] = [
    "title",
    "units",
    "analysis",
    "integrator",
    "iteration",
    "materials",
    "sections",
    "points",
    "mesh",
    "sets",
    "beams",
    "bars",
    "shells",
    "bodies",
    "masses",
    "attachments",
    "ties",
    "supports",
    "joints",
    "links",
    "contacts",
    "loads",
    "amplitudes",
    "environment",
    "initial",
    "damping",
    "expect",
    "output",
    "study",
];

struct Reference<'a> {
    definitions: &'a Value,
    text: String,
    /// Tables within tables that have been written.
    done: Vec<(&'a Value, String)>,
}

impl<'a> Reference<'a> {
    fn resolve(&self, schema: &'a Value) -> &'a Value {
        match schema["$ref"].as_str() {
            Some(name) => &self.definitions[name.trim_start_matches("#/$defs/")],
            None => schema,
        }
    }

    /// What may stand there, in a few words.
    fn kind(&self, schema: &'a Value) -> String {
        let schema = self.resolve(schema);
        if let Some(words) = self.words(schema) {
            return words.iter().map(|(word, _)| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", ");
        }
        if let Some(any) = schema["anyOf"].as_array().or(schema["oneOf"].as_array()) {
            let mut kinds: Vec<String> = Vec::new();
            for kind in any.iter().map(|one| self.kind(one)) {
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                }
            }
            return kinds.join(" or ");
        }
        if let Some(word) = schema["const"].as_str() {
            return format!("`\"{word}\"`");
        }
        match schema["type"].as_str() {
            Some("array") => {
                let item = self.kind(&schema["items"]);
                match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                    (Some(a), Some(b)) if a == b => format!("[{}]", vec![item; a as usize].join(", ")),
                    _ => format!("list of {item}"),
                }
            }
            Some("object") if schema["properties"].is_object() => "table".to_owned(),
            Some("object") => format!("table of {}", self.kind(&schema["additionalProperties"])),
            Some("string") => "text".to_owned(),
            Some(other) => other.to_owned(),
            None => "anything".to_owned(),
        }
    }

    /// The words of an enumeration and what they mean.
    fn words(&self, schema: &'a Value) -> Option<Vec<(&'a str, &'a str)>> {
        if let Some(plain) = schema["enum"].as_array() {
            return Some(plain.iter().filter_map(|word| Some((word.as_str()?, ""))).collect());
        }
        let mut found = Vec::new();
        for one in schema["oneOf"].as_array()? {
            let one = self.resolve(one);
            match (one["const"].as_str(), one["enum"].as_array()) {
                (Some(word), _) => found.push((word, one["description"].as_str().unwrap_or(""))),
                (None, Some(plain)) => found.extend(plain.iter().filter_map(|word| Some((word.as_str()?, "")))),
                _ => return None,
            }
        }
        Some(found)
    }

    /// A row for each key of a table, then the words that keys may take, then tables within it.
    fn table(&mut self, schema: &'a Value, level: &str) {
        let Some(properties) = schema["properties"].as_object() else { return };
        let required: Vec<&str> =
            schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        self.text += "\n| key | value | meaning |\n|---|---|---|\n";
        let mut inner = Vec::new();
        let mut rows: Vec<_> = properties.iter().collect();
        rows.sort_by_key(|(key, _)| (!["name", "kind"].contains(&key.as_str()), !required.contains(&key.as_str())));
        for (key, value) in rows {
            let star = if required.contains(&key.as_str()) { " *" } else { "" };
            let target = self.resolve(value);
            let mut meaning = cell(value["description"].as_str().or(target["description"].as_str()).unwrap_or(""));
            let words = self.words(target).unwrap_or_default();
            for like in words.chunk_by(|a, b| a.1 == b.1).filter(|like| !like[0].1.is_empty()) {
                let names: Vec<String> = like.iter().map(|(word, _)| format!("`\"{word}\"`")).collect();
                let between = if meaning.is_empty() { "" } else { "<br>" };
                let _ = write!(meaning, "{between}{}: {}", names.join(" or "), cell(like[0].1));
            }
            let _ = writeln!(self.text, "| `{key}`{star} | {} | {meaning} |", self.kind(value).replace('|', "\\|"));
            inner.extend(self.tables_within(value).into_iter().map(|table| (key.clone(), table)));
        }
        for (key, table) in inner {
            let description = table["description"].as_str().unwrap_or("").replace('\n', " ");
            let _ = write!(self.text, "\n{level} {key}\n\n{description}\n");
            match self.done.iter().find(|(properties, _)| **properties == table["properties"]) {
                Some((_, other)) => self.text += &format!("\nThe keys are those of `{other}`, above.\n"),
                None => {
                    self.done.push((&table["properties"], key));
                    self.table(table, &format!("{level}#"));
                }
            }
        }
    }

    /// Tables that a value is or holds.
    fn tables_within(&self, schema: &'a Value) -> Vec<&'a Value> {
        let any = schema["anyOf"].as_array().into_iter().flatten();
        let all = [schema, &schema["items"], &schema["additionalProperties"]].into_iter().chain(any);
        all.map(|one| self.resolve(one)).filter(|one| one["properties"].is_object()).collect()
    }
}

/// docs/deck.md from the output of `rdsolve schema`.
fn deck_reference(schema: &Value) -> String {
    let mut reference = Reference { definitions: &schema["$defs"], text: String::new(), done: Vec::new() };
    reference.text += "<!-- generated from `rdsolve schema`: UPDATE_DOCS=1 cargo test --test all -- docs -->\n\n# Deck reference\n\n\
        Every table and key of a deck, a TOML file. Keys with * are needed. Numbers may be written as integers. Names refer to \
        what the deck names: order does not matter. `rdsolve schema` prints the same as a JSON Schema for editors. How decks \
        are put together: [tutorial](tutorial.md).\n";
    let properties = schema["properties"].as_object().expect("properties");
    reference.text += "\n";
    let rank = |key: &str| ORDER.iter().position(|known| *known == key).unwrap_or(ORDER.len());
    let mut tables: Vec<_> = properties.iter().collect();
    tables.sort_by_key(|(key, _)| rank(key));
    for (key, value) in &tables {
        let _ = writeln!(reference.text, "- [`{key}`](#{})", anchor(&title(key, value)));
    }
    for (key, value) in tables {
        let _ = write!(reference.text, "\n## {}\n", title(key, value));
        let tables = reference.tables_within(value);
        let own = value["description"].as_str().unwrap_or("");
        let said = if own.is_empty() {
            tables.first().and_then(|table| table["description"].as_str()).unwrap_or("")
        } else {
            own
        };
        let _ = write!(reference.text, "\n{}\n", said.replace('\n', " "));
        match tables.into_iter().next() {
            Some(table) => {
                if said == own && table["description"].as_str().is_some_and(|text| text != own) {
                    let _ = write!(
                        reference.text,
                        "\n{}\n",
                        table["description"].as_str().unwrap_or("").replace('\n', " ")
                    );
                }
                reference.done.push((&table["properties"], title(key, value)));
                reference.table(table, "###");
            }
            None => {
                let kind = reference.kind(value);
                let _ = write!(reference.text, "\nValue: {kind}.\n");
            }
        }
    }
    reference.text
}

/// As it is written in a deck.
fn title(key: &str, schema: &Value) -> String {
    match schema["type"].as_str() {
        Some("array") => format!("[[{key}]]"),
        Some("object")
            if schema["additionalProperties"]
                .get("properties")
                .or(schema["additionalProperties"].get("$ref"))
                .is_some() =>
        {
            format!("[{key}.NAME]")
        }
        Some("object") => format!("[{key}]"),
        _ if schema["$ref"].is_string() && key != "units" => format!("[{key}]"),
        _ => key.to_owned(),
    }
}

#[test]
fn the_deck_reference_is_the_schema() {
    let done = rdsolve(&["schema"]).output().unwrap();
    let schema: Value = serde_json::from_slice(&done.stdout).unwrap();
    keep("docs/deck.md", &deck_reference(&schema));
}
