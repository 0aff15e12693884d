//! Records of the PEER ground motion data bases: files whose names end with `.AT2`.
//!
//! Four lines come first: three of text, the third with the unit, `UNITS OF G`, and one with the number of values and the time between two of
//! them, `NPTS= 5372, DT= .0100 SEC` or, in older files, `5372 0.0100 NPTS, DT`. Values follow between blanks, mostly five to a line; the first is
//! at t = 0. They are accelerations in g and are not converted.

use super::MOST_FAULTS;
use crate::diagnostic::Diagnostic;
use crate::text_file::{Fault, Text, TextLine};
use std::path::Path;

/// The number of lines before the values.
const HEADER: usize = 4;

/// True for the name of such a file.
pub fn is_at2(path: &str) -> bool {
    Path::new(path).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("at2"))
}

/// Reads the points (time, value in g) of a record from the bytes of a file whose path, for messages, is `path`.
///
/// # Errors
/// All errors found in the file, at least one and at most some.
pub fn read_at2(path: &str, bytes: &[u8]) -> Result<Vec<[f64; 2]>, Vec<Diagnostic>> {
    let mut text = Text::new(path, bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let (count, step, first) = header(&mut text).map_err(|fault| vec![*fault])?;
    let (mut points, mut faults): (Vec<[f64; 2]>, Vec<Fault>) = (Vec::new(), Vec::new());
    let mut next = first;
    while let Some(line) = next
        && faults.len() < MOST_FAULTS
    {
        for word in line.words() {
            if points.len() == count {
                faults.push(text.fault_at(format!("there are more values than NPTS = {count} says"), &word));
                return Err(faults.into_iter().map(|fault| *fault).collect());
            }
            let value = word.number().unwrap_or_else(|| {
                faults.push(text.fault_at(format!("`{}` is not a finite number", word.text()), &word));
                0.0
            });
            points.push([points.len() as f64 * step, value]);
        }
        next = text.line();
    }
    if faults.is_empty() && points.len() < count {
        let message = format!("there are {} values, and NPTS = {count} says more: the file is cut short", points.len());
        faults.push(text.fault_at_end(message));
    }
    if faults.is_empty() { Ok(points) } else { Err(faults.into_iter().map(|fault| *fault).collect()) }
}

/// Reads the lines before the values: their number, the time between two, and the line after.
fn header<'t>(text: &mut Text<'t>) -> Result<(usize, f64, Option<TextLine<'t>>), Fault> {
    let mut sizes = None;
    let mut next = text.line();
    while let Some(line) = next.filter(|line| line.number <= HEADER) {
        let words = String::from_utf8_lossy(line.bytes).to_ascii_uppercase();
        match line.number {
            3 => require_g(text, line, &words)?,
            HEADER => sizes = Some(self::sizes(text, line, &words)?),
            _ => {}
        }
        next = text.line();
    }
    match sizes {
        Some((count, step)) => Ok((count, step, next)),
        None => Err(text.fault("the fourth line of an .AT2 file says `NPTS= .., DT= ..`, and is missing", HEADER)),
    }
}

/// The third line names the unit; where it names none the record is taken to be in g.
fn require_g(text: &Text, line: TextLine, words: &str) -> Result<(), Fault> {
    let unit = words.split("UNITS OF").nth(1).map(str::trim);
    match unit {
        Some(unit) if unit.trim_end_matches('.') != "G" => {
            let fault =
                text.fault(format!("the record is in `{unit}`: an .AT2 file holds accelerations in g"), line.number);
            Err(Box::new(fault.hint("a record in other units goes into columns: `columns`, `time_step`, `scale`")))
        }
        _ => Ok(()),
    }
}

