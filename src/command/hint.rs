//! Hints for a first word that is neither a command nor a deck.

use base::names::nearest;

/// The commands, by their names on the command line.
pub const COMMANDS: [&str; 13] = [
    "run",
    "check",
    "import",
    "compare",
    "report",
    "study",
    "recommend",
    "sweep",
    "summary",
    "init",
    "schema",
    "completions",
    "man",
];

/// The hint for a word that is neither a command nor looks like the name of a file; `None` for any other word.
pub fn command_hint(word: &str) -> Option<String> {
    if COMMANDS.contains(&word) || word.contains(['.', '/', '\\']) || word.starts_with('-') {
        return None;
    }
    Some(match nearest(word, COMMANDS) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the commands are {}; a deck is a TOML file", COMMANDS.join(", ")),
    })
}
