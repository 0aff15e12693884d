//! Headers of data bases, recognized by their content, not by the file name.
//!
//! - PEER, .AT2, .VT2 and .DT2: lines of text with the unit after `UNITS OF`. The number of values and their time step are written as
//!   `NPTS= 5372, DT= .0100 SEC` or as `5372 0.0100 NPTS, DT`, in either order.
//! - ESM and ITACA: lines `NDATA: 5372`, `SAMPLING_INTERVAL_S: 0.005` and `UNITS: cm/s^2` among others.
//! - K-NET and KiK-net: lines `Sampling Freq(Hz) 100Hz` and `Scale Factor 3920(gal)/6182761`; the last line is `Memo.`.
//! - CSMIP, volume 2: `5372 points of accel data equally spaced at .010 sec, in cm/sec2`; velocities and displacements follow.

use super::number::{is_comment, is_number_like, numbers, whole};
use super::unit::RecordUnit;
use base::text_file::{Fault, Text, TextLine};

/// The header of a record whose values stand row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// The number of values; `None` where the header does not say it.
    pub count: Option<usize>,
    /// The time between two values, in seconds.
    pub step: f64,
    /// The unit, where the header names one.
    pub unit: Option<RecordUnit>,
    /// The factor from the numbers of the file to the unit.
    pub factor: f64,
    /// True where the numbers have the offset of the instrument.
    pub has_offset: bool,
    /// True where other blocks follow the values.
    pub has_more_blocks: bool,
    /// The number of the last line before the values.
    pub last_line: usize,
}

/// Largest number of lines of a header.
const LONGEST: usize = 150;
/// The line of CSMIP files before the accelerations of a channel.
pub const ACCELERATIONS: &str = "POINTS OF ACCEL DATA EQUALLY SPACED AT";

/// Finds the header of a record; `None` for a file without one that is known here.
///
/// # Errors
/// A header that is known and says no sound number of values or time between them.
pub fn find(path: &str, bytes: &[u8]) -> Result<Option<Header>, Fault> {
    let mut text = Text::new(path, bytes);
    let mut found = Found::default();
    while let Some(line) = text.line().filter(|line| line.number <= LONGEST) {
        if is_comment(line) {
            continue;
        }
        let words = words(line);
        if words.contains(ACCELERATIONS) {
            return csmip(&text, line, &words).map(Some);
        }
        let is_complete = found.count.is_some() && found.step.is_some();
        if is_complete && (is_number_like(&words) || !is_text(&words)) {
            break;
        }
        found.read(&text, line, &words)?;
        if words.starts_with("MEMO.") && found.frequency.is_some() {
            break;
        }
    }
    Ok(found.header())
}

/// The header of a file that begins with the number of its values and the time between two, after lines of text; `None` for others.
pub fn counted(path: &str, bytes: &[u8]) -> Option<Header> {
    let mut text = Text::new(path, bytes);
    let mut unit_named = None;
    let first = loop {
        let line = text.line()?;
        if !is_comment(line) && is_number_like(&String::from_utf8_lossy(line.bytes)) {
            break line;
        }
        unit_named = unit_named.or_else(|| known_unit(line));
    };
    let lines = std::iter::from_fn(|| text.line()).filter(|line| !is_comment(*line));
    let [count, step] = numbers(first).map(|word| word.number()).collect::<Option<Vec<f64>>>()?.try_into().ok()?;
    // A shorter file might be two columns.
    let is_count = count.fract() == 0.0 && (10.0..1e9).contains(&count) && step > 0.0;
    let is_counted = is_count && lines.map(|line| numbers(line).count()).sum::<usize>() == count as usize;
    is_counted.then_some(Header {
        count: Some(count as usize),
        step,
        unit: unit_named,
        factor: 1.0,
        has_offset: false,
        has_more_blocks: false,
        last_line: first.number,
    })
}

