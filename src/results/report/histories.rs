//! The numbers of tables over time, thinned to the capacity of a page: times at regular distances, and names at regular distances if there
//! are too many.

use super::numbers::PageNumbers;
use super::result::Result;
use crate::table::{CASE, STAGE, names_subject};
use crate::table_reader::{TableReader, fields, number, text};
use crate::tables;
use base::quantities::{Column, UnitSystem};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io;
use std::path::Path;

/// The largest number of numbers of one table that a page carries.
const NUMBERS: usize = 150_000;
/// The largest number of times.
const TIMES: usize = 1_500;
/// The number of times below which names are left out instead of further times.
const FEW_TIMES: usize = 200;

/// Tables that do not go over time, and the column that they go over.
const OVER: [(&str, &str); 3] =
    [("response.csv", "frequency"), ("response_links.csv", "frequency"), ("campbell.csv", "speed")];

/// A table over time.
pub struct History {
    /// The name of the file.
    pub file: String,
    /// The subjects of rows, as `tip` or `roof 3`; one empty name for the whole scene.
    pub names: Vec<String>,
    /// The names of the columns with numbers, but for the time.
    pub columns: Vec<String>,
    /// The column that rows go over: the time, the frequency of a response, or the speed of rotation.
    pub over: &'static str,
    /// The times, frequencies or speeds that are shown.
    pub times: Vec<f32>,
    /// The numbers by time, name and column; NaN where there is none.
    pub values: Vec<f32>,
    /// The numbers of times and of names of the table itself.
    pub all: [usize; 2],
}

/// The places of the columns of a table, from 0: `step` and `time`, keys, numbers.
struct Places {
    when: [Option<usize>; 2],
    keys: Vec<usize>,
    values: Vec<usize>,
}

impl Places {
    fn of(rows: &TableReader, over: &str) -> Places {
        let is = |place: &usize, wanted: bool| rows.is_key(*place) == wanted;
        let time = rows.column("time");
        // All load cases of a linear analysis have one time.
        let step = rows.column("step").filter(|_| rows.column(CASE).is_none());
        let when = [step, if over == "time" { time } else { rows.column(over) }];
        // Curves go on from stage to stage.
        let all = (0..rows.header.len()).filter(|&place| names_subject(&rows.header[place]));
        let keys = all.clone().filter(|place| is(place, true)).collect();
        let is_value = |place: &usize| is(place, false) && Some(*place) != when[1] && Some(*place) != time;
        Places { when, keys, values: all.filter(is_value).collect() }
    }

    /// The name of a row, from its fields.
    fn name(&self, row: &[&[u8]]) -> String {
        self.keys.iter().filter_map(|&key| row.get(key)).map(|field| text(field)).collect::<Vec<_>>().join(" ")
    }
}

/// Shows every whole row to `see` with the number of its frame, from 0, and returns the number of frames.
fn each(rows: &mut TableReader, places: &Places, see: &mut dyn FnMut(usize, &[&[u8]])) -> io::Result<usize> {
    let columns = rows.header.len();
    let (mut frames, mut before) = (0, Vec::new());
    let mut wrong = None;
    while let Some(row) = rows.next_row()? {
        let row: Vec<&[u8]> = fields(row).collect();
        if row.len() != columns {
            wrong = Some(row.len());
            break;
        }
        let when: Vec<u8> = places.when.iter().flatten().flat_map(|&place| [row[place], b","].concat()).collect();
        if frames == 0 || when != before {
            (frames, before) = (frames + 1, when);
        }
        see(frames - 1, &row);
    }
    wrong.map_or(Ok(frames), |count| Err(rows.ragged(count)))
}

impl History {
    /// Reads a table; `None` where it has no times.
    ///
    /// # Errors
    /// The table cannot be read, or a row has not as many fields as the header; the error names it.
    pub fn read(folder: &Path, file: &str) -> io::Result<Option<History>> {
        let path = folder.join(file);
        let mut rows = TableReader::open(&path)?;
        let over = OVER.iter().find(|(table, _)| *table == file).map_or("time", |(_, column)| *column);
        let places = Places::of(&rows, over);
        let Some(time) = places.when[1] else { return Ok(None) };
        let mut names: Vec<String> = Vec::new();
        let mut known: HashMap<String, usize> = HashMap::new();
        let frames = each(&mut rows, &places, &mut |_, row| {
            let name = places.name(row);
            if !known.contains_key(&name) {
                known.insert(name.clone(), names.len());
                names.push(name);
            }
        })?;
        let columns: Vec<String> = places.values.iter().map(|&place| rows.header[place].clone()).collect();
        let all = [frames, names.len()];
        let (width, most) = (columns.len().max(1), frames.min(TIMES));
        let times = (NUMBERS / (width * names.len().max(1))).clamp(most.min(FEW_TIMES), most).max(1);
        let kept = (NUMBERS / (width * times)).clamp(1, names.len().max(1));
        let every = frames.div_ceil(times).max(1);
        let slots: Vec<Option<usize>> = thinned(names.len(), kept);
        let names: Vec<String> =
            names.into_iter().zip(&slots).filter(|(_, slot)| slot.is_some()).map(|(n, _)| n).collect();
        let shown = |frame: usize| frame.is_multiple_of(every) || frame + 1 == frames;

        let mut rows = TableReader::open(&path)?;
        let (mut at, mut values) = (Vec::new(), Vec::new());
        let mut last = None;
        each(&mut rows, &places, &mut |frame, row| {
            // A run that goes on may have written more rows since the first pass.
            if frame >= frames || !shown(frame) {
                return;
            }
            if last != Some(frame) {
                last = Some(frame);
                at.push(number(row[time]) as f32);
                values.resize(values.len() + names.len() * columns.len(), f32::NAN);
            }
            let Some(&Some(slot)) = known.get(&places.name(row)).and_then(|&name| slots.get(name)) else { return };
            let first = ((at.len() - 1) * names.len() + slot) * columns.len();
            for (value, &place) in values[first..].iter_mut().zip(&places.values) {
                *value = number(row[place]) as f32;
            }
        })?;
        Ok(Some(History { file: file.into(), names, columns, over, times: at, values, all }))
    }