/// The number of values and the time between two.
fn sizes(text: &Text, line: TextLine, words: &str) -> Result<(usize, f64), Fault> {
    let parts: Vec<&str> = words
        .split(|c: char| c.is_whitespace() || [',', '=', ':'].contains(&c))
        .filter(|part| !part.is_empty())
        .collect();
    let after = |name: &str| parts.iter().position(|part| *part == name).and_then(|place| parts.get(place + 1));
    let found = match words.contains('=') {
        true => (after("NPTS"), after("DT")),
        // 5372 0.0100 NPTS, DT
        false if parts.get(2..4) == Some(&["NPTS", "DT"]) => (parts.first(), parts.get(1)),
        false => (None, None),
    };
    let (Some(count), Some(step)) = found else {
        return Err(text.fault("this line says `NPTS= .., DT= ..` in an .AT2 file", line.number));
    };
    let number = count.parse::<usize>().ok().filter(|count| *count >= 2);
    let Some(number) = number else {
        return Err(text.fault(format!("NPTS is the number of values, 2 or more, not `{count}`"), line.number));
    };
    let time = step.parse::<f64>().ok().filter(|step| step.is_finite() && *step > 0.0);
    let Some(time) = time else {
        return Err(text.fault(format!("DT is the time between two values, above 0, not `{step}`"), line.number));
    };
    Ok((number, time))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(sizes: &str, values: &str) -> String {
        format!("DATA BASE\nSomewhere, 1/1/1940, 180\nACCELERATION TIME SERIES IN UNITS OF G\n{sizes}\n{values}\n")
    }

    #[test]
    fn values_stand_row_by_row() {
        let values = "  .1E-01 -.2000000E-01\r\n 3.0D-2\n\n 0.04 0\n";
        let wanted = [[0.0, 0.01], [0.02, -0.02], [0.04, 0.03], [0.06, 0.04], [0.08, 0.0]];
        for sizes in
            ["NPTS=   5, DT=   .0200 SEC,", "5    0.0200    NPTS, DT", "npts = 5  dt= 2e-2 sec", "NPTS=5,DT=0.02"]
        {
            assert_eq!(read_at2("r.AT2", file(sizes, values).as_bytes()).unwrap(), wanted, "{sizes}");
        }
        // A header whose first lines are empty.
        let text = "\n\n\nNPTS= 2, DT= 1 SEC\n1 2\n";
        assert_eq!(read_at2("r.AT2", text.as_bytes()).unwrap(), [[0.0, 1.0], [1.0, 2.0]]);
        assert!(is_at2("a/b.AT2") && is_at2("b.at2") && !is_at2("at2") && !is_at2("b.csv"));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let sizes = "NPTS= 3, DT= .01 SEC";
        for (text, said, line) in [
            (String::new(), "is missing", 4),
            ("a\nb\nc\n".into(), "is missing", 4),
            (file("3 values", "1 2 3"), "this line says `NPTS", 4),
            (file("NPTS= 3.5, DT= .01", "1 2 3"), "not `3.5`", 4),
            (file("NPTS= 1, DT= .01", "1"), "2 or more", 4),
            (file("NPTS= 3, DT= 0", "1 2 3"), "above 0, not `0`", 4),
            (file("NPTS= 3, DT=", "1 2 3"), "this line says `NPTS", 4),
            (file(sizes, "1 2"), "there are 2 values, and NPTS = 3 says more", 5),
            (file(sizes, "1 2\n3 4"), "more values than NPTS = 3", 6),
            (file(sizes, "1 2\nx"), "`x` is not a finite number", 6),
            (file(sizes, "1 nan 3"), "`nan` is not a finite number", 5),
            (file(sizes, "-.1E-01-.2E-01 2 3"), "`-.1E-01-.2E-01` is not a finite number", 5),
            (file(sizes, "1 2 3").replace("OF G", "OF CM/S"), "the record is in `CM/S`", 3),
        ] {
            let found = read_at2("r.AT2", text.as_bytes()).unwrap_err();
            assert!(found[0].message.contains(said), "{text:?}: {:?}", found[0].message);
            let place = found[0].excerpt.as_ref().map(|excerpt| excerpt.line);
            assert_eq!(place, Some(line), "{text:?}");
        }
        // All that is wrong is said at once, up to a limit.
        let many = file("NPTS= 100, DT= 1", &"x\n".repeat(100));
        assert_eq!(read_at2("r", many.as_bytes()).unwrap_err().len(), MOST_FAULTS);
    }
}
