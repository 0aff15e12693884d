//! Output: results for scripts on standard output, diagnostics on standard error.

use super::exit::Exit;
use base::diagnostic::{Diagnostic, Source, plain};
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

/// Draws diagnostics on standard error. Where there are very many, it draws the first of each severity and says how many more
/// there are.
pub fn show(problems: &[Diagnostic], source: &Source) {
    let mut counts = [0_usize; 3];
    for problem in problems {
        let count = &mut counts[problem.severity as usize];
        *count += 1;
        if *count <= SHOWN {
            match shows_json() {
                true => write(&problem.json(source)),
                false => write(&format!("{}\n", problem.draw(source, is_styled()))),
            }
        }
    }
    for (count, thing) in counts.into_iter().zip(["error", "warning", "note"]) {
        if count > SHOWN {
            say(&format!("… and {}\n", counted(count - SHOWN, &format!("more {thing}"))));
        }
    }
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
