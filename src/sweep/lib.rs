//! Sweeps: many variants of one deck in one folder, which any number of processes may fill at once.
//!
//! [`file`] reads the text, [`names`] checks its names, [`cases`] makes the variants, and [`sampling`] the points of a sample. [`case_state`] is the
//! state of a case with its warnings; [`alike`] merges those of many. [`folder`] holds all cases and their page, [`marks`] marks complete cases, and
//! [`records`] keep cases without folders.

#![warn(missing_docs)]

pub mod alike;
pub mod case_state;
pub mod cases;
pub mod file;
pub mod folder;
pub mod marks;
pub mod names;
mod page;
pub mod records;
pub mod sampling;
