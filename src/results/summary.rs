//! Peaks and ends of a result, read back from its folder.

use super::compare::Selector;
use super::disk::at;
use super::low_pass::{LowPass, TimeSampling};
use super::result_json;
use super::table::{SET, names_subject};
use super::table_reader::{TableReader, fields, number, text};
use super::tables::TABLES;
use super::torn::torn_tables;
use base::names::to_digits;
use base::text_file::read_regular;
use serde::Serialize;
use serde_json::Value;
use solve::Wanted;
use std::collections::HashMap;
use std::io;
use std::path::Path;

/// The extremes of a folder of results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResultSummary {
    /// The status of the run; "unfinished" where there is no result.json.
    pub status: String,
    /// The reason for its end; empty when done.
    pub reason: String,
    /// All warnings: of the run, of the filter, and of tables that end within a row.
    pub warnings: Vec<String>,
    /// Remarks on the summary itself.
    pub notes: Vec<String>,
    /// The expected values with what became of them, in words.
    pub expectations: Vec<String>,
    /// The columns of all tables.
    pub columns: Vec<ColumnSummary>,
}

/// The extremes of one column.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnSummary {
    /// The file of the table.
    pub table: String,
    /// The name of the column.
    pub column: String,
    /// The least value.
    #[serde(rename = "min")]
    pub least: Extremum,
    /// The largest value.
    #[serde(rename = "max")]
    pub largest: Extremum,
    /// The value of largest magnitude at the last time.
    pub end: Extremum,
    /// False in a table about one state, of modes or of a response.
    #[serde(skip)]
    pub is_over_time: bool,
}

/// A value with its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Extremum {
    /// The value.
    pub value: f64,
    /// Its time.
    pub time: f64,
    /// The subject of its row, with the frequency or speed in tables over these; empty for the whole scene.
    pub at: String,
}

impl ResultSummary {
    /// Reads a folder of results, or one stage of it. Costs of steps are omitted. With a filter, extremes are those of the filtered columns.
    ///
    /// # Errors
    /// There are no results, none of such a stage, a file cannot be read, or its rows do not suit the filter; the error names it.
    pub fn of(
        folder: &Path,
        filter: Option<&Filter>,
        (only, stage): (&[Selector], Option<&str>),
    ) -> io::Result<ResultSummary> {
        let path = folder.join(result_json::NAME);
        let result: Value = match read_regular(&path) {
            Ok(bytes) => serde_json::from_slice(&bytes).map_err(|error| at(&path, error.into()))?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Value::Null,
            Err(error) => return Err(at(&path, error)),
        };
        let mut columns = Vec::new();
        let is_there = |file: &str| folder.join(file).exists();
        let mut doubts = Vec::new();
        let mut apart = 1;
        let takes =
            |file: &str, column: &str| only.is_empty() || only.iter().any(|selector| selector.takes(file, column));
        for table in TABLES.iter().filter(|table| !table.every_step && is_there(table.file)) {
            let mut rows = TableReader::open(&folder.join(table.file))?;
            stage.map_or(Ok(()), |stage| rows.in_stage(stage))?;
            let of_table = match filter {
                Some(filter) if table.columns().any(|column| takes(table.file, column.name)) => {
                    filtered((&folder.join(table.file), table.file), rows, (filter, &takes), &mut doubts)?
                }
                _ => of_table(table.file, rows, &mut apart)?,
            };
            let is_over_time = table.needs != Wanted::MODES;
            let taken = of_table.into_iter().filter(|column| {
                let name = column.column.split(" (").next().unwrap_or_default();
                takes(&column.table, name)
            });
            columns.extend(taken.map(|column| ColumnSummary { is_over_time, ..column }));
        }
        if result.is_null() && !TABLES.iter().any(|table| is_there(table.file)) {
            return Err(at(folder, io::Error::other("no results: neither a table nor result.json")));
        }
        if let Some(stage) = stage.filter(|_| columns.is_empty() && only.is_empty()) {
            return Err(at(folder, io::Error::other(format!("no row is of a stage `{stage}`"))));
        }
        let list = |key: &str| result[key].as_array().into_iter().flatten();
        let word = |key: &str| result[key].as_str().unwrap_or_default().to_owned();
        Ok(ResultSummary {
            status: result["status"].as_str().unwrap_or("unfinished").to_owned(),
            reason: word("reason"),
            warnings: list("warnings")
                .filter_map(Value::as_str)
                .map(str::to_owned)
                .chain(doubts)
                .chain(torn_tables(folder)?)
                .collect(),
            notes: (apart > 1).then(|| rows_apart(apart)).into_iter().collect(),
            expectations: list("expectations").map(expectation).collect(),
            columns,
        })
    }
}

