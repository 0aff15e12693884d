//! Records: a quantity over time in columns of a text file, as instruments and data bases give them.
//!
//! Columns stand between semicolons, commas, tabs or blanks, whichever the first line of numbers has. Lines that begin with `#`, `%` or `!` are
//! comments; one line of names may come before the numbers.

mod at2;

pub use at2::{is_at2, read_at2};

use crate::diagnostic::Diagnostic;
use crate::names::{nearest, quoted};
use crate::text_file::{Fault, Text, TextLine, Word};

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
    /// The column of the time and that of the value, or that of the value alone; none where the file has no others.
    pub columns: Vec<RecordColumn>,
    /// The time between two values, the first at 0; `None` where the file has the times.
    pub time_step: Option<f64>,
}

/// The largest number of errors of one file that are said.
const MOST_FAULTS: usize = 10;

/// Reads the points (time, value) of a record from the bytes of a file whose path, for messages, is `path`.
///
/// # Errors
/// All errors found in the file, at least one and at most some.
pub fn read(path: &str, bytes: &[u8], selection: &RecordSelection) -> Result<Vec<[f64; 2]>, Vec<Diagnostic>> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader =
        Reader { text: Text::new(path, bytes), separator: None, faults: Vec::new(), columns: 0, last: 0, blank: 0 };
    let points = reader.points(selection);
    if reader.faults.is_empty() {
        return Ok(points);
    }
    Err(reader.faults.into_iter().map(|fault| *fault).collect())
}

struct Reader<'t> {
    text: Text<'t>,
    /// What stands between columns; `None` for blanks.
    separator: Option<u8>,
    faults: Vec<Fault>,
    /// The number of columns of the first line of numbers.
    columns: usize,
    /// The number of the last line that was read, comments included, and of empty ones before it.
    last: usize,
    blank: usize,
}

/// The places of the wanted columns in a line, from 0.
struct Places {
    time: Option<usize>,
    value: usize,
}

