//! The records that amplitudes name: they are read before the model is built.

use super::data::RecordFile;
use crate::record::{self, RecordColumn, RecordSelection, RecordUnit, TimeSeries, UnitOfTimes, word_of_time};
use base::diagnostic::{At, Diagnostic, Span};
use base::names::short;
use base::text_file::read_regular;
use deck::Deck;
use deck::amplitudes::Amplitude;
use deck::output::Units;
use deck::words::ColumnName;
use sha2::{Digest, Sha256};
use std::path::Path;

/// A record that has been read.
#[derive(Debug)]
pub struct Record {
    /// Path as messages name it.
    pub path: String,
    /// The points (time, value): values as the file has them, times in the unit of the deck where both are known.
    pub points: Vec<[f64; 2]>,
    /// The unit of the values, where the file names it.
    pub unit: Option<RecordUnit>,
    /// SHA-256 of the file.
    pub digest: [u8; 32],
}

impl Record {
    /// The file, for the model to remember.
    pub fn origin(&self) -> RecordFile {
        RecordFile { path: self.path.clone(), digest: self.digest }
    }
}

/// Reads the records of all amplitudes, in their order, from the deck's folder; `None` for those without, or with errors. With all there
/// is to say about the files.
pub fn load_records(deck: &Deck, folder: &Path) -> (Vec<Option<Record>>, Vec<Diagnostic>) {
    let mut problems = Vec::new();
    let units = deck.units.as_ref().map(|units| &units.value);
    let all = deck.amplitudes.0.iter().map(|(_, amplitude)| match load(amplitude, folder, units) {
        Ok(Some((record, warnings))) => {
            problems.extend(warnings);
            Some(record)
        }
        Ok(None) => None,
        Err(found) => {
            problems.extend(found);
            None
        }
    });
    let records = all.collect();
    (records, problems)
}

fn load(
    amplitude: &Amplitude,
    folder: &Path,
    units: Option<&Units>,
) -> Result<Option<(Record, Vec<Diagnostic>)>, Vec<Diagnostic>> {
    let Some(file) = &amplitude.file else { return Ok(None) };
    let time_step = amplitude.time_step.as_ref();
    if let Some(step) = time_step.filter(|step| step.value <= 0.0) {
        return Err(vec![Diagnostic::error("`time_step` must be above 0").at(&step.span)]);
    }
    let rows = amplitude.rows.as_ref().map(|rows| rows.value);
    if let Some(columns) = amplitude.columns.as_ref().filter(|_| rows == Some(true)) {
        let message = "`columns` does not apply to a file that is read row by row";
        return Err(vec![Diagnostic::error(message).at(&columns.span)]);
    }
    let path = folder.join(&file.value).display().to_string();
    let bytes = read_regular(Path::new(&path)).map_err(|error| {
        let message = format!("cannot read the record `{path}`: {error}");
        vec![Diagnostic::error(message).at(&file.span).hint("the path is relative to the deck's folder")]
    })?;
    let column = |name: &ColumnName| match name {
        ColumnName::Name(name) => RecordColumn::Name(name.clone()),
        ColumnName::Number(number) => RecordColumn::Number(*number),
    };
    let columns = amplitude.columns.iter().flat_map(|columns| &columns.values).map(|at| column(&at.value)).collect();
    let time_unit = units.map(|units| units.scales()[2]);
    let selection = RecordSelection { columns, time_step: time_step.map(|step| step.value), rows, time_unit };
    let mut series = record::read(&path, &bytes, &selection).map_err(|found| at_file(found, &file.span))?;
    if let Some(at) = &amplitude.unit {
        series.unit = Some(given_unit(at, series.unit)?);
    }
    let mut warnings = warnings_of(amplitude, &file.value, &series);
    warnings.extend(series.times.as_ref().map(|times| of_times(times, file, units.map_or("", |units| units.label()))));
    let record = Record { path, points: series.points, unit: series.unit, digest: Sha256::digest(&bytes).into() };
    Ok(Some((record, warnings)))
}

/// The unit from the deck. It must not contradict the header.
fn given_unit(at: &At<String>, header: Option<RecordUnit>) -> Result<RecordUnit, Vec<Diagnostic>> {
    let unit = RecordUnit::new(at.value.trim());
    if unit.known.is_none() {
        let error = Diagnostic::error(format!("`{}` is no unit of a motion", at.value)).at(&at.span);
        return Err(vec![error.hint(
            "known: g, mg, %g, gal, and lengths such as m, cm, mm, in or ft alone, per s and per s2: \"cm/s2\"",
        )]);
    }
    match header.filter(|header| header.known.is_some() && header.known != unit.known) {
        Some(header) => {
            let error = Diagnostic::error(format!("the header of the file says {}", header.name)).at(&at.span);
            Err(vec![error.hint("leave `unit` out, or correct the header")])
        }
        None => Ok(unit),
    }
}

/// Notes converted times, and warns of an unknown unit of times.
fn of_times(times: &UnitOfTimes, file: &At<String>, units: &str) -> Diagnostic {
    let name = &file.value;
    let said = match times {
        UnitOfTimes::Converted(seconds) => {
            let word = word_of_time(*seconds);
            Diagnostic::note(format!(
                "the times of the record `{name}` are in {word}, and are converted to the units {units}"
            ))
            .hint("correct the unit in the file if they are in another one")
        }
        UnitOfTimes::Unknown(word) => {
            let message = format!(
                "`{word}`, beside the times of the record `{name}`, is no unit of time: they count in the units {units}"
            );
            Diagnostic::warning(message).hint("write s, ms, us, min or h into the file, or remove the word")
        }
    };
    said.at(&file.span)
}

/// Notes a subtracted offset, and a column that may be part of a sequence.
fn warnings_of(amplitude: &Amplitude, file: &str, series: &TimeSeries) -> Vec<Diagnostic> {
    let place = amplitude.columns.as_ref().map(|columns| &columns.span);
    let place = place.or(amplitude.file.as_ref().map(|file| &file.span));
    let mut warnings = Vec::new();
    if let Some((offset, unit)) = series.offset.zip(series.unit.as_ref()) {
        let message = format!(
            "the mean of the record `{file}`, {} {}, is subtracted: its instrument has an offset",
            short(offset),
            unit.name
        );
        let hint = "remove it from the file yourself if another baseline is meant";
        warnings.push(Diagnostic::note(message).hint(hint));
    }
    if let Some(count) = series.sequence {
        let message = format!(
            "`columns` selects one of the {count} values of each line of `{file}`, but the values along its lines look like one sequence"
        );
        let hint = "give `rows = true` to read them one after the other, or `rows = false` if columns are meant";
        warnings.push(Diagnostic::warning(message).hint(hint));
    }
    warnings.into_iter().map(|warning| place.iter().fold(warning, |warning, place| warning.at(place))).collect()
}

/// Errors of a file, with the place of its name in the deck.
fn at_file(found: Vec<Diagnostic>, place: &Span) -> Vec<Diagnostic> {
    found.into_iter().map(|problem| problem.at(place)).collect()
}
