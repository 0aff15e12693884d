//! A place in the rows of a table, with the numbers and names that are compared.

use crate::table_reader::{TableReader, fields, number, text};
use std::io;

/// The places, from 0, of the columns that are read.
#[derive(Debug, Clone, Default)]
pub struct Pick {
    /// The place of `step`; `None` where frames have no step.
    pub step: Option<usize>,
    /// The place of `time`; `None` where the table has no frames.
    pub time: Option<usize>,
    /// The place of the frequency in a table of a response, which has neither steps nor times.
    pub frequency: Option<usize>,
    /// The places of the key columns, which name the subject of a row.
    pub keys: Vec<usize>,
    /// The places of the columns that are compared.
    pub values: Vec<usize>,
}

/// The range of the finite numbers of a column.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// The least number.
    pub least: f64,
    /// The largest number.
    pub most: f64,
}

impl Range {
    /// The range of no number.
    pub const NONE: Range = Range { least: f64::INFINITY, most: f64::NEG_INFINITY };

    /// The range of the numbers of both.
    pub fn with(self, other: Range) -> Range {
        Range { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    /// The largest number less the least; 0 of no number.
    pub fn width(self) -> f64 {
        (self.most - self.least).max(0.0)
    }

    /// The largest absolute value; 0 of no number.
    pub fn magnitude(self) -> f64 {
        if self.most < self.least { 0.0 } else { self.most.abs().max(self.least.abs()) }
    }
}

/// The result of reading a whole table.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// The range of each picked value over the whole table.
    pub ranges: Vec<Range>,
    /// Whether the last line of the table is torn.
    pub truncated: bool,
}

/// A place in the rows of a table: it stands on one row, and goes forward.
pub struct Cursor {
    table: TableReader,
    roles: Vec<Role>,
    /// The picked values of the current row, in the order of [`Pick::values`].
    values: Vec<f64>,
    /// The key of the current row.
    key: Vec<u8>,
    /// Which response of the run the row belongs to, and its frequency.
    response: [f64; 2],
    /// True where no row is left.
    pub done: bool,
    /// The summary of the table; it is whole once all rows have been read.
    pub summary: Summary,
    /// The number, from 1, of the frame: rows that follow each other with the same step and time.
    pub frame: usize,
    /// Step and time of this frame; 0 where a table has none. Of a response, which one of the run it is, and the frequency.
    pub when: [f64; 2],
    /// Step and time of the frame before; `None` in the first.
    pub before: Option<[f64; 2]>,
    /// The number of rows so far.
    pub rows: u64,
}

/// How the fields of a column are read.
#[derive(Clone, Copy)]
enum Role {
    Step,
    Time(Option<usize>),
    Frequency(Option<usize>),
    Key,
    Value(usize),
    Nothing,
}

/// The role of each column.
fn roles(pick: &Pick, columns: usize) -> Vec<Role> {
    let mut roles = vec![Role::Nothing; columns];
    for (place, &column) in pick.values.iter().enumerate() {
        roles[column] = Role::Value(place);
    }
    pick.keys.iter().for_each(|&column| roles[column] = Role::Key);
    if let Some(column) = pick.step {
        roles[column] = Role::Step;
    }
    if let Some(column) = pick.time {
        roles[column] = Role::Time(pick.values.iter().position(|&value| value == column));
    }
    if let Some(column) = pick.frequency {
        roles[column] = Role::Frequency(pick.values.iter().position(|&value| value == column));
    }
    roles
}

impl Cursor {
    /// A place before the first row of a table.
    pub fn new(table: TableReader, pick: &Pick) -> Cursor {
        let width = pick.values.len();
        Cursor {
            roles: roles(pick, table.header.len()),
            table,
            values: vec![f64::NAN; width],
            key: Vec::new(),
            response: [0.0, f64::NEG_INFINITY],
            done: false,
            summary: Summary { ranges: vec![Range::NONE; width], truncated: false },
            frame: 0,
            when: [f64::NAN; 2],
            before: None,
            rows: 0,
        }
    }

    /// Goes to the next row, which is the first if there was none.
    ///
    /// # Errors
    /// The table cannot be read, or a row has not as many fields as the header.
    pub fn advance(&mut self) -> io::Result<()> {
        let Some(when) = self.read()? else {
            (self.summary.truncated, self.done) = (self.table.truncated, true);
            return Ok(());
        };
        self.rows += 1;
        for (range, &value) in self.summary.ranges.iter_mut().zip(&self.values) {
            if value.is_finite() {
                *range = range.with(Range { least: value, most: value });
            }
        }
        if self.frame == 0 || when.map(f64::to_bits) != self.when.map(f64::to_bits) {
            self.before = (self.frame > 0).then_some(self.when);
            self.when = when;
            self.frame += 1;
        }
        Ok(())
    }

    /// Reads the next row, and returns its step and time; `None` where none is left.
    fn read(&mut self) -> io::Result<Option<[f64; 2]>> {
        let Some(row) = self.table.next_row()? else { return Ok(None) };
        let (mut when, mut count) = ([0.0; 2], 0);
        self.values.fill(f64::NAN);
        self.key.clear();
        for (field, role) in fields(row).zip(self.roles.iter().chain(std::iter::repeat(&Role::Nothing))) {
            count += 1;
            match *role {
                Role::Step => when[0] = number(field),
                Role::Time(place) => {
                    when[1] = number(field);
                    place.into_iter().for_each(|place| self.values[place] = when[1]);
                }
                Role::Frequency(place) => {
                    let frequency = number(field);
                    let [number, before] = self.response;
                    self.response = [number + f64::from(u8::from(frequency < before)), frequency];
                    when = self.response;
                    place.into_iter().for_each(|place| self.values[place] = frequency);
                }
                Role::Key => {
                    self.key.extend_from_slice(text(field).as_bytes());
                    // No text of a table holds a zero byte, which therefore keeps names apart.
                    self.key.push(0);
                }
                Role::Value(place) => self.values[place] = number(field),
                Role::Nothing => {}
            }
        }
        if count == self.roles.len() { Ok(Some(when)) } else { Err(self.table.ragged(count)) }
    }

    /// The key of the row: the names of its subject, each followed by a zero byte.
    pub fn key(&self) -> &[u8] {
        &self.key
    }

    /// The picked values of the row, in the order of [`Pick::values`].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Whether there is a row, and it belongs to this frame.
    pub fn is_in(&self, frame: usize) -> bool {
        !self.done && self.frame == frame
    }
}

/// A key as text: `tip`, `roof 3 1`; empty for rows of the whole scene.
pub fn shown(key: &[u8]) -> String {
    let key = String::from_utf8_lossy(key);
    key.split('\0').filter(|name| !name.is_empty()).collect::<Vec<_>>().join(" ")
}
