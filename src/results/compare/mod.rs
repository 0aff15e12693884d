//! The comparison of two output folders: every table that either has is compared as numbers, each column against its own range.
//!
//! Tables are read once, side by side, and never held. The grids of the fields, `run.log`, and all of `result.json` but its status are left
//! out. `steps.csv` holds costs: it is compared and shown, but judged only if one of its columns is named.

mod cursor;
mod join;
mod scale;
mod select;

pub use cursor::shown;
pub use join::{Alone, Matched, Worst};
pub use select::{ColumnTolerance, Selector, size};

use super::disk::at;
use super::table::SET;
use super::table_reader::{TableReader, fields, number};
use super::tables::{holds_response, of_file};
use base::text_file::read_regular;
use cursor::{Cursor, Pick};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;

/// The selection of columns, and the tolerances.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Tolerances relative to the scale of a column; a column that none of them names has [`TOLERANCE`].
    pub tolerances: Vec<ColumnTolerance>,
    /// The absolute difference up to which numbers of any column agree.
    pub absolute: f64,
    /// The compared columns; an empty list selects all.
    pub columns: Vec<Selector>,
    /// The columns that are left out.
    pub ignored: Vec<Selector>,
}

impl Settings {
    /// Whether a column is compared.
    fn takes(&self, file: &str, column: &str) -> bool {
        let any = |of: &[Selector]| of.iter().any(|selector| selector.takes(file, column));
        (self.columns.is_empty() || any(&self.columns)) && !any(&self.ignored)
    }

    /// All selectors, which must each name a column.
    fn selectors(&self) -> impl Iterator<Item = &Selector> {
        self.columns.iter().chain(&self.ignored).chain(self.tolerances.iter().map(|tolerance| &tolerance.of))
    }
}

/// The tolerance relative to the scale of a column where the user names none.
pub const TOLERANCE: f64 = 1e-6;

/// The table of costs, which may differ between runs with equal results.
const COST: &str = "steps.csv";

/// The column that pairs the rows of frequency responses.
const FREQUENCY: &str = "frequency";

/// A column of both sides, compared.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedColumn {
    /// The name in the header.
    pub name: String,
    /// The largest difference.
    pub worst: Worst,
    /// The reference of relative differences, in the unit of the column: its range, or the largest number of its kind.
    pub scale: f64,
    /// The tolerance relative to the scale.
    pub tolerance: f64,
    /// False of a column that is shown only.
    pub judged: bool,
    /// True where the difference is within the tolerance, or is not judged.
    pub passed: bool,
}

impl ComparedColumn {
    /// The largest difference relative to the scale.
    pub fn relative(&self) -> f64 {
        if self.worst.difference == 0.0 { 0.0 } else { self.worst.difference / self.scale }
    }
}

/// A table of both sides, compared.
#[derive(Debug, Clone)]
pub struct ComparedTable {
    /// The name of the file.
    pub name: String,
    /// The columns that both sides have, but for keys and steps.
    pub columns: Vec<ComparedColumn>,
    /// The columns that one side has alone.
    pub only: [Vec<String>; 2],
    /// The rows that one side has alone.
    pub alone: [Alone; 2],
    /// The number of rows compared.
    pub rows: u64,
    /// The number of times or steps with such rows.
    pub frames: u64,
    /// The number of all rows of each side.
    pub all_rows: [u64; 2],
    /// The last times, steps or frequencies, where one side goes on without the other.
    pub ends: Option<[f64; 2]>,
    /// Whether the last line of each side is torn.
    pub truncated: [bool; 2],
    /// The number that pairs rows, besides their names.
    pub by: Matched,
    /// True where rows without a partner are a fault too.
    pub judged: bool,
}

impl ComparedTable {
    /// True where there are rows, but none of one side has a partner on the other.
    pub fn nothing_matched(&self) -> bool {
        self.rows == 0 && self.all_rows.iter().any(|&rows| rows > 0)
    }

    /// Whether the two sides agree in all that is judged.
    pub fn agrees(&self) -> bool {
        let rows = !self.nothing_matched() && self.ends.is_none() && self.alone.iter().all(|alone| alone.rows == 0);
        let whole = !self.truncated.contains(&true) && self.only.iter().all(Vec::is_empty);
        whole && (rows || !self.judged) && self.columns.iter().all(|column| column.passed)
    }
}

/// Two folders, compared.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The tables that both sides have, by name.
    pub tables: Vec<ComparedTable>,
    /// The files that one side has alone.
    pub only: [Vec<String>; 2],
    /// The status in `result.json` of each side; `None` where a side has none.
    pub status: Option<[String; 2]>,
    /// True where neither side has a status.
    pub without_status: bool,
    /// The selectors that name no column of either side. Where there are any, nothing has been compared.
    pub idle: Vec<Selector>,
    /// All columns of either side, as `nodes.csv:ux`.
    pub known: BTreeSet<String>,
}

