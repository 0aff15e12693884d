//! The records that amplitudes name: they are read before the model is built.

use super::data::RecordFile;
use crate::deck::Deck;
use crate::deck::amplitudes::Amplitude;
use crate::deck::words::ColumnName;
use crate::diagnostic::{Diagnostic, Span};
use crate::record::{self, RecordColumn, RecordSelection};
use crate::text_file::read_regular;
use sha2::{Digest, Sha256};
use std::path::Path;

/// A record that has been read.
#[derive(Debug)]
pub struct Record {
    /// Path as messages name it.
    pub path: String,
    /// The points (time, value) as the file has them.
    pub points: Vec<[f64; 2]>,
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
    let all = deck
        .amplitudes
        .0
        .iter()
        .map(|(_, amplitude)| load(amplitude, folder).map_err(|found| problems.extend(found)).ok().flatten());
    let records = all.collect();
    (records, problems)
}

fn load(amplitude: &Amplitude, folder: &Path) -> Result<Option<Record>, Vec<Diagnostic>> {
    let Some(file) = &amplitude.file else { return Ok(None) };
    let time_step = amplitude.time_step.as_ref();
    if let Some(step) = time_step.filter(|step| step.value <= 0.0) {
        return Err(vec![Diagnostic::error("`time_step` must be above 0").at(&step.span)]);
    }
    let path = folder.join(&file.value).display().to_string();
    let bytes = read_regular(Path::new(&path)).map_err(|error| {
        let message = format!("cannot read the record `{path}`: {error}");
        vec![Diagnostic::error(message).at(&file.span).hint("the path is relative to the deck's folder")]
    })?;
    if record::is_at2(&path) {
        let points = record::read_at2(&path, &bytes).map_err(|found| at_file(found, &file.span))?;
        return Ok(Some(Record { path, points, digest: Sha256::digest(&bytes).into() }));
    }
    let column = |name: &ColumnName| match name {
        ColumnName::Name(name) => RecordColumn::Name(name.clone()),
        ColumnName::Number(number) => RecordColumn::Number(*number),
    };
    let columns = amplitude.columns.iter().flat_map(|columns| &columns.values).map(|at| column(&at.value)).collect();
    let selection = RecordSelection { columns, time_step: time_step.map(|step| step.value) };
    match record::read(&path, &bytes, &selection) {
        Ok(points) => Ok(Some(Record { path, points, digest: Sha256::digest(&bytes).into() })),
        Err(found) => Err(at_file(found, &file.span)),
    }
}

/// Errors of a file, with the place of its name in the deck.
fn at_file(found: Vec<Diagnostic>, place: &Span) -> Vec<Diagnostic> {
    found.into_iter().map(|problem| problem.at(place)).collect()
}
