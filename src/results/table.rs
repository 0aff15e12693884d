//! The definition of a table of results: its file, its columns and how a frame becomes rows. Whatever lists, writes, compares
//! or describes tables reads this and nothing else of them.

use super::extent::{Extent, Rows};
use base::quantities::{Column, STEP, TIME};
use model::{ExpectAt, Model};
use solve::{Frame, Wanted};
use std::io;

/// The name of the column behind `step` and `time` that tables of a deck with stages have.
pub const STAGE: &str = "stage";

/// The name of the column behind these that tables of a deck with load cases have.
pub const CASE: &str = "case";

/// The name of the column with the names of the sets of a node.
pub const SET: &str = "set";

pub use model::BETWEEN_SETS;

/// True for a key column that names the subject of a row in any stage: where curves go on, and whatever asked for the row.
pub fn names_subject(column: &str) -> bool {
    column != STAGE && column != SET
}

/// A function that writes the rows of one frame. It is made once a run, so that it can store constants of the scene.
pub type WriteRows = Box<dyn Fn(&mut dyn WriteRow, &Frame) -> io::Result<()>>;

/// Receives the rows of a table, field by field: a file, or an account of the numbers.
pub trait WriteRow {
    /// False where nobody reads the rows with this first key.
    fn reads(&self, _subject: &str) -> bool {
        true
    }

    /// Begins a row with the two columns that every table has.
    fn row(&mut self, step: usize, time: f64) -> &mut dyn WriteRow;

    /// Adds a field with a whole number.
    fn count(&mut self, value: usize) -> &mut dyn WriteRow;

    /// Adds a field with a number; it stays empty where the number is not finite.
    fn number(&mut self, value: f64) -> &mut dyn WriteRow;

    /// Adds a field with a number; without one the field is empty, and no message counts it.
    fn optional(&mut self, value: Option<f64>) -> &mut dyn WriteRow {
        match value {
            Some(value) => self.number(value),
            None => self.text(""),
        }
    }

    /// Adds a field for each of several numbers.
    fn numbers(&mut self, values: &[f64]) -> &mut dyn WriteRow;

    /// Adds a field with a text.
    fn text(&mut self, text: &str) -> &mut dyn WriteRow;

    /// Ends a row.
    ///
    /// # Errors
    /// It cannot be kept.
    fn end(&mut self) -> io::Result<()>;
}

/// A kind of table: one constant in a separate file, and one line of [`super::TABLES`].
pub struct TableKind {
    /// The name of the file in the output folder.
    pub file: &'static str,
    /// The subject of a row and the condition for the table, in whole sentences.
    pub about: &'static str,
    /// The columns behind `step` and `time`, group by group.
    pub columns: &'static [&'static [Column]],
    /// Whether the deck requests the table and the scene has rows for it.
    pub wanted: fn(&Model) -> bool,
    /// The quantities that the solver must compute for its rows.
    pub needs: Wanted,
    /// Whether a deck has its last column.
    pub has_last: fn(&Model) -> bool,
    /// True if it receives every accepted step, for rows that sum all steps since the row before.
    pub every_step: bool,
    /// The approximate number of rows and columns at one time.
    pub extent: fn(&Extent) -> Rows,
    /// Makes the function that writes its rows for one model.
    pub rows: fn(&Model) -> WriteRows,
    /// The quantities that `[[expect]]` may request of the things in its rows.
    pub answers: Option<Answers>,
}

/// The quantities of the things in the rows of a table for `[[expect]]`: at any step, even if the table is not written.
pub struct Answers {
    /// The names of the quantities of one thing; empty where the table knows nothing of it.
    pub quantities: fn(ExpectAt) -> Vec<&'static str>,
    /// The quantities that the solver must compute for them.
    pub needs: Wanted,
    /// The value of one of these quantities, given by its index, where the frame has it.
    pub value: fn(ExpectAt, usize, &Frame) -> Option<f64>,
}

impl TableKind {
    /// All columns in their order, `step` and `time` first.
    pub fn columns(&self) -> impl Iterator<Item = Column> {
        [STEP, TIME].into_iter().chain(self.columns.iter().copied().flatten().copied())
    }

    /// The columns that a scene has.
    pub fn columns_of(&self, model: &Model) -> impl Iterator<Item = Column> {
        let left_out = usize::from(!(self.has_last)(model));
        self.columns().take(self.columns().count() - left_out)
    }

    /// The names in the header row; in a deck of stages or of load cases, each row names its own.
    pub fn header(&self, model: &Model) -> Vec<&'static str> {
        let mut names: Vec<&str> = self.columns_of(model).map(|column| column.name).collect();
        if !model.cases.list.is_empty() {
            names.insert(2, CASE);
        }
        if model.analysis.stage.is_some() {
            names.insert(2, STAGE);
        }
        names
    }
}
