//! The text of a deck: tables in the order of the reference, each below the lines of the file that it comes from.

use std::collections::HashMap;
use std::fmt::Write;

/// Tables in the order of the reference.
const ORDER: [&str; 27] = [
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
    "equations",
    "joints",
    "links",
    "contacts",
    "loads",
    "amplitudes",
    "environment",
    "initial",
    "damping",
    "output",
    "stages",
];
/// Tables that stand once.
const SINGLE: [&str; 8] = ["analysis", "integrator", "iteration", "points", "mesh", "environment", "damping", "output"];
/// Tables with a name in their head.
const NAMED: [&str; 3] = ["materials", "sections", "amplitudes"];

/// A table of the deck.
#[derive(Debug, Clone, Default)]
pub struct DeckTable {
    /// The table: `beams`.
    kind: &'static str,
    /// Its name in the head, of tables that have one there.
    name: String,
    /// Lines of the text that it comes from.
    lines: Vec<usize>,
    keys: Vec<(String, String)>,
}

impl DeckTable {
    /// A table that comes from a line of the file.
    pub fn new(kind: &'static str, line: usize) -> Self {
        DeckTable { kind, lines: vec![line], ..DeckTable::default() }
    }

    /// A table with its name in the head, such as `[materials.steel]`.
    pub fn named(kind: &'static str, name: &str, line: usize) -> Self {
        DeckTable { name: name.to_owned(), ..DeckTable::new(kind, line) }
    }

    /// Returns the table with further lines that it comes from.
    pub fn with_lines(mut self, lines: impl IntoIterator<Item = usize>) -> Self {
        self.lines.extend(lines);
        self.lines.sort_unstable();
        self.lines.dedup();
        self
    }

    /// Returns the table with a name in its head.
    pub fn with_name(mut self, name: &str) -> Self {
        self.name = name.to_owned();
        self
    }

    /// Its keys and their values, whatever lines they come from.
    pub fn content(&self) -> String {
        format!("{:?}", self.keys)
    }

    /// True where it has this key.
    pub fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|(known, _)| known == key)
    }

    /// Returns the table with a value as TOML has it.
    pub fn value(mut self, key: &str, value: impl Into<String>) -> Self {
        self.keys.push((self::key(key), value.into()));
        self
    }

    /// Returns the table with a text.
    pub fn text(self, key: &str, text: &str) -> Self {
        self.value(key, quoted(text))
    }

    /// Returns the table with a number.
    pub fn number(self, key: &str, x: f64) -> Self {
        self.value(key, number(x))
    }

    /// Returns the table with a list of numbers.
    pub fn numbers(self, key: &str, xs: &[f64]) -> Self {
        self.value(key, list(xs.iter().map(|x| number(*x))))
    }

    /// Returns the table with its stages; `None` for all.
    pub fn in_stages(self, stages: Option<&[String]>) -> Self {
        match stages {
            Some(stages) => self.names("stages", stages),
            None => self,
        }
    }

    /// Returns the table with names: one alone, or a list.
    pub fn names(self, key: &str, names: &[String]) -> Self {
        match names {
            [name] => self.text(key, name),
            _ => self.value(key, list(names.iter().map(|name| quoted(name)))),
        }
    }
}

/// A deck under construction.
#[derive(Debug, Default)]
pub struct DeckText {
    tables: Vec<DeckTable>,
    names: UniqueNames,
}

/// Names that nothing else has, whatever their case.
#[derive(Debug, Default)]
pub struct UniqueNames {
    /// Names in small letters, and the last number behind each.
    taken: HashMap<String, usize>,
}

impl UniqueNames {
    /// The wanted name, if that is free, else with a number behind it; it is taken then.
    pub fn unique(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_owned();
        while self.taken.contains_key(&name.to_lowercase()) {
            let last = self.taken.entry(wanted.to_lowercase()).or_insert(1);
            *last += 1;
            name = format!("{wanted}_{last}");
        }
        self.taken.insert(name.to_lowercase(), 1);
        name
    }
}

impl DeckText {
    /// Adds a table; the keys of one that stands once join those before.
    pub fn add(&mut self, table: DeckTable) {
        let mut alike = self.tables.iter_mut().take(if SINGLE.contains(&table.kind) { usize::MAX } else { 0 });
        match alike.find(|known| known.kind == table.kind) {
            Some(known) => {
                known.lines.extend(table.lines);
                known.keys.extend(table.keys);
            }
            None => self.tables.push(table),
        }
    }

    /// Adds a table with its stages, `None` for all. Without any stage it adds none.
    pub fn add_in(&mut self, table: DeckTable, stages: Option<Vec<String>>) {
        if stages.as_ref().is_none_or(|stages| !stages.is_empty()) {
            self.add(table.in_stages(stages.as_deref()));
        }
    }

    /// A name that nothing else in the deck has: the wanted one, if that is free, else with a word behind it.
    pub fn unique_or(&mut self, wanted: &str, word: &str) -> String {
        match self.names.taken.contains_key(&wanted.to_lowercase()) {
            true => self.unique(&format!("{wanted}_{word}")),
            false => self.unique(wanted),
        }
    }

    /// A name that nothing else in the deck has: the wanted one, if that is free, else with a number behind it.
    pub fn unique(&mut self, wanted: &str) -> String {
        self.names.unique(if wanted.is_empty() { "unnamed" } else { wanted })
    }

    /// The text, below `head`; `source` tells the origin of a line.
    pub fn write(&self, head: &str, source: impl Fn(usize) -> String) -> String {
        let mut text = head.to_owned();
        for kind in ORDER {
            let mut is_first = true;
            for table in self.tables.iter().filter(|table| table.kind == kind) {
                text.push('\n');
                let shown = table.lines.iter().filter(|line| **line > 0).take(4);
                for line in shown {
                    let _ = writeln!(text, "# {}", source(*line));
                }
                if table.lines.len() > 4 {
                    let _ = writeln!(text, "# … and {} more", table.lines.len() - 4);
                }
                let _ = match () {
                    () if kind == "points" && !std::mem::take(&mut is_first) => Ok(()),
                    () if SINGLE.contains(&kind) || kind == "sets" => writeln!(text, "[{kind}]"),
                    () if NAMED.contains(&kind) => writeln!(text, "[{kind}.{}]", key(&table.name)),
                    () => writeln!(text, "[[{kind}]]"),
                };
                for (key, value) in &table.keys {
                    let _ = writeln!(text, "{key} = {value}");
                }
            }
        }
        text
    }
}

/// A name as a key of TOML: bare, or in quotes.
fn key(name: &str) -> String {
    let bare =
        !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A text in quotes.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => drop(write!(quoted, "\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// A number that reads back to the same double.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 || (1e-4..1e7).contains(&size) { format!("{:?}", x + 0.0) } else { format!("{x:e}") }
}

/// A list.
pub fn list(values: impl Iterator<Item = String>) -> String {
    format!("[{}]", values.collect::<Vec<_>>().join(", "))
}

/// A vector.
pub fn vector(x: &[f64]) -> String {
    list(x.iter().map(|x| number(*x)))
}

/// A table within a line.
pub fn inline(keys: &[(&str, String)]) -> String {
    let keys: Vec<String> = keys.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    format!("{{ {} }}", keys.join(", "))
}