impl<'t> Reader<'t> {
    fn points(&mut self, selection: &RecordSelection) -> Vec<[f64; 2]> {
        let Some((names, mut line)) = self.begin() else { return Vec::new() };
        let count = self.split(line).len();
        if !names.is_empty() && names.len() != count {
            let message = format!("the line of names has {} columns, that of numbers {count}", names.len());
            self.faults.push(self.text.fault(message, line.number));
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

    /// Finds the names of columns, none where the file has none, and the first line of numbers.
    fn begin(&mut self) -> Option<(Vec<String>, TextLine<'t>)> {
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
            return Some((Vec::new(), first));
        }
        let names = words.iter().map(|word| word.text().trim_matches(['"', '\'', ' ']).to_owned()).collect();
        let Some(line) = self.next_line() else {
            self.faults.push(self.text.fault_at_end("the file has a line of names and no numbers"));
            return None;
        };
        // Names may stand between other separators than numbers do.
        if separator(line) != self.separator && self.split(line).len() == 1 {
            self.separator = separator(line);
        }
        Some((names, line))
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

    /// A number of a line; what is wrong is noted.
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

/// What stands between the columns of a line: `None` for blanks.
fn separator(line: TextLine) -> Option<u8> {
    [b';', b',', b'\t'].into_iter().find(|separator| line.bytes.contains(separator))
}

/// Finds the wanted columns among `count`, some of which have names.
fn places(selection: &RecordSelection, names: &[String], count: usize) -> Result<Places, String> {
    let wanted = if selection.time_step.is_some() { 1 } else { 2 };
    let of_file = match names {
        [] => format!("the file has {count} of them, without names"),
        names => format!("the file has {}", quoted(names.iter().map(String::as_str))),
    };
    if selection.columns.is_empty() {
        let which = if wanted == 1 { "that of the value" } else { "that of the time and that of the value" };
        return match count == wanted {
            true => Ok(Places { time: (wanted == 2).then_some(0), value: wanted - 1 }),
            false if count == 1 => Err("the file has one column: `time_step` says how far apart its values are".into()),
            false => Err(format!("`columns` must say which is {which}: {of_file}")),
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
            Err("`columns` names two columns, that of the time and that of the value, or one beside `time_step`".into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn select(columns: &[RecordColumn], time_step: Option<f64>) -> RecordSelection {
        RecordSelection { columns: columns.to_vec(), time_step }
    }

    fn name(name: &str) -> RecordColumn {
        RecordColumn::Name(name.into())
    }

    fn faults(text: &str, selection: &RecordSelection) -> Vec<String> {
        read("r.csv", text.as_bytes(), selection).unwrap_err().into_iter().map(|problem| problem.message).collect()
    }

    #[test]
    fn columns_stand_as_they_do() {
        let wanted = vec![[0.0, 1.0], [0.5, -2.0], [0.5, 3.0]];
        for text in [
            "0,1\n0.5,-2\n0.5,3\n",
            "# a comment\r\n0 1\r\n\r\n5e-1\t-2.0\r\n 0.5  3\r\n",
            "\u{feff}time; acceleration\n0;1\n0.5;-2\n0.5;3",
            "t,a\n0.0,1,\n0.5,-2d0,\n0.5,3,",
        ] {
            assert_eq!(read("r", text.as_bytes(), &select(&[], None)).unwrap(), wanted, "{text:?}");
        }
        let text = "time,\"x\",y\n0,7,1\n1,8,2\n";
        for columns in [[name("time"), name("y")], [RecordColumn::Number(1), RecordColumn::Number(3)]] {
            assert_eq!(read("r", text.as_bytes(), &select(&columns, None)).unwrap(), [[0.0, 1.0], [1.0, 2.0]]);
        }
        let every = select(&[name("x")], Some(0.25));
        assert_eq!(read("r", text.as_bytes(), &every).unwrap(), [[0.0, 7.0], [0.25, 8.0]]);
        assert_eq!(read("r", b"3\n4\n5\n", &select(&[], Some(2.0))).unwrap(), [[0.0, 3.0], [2.0, 4.0], [4.0, 5.0]]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let plain = select(&[], None);
        for (text, selection, said) in [
            ("", &plain, "no lines of numbers"),
            ("t,a\n", &plain, "no numbers"),
            ("0,1\n", &plain, "two values or more"),
            ("0,1\n1,x\n2,y\n", &plain, "`x` is not a finite number"),
            ("0,1\n1,inf\n", &plain, "`inf` is not a finite number"),
            ("0,1\n1,,\n", &plain, "there is a gap: column 2 is empty"),
            ("0 1\n1\n", &plain, "there is a gap: the line has 1 column"),
            ("0,1\n2,1\n1,1\n", &plain, "the time falls: 1 comes after 2"),
            ("0,1\n0,2\n0,3\n", &plain, "more than twice"),
            ("0,1\n1,2,3\n", &plain, "the line has 3 columns, those before it 2"),
            ("\"t, s\",x\n0,1\n", &plain, "the line of names has 3 columns, that of numbers 2"),
            (
                "0\t1\t2\n1\t\t2\n",
                &select(&[RecordColumn::Number(1), RecordColumn::Number(2)], None),
                "there is a gap: column 2 is empty",
            ),
            ("nan\n1\n2\n", &select(&[], Some(1.0)), "`nan` is not a finite number"),
            ("--\n1\n2\n", &select(&[], Some(1.0)), "`--` is not a finite number"),
            ("1\n\n2\n", &select(&[], Some(1.0)), "there is a gap: the line is empty"),
            ("t,x,x\n0,1,2\n1,2,3\n", &select(&[name("t"), name("x")], None), "more than one column is named `x`"),
            ("0\n1\n", &plain, "`time_step` says"),
            ("0,1,2\n1,2,3\n", &plain, "`columns` must say"),
            ("t,acc\n0,1\n1,2\n", &select(&[name("t"), name("ac")], None), "did you mean `acc`?"),
            ("0,1\n1,2\n", &select(&[RecordColumn::Number(1), RecordColumn::Number(3)], None), "there is no column 3"),
            ("0,1\n1,2\n", &select(&[], Some(0.1)), "`columns` must say"),
            ("0,1\n1,2\n", &select(&[RecordColumn::Number(1), RecordColumn::Number(2)], Some(0.1)), "names one column"),
            ("0,1\n1,2\n", &select(&[RecordColumn::Number(1)], None), "names two columns"),
        ] {
            let found = faults(text, selection);
            assert!(found[0].contains(said), "{text:?}: {found:?}");
        }
        // All that is wrong is said at once, up to a limit.
        assert_eq!(faults("0,1\n1,x\n2,y\n3,4\n", &plain).len(), 2);
        let many: String = (0..100).map(|k| format!("{k},x\n")).collect();
        assert_eq!(faults(&many, &plain).len(), MOST_FAULTS);
    }

    #[test]
    fn a_million_points_take_less_than_a_second() {
        let text: String =
            (0..1_000_000).map(|k| format!("{:.4},{:.6}\n", k as f64 * 0.005, (k as f64).sin())).collect();
        let began = std::time::Instant::now();
        let points = read("r", text.as_bytes(), &select(&[], None)).unwrap();
        assert_eq!((points.len(), points[999_999][0]), (1_000_000, 4999.995));
        // Half a second would be 0.5 µs a point, three times what it takes; the machine may be busy.
        assert!(began.elapsed().as_secs_f64() < 3.0);
    }
}
