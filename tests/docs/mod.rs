//! Pages in step with the program. What is generated or included is compared with what is written; UPDATE_DOCS=1 writes it anew.
//!
//! - `<!-- include PATH | FIRST | LAST -->` before a block: lines of a file, from the one that begins with FIRST to the next that
//!   begins with LAST, or the whole file;
//! - docs/deck.md: every table and key, from the JSON Schema of the deck;
//! - docs/results.md: every column of every table of results, from their registry;
//! - docs/validation.md: what decks expect and what comes out, handed over by the test that runs them all;
//! - docs/gallery.md: every deck, with its title and its picture;
//! - docs/import.md: what becomes of each keyword of other programs, from their table;
//! - every ```toml block: a deck where it has `[analysis]`, else words that a deck may have;
//! - every command in a ```sh block, every link.

mod book;
mod deck;
mod examples;
mod gallery;
mod keywords;
mod pages;
mod prose;
mod results;
mod validation;

pub use pages::tutorial;
pub use validation::{Validated, keep_validation};

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Fails where a file is not what it should be, or makes it so.
fn keep(page: &str, wanted: &str) {
    let path = root().join(page);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        return fs::write(&path, wanted).unwrap_or_else(|error| panic!("{page}: {error}"));
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    if found != wanted {
        let differs = found.lines().zip(wanted.lines()).find(|(a, b)| a != b);
        panic!(
            "{page} is out of step: UPDATE_DOCS=1 cargo test --test all -- docs decks writes it anew; first difference {differs:?}"
        );
    }
}

/// A page with another text between its marks.
fn with_generated(page: &str, generated: &str) -> String {
    let (before, rest) = page.split_once("<!-- generated").expect("a mark where generated text begins");
    let (mark, rest) = rest.split_once("-->\n").expect("the end of the mark");
    let (_, after) = rest.split_once("<!-- end of generated -->").expect("a mark where generated text ends");
    format!("{before}<!-- generated{mark}-->\n{generated}<!-- end of generated -->{after}")
}

/// Pages that are read by people, generated ones too.
fn pages() -> Vec<PathBuf> {
    let docs = fs::read_dir(root().join("docs")).expect("docs/").map(|entry| entry.unwrap().path());
    let mut found: Vec<PathBuf> = docs.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    found.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name)));
    found.sort();
    found
}

/// A fenced block: its language, the line before it, its text.
struct Block {
    language: String,
    before: String,
    text: String,
}

fn blocks(page: &str) -> Vec<Block> {
    let (mut found, mut before, mut open): (Vec<Block>, String, Option<Block>) = (Vec::new(), String::new(), None);
    for line in page.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(language)) => {
                open = Some(Block { language: language.to_owned(), before: before.clone(), text: String::new() });
            }
            (Some(_), Some("")) => found.extend(open.take()),
            (Some(block), _) => block.text += &format!("{line}\n"),
            (None, None) => before = line.to_owned(),
        }
    }
    found
}

fn rdsolve(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("rdsolve").expect("the program");
    command.args(arguments).current_dir(root());
    command
}

/// A heading as GitHub makes it an anchor.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>();
    kept.trim().replace(' ', "-")
}

/// As it stands in a row of a table.
fn cell(text: &str) -> String {
    text.replace('\n', " ").replace('|', "\\|")
}
