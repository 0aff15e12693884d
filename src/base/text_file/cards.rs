//! Cards: the lines of Abaqus and CalculiX input. A line that starts with `*` is a keyword with parameters, a line with `**` is a comment,
//! and all other lines are data of the keyword above. No keyword has a meaning here.
//!
//! Blanks before a card, and blanks inside keywords and names without quotes, have no meaning. A comma inside quotes separates nothing.
//! Programs differ about a keyword line with a final comma: Abaqus continues the parameters on the next line, CalculiX starts the data.
//! Here the next line continues the keyword where it has the form of parameters, since no data have it.

use super::text::{Fault, Text, TextLine, Word};
use std::cell::Cell;

/// Letters of a parameter at least: shorter abbreviations may mean several.
const ABBREVIATION: usize = 3;

/// The cards of a file, one after the other.
pub struct Cards<'a, 't> {
    /// The file, which draws messages.
    pub text: &'a mut Text<'t>,
    /// Parameters without a value that may continue a keyword line.
    flags: &'static [&'static str],
    next: Option<TextLine<'t>>,
}

/// A card: a keyword, or a line of data.
pub enum Card<'t> {
    /// A keyword with its parameters.
    Keyword(Keyword<'t>),
    /// A line of data.
    Data(Data<'t>),
}

/// A keyword and its parameters.
pub struct Keyword<'t> {
    /// The keyword in capitals without its asterisk, with one blank between its words: "END PART".
    pub name: String,
    /// The line, counted from 1.
    pub line: usize,
    /// The last line that continues it.
    pub last_line: usize,
    parameters: Vec<Parameter<'t>>,
}

/// A parameter of a keyword.
struct Parameter<'t> {
    /// Its name in capitals, without blanks.
    name: String,
    value: Option<String>,
    word: Word<'t>,
    /// True once a reader has asked for it.
    is_read: Cell<bool>,
}

/// A line of data, and the lines that continue it.
pub struct Data<'t> {
    /// The line, counted from 1.
    pub line: usize,
    /// The fields between commas.
    pub words: Vec<Word<'t>>,
    /// True where the last line ends with a comma.
    is_open: bool,
}

impl<'a, 't> Cards<'a, 't> {
    /// The cards of a text from where it stands. `flags`: parameters without a value.
    pub fn new(text: &'a mut Text<'t>, flags: &'static [&'static str]) -> Self {
        let next = content(text);
        Cards { text, flags, next }
    }

    /// The next card; `None` at the end of the file.
    pub fn card(&mut self) -> Option<Card<'t>> {
        let line = self.take()?;
        if begins_keyword(line) { Some(Card::Keyword(self.keyword(line))) } else { Some(Card::Data(data(line))) }
    }

    /// Appends lines to a data line with `wanted` fields: after a final comma, or while all fields of the next line still fit.
    pub fn complete(&mut self, data: &mut Data<'t>, wanted: usize) {
        while data.filled() < wanted {
            let Some(next) = self.next.filter(|next| !begins_keyword(*next)) else { break };
            let more = self::data(next);
            if !data.is_open && data.filled() + more.filled() > wanted {
                break;
            }
            self.take();
            data.words.truncate(data.filled());
            data.words.extend(more.words);
            data.is_open = more.is_open;
        }
    }

    /// Returns the current line and advances.
    fn take(&mut self) -> Option<TextLine<'t>> {
        std::mem::replace(&mut self.next, content(self.text))
    }

    fn keyword(&mut self, line: TextLine<'t>) -> Keyword<'t> {
        let mut words = fields(line);
        let mut last = line;
        while last.bytes.ends_with(b",") {
            let Some(more) = self.next.filter(|next| self.has_parameters(*next)) else { break };
            words.extend(fields(more));
            self.take();
            last = more;
        }
        let first = words.first().map(Word::text).unwrap_or_default();
        let name = first.trim_start_matches('*').split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
        let parameters = words.iter().skip(1).filter(|word| !word.bytes.is_empty()).map(parameter).collect();
        Keyword { name, line: line.number, last_line: last.number, parameters }
    }

    /// True for a line that has the form of parameters.
    fn has_parameters(&self, line: TextLine) -> bool {
        let is_parameter = |word: &Word| {
            let Parameter { name, value, .. } = parameter(word);
            let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic());
            let is_flag = || self.flags.iter().any(|flag| stands_for(&name, flag));
            word.bytes.is_empty() || is_name && (value.is_some() || is_flag())
        };
        !begins_keyword(line) && fields(line).iter().all(is_parameter)
    }
}

