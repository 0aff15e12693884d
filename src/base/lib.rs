//! Numbers, names, words and texts: the crate below all others.

#![warn(missing_docs)]

pub mod diagnostic;
pub mod math;
pub mod names;
pub mod quantities;
pub mod row_text;
pub mod snapshot;
pub mod text_file;
pub mod words;
