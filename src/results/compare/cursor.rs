//! A table is read and parsed on a thread of its own, ahead of whoever looks at its rows.

use crate::table_reader::{TableReader, fields, number, text};
use std::io;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{Scope, ScopedJoinHandle};

/// The number of rows that are handed over at a time.
const ROWS: usize = 2048;
/// The number of blocks of rows that may wait for their reader.
const WAITING: usize = 4;

/// The places, from 0, of the columns that are read.
#[derive(Debug, Clone, Default)]
pub struct Pick {
    /// The place of `step`; `None` where frames have no step.
    pub step: Option<usize>,
    /// The place of `time`; `None` where the table has no frames.
    pub time: Option<usize>,
    /// The place of the frequency in a table whose frames are those of a response, which has neither of these.
    pub frequency: Option<usize>,
    /// The places of the columns that say what a row is about.
    pub keys: Vec<usize>,
    /// The places of the columns that are compared.
    pub values: Vec<usize>,
}

/// Some rows, one after the other.
#[derive(Default)]
struct Block {
    /// Step and time of each row; 0 where a table has none. Of a response, which one of the run it is, and the frequency.
    when: Vec<[f64; 2]>,
    /// The picked values, row by row.
    values: Vec<f64>,
    /// The keys of the rows.
    keys: Vec<u8>,
    /// The place in `keys` where the key of each row ends.
    ends: Vec<usize>,
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

/// What is known once a table has been read.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// The range of each picked value over the whole table.
    pub ranges: Vec<Range>,
    /// Whether the last line of the table is torn.
    pub truncated: bool,
}

enum Message {
    Rows(Block),
    End(io::Result<Summary>),
}

/// A place in the rows of a table: it stands on one row, and goes forward.
pub struct Cursor {
    blocks: Receiver<Message>,
    block: Block,
    /// The row at hand, by its place in the block.
    row: usize,
    /// The number of values of a row.
    width: usize,
    /// True where no row is left.
    pub done: bool,
    /// The summary of the table; it is empty until all rows have been read.
    pub summary: Summary,
    /// The number, from 1, of the frame: rows that follow each other with the same step and time.
    pub frame: usize,
    /// Step and time of this frame.
    pub when: [f64; 2],
    /// Step and time of the frame before; `None` in the first.
    pub before: Option<[f64; 2]>,
    /// The number of rows so far.
    pub rows: u64,
}

/// Starts reading the rows of a table on a thread of the scope. The cursor stands before the first row.
pub fn read<'s>(scope: &'s Scope<'s, '_>, mut rows: TableReader, pick: Pick) -> (Cursor, ScopedJoinHandle<'s, ()>) {
    let (sender, blocks) = sync_channel(WAITING);
    let width = pick.values.len();
    let thread = scope.spawn(move || {
        let end = send(&mut rows, &pick, &sender);
        // Sending fails where nobody listens any more, since something else went wrong.
        let _ = sender.send(Message::End(end));
    });
    let block = Block::default();
    let (when, summary) = ([f64::NAN; 2], Summary::default());
    let cursor = Cursor { blocks, block, row: 0, width, done: false, summary, frame: 0, when, before: None, rows: 0 };
    (cursor, thread)
}

/// What the fields of a column are read as.
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

/// Reads a table to its end and sends its rows block by block.
fn send(rows: &mut TableReader, pick: &Pick, sender: &SyncSender<Message>) -> io::Result<Summary> {
    let (columns, width) = (rows.header.len(), pick.values.len());
    let roles = roles(pick, columns);
    let mut ranges = vec![Range::NONE; width];
    let mut block = Block::default();
    let mut before = [0.0, f64::NEG_INFINITY];
    while let Some(row) = rows.next_row()? {
        let (mut when, first, mut count) = ([0.0; 2], block.values.len(), 0);
        block.values.resize(first + width, f64::NAN);
        for (field, role) in fields(row).zip(roles.iter().chain(std::iter::repeat(&Role::Nothing))) {
            count += 1;
            match *role {
                Role::Step => when[0] = number(field),
                Role::Time(place) => {
                    when[1] = number(field);
                    if let Some(place) = place {
                        block.values[first + place] = when[1];
                    }
                }
                Role::Frequency(place) => {
                    let frequency = number(field);
                    before = [before[0] + f64::from(u8::from(frequency < before[1])), frequency];
                    when = before;
                    if let Some(place) = place {
                        block.values[first + place] = frequency;
                    }
                }
                Role::Key => {
                    block.keys.extend_from_slice(text(field).as_bytes());
                    // No text of a table holds a zero byte, which therefore keeps names apart.
                    block.keys.push(0);
                }
                Role::Value(place) => block.values[first + place] = number(field),
                Role::Nothing => {}
            }
        }
        if count != columns {
            return Err(rows.ragged(count));
        }
        for (range, &value) in ranges.iter_mut().zip(&block.values[first..]) {
            if value.is_finite() {
                *range = range.with(Range { least: value, most: value });
            }
        }
        block.when.push(when);
        block.ends.push(block.keys.len());
        if block.when.len() == ROWS && sender.send(Message::Rows(std::mem::take(&mut block))).is_err() {
            break;
        }
    }
    let _ = sender.send(Message::Rows(block));
    Ok(Summary { ranges, truncated: rows.truncated })
}

impl Cursor {
    /// Goes to the next row, which is the first if there was none.
    ///
    /// # Errors
    /// The table cannot be read, or a row has not as many fields as the header.
    pub fn advance(&mut self) -> io::Result<()> {
        self.row += 1;
        while self.row >= self.block.when.len() {
            match self.blocks.recv() {
                Ok(Message::Rows(block)) => (self.block, self.row) = (block, 0),
                Ok(Message::End(end)) => {
                    (self.summary, self.done) = (end?, true);
                    return Ok(());
                }
                Err(_) => return Err(io::Error::other("a table was not read to its end")),
            }
        }
        self.rows += 1;
        let when = self.block.when[self.row];
        if self.frame == 0 || when.map(f64::to_bits) != self.when.map(f64::to_bits) {
            self.before = (self.frame > 0).then_some(self.when);
            self.when = when;
            self.frame += 1;
        }
        Ok(())
    }

    /// The key of the row: the names of what it is about, each followed by a zero byte.
    pub fn key(&self) -> &[u8] {
        let begin = if self.row == 0 { 0 } else { self.block.ends[self.row - 1] };
        &self.block.keys[begin..self.block.ends[self.row]]
    }

    /// The picked values of the row, in the order of [`Pick::values`].
    pub fn values(&self) -> &[f64] {
        &self.block.values[self.row * self.width..(self.row + 1) * self.width]
    }

    /// Whether there is a row, and it belongs to this frame.
    pub fn is_in(&self, frame: usize) -> bool {
        !self.done && self.frame == frame
    }
}

/// A key as it is shown: `tip`, `roof 3 1`; empty for rows that are about the whole scene.
pub fn shown(key: &[u8]) -> String {
    let key = String::from_utf8_lossy(key);
    key.split('\0').filter(|name| !name.is_empty()).collect::<Vec<_>>().join(" ")
}
