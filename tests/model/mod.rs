//! What decks mean, and what is said of them.

mod build;
mod damping;
mod line_loads;
mod plausibility;
mod records;
mod rotations;
mod tables_of_positions;