/// Reports files of data bases whose numbers are not those of one record alone: COSMOS and SMC.
pub fn unread(path: &str, bytes: &[u8]) -> Option<Fault> {
    let mut text = Text::new(path, bytes);
    let line = text.line()?;
    let words = String::from_utf8_lossy(line.bytes).to_ascii_uppercase();
    let kind = match words.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ').trim_end() {
        words if words.contains("(FORMAT V") => "COSMOS",
        "CORRECTED ACCELEROGRAM" | "UNCORRECTED ACCELEROGRAM" => "SMC",
        _ => return None,
    };
    let fault = text.fault(format!("this is a file of {kind}, which rdsolve does not read"), line.number);
    Some(Box::new(fault.hint("write its accelerations to a file of one column, and give `time_step` and `unit`")))
}

/// True for a line that has a word or a name before a colon.
fn is_text(words: &str) -> bool {
    words.contains(':') || words.as_bytes().windows(2).any(|pair| pair.iter().all(u8::is_ascii_alphabetic))
}

/// The data of a header found so far.
#[derive(Default)]
struct Found {
    count: Option<usize>,
    step: Option<f64>,
    unit: Option<RecordUnit>,
    frequency: Option<f64>,
    factor: Option<f64>,
    last_line: usize,
}

impl Found {
    fn read(&mut self, text: &Text, line: TextLine, words: &str) -> Result<(), Fault> {
        self.last_line = line.number;
        if self.unit.is_none() {
            self.unit = unit(line, words);
        }
        if let Some(rest) = words.strip_prefix("SAMPLING FREQ(HZ)") {
            self.frequency = rest.trim().trim_end_matches("HZ").parse().ok().filter(|hertz: &f64| *hertz > 0.0);
        }
        if let Some((gals, counts)) = words.strip_prefix("SCALE FACTOR").and_then(|rest| rest.split_once("(GAL)/")) {
            let number = |text: &str| text.trim().parse::<f64>().ok();
            self.factor = number(gals).zip(number(counts)).map(|(gals, counts)| gals / counts);
        }
        let (count, step) = sizes(words);
        if let Some(count) = count {
            let number = whole(count).filter(|count| *count >= 2);
            self.count = Some(number.ok_or_else(|| {
                text.fault(format!("NPTS is the number of values, 2 or more, not `{count}`"), line.number)
            })?);
        }
        if let Some(step) = step {
            let time = seconds(step).filter(|step| step.is_finite() && *step > 0.0);
            self.step = Some(time.ok_or_else(|| {
                text.fault(format!("DT is the time between two values, above 0, not `{step}`"), line.number)
            })?);
        }
        Ok(())
    }

    fn header(self) -> Option<Header> {
        let plain = |count: Option<usize>, step: f64, unit: Option<RecordUnit>| Header {
            count,
            step,
            unit,
            factor: 1.0,
            has_offset: false,
            has_more_blocks: false,
            last_line: self.last_line,
        };
        if let (Some(frequency), Some(factor)) = (self.frequency, self.factor.filter(|factor| factor.is_finite())) {
            let header = plain(None, 1.0 / frequency, Some(RecordUnit::new("gal")));
            return Some(Header { factor, has_offset: true, ..header });
        }
        let (count, step) = (self.count?, self.step?);
        Some(plain(Some(count), step, self.unit))
    }
}

/// The line in capitals; a tab has the place of a blank.
fn words(line: TextLine) -> String {
    String::from_utf8_lossy(line.bytes).trim().to_ascii_uppercase().replace('\t', " ")
}

/// The unit of a motion that a title or a comment names; "acceleration in direction x" names none.
pub fn known_unit(line: TextLine) -> Option<RecordUnit> {
    unit(line, &words(line)).filter(|unit| unit.known.is_some())
}