/// A filter of columns over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter {
    /// The filter.
    pub low_pass: LowPass,
    /// The unit of time in seconds.
    pub second: f64,
}

/// An expected value in words.
fn expectation(one: &Value) -> String {
    let mark = if one["passed"].as_bool() == Some(true) { "ok  " } else { "MISS" };
    let number = |key: &str| one[key].as_f64().map_or("none".to_owned(), |value| to_digits(value, 7));
    let label = one["label"].as_str().unwrap_or_default();
    let bars = ["step_error", "mesh_error"].iter().filter_map(|key| one[*key].as_f64());
    let bars: String = bars.map(|bar| format!(" ± {}", to_digits(bar, 2))).collect();
    let wanted = one["bound"].as_str().unwrap_or("expected");
    format!("{mark} {label}: {}{bars}, {wanted} {}", number("value"), number("expected"))
}

/// The remark on extremes between rows.
fn rows_apart(steps: usize) -> String {
    format!(
        "rows stand up to {steps} steps apart, and extremes between them are not in tables. `peak` in `[[expect]]` and in `[collect]` of a sweep \
         takes every step, and with `every` = 1 in `[output]` tables have all of them"
    )
}

/// The extremes of all columns of numbers of a table; none where it has no rows. `apart` grows to the largest number of steps from row to row.
fn of_table(file: &str, mut rows: TableReader, apart: &mut usize) -> io::Result<Vec<ColumnSummary>> {
    let Some(time_at) = rows.column("time") else { return Ok(Vec::new()) };
    let over = rows.abscissa();
    let is_number = |place: &usize| {
        !rows.is_key(*place) && *place != time_at && rows.header[*place] != "step" && Some(*place) != over
    };
    let (keys, places): (Vec<usize>, Vec<usize>) = (
        (0..rows.header.len()).filter(|&place| rows.is_key(place) && rows.header[place] != SET).collect(),
        (0..rows.header.len()).filter(is_number).collect(),
    );
    let names: Vec<String> = places.iter().map(|&place| rows.header[place].clone()).collect();
    let width = rows.header.len();
    let over = over.map(|place| (place, rows.header[place].clone()));
    // Rows of reactions hold forces or moments in one column.
    let direction = rows.column("direction");
    let kinds = if direction.is_some() { &[" (forces)", " (moments)"][..] } else { &[""] };
    let mut found: Vec<Vec<Option<[Extremum; 3]>>> = vec![vec![None; places.len()]; kinds.len()];
    let mut last = f64::NEG_INFINITY;
    let (step_at, mut step) = (rows.column("step"), None);
    let mut ragged = None;
    while let Some(row) = rows.next_row()? {
        let row: Vec<&[u8]> = fields(row).collect();
        if row.len() != width {
            ragged = Some(row.len());
            break;
        }
        if let Some(now) = step_at.map(|place| number(row[place])) {
            *apart = (*apart).max((now - step.unwrap_or(now)) as usize);
            step = Some(now);
        }
        let time = number(row[time_at]);
        // A load that falls is at one time more than once; the last rows are those of the end.
        let begins = time != last;
        last = time;
        let at = || {
            let words = keys.iter().map(|&key| text(row[key]).into_owned());
            let words = words.collect::<Vec<_>>().join(" ");
            let over = over.iter().map(|(place, name)| format!("{name} = {}", to_digits(number(row[*place]), 7)));
            (!words.is_empty()).then_some(words).into_iter().chain(over).collect::<Vec<_>>().join(", ")
        };
        let kind = direction.map_or(0, |place| usize::from(row[place].starts_with(b"r")));
        for (extremes, &place) in found[kind].iter_mut().zip(&places) {
            note(extremes, number(row[place]), time, begins, &at);
        }
    }
    if let Some(count) = ragged {
        return Err(rows.ragged(count));
    }
    let summary = |(name, extremes): (String, Option<[Extremum; 3]>)| {
        let [least, largest, end] = extremes?;
        Some(ColumnSummary { table: file.to_owned(), column: name, least, largest, end, is_over_time: true })
    };
    let named = |kind: &str| names.iter().map(|name| format!("{name}{kind}")).collect::<Vec<_>>();
    Ok(kinds
        .iter()
        .zip(found)
        .flat_map(|(kind, found)| named(kind).into_iter().zip(found))
        .filter_map(summary)
        .collect())
}

/// Whether a column, by its file and its name, is to be shown.
type Takes<'t> = dyn Fn(&str, &str) -> bool + 't;

