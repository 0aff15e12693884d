//! Two tables are joined row by row: the rows of one time belong together, and among them those of one name.

use super::cursor::Cursor;
use crate::table_reader::FAILED;
use std::cmp::Ordering;
use std::collections::{HashMap, VecDeque};
use std::io;

/// Times that agree within this part of the shorter of the two last steps are one time. It far exceeds the rounding of sums of steps, and
/// hides no difference: motion between the frames is larger.
const ROUNDING: f64 = 1e-3;

/// The largest difference of a column, and where it stands.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Worst {
    /// The absolute difference in the unit of the column; infinite where only one side has a number, or any is NaN.
    pub difference: f64,
    /// The time of the row, the earlier of the two.
    pub time: f64,
    /// The key of the row ([`shown`](super::shown) makes a text of it).
    pub key: Vec<u8>,
}

/// The rows and frames that one side has alone.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Alone {
    /// The number of rows without a partner in frames that both sides have.
    pub rows: u64,
    /// The time and the key of the first of these rows.
    pub first: Option<(f64, Vec<u8>)>,
    /// The number of frames that the other side has not.
    pub frames: u64,
    /// The number of rows in these frames.
    pub all_rows: u64,
}

/// The number by which frames of two tables are paired.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Matched {
    /// Their times.
    Time,
    /// By steps: on a path whose load rises and falls, a time has more than one frame.
    Step,
    /// Their frequencies, in each of the responses of a run.
    Frequency,
}

impl Matched {
    /// The place of this number in [`Cursor::when`].
    fn place(self) -> usize {
        usize::from(self != Matched::Step)
    }
}

/// The common rows of two tables, and the rows of one alone.
#[derive(Debug, Clone, Default)]
pub struct Joined {
    /// The largest difference of each column.
    pub worst: Vec<Worst>,
    /// The number of rows that both sides have.
    pub rows: u64,
    /// The number of frames that both sides have.
    pub frames: u64,
    /// The rows of each side alone.
    pub alone: [Alone; 2],
    /// Time, step or frequency of the last frame of each side and of the frame before; `None` where there is no frame.
    pub ends: [Option<(f64, f64)>; 2],
}

/// Goes through both tables once, frame by frame.
///
/// # Errors
/// A table cannot be read, or is no table.
pub fn join(sides: &mut [Cursor; 2], columns: usize, by: Matched) -> io::Result<Joined> {
    let mut joined = Joined { worst: vec![Worst::default(); columns], ..Joined::default() };
    sides.iter_mut().try_for_each(Cursor::advance)?;
    let mut frame: Option<[usize; 2]> = None;
    while !(sides[0].done && sides[1].done) {
        let Some(both) = frame else {
            match order(sides, by) {
                Ordering::Equal => {
                    frame = Some([sides[0].frame, sides[1].frame]);
                    joined.frames += 1;
                }
                Ordering::Less => skip(&mut sides[0], &mut joined.alone[0])?,
                Ordering::Greater => skip(&mut sides[1], &mut joined.alone[1])?,
            }
            continue;
        };
        let [a, b] = &mut *sides;
        match (a.is_in(both[0]), b.is_in(both[1])) {
            (true, true) if a.key() == b.key() => {
                let time = a.when[1].min(b.when[1]);
                joined.rows += 1;
                tally(&mut joined.worst, a.values(), b.values(), time, a.key());
                a.advance()?;
                b.advance()?;
            }
            (false, false) => frame = None,
            _ => {
                rest(sides, both, &mut joined)?;
                frame = None;
            }
        }
    }
    for (end, side) in joined.ends.iter_mut().zip(&*sides) {
        let place = |when: [f64; 2]| when[by.place()];
        *end = (side.frame > 0).then(|| (place(side.when), side.before.map_or(f64::NAN, place)));
    }
    Ok(joined)
}

/// Which side's frame comes first; a side at its end comes last.
fn order([a, b]: &[Cursor; 2], by: Matched) -> Ordering {
    match (a.done, b.done) {
        (true, _) => return Ordering::Greater,
        (_, true) => return Ordering::Less,
        _ => {}
    }
    // A response that goes over its frequencies once more is another.
    if by == Matched::Step || by == Matched::Frequency && a.when[0] != b.when[0] {
        return a.when[0].total_cmp(&b.when[0]);
    }
    let [s, t] = [a.when[1], b.when[1]];
    let step = |side: &Cursor| side.before.map_or(f64::INFINITY, |before| (side.when[1] - before[1]).abs());
    let step = step(a).min(step(b));
    let digits = 4.0 * f64::EPSILON * s.abs().max(t.abs());
    let near = if step.is_finite() { (ROUNDING * step).max(digits) } else { digits };
    if (s - t).abs() <= near { Ordering::Equal } else { s.total_cmp(&t) }
}

/// Passes over a frame that the other side has not.
fn skip(side: &mut Cursor, alone: &mut Alone) -> io::Result<()> {
    let frame = side.frame;
    alone.frames += 1;
    while side.is_in(frame) {
        alone.all_rows += 1;
        side.advance()?;
    }
    Ok(())
}

/// Joins the rest of a frame whose rows are not in the same order on both sides, or not the same rows.
fn rest(sides: &mut [Cursor; 2], both: [usize; 2], joined: &mut Joined) -> io::Result<()> {
    let [a, b] = sides;
    let time = a.when[1].min(b.when[1]);
    let mut waiting: HashMap<Vec<u8>, VecDeque<(usize, Vec<f64>)>> = HashMap::new();
    let mut count = 0;
    while a.is_in(both[0]) {
        waiting.entry(a.key().to_vec()).or_default().push_back((count, a.values().to_vec()));
        count += 1;
        a.advance()?;
    }
    let miss = |alone: &mut Alone, key: &[u8]| {
        alone.rows += 1;
        alone.first.get_or_insert_with(|| (time, key.to_vec()));
    };
    // Rows behind the torn end of a file do not count as missing; the tear itself is reported.
    let a_truncated = a.done && a.summary.truncated;
    while b.is_in(both[1]) {
        match waiting.get_mut(b.key()).and_then(VecDeque::pop_front) {
            Some((_, values)) => {
                joined.rows += 1;
                tally(&mut joined.worst, &values, b.values(), time, b.key());
            }
            None if !a_truncated => miss(&mut joined.alone[1], b.key()),
            None => {}
        }
        b.advance()?;
    }
    if !(b.done && b.summary.truncated) {
        let mut left: Vec<(usize, Vec<u8>)> = waiting
            .into_iter()
            .flat_map(|(key, rows)| rows.into_iter().map(move |(at, _)| (at, key.clone())))
            .collect();
        left.sort_unstable();
        left.iter().for_each(|(_, key)| miss(&mut joined.alone[0], key));
    }
    Ok(())
}

/// Enters the differences between two rows into the largest so far.
fn tally(worst: &mut [Worst], a: &[f64], b: &[f64], time: f64, key: &[u8]) {
    for ((worst, &a), &b) in worst.iter_mut().zip(a).zip(b) {
        let difference = if a == b || a.to_bits() == b.to_bits() && a.to_bits() != FAILED {
            continue;
        } else if a.is_finite() && b.is_finite() {
            (a - b).abs()
        } else {
            f64::INFINITY
        };
        if difference > worst.difference {
            (worst.difference, worst.time) = (difference, time);
            worst.key.clear();
            worst.key.extend_from_slice(key);
        }
    }
}
