//! Tables of an output folder are read back row by row and never held whole. A killed run may leave a last line without its end: it is
//! omitted and reported to the reader.

use super::disk::at;
use super::table::{CASE, STAGE};
use super::tables;
use base::text_file::open_regular;
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

/// The number of bytes that are asked for at a time.
const CHUNK: usize = 1 << 18;

/// A table that is being read.
pub struct TableReader {
    path: PathBuf,
    reader: BufReader<File>,
    /// The current row, without its line break.
    line: Vec<u8>,
    /// The names of the columns.
    pub header: Vec<String>,
    /// For each column, whether it is a key.
    keys: Vec<bool>,
    /// The place of the column of stages, and the stage whose rows alone are read.
    stage: Option<(usize, String)>,
    /// The number of rows so far, without the header.
    pub count: usize,
    /// True if the last line had no end; known after all rows have been read.
    pub truncated: bool,
}

impl TableReader {
    /// Opens a table and reads its header.
    ///
    /// # Errors
    /// The file cannot be read, is not a regular file, or has no whole header; the error names it.
    pub fn open(path: &Path) -> io::Result<TableReader> {
        let file = open_regular(path).map_err(|e| at(path, e))?;
        let reader = BufReader::with_capacity(CHUNK, file);
        let (path, line) = (path.to_owned(), Vec::new());
        let (header, keys) = (Vec::new(), Vec::new());
        let mut rows = TableReader { path, reader, line, header, keys, stage: None, count: 0, truncated: false };
        if !rows.read()? {
            let text = "no whole header row: the file was cut short";
            return Err(at(&rows.path, io::Error::new(io::ErrorKind::InvalidData, text)));
        }
        rows.header = fields(&rows.line).map(|field| text(field).into_owned()).collect();
        rows.keys = rows.find_keys()?;
        Ok(rows)
    }

    /// Reads the rows of one stage alone.
    ///
    /// # Errors
    /// The table has no stages; the error names it.
    pub fn in_stage(&mut self, stage: &str) -> io::Result<()> {
        let none = || at(&self.path, io::Error::other("its rows are of no stage: the deck has no `[[stages]]`"));
        self.stage = Some((self.column(STAGE).ok_or_else(none)?, stage.to_owned()));
        Ok(())
    }

    /// For each column, whether it is a key. The definition of the table decides. In a table of another program, keys are the leading
    /// columns after `step` and `time` with text in the first row. Names of columns do not decide: `contact` is a name in one table and an
    /// energy in another.
    fn find_keys(&mut self) -> io::Result<Vec<bool>> {
        let file = self.path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if let Some(table) = tables::of_file(file) {
            let is_key = |column: &String| {
                [STAGE, CASE].contains(&column.as_str())
                    || table.columns().any(|known| known.is_key() && known.name == column)
            };
            return Ok(self.header.iter().map(is_key).collect());
        }
        let ahead = self.reader.fill_buf().map_err(|e| at(&self.path, e))?;
        let row = ahead.split(|&byte| byte == b'\n').next().unwrap_or_default();
        let is_when = |column: &String| matches!(column.as_str(), "step" | "time");
        let is_text = |field: &[u8]| {
            !field.is_empty() && std::str::from_utf8(field).is_ok_and(|text| text.trim().parse::<f64>().is_err())
        };
        let mut heads = true;
        let columns = self.header.iter().zip(fields(row).map(Some).chain(std::iter::repeat(None)));
        Ok(columns
            .map(|(column, field)| {
                if is_when(column) {
                    return false;
                }
                heads = heads && field.is_some_and(is_text);
                heads
            })
            .collect())
    }

    /// Whether a column, given by its place from 0, is a key.
    pub fn is_key(&self, place: usize) -> bool {
        self.keys.get(place).copied().unwrap_or(false)
    }

    /// The place of the frequency or speed of rows at one time: of a column of numbers before a key.
    pub fn abscissa(&self) -> Option<usize> {
        let first = self.header.iter().position(|name| !["step", "time", STAGE, CASE].contains(&name.as_str()))?;
        (!self.is_key(first) && self.keys[first..].contains(&true)).then_some(first)
    }

    /// The next row, without its line break; `None` where no whole one is left.
    ///
    /// # Errors
    /// The file cannot be read; the error names it.
    pub fn next_row(&mut self) -> io::Result<Option<&[u8]>> {
        loop {
            if !self.read()? {
                return Ok(None);
            }
            self.count += 1;
            let is_of = |(place, stage): &(usize, String)| {
                fields(&self.line).nth(*place).is_some_and(|own| text(own) == *stage)
            };
            if self.stage.as_ref().is_none_or(is_of) {
                break;
            }
        }
        Ok(Some(&self.line))
    }

    /// Reads the next line that ends a row; false if there is no whole one.
    fn read(&mut self) -> io::Result<bool> {
        self.line.clear();
        loop {
            let more = self.reader.read_until(b'\n', &mut self.line).map_err(|e| at(&self.path, e))?;
            if self.line.last() != Some(&b'\n') {
                self.truncated |= !self.line.is_empty();
                self.line.clear();
                return Ok(false);
            }
            // A quoted name may hold line breaks.
            let open = self.line.contains(&b'"') && self.line.iter().filter(|&&byte| byte == b'"').count() % 2 == 1;
            if !open {
                break;
            }
            if more == 0 {
                self.truncated = true;
                self.line.clear();
                return Ok(false);
            }
        }
        self.line.pop();
        if self.line.last() == Some(&b'\r') {
            self.line.pop();
        }
        Ok(true)
    }

