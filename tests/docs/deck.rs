//! docs/deck.md: every table and key, from the JSON Schema of the deck.

use super::{anchor, cell, keep, rdsolve};
use serde_json::Value;
use std::fmt::Write;

struct Reference<'a> {
    definitions: &'a Value,
    text: String,
    /// Tables within tables that have been written.
    done: Vec<String>,
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
        for (key, value) in properties {
            let star = if required.contains(&key.as_str()) { " *" } else { "" };
            let target = self.resolve(value);
            let mut meaning = cell(value["description"].as_str().or(target["description"].as_str()).unwrap_or(""));
            for (word, what) in self.words(target).unwrap_or_default().iter().filter(|(_, what)| !what.is_empty()) {
                let _ = write!(meaning, "{}`\"{word}\"`: {}", if meaning.is_empty() { "" } else { "<br>" }, cell(what));
            }
            let _ = writeln!(self.text, "| `{key}`{star} | {} | {meaning} |", self.kind(value).replace('|', "\\|"));
            inner.extend(self.tables_within(value).into_iter().map(|table| (key.clone(), table)));
        }
        for (key, (name, table)) in inner {
            if name.is_empty() || !self.done.contains(&name) {
                self.done.push(name);
                let _ = write!(self.text, "\n{level} {key}\n\n{}\n", table["description"].as_str().unwrap_or(""));
                self.table(table, &format!("{level}#"));
            }
        }
    }

    /// Tables that a value is or holds; those that are used in several places with the name of their definition.
    fn tables_within(&self, schema: &'a Value) -> Vec<(String, &'a Value)> {
        let any = schema["anyOf"].as_array().into_iter().flatten();
        let all = [schema, &schema["items"], &schema["additionalProperties"]].into_iter().chain(any);
        let table = |one: &'a Value| {
            let name = one["$ref"].as_str().unwrap_or("").trim_start_matches("#/$defs/");
            let table = self.resolve(one);
            table["properties"].is_object().then(|| (name.to_owned(), table))
        };
        all.filter_map(table).collect()
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
    for (key, value) in properties {
        let _ = writeln!(reference.text, "- [`{key}`](#{})", anchor(&title(key, value)));
    }
    for (key, value) in properties {
        let _ = write!(reference.text, "\n## {}\n", title(key, value));
        let tables = reference.tables_within(value);
        let own = value["description"].as_str().unwrap_or("");
        let said = if own.is_empty() {
            tables.first().and_then(|(_, t)| t["description"].as_str()).unwrap_or("")
        } else {
            own
        };
        let _ = write!(reference.text, "\n{}\n", said.replace('\n', " "));
        match tables.into_iter().next() {
            Some((name, table)) => {
                if said == own && table["description"].as_str().is_some_and(|text| text != own) {
                    let _ = write!(
                        reference.text,
                        "\n{}\n",
                        table["description"].as_str().unwrap_or("").replace('\n', " ")
                    );
                }
                reference.done.push(name);
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
