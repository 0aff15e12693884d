//! Values that follow one another along the lines of a file, as most data bases write records.

use super::header::{ACCELERATIONS, Header};
use super::number::{is_comment, is_number_like, number, numbers};
use base::text_file::{Fault, Text, TextLine};

/// The largest number of errors reported per file.
pub const MOST_FAULTS: usize = 10;

/// Reads the values of a file row by row, `step` apart from t = 0 on. Without a header, lines of text before the numbers are skipped.
///
/// # Errors
/// All errors found in the file, at least one and at most some.
pub fn read_rows(mut text: Text, header: Option<&Header>, step: f64) -> Result<Vec<[f64; 2]>, Vec<Fault>> {
    let last_line = header.map_or(0, |header| header.last_line);
    let mut rows = Rows { count: header.and_then(|header| header.count), step, points: Vec::new(), faults: Vec::new() };
    let mut has_begun = header.is_some();
    while let Some(line) = text.line() {
        let is_comment = is_comment(line);
        has_begun |= !is_comment && is_number_like(&String::from_utf8_lossy(line.bytes));
        if line.number <= last_line || is_comment || !has_begun {
            continue;
        }
        if header.is_some_and(|header| header.has_more_blocks) && rows.is_full() {
            rows.require_one_channel(&text, line);
        } else if rows.is_full() && !is_number_like(&String::from_utf8_lossy(line.bytes)) {
            // A remark of whoever processed the record, such as `END OF FILE`.
            break;
        } else {
            rows.line(&text, line);
        }
        if rows.faults.len() >= MOST_FAULTS || rows.is_overfull() {
            break;
        }
    }
    rows.finish(&text)
}

struct Rows {
    count: Option<usize>,
    step: f64,
    points: Vec<[f64; 2]>,
    faults: Vec<Fault>,
}

impl Rows {
    fn is_full(&self) -> bool {
        self.count == Some(self.points.len())
    }

    fn is_overfull(&self) -> bool {
        self.count.is_some_and(|count| self.points.len() > count)
    }

    fn line(&mut self, text: &Text, line: TextLine) {
        if let Some(fault) = decimal_commas(text, line) {
            self.faults.push(fault);
            return;
        }
        let was_full = self.is_full();
        for word in numbers(line) {
            let Some(value) = number(&word) else {
                let fault = text.fault_at(format!("`{}` is not a finite number", word.text()), &word);
                self.faults.push(Box::new(fault.hint("a record has a number at each of its times")));
                continue;
            };
            // The last row may be filled with zeros.
            if self.is_full() && value == 0.0 && !was_full {
                continue;
            }
            self.points.push([self.points.len() as f64 * self.step, value]);
            if let Some(count) = self.count.filter(|_| self.is_overfull()) {
                let fault = text.fault_at(format!("there are more values than NPTS = {count} says"), &word);
                self.faults.push(Box::new(fault.hint("`columns` chooses one of several columns")));
                return;
            }
        }
    }

    /// Reports a second channel behind the first one.
    fn require_one_channel(&mut self, text: &Text, line: TextLine) {
        if String::from_utf8_lossy(line.bytes).to_ascii_uppercase().contains(ACCELERATIONS) {
            let message =
                "the file has a second channel, and rdsolve reads one only: write the channel to a separate file";
            self.faults.push(text.fault(message, line.number));
        }
    }

    fn finish(mut self, text: &Text) -> Result<Vec<[f64; 2]>, Vec<Fault>> {
        let found = self.points.len();
        if self.faults.is_empty() && found < 2 {
            self.faults.push(text.fault_at_end("a record needs two values or more"));
        }
        if let Some(count) = self.count.filter(|count| self.faults.is_empty() && found < *count) {
            let message = format!("there are {found} values, and NPTS = {count} says more: the file is cut short");
            self.faults.push(text.fault_at_end(message));
        }
        if self.faults.is_empty() { Ok(self.points) } else { Err(self.faults) }
    }
}

/// Reports a line of several words with decimal commas: one comma between digits and no point in each.
fn decimal_commas(text: &Text, line: TextLine) -> Option<Fault> {
    let is_decimal = |bytes: &[u8]| {
        let parts: Vec<&[u8]> = bytes.split(|&byte| byte == b',').collect();
        parts.len() == 2 && !parts[1].is_empty() && !bytes.contains(&b'.')
    };
    let first = line.words().next().filter(|_| line.words().nth(1).is_some())?;
    line.words().all(|word| is_decimal(word.bytes)).then(|| {
        let fault = text.fault_at(format!("`{}` is not a finite number", first.text()), &first);
        Box::new(fault.hint("decimals stand behind a point"))
    })
}
