//! Envelopes: the extremes of each number of a table over load cases, row by row.

use super::table::WriteRow;
use super::table_file::TableFile;
use model::{ENVELOPE_ENDS, Model};
use std::io;

/// A field of a row.
#[derive(Debug, Clone)]
enum Field {
    Count(usize),
    Number(f64),
    Text(String),
}

/// The rows of one frame in one table.
#[derive(Debug, Default)]
struct Rows {
    list: Vec<Vec<Field>>,
    time: f64,
}

impl Rows {
    fn add(&mut self, field: Field) {
        if let Some(row) = self.list.last_mut() {
            row.push(field);
        }
    }
}

impl WriteRow for Rows {
    fn row(&mut self, _: usize, time: f64) -> &mut dyn WriteRow {
        self.time = time;
        self.list.push(Vec::new());
        self
    }

    fn count(&mut self, value: usize) -> &mut dyn WriteRow {
        self.add(Field::Count(value));
        self
    }

    fn number(&mut self, value: f64) -> &mut dyn WriteRow {
        self.add(Field::Number(value));
        self
    }

    fn numbers(&mut self, values: &[f64]) -> &mut dyn WriteRow {
        values.iter().for_each(|value| self.add(Field::Number(*value)));
        self
    }

    fn text(&mut self, text: &str) -> &mut dyn WriteRow {
        self.add(Field::Text(text.to_owned()));
        self
    }

    fn end(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The extremes over the cases of one envelope, table by table.
#[derive(Debug)]
struct Envelope {
    name: String,
    cases: Vec<usize>,
    /// The greatest and the least of each number; `None` before the first case.
    tables: Vec<Option<[Rows; 2]>>,
}

/// All envelopes of a run.
#[derive(Debug, Default)]
pub struct Envelopes(Vec<Envelope>);

impl Envelopes {
    /// Those that a model asks for.
    pub fn of(model: &Model) -> Envelopes {
        let each = model.cases.envelopes.iter();
        Envelopes(
            each.map(|of| Envelope { name: of.name.clone(), cases: of.cases.clone(), tables: Vec::new() }).collect(),
        )
    }

    /// Takes the rows of a table in a case.
    ///
    /// # Errors
    /// As for `write`, which writes them.
    pub fn take(
        &mut self,
        table: usize,
        case: usize,
        write: impl Fn(&mut dyn WriteRow) -> io::Result<()>,
    ) -> io::Result<()> {
        for envelope in self.0.iter_mut().filter(|envelope| envelope.cases.contains(&case)) {
            let mut rows = Rows::default();
            write(&mut rows)?;
            envelope.tables.resize_with(envelope.tables.len().max(table + 1), || None);
            match &mut envelope.tables[table] {
                Some([most, least]) => {
                    merge(most, &rows, f64::max);
                    merge(least, &rows, f64::min);
                }
                empty => {
                    let copy = Rows { list: rows.list.clone(), time: rows.time };
                    *empty = Some([copy, rows]);
                }
            }
        }
        Ok(())
    }

    /// Writes the extremes of a table, after the rows of all cases, of which the last has this step.
    ///
    /// # Errors
    /// The table cannot grow.
    pub fn write(&self, table: usize, last: usize, file: &mut TableFile) -> io::Result<()> {
        let mut step = last;
        for Envelope { name, tables, .. } in &self.0 {
            let Some(Some(extremes)) = tables.get(table) else { continue };
            for (rows, end) in extremes.iter().zip(ENVELOPE_ENDS) {
                file.begin_case(&format!("{name}{end}"));
                step += 1;
                for row in &rows.list {
                    file.row(step, rows.time);
                    for field in row {
                        match field {
                            Field::Count(value) => file.count(*value),
                            Field::Number(value) => file.number(*value),
                            Field::Text(text) => file.text(text),
                        };
                    }
                    file.end()?;
                }
            }
        }
        Ok(())
    }
}

/// Replaces each number by the extreme of it and its like in other rows.
fn merge(own: &mut Rows, others: &Rows, extreme: fn(f64, f64) -> f64) {
    for (own, other) in own.list.iter_mut().zip(&others.list) {
        for pair in own.iter_mut().zip(other) {
            if let (Field::Number(own), Field::Number(other)) = pair {
                *own = extreme(*own, *other);
            }
        }
    }
}
