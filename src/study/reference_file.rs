//! The file that a deck names as the reference of its study, read with all of its faults told at once.

use base::diagnostic::{Diagnostic, Span};
use base::names::{nearest, quoted};
use base::text_file::read_regular;
use base::text_file::{Text, TextLine};
use model::Model;
use model::study::{Quantity, Study};
use std::path::Path;

/// The values of a file.
pub struct GivenReference {
    /// The values at the sample times one after the other, each time all quantities.
    pub values: Vec<f64>,
    /// The number of intervals between its times.
    pub samples: usize,
    /// The path under which the file was found.
    pub source: String,
}

/// The number of messages about one file beyond which more help nobody.
const MOST_FAULTS: usize = 20;

/// The faults of the file of a reference.
struct Faults<'t> {
    /// The name that the deck gives.
    file: &'t str,
    text: Text<'t>,
    list: Vec<Diagnostic>,
}

impl Faults<'_> {
    fn push(&mut self, fault: Diagnostic) {
        match self.list.len() {
            MOST_FAULTS.. => {}
            _ => self.list.push(fault),
        }
        if self.list.len() == MOST_FAULTS {
            self.list.push(Diagnostic::error(format!("`{}` may have more errors; correct these first", self.file)));
        }
    }

    /// An error at a line of the file.
    fn on(&self, line: usize, text: String) -> Diagnostic {
        *self.text.fault(format!("the reference `{}` {text}", self.file), line)
    }

    /// An error at a field of a line, or at the line where the field cannot be told.
    fn in_field(&self, line: usize, field: usize, text: String) -> Diagnostic {
        let bytes = self.text.line_of(line).trim_ascii_end();
        // In a line with quotes, commas do not always end fields.
        let word = TextLine { bytes, number: line }.fields().nth(field).filter(|_| !bytes.contains(&b'"'));
        match word {
            Some(word) => *self.text.fault_at(format!("the reference `{}` {text}", self.file), &word),
            None => self.on(line, text),
        }
    }
}

/// Reads the file that the deck names, if it names one. `base` is the folder of the deck, and `key` the place where it names the
/// file.
///
/// # Errors
/// All faults of the file.
pub fn read(
    model: &Model,
    study: &Study,
    quantities: &[Quantity],
    base: &Path,
    key: Option<&Span>,
) -> Result<Option<GivenReference>, Vec<Diagnostic>> {
    let Some(file) = &study.reference else { return Ok(None) };
    let path = base.join(file);
    let placed = |list: Vec<Diagnostic>| match key {
        Some(key) => list.into_iter().map(|problem| problem.at(key)).collect(),
        None => list,
    };
    let error = |text: String| Diagnostic::error(format!("the reference `{file}` {text}"));
    let bytes = match read_regular(&path) {
        Ok(bytes) => bytes,
        Err(fault) => return Err(placed(vec![error(format!("cannot be read: {fault}"))])),
    };
    let shown = path.display().to_string();
    let mut faults = Faults { file, text: Text::new(&shown, &bytes), list: Vec::new() };
    let rows = rows(study, quantities, &bytes, &mut faults);
    if !faults.list.is_empty() {
        return Err(placed(faults.list));
    }
    let end = model.analysis.end_time;
    let samples = study.samples.unwrap_or(rows.len().saturating_sub(1)).max(1);
    let near = 1e-6 * end / samples as f64;
    let (mut values, mut missing) = (Vec::new(), Vec::new());
    let mut left = rows.iter().peekable();
    for k in 0..=samples {
        let time = end * k as f64 / samples as f64;
        while left.next_if(|row| row.time < time - near).is_some() {}
        match left.peek() {
            Some(row) if row.time <= time + near => values.extend(&row.values),
            // The error names the line of the next row; at the end, the line of the last row.
            next => missing.push((time, next.map_or_else(|| rows.last(), |row| Some(*row)).map_or(1, |row| row.line))),
        }
    }
    if let Some(&(time, line)) = missing.first() {
        let others = match missing.len() - 1 {
            0 => String::new(),
            1 => ", nor at one other time".to_owned(),
            count => format!(", nor at {count} other times"),
        };
        let hint = format!("{samples} intervals are looked for from 0 to {end}: see `samples`");
        return Err(placed(vec![faults.on(line, format!("has no row at t = {time}{others}")).hint(hint)]));
    }
    if values.iter().all(|value| *value == 0.0) {
        let text = "is zero throughout: there is nothing an error could be relative to";
        return Err(placed(vec![error(text.to_owned())]));
    }
    Ok(Some(GivenReference { values, samples, source: shown }))
}