impl Keyword<'_> {
    /// The keyword in capitals without blanks.
    pub fn key(&self) -> String {
        self.name.replace(' ', "")
    }

    /// Value of a parameter, which may be abbreviated; `None` if it is missing or empty.
    pub fn value(&self, name: &str) -> Option<&str> {
        self.parameter(name)?.value.as_deref().filter(|value| !value.is_empty())
    }

    /// True where a parameter is there, with a value or without.
    pub fn has(&self, name: &str) -> bool {
        self.parameter(name).is_some()
    }

    /// Forgets who has asked for parameters: its reader begins.
    pub fn forget_reads(&self) {
        self.parameters.iter().for_each(|parameter| parameter.is_read.set(false));
    }

    /// The names and values of the parameters that no reader has asked for.
    pub fn unread(&self) -> impl Iterator<Item = (&str, &str)> {
        let unread = self.parameters.iter().filter(|parameter| !parameter.is_read.get());
        unread.map(|parameter| (&*parameter.name, parameter.value.as_deref().unwrap_or_default()))
    }

    /// An error at a parameter, or at the keyword where it is missing.
    pub fn fault(&self, text: &Text, name: &str, message: impl Into<String>) -> Fault {
        match self.parameter(name) {
            Some(parameter) => text.fault_at(message, &parameter.word),
            None => text.fault(message, self.line),
        }
    }

    fn parameter(&self, name: &str) -> Option<&Parameter<'_>> {
        let whole = self.parameters.iter().find(|parameter| parameter.name == name);
        let found = whole.or_else(|| self.parameters.iter().find(|parameter| stands_for(&parameter.name, name)))?;
        found.is_read.set(true);
        Some(found)
    }
}

impl Data<'_> {
    /// The fields up to the last that is not blank.
    pub fn filled(&self) -> usize {
        self.words.iter().rposition(|word| !word.bytes.is_empty()).map_or(0, |last| last + 1)
    }
}

/// A name in a field: without its quotes, or without blanks where it has none.
pub fn name_in(word: &Word) -> String {
    unquoted(&word.text())
}

fn unquoted(text: &str) -> String {
    let text = text.trim();
    match text.strip_prefix('"') {
        Some(rest) => rest.strip_suffix('"').unwrap_or(rest).to_owned(),
        None => text.split_whitespace().collect(),
    }
}

/// True where a word is a parameter or an abbreviation of it.
pub fn stands_for(word: &str, parameter: &str) -> bool {
    word == parameter || word.len() >= ABBREVIATION && parameter.starts_with(word)
}

fn parameter<'t>(word: &Word<'t>) -> Parameter<'t> {
    let text = word.text();
    let (name, value) = text.split_once('=').map_or((text.as_str(), None), |(name, value)| (name, Some(value)));
    let name = name.split_whitespace().collect::<String>().to_ascii_uppercase();
    Parameter { name, value: value.map(unquoted), word: *word, is_read: Cell::new(false) }
}

fn begins_keyword(line: TextLine) -> bool {
    line.bytes.trim_ascii_start().starts_with(b"*")
}

fn data(line: TextLine) -> Data {
    Data { line: line.number, words: fields(line), is_open: line.bytes.ends_with(b",") }
}

/// The next line that is not a comment. An asterisk alone is one.
fn content<'t>(text: &mut Text<'t>) -> Option<TextLine<'t>> {
    let is_comment = |line: &TextLine| {
        let bytes = line.bytes.trim_ascii();
        bytes.starts_with(b"**") || bytes == b"*"
    };
    std::iter::from_fn(|| text.line()).find(|line| !is_comment(line))
}

/// The fields of a line between commas, without the blanks around them. Nothing after a last comma is no field.
fn fields(line: TextLine) -> Vec<Word> {
    if !line.bytes.contains(&b'"') {
        return line.fields().collect();
    }
    let (mut fields, mut start, mut quoted) = (Vec::new(), 0, false);
    for (at, byte) in line.bytes.iter().chain([&b',']).enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            // A quote that is not closed ends with its line.
            b',' if !quoted || at == line.bytes.len() => {
                let field = &line.bytes[start..at];
                let blank = field.len() - field.trim_ascii_start().len();
                fields.push(Word { bytes: field.trim_ascii(), column: start + blank, line: line.number });
                start = at + 1;
            }
            _ => {}
        }
    }
    if line.bytes.ends_with(b",") && !quoted {
        fields.pop();
    }
    fields
}
