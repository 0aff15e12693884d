//! Records whose values stand in columns.

use super::head::{Head, unquoted};
use super::number::is_comment;
use super::rows::MOST_FAULTS;
use super::series::{RecordColumn, RecordSelection, TimeSeries, UnitOfTimes};
use super::unit::{self, RecordUnit};
use base::names::{nearest, quoted};
use base::text_file::{Fault, Text, TextLine, Word};

/// Reads a record in columns behind the line of this number.
pub fn read_columns(
    mut text: Text,
    last: usize,
    selection: &RecordSelection,
    unit: Option<RecordUnit>,
) -> Result<TimeSeries, Vec<Fault>> {
    text.skip_to(last);
    let mut reader = Reader {
        text,
        separator: None,
        faults: Vec::new(),
        columns: 0,
        last,
        blank: 0,
        jumps: None,
        unit: None,
        times: None,
    };
    let mut points = reader.points(selection);
    if reader.faults.is_empty() {
        let named = reader.times.as_deref().zip(selection.time_unit);
        let times = named.and_then(|(name, wanted)| match unit::seconds_of(name) {
            Some(seconds) if seconds == wanted => None,
            Some(seconds) => {
                points.iter_mut().for_each(|[time, _]| *time *= seconds / wanted);
                Some(UnitOfTimes::Converted(seconds))
            }
            None => Some(UnitOfTimes::Unknown(name.to_owned())),
        });
        let sequence = reader.jumps.filter(Jumps::is_sequence).map(|_| reader.columns);
        return Ok(TimeSeries { points, unit: unit.or(reader.unit), offset: None, sequence, times });
    }
    Err(reader.faults)
}

/// Differences of the first lines of a column: along lines, and from line to line.
#[derive(Default)]
struct Jumps {
    lines: usize,
    along: f64,
    across: f64,
}

impl Jumps {
    /// True where values along the lines follow one another twice as closely as those of the column do.
    fn is_sequence(&self) -> bool {
        self.lines > 2 && 2.0 * self.along < self.across
    }
}

struct Reader<'t> {
    text: Text<'t>,
    /// The separator of columns; `None` for blanks.
    separator: Option<u8>,
    faults: Vec<Fault>,
    /// The number of columns of the first line of numbers.
    columns: usize,
    /// The number of the last line that was read, comments included, and of empty ones before it.
    last: usize,
    blank: usize,
    /// Statistics on a file without column names, to detect a column that is part of a sequence.
    jumps: Option<Jumps>,
    /// The unit that the name of the value's column, or the line below the names, gives it.
    unit: Option<RecordUnit>,
    /// The unit of the column of times, where it is named likewise.
    times: Option<String>,
}

/// The places of the wanted columns in a line, from 0.
struct Places {
    time: Option<usize>,
    value: usize,
}

impl<'t> Reader<'t> {
    fn points(&mut self, selection: &RecordSelection) -> Vec<[f64; 2]> {
        let head = match Head::read(&self.text, self.last) {
            Ok(head) => head,
            Err(fault) => {
                self.faults.push(fault);
                return Vec::new();
            }
        };
        let mut line = head.first;
        self.text.skip_to(line.number);
        (self.separator, self.last) = (head.separator, line.number);
        let count = self.count(line);
        self.columns = count;
        let places = match places(selection, &head.names, count) {
            Ok(places) => places,
            Err(message) => {
                self.faults.push(self.text.fault(message, line.number));
                return Vec::new();
            }
        };
        let unit_of = |place: usize| head.units.get(place).cloned().flatten();
        let named = unit_of(places.value).map(|unit| RecordUnit::new(&unit)).filter(|unit| unit.known.is_some());
        self.unit = named.or(head.unit);
        self.times = places.time.and_then(unit_of);
        let may_be_sequence = selection.rows.is_none() && head.names.is_empty() && count > 2 && places.time.is_none();
        self.jumps = may_be_sequence.then(Jumps::default);
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(self.text.bytes.len() / (line.bytes.len() + 1) + 1);
        loop {
            self.point(line, &places, selection.time_step, &mut points);
            match self.next_line() {
                Some(next) if self.faults.len() < MOST_FAULTS => line = next,
                _ => break,
            }
        }
        if points.len() < 2 && self.faults.is_empty() {
            self.faults.push(self.text.fault_at_end("a record needs two values or more"));
        }
        points
    }

