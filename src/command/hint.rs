//! What may be meant by a word that is neither a command nor a deck.

use crate::names::nearest;

/// The commands, as they are written.
pub const COMMANDS: [&str; 6] = ["run", "check", "compare", "report", "study", "schema"];

/// What may be meant by a word that should be a command and is no file.
pub fn command_hint(word: &str) -> Option<String> {
    if word.contains(['.', '/', '\\']) || word.starts_with('-') {
        return None;
    }
    Some(match nearest(word, COMMANDS.into_iter()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the commands are {}; a deck is a TOML file", COMMANDS.join(", ")),
    })
}
