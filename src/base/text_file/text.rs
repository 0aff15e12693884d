//! A file as lines and words, each with its place for messages.

use crate::diagnostic::{Diagnostic, Excerpt};
use crate::math::LARGEST_LENGTH;
use std::ops::Range;
use std::sync::OnceLock;

/// An error in the file.
pub type Fault = Box<Diagnostic>;

/// The bytes of a file, read line by line.
pub struct Text<'t> {
    /// The path of the file, for messages.
    pub path: &'t str,
    /// All bytes of the file.
    pub bytes: &'t [u8],
    /// Where its lines come from, if not all from this file.
    pieces: &'t [Piece],
    /// The place in `bytes` where the next line begins.
    next: usize,
    /// The number of the last line read.
    line: usize,
    /// The places in `bytes` behind the ends of all lines, from the first message on.
    ends: OnceLock<Vec<usize>>,
}

/// Lines in a row that come from one file.
#[derive(Debug, Clone)]
pub struct Piece {
    /// The number of the first in the text, counted from 1.
    pub first: usize,
    /// The path of the file, for messages.
    pub path: String,
    /// The number of the first in its file.
    pub line: usize,
}

/// A line without its end.
#[derive(Debug, Clone, Copy)]
pub struct TextLine<'t> {
    /// The bytes of the line, without the blanks at its end.
    pub bytes: &'t [u8],
    /// The number of the line, counted from 1.
    pub number: usize,
}

/// A part of a line, without blanks around it.
#[derive(Debug, Clone, Copy)]
pub struct Word<'t> {
    /// The bytes of the word.
    pub bytes: &'t [u8],
    /// The number of bytes of the line before it.
    pub column: usize,
    /// The number of the line, counted from 1.
    pub line: usize,
}

impl<'t> Text<'t> {
    /// The text from its first line, without a byte order mark.
    pub fn new(path: &'t str, bytes: &'t [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        Text { path, bytes, pieces: &[], next: 0, line: 0, ends: OnceLock::new() }
    }

    /// The text with lines of several files.
    pub fn of_pieces(path: &'t str, bytes: &'t [u8], pieces: &'t [Piece]) -> Self {
        Text { pieces, ..Text::new(path, bytes) }
    }

    /// Path of the file of a line, and the line number in it.
    pub fn origin(&self, line: usize) -> (&'t str, usize) {
        let piece = self.pieces[..self.pieces.partition_point(|piece| piece.first <= line)].last();
        piece.map_or((self.path, line), |piece| (piece.path.as_str(), piece.line + line - piece.first))
    }

    /// The bytes of the line of a number, without its end; empty behind the last line.
    pub fn line_of(&self, number: usize) -> &'t [u8] {
        let ends = self.ends.get_or_init(|| {
            let breaks = self.bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
            breaks.map(|(at, _)| at + 1).chain([self.bytes.len() + 1]).collect()
        });
        let number = number.max(1);
        let begin = if number == 1 { Some(0) } else { ends.get(number - 2).copied() };
        begin.and_then(|begin| self.bytes.get(begin..ends.get(number - 1)? - 1)).unwrap_or_default()
    }

    /// A line as messages show it.
    pub fn excerpt(&self, line: usize) -> Excerpt {
        let text = self.line_of(line).trim_ascii_end();
        let (path, line) = self.origin(line);
        Excerpt::new(path.to_owned(), line, text, 0..text.len())
    }

    /// Goes on behind the line of this number; the start of the text is before the line 1.
    pub fn skip_to(&mut self, line: usize) {
        while self.line < line
            && let Some(length) = self.bytes[self.next.min(self.bytes.len())..].iter().position(|&byte| byte == b'\n')
        {
            self.next += length + 1;
            self.line += 1;
        }
    }

