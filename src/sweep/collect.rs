//! Numbers read from the tables of one case.

use super::file::{Collected, CollectedWhen};
use results::TABLES;
use results::curve::{REACTION, REACTIONS, reaction_direction};
use results::table::{BETWEEN_SETS, CASE, SET, STAGE, TableKind, names_subject};
use results::table_reader::{TableReader, fields, number, text};
use std::io;
use std::path::Path;

/// Times are those of a row within this part of it.
const SAME_TIME: f64 = 1e-9;

/// The tables that hold these numbers.
pub fn tables_of(wanted: &[Collected]) -> Vec<&'static str> {
    let reactions: Vec<Collected> = wanted.iter().filter_map(as_reaction).collect();
    let holds_one = |table: &&&TableKind| wanted.iter().chain(&reactions).any(|one| holds(table, one));
    TABLES.iter().filter(holds_one).map(|table| table.file).collect()
}

/// Whether a table has the column of this number, and rows about its subject.
fn holds(table: &TableKind, one: &Collected) -> bool {
    let about_all = !table.columns().any(|column| column.is_key());
    !table.every_step
        && table.columns().any(|column| !column.is_key() && column.name == one.quantity)
        && (one.at == "energy") == (about_all && table.file == "energy.csv")
}

/// The collected numbers, in their order; `None` if the tables lack one. Each table is read once.
///
/// # Errors
/// A table cannot be read; the error names it.
pub fn collect(folder: &Path, wanted: &[Collected]) -> io::Result<Vec<Option<f64>>> {
    let mut found = vec![None; wanted.len()];
    // A response is asked for its own table, whose columns have the names of others.
    let (first, others): (Vec<&TableKind>, Vec<&TableKind>) =
        TABLES.iter().copied().partition(|table| table.file == "response.csv");
    for table in first.into_iter().chain(others) {
        let asked: Vec<usize> =
            (0..wanted.len()).filter(|&place| found[place].is_none() && holds(table, &wanted[place])).collect();
        let path = folder.join(table.file);
        if asked.is_empty() || !path.exists() {
            continue;
        }
        let asked_of_it: Vec<&Collected> = asked.iter().map(|&place| &wanted[place]).collect();
        for (place, value) in asked.into_iter().zip(of_table(&path, &asked_of_it)?) {
            found[place] = value;
        }
    }
    let path = folder.join(REACTIONS);
    for (place, one) in wanted.iter().enumerate().filter(|_| path.exists()) {
        if let Some(reaction) = as_reaction(one).filter(|_| found[place].is_none()) {
            found[place] = of_table(&path, &[&reaction])?.pop().flatten();
        }
    }
    Ok(found)
}

/// The rows of reactions.csv that a component of force or moment at a support stands in.
fn as_reaction(one: &Collected) -> Option<Collected> {
    let direction = reaction_direction(&one.quantity)?;
    Some(Collected { at: format!("{} {direction}", one.at), quantity: REACTION.to_owned(), ..one.clone() })
}

/// The search for one number in the rows of a table.
struct Search<'w> {
    wanted: &'w Collected,
    /// The place of its column.
    column: usize,
    best: Option<f64>,
    /// The first key of the first row taken.
    subject: Option<String>,
    /// True if other rows taken have another.
    has_others: bool,
}

