//! Output: results for scripts on standard output, diagnostics on standard error.

use super::exit::Exit;
use base::diagnostic::{Diagnostic, Source, plain};
use base::names::joined;
use std::collections::HashMap;
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Writes results for a script to standard output. A reader that has gone away is no fault.
///
/// # Errors
/// [`Exit::InputOutput`] where standard output cannot be written; the reason has been shown.
pub fn print(text: &str) -> Result<(), Exit> {
    match std::io::stdout().lock().write_all(plain(text).as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot write to standard output: {error}"));
            Err(Exit::InputOutput)
        }
        _ => Ok(()),
    }
}

/// The number of errors, and of warnings, that are shown: nobody reads on, and a deck of a million lines may have as many.
const SHOWN: usize = 50;

/// The number of lines that are listed of diagnostics with the same words.
const LINES: usize = 20;

/// Draws diagnostics on standard error. Diagnostics with the same words are drawn once, with all their lines. Where there are very many, it draws
/// the first of each severity and says how many more there are.
pub fn show(problems: &[Diagnostic], source: &Source) {
    let (mut drawn, mut left) = ([0_usize; 3], [0_usize; 3]);
    for alike in alike(problems, source) {
        let kind = alike[0].severity as usize;
        if drawn[kind] == SHOWN {
            left[kind] += alike.len();
            continue;
        }
        drawn[kind] += 1;
        match shows_json() {
            true => write(&alike[0].json(source)),
            false => write(&format!("{}\n", merged(&alike, source).draw(source, is_styled()))),
        }
    }
    for (count, thing) in left.into_iter().zip(["error", "warning", "note"]) {
        if count > 0 {
            say(&format!("… and {}\n", counted(count, &format!("more {thing}"))));
        }
    }
}

/// Diagnostics with the same words about the same file, in the order of their first ones; as JSON each is alone.
fn alike<'p>(problems: &'p [Diagnostic], source: &'p Source) -> Vec<Vec<&'p Diagnostic>> {
    let mut groups: Vec<Vec<&Diagnostic>> = Vec::new();
    let mut known = HashMap::new();
    for problem in problems {
        let words = (problem.severity, problem.message.as_str(), &problem.hints, problem.file(source));
        match *known.entry(words).or_insert(groups.len()) {
            group if group < groups.len() && !shows_json() => groups[group].push(problem),
            _ => groups.push(vec![problem]),
        }
    }
    groups
}

/// The first of alike diagnostics, with the lines of the others.
fn merged(alike: &[&Diagnostic], source: &Source) -> Diagnostic {
    let others = alike[1..].iter().take(LINES).filter_map(|problem| problem.position(source));
    let mut lines: Vec<String> = others.map(|(_, line, _)| line.to_string()).collect();
    let mut first = alike[0].clone();
    if !lines.is_empty() {
        let noun = if lines.len() == 1 { "line" } else { "lines" };
        let more = (alike.len() - 1).saturating_sub(LINES);
        lines.extend((more > 0).then(|| format!("{more} more")));
        let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
        first.hints = first.remedies();
        first.hints.push(format!("the same in {noun} {}", joined(&lines)));
    }
    first
}

/// Writes an error that has no place in a deck to standard error.
pub fn complain(message: &str) {
    if shows_json() {
        return write(&message_as_json("error", message));
    }
    let (bold, normal) = if is_styled() { ("\u{1b}[1m\u{1b}[91m", "\u{1b}[0m") } else { ("", "") };
    write(&format!("{bold}error{normal}: {}", plain(message)));
}

/// Writes a line to standard error.
pub fn say(line: &str) {
    write(&if shows_json() { message_as_json("note", line.trim()) } else { plain(line).into_owned() });
}

/// Whether diagnostics are shown as JSON: decided once, as the program begins.
static JSON: AtomicBool = AtomicBool::new(false);

/// Shows diagnostics as JSON from here on, one object a line.
pub fn show_json() {
    JSON.store(true, Ordering::Relaxed);
}

fn shows_json() -> bool {
    JSON.load(Ordering::Relaxed)
}

/// A message without a place as one line of JSON.
fn message_as_json(severity: &str, message: &str) -> String {
    serde_json::json!({ "severity": severity, "message": message }).to_string()
}

/// Writes a styled line to standard error; a failure to write cannot be reported anywhere.
fn write(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A number with its noun in the singular or the plural: "1 error", "2 errors".
pub fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// Whether bold and colours are shown: on a terminal, unless the user objects by `NO_COLOR` (no-color.org).
fn is_styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
