//! The numbers that a sweep collects. One search reads the rows of a table as a run makes them, or as its file has them.

use super::TABLES;
use super::curve::{REACTION, REACTION_COMPONENTS, REACTIONS, reaction_direction};
use super::table::{BETWEEN_SETS, CASE, SET, STAGE, TableKind, names_subject};
use super::table_reader::{TableReader, fields, number, text};
use super::tables::holds_response;
use base::snapshot::keep;
use model::ENVELOPE_ENDS;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::io;
use std::path::Path;

/// Times are those of a row within this part of it.
const SAME_TIME: f64 = 1e-9;

/// A number that is read from the result of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Collected {
    /// The name of its column.
    pub name: String,
    /// The subject of the row, as its table names it, or "energy".
    pub at: String,
    /// The column of the table.
    pub quantity: String,
    /// The stage of the rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stage: Option<String>,
    /// The time of the number.
    pub when: CollectedWhen,
}

impl Collected {
    /// True for a request of the same number, whatever its column is called.
    fn is_like(&self, other: &Collected) -> bool {
        *self == Collected { name: self.name.clone(), ..other.clone() }
    }
}

/// The time of a collected number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CollectedWhen {
    /// Where it is largest.
    Max,
    /// Where it is least.
    Min,
    /// Where its magnitude is largest.
    Abs,
    /// At the end.
    End,
    /// At this time.
    Time(f64),
}

impl CollectedWhen {
    /// True for an extreme over time.
    fn is_peak(self) -> bool {
        matches!(self, CollectedWhen::Max | CollectedWhen::Min | CollectedWhen::Abs)
    }
}

/// A number that a run has found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundNumber {
    /// The request.
    #[serde(flatten)]
    pub wanted: Collected,
    /// The number in digits that read back to the same bits; empty if no row has it.
    pub value: String,
}

impl FoundNumber {
    /// The number; `None` if no row has it.
    fn number(&self) -> Option<f64> {
        self.value.parse().ok()
    }
}

/// Collected numbers as a summary and a result have them.
pub fn in_words(number: Option<f64>) -> String {
    number.map_or(String::new(), |number| format!("{number:?}"))
}

/// The collected numbers of a folder, in their order: those that its run has `found` in the rows of every step, others from its tables. `None` if
/// the tables lack one. Each table is read once.
///
/// # Errors
/// A table cannot be read; the error names it.
pub fn collect(folder: &Path, wanted: &[Collected], found: &[FoundNumber]) -> io::Result<Vec<Option<f64>>> {
    let known = |one: &Collected| found.iter().find(|other| other.wanted.is_like(one));
    if let Some(all) = wanted.iter().map(|one| known(one).map(FoundNumber::number)).collect() {
        return Ok(all);
    }
    let in_tables = search_tables(folder, wanted)?;
    let both = wanted.iter().zip(in_tables);
    Ok(both.map(|(one, in_tables)| known(one).map_or(in_tables, FoundNumber::number)).collect())
}

/// The numbers in the tables of a folder.
fn search_tables(folder: &Path, wanted: &[Collected]) -> io::Result<Vec<Option<f64>>> {
    let mut all = Vec::new();
    for kind in TABLES {
        let path = folder.join(kind.file);
        if asked_of(kind, wanted).next().is_none() || !path.exists() {
            continue;
        }
        let mut rows = TableReader::open(&path)?;
        let Some(mut search) = RowSearch::new(kind, &rows.header, wanted) else { continue };
        while let Some(row) = rows.next_row()? {
            search.read(row);
        }
        all.push(search);
    }
    Ok(found(all.iter(), wanted.len()))
}

/// The numbers that these searches have found, by their places in the list of numbers.
pub fn found<'s>(tables: impl Iterator<Item = &'s RowSearch>, count: usize) -> Vec<Option<f64>> {
    let mut all: Vec<&Search> = tables.flat_map(|table| &table.searches).collect();
    all.sort_by_key(|search| search.order);
    let mut found = vec![None; count];
    for search in all {
        found[search.place] = found[search.place].or(search.number());
    }
    found
}

