//! Records: a quantity over time in a text file, as instruments and data bases give them.
//!
//! Values follow one another along the lines, if the header of a data base or the deck says so. Otherwise they stand in columns, separated
//! as in the first line of numbers: by semicolons, commas, tabs or blanks. Lines that begin with `#`, `%` or `!` are comments; one line of
//! names may come before the columns.

mod header;
mod number;
mod rows;
mod unit;

pub use rows::MOST_FAULTS;
pub use unit::{MotionQuantity, RecordUnit, word_of_time};

use base::diagnostic::Diagnostic;
use base::names::{nearest, quoted};
use base::text_file::{Fault, Text, TextLine, Word};
use std::path::Path;

/// A column of a record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RecordColumn {
    /// By its name in the line of names.
    Name(String),
    /// By its number, counted from 1.
    Number(u64),
}

/// The part of a record that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordSelection {
    /// The columns of time and value, or of the value alone; empty if the file has no others.
    pub columns: Vec<RecordColumn>,
    /// The time between two values, the first at 0; `None` where the file has the times or says their distance.
    pub time_step: Option<f64>,
    /// Whether values follow one another along the lines; `None` where the header of the file says it.
    pub rows: Option<bool>,
    /// The unit of the times wanted, in seconds; `None` for times as the file has them.
    pub time_unit: Option<f64>,
}

/// A record as its file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeSeries {
    /// The points (time, value), times in the unit of the selection where the file names its own.
    pub points: Vec<[f64; 2]>,
    /// The unit of the values, where the header names one.
    pub unit: Option<RecordUnit>,
    /// The offset of the instrument that was subtracted from all values, in their unit.
    pub offset: Option<f64>,
    /// The number of values per line, if the lines look like one sequence and the column is only a part of it.
    pub sequence: Option<usize>,
    /// The unit of the times in the file, where it is not the one wanted.
    pub times: Option<UnitOfTimes>,
}

/// A unit of times that a file names.
#[derive(Debug, Clone, PartialEq)]
pub enum UnitOfTimes {
    /// So many seconds; the times are converted.
    Converted(f64),
    /// No unit of time; the times are as the file has them.
    Unknown(String),
}

/// Reads a record from the bytes of a file whose path, for messages, is `path`.
///
/// # Errors
/// All errors found in the file, at least one and at most some.
pub fn read(path: &str, bytes: &[u8], selection: &RecordSelection) -> Result<TimeSeries, Vec<Diagnostic>> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    read_text(path, bytes, selection).map_err(|faults| faults.into_iter().map(|fault| *fault).collect())
}

fn read_text(path: &str, bytes: &[u8], selection: &RecordSelection) -> Result<TimeSeries, Vec<Fault>> {
    let text = Text::new(path, bytes);
    let header = header::find(path, bytes).map_err(|fault| vec![fault])?;
    if let Some(fault) = header::unread(path, bytes).filter(|_| header.is_none()) {
        return Err(vec![fault]);
    }
    let is_in_rows = selection.rows.unwrap_or(header.is_some() && selection.columns.is_empty());
    let is_bare = selection.columns.is_empty() && selection.time_step.is_none();
    if is_bare && header.is_none() && is_of_peer(path) {
        let fault = text.fault("no line says `NPTS= .., DT= ..`, as headers of the PEER data bases do", 1);
        return Err(vec![Box::new(fault.hint("`rows = true` and `time_step` read values without such a header"))]);
    }
    if !is_in_rows {
        let last = header.as_ref().map_or(0, |header| header.last_line);
        return read_columns(text, last, selection, header.and_then(|header| header.unit));
    }
    let in_header = header.as_ref().map(|header| header.step / selection.time_unit.unwrap_or(1.0));
    let Some(step) = in_header.or(selection.time_step) else {
        let message = "the file does not say how far apart its values are: `rows = true` needs `time_step` beside it";
        return Err(vec![text.fault(message, 1)]);
    };
    if let (Some(given), Some(header)) = (selection.time_step, &header)
        && (given - step).abs() > 1e-6 * step
    {
        let own = match selection.time_unit.filter(|unit| *unit != 1.0) {
            Some(_) => format!("{} s, in the unit of the deck {step}", header.step),
            None => step.to_string(),
        };
        let message = format!("`time_step` is {given}, and the header says {own}: leave `time_step` out");
        return Err(vec![text.fault(message, header.last_line)]);
    }
    let points = rows::read_rows(text, header.as_ref(), step)?;
    let mut series = with_unit(points, header);
    series.times =
        in_header.zip(selection.time_unit).filter(|(_, unit)| *unit != 1.0).map(|_| UnitOfTimes::Converted(1.0));
    if series.unit.is_none() && has_extension(path, "at2") {
        series.unit = Some(RecordUnit::new("g"));
    }
    Ok(series)
}

/// The points in the unit of the header, without the offset of the instrument.
fn with_unit(mut points: Vec<[f64; 2]>, header: Option<header::Header>) -> TimeSeries {
    let Some(header) = header else {
        return TimeSeries { points, unit: None, offset: None, sequence: None, times: None };
    };
    points.iter_mut().for_each(|[_, value]| *value *= header.factor);
    let offset = header.has_offset.then(|| points.iter().map(|[_, value]| value).sum::<f64>() / points.len() as f64);
    points.iter_mut().for_each(|[_, value]| *value -= offset.unwrap_or(0.0));
    TimeSeries { points, unit: header.unit, offset, sequence: None, times: None }
}