impl Comparison {
    /// Whether the two folders agree in all that is judged.
    pub fn agrees(&self) -> bool {
        self.only.iter().all(Vec::is_empty)
            && self.status.as_ref().is_none_or(|[a, b]| a == b)
            && self.tables.iter().all(ComparedTable::agrees)
    }
}

/// Compares two folders.
///
/// # Errors
/// A folder holds no results, or a file in it cannot be read; the error names it.
pub fn compare(folders: [&Path; 2], settings: &Settings) -> io::Result<Comparison> {
    let names = [tables(folders[0])?, tables(folders[1])?];
    let ends = [end_of(folders[0])?, end_of(folders[1])?];
    let status = ends.each_ref().map(|end| end.as_ref().map(|end| end.status.clone()));
    for (side, folder) in folders.into_iter().enumerate() {
        if names[side].is_empty() && status[side].is_none() {
            return Err(at(folder, io::Error::other("no results: neither a table nor result.json")));
        }
    }
    let all: BTreeSet<&String> = names.iter().flatten().collect();
    let heads = |name: &str| folders.map(|folder| TableReader::open(&folder.join(name)));
    let known = columns(folders, &names)?;
    let takes = |selector: &Selector| {
        *selector == Selector::default()
            || known
                .iter()
                .any(|known| known.split_once(':').is_some_and(|(file, column)| selector.takes(file, column)))
    };
    let idle: Vec<Selector> = settings.selectors().filter(|&selector| !takes(selector)).cloned().collect();
    if !idle.is_empty() {
        return Ok(Comparison {
            tables: Vec::new(),
            only: Default::default(),
            status: None,
            without_status: false,
            idle,
            known,
        });
    }

    let moved = ends.each_ref().map(|end| end.as_ref().and_then(|end| end.moved_steps));
    let by_step = moved[0].is_some() && moved[0] == moved[1] || turns(folders[0])? || turns(folders[1])?;
    let mut compared = Vec::new();
    let mut only: [Vec<String>; 2] = Default::default();
    let chosen = |file: &str, column: &str| settings.takes(file, column);
    let wanted = |name: &str| {
        let mut of_file = known.iter().filter_map(|known| known.split_once(':')).filter(|(file, _)| *file == name);
        of_file.any(|(file, column)| chosen(file, column))
    };
    for &name in all.iter().filter(|name| wanted(name)) {
        match [0, 1].map(|side| names[side].contains(name)) {
            [true, true] => {
                let [a, b] = heads(name);
                compared.push(table(name, [a?, b?], settings, by_step, &chosen)?);
            }
            [first, _] => only[usize::from(!first)].push(name.clone()),
        }
    }
    let without_status = status == [None, None];
    let status = match status {
        [Some(a), Some(b)] => Some([a, b]),
        [None, None] => None,
        [a, _] => {
            only[usize::from(a.is_none())].push("result.json".into());
            None
        }
    };
    Ok(Comparison { tables: compared, only, status, without_status, idle, known })
}

/// The columns of all tables of either side, as `nodes.csv:ux`.
fn columns(folders: [&Path; 2], names: &[BTreeSet<String>; 2]) -> io::Result<BTreeSet<String>> {
    let mut known = BTreeSet::new();
    for (folder, names) in folders.into_iter().zip(names) {
        for name in names {
            let rows = TableReader::open(&folder.join(name))?;
            known.extend(rows.header.iter().map(|column| format!("{name}:{column}")));
        }
    }
    Ok(known)
}

/// Compares a table that both sides have.
fn table(
    name: &str,
    rows: [TableReader; 2],
    settings: &Settings,
    by_step: bool,
    chosen: &dyn Fn(&str, &str) -> bool,
) -> io::Result<ComparedTable> {
    let shared: Vec<String> =
        rows[0].header.iter().filter(|column| rows[1].column(column).is_some()).cloned().collect();
    let only = [0, 1].map(|side: usize| {
        let missing = rows[side].header.iter().filter(|column| rows[1 - side].column(column).is_none());
        missing.filter(|column| chosen(name, column)).cloned().collect()
    });
    // A key of either side is one: a table of another version may have its names in another place.
    let is_key = |column: &str| rows.iter().any(|rows| rows.column(column).is_some_and(|place| rows.is_key(place)));
    let values: Vec<&str> = shared.iter().map(String::as_str).filter(|&c| c != "step" && !is_key(c)).collect();
    let has_time = shared.iter().any(|column| column == "time");
    let by = matched_by(name, &shared, by_step);
    let mut sides = rows.map(|rows| {
        let pick = pick(&rows, &shared, &values, has_time, by);
        Cursor::new(rows, &pick)
    });
    let joined = join::join(&mut sides, values.len(), by)?;
    let all_rows = [sides[0].rows, sides[1].rows];
    let summaries = sides.map(|side| side.summary);
    let scales = scale::scales(name, &values, [&summaries[0].ranges, &summaries[1].ranges]);
    let named = |column: &str| {
        let by = |selector: &Selector| *selector != Selector::default() && selector.takes(name, column);
        settings.columns.iter().chain(settings.tolerances.iter().map(|tolerance| &tolerance.of)).any(by)
    };
    let columns: Vec<ComparedColumn> = (values.iter().zip(joined.worst).zip(scales))
        .filter(|((column, _), _)| chosen(name, column))
        .map(|((&column, worst), scale)| {
            let tolerance = select::closest(&settings.tolerances, name, column).map_or(TOLERANCE, |t| t.value);
            let judged = name != COST || named(column);
            let near = worst.difference <= settings.absolute || worst.difference <= tolerance * scale;
            ComparedColumn { name: column.into(), worst, scale, tolerance, judged, passed: near || !judged }
        })
        .collect();
    let truncated = summaries.map(|summary| summary.truncated);
    let judged = name != COST || columns.iter().any(|column| column.judged);
    Ok(ComparedTable {
        name: name.into(),
        only,
        alone: joined.alone,
        rows: joined.rows,
        frames: joined.frames,
        all_rows,
        ends: apart(joined.ends, truncated),
        truncated,
        by,
        columns,
        judged,
    })
}

