//! Mechanics of nodes, elements and constraints, which know neither a deck nor a matrix of the whole.

#![warn(missing_docs)]

pub mod amplitude;
pub mod constraints;
pub mod elements;
pub mod integrators;
pub mod materials;
pub mod sections;
pub mod solids;
pub mod state;
