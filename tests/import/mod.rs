//! Files of Abaqus and CalculiX as decks: values that come out, verdicts, and the command.

mod coming_from;
mod command;
mod constraints;
mod dresses;
mod keywords;
mod mapping;
mod mesh_makers;
mod model_changes;
mod pretension;
mod robots;
mod round_trip;
mod rows;
mod silent;
mod steady_motions;
mod surfaces;
mod translations;
mod values;

use import::{Dialect, ImportOptions, Imported, KeywordVerdict};
use rdsolve::text_file::Text;

/// What a file becomes.
pub fn imported(text: &str) -> Imported {
    imported_from(text, None)
}

/// What a file of a program becomes.
pub fn imported_from(text: &str, dialect: Option<Dialect>) -> Imported {
    let options = ImportOptions { dialect, units: None, mesh_file: "a.mesh.inp".to_owned() };
    import::import(&mut Text::new("a.inp", text.as_bytes()), &options)
}

/// Reasons of what a file has that is refused.
pub fn refusals(imported: &Imported) -> Vec<String> {
    reasons(imported, KeywordVerdict::Refused)
}

/// The texts of a verdict.
pub fn reasons(imported: &Imported, verdict: KeywordVerdict) -> Vec<String> {
    let rows = imported.verdicts.rows.iter().filter(|row| row.verdict == verdict);
    rows.map(|row| format!("{} {}: {}", row.line, row.keyword, row.text)).collect()
}

/// Tables of a deck without comments.
pub fn tables(deck: &str) -> String {
    let lines = deck.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    lines.fold(String::new(), |text, line| text + line + "\n")
}

/// The names and the texts of the files beside this one.
pub fn decks() -> Vec<(String, String)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import/decks");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let name = |path: &std::path::Path| path.file_stem().unwrap().to_str().unwrap().to_owned();
    paths.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect()
}

/// The text of a file beside this one.
pub fn deck(name: &str) -> String {
    decks().into_iter().find(|(known, _)| known == name).unwrap_or_else(|| panic!("{name}")).1
}
