//! Building blocks of the deck's tables: sorts of values, and tables with keys that depend on their kind. Rooms of kinds write their keys
//! with it, and the deck its tables. Each sort of value describes its valid input in `expecting`.

mod column_name;
mod directions;
mod flag_or_table;
mod frequencies;
pub mod kinds;
mod ladder;
mod named;
mod number_or_table;
mod number_or_word;
mod numbers;
mod one_or_many;
mod table;

pub use column_name::ColumnName;
pub use directions::Directions;
pub use flag_or_table::FlagOrTable;
pub use frequencies::{Frequencies, FrequencyRange, Spacing};
pub use ladder::{Ladder, PER_DECADE, Rungs, rungs};
pub use named::Named;
pub use number_or_table::NumberOrTable;
pub use number_or_word::{NumberOr, NumberOrAuto, TimeOrEnd};
pub use numbers::{Numbers, Vector};
pub use one_or_many::{Item, Names, OneOrMany};
pub use table::Table;

use crate::diagnostic::At;

/// A key that may be left out.
pub type Maybe<T> = Option<At<T>>;