    /// A column of the name at a place over time; `None` where there is no such column.
    pub fn line(&self, name: usize, column: &str) -> Option<Vec<f32>> {
        let column = self.columns.iter().position(|other| other == column)?;
        let width = self.columns.len();
        Some((0..self.times.len()).map(|t| self.values[(t * self.names.len() + name) * width + column]).collect())
    }

    /// A sentence about the omitted data; empty if all data is shown.
    pub fn left_out(&self) -> String {
        let mut parts = Vec::new();
        if self.times.len() < self.all[0] {
            parts.push(format!("{} of {} times", self.times.len(), self.all[0]));
        }
        if self.names.len() < self.all[1] {
            parts.push(format!("{} of {} names", self.names.len(), self.all[1]));
        }
        if parts.is_empty() { String::new() } else { format!("{}: shown are {}", self.file, parts.join(" and ")) }
    }

    /// The history as the scripts of the page read it, with the error bars that result.json has.
    pub fn json(&self, result: &Result, numbers: &mut PageNumbers) -> Value {
        let (units, clock) = (result.units(), result.clock());
        let label = |column: &str| label(described(&self.file, column), column, units);
        let over_label = match self.over {
            "time" if clock.is_empty() => "time".to_owned(),
            "time" => format!("time ({})", clock.trim()),
            other => label(other),
        };
        json!({
            "file": self.file,
            "over": self.over,
            "names": self.names,
            "columns": self.columns,
            "kinds": self.columns.iter().map(|column| described(&self.file, column).map(|known| known.kind)).collect::<Vec<_>>(),
            "labels": self.columns.iter().map(|column| label(column)).collect::<Vec<_>>(),
            "over_label": over_label,
            "bands": self.columns.iter().map(|column| band(&result.json, &self.file, column)).collect::<Vec<_>>(),
            "times": numbers.add(&self.times, 1),
            "values": numbers.add(&self.values, self.names.len() * self.columns.len()),
        })
    }
}

/// The stages of a table, each with its last time; empty where the table has no such column.
///
/// # Errors
/// As for [`History::read`].
pub fn stages(folder: &Path, file: &str) -> io::Result<Vec<(String, f32)>> {
    let mut rows = TableReader::open(&folder.join(file))?;
    let (Some(stage), Some(time)) = (rows.column(STAGE), rows.column("time")) else { return Ok(Vec::new()) };
    let mut stages: Vec<(String, f32)> = Vec::new();
    while let Some(row) = rows.next_row()? {
        let row: Vec<&[u8]> = fields(row).collect();
        let (Some(name), Some(now)) = (row.get(stage), row.get(time)) else { break };
        let (name, now) = (text(name), number(now) as f32);
        match stages.last_mut() {
            Some((last, end)) if *last == *name => *end = now,
            _ => stages.push((name.into_owned(), now)),
        }
    }
    Ok(stages)
}

/// A column as its table describes it; `None` where the table is not one of a run.
fn described(file: &str, column: &str) -> Option<Column> {
    tables::of_file(file)?.columns().find(|known| known.name == column)
}

/// Half the width of the band of error bars of a column, over all rows and times; 0 without error bars.
fn band(result: &Value, file: &str, column: &str) -> f64 {
    let mut bars = result["error_bars"].as_array().into_iter().flatten();
    let bar = bars.find(|bar| bar["table"] == file && bar["column"] == column);
    let number = |key: &str| bar.and_then(|bar| bar[key].as_f64()).unwrap_or(0.0);
    (number("step_error") + number("mesh_error")).max(number("anywhere"))
}

/// A column with its unit, for an axis.
fn label(known: Option<Column>, column: &str, units: Option<&UnitSystem>) -> String {
    match known {
        Some(known) => format!("{column} ({})", known.unit.text(units)),
        None => column.to_owned(),
    }
}

/// For each of `all`, its place among the `kept` that stay; these are spread evenly.
fn thinned(all: usize, kept: usize) -> Vec<Option<usize>> {
    let mut next = 0;
    (0..all)
        .map(|i| {
            let takes = next < kept && i * kept >= next * all;
            next += usize::from(takes);
            takes.then(|| next - 1)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_table_is_thinned_and_ends_where_it_ends() {
        let dir = tempfile::tempdir().unwrap();
        let mut text = String::from("step,time,node,ux\n");
        (0..=4000).for_each(|i| text += &format!("{i},{}.5,a,{i}\n{i},{}.5,b,\n", i, i));
        std::fs::write(dir.path().join("t.csv"), text).unwrap();
        let history = History::read(dir.path(), "t.csv").unwrap().unwrap();
        assert_eq!((history.all, history.names.len()), ([4001, 2], 2));
        assert!(history.times.len() <= TIMES + 1 && history.left_out().contains("of 4001 times"));
        let line = history.line(0, "ux").unwrap();
        assert_eq!((line[0], *line.last().unwrap()), (0.0, 4000.0));
        assert!(line.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(history.line(1, "ux").unwrap().iter().all(|value| value.is_nan()));
    }

    #[test]
    fn names_that_stay_are_spread_evenly() {
        let slots = thinned(10, 3);
        assert_eq!(slots.iter().flatten().copied().collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(slots.iter().position(|slot| *slot == Some(2)), Some(7));
        assert_eq!(thinned(2, 2), [Some(0), Some(1)]);
    }
}
