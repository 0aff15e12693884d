//! The files of the output folder, and what reads them.

mod compare;
mod drifts;
mod error_bars;
mod expect;
mod files;
mod folder;
mod report;
mod resultants;
mod stresses;
mod table_size;
mod torn;