/// The number that pairs the frames of a table.
fn matched_by(name: &str, shared: &[String], by_step: bool) -> Matched {
    match () {
        () if of_file(name).is_some_and(holds_response) && shared.iter().any(|column| column == FREQUENCY) => {
            Matched::Frequency
        }
        () if by_step && shared.iter().any(|column| column == "step") => Matched::Step,
        () => Matched::Time,
    }
}

/// The columns of one side that are read.
fn pick(rows: &TableReader, shared: &[String], values: &[&str], has_time: bool, by: Matched) -> Pick {
    let place = |column: &str| rows.column(column);
    let frequency = place(FREQUENCY).filter(|_| by == Matched::Frequency);
    let has_time = has_time && frequency.is_none();
    // A table without a time has no frames, whatever its column `step` counts.
    let (step, time) = (place("step").filter(|_| has_time), place("time").filter(|_| has_time));
    let is_value = |column: &String| matches!(column.as_str(), "step" | "time") || values.contains(&column.as_str());
    let keys =
        shared.iter().filter(|column| !is_value(column) && *column != SET).filter_map(|column| place(column)).collect();
    Pick { step, time, frequency, keys, values: values.iter().filter_map(|column| place(column)).collect() }
}

/// The last times, where one side goes on for more than one and a half of the other's last step.
fn apart(ends: [Option<(f64, f64)>; 2], truncated: [bool; 2]) -> Option<[f64; 2]> {
    let [Some(a), Some(b)] = ends else { return None };
    let shorter = usize::from(b.0 < a.0);
    let (end, before) = if shorter == 0 { a } else { b };
    let step = if before.is_nan() { 0.0 } else { (end - before).abs() };
    let digits = 4.0 * f64::EPSILON * a.0.abs().max(b.0.abs());
    ((a.0 - b.0).abs() > (1.5 * step).max(digits) && !truncated[shorter]).then_some([a.0, b.0])
}

/// The names of the tables of a folder.
fn tables(folder: &Path) -> io::Result<BTreeSet<String>> {
    let mut names = BTreeSet::new();
    for entry in fs::read_dir(folder).map_err(|e| at(folder, e))? {
        let name = entry.map_err(|e| at(folder, e))?.file_name();
        names.extend(name.to_str().filter(|name| name.ends_with(".csv")).map(String::from));
    }
    Ok(names)
}

/// The end of a run by its result.json.
struct End {
    status: String,
    /// The number of steps where these moved a displacement, and times are loads.
    moved_steps: Option<u64>,
}

/// The end of a run; `None` where it never came to write one.
fn end_of(folder: &Path) -> io::Result<Option<End>> {
    let path = folder.join("result.json");
    let text = match read_regular(&path) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
        read => read.map_err(|e| at(&path, e))?,
    };
    let result: serde_json::Value = serde_json::from_slice(&text).map_err(|e| at(&path, e.into()))?;
    let moved_steps = result["counts"]["steps"].as_u64().filter(|_| result["by_displacement"] == true);
    match result["status"].as_str() {
        Some(status) => Ok(Some(End { status: status.into(), moved_steps })),
        None => Err(at(&path, io::Error::new(io::ErrorKind::InvalidData, "no status"))),
    }
}

/// Whether the load of a path falls anywhere, so that one time has several points.
fn turns(folder: &Path) -> io::Result<bool> {
    let path = folder.join(COST);
    if !path.is_file() {
        return Ok(false);
    }
    let mut rows = TableReader::open(&path)?;
    let (Some(dt), Some(time)) = (rows.column("dt"), rows.column("time")) else { return Ok(false) };
    let mut before = f64::NEG_INFINITY;
    while let Some(row) = rows.next_row()? {
        let row: Vec<f64> = fields(row).map(number).collect();
        // A row may stand for several steps.
        let now = row.get(time).copied().unwrap_or(f64::NAN);
        if row.get(dt).is_some_and(|dt| *dt < 0.0) || now < before {
            return Ok(true);
        }
        before = now;
    }
    Ok(false)
}