/// A row of a reference: a time, and the quantities then.
struct Row {
    line: usize,
    time: f64,
    values: Vec<f64>,
}

/// All rows; faults of the file go to `faults`.
fn rows(study: &Study, quantities: &[Quantity], bytes: &[u8], faults: &mut Faults) -> Vec<Row> {
    let mut lines = LineCounter { bytes, passed: 0, line: 1 };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(bytes);
    let header: Vec<String> = match reader.byte_headers() {
        Ok(header) => header.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect(),
        Err(fault) => {
            faults.push(faults.on(1, format!("cannot be read: {fault}")));
            return Vec::new();
        }
    };
    let head = lines.at(0);
    if header.is_empty() {
        faults.push(faults.on(1, "is empty".to_owned()));
        return Vec::new();
    }
    let columns = Columns::of(header, head, study, quantities, faults);
    let mut rows: Vec<Row> = Vec::new();
    let mut last: Option<(f64, usize)> = None;
    for record in reader.into_byte_records() {
        let record = match record {
            Ok(record) => record,
            Err(fault) => {
                faults.push(faults.on(head, format!("cannot be read: {fault}")));
                break;
            }
        };
        let line = lines.at(record.position().map_or(0, |position| position.byte() as usize));
        let time = columns.time.and_then(|place| columns.number(&record, place, line, faults));
        let values: Vec<f64> =
            columns.values.iter().filter_map(|&place| columns.number(&record, place, line, faults)).collect();
        if let (Some(time), Some(place)) = (time, columns.time) {
            if let Some((before, above)) = last.filter(|(before, _)| *before >= time) {
                let message = format!("has times that do not rise: {time} in line {line}");
                faults.push(faults.in_field(line, place, message).hint(format!("line {above} has {before}")));
            }
            last = Some((time, line));
            rows.push(Row { line, time, values });
        }
    }
    rows
}

/// Computes the lines of records from the bytes of their beginnings.
struct LineCounter<'t> {
    bytes: &'t [u8],
    /// The number of bytes that have been counted.
    passed: usize,
    /// The line that follows them.
    line: usize,
}

impl LineCounter<'_> {
    /// The line of the record that begins at a byte, each call at a later one. The reader of records passes over blank lines, but
    /// counts their bytes to the record that follows.
    fn at(&mut self, start: usize) -> usize {
        let blank = self.bytes[start..].iter().take_while(|&&byte| byte == b'\n' || byte == b'\r').count();
        self.line += self.bytes[self.passed..start + blank].iter().filter(|&&byte| byte == b'\n').count();
        self.passed = start + blank;
        self.line
    }
}

/// The places of the columns that are asked for.
struct Columns {
    header: Vec<String>,
    /// The place of the time; `None` where it is missing.
    time: Option<usize>,
    /// The places of the quantities.
    values: Vec<usize>,
}

impl Columns {
    /// Finds the columns in the header in line `head`; a missing column is a fault.
    fn of(header: Vec<String>, head: usize, study: &Study, quantities: &[Quantity], faults: &mut Faults) -> Columns {
        let own = || quantities.iter().map(Quantity::word).collect();
        let names: Vec<String> = if study.columns.is_empty() { own() } else { study.columns.clone() };
        let time = header.iter().position(|name| name == "t" || name == "time");
        if time.is_none() {
            faults.push(faults.on(head, "has no column `t` or `time`".to_owned()));
        }
        let mut values = Vec::new();
        for name in &names {
            match header.iter().position(|column| column == name) {
                Some(place) => values.push(place),
                None => {
                    let known = header.iter().map(String::as_str);
                    let near = nearest(name, known.clone()).map(|near| format!("did you mean `{near}`?"));
                    let hint = near.unwrap_or_else(|| format!("it has {}", quoted(known)));
                    faults.push(faults.on(head, format!("has no column `{name}`")).hint(hint));
                }
            }
        }
        Columns { header, time, values }
    }

    /// The number in a field; it is a fault where there is none.
    fn number(&self, record: &csv::ByteRecord, place: usize, line: usize, faults: &mut Faults) -> Option<f64> {
        let text = record.get(place).map(String::from_utf8_lossy);
        let number = text.as_ref().and_then(|text| text.parse::<f64>().ok()).filter(|number| number.is_finite());
        if number.is_none() {
            let what = match &text {
                Some(text) if !text.is_empty() => format!("`{text}` is not a finite number"),
                _ => "the field is empty".to_owned(),
            };
            let message = format!("has no finite number for `{}` in line {line}", self.header[place]);
            faults.push(faults.in_field(line, place, message).hint(what));
        }
        number
    }
}