    /// The error of a row with more or fewer fields than the header.
    pub fn ragged(&self, fields: usize) -> io::Error {
        let (row, columns) = (self.count, self.header.len());
        let text = format!("row {row} has {fields} fields, the header {columns}");
        at(&self.path, io::Error::new(io::ErrorKind::InvalidData, text))
    }

    /// The place of a column from 0; `None` if no column has that name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|other| other == name)
    }
}

/// The fields of a row as they stand there, quotes included.
pub fn fields(row: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut quoted = false;
    row.split(move |&byte| {
        quoted ^= byte == b'"';
        byte == b',' && !quoted
    })
}

/// The text of a field, without the quotes around it and with those within it single.
pub fn text(field: &[u8]) -> Cow<'_, str> {
    match field {
        [b'"', inner @ .., b'"'] => Cow::Owned(String::from_utf8_lossy(inner).replace("\"\"", "\"")),
        plain => String::from_utf8_lossy(plain),
    }
}

/// The bits of a field `NaN`, the result of a failed computation; an empty field means that there is no number.
pub const FAILED: u64 = 0x7ff8_0000_0000_0002;

/// The number of a field. An empty field is NaN. A field `NaN` has the bits [`FAILED`]. Any other text is a NaN that contains its hash, so
/// that equal texts have equal bits.
pub fn number(field: &[u8]) -> f64 {
    if field.is_empty() {
        return f64::NAN;
    }
    match std::str::from_utf8(field).ok().and_then(|text| text.parse::<f64>().ok()) {
        Some(number) if number.is_nan() => f64::from_bits(FAILED),
        Some(number) => number,
        None => {
            let hash = field
                .iter()
                .fold(0xcbf2_9ce4_8422_2325_u64, |h, &byte| (h ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
            f64::from_bits(0x7ff8_0000_0000_0000 | (hash >> 13) | 1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_fields_are_those_of_the_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        std::fs::write(&path, "step,name,x\n0,\"a, \"\"b\"\"\nc\",1.5\r\n1,d,\n2,e,3").unwrap();
        let mut rows = TableReader::open(&path).unwrap();
        assert_eq!(rows.header, ["step", "name", "x"]);
        let read: Vec<String> =
            fields(rows.next_row().unwrap().unwrap()).map(|field| text(field).into_owned()).collect();
        assert_eq!(read, ["0", "a, \"b\"\nc", "1.5"]);
        assert!(number(fields(rows.next_row().unwrap().unwrap()).nth(2).unwrap()).is_nan());
        assert!(rows.next_row().unwrap().is_none());
        assert!(rows.truncated && rows.count == 2);
        std::fs::write(&path, "step\n").unwrap();
        assert!(!TableReader::open(&path).unwrap().truncated);
        // A table may end within a name of two lines, and before its header is whole.
        std::fs::write(&path, "step,name\n0,\"a\n").unwrap();
        let mut rows = TableReader::open(&path).unwrap();
        assert!(rows.next_row().unwrap().is_none() && rows.truncated);
        for torn in ["", "step,na"] {
            std::fs::write(&path, torn).unwrap();
            assert!(TableReader::open(&path).is_err_and(|error| error.to_string().contains("cut short")));
        }
    }

    #[test]
    fn keys_are_those_of_the_definition_or_of_the_position() {
        let dir = tempfile::tempdir().unwrap();
        let keys = |file: &str, text: &str| -> Vec<String> {
            let path = dir.path().join(file);
            std::fs::write(&path, text).unwrap();
            let rows = TableReader::open(&path).unwrap();
            (0..rows.header.len()).filter(|&i| rows.is_key(i)).map(|i| rows.header[i].clone()).collect()
        };
        // `contact` is an energy here, whatever contacts.csv calls by this word; `total` is a column of another program.
        assert!(keys("energy.csv", "step,time,kinetic,contact,total\n0,0.0,1.0,2.0,3.0\n").is_empty());
        assert_eq!(keys("contacts.csv", "step,time,contact,touching,gap\n"), ["contact"]);
        assert_eq!(keys("sections.csv", "step,time,beam,element,point,s\n"), ["beam", "element", "point"]);
        // Tables of other programs are read by the positions of their columns.
        assert!(keys("probe.csv", "time,contact,node\n0.0,1.0,2.0\n").is_empty());
        assert_eq!(keys("probe.csv", "step,time,who,where,link\n0,0.0,a,b,1.0\n"), ["who", "where"]);
        assert_eq!(keys("probe.csv", "time,who,ux,state\n0.0,a,1.0,open\n"), ["who"]);
        assert!(keys("probe.csv", "time,link,ux\n0.0,nan,1e3\n").is_empty());
    }

    #[test]
    fn text_is_a_number_of_its_own() {
        assert_eq!(number(b"-1.5e-3"), -1.5e-3);
        assert_eq!(number(b"ux").to_bits(), number(b"ux").to_bits());
        assert!(number(b"ux").is_nan() && number(b"ux").to_bits() != number(b"uy").to_bits());
        assert!(number(b"").is_nan() && number(b"").to_bits() != FAILED);
        assert!([&b"NaN"[..], b"nan", b"-NaN"].iter().all(|text| number(text).to_bits() == FAILED));
    }
}
