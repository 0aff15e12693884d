//! The outcome of the run as tables that need no script: status, plan, counts, expectations, the deck.

use super::html::{escaped, table};
use crate::log;
use base::diagnostic::composed;
use base::names::short;
use base::quantities::{Unit, UnitSystem};
use base::text_file::read_text;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// The outcome of a run from result.json, or from the log of an unfinished run.
pub struct Result {
    /// The object in result.json; null where there is no such file.
    pub json: Value,
    /// The path of the deck, as it was given.
    pub deck: Option<String>,
    /// The text of the deck, if it can be found and is that of this run to the last byte.
    pub text: Option<String>,
}

impl Result {
    /// The outcome of the run in a folder, given its result.json. The deck is looked for where its path leads from here, and
    /// beside the folder.
    pub fn of(folder: &Path, json: Value) -> Result {
        let deck = json["deck"].as_str().map(str::to_owned).or_else(|| deck_of_log(&folder.join(log::NAME)));
        let sets: Vec<&str> = json["sets"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let hash = json["deck_hash"].as_str().unwrap_or_default();
        let beside = folder.parent().map(Path::to_path_buf).unwrap_or_default();
        let found = deck.iter().flat_map(|deck| [PathBuf::from(deck), beside.join(deck)]);
        let text = found.filter_map(|path| read_text(path).ok()).find(|text| digest(&composed(text), &sets) == hash);
        Result { json, deck, text }
    }

    /// The system of units of the deck.
    pub fn units(&self) -> Option<&'static UnitSystem> {
        UnitSystem::find(self.json["units"].as_str()?)
    }

