//! What may be meant by a word that is neither a command nor a deck.

use crate::names::nearest;

/// The commands, as they are written.
pub const COMMANDS: [&str; 6] = ["run", "check", "compare", "report", "study", "schema"];

/// What may be meant by a word that is neither a command nor the name of a file.
pub fn command_hint(word: &str) -> Option<String> {
    if COMMANDS.contains(&word) || word.contains(['.', '/', '\\']) || word.starts_with('-') {
        return None;
    }
    Some(match nearest(word, COMMANDS) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the commands are {}; a deck is a TOML file", COMMANDS.join(", ")),
    })
}
