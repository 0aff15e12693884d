//! What is printed: results for a script on standard output, diagnostics on standard error.

use super::exit::Exit;
use crate::diagnostic::{Diagnostic, Source};
use std::io::{IsTerminal, Write};

/// Results for a script, on standard output. A reader that has gone away is no fault.
pub fn print(text: &str) -> Result<(), Exit> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot write to standard output: {error}"));
            Err(Exit::InputOutput)
        }
        _ => Ok(()),
    }
}

/// Draws diagnostics on standard error.
pub fn show(problems: &[Diagnostic], source: &Source) {
    for problem in problems {
        say(&format!("{}\n", problem.draw(source, is_styled())));
    }
}

/// An error that has no place in a deck.
pub fn complain(message: &str) {
    let (bold, plain) = if is_styled() { ("\u{1b}[1m\u{1b}[91m", "\u{1b}[0m") } else { ("", "") };
    say(&format!("{bold}error{plain}: {message}"));
}

/// One line on standard error; there is nowhere to report that it cannot be written.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// "1 error", "2 errors".
pub fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

fn is_styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
