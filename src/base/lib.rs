//! Numbers, names, words and texts: what every other crate builds on, and what knows none of them.

#![warn(missing_docs)]

pub mod diagnostic;
pub mod math;
pub mod names;
pub mod quantities;
pub mod snapshot;
pub mod text_file;
pub mod words;