    /// The symbol of time behind a blank; empty without units, and in statics, where the time counts load steps.
    pub fn clock(&self) -> String {
        let plan = self.json["plan"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let moves = plan.map(str::trim_start).any(|line| line.starts_with("analysis    dynamic"));
        self.units().filter(|_| moves).map_or(String::new(), |units| format!(" {}", Unit::Time.text(Some(units))))
    }

    /// The title of the deck; without one, the name of the deck or of the folder.
    pub fn title(&self, folder: &Path) -> String {
        let stem = |path: &Path| path.file_stem().map(|name| name.to_string_lossy().into_owned());
        match self.json["title"].as_str() {
            Some(title) if !title.is_empty() => title.to_owned(),
            _ => {
                let deck = self.deck.as_deref().map(Path::new).filter(|deck| !deck.ends_with("deck.toml"));
                let folder = folder.file_name().map(|name| name.to_string_lossy().into_owned());
                deck.and_then(stem).or(folder).unwrap_or_else(|| "Results".into())
            }
        }
    }

    /// A badge with the status, and the reason, as HTML.
    pub fn status(&self) -> String {
        let Some(status) = self.json["status"].as_str() else {
            return "<p><span class=\"badge bad\">unfinished</span> There is no result.json: the run is still going, or was \
                    killed. What its files hold is shown.</p>\n"
                .into();
        };
        let class = if status == "done" { "good" } else { "bad" };
        let reason = escaped(self.json["reason"].as_str().unwrap_or_default());
        format!("<p><span class=\"badge {class}\">{}</span> {reason}</p>\n", escaped(status))
    }

    /// A table of the expectations as HTML; empty where the deck has none.
    pub fn expectations(&self) -> String {
        let Some(list) = self.json["expectations"].as_array().filter(|list| !list.is_empty()) else {
            return String::new();
        };
        let number = |value: &Value| value.as_f64().map_or(String::new(), significant);
        let rows: Vec<Vec<String>> = list
            .iter()
            .map(|one| {
                let kind = if one["relative"].as_bool() == Some(true) { "relative" } else { "absolute" };
                let tolerance = one["tolerance"].as_f64().map_or(String::new(), |t| format!("{} {kind}", short(t)));
                let bound = one["bound"].as_str().map_or(String::new(), |bound| format!("{bound} "));
                vec![
                    one["label"].as_str().unwrap_or_default().into(),
                    if one["passed"].as_bool() == Some(true) { "ok" } else { "MISSED" }.into(),
                    number(&one["value"])
                        + &["step_error", "mesh_error"]
                            .map(|key| one[key].as_f64().map_or(String::new(), |bar| format!(" ± {}", short(bar))))
                            .concat(),
                    bound + &number(&one["expected"]),
                    one["error"].as_f64().map_or(String::new(), short),
                    tolerance,
                    one["reason"].as_str().or(one["source"].as_str()).unwrap_or_default().into(),
                ]
            })
            .collect();
        let head = ["expected of the run", "verdict", "value", "expected", "error", "tolerance", "source"];
        format!("<section><h2>Expectations</h2>\n{}</section>\n", table(&head, &rows))
    }

    /// A table of sizes, counts, times and origin as HTML.
    pub fn numbers(&self) -> String {
        let mut rows: Vec<Vec<String>> = Vec::new();
        let mut row = |name: &str, value: String| rows.push(vec![name.to_owned(), value]);
        let numbers = ["sizes", "counts"].into_iter().flat_map(|key| self.json[key].as_object().into_iter().flatten());
        for (key, value) in numbers {
            row(key, value.to_string());
        }
        for (key, value) in self.json["timings"].as_object().into_iter().flatten() {
            let name = key.strip_suffix("_s").unwrap_or(key);
            row(
                &format!("{name} time"),
                value.as_f64().map_or(String::new(), |seconds| format!("{} s", short(seconds))),
            );
        }
        if let Some(bytes) = self.json["peak_memory_bytes"].as_f64() {
            row("peak memory", format!("{:.1} MB", bytes / 1e6));
        }
        for (key, name) in [("joint_violation", "largest gap of a joint"), ("rotation_drift", "rotation drift")] {
            if let Some(value) = self.json[key].as_f64() {
                row(name, short(value));
            }
        }
        row("rdsolve", self.json["version"].as_str().unwrap_or("?").to_owned());
        row("deck", self.deck.clone().unwrap_or_else(|| "?".into()));
        for set in self.json["sets"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            row("--set", set.to_owned());
        }
        row("SHA-256", self.json["deck_hash"].as_str().unwrap_or("?").to_owned());
        format!("<section><h2>Counts and times</h2>\n{}</section>\n", table(&[], &rows))
    }

    /// The warnings, the plan and the deck as HTML.
    pub fn texts(&self) -> String {
        let lines = |key: &str| -> Vec<&str> {
            self.json[key].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
        };
        let warnings: String = lines("warnings").iter().map(|text| format!("<li>{}</li>\n", escaped(text))).collect();
        let warnings = if warnings.is_empty() { warnings } else { format!("<h2>Warnings</h2>\n<ul>{warnings}</ul>\n") };
        let deck = match (&self.text, &self.deck) {
            (Some(text), _) => format!("<details><summary>Deck</summary>\n<pre>{}</pre></details>\n", escaped(text)),
            (None, Some(deck)) => format!(
                "<p class=\"note\">The text of <code>{}</code> is not shown: it is not there, has changed since, or has a \
                 mesh file.</p>\n",
                escaped(deck)
            ),
            (None, None) => String::new(),
        };
        let plan = lines("plan").join("\n");
        let plan = if plan.is_empty() { plan } else { format!("<h2>Plan</h2>\n<pre>{}</pre>\n", escaped(&plan)) };
        format!("<section>{warnings}{plan}{deck}</section>\n")
    }
}

/// A number to seven significant digits.
fn significant(number: f64) -> String {
    let rounded: f64 = format!("{number:.6e}").parse().unwrap_or(number);
    match rounded.abs() {
        size if size == 0.0 || (1e-4..1e9).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// The hash of a deck without a mesh, as a run computes it.
fn digest(text: &str, sets: &[&str]) -> String {
    let mut hasher = Sha256::new();
    hasher.update(text);
    for set in sets {
        hasher.update([0]);
        hasher.update(set);
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The deck that a run has named in the first line of its log.
fn deck_of_log(path: &Path) -> Option<String> {
    let log = read_text(path).ok()?;
    Some(log.lines().next()?.split_once(", deck ")?.1.to_owned())
}
