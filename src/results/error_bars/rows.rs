//! The rows of one table at one time, as numbers.

use crate::table::{TableKind, WriteRow, names_subject};
use base::quantities::Column;
use model::Model;
use std::io;

/// Collects the rows of one frame. Its memory is kept from frame to frame.
pub struct CollectedRows {
    /// All columns after `step` and `time`.
    columns: Vec<Column>,
    /// True where rows are about elements: other meshes have others.
    by_element: bool,
    /// The field that comes next, counted behind `step` and `time`.
    field: usize,
    /// The numbers, row after row; NaN where there is none.
    numbers: Vec<f64>,
    /// The keys of all rows, each field followed by a space, ...
    keys: String,
    /// ... and where those of each row end.
    ends: Vec<usize>,
}

impl CollectedRows {
    /// No rows of this table of a scene.
    pub fn new(kind: &TableKind, model: &Model) -> CollectedRows {
        let columns = kind.columns_of(model).skip(2).collect();
        let by_element = kind.columns().any(|column| column.name == "element");
        CollectedRows { columns, by_element, field: 0, numbers: Vec::new(), keys: String::new(), ends: Vec::new() }
    }

    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.numbers.clear();
        self.keys.clear();
        self.ends.clear();
    }

    /// All numbers, row after row, [`CollectedRows::width`] in each.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// The number of columns with numbers.
    pub fn width(&self) -> usize {
        self.columns.iter().filter(|column| !column.is_key()).count()
    }

    /// The subject of a row: its keys, separated by spaces.
    pub fn label(&self, row: usize) -> &str {
        let end = self.ends.get(row).copied().unwrap_or(0);
        let start = row.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        self.keys[start..end].trim_end()
    }

    /// The number of a subject in a column: in this row if the subject agrees, else in the first row that agrees. In another mesh, nodes
    /// between named points and elements lie elsewhere, so for these it is that of largest magnitude in the column.
    pub fn find(&self, (row, label): (usize, &str), column: usize, same_mesh: bool) -> Option<f64> {
        let same_rows = self.ends.get(row).is_some() && self.label(row) == label;
        if !same_mesh && (self.by_element || label.ends_with(']')) {
            let all = (0..self.ends.len()).filter_map(|row| self.number_at(row, column));
            return all.reduce(|most, number| if number.abs() > most.abs() { number } else { most });
        }
        let row = if same_rows { Some(row) } else { (0..self.ends.len()).find(|&row| self.label(row) == label) };
        self.number_at(row?, column)
    }

    /// The number in a row and a column of numbers.
    fn number_at(&self, row: usize, column: usize) -> Option<f64> {
        self.numbers.get(row * self.width() + column).copied()
    }

    fn add_key(&mut self, text: &str) {
        if self.columns.get(self.field).is_some_and(|column| names_subject(column.name)) {
            self.keys.push_str(text);
            self.keys.push(' ');
        }
        self.field += 1;
    }

    fn add_number(&mut self, value: f64) {
        self.numbers.push(value);
        self.field += 1;
    }

    fn is_at_key(&self) -> bool {
        self.columns.get(self.field).is_some_and(Column::is_key)
    }
}

impl WriteRow for CollectedRows {
    fn row(&mut self, _: usize, _: f64) -> &mut dyn WriteRow {
        self.field = 0;
        self
    }

    fn count(&mut self, value: usize) -> &mut dyn WriteRow {
        if self.is_at_key() {
            self.add_key(&value.to_string())
        } else {
            self.add_number(value as f64)
        }
        self
    }

    fn number(&mut self, value: f64) -> &mut dyn WriteRow {
        if self.is_at_key() {
            self.add_key(&value.to_string())
        } else {
            self.add_number(value)
        }
        self
    }

    fn numbers(&mut self, values: &[f64]) -> &mut dyn WriteRow {
        for value in values {
            self.number(*value);
        }
        self
    }

    fn text(&mut self, text: &str) -> &mut dyn WriteRow {
        if self.is_at_key() {
            self.add_key(text)
        } else {
            self.add_number(f64::NAN)
        }
        self
    }

    fn end(&mut self) -> io::Result<()> {
        self.ends.push(self.keys.len());
        Ok(())
    }
}
