//! What decks mean, and what is said of them.

mod attachments;
mod build;
mod cells;
mod concrete;
mod damping;
mod grading;
mod line_loads;
mod mesh_edges;
mod normals;
mod output;
mod plausibility;
mod record;
mod records;
mod releases;
mod rotations;
mod scaled_loads;
mod superelements;
mod tables_of_positions;
mod unseen_record;
