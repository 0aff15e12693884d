//! Abaqus and CalculiX input with included files: `*INCLUDE` inserts the lines of a file, and `INPUT=` of a keyword inserts its data.

use super::cards::{Card, Cards, Keyword};
use super::text::{Fault, Piece, Text};
use std::io;

/// Files within files at most.
const DEEPEST: usize = 9;

/// A file with the lines of those that it includes.
pub struct Included {
    /// All lines in their order.
    pub bytes: Vec<u8>,
    /// Where they come from.
    pub pieces: Vec<Piece>,
    /// The number of lines so far.
    lines: usize,
}

impl Included {
    /// A file that includes no other.
    pub fn alone(bytes: Vec<u8>) -> Included {
        Included { bytes, pieces: Vec::new(), lines: 0 }
    }

    /// Reads included files by `read`, with names as in the file. A file without includes stays unchanged.
    ///
    /// # Errors
    /// Errors name the line of an unreadable file, or of an endless include.
    pub fn new(
        path: &str,
        bytes: Vec<u8>,
        read: &mut dyn FnMut(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Included, Fault> {
        if !["INCLUDE", "INPUT"].iter().any(|word| has(&bytes, word.as_bytes())) {
            return Ok(Included::alone(bytes));
        }
        let mut included = Included { bytes: Vec::with_capacity(bytes.len()), pieces: Vec::new(), lines: 0 };
        included.add(path, &bytes, read, 0)?;
        Ok(included)
    }

    fn add(
        &mut self,
        path: &str,
        bytes: &[u8],
        read: &mut dyn FnMut(&str) -> io::Result<Vec<u8>>,
        depth: usize,
    ) -> Result<(), Fault> {
        let mut text = Text::new(path, bytes);
        let lines: Vec<&[u8]> = text.bytes.split(|&byte| byte == b'\n').collect();
        let mut cards = Cards::new(&mut text, &[]);
        let mut next = 0;
        while let Some(card) = cards.card() {
            let Card::Keyword(keyword) = card else { continue };
            let Some(name) = included(&keyword) else { continue };
            // The line that includes a whole file is none of the mesh.
            let end = if keyword.key() == "INCLUDE" { keyword.line - 1 } else { keyword.last_line };
            self.copy(path, &lines, next..end);
            next = keyword.last_line;
            let message = |why: String| keyword.fault(cards.text, "INPUT", format!("cannot read `{name}`: {why}"));
            if depth == DEEPEST {
                return Err(message(format!("files include each other more than {DEEPEST} deep")));
            }
            let bytes = read(name).map_err(|error| {
                let mut fault = message(error.to_string());
                fault.hints.push("the path is relative to the folder of the mesh".to_owned());
                fault
            })?;
            self.add(name, &bytes, read, depth + 1)?;
        }
        self.copy(path, &lines, next..lines.len());
        Ok(())
    }

    fn copy(&mut self, path: &str, lines: &[&[u8]], range: std::ops::Range<usize>) {
        if range.is_empty() {
            return;
        }
        self.pieces.push(Piece { first: self.lines + 1, path: path.to_owned(), line: range.start + 1 });
        self.lines += range.len();
        for line in &lines[range] {
            self.bytes.extend_from_slice(line);
            self.bytes.push(b'\n');
        }
    }
}

/// The keywords whose INPUT= names a file with their data.
const READ: &[&str] = &[
    "INCLUDE",
    "NODE",
    "ELEMENT",
    "NSET",
    "ELSET",
    "AMPLITUDE",
    "NODALTHICKNESS",
    "EQUATION",
    "MPC",
    "INITIALCONDITIONS",
    "BOUNDARY",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "TEMPERATURE",
];

/// The name of the file that a keyword includes. INPUT= of other keywords is not asked for, so it stays unread.
pub fn included<'k>(keyword: &'k Keyword) -> Option<&'k str> {
    READ.contains(&keyword.key().as_str()).then(|| keyword.value("INPUT")).flatten()
}

/// True where bytes hold a word, in whatever case.
fn has(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|part| part.eq_ignore_ascii_case(word))
}
