//! The decks of the repository.

mod extreme;
mod safety_cab;
mod values;