/// The quantities that tables have: their columns without the names of rows, and the components of reactions.
pub fn quantities() -> impl Iterator<Item = &'static str> {
    let kinds = TABLES.iter().filter(|kind| !kind.every_step);
    let columns = kinds.flat_map(|kind| kind.columns()).filter(|column| !column.is_key()).map(|column| column.name);
    columns.chain(REACTION_COMPONENTS)
}

/// True if a table may have an extreme among these numbers.
pub(super) fn has_peak(kind: &TableKind, wanted: &[Collected]) -> bool {
    asked_of(kind, wanted).any(|(_, _, one)| one.when.is_peak())
}

/// The numbers that a table may have. Each comes with its place in the list and with the rank of the table: the lowest rank gives the number.
fn asked_of<'w>(kind: &TableKind, wanted: &'w [Collected]) -> impl Iterator<Item = (usize, usize, &'w Collected)> {
    let about_all = !kind.columns().any(|column| column.is_key());
    let values: Vec<&str> = kind.columns().filter(|column| !column.is_key()).map(|column| column.name).collect();
    let (file, every_step) = (kind.file, kind.every_step);
    // A response is asked for its own tables, whose columns have the names of others.
    let order = if holds_response(kind) { 0 } else { 1 + TABLES.iter().take_while(|table| table.file != file).count() };
    wanted.iter().enumerate().flat_map(move |(place, one)| {
        let is_energy = (one.at == "energy") == (about_all && file == "energy.csv");
        let holds = !every_step && values.contains(&one.quantity.as_str()) && is_energy;
        // A component of force or moment at a support stands in rows of its direction.
        let is_reaction = file == REACTIONS && reaction_direction(&one.quantity).is_some();
        holds.then_some((place, order, one)).into_iter().chain(is_reaction.then_some((place, usize::MAX, one)))
    })
}

/// The search for numbers in the rows of one table.
pub struct RowSearch {
    searches: Vec<Search>,
    /// The fields of the row under way up to the last that is looked at, and the place of the next one.
    row: Vec<Field>,
    next: usize,
    /// The places of the time, of the step, of the load case, of the keys, of the stage and of the sets.
    time: usize,
    step: Option<usize>,
    case: Option<usize>,
    keys: Vec<usize>,
    others: [Option<usize>; 2],
}

/// A field of the row under way.
#[derive(Clone, Default)]
struct Field {
    looked_at: LookedAt,
    text: String,
    number: f64,
}

/// The part of a field that a search needs.
#[derive(Clone, Copy, Default, PartialEq)]
enum LookedAt {
    #[default]
    Nothing,
    Text,
    Number,
}

/// The search for one number.
struct Search {
    wanted: Collected,
    /// Its place in the list of numbers.
    place: usize,
    /// The place of this table among those that are asked for it.
    order: usize,
    /// The place of its column.
    column: usize,
    /// The direction of the rows that are summed at each instant, of a reaction.
    direction: Option<&'static str>,
    found: FoundSoFar,
}

/// The result of a search so far.
#[derive(Debug, Clone, Default)]
pub struct FoundSoFar {
    best: Option<f64>,
    /// The first key of the first row taken.
    subject: Option<String>,
    /// True if other rows taken have another.
    has_others: bool,
    /// The sum of the rows of the instant under way.
    sum: Option<Sum>,
}

/// The sum of the rows of one instant.
#[derive(Debug, Clone, Default)]
struct Sum {
    stage: String,
    step: f64,
    time: f64,
    value: f64,
}

keep!(FoundSoFar: Default { best, subject, has_others, sum });
keep!(Sum: Default { stage, step, time, value });