    /// The next line of values: comments do not count, and a line of separators alone is blank.
    fn next_line(&mut self) -> Option<TextLine<'t>> {
        loop {
            let line = self.text.line()?;
            if self.separator.is_some_and(|separator| line.parts(separator).all(|part| part.bytes.is_empty())) {
                continue;
            }
            (self.blank, self.last) = (line.number - self.last - 1, line.number);
            if !is_comment(line) {
                return Some(line);
            }
        }
    }

    /// The number of columns of a line.
    fn count(&self, line: TextLine<'t>) -> usize {
        match self.separator {
            Some(separator) => line.parts(separator).count(),
            None => line.words().count(),
        }
    }

    /// The n-th part of a line, counted from 0.
    fn part(&self, line: TextLine<'t>, n: usize) -> Option<Word<'t>> {
        let part = match self.separator {
            Some(separator) => line.parts(separator).nth(n),
            None => line.words().nth(n),
        };
        part.map(unquoted)
    }

    /// Reads one line.
    fn point(&mut self, line: TextLine<'t>, places: &Places, time_step: Option<f64>, points: &mut Vec<[f64; 2]>) {
        let count = self.count(line);
        if count > self.columns {
            let message = format!("the line has {count} columns, those before it {}", self.columns);
            self.faults.push(self.text.fault(message, line.number));
            return;
        }
        let Some(value) = self.number(line, places.value) else { return };
        self.compare_along(line, value, points.last());
        let Some(place) = places.time else {
            // Without times an empty line would make all later values early.
            if self.blank > 0 && !points.is_empty() {
                self.faults.push(self.text.fault("there is a gap: the line is empty", line.number - 1));
                return;
            }
            points.push([points.len() as f64 * time_step.unwrap_or(1.0), value]);
            return;
        };
        let Some(time) = self.number(line, place) else { return };
        let falls = points.last().is_some_and(|last| last[0] > time);
        let thrice = points.len() > 1 && points[points.len() - 2][0] == time;
        if (falls || thrice)
            && let Some(word) = self.part(line, place)
        {
            let message = if falls {
                format!("the time falls: {time} comes after {}", points[points.len() - 1][0])
            } else {
                format!("the time {time} stands there more than twice: once before a jump and once after it")
            };
            self.faults.push(self.text.fault_at(message, &word));
            return;
        }
        points.push([time, value]);
    }

    /// Adds the differences along a line and to the line before, among the first lines.
    fn compare_along(&mut self, line: TextLine<'t>, value: f64, before: Option<&[f64; 2]>) {
        const LINES: usize = 2000;
        let Some(jumps) = self.jumps.as_ref().filter(|jumps| jumps.lines < LINES) else { return };
        let values: Vec<f64> = (0..self.columns).filter_map(|n| self.part(line, n)?.number()).collect();
        let along =
            values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>() / (values.len().max(2) - 1) as f64;
        let across = before.map_or(0.0, |before| (value - before[1]).abs());
        self.jumps = Some(Jumps { lines: jumps.lines + 1, along: jumps.along + along, across: jumps.across + across });
    }

    /// A number of a line; errors are noted.
    fn number(&mut self, line: TextLine<'t>, place: usize) -> Option<f64> {
        let fault = match self.part(line, place) {
            Some(word) => match word.number() {
                Some(number) => return Some(number),
                None if word.bytes.is_empty() => {
                    self.text.fault(format!("there is a gap: column {} is empty", place + 1), line.number)
                }
                None => {
                    let fault = self.text.fault_at(format!("`{}` is not a finite number", word.text()), &word);
                    let decimal_comma = word.bytes.contains(&b',');
                    if decimal_comma { Box::new(fault.hint("decimals stand behind a point")) } else { fault }
                }
            },
            None => {
                let count = self.count(line);
                let columns = if count == 1 { "column" } else { "columns" };
                let message = format!("there is a gap: the line has {count} {columns}, column {} is wanted", place + 1);
                self.text.fault(message, line.number)
            }
        };
        self.faults.push(fault);
        None
    }
}

/// Finds the selected columns among `count`; `names` may be empty.
fn places(selection: &RecordSelection, names: &[String], count: usize) -> Result<Places, String> {
    let wanted = if selection.time_step.is_some() { 1 } else { 2 };
    let of_file = match names {
        [] => format!("the file has {count} of them, without names"),
        names => format!("the file has {}", quoted(names.iter().map(String::as_str))),
    };
    if selection.columns.is_empty() {
        let which = match wanted {
            1 => "which of them is the value",
            _ => "which are the time and the value",
        };
        return match count == wanted {
            true => Ok(Places { time: (wanted == 2).then_some(0), value: wanted - 1 }),
            false if count == 1 => Err("the file has one column: `time_step` says how far apart its values are".into()),
            false if names.is_empty() => {
                let step = if wanted == 1 { "" } else { " with `time_step`" };
                Err(format!(
                    "a line has {count} values: `columns` says {which}, or `rows = true`{step} reads all of them one after the other along the lines"
                ))
            }
            false => Err(format!("`columns` must say {which}: {of_file}")),
        };
    }
    let found = selection.columns.iter().map(|column| match column {
        RecordColumn::Number(number) if (1..=count as u64).contains(number) => Ok(*number as usize - 1),
        RecordColumn::Number(number) => Err(format!("there is no column {number}: {of_file}")),
        RecordColumn::Name(name) if names.iter().filter(|own| *own == name).count() > 1 => {
            Err(format!("more than one column is named `{name}`: give its number"))
        }
        RecordColumn::Name(name) => names.iter().position(|own| own == name).ok_or_else(|| {
            let like = nearest(name, names.iter().map(String::as_str));
            let like = like.map_or(String::new(), |like| format!("; did you mean `{like}`?"));
            format!("there is no column `{name}`: {of_file}{like}")
        }),
    });
    let found = found.collect::<Result<Vec<usize>, String>>()?;
    match found[..] {
        [value] if wanted == 1 => Ok(Places { time: None, value }),
        [time, value] if wanted == 2 => Ok(Places { time: Some(time), value }),
        _ if wanted == 1 => Err("with `time_step`, `columns` names one column, that of the value".into()),
        _ => {
            Err("`columns` must be two numbers, the column of the time and the column of the value, or one beside `time_step`".into())
        }
    }
}
