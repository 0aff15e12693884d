//! What is printed: results for a script on standard output, diagnostics on standard error.

use super::exit::Exit;
use crate::diagnostic::{Diagnostic, Severity, Source, plain};
use std::io::{IsTerminal, Write};

/// Results for a script, on standard output. A reader that has gone away is no fault.
pub fn print(text: &str) -> Result<(), Exit> {
    match std::io::stdout().lock().write_all(plain(text).as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot write to standard output: {error}"));
            Err(Exit::InputOutput)
        }
        _ => Ok(()),
    }
}

/// Errors that are shown, and warnings: nobody reads on, and a deck of a million lines may have as many.
const SHOWN: usize = 50;

/// Draws diagnostics on standard error; of very many the first of each severity, and how many more there are.
pub fn show(problems: &[Diagnostic], source: &Source) {
    let mut counts = [0_usize; 2];
    for problem in problems {
        let count = &mut counts[usize::from(problem.severity == Severity::Warning)];
        *count += 1;
        if *count <= SHOWN {
            write(&format!("{}\n", problem.draw(source, is_styled())));
        }
    }
    for (count, thing) in counts.into_iter().zip(["error", "warning"]) {
        if count > SHOWN {
            say(&format!("… and {}\n", counted(count - SHOWN, &format!("more {thing}"))));
        }
    }
}

/// An error that has no place in a deck.
pub fn complain(message: &str) {
    let (bold, normal) = if is_styled() { ("\u{1b}[1m\u{1b}[91m", "\u{1b}[0m") } else { ("", "") };
    write(&format!("{bold}error{normal}: {}", plain(message)));
}

/// One line on standard error.
pub fn say(line: &str) {
    write(&plain(line));
}

/// A line as it is, with what styles it; there is nowhere to report that it cannot be written.
fn write(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// "1 error", "2 errors".
pub fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

fn is_styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