impl RowSearch {
    /// The search in a table with these columns; `None` if it has none of the numbers.
    pub fn new(kind: &TableKind, header: &[impl AsRef<str>], wanted: &[Collected]) -> Option<RowSearch> {
        let column = |name: &str| header.iter().position(|other| other.as_ref() == name);
        let search = |(place, order, wanted): (usize, usize, &Collected)| {
            let (column, direction) = match column(&wanted.quantity) {
                Some(column) => (column, None),
                None => (column(REACTION)?, Some(reaction_direction(&wanted.quantity)?)),
            };
            Some(Search { wanted: wanted.clone(), place, order, column, direction, found: FoundSoFar::default() })
        };
        let searches: Vec<Search> = asked_of(kind, wanted).filter_map(search).collect();
        let time = column("time").filter(|_| !searches.is_empty())?;
        // The stage and the load case of a row are part of its time, not of its subject.
        let says_what = |name: &str| names_subject(name) && kind.columns().any(|one| one.is_key() && one.name == name);
        let keys: Vec<usize> = (0..header.len()).filter(|&place| says_what(header[place].as_ref())).collect();
        let others = [STAGE, SET].map(column);
        let case = column(CASE);
        let texts = keys.iter().chain(others.iter().flatten()).chain(&case).map(|&place| (place, LookedAt::Text));
        let numbers = searches.iter().map(|search| search.column).chain([time]).chain(column("step"));
        let all: Vec<_> = texts.chain(numbers.map(|place| (place, LookedAt::Number))).collect();
        let mut row = vec![Field::default(); all.iter().map(|(place, _)| place + 1).max().unwrap_or(0)];
        all.into_iter().for_each(|(place, looked_at)| row[place].looked_at = looked_at);
        Some(RowSearch { searches, row, next: 0, time, step: column("step"), case, keys, others })
    }

    /// Takes a row of a file.
    fn read(&mut self, row: &[u8]) {
        self.next = 0;
        for (field, to) in fields(row).zip(&mut self.row) {
            match to.looked_at {
                LookedAt::Text => text(field).as_ref().clone_into(&mut to.text),
                LookedAt::Number => to.number = number(field),
                LookedAt::Nothing => {}
            }
        }
        self.end();
    }

    /// True where a number may come from rows with this first key.
    pub fn reads(&self, subject: &str) -> bool {
        self.others[1].is_some() || self.searches.iter().any(|search| search.wanted.at.starts_with(subject))
    }

    /// Begins a row with its step.
    pub fn begin(&mut self, step: usize) {
        self.next = 0;
        self.count(step);
    }

    /// Takes a field with a whole number.
    pub fn count(&mut self, value: usize) {
        if let Some(Field { looked_at, text, number }) = self.row.get_mut(self.next) {
            *number = value as f64;
            if *looked_at == LookedAt::Text {
                text.clear();
                // A text can always grow.
                let _ = write!(text, "{value}");
            }
        }
        self.next += 1;
    }

    /// Takes a field for each number, and returns how many of them are not finite.
    pub fn numbers(&mut self, values: &[f64]) -> usize {
        self.row.iter_mut().skip(self.next).zip(values).for_each(|(to, value)| to.number = *value);
        self.next += values.len();
        values.iter().filter(|value| !value.is_finite()).count()
    }

    /// Takes a field with a text.
    pub fn text(&mut self, value: &str) {
        if let Some(Field { looked_at, text, number }) = self.row.get_mut(self.next) {
            *number = f64::NAN;
            if *looked_at == LookedAt::Text {
                value.clone_into(text);
            }
        }
        self.next += 1;
    }

    /// Looks at the whole row.
    pub fn end(&mut self) {
        let RowSearch { searches, row, keys, others, time, step, case, .. } = self;
        let of_envelope = case.is_some_and(|place| ENVELOPE_ENDS.iter().any(|end| row[place].text.ends_with(end)));
        let (time, step) = (row[*time].number, step.map_or(0.0, |place| row[place].number));
        let stage = others[0].map_or("", |place| &row[place].text);
        for search in searches {
            if search.is_about(row, keys, *others) {
                if let Some(&key) = keys.first() {
                    search.found.note(&row[key].text);
                }
                let value = row[search.column].number;
                match search.direction {
                    // Extremes of several nodes may be of different cases: their sum is no reaction.
                    Some(_) if of_envelope => {}
                    Some(_) => search.add((stage, step, time), value),
                    None => search.see(time, value),
                }
            }
        }
    }

    /// True if it looks for an extreme, which may lie between the rows of a file.
    pub fn has_peaks(&self) -> bool {
        self.searches.iter().any(|search| search.wanted.when.is_peak())
    }

