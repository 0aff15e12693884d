//! Positions: nodes, and the names and frames for places in the deck.

pub mod axes;
pub mod cells;
pub mod ends;
pub mod nearest_nodes;
pub mod nodes;
pub mod place;
pub mod spot;