fn of_table(path: &Path, wanted: &[&Collected]) -> io::Result<Vec<Option<f64>>> {
    let mut rows = TableReader::open(path)?;
    let Some(time) = rows.column("time") else { return Ok(vec![None; wanted.len()]) };
    let mut searches: Vec<(usize, Search)> = Vec::new();
    for (place, &wanted) in wanted.iter().enumerate() {
        searches.extend(
            rows.column(&wanted.quantity)
                .map(|column| (place, Search { wanted, column, best: None, subject: None, has_others: false })),
        );
    }
    // The stage and the load case of a row are part of its time, not of its subject.
    let says_what = |&key: &usize| rows.is_key(key) && names_subject(&rows.header[key]) && rows.header[key] != CASE;
    let keys: Vec<usize> = (0..rows.header.len()).filter(says_what).collect();
    let others = [STAGE, SET].map(|name| rows.column(name));
    let looked_at = searches.iter().map(|(_, search)| search.column).chain([time]).chain(keys.iter().copied());
    let last = looked_at.chain(others.into_iter().flatten()).max().unwrap_or(0);
    // The ends of the fields of a row, as far as they are needed.
    let mut ends: Vec<(usize, usize)> = Vec::new();
    while let Some(row) = rows.next_row()? {
        let mut from = 0;
        ends.clear();
        ends.extend(fields(row).take(last + 1).map(|field| {
            let end = (from, from + field.len());
            from = end.1 + 1;
            end
        }));
        let field = |place: usize| ends.get(place).map(|&(from, to)| &row[from..to]);
        for (_, search) in &mut searches {
            let Some(value) = field(search.column).filter(|_| search.is_about(&field, &keys, others)) else { continue };
            if let Some(subject) = keys.first().and_then(|&key| field(key)).map(text) {
                search.has_others |= *search.subject.get_or_insert_with(|| subject.to_string()) != subject;
            }
            search.see(|| field(time).map_or(f64::NAN, number), number(value));
        }
    }
    let mut found = vec![None; wanted.len()];
    // One time of several nodes is no number.
    let is_one = |search: &Search| !search.has_others || search.takes_extreme();
    searches.into_iter().filter(|(_, search)| is_one(search)).for_each(|(place, search)| found[place] = search.best);
    Ok(found)
}

impl Search<'_> {
    /// True where the number is the extreme of all rows.
    fn takes_extreme(&self) -> bool {
        !matches!(self.wanted.when, CollectedWhen::End | CollectedWhen::Time(_))
    }

    /// Takes the value of a row, if it is the one that is wanted so far.
    fn see(&mut self, time: impl Fn() -> f64, value: f64) {
        let takes = |best: f64| match self.wanted.when {
            CollectedWhen::Max => value > best,
            CollectedWhen::Min => value < best,
            CollectedWhen::Abs => value.abs() > best.abs(),
            CollectedWhen::End | CollectedWhen::Time(_) => true,
        };
        let elsewhere = |at: f64| {
            let t = time();
            (t - at).abs() > SAME_TIME * at.abs().max(t.abs())
        };
        let elsewhere = matches!(self.wanted.when, CollectedWhen::Time(at) if elsewhere(at));
        if value.is_finite() && !elsewhere && self.best.is_none_or(takes) {
            self.best = Some(value);
        }
    }

    /// True for a row of the wanted subject, or of the wanted set, in the wanted stage.
    fn is_about<'r>(
        &self,
        field: &impl Fn(usize) -> Option<&'r [u8]>,
        keys: &[usize],
        [stages, sets]: [Option<usize>; 2],
    ) -> bool {
        let says = |place: usize, name: &str| field(place).is_some_and(|found| text(found) == name);
        let in_stage = match &self.wanted.stage {
            Some(stage) => stages.is_some_and(|place| says(place, stage)),
            None => true,
        };
        let lists = |names: &[u8]| text(names).split(BETWEEN_SETS).any(|name| name == self.wanted.at);
        let in_set = sets.and_then(field).is_some_and(lists);
        let is_subject =
            in_set || keys.is_empty() || says(keys[0], &self.wanted.at) || keys.len() > 1 && self.is_all(field, keys);
        in_stage && is_subject
    }

    /// True if all keys of a row, separated by spaces, are the wanted subject.
    fn is_all<'r>(&self, field: &impl Fn(usize) -> Option<&'r [u8]>, keys: &[usize]) -> bool {
        let all: Vec<_> = keys.iter().filter_map(|&key| field(key)).map(text).collect();
        all.join(" ") == self.wanted.at
    }
}