    /// The next line that is not blank.
    pub fn line(&mut self) -> Option<TextLine<'t>> {
        while self.next < self.bytes.len() {
            let rest = &self.bytes[self.next..];
            let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
            self.next += length + 1;
            self.line += 1;
            let bytes = rest[..length].trim_ascii_end();
            if !bytes.is_empty() {
                return Some(TextLine { bytes, number: self.line });
            }
        }
        None
    }

    /// An error at a line.
    pub fn fault(&self, message: impl Into<String>, line: usize) -> Fault {
        let text = self.line_of(line).trim_ascii_end();
        let first = text.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(0);
        self.draw(message, line, text, first..text.len())
    }

    /// An error at a word.
    pub fn fault_at(&self, message: impl Into<String>, word: &Word) -> Fault {
        let text = self.line_of(word.line).trim_ascii_end();
        self.draw(message, word.line, text, word.column..word.column + word.bytes.len())
    }

    /// An error at a number on a line: the last of that value, since the number of an element comes before those of its nodes.
    pub fn fault_on(&self, message: impl Into<String>, line: usize, number: Option<u64>) -> Fault {
        let content = TextLine { bytes: self.line_of(line), number: line };
        let word = number.and_then(|number| {
            let in_words = content.words().filter(|word| word.whole() == Some(number)).last();
            in_words.or_else(|| content.fields().filter(|word| word.whole() == Some(number)).last())
        });
        match word {
            Some(word) => self.fault_at(message, &word),
            None => self.fault(message, line),
        }
    }

    /// An error at the end of the file.
    pub fn fault_at_end(&self, message: impl Into<String>) -> Fault {
        let last = self.bytes.iter().filter(|&&byte| byte == b'\n').count() + usize::from(!self.bytes.ends_with(b"\n"));
        self.fault(message, last.max(1))
    }

    /// An error with an excerpt of the line.
    fn draw(&self, message: impl Into<String>, line: usize, text: &[u8], columns: Range<usize>) -> Fault {
        let (path, line) = self.origin(line);
        Box::new(Diagnostic::error(message).of(Excerpt::new(path.to_owned(), line, text, columns)))
    }
}

impl<'t> TextLine<'t> {
    /// The parts between blanks.
    pub fn words(self) -> Words<'t> {
        Words { line: self, at: 0 }
    }

    /// The parts between commas, without the blanks around them. Nothing after a last comma is no part.
    pub fn fields(self) -> impl Iterator<Item = Word<'t>> {
        self.parts(b',')
    }

    /// The parts between separators, without the blanks around them. Nothing after a last separator is no part.
    pub fn parts(self, separator: u8) -> impl Iterator<Item = Word<'t>> {
        let (bytes, line, mut at) = (self.bytes, self.number, 0);
        std::iter::from_fn(move || {
            if at >= bytes.len() {
                return None;
            }
            let rest = &bytes[at..];
            let length = rest.iter().position(|&byte| byte == separator).unwrap_or(rest.len());
            let blank = rest[..length].len() - rest[..length].trim_ascii_start().len();
            let column = at + blank;
            at += length + 1;
            Some(Word { bytes: rest[..length].trim_ascii(), column, line })
        })
    }
}

/// The parts of a line between blanks.
pub struct Words<'t> {
    line: TextLine<'t>,
    at: usize,
}

impl<'t> Iterator for Words<'t> {
    type Item = Word<'t>;

    fn next(&mut self) -> Option<Word<'t>> {
        let TextLine { bytes, number } = self.line;
        let column = self.at + bytes[self.at..].iter().position(|byte| !byte.is_ascii_whitespace())?;
        let length = bytes[column..].iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len() - column);
        self.at = column + length;
        Some(Word { bytes: &bytes[column..self.at], column, line: number })
    }
}

impl Word<'_> {
    /// The word as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(self.bytes).into_owned()
    }

    /// A finite number, also with the exponent of Fortran.
    pub fn number(&self) -> Option<f64> {
        let text = std::str::from_utf8(self.bytes).ok()?;
        let read = text.parse().or_else(|error| match text.contains(['d', 'D']) {
            true => text.replace(['d', 'D'], "e").parse(),
            false => Err(error),
        });
        read.ok().filter(|number: &f64| number.is_finite())
    }

    /// A finite number as Fortran reads it: the letter of the exponent may be missing, as in `1.5-3`.
    pub fn fortran_number(&self) -> Option<f64> {
        let without_letter = || {
            let sign = self.bytes.iter().rposition(|byte| matches!(byte, b'+' | b'-')).filter(|&at| at > 0)?;
            let [mantissa, exponent] = [&self.bytes[..sign], &self.bytes[sign..]].map(std::str::from_utf8);
            let mantissa = mantissa.ok().filter(|text| {
                text.contains('.') && text.ends_with(['.', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'])
            })?;
            format!("{mantissa}e{}", exponent.ok()?).parse().ok().filter(|number: &f64| number.is_finite())
        };
        self.number().or_else(without_letter)
    }

    /// A coordinate: a finite number that is no larger than lengths are.
    pub fn coordinate(&self) -> Option<f64> {
        self.number().filter(|x| x.abs() <= LARGEST_LENGTH)
    }

    /// A whole number, not negative.
    pub fn whole(&self) -> Option<u64> {
        std::str::from_utf8(self.bytes).ok()?.parse().ok()
    }

    /// A whole number.
    pub fn signed(&self) -> Option<i64> {
        std::str::from_utf8(self.bytes).ok()?.parse().ok()
    }
}
