//! Text files that a deck names: read whole, line by line, each word with its place for messages.

mod file;
mod text;

pub use file::read_regular;
pub use text::{Fault, Text, TextLine, Word, Words};