/// The columns of numbers of the rows of one name.
struct Series {
    name: String,
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
}

/// The rows of a table by their names, and the names of the columns of numbers that are taken.
fn series(rows: &mut TableReader, takes: &dyn Fn(&str) -> bool) -> io::Result<(Vec<Series>, Vec<String>)> {
    let Some(time_at) = rows.column("time") else { return Ok((Vec::new(), Vec::new())) };
    let width = rows.header.len();
    let is_number = |place: &usize| {
        !rows.is_key(*place) && !["step", "time"].contains(&&*rows.header[*place]) && takes(&rows.header[*place])
    };
    let places: Vec<usize> = (0..width).filter(is_number).collect();
    let keys: Vec<usize> =
        (0..width).filter(|&place| rows.is_key(place) && names_subject(&rows.header[place])).collect();
    let columns: Vec<String> = places.iter().map(|&place| rows.header[place].clone()).collect();
    let mut all: Vec<Series> = Vec::new();
    let mut known: HashMap<String, usize> = HashMap::new();
    let mut ragged = None;
    while let Some(row) = rows.next_row()? {
        let row: Vec<&[u8]> = fields(row).collect();
        if row.len() != width {
            ragged = Some(row.len());
            break;
        }
        let name = keys.iter().map(|&key| text(row[key]).into_owned()).collect::<Vec<_>>().join(" ");
        let index = *known.entry(name.clone()).or_insert_with(|| {
            all.push(Series { name, times: Vec::new(), values: vec![Vec::new(); places.len()] });
            all.len() - 1
        });
        all[index].times.push(number(row[time_at]));
        all[index].values.iter_mut().zip(&places).for_each(|(values, &place)| values.push(number(row[place])));
    }
    ragged.map_or(Ok((all, columns)), |count| Err(rows.ragged(count)))
}

/// The extremes of all columns of numbers of a table after a filter, which goes over the rows of each name. Columns with empty fields are left
/// out.
fn filtered(
    (path, file): (&Path, &str),
    mut rows: TableReader,
    (filter, takes): (&Filter, &Takes),
    doubts: &mut Vec<String>,
) -> io::Result<Vec<ColumnSummary>> {
    let (all, columns) = series(&mut rows, &|column| takes(file, column))?;
    let unfit = |why: String| at(path, io::Error::other(why));
    let mut found: Vec<Option<[Extremum; 3]>> = vec![None; columns.len()];
    for Series { name, times, values } in &all {
        let sampling = TimeSampling::of(times).map_err(unfit)?;
        let doubt = filter.low_pass.doubt(sampling.step, filter.second).map(|doubt| format!("{file}: {doubt}"));
        doubts.extend(doubt.filter(|doubt| !doubts.contains(doubt)));
        for (extremes, values) in
            found.iter_mut().zip(values).filter(|(_, values)| values.iter().all(|x| x.is_finite()))
        {
            let smooth = filter.low_pass.apply(&sampling, filter.second, times, values).map_err(unfit)?;
            let mut own = None;
            sampling.times().zip(smooth).for_each(|(time, value)| note(&mut own, value, time, true, &|| name.clone()));
            merge(extremes, own);
        }
    }
    let summary = |(name, extremes): (String, Option<[Extremum; 3]>)| {
        let [least, largest, end] = extremes?;
        Some(ColumnSummary { table: file.to_owned(), column: name, least, largest, end, is_over_time: true })
    };
    Ok(columns.into_iter().zip(found).filter_map(summary).collect())
}

/// Takes account of the extremes of rows of another name.
fn merge(extremes: &mut Option<[Extremum; 3]>, own: Option<[Extremum; 3]>) {
    let Some([least, largest, end]) = own else { return };
    let Some(all) = extremes else {
        *extremes = Some([least, largest, end]);
        return;
    };
    if least.value < all[0].value {
        all[0] = least;
    }
    if largest.value > all[1].value {
        all[1] = largest;
    }
    if end.time > all[2].time || end.time == all[2].time && end.value.abs() > all[2].value.abs() {
        all[2] = end;
    }
}

/// Takes account of one number, of the first row of its time or of a later one.
fn note(extremes: &mut Option<[Extremum; 3]>, value: f64, time: f64, begins: bool, at: &impl Fn() -> String) {
    if !value.is_finite() {
        return;
    }
    let here = || Extremum { value, time, at: at() };
    let [least, largest, end] = extremes.get_or_insert_with(|| [here(), here(), here()]);
    if value < least.value {
        *least = here();
    }
    if value > largest.value {
        *largest = here();
    }
    if begins || time != end.time || value.abs() > end.value.abs() {
        *end = here();
    }
}
