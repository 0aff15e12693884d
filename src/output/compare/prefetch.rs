//! A table read and parsed on a thread of its own, ahead of whoever looks at its rows.

use crate::output::table_reader::{TableReader, fields, number, text};
use std::io;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{Scope, ScopedJoinHandle};

/// Rows handed over at a time, and blocks that may wait.
const ROWS: usize = 2048;
const WAITING: usize = 4;

/// Which columns are read, by their places.
#[derive(Debug, Clone, Default)]
pub struct Pick {
    pub step: Option<usize>,
    pub time: Option<usize>,
    pub keys: Vec<usize>,
    pub values: Vec<usize>,
}

/// Some rows.
#[derive(Default)]
struct Block {
    /// Step and time of each row; 0 where a table has none.
    when: Vec<[f64; 2]>,
    /// Row by row.
    values: Vec<f64>,
    /// Names, one row behind the other, and where each row's end.
    keys: Vec<u8>,
    ends: Vec<usize>,
}

/// Least and largest number of a column.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    pub least: f64,
    pub most: f64,
}

impl Range {
    pub const NONE: Range = Range { least: f64::INFINITY, most: f64::NEG_INFINITY };

    pub fn with(self, other: Range) -> Range {
        Range { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    /// Of nothing, 0.
    pub fn width(self) -> f64 {
        (self.most - self.least).max(0.0)
    }

    pub fn magnitude(self) -> f64 {
        if self.most < self.least { 0.0 } else { self.most.abs().max(self.least.abs()) }
    }
}

/// What is known when a table has been read.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// Of each picked column, over the whole table.
    pub ranges: Vec<Range>,
    pub truncated: bool,
}

enum Message {
    Rows(Block),
    End(io::Result<Summary>),
}

/// The row in hand.
pub struct Cursor {
    blocks: Receiver<Message>,
    block: Block,
    row: usize,
    width: usize,
    /// No row is left.
    pub done: bool,
    /// Once done.
    pub summary: Summary,
    /// Rows so far that share their step and time: their number, from 1.
    pub frame: usize,
    /// Step and time of this frame and of the one before.
    pub when: [f64; 2],
    pub before: Option<[f64; 2]>,
    pub rows: u64,
}

/// Starts reading the rows of a table.
pub fn read<'s>(scope: &'s Scope<'s, '_>, mut rows: TableReader, pick: Pick) -> (Cursor, ScopedJoinHandle<'s, ()>) {
    let (sender, blocks) = sync_channel(WAITING);
    let width = pick.values.len();
    let thread = scope.spawn(move || {
        let end = send(&mut rows, &pick, &sender);
        // Nobody listens any more where something else went wrong.
        let _ = sender.send(Message::End(end));
    });
    let block = Block::default();
    let (when, summary) = ([f64::NAN; 2], Summary::default());
    let cursor = Cursor { blocks, block, row: 0, width, done: false, summary, frame: 0, when, before: None, rows: 0 };
    (cursor, thread)
}

/// For each field of a row, what it is.
#[derive(Clone, Copy)]
enum Role {
    Step,
    Time(Option<usize>),
    Key,
    Value(usize),
    Nothing,
}

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
    roles
}

fn send(rows: &mut TableReader, pick: &Pick, sender: &SyncSender<Message>) -> io::Result<Summary> {
    let (columns, width) = (rows.header.len(), pick.values.len());
    let roles = roles(pick, columns);
    let mut ranges = vec![Range::NONE; width];
    let mut block = Block::default();
    while let Some(row) = rows.next()? {
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
                Role::Key => {
                    block.keys.extend_from_slice(text(field).as_bytes());
                    // No text of a table holds it: names stay apart.
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

    pub fn key(&self) -> &[u8] {
        let begin = if self.row == 0 { 0 } else { self.block.ends[self.row - 1] };
        &self.block.keys[begin..self.block.ends[self.row]]
    }

    pub fn values(&self) -> &[f64] {
        &self.block.values[self.row * self.width..(self.row + 1) * self.width]
    }

    /// Whether a row is in hand that belongs to this frame.
    pub fn is_in(&self, frame: usize) -> bool {
        !self.done && self.frame == frame
    }
}

/// A key as it is shown: `tip`, `roof 3 1`.
pub fn shown(key: &[u8]) -> String {
    let key = String::from_utf8_lossy(key);
    key.split('\0').filter(|name| !name.is_empty()).collect::<Vec<_>>().join(" ")
}
