//! Where things are: nodes, and the names and frames by which tables of the deck say places.

pub mod axes;
pub mod cells;
pub mod ends;
pub mod nearest_nodes;
pub mod nodes;
pub mod place;
pub mod spot;
