//! Sweeps: many variants of one deck in one folder, which any number of processes may fill at once.
//!
//! [`file`] is the text that asks for it, [`cases`] the variants that follow, [`sampling`] the points of a sample, [`collect`] the numbers
//! that are read from the results of each, [`case_state`] what became of a case, [`folder`] where all that stands, and a
//! page of it, [`marks`] what says that a case does, [`records`] what is kept of cases whose folders are not.

#![warn(missing_docs)]

pub mod case_state;
pub mod cases;
pub mod collect;
pub mod file;
pub mod folder;
pub mod marks;
mod page;
pub mod records;
pub mod sampling;
