//! Numbers read from the tables of one case.

use super::file::{Collected, CollectedWhen};
use crate::output::TABLES;
use crate::output::table::{STAGE, TableKind};
use crate::output::table_reader::{TableReader, fields, number, text};
use std::io;
use std::path::Path;

/// Times are those of a row within this part of it.
const SAME_TIME: f64 = 1e-9;

/// The number that is asked for; `None` where the tables do not have it.
///
/// # Errors
/// A table cannot be read; the error names it.
pub fn collect(folder: &Path, wanted: &Collected) -> io::Result<Option<f64>> {
    // A response is asked for its own table, whose columns have the names of others.
    let there = TABLES.iter().copied().filter(|table| !table.every_step && folder.join(table.file).exists());
    let (first, others): (Vec<&TableKind>, Vec<&TableKind>) = there.partition(|table| table.file == "response.csv");
    for table in first.into_iter().chain(others) {
        let has_it = table.columns().any(|column| !column.is_key() && column.answers_to(&wanted.quantity));
        let about_all = !table.columns().any(|column| column.is_key());
        if !has_it || (wanted.at == "energy") != (about_all && table.file == "energy.csv") {
            continue;
        }
        if let Some(value) = of_table(&folder.join(table.file), wanted)? {
            return Ok(Some(value));
        }
    }
    Ok(None)
}

fn of_table(path: &Path, wanted: &Collected) -> io::Result<Option<f64>> {
    let mut rows = TableReader::open(path)?;
    let (Some(time), Some(place)) = (rows.column("time"), rows.column(&wanted.quantity)) else { return Ok(None) };
    // The stage of a row says when it is, as its time does, not what it is about.
    let says_what = |&key: &usize| rows.is_key(key) && rows.header[key] != STAGE;
    let keys: Vec<usize> = (0..rows.header.len()).filter(says_what).collect();
    let stages = rows.column(STAGE);
    let in_stage = |row: &[&[u8]]| match &wanted.stage {
        Some(stage) => stages.and_then(|column| row.get(column)).is_some_and(|field| text(field) == *stage),
        None => true,
    };
    let mut best: Option<f64> = None;
    while let Some(row) = rows.next()? {
        let row: Vec<&[u8]> = fields(row).collect();
        if row.len() <= place.max(time) || !in_stage(&row) || (!keys.is_empty() && !is_about(&row, &keys, &wanted.at)) {
            continue;
        }
        let (t, value) = (number(row[time]), number(row[place]));
        let takes = |best: f64| match wanted.when {
            CollectedWhen::Max => value > best,
            CollectedWhen::Min => value < best,
            CollectedWhen::Abs => value.abs() > best.abs(),
            CollectedWhen::End | CollectedWhen::Time(_) => true,
        };
        let elsewhere =
            matches!(wanted.when, CollectedWhen::Time(at) if (t - at).abs() > SAME_TIME * at.abs().max(t.abs()));
        if value.is_finite() && !elsewhere && best.is_none_or(takes) {
            best = Some(value);
        }
    }
    Ok(best)
}

/// True where the first key of a row, or all of them with a space between, are this.
fn is_about(row: &[&[u8]], keys: &[usize], at: &str) -> bool {
    let first = keys.first().is_some_and(|&key| row.get(key).is_some_and(|field| text(field) == at));
    first || {
        let all: Vec<_> = keys.iter().filter_map(|&key| row.get(key)).map(|field| text(field)).collect();
        all.join(" ") == at
    }
}
