//! The model: nodes, bodies, elements, links, constraints and loads, as plain data in deck order. Built once from the deck, never changed;
//! everything downstream borrows it.

#![warn(missing_docs)]

mod amplitudes;
mod attachments;
mod bars;
mod beams;
mod bodies;
mod build;
mod cases;
mod contacts;
mod data;
mod environment;
mod equations;
mod expects;
mod group_names;
mod groups;
mod initial;
mod joints;
mod links;
mod loads;
mod masses;
mod materials;
mod merge_diagnostics;
pub mod mesh;
mod mesh_file;
mod meshed_sections;
mod motion_curves;
mod moving_frames;
mod names;
mod output;
mod own_damping;
mod part_context;
mod parts;
mod places;
mod plausibility;
mod procedure;
pub mod record;
mod records;
mod reduced;
mod reinforcement;
mod report;
mod rigid;
mod scene;
mod sections;
mod shells;
mod stages;
mod superelements;
mod supports;
mod ties;
mod values;

/// Internals of the model for tests.
pub mod inner {
    pub use crate::beams::grading::cuts;
    pub use crate::contacts::mesh_edges::{MeshEdge, mesh_edges};
    pub use crate::places::cells::Cells;
    pub use crate::plausibility::unseen_record::missed;
}

pub use build::{build_read, read, read_stages, replan};
pub use data::*;
pub use mesh_file::Input;
pub use plausibility::loose::holds_all;
pub use procedure::study;
pub use records::{Record, load_records};
pub use superelements::rigid_motion::{SuperelementMatrices, WrongMatrix, settle};