/// True for the names of files from the PEER data bases.
fn is_of_peer(path: &str) -> bool {
    ["at2", "vt2", "dt2"].iter().any(|extension| has_extension(path, extension))
}

fn has_extension(path: &str, wanted: &str) -> bool {
    Path::new(path).extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// Reads a record in columns behind the line of this number.
fn read_columns(
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
        let Some((names, units, mut line)) = self.begin() else { return Vec::new() };
        let count = self.split(line).len();
        if !names.is_empty() && names.len() != count {
            let message = format!("the line of names has {} columns, that of numbers {count}", names.len());
            let fault = self.text.fault(message, line.number);
            let hint =
                "give each column one name, or none; `rows = true` with `time_step` reads all values along the lines";
            self.faults.push(Box::new(fault.hint(hint)));
            return Vec::new();
        }
        self.columns = count;
        let places = match places(selection, &names, count) {
            Ok(places) => places,
            Err(message) => {
                self.faults.push(self.text.fault(message, line.number));
                return Vec::new();
            }
        };
        let unit_of = |place: usize| {
            let in_name = names.get(place).filter(|name| name.contains(['(', '[']));
            units.get(place).or(in_name).and_then(|name| inner_name(name))
        };
        self.unit = unit_of(places.value).map(RecordUnit::new).filter(|unit| unit.known.is_some());
        self.times = places.time.and_then(unit_of).map(str::to_owned);
        let may_be_sequence = selection.rows.is_none() && names.is_empty() && count > 2 && places.time.is_none();
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

    /// Finds the names of columns and a line of units below them, none where the file has none, and the first line of numbers.
    fn begin(&mut self) -> Option<(Vec<String>, Vec<String>, TextLine<'t>)> {
        let Some(first) = self.next_line() else {
            self.faults.push(self.text.fault("the file has no lines of numbers", 1));
            return None;
        };
        self.separator = separator(first);
        let words = self.split(first);
        // A line of names has letters in each: `nan`, `inf` and `--` are values that are none.
        let is_name = |word: &Word| {
            let text = word.text();
            text.contains(char::is_alphabetic) && text.parse::<f64>().is_err() && word.number().is_none()
        };
        if !words.iter().all(is_name) {
            return Some((Vec::new(), Vec::new(), first));
        }
        let texts = |words: &[Word]| -> Vec<String> {
            words.iter().map(|word| word.text().trim_matches(['"', '\'', ' ']).to_owned()).collect()
        };
        let mut names = texts(&words);
        let is_blank = self.separator.is_none();
        let (mut next, mut units) = (self.next_line(), Vec::new());
        if let Some(line) = next
            && self.split(line).iter().all(is_name)
        {
            units = texts(&self.split(line));
            next = self.next_line();
        }
        let Some(line) = next else {
            self.faults.push(self.text.fault_at_end("the file has a line of names and no numbers"));
            return None;
        };
        // Names may stand between other separators than numbers do.
        if separator(line) != self.separator && self.split(line).len() == 1 {
            self.separator = separator(line);
        }
        if is_blank && names.len() != self.split(line).len() {
            join_units(&mut names);
        }
        Some((names, units, line))
    }

    /// The next line that is no comment.
    fn next_line(&mut self) -> Option<TextLine<'t>> {
        loop {
            let line = self.text.line()?;
            (self.blank, self.last) = (line.number - self.last - 1, line.number);
            if !line.bytes.trim_ascii_start().starts_with(b"#")
                && !line.bytes.trim_ascii_start().starts_with(b"%")
                && !line.bytes.trim_ascii_start().starts_with(b"!")
            {
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

    fn split(&self, line: TextLine<'t>) -> Vec<Word<'t>> {
        match self.separator {
            Some(separator) => line.parts(separator).collect(),
            None => line.words().collect(),
        }
    }

    /// The n-th part of a line, counted from 0.
    fn part(&self, line: TextLine<'t>, n: usize) -> Option<Word<'t>> {
        match self.separator {
            Some(separator) => line.parts(separator).nth(n),
            None => line.words().nth(n),
        }
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
        let values: Vec<f64> = self.split(line).iter().filter_map(Word::number).collect();
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
                let count = self.split(line).len();
                let columns = if count == 1 { "column" } else { "columns" };
                let message = format!("there is a gap: the line has {count} {columns}, column {} is wanted", place + 1);
                self.text.fault(message, line.number)
            }
        };
        self.faults.push(fault);
        None
    }
}

/// The end of a name in brackets, as in "Acc (g)" or "a [m/s^2]", or the name itself.
fn inner_name(name: &str) -> Option<&str> {
    Some(name.rsplit(['(', '[']).next()?.trim_matches([')', ']', ' ']))
}

/// Joins a unit in brackets to the name before it, where blanks separate columns.
fn join_units(names: &mut Vec<String>) {
    for place in (1..names.len()).rev() {
        if names[place].starts_with(['(', '[']) {
            let unit = names.remove(place);
            names[place - 1] += &format!(" {unit}");
        }
    }
}

/// The separator of the columns of a line; `None` for blanks.
fn separator(line: TextLine) -> Option<u8> {
    [b';', b',', b'\t'].into_iter().find(|separator| line.bytes.contains(separator))
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
