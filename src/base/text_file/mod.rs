//! Text files that a deck names: read whole, line by line, each word with its place for messages.

pub mod cards;
mod file;
pub mod foreign;
pub mod includes;
mod text;

pub use file::{open_regular, read_regular, read_text};
pub use text::{Fault, Piece, Text, TextLine, Word, Words};
