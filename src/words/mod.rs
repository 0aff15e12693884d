//! What tables of the deck are made of: sorts of values, and tables whose keys depend on the kind they name. Rooms of kinds
//! write their keys with it, and the deck its tables.

pub mod kinds;
mod values;

pub use values::*;