/// The unit that a line names, as the file writes it.
fn unit(line: TextLine, words: &str) -> Option<RecordUnit> {
    const BEFORE: [&str; 5] = ["UNITS OF ", "UNITS: ", "ACCELERATION IN ", "VELOCITY IN ", "DISPLACEMENT IN "];
    let place = BEFORE.iter().find_map(|before| words.find(before).map(|place| place + before.len()))?;
    // Upper case has the same places: only letters of ASCII are changed.
    let original = String::from_utf8_lossy(line.bytes);
    let name = original.trim().get(place..)?.split_whitespace().next()?;
    let name = name.trim_matches(['.', ',', ';', ':', '(', ')']);
    (!name.is_empty()).then(|| RecordUnit::new(name))
}

/// The number of values and the time between two of them, as a line writes them.
fn sizes(words: &str) -> (Option<&str>, Option<&str>) {
    const COUNT: [&str; 3] = ["NPTS", "NPT", "NDATA"];
    const STEP: [&str; 2] = ["DT", "SAMPLING_INTERVAL_S"];
    let is_between = |c: char| c.is_whitespace() || [',', '=', ':', ';', '(', ')'].contains(&c);
    let parts: Vec<&str> = words.split(is_between).filter(|part| !part.is_empty()).collect();
    let place = |names: &[&str]| parts.iter().position(|part| names.contains(part));
    let after = |place: usize| {
        let is_value = |part: &&&str| !["SEC", "SECS", "SECONDS", "S"].contains(*part);
        parts[place + 1..].iter().find(is_value).filter(|part| !COUNT.contains(*part) && !STEP.contains(*part)).copied()
    };
    match (place(&COUNT), place(&STEP)) {
        // 5372 0.0100 NPTS, DT
        (Some(count), Some(step)) if count.abs_diff(step) == 1 && count.min(step) >= 2 => {
            let first = count.min(step) - 2;
            let numbers = [parts[first], parts[first + 1]];
            if count < step { (Some(numbers[0]), Some(numbers[1])) } else { (Some(numbers[1]), Some(numbers[0])) }
        }
        (Some(count), Some(step)) => (after(count), after(step)),
        // Alone a name must begin its line: it might be that of a station.
        (Some(0), None) => (after(0), None),
        (None, Some(0)) => (None, after(0)),
        _ => (None, None),
    }
}

/// The seconds of `0.01`, `.01SEC` or `1.0D-2`.
fn seconds(text: &str) -> Option<f64> {
    text.trim_end_matches("ONDS").trim_end_matches("SEC").trim_end_matches('S').replace('D', "E").parse().ok()
}

/// The header of the accelerations of a channel.
fn csmip(text: &Text, line: TextLine, words: &str) -> Result<Header, Fault> {
    let (before, after) = words.split_once(ACCELERATIONS).unwrap_or_default();
    let count = before.split_whitespace().last().and_then(whole).filter(|count| *count >= 2);
    let step = after.split_whitespace().next().and_then(seconds).filter(|step| step.is_finite() && *step > 0.0);
    let (Some(count), Some(step)) = (count, step) else {
        let message =
            "this line says how many accelerations follow and how far apart they are, and one of the two is no number";
        return Err(text.fault(message, line.number));
    };
    // As `in cm/sec2`, `(UNITS: CM/SEC/SEC)`, `units=cm/sec2(04)` or `units = cm/sec2`.
    let named = || after.split_once("UNITS").map(|(before, rest)| (before, rest.trim_start()));
    let unit = after.split_once(" IN ").or_else(|| named().filter(|(_, rest)| rest.starts_with([':', '='])));
    let is_around = |c: char| c.is_whitespace() || [',', ';', '(', ')', ':', '='].contains(&c);
    let unit = unit.and_then(|(_, unit)| unit.split(is_around).find(|part| !part.is_empty()));
    let unit = unit.map(|unit| RecordUnit::new(&unit.trim_end_matches('.').to_ascii_lowercase()));
    Ok(Header {
        count: Some(count),
        step,
        unit,
        factor: 1.0,
        has_offset: false,
        has_more_blocks: true,
        last_line: line.number,
    })
}