    /// The results so far, to go back to.
    pub fn so_far(&self) -> Vec<FoundSoFar> {
        self.searches.iter().map(|search| search.found.clone()).collect()
    }

    /// Goes back to earlier results of the same search.
    pub fn go_back(&mut self, to: &[FoundSoFar]) {
        self.searches.iter_mut().zip(to).for_each(|(search, found)| search.found.clone_from(found));
    }
}

impl FoundSoFar {
    /// Notes the subject of a row that is taken.
    fn note(&mut self, subject: &str) {
        match &self.subject {
            Some(first) => self.has_others |= first != subject,
            None => self.subject = Some(subject.to_owned()),
        }
    }
}

impl Search {
    /// The number of the rows so far. There is none for one time of several subjects, unless it is a force, and none for moments about
    /// several points: they have no sum.
    fn number(&self) -> Option<f64> {
        let is_one = match self.direction {
            _ if !self.found.has_others => true,
            Some(direction) => direction.starts_with('u'),
            None => self.wanted.when.is_peak(),
        };
        match &self.found.sum {
            _ if !is_one => None,
            Some(sum) if self.takes(sum.time, sum.value) => Some(sum.value),
            _ => self.found.best,
        }
    }

    /// Adds the value of a row to those of its instant: a stage, a step and a time.
    fn add(&mut self, (stage, step, time): (&str, f64, f64), value: f64) {
        let sum = self.found.sum.get_or_insert_with(|| Sum { stage: stage.to_owned(), step, time, value: 0.0 });
        if sum.stage == stage && sum.step == step && sum.time == time {
            sum.value += value;
            return;
        }
        let before = (sum.time, std::mem::replace(&mut sum.value, value));
        stage.clone_into(&mut sum.stage);
        (sum.step, sum.time) = (step, time);
        self.see(before.0, before.1);
    }

    /// Takes the value of a row, if it is the one that is wanted so far.
    fn see(&mut self, time: f64, value: f64) {
        if self.takes(time, value) {
            self.found.best = Some(value);
        }
    }

    /// True for the value of a row that is the one that is wanted so far.
    fn takes(&self, time: f64, value: f64) -> bool {
        let takes = |best: f64| match self.wanted.when {
            CollectedWhen::Max => value > best,
            CollectedWhen::Min => value < best,
            CollectedWhen::Abs => value.abs() > best.abs(),
            CollectedWhen::End | CollectedWhen::Time(_) => true,
        };
        let is_apart = |at: f64| (time - at).abs() > SAME_TIME * at.abs().max(time.abs());
        let elsewhere = matches!(self.wanted.when, CollectedWhen::Time(at) if is_apart(at));
        value.is_finite() && !elsewhere && self.found.best.is_none_or(takes)
    }

    /// True for a row of the wanted subject, or of the wanted set, in the wanted stage.
    fn is_about(&self, row: &[Field], keys: &[usize], [stages, sets]: [Option<usize>; 2]) -> bool {
        let says = |place: usize, name: &str| row[place].text == name;
        let in_stage = match &self.wanted.stage {
            Some(stage) => stages.is_some_and(|place| says(place, stage)),
            None => true,
        };
        let in_set = sets.is_some_and(|place| row[place].text.split(BETWEEN_SETS).any(|name| name == self.wanted.at));
        let is_subject = in_set || keys.is_empty() || says(keys[0], &self.wanted.at) || self.is_all(row, keys);
        in_stage && is_subject && self.direction.is_none_or(|direction| keys.iter().any(|&key| says(key, direction)))
    }

    /// True if all keys of a row, separated by spaces, are the wanted subject.
    fn is_all(&self, row: &[Field], keys: &[usize]) -> bool {
        let mut rest = Some(self.wanted.at.as_str());
        for (number, &key) in keys.iter().enumerate() {
            let next = if number == 0 { rest } else { rest.and_then(|rest| rest.strip_prefix(' ')) };
            rest = next.and_then(|rest| rest.strip_prefix(row[key].text.as_str()));
        }
        rest == Some("")
    }
}
