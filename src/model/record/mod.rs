//! Records: a quantity over time in a text file, as instruments and data bases give them.
//!
//! Values follow one another along the lines, if the header of a data base or the deck says so. Otherwise they stand in columns, separated
//! as in the first line of numbers: by semicolons, commas, tabs or blanks. Lines that begin with `#`, `%` or `!` are comments; titles, names
//! and units may come before the columns.

mod columns;
mod encoding;
mod head;
mod header;
mod number;
mod rows;
mod series;
mod unit;

pub use rows::MOST_FAULTS;
pub use series::{RecordColumn, RecordSelection, TimeSeries, UnitOfTimes};
pub use unit::{MotionQuantity, RecordUnit, word_of_time};

use base::diagnostic::Diagnostic;
use base::text_file::{Fault, Text};
use std::path::Path;

/// Reads a record from the bytes of a file whose path, for messages, is `path`.
///
/// # Errors
/// All errors found in the file, at least one and at most some.
pub fn read(path: &str, bytes: &[u8], selection: &RecordSelection) -> Result<TimeSeries, Vec<Diagnostic>> {
    read_text(path, &encoding::plain(bytes), selection)
        .map_err(|faults| faults.into_iter().map(|fault| *fault).collect())
}

fn read_text(path: &str, bytes: &[u8], selection: &RecordSelection) -> Result<TimeSeries, Vec<Fault>> {
    let text = Text::new(path, bytes);
    let found = header::find(path, bytes).map_err(|fault| vec![fault])?;
    let header = found.or_else(|| header::counted(path, bytes).filter(|_| selection.columns.is_empty()));
    if let Some(fault) = header::unread(path, bytes).filter(|_| header.is_none()) {
        return Err(vec![fault]);
    }
    let is_in_rows = selection.rows.unwrap_or(header.is_some() && selection.columns.is_empty());
    let is_bare = selection.columns.is_empty() && selection.time_step.is_none();
    if is_bare && header.is_none() && is_of_peer(path) {
        let fault = text.fault("no line says `NPTS= .., DT= ..`, as headers of the PEER data bases do", 1);
        return Err(vec![Box::new(fault.hint("`rows = true` and `time_step` read values without such a header"))]);
    }
    if !is_in_rows {
        let last = header.as_ref().map_or(0, |header| header.last_line);
        return columns::read_columns(text, last, selection, header.and_then(|header| header.unit));
    }
    let in_header = header.as_ref().map(|header| header.step / selection.time_unit.unwrap_or(1.0));
    let Some(step) = in_header.or(selection.time_step) else {
        let message = "the file does not say how far apart its values are: `rows = true` needs `time_step` beside it";
        return Err(vec![text.fault(message, 1)]);
    };
    if let (Some(given), Some(header)) = (selection.time_step, &header)
        && (given - step).abs() > 1e-6 * step
    {
        let own = match selection.time_unit.filter(|unit| *unit != 1.0) {
            Some(_) => format!("{} s, in the unit of the deck {step}", header.step),
            None => step.to_string(),
        };
        let message = format!("`time_step` is {given}, and the header says {own}: leave `time_step` out");
        return Err(vec![text.fault(message, header.last_line)]);
    }
    let points = rows::read_rows(text, header.as_ref(), step)?;
    let mut series = with_unit(points, header);
    series.times =
        in_header.zip(selection.time_unit).filter(|(_, unit)| *unit != 1.0).map(|_| UnitOfTimes::Converted(1.0));
    if series.unit.is_none() && has_extension(path, "at2") {
        series.unit = Some(RecordUnit::new("g"));
    }
    Ok(series)
}

/// The points in the unit of the header, without the offset of the instrument.
fn with_unit(mut points: Vec<[f64; 2]>, header: Option<header::Header>) -> TimeSeries {
    let Some(header) = header else {
        return TimeSeries { points, unit: None, offset: None, sequence: None, times: None };
    };
    points.iter_mut().for_each(|[_, value]| *value *= header.factor);
    let offset = header.has_offset.then(|| points.iter().map(|[_, value]| value).sum::<f64>() / points.len() as f64);
    points.iter_mut().for_each(|[_, value]| *value -= offset.unwrap_or(0.0));
    TimeSeries { points, unit: header.unit, offset, sequence: None, times: None }
}

/// True for the names of files from the PEER data bases.
fn is_of_peer(path: &str) -> bool {
    ["at2", "vt2", "dt2"].iter().any(|extension| has_extension(path, extension))
}

fn has_extension(path: &str, wanted: &str) -> bool {
    Path::new(path).extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}
