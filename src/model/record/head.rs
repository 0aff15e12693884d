//! The lines before the columns of a record: titles, names of columns, and their units.

use super::header;
use super::number::is_comment;
use super::unit::{RecordUnit, is_unit, seconds_of};
use base::text_file::{Fault, Text, TextLine, Word};

/// The lines before the numbers, and the first line of numbers.
pub struct Head<'t> {
    /// The separator of the columns; `None` for blanks.
    pub separator: Option<u8>,
    /// The names of the columns; empty where the file has none.
    pub names: Vec<String>,
    /// The units of the columns as the file writes them, where it does; empty without names.
    pub units: Vec<Option<String>>,
    /// The unit of all values that a title or a comment names.
    pub unit: Option<RecordUnit>,
    /// The first line of numbers.
    pub first: TextLine<'t>,
}

impl<'t> Head<'t> {
    /// Reads from behind the line of this number up to the first line of numbers.
    ///
    /// # Errors
    /// No line of numbers, and names of other columns than the numbers have.
    pub fn read(text: &Text<'t>, last: usize) -> Result<Head<'t>, Fault> {
        let (lines, first) = before_numbers(text, last)?;
        let separator = separator(first);
        let count = split(first, separator).len();
        let fitting: Vec<Vec<String>> = lines.iter().filter_map(|line| names_of(*line, separator, count)).collect();
        let (names, below) = match &fitting[..] {
            [.., names, units] if units.iter().all(|unit| is_unit(bare(unit))) => (names.clone(), Some(units)),
            [.., names] => (names.clone(), None),
            [] => (Vec::new(), None),
        };
        if let Some(line) = lines.last().filter(|line| names.is_empty() && !is_comment(**line))
            && separator.is_some_and(|separator| line.bytes.contains(&separator))
        {
            let own = split(*line, separator).len();
            let fault =
                text.fault(format!("the line of names has {own} columns, that of numbers {count}"), first.number);
            let hint =
                "give each column one name, or none; `rows = true` with `time_step` reads all values along the lines";
            return Err(Box::new(fault.hint(hint)));
        }
        let units = match below {
            Some(units) => units.iter().map(|unit| Some(bare(unit).to_owned())).collect(),
            None => units_in(&names),
        };
        let unit = lines.iter().find_map(|line| header::known_unit(*line));
        Ok(Head { separator, names, units, unit, first })
    }
}

/// The lines of text before the numbers, and the first line of numbers.
fn before_numbers<'t>(text: &Text<'t>, last: usize) -> Result<(Vec<TextLine<'t>>, TextLine<'t>), Fault> {
    let mut ahead = Text::new(text.path, text.bytes);
    ahead.skip_to(last);
    let mut lines = Vec::new();
    let mut next = ahead.line();
    while let Some(line) = next {
        next = ahead.line();
        if !is_comment(line) && begins_numbers(line, next) {
            return Ok((lines, line));
        }
        if !is_rule(line) {
            lines.push(line);
        }
    }
    match lines.iter().any(|line| !is_comment(*line)) {
        true => Err(text.fault_at_end("the file has a line of names and no numbers")),
        false => Err(text.fault("the file has no lines of numbers", 1)),
    }
}

/// True for a line of values, or for one with some values that has them at the same places as the next line.
fn begins_numbers(line: TextLine, next: Option<TextLine>) -> bool {
    let values = |line: TextLine| -> Vec<bool> { split(line, separator(line)).iter().map(is_value).collect() };
    let own = values(line);
    !is_rule(line) && (own.iter().all(|is| *is) || own.contains(&true) && next.is_some_and(|next| values(next) == own))
}

/// True for a line that is drawn below names.
fn is_rule(line: TextLine) -> bool {
    line.bytes.len() > 2 && line.bytes.iter().all(|byte| b"-=_*+|,; \t".contains(byte))
}

/// True for a number or its replacement, such as `nan`, `--` or nothing.
fn is_value(word: &Word) -> bool {
    let text = word.text();
    word.number().is_some() || text.parse::<f64>().is_ok() || !text.contains(char::is_alphabetic)
}

/// The separator of the columns of a line; `None` for blanks.
fn separator(line: TextLine) -> Option<u8> {
    [b';', b',', b'\t'].into_iter().find(|separator| line.bytes.contains(separator))
}

fn split(line: TextLine<'_>, separator: Option<u8>) -> Vec<Word<'_>> {
    match separator {
        Some(separator) => line.parts(separator).map(unquoted).collect(),
        None => line.words().map(unquoted).collect(),
    }
}

/// The word without the quotation marks around it.
pub fn unquoted(word: Word<'_>) -> Word<'_> {
    match word.bytes {
        [b'"', inner @ .., b'"'] => Word { bytes: inner.trim_ascii(), column: word.column + 1, line: word.line },
        _ => word,
    }
}

/// The parts of a line, if they are as many as the columns: names may stand between other separators than numbers do.
fn names_of(line: TextLine, of_numbers: Option<u8>, count: usize) -> Option<Vec<String>> {
    let mark = if is_comment(line) { line.bytes.iter().take_while(|byte| b" \t#%!".contains(byte)).count() } else { 0 };
    let line = TextLine { bytes: &line.bytes[mark..], ..line };
    [of_numbers, separator(line), None]
        .into_iter()
        .map(|separator| names_between(line, separator))
        .find(|names| names.len() == count)
}

/// The names between separators, or between blanks, where a unit in brackets belongs to the name before it.
fn names_between(line: TextLine, separator: Option<u8>) -> Vec<String> {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().trim_matches(['"', '\'']).to_owned();
    if let Some(separator) = separator {
        let mut reader = csv::ReaderBuilder::new().delimiter(separator).has_headers(false).from_reader(line.bytes);
        return reader.byte_records().next().and_then(Result::ok).map_or(Vec::new(), |record| {
            let count = record.len() - usize::from(record.iter().next_back().is_some_and(<[u8]>::is_empty));
            record.iter().take(count).map(text).collect()
        });
    }
    let mut names: Vec<String> = Vec::new();
    for word in line.words().map(|word| text(word.bytes)) {
        match names.last_mut().filter(|_| word.starts_with(['(', '['])) {
            Some(name) => *name += &format!(" {word}"),
            None => names.push(word),
        }
    }
    names
}

/// The units in names of columns: in brackets as `Acc (g)`, or behind a stroke as `a/g`. Last as in `time_s,acc_g`, if the first names a time.
fn units_in(names: &[String]) -> Vec<Option<String>> {
    let last = |name: &str| name.rsplit(['_', ' ']).next().unwrap_or_default().to_owned();
    let end_with_units = names.first().is_some_and(|name| last(name) != *name && seconds_of(&last(name)).is_some());
    let unit = |name: &String| {
        let in_brackets = name.rfind(['(', '[']).map(|place| bare(&name[place..]).to_owned());
        let behind_stroke = || name.split_once('/').map(|(_, unit)| unit.to_owned()).filter(|unit| is_unit(unit));
        let at_end = || Some(last(name)).filter(|unit| end_with_units && unit != name && is_unit(unit));
        in_brackets.or_else(behind_stroke).or_else(at_end)
    };
    names.iter().map(unit).collect()
}

/// A unit without the brackets around it.
fn bare(unit: &str) -> &str {
    unit.trim_matches(['(', ')', '[', ']', ' '])
}
