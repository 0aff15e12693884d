//! The files of the output folder, and what reads them back: comparisons, reports.
//!
//! A table is one file of [`tables`] and one line of its list. [`Files`] opens the tables of the deck and passes every accepted step to
//! each. Errors name the file.

#![warn(missing_docs)]

pub mod checkpoint;
pub mod collected;
pub mod compare;
pub mod curve;
mod disk;
mod envelopes;
pub mod error_bars;
pub mod expect;
pub mod extent;
pub mod fields;
mod files;
mod folder;
mod frd;
mod lock;
pub mod log;
pub mod low_pass;
pub mod marks;
pub mod matrix_market;
pub mod observed;
pub mod progress;
pub mod report;
mod response_rows;
pub mod result_json;
mod run_list;
mod shared_lock;
mod shell_stresses;
pub mod summary;
pub mod table;
mod table_file;
pub mod table_reader;
pub mod table_size;
pub mod tables;
mod torn;
mod vtu;

pub use disk::{at, make_safe, replace};
pub use files::{Files, FilesMark, RunKeeps, listed, wanted, wanted_with};
pub use folder::claim;
pub use folder::{holds_run, remove, remove_empty, remove_run};
pub use lock::{FolderLock, host};
pub use shared_lock::SharedLock;
pub use table_size::{expected_sizes, settle_cadence};
pub use tables::TABLES;
pub use torn::torn_tables;
